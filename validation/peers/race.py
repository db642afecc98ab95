"""One problem, solved by everybody in turns. All errors are computed here, in the kinetic metric, against one
reference.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

import by_hand
import deltaq
from reader import Scene
from with_deltaq import SOLVE
from worker import Refusal, Worker

# errors that have to be reached
TARGETS = (1e-9, 1e-10, 1e-11)
TASKS = ("trajectory", "end")
# how far a right-hand side at the start may be from ours, relative to the largest rate
RIGHT = 1e-12
# a method that is slower by this factor than another one of its row, at a larger error, climbs no further
HOPELESS = 10
# what is slower than the fastest by this factor at the first try is not timed again
NOISE = 1.4
# how far the reference may be from ours
AGREEMENT = 1e-10
OURS = "deltaq"


class Effort(NamedTuple):
    """Tolerances 10^-k: every how many-th k; turns of everybody; seconds of repeats in a turn; a run that
    takes longer is the last one of its method; seconds that a single question may take.
    """

    step: int = 1
    rounds: int = 2
    repeat: float = 0.05
    slow: float = 0.5
    limit: int = 60


QUICK = Effort(step=2, rounds=1, repeat=0.02, slow=0.3, limit=30)


@dataclass
class Rung:
    """A method at a tolerance: seconds of the derivation, of what else comes before the first run, and of a
    run; of ours also of all as a whole.
    """

    row: str
    entrant: tuple
    method: str
    tolerance: float
    task: str
    setup: float
    prepare: float
    seconds: float
    error: float
    whole: float | None = None

    @property
    def total(self):
        return self.setup + self.prepare + self.seconds if self.whole is None else self.whole


def row_of(case, entrant, method=""):
    """The row of the tables that a method of an entrant belongs to."""
    tool, form = entrant
    if tool == "deltaq":
        return "deltaq, `solve` (two runs)" if method == SOLVE else OURS
    if tool == "scipy":
        endings = {"whole": "numba, DOP853 compiled whole", "numba": "SciPy, right-hand side by numba"}
        name = endings.get(method[-5:], "SciPy")
    elif tool == "casadi":
        name = "CasADi, IDAS" if method.startswith("IDAS") else "CasADi, CVODES"
    else:
        name = {"heyoka": "heyoka", "sympy": "SymPy"}[tool]
    if form == "reduced":
        return f"{name}, reduced by hand"
    return f"{name}, multipliers" if case.trailers and tool != "sympy" else name


class Race:
    """What was found, for the page: `setups` and `checks` by row, `rungs`, `failures`; `reference`, how far
    our tightest run is from it, or why not.
    """

    def __init__(self, case, effort):
        self.case, self.effort, self.workers = replace(case), effort, {}
        self.setups, self.checks, self.rungs, self.failures = {}, {}, [], []
        self.expected, self.reference = None, "not timed"
        try:
            self.run()
        finally:
            for worker in self.workers.values():
                worker.end()

    def run(self):
        self.start()
        methods = self.set_everybody_up()
        if not any(tool not in ("deltaq", "sympy") for tool, _ in self.case.entrants):
            return
        try:
            self.refer()
        except Refusal as refusal:
            self.reference = str(refusal)
            return
        for entrant, method, setup in methods:
            self.climb(entrant, method, setup)
        for _ in range(self.effort.rounds):
            self.turn()
        if not self.case.vary:
            self.totals()

    def fail(self, row, what, words):
        self.failures.append((row, what, str(words)))

    def ask(self, entrant, what, purpose="time", **about):
        """A process that had to be ended is set up anew."""
        worker = self.workers.get((entrant, purpose))
        case = replace(self.case, form=entrant[1], purpose=purpose)
        if worker is None or not worker.process.is_alive():
            worker = self.workers[entrant, purpose] = Worker(entrant[0])
            if what != "setup":
                worker.ask("setup", self.effort.limit, case=case)
        return worker.ask(what, self.effort.limit, **({"case": case} if what == "setup" else about))

    def start(self):
        """The start, and our rates there."""
        case = self.case
        self.system = system = deltaq.parse(case.toml)
        names, (q, v) = system.coordinates, (system.start.q, system.start.v)
        case.tags = [("q", x) for x in names] + [("v", x) for x in names]
        case.start = [*q, *v]
        if case.trailers:
            case.tags += [("u", ""), ("omega", "")]
            case.start += [v[0] * np.cos(q[2]) + v[1] * np.sin(q[2]), v[2]]
        choice = {}
        try:
            if case.removal:
                motion = system.solve(case.formulation, [case.duration], removal=case.removal)
                choice = {"removal": case.removal, "constants": list(motion.constants.values())}
            equations = system.equations(case.formulation, **choice)
            y = equations.initial_state()
            rates = equations.rates(system.start.t, y)
        except deltaq.DeltaqError as error:
            return self.fail(OURS, "the equations at the start, for the check of right-hand sides", error)
        tags = tags_of(equations.states, names, case.removal and removal_of(case))
        self.expected = dict(zip(tags, rates))
        if case.trailers:
            # d/dt of the forward speed; its second part is the side slip, which is zero
            a = self.expected
            self.expected["u", ""] = (a["v", "x"] * np.cos(q[2]) + a["v", "y"] * np.sin(q[2])
                                      + v[2] * (v[1] * np.cos(q[2]) - v[0] * np.sin(q[2])))
            self.expected["omega", ""] = a["v", "theta0"]
        else:
            # a parameter that nothing depends on is no state of ours: it starts at zero
            cyclic = {("u", name): x for (kind, name), x in zip(tags, y) if kind == "du" and ("u", name) not in tags}
            self.expected |= cyclic
            case.tags, zeros = tags + list(cyclic), [0.0 for _ in cyclic]
            begins = lambda member: deltaq.parse(case.toml, member).equations(case.formulation, **choice).initial_state()
            case.starts = [[*begins(member), *zeros] for member in case.members]
            case.start = case.starts[0]
            self.expected |= by_hand.rates_of(case, Scene(case.toml).parameters, [*rates, *cyclic.values()])

    def set_everybody_up(self):
        """Derivations, right-hand sides checked; entrant, method and seconds of the derivation for what may
        be timed.
        """
        methods = []
        for entrant in self.case.entrants:
            row, what = row_of(self.case, entrant), "derivation"
            try:
                self.setups[row], names = self.ask(entrant, "setup")
                what = "right-hand side"
                apart = self.check(entrant)
                if not apart <= RIGHT:
                    raise Refusal(f"{apart:.1e} from ours at the start")
            except Refusal as refusal:
                self.fail(row, what, refusal if what == "derivation" else f"{refusal}: not timed")
                continue
            self.checks[row] = apart
            methods += [(entrant, method, self.setups[row]) for method in names]
        return methods

    def check(self, entrant):
        """Largest difference of the rates at the start from ours, relative to the largest."""
        if self.expected is None or entrant[0] == "deltaq":
            # ours is what the others are compared with; where it has no answer, the reference has to do
            return 0.0
        tags, rates = self.ask(entrant, "rates")
        missing = [tag for tag in tags if tag not in self.expected]
        if missing:
            raise Refusal(f"no {missing[0]} of ours")
        ours = np.array([self.expected[tag] for tag in tags])
        return np.abs(rates - ours).max() / max(1.0, np.abs(ours).max())

    def refer(self):
        """The reference: heyoka's Taylor method in 113 bits at 1e-28, from expressions that heyoka
        differentiates itself, confirmed by ours.
        """
        entrant = ("heyoka", "reduced" if self.case.trailers or self.case.vary else "scene")
        about = {"method": "Taylor, 113 bits", "tolerance": 1e-28, "task": "trajectory"}
        _, self.truth = self.ask(entrant, "run", "reference", **about)
        members = len(self.case.members)
        q, t = self.truth.reshape(-1, self.system.dimension), np.repeat(self.case.times, members)
        self.mass = self.system.mass(t, q, np.tile(self.system.start.v, (len(q), 1)))
        _, ours = self.ask(self.case.entrants[0], "run", method="Dop853", tolerance=1e-14, task="trajectory")
        apart = self.error(ours)
        if not apart <= AGREEMENT:
            raise Refusal(f"the reference and ours are {apart:.1e} apart")
        self.reference = apart

    def error(self, found):
        """The largest sqrt(dq' M dq) over the times, and over motions; of a table with two rows, that at the
        last time.
        """
        places, n = [0, -1] if len(found) == 2 else slice(None), self.system.dimension
        difference = (found - self.truth[places]).reshape(-1, n)
        mass = self.mass.reshape(len(self.truth), -1, n, n)[places].reshape(-1, n, n)
        return np.sqrt(np.abs(np.einsum("ki,kij,kj->k", difference, mass, difference))).max()

    def climb(self, entrant, method, setup):
        """Tighter and tighter until the tightest target is reached, each tolerance once."""
        row = row_of(self.case, entrant, method)
        # heyoka compiles for every tolerance: those that cannot do are left out
        for k in range(9 if entrant[0] == "heyoka" else 7, 16, self.effort.step):
            tolerance, found = float(f"1e-{k}"), []
            for task in TASKS:
                about = {"method": method, "tolerance": tolerance, "task": task}
                try:
                    prepare = self.ask(entrant, "prepare", **about)
                    seconds, coordinates = self.ask(entrant, "run", **about)
                except Refusal as refusal:
                    return self.fail(row, f"{method} at 1e-{k}, {task}", refusal)
                prepare = found[0].prepare if found else prepare
                error = self.error(coordinates)
                found.append(Rung(row, entrant, method, tolerance, task, setup, prepare, seconds, error))
                self.rungs.append(found[-1])
            best, slowest = min(rung.error for rung in found), max(rung.seconds for rung in found)
            if best <= 0.5 * TARGETS[2]:
                return None
            other = self.far_better(row, method, slowest, best)
            if other:
                words = f"{other.method} at {short(other.tolerance)} is over {HOPELESS} times as fast, with a smaller error"
            elif slowest > self.effort.slow:
                words = f"{slowest:.1f} s a run, error {short(best)}"
            else:
                continue
            return self.fail(row, f"{method} at 1e-{k}, trajectory", f"stopped there: {words}")
        reached = min((rung.error for rung in self.rungs if (rung.row, rung.method) == (row, method)), default=math.inf)
        if reached > TARGETS[2]:
            self.fail(row, f"{method}, all tolerances", f"no error below {short(reached)}")

    def far_better(self, row, method, seconds, error):
        """Another method of the row that reaches every target and a smaller error in a fraction of the time."""
        for rung in self.rungs:
            better = rung.error <= min(TARGETS[2], error) and HOPELESS * rung.seconds < seconds
            if better and rung.row == row and rung.method != method and rung.task == "trajectory":
                return rung
        return None

    def candidates(self):
        """What may be the fastest of its row for some target."""
        least = {}
        for rung in self.rungs:
            for target in filter(lambda target: rung.error <= target, TARGETS):
                key = rung.row, rung.task, target
                least[key] = min(least.get(key, math.inf), rung.seconds)
        fast = lambda rung, target: rung.error <= target and rung.seconds <= NOISE * least[rung.row, rung.task, target]
        return [rung for rung in self.rungs if any(fast(rung, target) for target in TARGETS)]

    def turn(self):
        """Times the candidates once more, everybody in turns."""
        for rung in self.candidates():
            about = {"method": rung.method, "tolerance": rung.tolerance, "task": rung.task}
            try:
                rung.seconds = min(rung.seconds, self.ask(rung.entrant, "run", repeat=self.effort.repeat, **about)[0])
            except Refusal as refusal:
                self.fail(rung.row, f"{rung.method} at {short(rung.tolerance)}, again", refusal)

    def totals(self):
        """Ours from the text of the scene, measured as a whole: the candidates, and every method in every
        form, for one that takes longer to integrate may be derived sooner.
        """
        chosen = {id(rung): rung for rung in self.candidates()}
        # the derivation of a long train takes seconds
        if not self.case.trailers:
            precise = [rung for rung in self.rungs if rung.task == "trajectory" and rung.error <= TARGETS[2]]
            fastest = {rung.method: rung for rung in sorted(precise, key=lambda rung: -rung.seconds)}
            chosen |= {id(rung): rung for rung in fastest.values()}
        for rung in chosen.values():
            if rung.entrant[0] != "deltaq":
                continue
            rung.whole = math.inf
            for _ in range(self.effort.rounds):
                try:
                    seconds = self.ask(rung.entrant, "total", method=rung.method, tolerance=rung.tolerance)
                    rung.whole = min(rung.whole, seconds)
                except Refusal:
                    pass


def tags_of(states, coordinates, removal):
    """What our states are, in the words that all tools understand; `removal` has the parameters and the
    memory variables.
    """
    parameters, memory = removal or ((), ())
    counted, tags = 0, []
    for state in states:
        stem = state.rstrip("'")
        if stem in parameters:
            tags.append(("u" if state == stem else "du", stem))
        elif removal:
            tags.append(("w", state) if state in memory else ("P", state.removeprefix("P_")))
        elif stem in coordinates:
            tags.append(("q" if state == stem else "v", stem))
        else:
            counted += 1
            tags.append(("mu", str(counted)))
    return tags


def removal_of(case):
    removal = Scene(case.toml).removals[case.removal]
    return removal.parameters, removal.memory


def short(x, digits=0):
    """1e-9, not 1e-09."""
    return f"{x:.{digits}e}".replace("e-0", "e-").replace("e+0", "e")
