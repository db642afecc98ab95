"""Motions against closed forms."""

import numpy as np
import pytest

import deltaq


def test_chetaev_sledge_turns_at_a_constant_rate(sledge, system):
    motion = system.solve("chetaev")
    t = motion.times
    assert motion.status == "completed" and motion.cause is None
    assert t.shape == (101,) and motion.coordinates.shape == (101, 3) and motion.velocities.shape == (101, 3)
    phi, speed = sledge.phi(t), sledge.speed(t)
    np.testing.assert_allclose(motion.coordinates[:, 2], phi, atol=1e-11)
    np.testing.assert_allclose(motion.velocities[:, 0], speed * np.cos(phi), atol=1e-10)
    np.testing.assert_allclose(motion.velocities[:, 1], speed * np.sin(phi), atol=1e-10)
    assert 0 <= motion.error_estimate < 1e-8 and motion.relative_error_estimate < 1e-9


def test_reaction_of_the_blade(sledge, system):
    # d/dt x' = g sin(alpha) - lambda sin(phi), and u' = g sin(alpha) cos(phi): lambda = u w + g sin(alpha) sin(phi)
    motion = system.solve()
    (name,) = motion.multipliers
    phi, speed = sledge.phi(motion.times), sledge.speed(motion.times)
    expected = speed * sledge.w + sledge.g * np.sin(sledge.alpha) * np.sin(phi)
    np.testing.assert_allclose(motion.multipliers[name], expected, atol=1e-9)


def off_the_constraint(coordinates, velocities):
    """The largest |y' cos(phi) - x' sin(phi)|; one row per time."""
    (_, _, phi), (x, y, _) = np.moveaxis(coordinates, -1, 0), np.moveaxis(velocities, -1, 0)
    return np.abs(y * np.cos(phi) - x * np.sin(phi)).max()


def test_projection_is_done_where_it_is_asked_for(system):
    loose = dict(form="multipliers", method="dop853", tolerance=1e-3)
    for formulation in ("chetaev", "vakonomic"):
        # where a step ends
        kept, free = (system.solve(formulation, [0.0, 10.0], project=project, **loose) for project in (True, False))
        assert kept.projection["count"] > 5 and free.projection["count"] == 0
        assert kept.projection["largest"] > 1e-9 and free.projection["largest"] == 0
        assert off_the_constraint(kept.coordinates, kept.velocities) < 1e-12
        assert off_the_constraint(free.coordinates, free.velocities) > 1e-7


def test_natural_constants(sledge, system):
    # P_x = g sin(alpha) (T - t)
    motion = system.solve("removed-constraint", [0.0, 5.0, 10.0])
    a = sledge.g * np.sin(sledge.alpha)
    np.testing.assert_allclose(motion.multipliers["P_x"], a * (10 - motion.times), atol=1e-8)
    assert motion.removal == "arc-length"
    np.testing.assert_allclose(motion.constants["P0_x"], a * 10, rtol=1e-12)
    assert system.solve("removed-constraint", constants="zero").constants["P0_x"] == 0
    horizon = system.solve("removed-constraint", [0, 1], constants={"horizon": 4})
    np.testing.assert_allclose(horizon.constants["P0_x"], a * 4, rtol=1e-10)
    given = system.solve("removed-constraint", [0, 1], constants=[2])
    assert given.constants == {"P0_x": 2.0}
    automatic = system.solve("removed-constraint", [0, 1], removal="coordinates", constants="zero")
    assert automatic.removal == "coordinates"


def test_multipliers_at_the_start(system):
    assert system.solve("vakonomic", [0, 1]).constants == {"mu0_1": 0.0}
    motion = system.solve("vakonomic", [0, 1], mu0=np.array([0.25]))
    # read off from costates
    assert motion.constants == {"mu0_1": 0.25} and abs(motion.multipliers["mu_1"][0] - 0.25) < 1e-15


@pytest.mark.parametrize("method", deltaq.METHODS)
def test_every_method(sledge, system, method):
    motion = system.solve(times=np.linspace(0, 1, 5), method=method, tolerance=1e-7)
    np.testing.assert_allclose(motion.coordinates[:, 2], sledge.phi(motion.times), atol=1e-4)
    assert (motion.work["jacobians"] > 0) == (method in ("bdf", "tr-bdf2", "esdirk34", "radau5"))


def test_reading_off(sledge, system):
    motion = system.solve()
    one, many = motion.at(2.5), motion.at([2.5, 3.0])
    assert one.coordinates.shape == (3,) and many.coordinates.shape == (2, 3)
    np.testing.assert_array_equal(one.coordinates, many.coordinates[0])
    assert isinstance(next(iter(one.multipliers.values())), float)
    assert next(iter(many.multipliers.values())).shape == (2,)
    for outside in (-1e-3, 10.001, [0, 11]):
        with pytest.raises(ValueError, match="outside of the motion"):
            motion.at(outside)
    with pytest.raises(ValueError, match="finite"):
        motion.at(np.nan)


def test_times_say_how_far(system):
    motion = system.solve(times=np.linspace(0, 20, 3))
    assert motion.end == 20.0 and motion.times.shape == (3,)
    assert system.solve(times=(0, 2)).end == 2.0
    assert system.solve(times=np.arange(3, dtype=np.int32)).end == 2.0
    with pytest.raises(ValueError, match="before the start"):
        system.solve(times=[-1, 1])
    with pytest.raises(ValueError, match="finite"):
        system.solve(times=[0, np.inf])


