"""The page `peers.md`."""

import math
import re

from data_package import DataPackage
from picture import curves, drawn, headline
from problems import MEMBERS
from race import OURS, TARGETS, short

BY_HAND = "heyoka, reduced by hand"
# the error that verdicts are about
TARGET = 1e-10
# how much less time ours needs from the text of a scene to a trajectory
TOTAL = 50


def demanded(row):
    """How much faster ours has to be than the peer of a row: not slower than heyoka, three times as fast as
    any other.
    """
    return 1 if row.startswith("heyoka") else 3


def least(race, row, of, task="trajectory", target=TARGET):
    """The rung of a row that needs least of something at an error of at most `target`."""
    fit = [rung for rung in race.rungs if (rung.row, rung.task) == (row, task) and rung.error <= target]
    return min((rung for rung in fit if math.isfinite(of(rung))), key=of, default=None)


def ms(seconds):
    """Milliseconds with three significant digits at most."""
    x = 1e3 * seconds
    if not math.isfinite(x):
        return "–"
    digits = [digits for bound, digits in ((99.5, 0), (9.95, 1), (0.995, 2), (0.0995, 3)) if x >= bound]
    return f"{x:.{digits[0]}f}" if digits else short(x, 2)


def markdown(columns, rows):
    lines = [columns, ["---", *["---:"] * (len(columns) - 1)], *rows]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)


def grid(races, cell):
    """Columns and rows: a row for every row of the races, a column for every race."""
    rows = dict.fromkeys(rung.row for race in races for rung in race.rungs)
    return ["tool", *(race.case.title for race in races)], [[row, *(cell(race, row) for race in races)] for row in rows]


def seconds(rung):
    return rung.seconds


def beside_ours(races, of, wanted):
    """Milliseconds of every row, how many times those of ours, and whether that is what was wanted."""

    def cell(race, row):
        theirs, ours = least(race, row, of), least(race, OURS, of)
        if theirs is None:
            return "not reached"
        if ours is None or row.startswith(OURS):
            return ms(of(theirs))
        ratio = of(theirs) / of(ours)
        return f"{ms(of(theirs))} (× {ms(ratio / 1e3)}, {'met' if ratio >= wanted(row) else '**missed**'})"

    return grid(races, cell)


def three(races, task):
    def cell(race, row):
        rungs = [least(race, row, seconds, task, target) for target in TARGETS]
        return " / ".join(ms(rung.seconds) if rung else "–" for rung in rungs)

    return grid(races, cell)


def settings(races):
    def cell(race, row):
        rung = least(race, row, seconds)
        return f"{rung.method}, {short(rung.tolerance)}: {short(rung.error)}" if rung else "–"

    return grid(races, cell)


def by_hand(races):
    """Every problem that heyoka has reduced by hand: its time, ours, and the ratio."""
    lines = []
    for race in races:
        theirs, ours = least(race, BY_HAND, seconds), least(race, OURS, seconds)
        if BY_HAND not in race.setups:
            continue
        if theirs is None or ours is None:
            lines.append([race.case.title, *("not reached" if rung is None else ms(rung.seconds) for rung in (theirs, ours)), "–", "–", "–"])
            continue
        ratio = theirs.seconds / ours.seconds
        setting = lambda rung: f"{rung.method}, {short(rung.tolerance)}: {short(rung.error)}"
        verdict = f"{ms(ratio / 1e3)}, {'met' if ratio >= 1 else '**missed**'}"
        lines.append([race.case.title, ms(theirs.seconds), ms(ours.seconds), verdict, setting(theirs), setting(ours)])
    return ["problem", "heyoka (ms)", "deltaq (ms)", "ratio", "heyoka, setting", "deltaq, setting"], lines


def set_up(races):
    """Set-up of the fastest setting: derivation, then compilation and what else comes before the first run."""

    def cell(race, row):
        rung = least(race, row, seconds)
        if rung is None or row.startswith(OURS):
            return ms(rung.total - rung.seconds) if rung else "–"
        return f"{ms(rung.setup)} + {ms(rung.prepare)}"

    return grid(races, cell)


def derivations(races):
    """Derivations that end without a motion: SymPy's."""
    rows = []
    for race in races:
        if ("sympy", "scene") not in race.case.entrants:
            continue
        cells = [f"{ms(race.setups[row])} ms" if row in race.setups else "–" for row in ("SymPy", OURS)]
        refused = [words for row, _, words in race.failures if row == "SymPy"]
        rows.append([race.case.title, refused[0] if refused and cells[0] == "–" else cells[0], cells[1]])
    return ["problem", "SymPy, LagrangesMethod", "deltaq, derivation and compilation"], rows


def counted(rows):
    """How many comparisons meet what was wanted, and of how many."""
    text = str(rows)
    met, missed = text.count(", met)"), text.count("**missed**")
    return f"{met} of {met + missed}"


