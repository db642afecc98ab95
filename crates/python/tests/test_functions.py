"""Equations as functions of NumPy, JAX and Numba, and as SciPy's integrators take them.

JAX and Numba are used where they are installed; where they are not, NumPy stands for `jax.numpy`, and no compiler for Numba's.
"""

import importlib.util
import pickle
import sys
import types

import deltaq
import numpy as np
import pytest
from scipy.integrate import solve_ivp

HAS_JAX = importlib.util.find_spec("jax") is not None
SCENES = [("sledge", "chetaev"), ("sledge", "vakonomic"), ("disc", "chetaev"), ("turntable", "vakonomic"), ("trailer", "chetaev")]


@pytest.fixture(autouse=True)
def modules(monkeypatch):
    if not HAS_JAX:
        monkeypatch.setitem(sys.modules, "jax", types.SimpleNamespace(numpy=np))
        monkeypatch.setitem(sys.modules, "jax.numpy", np)
    else:
        import jax

        jax.config.update("jax_enable_x64", True)
    if importlib.util.find_spec("numba") is None:
        monkeypatch.setitem(sys.modules, "numba", types.SimpleNamespace(njit=lambda function: function))


@pytest.mark.parametrize("module", ["numpy", "jax", "numba"])
@pytest.mark.parametrize(("scene", "formulation"), SCENES)
def test_functions_are_the_equations(scene, formulation, module):
    equations = deltaq.built_in(scene).equations(formulation)
    made = equations.functions(module)
    assert made.states == equations.states and made.module == module and made.time == 0
    np.testing.assert_array_equal(made.start, equations.initial_state())
    numbers = made.values if module == "numba" else made.parameters
    random = np.random.default_rng(1)
    for _ in range(20):
        y = np.asarray(made.start) + 0.1 * random.normal(size=len(made.states))
        expected = equations.rates(0.3, y)
        np.testing.assert_allclose(made.rates(0.3, y, numbers), expected, rtol=1e-11, atol=1e-12 * abs(expected).max())
        read, outputs = equations.outputs(0.3, y), np.asarray(made.outputs(0.3, y, numbers))
        n = len(read.coordinates)
        np.testing.assert_allclose(outputs[: 2 * n], np.concatenate([read.coordinates, read.velocities]), rtol=1e-12, atol=1e-12)
        rest = [*read.multipliers.values(), *read.invariants.values()]
        np.testing.assert_allclose(outputs[2 * n :], rest, rtol=1e-9, atol=1e-10)


@pytest.mark.parametrize("module", ["numpy", "jax", "numba"])
def test_parameters_of_a_call(module):
    equations = deltaq.built_in("sledge").equations()
    made = equations.functions(module)
    y, moon = np.asarray(made.start), made.parameters | {"g": 1.62}
    numbers = np.array([*moon.values()]) if module == "numba" else moon
    np.testing.assert_allclose(made.rates(0.0, y, numbers), equations.rates(0.0, y, {"g": 1.62}), rtol=1e-13, atol=1e-14)


def test_the_text_says_what_it_is_for():
    equations = deltaq.built_in("sledge").equations()
    assert "import jax.numpy as np" in equations.to_jax() and "import numpy as np" not in equations.to_jax()
    assert equations.to_numba().count("@numba.njit") == 3 and "..." not in equations.to_numba().split("import numba")[1]
    with pytest.raises(ValueError, match="module is 'torch'; known: numpy, jax, numba"):
        equations.functions("torch")
    assert "numpy" in repr(equations.functions())


def test_jax_differentiates():
    """JAX's own derivatives where it is installed; differences of what stands for it elsewhere."""
    equations = deltaq.built_in("sledge").equations("vakonomic")
    made, y, h = equations.functions("jax"), equations.initial_state(), 1e-6
    if not HAS_JAX:
        rates = lambda y: made.rates(0.0, y, made.parameters)
        found, tolerance = np.stack([(rates(y + h * e) - rates(y - h * e)) / (2 * h) for e in np.eye(len(y))], axis=1), 1e-7
    else:
        import jax

        found, tolerance = jax.jacfwd(jax.jit(made.rates), 1)(0.0, y, made.parameters), 1e-12
    np.testing.assert_allclose(found, equations.jacobian(0.0, y), atol=tolerance)


def test_what_is_not_installed_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    with pytest.raises(ImportError, match="this needs numba, which is not there: pip install numba"):
        deltaq.built_in("sledge").equations().functions("numba")


@pytest.mark.parametrize("parameters", [None, {"g": 1.62}])
def test_scipys_pair(parameters):
    equations = deltaq.built_in("sledge").equations("vakonomic")
    fun, jac = equations.to_scipy(parameters)
    y, h = equations.initial_state(), 1e-6
    np.testing.assert_array_equal(fun(0.0, y), equations.rates(0.0, y, parameters))
    by_differences = np.stack([(fun(0.0, y + h * e) - fun(0.0, y - h * e)) / (2 * h) for e in np.eye(len(y))], axis=1)
    np.testing.assert_allclose(jac(0.0, y), by_differences, atol=1e-7)
    times = np.linspace(0.0, 1.0, 5)
    found = solve_ivp(fun, (0.0, 1.0), y, method="Radau", jac=jac, t_eval=times, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found.y.T, equations.integrate(times, parameters=parameters).states, atol=1e-6)
    again = pickle.loads(pickle.dumps(fun))
    np.testing.assert_array_equal(again(0.0, y), fun(0.0, y))