def test_energy_is_an_invariant_with_small_drift(system):
    motion = system.solve()
    assert motion.invariants
    for values in motion.invariants.values():
        assert np.ptp(values) < 1e-8


def test_charts_along_a_motion(system):
    motion = system.solve("removed-constraint", removal="coordinates", constants="zero")
    assert motion.status == "completed" and len(motion.charts) > 0
    # by x' and phi', then by canonical momenta where the blade nearly points along y
    [(t, by)] = motion.charts
    assert by == "canonical momenta" and abs(np.cos(motion.at(t).coordinates[2])) < 0.2
    assert system.solve().charts == []


def test_the_form_is_chosen_and_said(system):
    motion = system.solve()
    assert motion.form == ("chetaev-reduced", "the constraints are linear in the velocities")
    other = system.solve(form="multipliers")
    assert other.form == ("chetaev", "asked for")
    np.testing.assert_allclose(motion.coordinates, other.coordinates, atol=1e-9)
    assert motion.multipliers.keys() == other.multipliers.keys()
    for name, values in motion.multipliers.items():
        np.testing.assert_allclose(values, other.multipliers[name], atol=1e-8)
    with pytest.raises(ValueError, match="chetaev has no form `costates`"):
        system.solve(form="costates")


def test_the_method_is_chosen_and_said(system):
    assert system.solve().method == ("taylor", "the equations have Taylor series")
    assert system.solve(method="dop853").method == ("dop853", "asked for")


def test_a_motion_that_stops(sledge):
    # this chart ends where the blade points across the slope, phi = pi/2
    along_x = {"along-x": {"parameters": ["x", "phi"], "rates": {"y": "x'*tan(phi)"}}}
    system = sledge.system(lagrangian="(x'^2 + y'^2)/2 + phi'^2/4 + 4*x + y", removals=along_x, duration=30)
    motion = system.solve("removed-constraint")
    assert motion.status == "stopped" and motion.cause.startswith("stopped at t = ") and "cos(phi)" in motion.cause
    assert 0 < motion.end < 30 and motion.times[motion.reached - 1] <= motion.end < motion.times[motion.reached]
    assert len(motion.times) == len(motion.coordinates) == 101
    assert motion.at(motion.end).coordinates[2] == pytest.approx(np.pi / 2, abs=1e-2)


def test_limits_of_a_run(system):
    motion = system.solve(max_steps=5)
    assert motion.status == "stopped" and "more than 5 steps" in motion.cause
    motion = system.solve(time_limit=1e-9)
    assert motion.status == "stopped" and "time limit of 1e-9 s" in motion.cause and motion.end == 0
    run = system.equations().integrate([0, 10], time_limit=1e-9)
    assert run.status == "stopped" and "time limit" in run.cause
    members = system.ensemble(vary={"phi": [0, 1]}, time_limit=1e-9)
    assert members.status == ["stopped"] * 2 and all("time limit" in cause for cause in members.cause)
    assert system.solve(time_limit=600).status == "completed"
    assert 1000 <= system.equations().integrate([0, 10], max_step=0.01).work["steps"] < 1100
    assert system.ensemble(vary={"phi": [0, 1]}, max_step=0.01).status == ["completed"] * 2
    assert len(system.compare(max_step=0.1).pairs) > 0
    with pytest.raises(ValueError, match="max_step"):
        system.solve(max_step=0)
    for wrong in (0, -1, np.nan):
        with pytest.raises(ValueError, match="time_limit"):
            system.solve(time_limit=wrong)


def test_each_coordinate_has_its_error(sledge, system):
    motion = system.solve(tolerance=1e-6)
    errors = motion.coordinate_error_estimates
    assert errors.shape == motion.coordinates.shape and (np.diff(errors, axis=0) >= 0).all()
    phi = np.abs(motion.coordinates[:, 2] - sledge.phi(motion.times))
    assert (phi <= errors[:, 2] + 1e-13).all() and 0 < errors[-1, 0] < 1e-4
    rates = motion.velocity_error_estimates
    assert rates.shape == motion.velocities.shape and (np.diff(rates, axis=0) >= 0).all()
    turning = sledge.phi(1.0) - sledge.phi(0.0)
    assert (np.abs(motion.velocities[:, 2] - turning) <= rates[:, 2] + 1e-12).all()
    (name,) = motion.multipliers
    reaction = motion.multiplier_error_estimates[name]
    assert reaction.shape == motion.times.shape and 0 < reaction[-1] < 1e-3


def test_one_wrong_coordinate_is_not_trusted():
    # z has hardly any inertia, so that the kinetic metric does not see what becomes of it
    system = deltaq.System(["x", "z"], "x'^2/2 + 1e-18*(z'^2 - 1600*z^2)/2", start={"x": 0, "z": 1e-9}, velocities={"x'": 1, "z'": 1}, duration=2)
    motion = system.solve(tolerance=1e-3, method="dop853")
    relative = motion.coordinate_error_estimates[-1, 1] / np.abs(motion.coordinates[:, 1]).max()
    assert motion.relative_error_estimate < 1e-6 and relative > 1e-3
    assert motion.status == "untrusted" and "of z" in motion.cause
