"""Equations as C, NumPy and SymPy are the equations: rates and outputs at 1,000 random states of every scene and formulation."""

import ctypes
import os
import subprocess
import types
from pathlib import Path

import numpy as np
import pytest
import sympy

import deltaq

SCENES = Path(__file__).resolve().parents[3] / "crates/scene/scenes"
FORMS = (*deltaq.FORMULATIONS, "chetaev-reduced", "vakonomic-reduced")
STATES = 1000
# difference over the largest rate (or output) at the same state
TOLERANCE = 1e-13


def cases():
    """Equations by name: of every scene, in every formulation and form that it has."""
    found = {}
    for path in sorted(SCENES.glob("*.toml")):
        system = deltaq.load(path)
        for form in FORMS:
            try:
                found[f"{path.stem} {form}"] = system, system.equations(form)
            except (deltaq.DerivationError, deltaq.RemovalError):
                pass
    return found


CASES = cases()
NONLINEAR = {"appell-hamel vakonomic-costate"}
LINEAR = sorted(CASES.keys() - NONLINEAR)
# SymPy looks for common subexpressions for minutes
SLOW = {f"bicycle {form}" for form in ("removed-constraint", "chetaev-reduced", "vakonomic-reduced")}


def states(name):
    """Times and states about the start, and rates and outputs there."""
    system, equations = CASES[name]
    random = np.random.default_rng(sum(map(ord, name)))
    start = equations.initial_state()
    t = random.uniform(system.start.t, system.start.t + system.duration, STATES)
    y = start + 0.1 * (1 + abs(start)) * random.uniform(-1, 1, (STATES, len(start)))
    read = equations.outputs(t, y)
    columns = [read.coordinates, read.velocities, *(x[:, None] for x in (read.multipliers | read.invariants).values())]
    return t, y, equations.rates(t, y), np.concatenate(columns, axis=1)


def check(name, found, expected):
    assert found.shape == expected.shape
    scale = abs(expected).max(axis=1, keepdims=True)
    assert (scale > 0).all()
    worst = (abs(found - expected) / scale).max()
    assert worst < TOLERANCE, f"{name}: {worst:.1e}, limit {TOLERANCE:.0e}"


def module(text):
    made = types.ModuleType("made")
    exec(compile(text, "made", "exec"), made.__dict__)
    return made


def compiled(library, *files):
    options = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O0", "-shared", "-fPIC", "-o", library]
    subprocess.run([os.environ.get("CC", "cc"), *options, *files, "-lm"], check=True)
    return ctypes.CDLL(library)


def pointers(*arrays):
    return [x.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for x in arrays]


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """All C files as one library."""
    folder = tmp_path_factory.mktemp("code")
    files = []
    for i, name in enumerate(LINEAR):
        files.append(folder / f"{i}.c")
        files[-1].write_text(CASES[name][1].to_c())
    return compiled(folder / "all.so", *files)


@pytest.mark.parametrize("name", LINEAR)
def test_c(library, name):
    t, y, *expected = states(name)
    prefix = name.replace("-", "_").replace(" ", "_")
    start = (ctypes.c_double * y.shape[1]).in_dll(library, f"{prefix}_start")
    np.testing.assert_array_equal(list(start), CASES[name][1].initial_state())
    defaults = ctypes.byref(ctypes.c_char.in_dll(library, f"{prefix}_defaults"))
    for what, values in zip(("rates", "outputs"), expected):
        found, function = np.empty_like(values), library[f"{prefix}_{what}"]
        for time, state, row in zip(t, y, found):
            assert function(ctypes.c_double(time), *pointers(state), defaults, *pointers(row)) == 0
        check(f"{name} {what}", found, values)


