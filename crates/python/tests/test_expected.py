"""What people expect who come from SciPy, pandas and SymPy: where runs start, numbers of a call, columns by name, typed answers."""

import pickle

import deltaq
import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    PinJoint,
    Point,
    PrismaticJoint,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)
from sympy.physics.mechanics import System as SymPySystem
from sympy.physics.mechanics.tests import test_linearize

from test_sympy import function, names_of

# a force that depends on time, and on one that a controller sets
PUSHED = deltaq.System(
    ["x"], "x'^2/2 - x^2/2", forces={"x": "cos(3*t) + u"}, parameters={"u": 0.0}, start={"x": 0.2}, velocities={"x'": 0}, duration=3.0
)


def pushed(t):
    """x'' + x = cos(3 t) from (0.2, 0): x = 0.2 cos t + (cos t - cos 3t)/8."""
    return 0.2 * np.cos(t) + (np.cos(t) - np.cos(3 * t)) / 8


def test_a_run_in_pieces_is_the_run_in_one():
    equations, times = PUSHED.equations(), np.linspace(0, 3, 7)
    whole = equations.integrate(times, y0=equations.initial_state())
    np.testing.assert_allclose(whole.states[:, 0], pushed(times), atol=1e-10)
    np.testing.assert_array_equal(whole.states, equations.integrate(times).states)
    y = equations.initial_state()
    for first, last in zip(times, times[1:]):
        y = equations.integrate([first, last], y0=y).states[-1]
    np.testing.assert_allclose(y, whole.states[-1], atol=1e-10)
    # y0 elsewhere than at the first of times, or before the start of the system
    later = equations.integrate([2.0, 3.0], y0=whole.states[2], t0=1.0)
    np.testing.assert_allclose(later.states, whole.states[[4, 6]], atol=1e-10)
    np.testing.assert_allclose(equations.integrate(3.0, y0=whole.states[2], t0=1.0).states, whole.states[6], atol=1e-10)
    back = equations.integrate([-1.0, 0.0], y0=[pushed(-1.0), -pushed(-1.0)])
    assert back.status == "completed" and back.times[0] == -1
    # the next call starts with the system again
    np.testing.assert_array_equal(equations.integrate(times).states, whole.states)


@pytest.mark.parametrize("formulation", ["chetaev", "vakonomic", "removed-constraint"])
def test_every_formulation_goes_on(formulation):
    equations, times = deltaq.built_in("sledge").equations(formulation), np.linspace(0, 1, 5)
    whole = equations.integrate(times)
    rest = equations.integrate(times[2:], y0=whole.states[2])
    np.testing.assert_allclose(rest.states, whole.states[2:], rtol=1e-9, atol=1e-9)


def test_a_controller_at_100_hertz():
    """The torque is held for 10 ms: exact from sample to sample, as x'' + x is linear."""
    equations, y, exact = PUSHED.equations(), np.array([0.2, 0.0]), np.array([0.2, 0.0])
    for i in range(100):
        t, u = i / 100, -0.5 * np.sign(y[1])
        y = equations.integrate([t, t + 0.01], y0=y, parameters={"u": u}).states[-1]
        # deviation from the forced motion -cos(3 t)/8 + u
        c, s = np.cos(0.01), np.sin(0.01)
        forced = lambda t: np.array([-np.cos(3 * t) / 8 + u, 3 * np.sin(3 * t) / 8])
        exact = np.array([[c, s], [-s, c]]) @ (exact - forced(t)) + forced(t + 0.01)
    np.testing.assert_allclose(y, exact, atol=1e-10)


def test_what_integrate_refuses():
    equations = PUSHED.equations()
    y = equations.initial_state()
    for words, call in {
        "no later one follows; give t0": lambda: equations.integrate([1.0], y0=y),
        "t = 2, and no later one": lambda: equations.integrate(2.0, y0=y),
        "t0 is the time of y0; without y0": lambda: equations.integrate([1.0], t0=0.5),
        "times is empty": lambda: equations.integrate([], y0=y),
        "before the start 1": lambda: equations.integrate([0.5, 2.0], y0=y, t0=1.0),
        "times ends at 1; after t0 = 1": lambda: equations.integrate([1.0], y0=y, t0=1.0),
        "t0 is NaN": lambda: equations.integrate([1.0], y0=y, t0=np.nan),
    }.items():
        with pytest.raises(ValueError, match=words):
            call()


