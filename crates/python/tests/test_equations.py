"""Equations as functions of arrays."""

import numpy as np
import pytest

import deltaq


def test_names_and_texts(system):
    equations = system.equations()
    assert equations.formulation == "chetaev" and equations.removal is None
    assert equations.states == ["x", "y", "phi", "x'", "y'", "phi'"] and equations.constants == []
    assert "lambda_1" in equations.text and str(equations) == equations.text
    assert equations.latex.startswith(r"\begin{aligned}") and r"\lambda" in equations.latex
    assert system.equations("vakonomic").constants == ["mu0_1"]
    assert system.equations("removed-constraint").removal == "arc-length"


def test_rates_of_the_sledge(sledge, system):
    equations = system.equations()
    y = equations.initial_state()
    np.testing.assert_allclose(y[[2, 5]], [sledge.phi0, sledge.w])
    rates = equations.rates(0.0, y)
    phi, u, a = sledge.phi0, sledge.u0, sledge.g * np.sin(sledge.alpha)
    # u' = a cos(phi) along the blade, u w across it
    along, across = a * np.cos(phi), u * sledge.w
    expected = [along * np.cos(phi) - across * np.sin(phi), along * np.sin(phi) + across * np.cos(phi), 0.0]
    np.testing.assert_allclose(rates[:3], y[3:], rtol=1e-15)
    np.testing.assert_allclose(rates[3:], expected, atol=1e-14)
    np.testing.assert_allclose(equations.acceleration(0, y[:3], y[3:]), expected, atol=1e-14)


def in_every_formulation(sledge):
    of_laws = {"kappa": 0.5, "epsilon": 0.1}
    return sledge.system(
        parameters={"g": sledge.g, "alpha": sledge.alpha, "k": sledge.k, **of_laws},
        virtual=["y'*cos(phi) - x'*sin(phi) - phi'/4"],
    )


@pytest.mark.parametrize("formulation", deltaq.FORMULATIONS)
def test_shapes(sledge, formulation):
    equations = in_every_formulation(sledge).equations(formulation)
    y = equations.initial_state()
    m = len(equations.states)
    assert y.shape == (m,) and y.dtype == np.float64
    rows = y + 0.01 * np.arange(4)[:, None]
    t = np.linspace(0, 1, 4)
    many = equations.rates(t, rows)
    assert many.shape == (4, m) and equations.rates(0.5, rows).shape == (4, m)
    for i in range(4):
        np.testing.assert_array_equal(many[i], equations.rates(t[i], rows[i]))
    np.testing.assert_array_equal(many, equations.rates(t, np.asfortranarray(rows)))
    np.testing.assert_array_equal(many, equations.rates(list(t), rows.tolist()))
    assert equations.jacobian(0, y).shape == (m, m) and equations.jacobian(t, rows).shape == (4, m, m)
    outputs = equations.outputs(t, rows)
    assert outputs.coordinates.shape == outputs.velocities.shape == (4, 3)
    assert equations.rates(0, rows[:0]).shape == (0, m)


@pytest.mark.parametrize("formulation", deltaq.FORMULATIONS)
def test_jacobian_against_differences(sledge, formulation):
    multipliers = "vakonomic" in formulation or formulation == "kappa"
    equations = in_every_formulation(sledge).equations(formulation, mu0=[0.3] if multipliers else None)
    y = equations.initial_state()
    step = 1e-6
    rows = np.concatenate([y + step * np.eye(len(y)), y - step * np.eye(len(y))])
    plus, minus = np.split(equations.rates(0, rows), 2)
    np.testing.assert_allclose(equations.jacobian(0, y), ((plus - minus) / (2 * step)).T, atol=1e-6)


def test_initial_states_of_free_constants(system):
    equations = system.equations("vakonomic", mu0=[0.5])
    place = equations.states.index("mu_1")
    assert equations.initial_state()[place] == 0.5
    assert equations.initial_state("zero")[place] == 0.0
    assert equations.initial_state(constants=[-2])[place] == -2.0
    removed = system.equations("removed-constraint")
    assert removed.initial_state()[removed.states.index("P_x")] == 0.0
    natural = removed.initial_state({"horizon": 10})[removed.states.index("P_x")]
    assert natural == pytest.approx(38.201939380478535, rel=1e-12)  # g sin(alpha) T


def test_a_motion_of_our_own(sledge, system):
    # the classical Runge-Kutta method on the rates: phi = phi0 + w t
    equations = system.equations()
    t, y, h = 0.0, equations.initial_state(), 1e-3
    for _ in range(1000):
        a = equations.rates(t, y)
        b = equations.rates(t + h / 2, y + h / 2 * a)
        c = equations.rates(t + h / 2, y + h / 2 * b)
        d = equations.rates(t + h, y + h * c)
        t, y = t + h, y + h / 6 * (a + 2 * b + 2 * c + d)
    np.testing.assert_allclose(y[2], sledge.phi(1.0), atol=1e-12)
    np.testing.assert_allclose(np.hypot(y[3], y[4]), sledge.speed(1.0), atol=1e-10)
    outputs = equations.outputs(t, y)
    residual = system.constraint(t, outputs.coordinates, outputs.velocities)
    assert residual.shape == (1,) and abs(residual[0]) < 1e-10


