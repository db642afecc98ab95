"""Motions between two points; residuals for fits, which never raise."""

import math
import pickle

import numpy as np
import pytest

import deltaq


@pytest.fixture(scope="module")
def heisenberg():
    return deltaq.built_in("heisenberg")


def test_geodesics_have_their_closed_form(heisenberg):
    """Circles on which the velocity turns at rate mu; the first conjugate time is 2 pi/|mu|."""
    goal = {"x": 0.2, "y": 0.5, "z": 1.2}
    found = heisenberg.connect(goal, at=8.0)
    assert found.unknowns == ["x'", "y'", "mu0_1"] and found.formulation == "vakonomic"
    assert len(found) == len(found.motions) >= 3
    assert sum(motion.starts for motion in found.motions) + sum(found.failures.values()) == found.starts == 60
    assert found.runs > found.with_derivatives > 0
    actions = [motion.action for motion in found.motions]
    assert actions == sorted(actions) and found.motions[0].is_minimum
    for motion in found.motions:
        mu, (vx, vy) = motion.unknowns["mu0_1"], motion.velocities[:2]
        turned = mu * 8.0
        x = 0.5 + (vx * math.sin(turned) - vy * (1 - math.cos(turned))) / mu
        y = (vx * (1 - math.cos(turned)) + vy * math.sin(turned)) / mu
        assert abs(x - goal["x"]) < 1e-10 and abs(y - goal["y"]) < 1e-10
        assert abs(motion.action - (vx**2 + vy**2) * 4) < 1e-10 * motion.action
        first = 2 * math.pi / abs(mu)
        assert motion.is_minimum == (first > 8.0) and len(motion.multiplicities) == len(motion.conjugate_times)
        if first < 8.0:
            assert abs(motion.conjugate_times[0] - first) < 1e-9 and motion.conjugate_errors[0] < 1e-9
        again = motion.system.solve("vakonomic", [8.0])
        assert np.allclose(again.coordinates[0], list(goal.values()), atol=1e-9)
        assert motion.is_isolated and all(abs(r) < 1e-9 for r in motion.residuals.values())
        assert set(motion.errors) == set(found.unknowns) and motion.condition > 1 and motion.action_error < 1e-9
    copy = pickle.loads(pickle.dumps(found))
    assert copy.motions[0].unknowns == found.motions[0].unknowns
    assert "motions" in repr(found) and "action" in repr(found.motions[0])


def test_chetaevs_motions_have_no_constants():
    found = deltaq.built_in("disc").connect({"psi": 3.0, "phi": 1.5}, 2.0, "chetaev", starts=4)
    [motion] = found.motions
    assert motion.constants.shape == (0,) and motion.is_minimum is None
    assert np.allclose(motion.velocities[2:], [1.5, 0.55], atol=1e-10)


def test_what_connect_refuses(heisenberg):
    with pytest.raises(deltaq.BoundaryError, match=r"3 unknowns \(x', y', mu0_1\), and 2 coordinates"):
        heisenberg.connect({"x": 1.0, "y": 1.0})
    with pytest.raises(deltaq.BoundaryError, match="no coordinate `w`"):
        heisenberg.connect({"w": 1.0})
    with pytest.raises(deltaq.BoundaryError, match="is not after the start"):
        heisenberg.connect({"x": 1.0}, at=-1.0)


TIMES = np.linspace(0.2, 2.0, 10)
NAMES = ["g", "phi'", "mu0_1"]


def miss(**options):
    data = {"x": np.zeros(10), "phi'": np.ones(10), "mu_1": np.full(10, 0.1)}
    return deltaq.built_in("sledge").residuals(NAMES, TIMES, data, "vakonomic", **options)