def test_numbers_of_a_call(system):
    motion = system.solve("chetaev", [0.0, 1.0], parameters={"g": 1.6}, start={"phi": 0.1, "phi'": 2})
    other = system.replace({"g": 1.6, "phi": 0.1, "phi'": 2})
    assert motion.system == other and motion.system.parameters["g"] == 1.6
    np.testing.assert_array_equal(motion.coordinates, other.solve("chetaev", [0.0, 1.0]).coordinates)
    assert system.equations().parameters == system.parameters
    for words, call in {
        "unknown parameter `phi`; known: ": lambda: system.solve(parameters={"phi": 1}),
        "unknown start value `g`; known: x, y, phi, x', y', phi'": lambda: system.solve(start={"g": 1}),
    }.items():
        with pytest.raises(deltaq.UnknownNameError, match=words):
            call()
    # free constants stay where parameters are inputs of a call
    equations = system.equations("removed-constraint", constants=[0.3])
    y = equations.initial_state()
    np.testing.assert_allclose(equations.rates(0.1, y, {"g": system.parameters["g"]}), equations.rates(0.1, y), rtol=1e-12, atol=1e-13)


def test_systems_are_equal_if_they_say_the_same(system):
    assert system == system.replace() == system.replace(g=system.parameters["g"]) == pickle.loads(pickle.dumps(system))
    assert system == deltaq.parse(system.to_toml()) and hash(system) == hash(system.replace({}))
    assert system.replace(g=1.6) == system.replace({"g": 1.6}) != system and system != "sledge" and system != system.replace({"phi'": 0})
    assert len({system, system.replace(), system.replace(g=1)}) == 2
    with pytest.raises(TypeError, match="g is given twice"):
        system.replace({"g": 1}, g=2)
    with pytest.raises(deltaq.UnknownNameError):
        system.replace(nothing=1)


def test_one_time_is_a_number(system):
    motion, many = system.solve("vakonomic", 1.0), system.ensemble("chetaev", 1.0, vary={"g": [1.0, 2.0]})
    of = system.solve("vakonomic", [1.0])
    assert motion.coordinates.shape == motion.coordinate_error_estimates.shape == (3,) and np.ndim(motion.times) == 0
    np.testing.assert_array_equal(motion.coordinates, of.coordinates[0])
    assert motion["mu_1"] == of["mu_1"][0] and isinstance(motion.multipliers["mu_1"], float)
    assert many.coordinates.shape == (2, 3) and many["phi"].shape == (2,) and many.multipliers["lambda_1"].shape == (2,)
    for table in (motion.to_pandas(), motion.to_arrow(), many.to_pandas()):
        assert len(table) in (1, 2)
    assert motion.to_xarray().sizes == {"t": 1} and many.to_xarray().sizes == {"member": 2, "t": 1}
    assert "t = 1" in motion._repr_html_() and len(motion) == 1 and [s.t for s in motion] == [1.0]
    motion.plot(), many.plot()
    again = pickle.loads(pickle.dumps(motion))
    np.testing.assert_array_equal(again.at(0.5).coordinates, motion.at(0.5).coordinates)
    short = system.solve("chetaev", 5.0, max_steps=1, method="dop853")
    assert short.reached == 0 and np.isnan(short.coordinates).all() and np.isnan(short["lambda_1"])


