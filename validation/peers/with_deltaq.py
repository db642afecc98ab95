"""Ours, through the Python module. Runs are timed by the module's own clock, which leaves out the call from
Python and the start of a thread.
"""

import numpy as np

import deltaq

METHODS = {name.title().replace("-", ""): name for name in deltaq.METHODS}
# on the car with trailers, which is not stiff and may be long, the explicit ones
EXPLICIT = [name for name in ("Taylor", "Dop853", "Tsit45") if name in METHODS]
# two runs, the second at a hundredth of the tolerance, and the difference as an error estimate
SOLVE = "solve: two runs by the method that is chosen"
BODIES = "quasi-velocities, a place for every body"
# several motions in lanes, each once
LANES = "Taylor in lanes"
FORMS = {"": "", "quasi-velocities": "-reduced", "costate form": "-costate", BODIES: "-reduced"}


class Tool:
    def methods(self, case):
        if case.vary:
            return [LANES]
        forms = {"chetaev": ["", "quasi-velocities"], "vakonomic": ["", "costate form", "quasi-velocities"]}
        forms = forms.get(case.formulation, [""]) + ([BODIES] if case.trailers else [])
        names = EXPLICIT if case.trailers else METHODS
        return [", ".join(filter(None, (name, form))) for form in forms for name in names] + [SOLVE]

    def setup(self, case):
        self.case, self.made = case, {}
        constants = [x for (kind, _), x in zip(case.tags, case.start) if kind == "P"]
        self.choice = {"removal": case.removal, "constants": constants} if case.removal else {}
        self.system = deltaq.parse(case.toml)
        if case.vary:
            return 0.0
        self.made["Dop853"] = self.system.equations(case.formulation, **self.choice)
        return 0.0

    def equations(self, method):
        form = method.partition(", ")[2]
        system = deltaq.parse(self.case.bodies if form == BODIES else self.case.toml)
        return system.equations(self.case.formulation + FORMS[form], **self.choice)

    def shared(self, method):
        return "", lambda: None

    def prepare(self, method, tolerance, times):
        if method != SOLVE and not self.case.vary and method not in self.made:
            self.made[method] = self.equations(method)

    def run(self, method, tolerance, times):
        if self.case.vary:
            return self.together(method, tolerance, times)
        self.prepare(method, tolerance, times)
        if method == SOLVE:
            return lambda: self.solve(self.system, tolerance, times), completed
        equations, name = self.made[method], METHODS[method.partition(", ")[0]]
        columns = range(self.system.dimension)
        if method.endswith(BODIES):
            columns = [i if i < 3 else 3 * (i - 2) + 2 for i in columns]
        coordinates = lambda run: equations.outputs(completed(run, run.times), run.states).coordinates[:, columns]
        return lambda: equations.integrate(times, method=name, tolerance=tolerance), coordinates

    def together(self, method, tolerance, times):
        """In lanes on one thread; or one by one, which nobody times."""
        case, beside = self.case, lambda tables: np.concatenate(tables, axis=1)
        if method != LANES:
            single = [deltaq.parse(case.toml, member).equations(case.formulation, **self.choice) for member in case.members]
            name = METHODS[method]
            runs = lambda: [equations.integrate(times, method=name, tolerance=tolerance) for equations in single]
            read = lambda runs: beside([e.outputs(completed(run, run.times), run.states).coordinates for e, run in zip(single, runs)])
            return runs, read
        about = {"vary": case.vary, "tolerance": tolerance, "threads": 1, "estimate": False} | self.choice

        def coordinates(answer):
            wrong = [why for why in (*answer.cause, *answer.alone) if why]
            if wrong:
                raise ValueError(wrong[0])
            return beside(answer.coordinates)

        return lambda: self.system.ensemble(case.formulation, times, **about), coordinates

    def solve(self, system, tolerance, times):
        return system.solve(self.case.formulation, times, tolerance=tolerance, **self.choice)

    def seconds(self, answer):
        if isinstance(answer, list):
            return sum(run.seconds for run in answer)
        return answer.seconds["integrate"] if isinstance(answer, deltaq.Motion) else answer.seconds

    def total(self, method, tolerance, times):
        if method == SOLVE:
            return self.solve(deltaq.parse(self.case.toml), tolerance, times)
        return self.equations(method).integrate(times, method=METHODS[method.partition(", ")[0]], tolerance=tolerance)


def completed(answer, table=None):
    if answer.status != "completed":
        raise ValueError(answer.cause)
    return answer.coordinates if table is None else table
