"""SymPy in: its own examples move as SymPy says, and its expressions are formulas.

Examples are run from the source of SymPy's tests, up to where its equations stand. Those by Kane's method have speeds u, and velocities
with constraints put in; here their bodies move by positions and angular velocities in q', under the constraints that SymPy has put in.
"""

import inspect
import subprocess
import sys
import textwrap

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, Point, cross, dot, dynamicsymbols
from sympy.physics.mechanics.tests import test_kane2, test_kane3, test_kane5, test_lagrange, test_linearize

import deltaq

STATES = 1000
# difference over the largest acceleration at the same state
TOLERANCE = 1e-12
x, y = dynamicsymbols("x y")


def names_of(module, test, end):
    """The names in a test of SymPy's, run up to the line that begins with `end`."""
    source = inspect.getsource(inspect.unwrap(getattr(module, test)))
    lines = source[source.index("def ") : source.index("\n    " + end)].splitlines()[1:]
    names = dict(vars(module))
    exec(textwrap.dedent("\n".join(lines)), names)
    return names


def function(symbols, matrix):
    """A matrix as a function of k values of the symbols, shape (k, len(symbols)): an array (k, rows, columns)."""
    made = sp.lambdify(symbols, list(matrix), cse=True)

    def call(*values):
        columns = np.concatenate(values, axis=1).T
        return np.stack([np.broadcast_to(e, columns.shape[1]) for e in made(*columns)], -1).reshape(-1, *matrix.shape)

    return call


class Kane:
    """Equations by KanesMethod, and the same system as a LagrangesMethod."""

    def __init__(self, kane, origin, bodies, loads, q, speeds, more=(), constraints=(), slips=()):
        """speeds: equations that give u in q'; more: velocities of coordinates that SymPy has not; slips: points that stick to bodies."""
        frame, self.zero = kane._inertial, dict.fromkeys(kane._uaux, 0)
        self.speeds = sp.solve([sp.expand(e.subs(self.zero)) for e in speeds], list(kane.u), dict=True)[0]
        at = {place: self.moving(place, origin, frame) for place in [*(b.masscenter for b in bodies), *(p for p, _ in loads)]}
        spin = {b.frame: self.in_rates(b.frame.ang_vel_in(frame)) for b in bodies}
        energy = 0
        for body in bodies:
            v, w = at[body.masscenter].vel(frame), spin[body.frame]
            energy += (body.mass * dot(v, v) + dot(w, dot(body.central_inertia, w))) / 2
        rolling = [
            dot(at[body.masscenter].vel(frame) + cross(spin[body.frame], point.pos_from(body.masscenter)), axis)
            for point, body, axes in slips
            for axis in axes
        ]
        constraints = [self.in_rates(sp.sympify(c)) for c in constraints] + rolling
        forces = [(at[place], force) for place, force in loads]
        self.method = LagrangesMethod(energy, q, nonhol_coneqs=constraints, forcelist=forces, frame=frame)
        rates = kane.kindiffdict() | dict(more)
        self.compared = [i for i, c in enumerate(self.method.u) if c in rates]
        self.kane, self.rates = kane, sp.Matrix([rates[self.method.u[i]] for i in self.compared])

    def in_rates(self, expression):
        return expression.subs(self.zero).subs(self.speeds)

    def moving(self, place, origin, frame):
        point = Point(place.name)
        point.set_vel(frame, self.in_rates(place.pos_from(origin).dt(frame)))
        return point

    def accelerations(self, parameters, p, q, v):
        kane, place = self.kane, list(parameters)
        coordinates, rates, u = list(self.method.q), list(self.method.u), list(kane.u)
        speeds = function([*place, *coordinates, *rates], sp.Matrix([self.speeds[s] for s in u]))(p, q, v)[..., 0]
        known = [*place, *coordinates, *u]
        mass, forcing, rate, by_q, by_u = (
            function(known, m.subs(self.zero).doit())(p, q, speeds)
            for m in (kane.mass_matrix_full, kane.forcing_full, self.rates, self.rates.jacobian(coordinates), self.rates.jacobian(u))
        )
        np.testing.assert_allclose(rate[..., 0], v[:, self.compared], rtol=1e-10, atol=1e-10)
        change = np.linalg.solve(mass, forcing)[:, len(kane.q) :]
        return (by_q @ v[..., None] + by_u @ change)[..., 0]


