"""Comparisons: verdicts, growth, fits."""

import numpy as np
import pytest

import deltaq


@pytest.fixture(scope="module")
def comparison(sledge):
    return sledge.system(duration=3.0, removals=None).compare()


def test_verdicts(comparison):
    assert comparison.verdict("chetaev", "vakonomic") == "different"
    assert comparison.verdict("vakonomic", "vakonomic-costate") == "same"
    pair = comparison.pair("Chetaev", "vakonomic")
    assert pair is comparison.pair("vakonomic", "chetaev")
    assert pair.verdict == "different" and pair.because is None
    assert list(pair.tau) == [1e-6, 1e-3, 0.1]
    assert 0 < pair.tau[1e-6] < pair.tau[1e-3] < 3
    assert pair.times.shape == pair.gap.shape == pair.limit.shape
    np.testing.assert_allclose(pair.gap.max(), pair.largest_gap)
    assert set(pair.largest_by_coordinate) == {"x", "y", "phi"} and max(pair.error_estimates) < 1e-8
    assert "nonholonomic" in comparison.integrability
    assert comparison.contradictions == []


def test_growth_is_as_predicted(comparison):
    # without multipliers at the start, the gap grows with the cube of time
    pair = comparison.pair("chetaev", "vakonomic")
    assert pair.predicted.exponent == 3 and pair.growth.exponent == pytest.approx(3, abs=0.01)
    np.testing.assert_allclose(pair.growth.coefficient, pair.predicted.coefficient, rtol=1e-3, atol=1e-3)


def test_what_is_decided(sledge, comparison):
    decided = next(d for d in comparison.decided if (d.family, d.motion) == ("vakonomic", "chetaev"))
    assert (decided.answer, decided.proved, decided.dimension) == ("none", True, None)
    assert decided.order == 1 and list(decided.constants) == ["mu0_1"] and decided.mismatch > 0.01
    assert comparison.pair("chetaev", "vakonomic").predicted.proved
    # straight down the slope no reaction acts
    start, velocities = {"x": 0, "y": 0, "phi": 0}, {"phi'": 0, "x'": 0.5}
    straight = sledge.system(duration=1.0, removals=None, start=start, velocities=velocities).compare()
    decided = next(d for d in straight.decided if (d.family, d.motion) == ("vakonomic", "chetaev"))
    assert decided.answer == "some" and decided.dimension is not None


def test_runs_and_fits(sledge, comparison):
    assert comparison.fits == []
    comparison = sledge.system(duration=3.0).compare(fits="all")
    assert [run.formulation for run in comparison.runs][:2] == ["chetaev", "vakonomic"]
    assert all(run.error is None and run.motion.status in ("completed", "stopped") for run in comparison.runs)
    fit = next(fit for fit in comparison.fits if (fit.run, fit.target) == ("vakonomic", "chetaev"))
    assert list(fit.constants) == ["mu0_1"]
    assert fit.largest_gap > 0.1 and fit.verdict == "different" and fit.starts > 2
    assert fit.largest_gap_by_half >= fit.largest_gap and fit.settled == (fit.largest_gap_by_half <= 1.01 * fit.largest_gap)
    # no farther than the motion that starts without multipliers, in the kinetic metric diag(1, 1, k^2)
    system, t = sledge.system(duration=3.0), np.linspace(0, 3, 401)
    goal = system.solve("chetaev", t).coordinates

    def largest(mu0):
        difference = system.solve("vakonomic", t, mu0=mu0).coordinates - goal
        return np.sqrt(np.max(difference**2 @ [1, 1, sledge.k**2]))

    best = fit.constants["mu0_1"]
    assert fit.largest_gap == pytest.approx(largest([best]), rel=1e-3)
    assert largest([best]) <= largest([0])


def test_names(comparison):
    with pytest.raises(deltaq.UnknownNameError, match="no run `hertz`"):
        comparison.verdict("hertz", "chetaev")
    with pytest.raises(KeyError, match="not compared"):
        comparison.verdict("chetaev", "vakonomic-costate")


def test_refused_formulations_say_why(sledge):
    # forces act in every formulation
    comparison = sledge.system(duration=1.0, removals=None, forces={"x": "-x'"}).compare(tolerance=1e-9)
    known = {"chetaev", "vakonomic", "vakonomic-costate", "removed-constraint"}
    assert {run.formulation for run in comparison.runs} == known
    assert all(run.motion is not None and run.error is None for run in comparison.runs)
    # nothing removes a constraint that is not linear
    cone = deltaq.System(
        coordinates=["x", "y", "z"], lagrangian="(x'^2 + y'^2 + z'^2)/2", constraints=["z'^2 - x'^2 - y'^2"],
        start={"x": 0, "y": 0, "z": 0}, velocities={"x'": 3, "y'": 4, "z'": 5}, duration=1.0,
    )
    run = next(run for run in cone.compare(tolerance=1e-9).runs if run.formulation == "removed-constraint")
    assert run.motion is None and "not linear" in run.error
    with pytest.raises(deltaq.CallError, match="tolerance"):
        sledge.system().compare(tolerance=0)
    with pytest.raises(ValueError, match="unknown fits `some`; known: undecided, all, none"):
        sledge.system().compare(fits="some")
