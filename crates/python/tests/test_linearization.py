"""Eigenvalues of steady motions against closed forms."""

import numpy as np
import pytest

import deltaq

PENDULUM = {"coordinates": ["angle"], "lagrangian": "angle'^2/2 + 9*cos(angle)", "velocities": {"angle'": 0}}


def pendulum(angle):
    return deltaq.System(start={"angle": angle}, **PENDULUM)


def test_a_pendulum_hangs_and_stands():
    hanging, standing = pendulum(0).linearize(), pendulum(np.pi).linearize()
    np.testing.assert_allclose(hanging.eigenvalues, [3j, -3j], atol=1e-14)
    np.testing.assert_allclose(standing.eigenvalues, [3, -3], atol=1e-14)
    assert (hanging.unstable, standing.unstable) == (0, 1)
    assert (hanging.growing, standing.growing) == ("0", "1")
    assert hanging.states == hanging.of == ["angle", "angle'"] and hanging.carried == {} and hanging.is_steady
    np.testing.assert_array_equal(hanging.matrix, [[0, 1], [-9, 0]])
    assert hanging.eigenvalues.dtype == np.complex128 and np.all(hanging.errors < 1e-13)


def test_a_sledge_turns_and_slides():
    # on level ice: x and y are carried, speed and turn go on
    sledge = deltaq.System(
        ["x", "y", "phi"],
        "(x'^2 + y'^2 + phi'^2)/2",
        ["y'*cos(phi) - x'*sin(phi)"],
        start={"x": 0, "y": 0, "phi": 0.3},
        velocities={"x'": "cos(phi)", "phi'": 2},
    )
    found = sledge.linearize()
    assert found.eigenvalues.shape == (0,) and found.zeros == 2 and set(found.carried) == {"x", "y", "phi"}
    assert abs(found.carried["phi"] - 2) < 1e-15 and found.growing == "undecided"
    with pytest.raises(deltaq.SolveError, match="no rate depends on `x`"):
        sledge.linearize(free=["x"])


def test_what_is_not_steady_is_refused_found_or_frozen():
    swinging = pendulum(0.5)
    with pytest.raises(deltaq.SolveError, match="angle'' = -4.3"):
        swinging.linearize()
    np.testing.assert_allclose(swinging.linearize(find=True).eigenvalues, [3j, -3j], atol=1e-12)
    frozen = swinging.linearize(at=0.0)
    np.testing.assert_allclose(frozen.eigenvalues.imag**2, 9 * np.cos(0.5), rtol=1e-14)
    assert not frozen.is_steady


def test_where_stability_changes():
    # a bead on a hoop that turns at w: the bottom is stable while w^2 < g/r = 9, then grows at sqrt(w^2 - 9)
    bead = deltaq.System(
        ["angle"], "angle'^2/2 + w^2*sin(angle)^2/2 + 9*cos(angle)", parameters={"w": 1.0}, start={"angle": 0}, velocities={"angle'": 0}
    )
    swept = bead.linearize_over({"w": [1.0, 2.0, 4.0, 5.0]})
    np.testing.assert_array_equal(swept.values, [1, 2, 4, 5])
    assert [point.unstable for point in swept.points] == [0, 0, 1, 1] and len(swept) == 4
    np.testing.assert_allclose(swept.points[3].eigenvalues, [4, -4], rtol=1e-12)
    [change] = swept.changes
    assert (change.below, change.above, change.frequency) == (0, 1, 0) and abs(change.value - 3) < 1e-7 + change.width
    np.testing.assert_array_equal(swept.points[1].matrix, bead.replace({"w": 2.0}).linearize().matrix)
    with pytest.raises(ValueError, match="over has 2 names; one can vary"):
        bead.linearize_over({"w": [1.0], "angle": [0.0]})