class Lagrange:
    """Equations by LagrangesMethod."""

    def __init__(self, method):
        method.form_lagranges_equations()
        self.method, self.compared = method, range(len(method.q))

    def accelerations(self, parameters, p, q, v):
        known = [*parameters, *self.method.q, *self.method.u]
        mass, forcing = (function(known, m)(p, q, v) for m in (self.method.mass_matrix_full, self.method.forcing_full))
        n = q.shape[1]
        return np.linalg.solve(mass, forcing)[:, n : 2 * n, 0]


def disc_of_five_coordinates():
    """Rolling disc by the contact and three angles: test_kane5."""
    made = test_kane5._create_rolling_disc()
    kane = KanesMethod(
        made["frame"],
        made["q_ind"],
        made["u_ind"],
        made["kdes"],
        u_dependent=made["u_dep"],
        velocity_constraints=made["fnh"],
        bodies=made["bodies"],
        forcelist=made["loads"],
        explicit_kinematics=False,
        kd_eqs_solver=lambda a, b: sp.simplify(a.LUsolve(b)),
    )
    kane.kanes_equations()
    (disc,) = made["bodies"]
    (origin,) = [point for point in disc.masscenter._pos_dict if point.name == "contact_point"]
    (ground,) = [point for point in origin._pos_dict if point is not disc.masscenter]
    return Kane(kane, ground, made["bodies"], made["loads"], made["q_ind"], made["kdes"], constraints=made["fnh"])


def disc_of_six_coordinates():
    """Rolling disc by its centre and three angles: test_linearize_rolling_disc_kane."""
    s = names_of(test_linearize, "test_linearize_rolling_disc_kane", "# Test generalized form")
    q = [s[f"q{i}"] for i in range(1, 7)]
    return Kane(s["KM"], s["NO"], s["BL"], s["FL"], q, s["kindiffs"], constraints=s["f_v"])


def disc_by_auxiliary_speeds():
    """Rolling disc by three angles and a height, with a force at the contact: test_aux_dep."""
    s = names_of(test_kane2, "test_aux_dep", "frstar_steady")
    origin = Point("origin")
    s["P"].set_pos(origin, x * s["N"].x + y * s["N"].y)
    speeds = list(s["kindiffs"]) + [
        dot(s["O"].pos_from(origin).dt(s["N"]) - s["O"].vel(s["N"]), axis) for axis in (s["A"].x, s["A"].y)
    ]
    return Kane(s["kane"], origin, s["bodyList"], s["forceList"][:1], [*s["q"], x, y], speeds, constraints=s["f_v"])


def carriage():
    """Carriage with two wheels on an incline, exercises 8.12 and 8.17 of Kane: test_non_central_inertia."""
    s = names_of(test_kane2, "test_non_central_inertia", "# define inertias of rigid bodies A, B, C about")
    origin = Point("origin")
    s["pD"].set_pos(origin, x * s["P"].y + y * s["P"].z)
    v = s["pD"].pos_from(origin).dt(s["F"])
    more = {rate: dot(s["u2"] * s["A"].y, axis) for rate, axis in ((x.diff(), s["P"].y), (y.diff(), s["P"].z))}
    speeds = [*s["kde"], dot(v, s["A"].y) - s["u2"]]
    q = [s["q1"], s["q2"], s["q3"], x, y]
    return Kane(s["km"], origin, s["bodies"], s["forces"], q, speeds, more, [*s["vc"], dot(v, s["A"].z)])


def bicycle():
    """The benchmark bicycle: test_bicycle."""
    s = names_of(test_kane3, "test_bicycle", "# This is the start of entering")
    origin, (q3, q6) = Point("origin"), dynamicsymbols("q3 q6")
    s["WR_cont"].set_pos(origin, x * s["N"].x + y * s["N"].y)
    more = {q3.diff(): s["u3"], q6.diff(): s["u6"]}
    speeds = [*s["kd"], q3.diff() - s["u3"], q6.diff() - s["u6"]]
    q = [x, y, s["q1"], s["q2"], q3, s["q4"], s["q5"], q6]
    slips = [(s["WR_cont"], s["BodyWR"], (s["N"].x, s["N"].y)), (s["WF_cont"], s["BodyWF"], s["Y"])]
    return Kane(s["KM"], origin, s["BL"], s["FL"], q, speeds, more, slips=slips)


def disc_on_an_incline():
    """Disc on an incline, with a constraint on positions: test_disc_on_an_incline_plane."""
    return Lagrange(names_of(test_lagrange, "test_disc_on_an_incline_plane", "rhs = m.rhs()")["m"])