def test_columns_instants_and_slices(system):
    motion = system.solve("vakonomic", np.linspace(0, 2, 21), sensitivities=["g"])
    for name, values in {"phi": motion.coordinates[:, 2], "phi'": motion.velocities[:, 2], "mu_1": motion.multipliers["mu_1"], "energy": motion.invariants["energy"], "t": motion.times}.items():
        np.testing.assert_array_equal(motion[name], values)
        assert name in motion
    assert "psi" not in motion and len(motion) == 21
    with pytest.raises(deltaq.UnknownNameError, match="unknown column 'psi'; known: t, x, y, phi, x'"):
        motion["psi"]
    states = list(motion)
    assert [s.t for s in states] == motion.times.tolist() and (states[3].q == motion.coordinates[3]).all() and (states[3].v == motion.velocities[3]).all()
    part = motion[0.5:1.0]
    np.testing.assert_array_equal(part.times, motion.times[5:11])
    np.testing.assert_array_equal(part["phi"], motion["phi"][5:11])
    np.testing.assert_array_equal(part.sensitivities["g"].coordinates, motion.sensitivities["g"].coordinates[5:11])
    np.testing.assert_array_equal(part.at(1.7).coordinates, motion.at(1.7).coordinates)
    assert part.reached == 6 and motion[::10].times.tolist() == [0, 1, 2] and len(motion[0:1]) == 11 and len(motion[5:]) == 0
    for wrong in (3, 2.0, None):
        with pytest.raises(TypeError, match="not a column's name, and not a slice of times"):
            motion[wrong]
    with pytest.raises(ValueError, match="the step -1 of a slice"):
        motion[::-1]
    stopped = deltaq.System(["x"], "x'^2/2 - 1/x", start={"x": 1}, velocities={"x'": 0}).solve(times=[0, 0.5, 1.0], max_steps=3, method="dop853")
    assert stopped.reached < 3 and len(list(stopped)) == stopped.reached == stopped[0:].reached
    many = system.ensemble("chetaev", [0.5, 1.0], vary={"g": [1.0, 2.0, 3.0]})
    assert many["phi"].shape == (3, 2) and "lambda_1" in many


def test_the_modules_own_tables_are_films():
    system = deltaq.built_in("sledge")
    system = deltaq.parse(system.to_toml() + '\n[observables]\nspeed = "sqrt(x\'^2 + y\'^2)"\n')
    motion = system.solve("vakonomic", np.linspace(0, 1, 11), parameters={"g": 9.7}, start={"phi'": 0.9})
    unnamed = motion.to_pandas().rename_axis(None)
    asked = system.residuals(["g", "phi'"], motion.times, {"x": motion["x"]}, "vakonomic")
    for table in (motion, motion.to_pandas(), motion.to_xarray(), motion.to_arrow(), unnamed, motion.to_pandas().reset_index()):
        for miss in (system.residuals(["g", "phi'"], table, formulation="vakonomic"), system.residuals(["g", "phi'"], data=table, formulation="vakonomic")):
            assert miss.columns == ["x", "y", "phi", "x'", "y'", "phi'", "mu_1"] and len(miss) == 77
            assert abs(miss([9.7, 0.9])).max() < 1e-9 and abs(miss([9.8, 0.9])).max() > 1e-3
        np.testing.assert_array_equal(miss([9.81, 1.1])[:11], asked([9.81, 1.1]))
    film = motion.to_pandas() + 1e-3 * np.random.default_rng(3).normal(size=(11, 10))
    found = [system.fit(table, free=["g", "phi'"], sigma=1e-3, formulations=["vakonomic"]).best.estimates["g"].value for table in (film, film.reset_index())]
    assert found[0] == found[1] and abs(found[0] - 9.7) < 0.2
    with pytest.raises(ValueError, match="the data have no column t, and no times are given; there are x"):
        system.residuals(["g"], motion.to_pandas()[["x"]].reset_index(drop=True))
    with pytest.raises(TypeError, match="residuals needs data"):
        system.residuals(["g"])
    with pytest.raises(deltaq.UnknownNameError, match="unknown column `psi`"):
        system.residuals(["g"], motion.times, {"psi": motion["x"]})


def test_answers_have_types_and_are_mappings():
    integrals = deltaq.built_in("sledge").integrals(degree=1)
    assert integrals.scene == integrals["scene"] == "sledge" and integrals.measure.answer == integrals["measure"]["answer"] == "local"
    assert [p.degree for p in integrals.polynomials] == [1] and integrals.ansatz.printed[0].expression == "phi'" and integrals.measure.reason is None
    assert integrals == dict(integrals) and "polynomials" in integrals and "<deltaq.Integrals scene='sledge'" in repr(integrals)
    design = deltaq.built_in("heisenberg").design(("vakonomic", "chetaev"), film="20Hz,1mm,1s", over={"mu0_1": (0.1, 1)}, free=["x'", "y'"], points=2)
    assert design.best.at == tuple(design["best"]["at"]) and design.best.numbers == {own["name"]: own["value"] for own in design["best"]["numbers"]}
    assert design.chosen[0].name == "mu0_1" and design.columns[0].sigma == 1e-3 and design.estimate is None
    again = pickle.loads(pickle.dumps(design))
    assert again == design and again.best.value == design.best.value


