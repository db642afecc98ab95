"""heyoka: Taylor's method, the equations compiled by LLVM. Licence MPL-2.0."""

import heyoka as hy
import numpy as np

import by_hand
import simplified
import trailers
from algebras import Heyoka, Sympy
from derivation import Places, derive, explicit, ordered, without_constants
from reader import Scene

OWN, COMPACT, SIMPLIFIED = "Taylor", "Taylor, compact mode", "Taylor, simplified by SymPy"
# the reference: coefficients and states with 113 bits
REFERENCE = "Taylor, 113 bits"


class System:
    """States with tags and rates, the start, and where the coordinates are; of several motions at once `starts`
    and `constants` of each.
    """

    def __init__(self, scene, tags, y, rates, start, fixed, starts=(), constants=()):
        self.tags, self.start = tags, np.array(start, dtype=float)
        self.starts, self.constants = np.array(starts, dtype=float), np.array(constants, dtype=float)
        self.equations = list(zip(y, rates))
        self.places = Places(scene.coordinates, tags, fixed)


class Tool:
    def methods(self, case):
        if case.purpose == "reference":
            return [REFERENCE]
        # one function for the whole step, or functions in loops: more to compile and faster, or the other way round
        return [OWN, COMPACT] + ([] if case.trailers or case.form == "reduced" else [SIMPLIFIED])

    def setup(self, case):
        scene = Scene(case.toml)
        self.case, self.scene, self.ready, self.short = case, scene, {}, None
        self.algebra = algebra = Heyoka()
        if case.form == "reduced" and not case.trailers:
            found = self.by_hand()
        elif case.form == "reduced":
            tags, y, rates = trailers.symbolic(scene, algebra)
            start = ordered(tags, case.tags, case.start)
            found = without_constants(algebra, tags, y, rates, start)
        else:
            instant = derive(scene, algebra, case.formulation, case.removal)
            found = explicit(instant, algebra, ordered(instant.tags, case.tags, case.start))
        self.own = System(scene, *found)
        return algebra.uncounted

    def by_hand(self):
        """Of several motions at once, constants of the motion are parameters of the integrator."""
        case, parameters = self.case, self.scene.parameters
        number = lambda i, value: hy.par[i] if case.vary else hy.expression(float(value))
        tags, y, rates = by_hand.symbolic(case, parameters, self.algebra, number, hy.time)
        starts, constants = zip(*(by_hand.start(case, parameters, values) for values in case.starts))
        starts, constants = ([list(table.values()) for table in tables] for tables in (starts, constants))
        return tags, y, [hy.expression(e) if isinstance(e, float) else e for e in rates], starts[0], {}, starts, constants

    def rates(self):
        y, rates = zip(*self.own.equations)
        constants = self.own.constants[0] if self.case.vary else ()
        return self.own.tags, self.algebra.numbers(list(rates), list(y), self.own.start, constants)

    def system(self, method):
        if method != SIMPLIFIED:
            return self.own
        if self.short is None:
            case = self.case
            instant = derive(self.scene, Sympy(), case.formulation, case.removal)
            tags, y, rates, start, fixed = simplified.explicit(instant, ordered(instant.tags, case.tags, case.start))
            y, rates = [hy.expression(str(x)) for x in y], [hy.from_sympy(e) for e in rates]
            self.short = System(self.scene, tags, y, rates, start, fixed)
        return self.short

    def shared(self, method):
        return (SIMPLIFIED, lambda: self.system(method)) if method == SIMPLIFIED else ("", lambda: None)

    def prepare(self, method, tolerance, times):
        key = (method, tolerance)
        if key not in self.ready:
            system = self.system(method)
            if method == REFERENCE:
                more = {"tol": hy.real128(tolerance), "fp_type": hy.real128, "compact_mode": True}
                self.ready[key] = hy.taylor_adaptive(system.equations, system.start.astype(hy.real128), **more)
            elif self.case.vary:
                states, more = system.starts.T.copy(), {"tol": tolerance, "compact_mode": method == COMPACT, "fast_math": True}
                self.ready[key] = hy.taylor_adaptive_batch(system.equations, states, pars=system.constants.T.copy(), **more)
            else:
                self.ready[key] = hy.taylor_adaptive(system.equations, system.start, tol=tolerance, compact_mode=method == COMPACT, fast_math=True)
        return self.ready[key]

    def run(self, method, tolerance, times):
        system, integrator = self.system(method), self.prepare(method, tolerance, times)
        if self.case.vary:
            return self.together(method, system, integrator, np.array(times, dtype=float))
        kind = hy.real128 if method == REFERENCE else float
        start, grid = system.start.astype(kind), np.array(times, dtype=float).astype(kind)

        def trajectory():
            integrator.time = grid[0]
            integrator.state[:] = start
            return integrator.propagate_grid(grid)[-1].astype(float)

        def end():
            integrator.time = grid[0]
            integrator.state[:] = start
            integrator.propagate_until(grid[-1])
            return np.stack([start, integrator.state])

        return (trajectory if len(times) > 2 else end), system.places

    def together(self, method, system, integrator, times):
        """In heyoka's batch mode; the reference one by one."""
        if method == REFERENCE:
            grid = times.astype(hy.real128)

            def one(start, constants):
                integrator.time, integrator.state[:], integrator.pars[:] = grid[0], start.astype(hy.real128), constants.astype(hy.real128)
                return integrator.propagate_grid(grid)[-1].astype(float)

            return (lambda: np.stack([one(*about) for about in zip(system.starts, system.constants)])), self.beside
        states, grid = system.starts.T.copy(), np.repeat(times[:, None], len(system.starts), axis=1)

        def begin():
            integrator.set_time(times[0])
            integrator.state[:] = states

        def trajectory():
            begin()
            return integrator.propagate_grid(grid)[-1]

        def end():
            begin()
            integrator.propagate_until(times[-1])
            return np.stack([states, integrator.state])

        return (trajectory if len(times) > 2 else end), lambda table: self.beside(np.moveaxis(table, 2, 0))

    def beside(self, tables):
        return np.concatenate([self.own.places(table) for table in tables], axis=1)