def test_derivatives_of_residuals_are_those_of_differences():
    found, p = miss(sigma={"x": 0.1}), np.array([9.7, 0.9, 0.2])
    assert found.columns == ["x", "phi'", "mu_1"] and found.names == NAMES and len(found) == 30
    jacobian = found.jac(p)
    assert found(p).shape == (30,) and jacobian.shape == (30, 3) and found.ended is None
    for j, h in enumerate([1e-3, 1e-3, 1e-3]):
        step = h * np.eye(3)[j]
        # of order 4
        difference = (8 * (found(p + step) - found(p - step)) - (found(p + 2 * step) - found(p - 2 * step))) / (12 * h)
        assert np.allclose(jacobian[:, j], difference, rtol=1e-7, atol=1e-7), NAMES[j]
    motion = deltaq.built_in("sledge").replace(dict(zip(NAMES, p))).solve("vakonomic", TIMES)
    assert np.allclose(found(p)[:10], motion.coordinates[:, 0] / 0.1, atol=1e-7)
    assert np.allclose(found(p)[10:20], motion.velocities[:, 2] - 1, atol=1e-9)
    assert np.allclose(found(p)[20:], motion.multipliers["mu_1"] - 0.1, atol=1e-9)
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again(p), found(p)) and "phi'" in repr(again)


def test_numbers_are_no_error():
    found = miss(penalty=1e3)
    for bad in ([np.nan, 1.0, 0.0], [np.inf, 1.0, 0.0], [9.81, 1.0, -np.inf]):
        assert np.all(found(bad) == 1e3) and "must be finite" in found.ended
        assert np.all(found.jac(bad) == 0.0) and "must be finite" in found.ended
    # a motion that ends on the way: the heading comes across the slope
    along = deltaq.built_in("sledge").residuals(
        ["phi'"], TIMES, {"x": np.zeros(10)}, "removed-constraint", removal="along-x", penalty=1e3
    )
    values, jacobian = along([1.1]), along.jac([1.1])
    assert along.ended.startswith("the motion stops at t = ")
    late = values == 1e3
    assert late[-1] and not late[0] and np.all(jacobian[late] == 0) and np.all(np.isfinite(values))
    # far out steps are too many, or states too large: finite all the same
    assert np.all(np.isfinite(miss(max_steps=50)([1e9, 1e6, 1e7]))) and np.all(np.isfinite(miss(max_steps=50).jac([1e9, 1e6, 1e7])))


def test_wrong_calls_are_errors():
    sledge, data = deltaq.built_in("sledge"), {"x": np.zeros(10)}
    for arguments, error, words in [
        ((["g"], TIMES, {}), ValueError, "data has no column"),
        ((["g"], TIMES, {"w": np.zeros(10)}), deltaq.UnknownNameError, "unknown column `w`; known: x, y, phi, x', y', phi', lambda_1"),
        ((["g"], TIMES, {"x": np.zeros(9)}), ValueError, "x has 9 entries; 10 are needed"),
        ((["g"], TIMES, {"x": np.full(10, np.nan)}), ValueError, "x contains NaN; it must be finite"),
        ((["h"], TIMES, data), deltaq.DeltaqError, "h"),
        ((["g"], TIMES[::-1], data), deltaq.SolveError, "times have to rise"),
        ((["g"], TIMES - 1, data), deltaq.SolveError, "times have to begin at the start"),
    ]:
        with pytest.raises(error, match=words):
            sledge.residuals(*arguments)
    for options, words in [
        ({"sigma": {"x": 0.0}}, "sigma of x is 0"),
        ({"sigma": {"y": 1.0}}, "unknown column `y`"),
        ({"penalty": np.inf}, "penalty is inf"),
        ({"method": "radau5"}, "taylor and dop853, not by radau5"),
    ]:
        with pytest.raises((ValueError, deltaq.DeltaqError), match=words):
            sledge.residuals(["g"], TIMES, data, **options)
    with pytest.raises(deltaq.SolveError, match="natural at a horizon"):
        sledge.residuals(["g"], TIMES, data, "removed-constraint", constants={"horizon": 10.0})
    with pytest.raises(ValueError, match="p has 2 entries; 1 are needed"):
        sledge.residuals(["g"], TIMES, data)([1.0, 2.0])
