"""Numbers of a call: parameters, free constants and starts; derivatives by them."""

import pickle

import numpy as np
import pytest

import deltaq

TIMES = np.linspace(0.0, 1.0, 5)


@pytest.mark.parametrize("formulation", ["chetaev", "vakonomic", "removed-constraint"])
def test_parameters_of_a_run_are_those_of_another_system(system, formulation):
    equations = system.equations(formulation)
    for number in [1.6, 3.7]:
        other = system.replace({"g": number, "k": 0.9}).equations(formulation)
        run = equations.integrate(TIMES, parameters={"g": number, "k": 0.9})
        np.testing.assert_allclose(run.states, other.integrate(TIMES).states, rtol=1e-9, atol=1e-11)
        y = run.states[2]
        np.testing.assert_allclose(
            equations.rates(0.5, y, parameters={"g": number, "k": 0.9}), other.rates(0.5, y), rtol=1e-12, atol=1e-13
        )
        np.testing.assert_allclose(
            equations.jacobian(0.5, y, {"g": number, "k": 0.9}), other.jacobian(0.5, y), rtol=1e-11, atol=1e-12
        )
    # its own numbers are as they were
    own = system.equations(formulation)
    np.testing.assert_array_equal(equations.integrate(TIMES).states, own.integrate(TIMES).states)


def test_kept_equations_take_the_numbers_of_each_call(system):
    equations = system.equations("chetaev")
    y = equations.initial_state()
    for numbers in [{"g": 1.6}, {"g": 3.7}, {"alpha": 0.1}, {"k": 0.9, "g": 3.7}, {"g": 1.6}]:
        other = system.replace(numbers).equations("chetaev")
        np.testing.assert_allclose(equations.rates(0.5, y, parameters=numbers), other.rates(0.5, y), rtol=1e-12, atol=1e-13)


def test_start_and_constants_of_a_run(system):
    equations = system.equations("vakonomic")
    other = system.equations("vakonomic", mu0=[0.3])
    run = equations.integrate(TIMES, mu0=[0.3])
    np.testing.assert_allclose(run.states, other.integrate(TIMES).states, rtol=1e-12)
    # no time in it: from the state in the middle it goes on
    on = equations.integrate([0.0, 0.5], y0=run.states[2])
    np.testing.assert_allclose(on.states[-1], run.states[-1], rtol=1e-9)
    np.testing.assert_array_equal(equations.integrate(TIMES).states, equations.integrate(TIMES).states)


def test_what_is_refused(system):
    equations = system.equations()
    with pytest.raises(deltaq.UnknownNameError, match="unknown parameter `mass`; known: "):
        equations.integrate(TIMES, parameters={"mass": 1.0})
    with pytest.raises(ValueError, match="g is NaN; it must be finite"):
        equations.rates(0.0, equations.initial_state(), parameters={"g": np.nan})
    with pytest.raises(ValueError, match="y0 has 2 entries; 6 are needed"):
        equations.integrate(TIMES, y0=[1.0, 2.0])
    with pytest.raises(deltaq.SolveError, match="mass matrix is singular .* 0.0e0"):
        equations.integrate(TIMES, parameters={"k": 0.0})


def test_derivatives_of_a_motion(sledge, system):
    motion = system.solve("chetaev", TIMES, sensitivities=["g", "phi'"])
    assert set(motion.sensitivities) == {"g", "phi'"}
    by_turn = motion.sensitivities["phi'"]
    np.testing.assert_allclose(by_turn.coordinates[:, 2], TIMES, atol=1e-12)
    # x = ... + a (sin(phi) - sin(phi0))^2 / (2 w^2) is linear in g
    moved = [system.replace({"g": sledge.g + h}).solve("chetaev", TIMES).coordinates for h in (0.5, -0.5)]
    by_g = motion.sensitivities["g"]
    np.testing.assert_allclose(by_g.coordinates, moved[0] - moved[1], atol=1e-11)
    assert by_g.multipliers["lambda_1"].shape == TIMES.shape
    errors = motion.sensitivity_error_estimates["g"].coordinates
    assert (errors >= 0).all() and errors.max() < 1e-9
    again = pickle.loads(pickle.dumps(motion))
    np.testing.assert_array_equal(again.sensitivities["g"].coordinates, by_g.coordinates)
    assert system.solve("chetaev", TIMES).sensitivities == {}
    with pytest.raises(deltaq.UnknownNameError, match="`mass` is not a parameter"):
        system.solve(sensitivities=["mass"])