def test_extents_of_a_comparison():
    sledge = deltaq.built_in("sledge").replace(duration=1)
    answer, everything, gaps = sledge.compare(), sledge.compare(extent="everything"), sledge.compare(extent="gaps")
    assert [(d.family, d.motion) for d in answer.decided] == [("vakonomic", "chetaev")] and len(everything.decided) > 1 and not gaps.decided
    assert [run.label for run in answer.runs][:4] == ["chetaev", "vakonomic", "vakonomic-costate", "removed-constraint:arc-length"]
    assert sum(p.growth is not None for p in answer.pairs) == 1 < sum(p.growth is not None for p in everything.pairs)
    assert all(p.growth is None and p.predicted is None for p in gaps.pairs)
    for other in (everything, gaps):
        assert [(p.first, p.second, p.largest_gap) for p in other.pairs] == [(p.first, p.second, p.largest_gap) for p in answer.pairs]
    undecided = sledge.compare(decision=False)
    assert not undecided.decided and not undecided.fits and undecided.pair("Chetaev", "vakonomic").growth is not None
    two = sledge.compare(["vakonomic", "chetaev"])
    assert [run.label for run in two.runs] == ["chetaev", "vakonomic"] and two.verdict("chetaev", "vakonomic") == "different"
    with pytest.raises(ValueError, match="unknown extent `all`; known: answer, everything, gaps"):
        sledge.compare(extent="all")
    swept = deltaq.sweep(sledge, {"k": [0.5, 1.0]}, decision=False).to_arrow().to_pydict()
    assert swept["answer"] == ["", ""] and swept["verdict"] == ["different"] * 2 and swept["mismatch"] == [None, None]
    assert swept["apart"] == deltaq.sweep(sledge, {"k": [0.5, 1.0]}).to_arrow()["apart"].to_pylist()


def test_kane_with_generalized_speeds():
    """A rolling disc by six coordinates and six speeds, of SymPy's tests: accelerations agree at random states on the constraints."""
    s = names_of(test_linearize, "test_linearize_rolling_disc_kane", "# Test generalized form")
    kane, random = s["KM"], np.random.default_rng(1)
    q, u, rates = list(kane.q), list(kane.u), [c.diff() for c in kane.q]
    symbols = sorted(kane.mass_matrix_full.free_symbols | kane.forcing_full.free_symbols, key=str)
    parameters = {name: random.uniform(0.5, 1.5) for name in symbols if name != dynamicsymbols._t}
    at = random.uniform(-0.5, 0.5, (100, 6)) + 0.1
    p = np.full((100, len(parameters)), list(parameters.values()))
    system = deltaq.from_sympy(kane, parameters=parameters, start=dict(zip(q, at[0])), velocities=dict.fromkeys(rates, 1), project=True)
    assert system.coordinates == [c.name for c in q] and len(system.constraints) == 3
    matrix, right = sp.linear_eq_to_matrix([rate - e for rate, e in kane.kindiffdict().items()], u)
    speeds = matrix.LUsolve(right)
    to_rates, to_speeds = (function([*parameters, *q, *own], m) for own, m in ((u, sp.Matrix([kane.kindiffdict()[c] for c in rates])), (rates, speeds)))
    slips = function([*parameters, *q, *u], kane._k_nh)
    speed = random.uniform(-1, 1, (100, 6))
    speed -= (np.linalg.pinv(slips(p, at, speed)) @ slips(p, at, speed) @ speed[..., None])[..., 0]
    v = to_rates(p, at, speed)[..., 0]
    np.testing.assert_allclose(system.constraint(0, at, v), 0, atol=1e-12)
    np.testing.assert_allclose(to_speeds(p, at, v)[..., 0], speed, atol=1e-12)
    mass, forcing = (function([*parameters, *q, *u], m)(p, at, speed) for m in (kane.mass_matrix_full, kane.forcing_full))
    change = np.linalg.solve(mass, forcing)[..., 0]
    made = sp.Matrix([kane.kindiffdict()[c] for c in rates])
    by_q, by_u = (function([*parameters, *q, *u], made.jacobian(own))(p, at, speed) for own in (q, u))
    expected = (by_q @ v[..., None] + by_u @ change[:, 6:, None])[..., 0]
    found = system.equations("chetaev").rates(0, np.concatenate([at, v], axis=1))[:, 6:]
    assert (abs(found - expected).max(axis=1) / abs(expected).max(axis=1)).max() < 1e-11