@pytest.mark.parametrize("method", deltaq.METHODS)
def test_single_runs(sledge, system, method):
    equations = system.equations("chetaev")
    times = np.linspace(0, 10, 21)
    tolerance = 1e-6 if method in ("tr-bdf2", "esdirk34") else 1e-9
    run = equations.integrate(times, method=method, tolerance=tolerance)
    assert run.status == "completed" and run.cause is None and run.work["steps"] > 0 and run.seconds > 0
    np.testing.assert_array_equal(run.times, times)
    outputs = equations.outputs(run.times, run.states)
    np.testing.assert_allclose(outputs.coordinates[:, 2], sledge.phi(times), atol=1e3 * tolerance)
    np.testing.assert_allclose(np.hypot(*outputs.velocities[:, :2].T), np.abs(sledge.speed(times)), atol=1e4 * tolerance)
    # at its ends alone
    ends = equations.integrate([0, 10], method=method, tolerance=tolerance)
    np.testing.assert_array_equal(ends.states[0], run.states[0])
    np.testing.assert_allclose(ends.states[1], run.states[-1], atol=1e4 * tolerance)


def test_the_method_that_is_asked_for_is_the_one_that_runs(system):
    work = {method: system.equations().integrate([1], method=method).work for method in ("taylor", "dop853", "radau5")}
    assert [name for name, done in work.items() if done["orders"]] == ["taylor"]
    assert [name for name, done in work.items() if done["jacobians"]] == ["radau5"]


def test_single_runs_that_stop(system):
    run = system.equations().integrate([0, 0.001, 10], max_steps=3)
    assert run.status == "stopped" and "3" in run.cause and len(run.times) == len(run.states) == 3 > run.reached
    with pytest.raises(ValueError, match="ascending"):
        system.equations().integrate([2, 1])
    with pytest.raises(ValueError, match="unknown method"):
        system.equations().integrate([1], method="euler")
    with pytest.raises(deltaq.CallError):
        system.equations().integrate([1], tolerance=0)


def test_mass_matrices(sledge, system):
    q, v = np.zeros((5, 3)), np.ones((5, 3))
    np.testing.assert_allclose(system.mass(0, q, v), np.tile(np.diag([1, 1, sledge.k**2]), (5, 1, 1)), atol=1e-15)
    assert system.mass(0, q[0], v[0]).shape == (3, 3)


def test_constraint_residuals(system):
    q, v = np.zeros((5, 3)), np.ones((5, 3))
    np.testing.assert_array_equal(system.constraint(0, q, v), np.ones((5, 1)))
    assert system.constraint(0.0, system.start.q, system.start.v) == pytest.approx([0.0], abs=1e-15)


def test_accelerations(system):
    start = system.start
    vakonomic = system.equations("vakonomic")
    y = vakonomic.initial_state([0.7])
    expected = vakonomic.rates(0, y)[3:6]
    np.testing.assert_array_equal(vakonomic.acceleration(0, start.q, start.v, mu=[0.7]), expected)
    with pytest.raises(ValueError, match="mu"):
        vakonomic.acceleration(0, start.q, start.v)
    with pytest.raises(ValueError, match="use rates"):
        system.equations("vakonomic-costate").acceleration(0, start.q, start.v)
    with pytest.raises(ValueError, match="2 entries"):
        system.equations().acceleration(0, [0, 0], start.v)


def test_wrong_shapes(system):
    equations = system.equations()
    y = equations.initial_state()
    with pytest.raises(ValueError, match=r"y has shape \[5\]"):
        equations.rates(0, y[:5])
    with pytest.raises(ValueError, match="y has 2 rows, t has 3"):
        equations.rates([0, 1, 2], [y, y])
    with pytest.raises(ValueError, match="single row"):
        equations.rates([0, 1, 2], y)
    with pytest.raises(ValueError, match="finite"):
        equations.rates(0, np.full(6, np.nan))
    with pytest.raises(ValueError, match="string"):
        equations.rates(0, "y")
    with pytest.raises(TypeError):
        equations.rates(0, object())


def test_singular_equations():
    # two blades at a right angle are one constraint too many where both are parallel, at psi = 0
    system = deltaq.System(
        ["x", "y", "psi"],
        "(x'^2 + y'^2 + psi'^2)/2",
        ["x'*psi - y'"],
        start={"x": 0, "y": 0, "psi": 1},
        velocities={"x'": 1, "psi'": 0},
    )
    assert system.equations().rates(0, [0, 0, 1, 1, 1, 0]).shape == (6,)
    heavy = deltaq.System(["x"], "x^2*x'^2/2", start={"x": 1}, velocities={"x'": 1})
    with pytest.raises(deltaq.EvaluationError, match="singular"):
        heavy.equations().rates(0, [0, 1])