def data(races):
    """All tables."""
    scenes = [race for race in races if not race.case.trailers and not race.case.vary]
    trains = [race for race in races if race.case.trailers and race.rungs]
    failures = [[race.case.title, *failure] for race in races for failure in race.failures]
    failures += [[race.case.title, "all", "reference", race.reference] for race in races
                 if race.reference != "not timed" and isinstance(race.reference, str)]
    confirmed = [race for race in races if not isinstance(race.reference, str)]
    checks = [[race.case.title, short(race.reference, 1), short(max(race.checks.values()), 1)] for race in confirmed]
    targets = " / ".join(map(short, TARGETS))
    package = DataPackage("data/peers", "The same problems in other tools, timed")
    package.table("solve", f"Milliseconds of one run to an error of {short(TARGET)} (times those of deltaq)", *beside_ours(scenes, seconds, demanded))
    package.table("settings", "Method, tolerance and error of these", *settings(scenes))
    package.table("errors", f"Milliseconds to errors of {targets}", *three(scenes, "trajectory"))
    package.table("ends", "The same if only the end is wanted", *three(scenes, "end"))
    package.table("by-hand", "Next to heyoka, reduced by hand", *by_hand(races))
    package.table("set-up", "Milliseconds of derivation + compilation", *set_up(scenes))
    package.table("derivation", "The derivation alone, by the tool that has a class for it", *derivations(races))
    package.table("total", f"From scene file to trajectory, milliseconds (wanted: {TOTAL} times those of deltaq)", *beside_ours(scenes, lambda rung: rung.total, lambda row: TOTAL))
    package.table("trains-solve", "Car with n trailers: milliseconds of one run", *beside_ours(trains, seconds, demanded))
    package.table("trains-set-up", "Car with n trailers: derivation + compilation", *set_up(trains))
    package.table("trains-settings", "Car with n trailers: method, tolerance and error", *settings(trains))
    package.table("not-measured", "What was not measured, and why", ["problem", "who", "what", "what became of it"], failures)
    package.table("checks", "Checks of the reference and of the right-hand sides",
                  ["problem", "our DOP853 at 1e-14 from the reference", "right-hand sides at the start, largest relative difference"], checks)
    return package


def page(races, provenance):
    """The page; in its tables the minus of an exponent is U+2212, where no line breaks."""
    lines = written(races, provenance).split("\n")
    return "\n".join(re.sub(r"(?<=\d)e-(?=\d)", "e\u2212", line) if line.startswith("|") else line for line in lines)


def written(races, provenance):
    """The page; `provenance` has date, commit, seconds, machine, effort, ours and versions."""
    scenes = [race for race in races if not race.case.trailers and not race.case.vary]
    columns, rows = beside_ours(scenes, seconds, demanded)
    _, total = beside_ours(scenes, lambda rung: rung.total, lambda row: TOTAL)
    pictures = [race for race in races if race.rungs and not race.case.vary]
    image = lambda race: f"![{headline(race.case.title, drawn(curves([vars(rung) for rung in race.rungs])))}](peers-{race.case.name}.svg)\n\n"
    return f"""# The same problems in other tools

**Solve time meets the target in {counted(rows)} comparisons; the time from scene file to trajectory in {counted(total)}.** The target for one run is the time of heyoka, and a third of the time of any other tool; \
from scene file to trajectory it is a fiftieth.

{INTRODUCTION}
## Solve time to an error of {short(TARGET)}

Milliseconds of one run (times those of deltaq).

{markdown(columns, rows)}
{"".join(map(image, pictures[:2]))}{"".join(f"- [{race.case.title}](peers-{race.case.name}.svg){chr(10)}" for race in pictures[2:])}
## Data

{data(races).list(1)}
## How this was made

`cargo xtask peers` on {provenance["date"]}, commit {provenance["commit"]}, in {provenance["seconds"]:.0f} s on {provenance["machine"]}. \
Each time that counts is the least of {provenance["effort"].rounds} turns of at least {provenance["effort"].repeat} s. Each step of each tool may take \
{provenance["effort"].limit} s on one thread. {MEMBERS} at a time (`by-hand.csv`): {MEMBERS} motions from other starts in one call.

{", ".join(f"{name} {version}" for name, version in provenance["versions"].items())}. Licences: {LICENCES}
"""


LICENCES = """\
heyoka MPL-2.0; CasADi LGPL-3.0, with SUNDIALS BSD-3-Clause; NumPy, SciPy, SymPy and mpmath BSD-3-Clause; numba and llvmlite BSD-2-Clause. \
deltaq is not linked with any of them."""

INTRODUCTION = r"""We give every tool the text of the scene. It derives and compiles in its own way, in the best form that we know for it. A tool is timed \
only if its right-hand side at the start agrees with ours to 1e-12. All tools run from Python, each in its own process.

| tool | what it was given | how it runs |
|---|---|---|
| deltaq | the scene; for trailers also a text with a place for every body | one run with projection and dense output; `solve` makes a second run at a hundredth of the tolerance as error estimate |
| heyoka | the scene; closed forms simplified by SymPy, whose time counts as set-up; *reduced by hand*: quasi-velocities, known costates, cyclic momenta (`validation/peers/by_hand.py`) | Taylor, `fast_math`, compiled for every tolerance, or read from its cache of code on disk |
| SciPy | SymPy's derivation, straight-line code | `solve_ivp` (DOP853, LSODA, Radau) in Python or numba; *compiled whole*: DOP853 as one numba function |
| CasADi | SX expressions | CVODES with the unknowns eliminated, IDAS with the equations as they stand |

A trajectory is the coordinates at 21 equidistant times. Its error is the largest in the kinetic metric $\sqrt{\Delta q^{\mathsf T} M \Delta q}$ against heyoka's Taylor \
method in 113 bits at 1e-28, which our own integration confirms. A time is the least of repeated runs, tools taking turns; the fastest setting that reaches \
the error counts. Imports and process starts are not counted.
""".replace("\\\n", "")
