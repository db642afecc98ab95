"""Whole programs by the conventions of diffrax, SciPy and pandas: they run, agree, and are typed strictly."""

import importlib.util
import runpy
import sys
import types
from pathlib import Path

import deltaq
import numpy as np
import pytest
from mypy import api
from scipy.integrate import solve_ivp

CRATE = Path(__file__).resolve().parents[1]
PROGRAMS = sorted((CRATE / "examples").glob("*.py"))


def without_diffrax():
    """diffrax where it is not installed: its names, its conventions, and SciPy's method of order 8."""

    def solve(term, solver, t0, t1, dt0, y0, args, saveat, stepsize_controller):
        tolerances = {"rtol": 1e-3 * stepsize_controller["rtol"], "atol": 1e-3 * stepsize_controller["atol"]}
        found = solve_ivp(lambda t, y: term(t, y, args), (t0, t1), y0, method=solver, t_eval=saveat, **tolerances)
        return types.SimpleNamespace(ys=found.y.T)

    return types.SimpleNamespace(ODETerm=lambda f: f, Dopri8=lambda: "DOP853", SaveAt=lambda ts: ts, PIDController=dict, diffeqsolve=solve)


@pytest.fixture
def jax_and_diffrax(monkeypatch):
    """Both, or what stands in for them."""
    if importlib.util.find_spec("diffrax") is None:
        jax = types.SimpleNamespace(config=types.SimpleNamespace(update=lambda name, value: None), numpy=np)
        for name, module in {"jax": jax, "jax.numpy": np, "diffrax": without_diffrax()}.items():
            monkeypatch.setitem(sys.modules, name, module)


def found(name):
    return runpy.run_path(str(CRATE / "examples" / f"{name}.py"))["main"]()


def test_diffrax(jax_and_diffrax):
    answer = found("with_diffrax")
    assert answer.pop("earth and moon") > 1
    assert max(answer.values()) < 1e-7, answer


def test_scipy():
    answer = found("with_scipy")
    assert answer["DOP853"] < 1e-6 and answer["Radau"] < 1e-6
    assert answer["g"] == pytest.approx(9.7, abs=1e-9) and answer["phi'"] == pytest.approx(0.9, abs=1e-9)
    # where the torque of the controller balances that of the system, k^2 phi'' = torque + 0.1 sin(3 t)
    assert answer["phi"] == pytest.approx(1, abs=0.05) and abs(answer["torque"]) < 0.3


def test_pandas():
    answer = found("with_pandas")
    assert answer["rows"] == 54 and abs(answer["g"] - 9.7) < 5 * answer["error"] < 0.1
    assert answer["chetaev"] == "supported" and answer["vakonomic"] == "excluded" and answer["chetaev, vakonomic"] == "different"
    assert 0.7 < answer["residuals"] < 1.3 and answer["spread"] > 0.1


def test_they_are_short_and_typed_strictly(monkeypatch, tmp_path):
    for path in PROGRAMS:
        assert len(path.read_text("utf-8").splitlines()) <= 60, path.name
    # the stubs of the module that is tested, wherever it was laid out
    place = Path(deltaq.__file__).parents[1]
    if place.name != "site-packages":
        monkeypatch.setenv("MYPYPATH", str(place))
    settings = ["--config-file", str(CRATE / "pyproject.toml"), "--cache-dir", str(tmp_path), "--python-executable", sys.executable]
    said, faults, code = api.run([*settings, *map(str, PROGRAMS)])
    assert code == 0, said + faults
    wrong = tmp_path / "wrong.py"
    wrong.write_text('import deltaq\nx: str = deltaq.built_in("sledge").equations().integrate([0.0, 1.0]).states\n')
    assert api.run([*settings, str(wrong)])[2] == 1
