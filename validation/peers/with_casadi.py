"""CasADi's expressions with SUNDIALS: CVODES on y' = F(y), IDAS on the equations with their unknowns. Licences LGPL-3.0 and BSD."""

import casadi as ca
import numpy as np

import trailers
from algebras import Casadi
from derivation import Places, derive, explicit, ordered, without_constants
from reader import Scene

OPTIONS = {
    "CVODES, Adams": {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"},
    "CVODES, BDF": {},
    "IDAS": {"calc_ic": True, "suppress_algebraic": True},
}
# from here on K z = r is left to a sparse solver in numbers: straight-line elimination would grow too long
LARGE = 30


class Tool:
    def methods(self, case):
        return list(OPTIONS) if case.form != "reduced" else list(OPTIONS)[:2]

    def setup(self, case):
        scene = Scene(case.toml)
        algebra = Casadi()
        self.differential = None
        if case.form == "reduced":
            tags, y, rates = trailers.symbolic(scene, algebra)
            start = ordered(tags, case.tags, case.start)
            self.tags, y, rates, self.start, fixed = without_constants(algebra, tags, y, rates, start)
            self.problem = {"x": ca.vertcat(*y), "ode": ca.vertcat(*rates)}
        else:
            instant = derive(scene, algebra, case.formulation, case.removal)
            start = ordered(instant.tags, case.tags, case.start)
            z, y_all = ca.vertcat(*instant.z), ca.vertcat(*instant.y)
            matrix = ca.vertcat(*[ca.horzcat(*row) for row in instant.matrix])
            matrix, right = ca.sparsify(matrix), ca.vertcat(*instant.right)
            self.differential = {"x": y_all, "z": z, "ode": ca.vertcat(*instant.rates), "alg": ca.mtimes(matrix, z) - right}
            self.whole_start = start
            guess = ca.Function("guess", [y_all], [ca.densify(matrix), right])(start)
            self.guess = np.linalg.solve(np.array(guess[0]), np.array(guess[1]))
            self.whole = Places(scene.coordinates, instant.tags, {})
            if len(instant.z) > LARGE:
                self.tags, self.start, fixed = instant.tags, start, {}
                parts = ca.Function("parts", [y_all], [matrix, right])
                rates_of = ca.Function("rates", [y_all, z], [self.differential["ode"]])
                y_whole = ca.MX.sym("y", len(start))
                solved = rates_of(y_whole, ca.solve(*parts(y_whole), "csparse"))
                self.problem = {"x": y_whole, "ode": solved}
            else:
                self.tags, y, rates, self.start, fixed = explicit(instant, algebra, start)
                self.problem = {"x": ca.vertcat(*y), "ode": ca.vertcat(*rates)}
        self.places = Places(scene.coordinates, self.tags, fixed)
        self.ready = {}
        return 0.0

    def rates(self):
        function = ca.Function("rates_at", [self.problem["x"]], [self.problem["ode"]])
        return self.tags, np.array(function(self.start)).ravel()

    def shared(self, method):
        return "", lambda: None

    def prepare(self, method, tolerance, times):
        key = (method, tolerance, tuple(times))
        if key not in self.ready:
            options = {"max_num_steps": 200_000, "reltol": tolerance, "abstol": tolerance} | OPTIONS[method]
            problem = self.differential if method == "IDAS" else self.problem
            kind = "idas" if method == "IDAS" else "cvodes"
            self.ready[key] = ca.integrator("run", kind, problem, key[2][0], list(key[2][1:]), options)
        return self.ready[key]

    def run(self, method, tolerance, times):
        integrator = self.prepare(method, tolerance, times)
        whole = method == "IDAS"
        start = np.array(self.whole_start if whole else self.start, dtype=float)
        more = {"z0": self.guess} if whole else {}
        places = self.whole if whole else self.places
        return lambda: np.vstack([start, np.array(integrator(x0=start, **more)["xf"]).T]), places