def pendulum():
    """Pendulum in two coordinates, with a force and a constraint on positions: test_nonminimal_pendulum."""
    return Lagrange(names_of(test_lagrange, "test_nonminimal_pendulum", "# Check solution")["LM"])


EXAMPLES = [
    disc_of_five_coordinates,
    disc_of_six_coordinates,
    disc_by_auxiliary_speeds,
    carriage,
    bicycle,
    disc_on_an_incline,
    pendulum,
]


@pytest.mark.parametrize("make", EXAMPLES)
def test_examples_of_sympy(make):
    example = make()
    method, random = example.method, np.random.default_rng(1)
    q, rates = list(method.q), list(method.u)
    symbols = method._L.free_symbols | method.coneqs.free_symbols | method._hol_coneqs.free_symbols
    for place, force in method.forcelist:
        symbols |= force.free_symbols(method.inertial) | place.vel(method.inertial).free_symbols(method.inertial)
    symbols.discard(dynamicsymbols._t)
    parameters = {s: random.uniform(0.5, 1.5) for s in sorted(symbols, key=str)}
    # velocities on the constraints J v + b = 0
    p = np.full((STATES, len(parameters)), list(parameters.values()))
    at = random.uniform(-0.5, 0.5, (STATES, len(q))) + 0.1
    if make is pendulum:
        at *= (parameters[sp.Symbol("L")] / np.linalg.norm(at, axis=1))[:, None]
    known = [*parameters, *q, *rates]
    jacobian, rest = (function(known, m) for m in (method.coneqs.jacobian(rates), method.coneqs))
    v = random.uniform(-1, 1, at.shape)
    for _ in range(2):
        v -= (np.linalg.pinv(jacobian(p, at, v)) @ rest(p, at, v))[..., 0]
    if make is disc_on_an_incline:
        at[:, 0] = parameters[sp.Symbol("R")] * at[:, 1]
    start, velocities = dict(zip(q, at[0])), dict(zip(rates, v[0]))
    system = deltaq.from_sympy(method, parameters=parameters, start=start, velocities=velocities, project=True)
    assert system.coordinates == [c.name for c in q]
    np.testing.assert_allclose(system.constraint(0, at, v), 0, atol=1e-13)
    equations = system.equations("chetaev")
    assert equations.states == system.coordinates + [f"{c}'" for c in system.coordinates]
    found = equations.rates(0, np.concatenate([at, v], axis=1))[:, len(q) :][:, example.compared]
    expected = example.accelerations(parameters, p, at, v)
    worst = (abs(found - expected).max(axis=1) / abs(expected).max(axis=1)).max()
    assert worst < TOLERANCE, f"{worst:.1e}"


def test_expressions_stand_where_strings_do(sledge):
    x, y, phi, u = dynamicsymbols("x y phi u")
    g, alpha, k = sp.symbols("g alpha k")
    t = dynamicsymbols._t
    system = deltaq.System(
        sp.Matrix([x, y, phi]),
        (x.diff() ** 2 + y.diff() ** 2) / 2 + k**2 * phi.diff(t) ** 2 / 2 + g * x * sp.sin(alpha),
        sp.Matrix([y.diff() * sp.cos(phi) - x.diff() * sp.sin(phi)]),
        parameters={g: sledge.g, alpha: sledge.alpha, k: sledge.k},
        units={x: "m", "y": "m", phi: "rad"},
        start={x: 0, "y": sp.Integer(0), phi: sledge.phi0},
        velocities={phi.diff(): sledge.w, x.diff(): sp.cos(phi) / 2},
        removals={
            "arc-length": {
                "parameters": [u, phi],
                "rates": {x: u.diff() * sp.cos(phi), "y": u.diff() * sp.sin(phi)},
                "start": {u: 0},
                "constants": {"horizon": sledge.duration},
            }
        },
        duration=sp.Integer(10),
        name="sledge",
        title="Ice sledge on an incline",
    )
    assert system.to_toml() == sledge.system().to_toml()