def test_a_system_of_joints():
    """A cart with a pendulum, by SymPy's joints: speeds, gravity and a spring as potential energy."""
    q1, q2, u1, u2 = dynamicsymbols("q1 q2 u1 u2")
    m1, m2, g, l, k = sp.symbols("m1 m2 g l k")
    wall, cart, bob = RigidBody("wall"), RigidBody("cart", mass=m1), RigidBody("bob", mass=m2)
    whole = SymPySystem.from_newtonian(wall)
    bob.central_inertia = inertia(bob.frame, 0, 0, 0)
    slide, pin = PrismaticJoint("J1", wall, cart, q1, u1), PinJoint("J2", cart, bob, q2, u2, child_point=l * bob.frame.y, joint_axis=cart.frame.z)
    whole.add_joints(slide, pin)
    whole.apply_uniform_gravity(-g * whole.y)
    cart.potential_energy = k * q1**2 / 2
    whole.add_loads((cart.masscenter, -u1 * whole.x / 3))
    values = {m1: 2.0, m2: 1.0, g: 9.81, l: 0.5, k: 3.0}
    found = deltaq.from_sympy(whole, parameters=values, start={q1: 0.3, q2: 0.2}, velocities={q1.diff(): 0.4, q2.diff(): 0.1})
    # by hand: a point mass at (q1 + l sin(q2), -l cos(q2))
    by_hand = deltaq.System(
        ["q1", "q2"],
        "m1*q1'^2/2 + m2*(q1'^2 + 2*l*q1'*q2'*cos(q2) + l^2*q2'^2)/2 + m2*g*l*cos(q2) - k*q1^2/2",
        forces={"q1": "-q1'/3"},
        parameters={str(name): value for name, value in values.items()},
        start={"q1": 0.3, "q2": 0.2},
        velocities={"q1'": 0.4, "q2'": 0.1},
    )
    for q, v in (([0.3, 0.2], [0.4, 0.1]), ([-0.5, 1.1], [0.7, -0.9])):
        np.testing.assert_allclose(found.equations().acceleration(0, q, v), by_hand.equations().acceleration(0, q, v), rtol=1e-12)


def test_velocities_with_a_constraint_put_in_are_refused():
    """A disc that rolls, its centre's velocity taken from the contact: Lagrange's equations of that energy would be wrong."""
    q1, q2, q3, u1, u2, u3 = dynamicsymbols("q1 q2 q3 u1 u2 u3")
    m, r = sp.symbols("m r")
    space = ReferenceFrame("N")
    yaw = space.orientnew("Y", "Axis", [q1, space.z])
    lean = yaw.orientnew("L", "Axis", [q2, yaw.x])
    frame = lean.orientnew("R", "Axis", [q3, lean.y])
    rates = [q1.diff() - u1, q2.diff() - u2, q3.diff() - u3]
    contact = Point("C")
    contact.set_vel(space, 0)
    centre = contact.locatenew("G", r * lean.z)
    centre.v2pt_theory(contact, space, frame)
    disc = RigidBody("B", centre, frame, m, (inertia(lean, m * r**2 / 4, m * r**2 / 2, m * r**2 / 4), centre))
    kane = KanesMethod(space, [q1, q2, q3], [u1, u2, u3], kd_eqs=rates, bodies=[disc], forcelist=[(centre, -m * space.z)])
    with pytest.raises(TypeError, match="the velocity of the point G is not the rate of a place .* a constraint was put into it"):
        deltaq.from_sympy(kane, start={}, parameters={m: 1, r: 1})
    fewer = KanesMethod(space, [q1, q2, q3], [u1, u2], kd_eqs=[q1.diff() - u1, q2.diff() - u2, q3.diff() - u1], bodies=[disc])
    with pytest.raises(TypeError, match="3 coordinates have 2 generalized speeds"):
        deltaq.from_sympy(fewer, start={})
    with pytest.raises(TypeError, match="the KanesMethod has no bodies"):
        deltaq.from_sympy(KanesMethod(space, [q1], [u1], kd_eqs=[q1.diff() - u1]), start={})
