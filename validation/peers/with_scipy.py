"""SciPy's solve_ivp with right-hand sides from SymPy, as Python and compiled by numba; and DOP853 compiled as a whole. Licences BSD."""

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

import compiled_dop853
import trailers
from algebras import Sympy
from code_lines import Lines, function
from derivation import Places, derive, ordered
from reader import Scene

SOLVERS = ["DOP853", "LSODA", "Radau"]
COMPILED = "DOP853 compiled whole"


class Tool:
    def methods(self, case):
        return [f"{solver}, {kind}" for kind in ("Python", "numba") for solver in SOLVERS] + [COMPILED]

    def setup(self, case):
        scene = Scene(case.toml)
        self.by_hand = case.form in ("reduced", "multipliers")
        if self.by_hand:
            n = len(scene.coordinates) - 3
            p = scene.parameters
            names = [("q", x) for x in scene.coordinates]
            names += [("u", ""), ("omega", "")] if case.form == "reduced" else [("v", x) for x in scene.coordinates]
            self.hand = trailers.reduced_loop if case.form == "reduced" else trailers.multipliers
            self.arguments = (n, float(p["m"]), float(p["J"]), float(p["d"]))
            hand, arguments = self.hand, self.arguments
            self.python = lambda t, y: hand(t, y, *arguments)
            self.tags, fixed, self.start = names, {}, ordered(names, case.tags, case.start)
        else:
            algebra = Sympy()
            instant = derive(scene, algebra, case.formulation, case.removal)
            self.lines = Lines(instant, ordered(instant.tags, case.tags, case.start))
            self.python = function(self.lines.for_python())
            self.tags, fixed, self.start = self.lines.tags, self.lines.fixed, self.lines.start
        self.start = np.array(self.start, dtype=float)
        self.coordinates = Places(scene.coordinates, self.tags, fixed)
        self.compiled = None
        return 0.0

    def rates(self):
        return self.tags, self.python(0.0, self.start)

    def numba(self):
        if self.compiled is None:
            if self.by_hand:
                n, m, J, d = self.arguments
                hand = njit(self.hand)
                # Radau hands over columns of matrices
                self.compiled = njit(lambda t, y: hand(t, np.ascontiguousarray(y), n, m, J, d))
            else:
                self.compiled = njit(function(self.lines.for_numba()))
            found, expected = self.compiled(0.0, self.start), np.array(self.python(0.0, self.start))
            if np.abs(found - expected).max() > 1e-12 * max(1.0, np.abs(expected).max()):
                raise ValueError("the compiled right-hand side differs from the other one")
        return self.compiled

    def shared(self, method):
        if method == COMPILED:
            # numba compiles at the first call with a function
            return COMPILED, lambda: compiled_dop853.integrate(self.numba(), 0.0, self.start, np.array([0.0, 1e-6]), 1e-3)
        return ("numba", self.numba) if "numba" in method else ("", lambda: None)

    def prepare(self, method, tolerance, times):
        pass

    def run(self, method, tolerance, times):
        times = np.array(times, dtype=float)
        if method == COMPILED:
            rates = self.numba()
            return lambda: compiled_dop853.integrate(rates, times[0], self.start, times, tolerance), self.coordinates
        rates = self.numba() if "numba" in method else self.python
        solver = method.split(",")[0]
        asked = times if len(times) > 2 else None

        def run():
            found = solve_ivp(rates, (times[0], times[-1]), self.start, method=solver, t_eval=asked, rtol=tolerance, atol=tolerance)
            if not found.success:
                raise ValueError(found.message)
            return found.y.T if asked is not None else found.y[:, [0, -1]].T

        return run, self.coordinates