@pytest.mark.parametrize("name", LINEAR)
def test_numpy(name):
    t, y, rates, outputs = states(name)
    made = module(CASES[name][1].to_numpy())
    assert made.STATES == CASES[name][1].states
    np.testing.assert_array_equal(made.START, CASES[name][1].initial_state())
    check(f"{name} rates", made.rates(t, y), rates)
    check(f"{name} outputs", made.outputs(t, y), outputs)
    np.testing.assert_allclose(made.rates(t[0], y[0]), rates[0], rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("name", sorted(set(LINEAR) - SLOW))
def test_sympy(name):
    t, y, *expected = states(name)
    made = module(CASES[name][1].to_sympy())
    known = [made.t, *made.STATES, *made.PARAMETERS]
    values = [t, *y.T, *made.PARAMETERS.values()]

    def evaluate(matrix, symbols, at):
        function = sympy.lambdify(symbols, [*matrix], cse=True)
        rows = np.stack([np.broadcast_to(x, t.shape) for x in function(*at)], axis=-1)
        return rows.reshape(-1, *matrix.shape)

    z = np.empty((STATES, 0))
    if made.UNKNOWNS:
        z = np.linalg.solve(evaluate(made.MATRIX, known, values), evaluate(made.RIGHT, known, values))[..., 0]
    for what, matrix, column in zip(("rates", "outputs"), (made.RATES, made.OUTPUTS), expected):
        found = evaluate(matrix, [*known, *made.UNKNOWNS], [*values, *z.T])[..., 0]
        check(f"{name} {what}", found, column)


ODD = dict(
    coordinates=["lambda", "x_dot", "x", "s1"],
    lagrangian="double*lambda'^2/2 + x'^2/(2*(1 + x^2)) + x_dot'^2*x'/2 + x_dot'^2 + s1'^2/6 - pi*np*cos(lambda)*exp(-s1)",
    constraints=["s1'*x - x_dot'*atan2(x, 3) + t"],
    start={"lambda": 0.5, "x_dot": -0.3, "x": 1, "s1": 0.2},
    velocities={"lambda'": 1, "x'": 0.5, "x_dot'": 0.25},
    time=1.5,
    name="2-odd names",
    title='*/ /* """ \\',
)
PARAMETERS = {"double": 2, "np": 0.75}


def test_names_and_parameters(tmp_path):
    """Keywords, primes and names of our own are told apart; parameters are values that can be changed."""
    equations = deltaq.System(**ODD, parameters=PARAMETERS).equations()
    changed = deltaq.System(**ODD, parameters={"double": 3, "np": -1.5}).equations()
    start = equations.initial_state()
    expected = [e.rates(1.5, start) for e in (equations, changed)]
    made = module(equations.to_numpy())
    assert made.PARAMETERS == PARAMETERS and made.TIME == 1.5
    for rates, parameters in zip(expected, (made.PARAMETERS, {"double": 3, "np": -1.5})):
        np.testing.assert_allclose(made.rates(1.5, start, parameters), rates, rtol=1e-13)
    both = made.rates(1.5, start, {"double": np.array([2, 3]), "np": np.array([0.75, -1.5])})
    np.testing.assert_allclose(both, expected, rtol=1e-13)
    file, found = tmp_path / "odd.c", np.empty(8)
    file.write_text(equations.to_c())
    rates = compiled(tmp_path / "odd.so", file)["scene_2_odd_names_chetaev_rates"]
    assert rates(ctypes.c_double(1.5), *pointers(start, np.array([3, -1.5]), found)) == 0
    np.testing.assert_allclose(found, expected[1], rtol=1e-13)
    made = module(equations.to_sympy())
    solved = made.RATES.subs(dict(zip(made.UNKNOWNS, made.MATRIX.LUsolve(made.RIGHT))))
    values = dict(zip(made.STATES, made.START)) | made.PARAMETERS | {made.t: 1.5}
    np.testing.assert_allclose(np.array(solved.subs(values).evalf(30), float).ravel(), expected[0], rtol=1e-13)


def test_a_singular_instant_is_an_answer_of_c(tmp_path):
    system = deltaq.System(["x", "y"], "x*x'^2/2 + y'^2/2 - y*x", ["x*x' + y*y'"], start=dict(x=1, y=0), velocities={"y'": 1})
    equations, file, found, state = system.equations(), tmp_path / "singular.c", np.full(4, 7.0), np.zeros(4)
    file.write_text(equations.to_c())
    rates = compiled(tmp_path / "singular.so", file).system_chetaev_rates
    with pytest.raises(deltaq.EvaluationError, match="singular"):
        equations.rates(0, state)
    assert rates(ctypes.c_double(0), *pointers(state, np.zeros(1), found)) == 1
    np.testing.assert_array_equal(found, 7)


@pytest.mark.parametrize("name", sorted(NONLINEAR))
def test_what_takes_newtons_method_is_refused(name):
    equations = CASES[name][1]
    for write in (equations.to_c, equations.to_numpy, equations.to_sympy):
        with pytest.raises(deltaq.SolveError, match="not linear"):
            write()