def test_formulas_have_the_value_of_the_expression():
    a, t, third = sp.Symbol("a"), dynamicsymbols._t, sp.Rational(1, 3)
    expressions = [
        *(1 / x, x**-2, -(x**2), (x + 1) ** third, x**y, x ** (-y), (-x) ** 2, (x**2) ** y, 2 ** (x - y), x**y**a),
        *(sp.sqrt(x) / y, 1 / sp.sqrt(x + y), x / (y * (x + 1)), -third * x ** sp.Rational(-3, 2), a - (x - y) / (a - 3)),
        *(sp.exp(-x) / 3, sp.E + 2 * sp.pi * x / 3, sp.Float("0.1", 30) * x, 1e-7 * y + 9.81, sp.sqrt(2) * a, sp.Integer(-2) * x),
        *(sp.atan2(y, x), sp.sec(x) * sp.cot(y), sp.log(x**2 + 1), sp.asinh(x) * sp.acosh(1 + y) / sp.tanh(a), sp.sinh(x) ** 2),
        *(x.diff() * y.diff(t) ** 2, sp.Derivative(x * y * sp.sin(t), t), sp.Pow(sp.Pow(x, 2, evaluate=False), 3, evaluate=False)),
        sp.Mul(2, sp.Add(x, y, evaluate=False), sp.Pow(a, -1), evaluate=False),
    ]
    values = {x: 0.7, y: 1.3, a: 0.9, t: 0.4, x.diff(): -0.6, y.diff(): 0.8}
    rates = {sp.Derivative(c, t): values[sp.Derivative(c, t)] for c in (x, y)}
    given = dict(start={x: 1, y: 1}, velocities={x.diff(): 0, y.diff(): 0}, parameters={a: 0.9})
    for e in expressions:
        system = deltaq.System([x, y], (x.diff() ** 2 + y.diff() ** 2) / 2, forces={x: e}, **given)
        found = system.equations().acceleration(0.4, [0.7, 1.3], [-0.6, 0.8])[0]
        assert found == pytest.approx(float(e.doit().subs(rates).subs(values)), rel=1e-14), e


@pytest.mark.parametrize(
    "expression, error, words",
    [
        (abs(x), deltaq.SceneError, "`abs` is not differentiable"),
        (sp.sign(x), deltaq.SceneError, "`sign` is not differentiable"),
        (sp.Max(x, y), deltaq.SceneError, "`max` is not differentiable"),
        (sp.erf(x), deltaq.SceneError, "`erf`"),
        (sp.Piecewise((x, x > 0), (y, True)), TypeError, "no Piecewise"),
        (sp.I * x, TypeError, "no ImaginaryUnit"),
        (x + sp.oo * y, TypeError, "no NegativeInfinity"),
        (sp.Function("f")(x), TypeError, r"no f: `f\(x\(t\)\)`"),
        (sp.Derivative(sp.Function("f")(y), y), TypeError, "no Derivative"),
        (sp.Integral(sp.exp(-(x**2)) ** x, dynamicsymbols._t), TypeError, "no Integral"),
        (sp.Symbol(r"\omega_1") * x, ValueError, r"`\\omega_1` of SymPy cannot be a name"),
        (sp.Symbol("u'") * x, ValueError, "`u'` of SymPy cannot be a name"),
        (sp.Symbol("x") * x, ValueError, "stands for two symbols of SymPy"),
        (sp.Symbol("a") * sp.Symbol("a", real=True), ValueError, "stands for two symbols of SymPy"),
        (sp.Symbol("a") * x, deltaq.SceneError, "undefined name `a`"),
    ],
)
def test_what_is_no_formula_is_refused(expression, error, words):
    with pytest.raises(error, match=words):
        deltaq.System([x, y], x.diff() ** 2 + y.diff() ** 2 - expression, start={x: 1, y: 1}, velocities={"x'": 0, "y'": 0})


def test_wrong_arguments():
    with pytest.raises(TypeError, match="a LagrangesMethod, a KanesMethod or a System of SymPy is expected"):
        deltaq.from_sympy(test_kane5.KanesMethod, start={})
    with pytest.raises(TypeError, match="a string or an expression of SymPy is expected"):
        deltaq.System([x], sp.Matrix([x]), start={x: 0})
    with pytest.raises(TypeError, match="a list of strings or of expressions of SymPy is expected"):
        deltaq.System([x], x.diff() ** 2, x.diff(), start={x: 0})
    with pytest.raises(TypeError, match="missing 1 required keyword argument: 'start'"):
        deltaq.System([x], x.diff() ** 2)
    with pytest.raises(ValueError, match="`y` in start is not a coordinate"):
        deltaq.System([x], x.diff() ** 2, start={x: 0, y: 1})


def test_sympy_is_not_needed():
    code = "import sys; sys.modules['sympy'] = None; import deltaq; deltaq.System(['x'], \"x'^2/2\", start={'x': 0}, velocities={\"x'\": 1})"
    subprocess.run([sys.executable, "-B", "-c", code], check=True)
