"""heyoka: Taylor's method, the equations compiled by LLVM. Licence MPL-2.0."""

import heyoka as hy
import numpy as np

import trailers
import simplified
from algebras import Heyoka, Sympy
from derivation import Places, derive, explicit, ordered, without_constants
from reader import Scene

OWN, COMPACT, SIMPLIFIED = "Taylor", "Taylor, compact mode", "Taylor, simplified by SymPy"
# the reference: coefficients and states with 113 bits
REFERENCE = "Taylor, 113 bits"


class System:
    """States with tags and rates, the start, and where the coordinates are."""

    def __init__(self, scene, tags, y, rates, start, fixed):
        self.tags, self.start = tags, np.array(start, dtype=float)
        self.equations = list(zip(y, rates))
        self.places = Places(scene.coordinates, tags, fixed)


class Tool:
    def methods(self, case):
        if case.purpose == "reference":
            return [REFERENCE]
        # one function for the whole step, or functions in loops: more to compile and faster, or the other way round
        return [OWN, COMPACT] + ([] if case.trailers else [SIMPLIFIED])

    def setup(self, case):
        scene = Scene(case.toml)
        self.case, self.scene, self.ready, self.short = case, scene, {}, None
        self.algebra = algebra = Heyoka()
        if case.form == "reduced":
            tags, y, rates = trailers.symbolic(scene, algebra)
            start = ordered(tags, case.tags, case.start)
            found = without_constants(algebra, tags, y, rates, start)
        else:
            instant = derive(scene, algebra, case.formulation, case.removal)
            found = explicit(instant, algebra, ordered(instant.tags, case.tags, case.start))
        self.own = System(scene, *found)
        return algebra.uncounted

    def rates(self):
        y, rates = zip(*self.own.equations)
        return self.own.tags, self.algebra.numbers(list(rates), list(y), self.own.start)

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
            else:
                self.ready[key] = hy.taylor_adaptive(system.equations, system.start, tol=tolerance, compact_mode=method == COMPACT)
        return self.ready[key]

    def run(self, method, tolerance, times):
        system, integrator = self.system(method), self.prepare(method, tolerance, times)
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
