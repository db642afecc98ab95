"""Many motions at once: each is the motion of a system of its own."""

import numpy as np
import pytest

import deltaq


def test_members_against_the_closed_form(sledge, system):
    phi, w = np.linspace(-1, 1, 19), np.linspace(0.2, 2, 19)
    times = np.linspace(0, 10, 6)
    # the constraint supplies y'
    many = system.ensemble("chetaev", times, vary={"phi": phi, "phi'": w})
    assert len(many) == 19 and many.coordinates.shape == (19, 6, 3) and many.velocities.shape == (19, 6, 3)
    assert many.status == ["completed"] * 19 and many.cause == [None] * 19 and many.reached == [6] * 19
    np.testing.assert_array_equal(many.varied["phi"], phi)
    turned = phi[:, None] + w[:, None] * times
    speed = sledge.u0 + sledge.g * np.sin(sledge.alpha) / w[:, None] * (np.sin(turned) - np.sin(phi[:, None]))
    np.testing.assert_allclose(many.coordinates[:, :, 2], turned, atol=1e-11)
    np.testing.assert_allclose(many.velocities[:, :, 0], speed * np.cos(turned), atol=1e-9)
    assert (many.error_estimate < 1e-8).all() and (many.relative_error_estimate < 1e-8).all()
    (name,) = many.multipliers
    assert many.multipliers[name].shape == (19, 6)
    assert np.ptp(many.invariants["energy"], axis=1).max() < 1e-9


def test_members_that_run_once(system):
    twice, once = (system.ensemble("chetaev", [10], vary={"phi": [0.1, 0.3]}, estimate=estimate) for estimate in (True, False))
    assert np.isfinite(twice.error_estimate).all() and np.isnan(once.error_estimate).all()
    assert once.status == ["completed"] * 2 and once.seconds > 0
    np.testing.assert_allclose(once.coordinates, twice.coordinates, atol=1e-8)


@pytest.mark.parametrize("formulation", ["vakonomic", "chetaev"])
def test_parameters_against_single_motions(sledge, system, formulation):
    values = {"g": [9.81, 3.7, 1.6], "k": [0.7, 0.9, 0.5]}
    many = system.ensemble(formulation, [1.0, 4.0], vary=values)
    for i in range(3):
        parameters = {"g": values["g"][i], "alpha": sledge.alpha, "k": values["k"][i]}
        motion = sledge.system(parameters=parameters).solve(formulation, [1.0, 4.0])
        np.testing.assert_allclose(many.coordinates[i], motion.coordinates, atol=1e-8)
        for name, column in motion.multipliers.items():
            np.testing.assert_allclose(many.multipliers[name][i], column, atol=1e-7)


def test_free_constants(system):
    varied = system.ensemble("vakonomic", [0, 3], vary={"mu0_1": [-0.2, 0.3]})
    np.testing.assert_allclose(varied.multipliers["mu_1"][:, 0], [-0.2, 0.3], rtol=1e-15)
    given = system.ensemble("vakonomic", [0, 3], vary={"k": [0.7, 0.7]}, mu0=[0.3])
    # what varies is not put into the expressions: other round-off
    np.testing.assert_allclose(given.coordinates[1], varied.coordinates[1], atol=1e-12)
    natural = system.ensemble("removed-constraint", [10], vary={"phi": [0.1, 0.3]})
    assert natural.removal == "arc-length"
    np.testing.assert_allclose(natural.multipliers["P_x"], 0, atol=1e-8)


def test_systems_that_were_read_with_overrides_keep_them(system):
    read = deltaq.parse(system.to_toml(), {"g": 1.6})
    many = read.ensemble(times=[2.0], vary={"k": [0.7]})
    np.testing.assert_allclose(many.coordinates[0], read.solve(times=[2.0]).coordinates, atol=1e-9)


def test_members_that_stop_are_told_apart():
    # u' = b u^2, u = u0/(1 - b u0 t)
    system = deltaq.System(
        coordinates=["x", "y"], lagrangian="(x'^2 + y'^2)/2", constraints=["y' - x'"], parameters={"b": 1},
        forces={"x": "2*b*x'^2"}, start={"x": 0, "y": 0}, velocities={"x'": 0.5}, duration=1.5,
    )
    speeds = np.array([0.5, 2.0, 0.1, -1.0])
    many = system.ensemble(times=[0.2, 1.5], vary={"x'": speeds}, threads=2)
    assert many.status == ["completed", "stopped", "completed", "completed"]
    assert many.reached == [2, 1, 2, 2] and many.cause[1].startswith("stopped at t = 0.")
    assert np.isnan(many.coordinates[1, 1]).all() and not np.isnan(many.coordinates[[0, 2, 3]]).any()
    np.testing.assert_allclose(many.coordinates[:, 0, 0], -np.log(1 - 0.2 * speeds), atol=1e-9)
    assert many.alone[1] is not None and many.alone[0] is None
    assert "3 of 4" in repr(many)
    # y' = x' leaves no choice
    refused = system.ensemble(vary={"y'": [0.5, 3.0]})
    assert refused.status == ["completed", "refused"] and "contradict" in refused.cause[1]
    assert refused.reached == [1, 0] and np.isnan(refused.error_estimate[1])


def test_results_do_not_depend_on_threads(system):
    values = {"phi": np.linspace(0, 1, 21)}
    one, three = (system.ensemble("vakonomic", [5.0], vary=values, threads=n) for n in (1, 3))
    np.testing.assert_array_equal(one.coordinates, three.coordinates)


def test_what_is_wrong_is_said(system):
    for vary, words in [
        ({}, "empty"),
        ({"g": []}, "no values"),
        ({"g": [1, 2], "k": [1]}, "2 values, k has 1"),
        ({"g": [1, np.nan]}, "g contains"),
        ({"duration": [1, 2]}, "same for all members"),
    ]:
        with pytest.raises(ValueError, match=words):
            system.ensemble(vary=vary)
    with pytest.raises(deltaq.UnknownNameError, match="gg"):
        system.ensemble(vary={"gg": [1, 2]})
    for times, words in [([1, 0.5], "ascending"), ([-1], "before the start"), ([np.inf], "times contains")]:
        with pytest.raises(ValueError, match=words):
            system.ensemble(times=times, vary={"g": [1, 2]})
    # constants that are natural at a horizon are found for every value of a parameter
    assert len(system.ensemble("removed-constraint", vary={"g": [1, 2]})) == 2
    for tolerance in (0, 1, -1, np.nan):
        with pytest.raises(deltaq.CallError, match="tolerance"):
            system.ensemble(vary={"g": [1, 2]}, tolerance=tolerance)
