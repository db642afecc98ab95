"""Films in Python: the command's answer, likelihood with exact slopes, profiles, pickles, what is refused."""

import json
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import deltaq

FILM = Path(__file__).resolve().parents[2] / "deltaq" / "tests" / "film.csv"
PROGRAM = Path(sys.prefix).parent / "release" / "deltaq"
FREE = ["x", "y", "phi", "x'", "phi'", "g~9"]


@pytest.fixture(scope="module")
def fitted():
    return deltaq.built_in("sledge").fit(FILM, free=FREE, sigma="1mm", law=["eps"])


def test_it_is_the_answer_of_the_command(fitted):
    call = [PROGRAM, "fit", "sledge", FILM, "--free", ",".join(FREE), "--sigma", "1mm", "--law", "eps", "--format", "json"]
    answer = json.loads(subprocess.run(call, capture_output=True, text=True, check=True).stdout)
    assert fitted.answer == answer
    assert [row.verdict for row in fitted.rows] == ["supported", "excluded", "supported"]
    assert fitted.best.formulation == "first-order" and "excluded" in repr(fitted)


def test_a_table_is_a_film(fitted):
    table = np.genfromtxt(FILM, delimiter=",", names=True)
    film = {"t": table["t"], "x": table["x_mm"] / 1000, "y": table["y_mm"] / 1000}
    again = deltaq.built_in("sledge").fit(film, free=FREE, sigma=1e-3, law=["eps"])
    assert [row.chi_squared for row in again.rows] == pytest.approx([row.chi_squared for row in fitted.rows], rel=1e-6)


def test_likelihood_and_slopes(fitted):
    row = fitted["chetaev"]
    assert row.logp(row.theta) == pytest.approx(-0.5 * row.chi_squared, rel=1e-12)
    errors = np.array([row.estimates[name]["error"] for name in row.names])
    theta = row.theta + 2 * errors
    for i, step in enumerate(1e-3 * errors):
        moved = [theta + step * np.eye(len(theta))[i] * side for side in (1, -1)]
        difference = (row.logp(moved[0]) - row.logp(moved[1])) / (2 * step)
        assert row.grad(theta)[i] == pytest.approx(difference, rel=1e-5, abs=1e-6 / step)
    nowhere = np.full(len(theta), np.nan)
    assert row.logp(nowhere) == -np.inf and not row.grad(nowhere).any()


def test_profiles(fitted):
    g = fitted["chetaev"].estimates["g"]
    profile = fitted["chetaev"].profile("g", [g["value"], g["value"] - 1.96 * g["error"], g["high"]])
    assert profile.rise == pytest.approx([0, 3.84, 3.84], abs=0.25)
    eps = fitted.best.estimates["epsilon"]
    profile = fitted.profile("eps")
    assert profile.rise.min() < 0.1 and np.interp(eps["high"], profile.at, profile.rise) == pytest.approx(3.84, abs=0.25)
    assert np.all(profile.at >= 0)
    assert fitted.profile("eps").plot().axes[0].get_xlabel() == "epsilon"
    with pytest.raises(deltaq.UnknownNameError, match="no unknown 'k'"):
        fitted.profile("k")


def test_pictures_and_pickles(fitted):
    figure = fitted.plot()
    film, chetaev, *_ = figure.axes[0].get_lines()
    assert abs(film.get_ydata() - chetaev.get_ydata()).max() < 5e-3
    again = pickle.loads(pickle.dumps(fitted))
    assert again.answer == fitted.answer


def test_what_films_can_show(fitted):
    assert [row.shown["answer"] for row in fitted.rows] == ["proved"] * 3
    again = deltaq.built_in("sledge").fit(FILM, free=[*FREE, "alpha"], sigma="1mm", formulations=["chetaev"])
    shown = again["chetaev"].shown
    assert (shown["answer"], shown["hidden"]) == ("hidden", [["g", "alpha"]]) and "derivatives to order" in shown["words"]


def test_a_grid_of_films():
    heisenberg = deltaq.built_in("heisenberg")
    ask = dict(film="20Hz,1mm,1s", free=["x'", "y'"])
    grid = deltaq.designs(heisenberg, {"mu0_1": [0.5, 1.0], "x'": [0.6, 0.8, 0.0]}, ("vakonomic", "chetaev"), part=2, **ask)
    rows = grid.to_pylist()
    assert [row["mu0_1"] for row in rows] == [0.5] * 3 + [1.0] * 3 and [row["x'"] for row in rows[:3]] == [0.6, 0.8, 0.0]
    own = heisenberg.replace({"mu0_1": 1.0, "x'": 0.8}).design(("vakonomic", "chetaev"), points=1, **ask)["best"]
    assert rows[4]["value"] == pytest.approx(own["value"], rel=1e-6) and rows[4]["cause"] == ""
    # twice the rate of turning, four times the squares
    assert rows[4]["value"] == pytest.approx(4 * rows[1]["value"], rel=0.1)
    nowhere = deltaq.designs(heisenberg, {"x'": [1e200, 0.5]}, ("vakonomic", "chetaev"), **ask).to_pylist()
    assert nowhere[0]["value"] is None and nowhere[0]["cause"] and nowhere[1]["value"] > 0
    with pytest.raises(ValueError, match="finite values"):
        deltaq.designs(heisenberg, {"mu0_1": [np.nan]}, ("vakonomic", "chetaev"), **ask)
    with pytest.raises(deltaq.UnknownNameError, match="mu0_7"):
        deltaq.designs(heisenberg, {"mu0_7": [1.0]}, ("vakonomic", "chetaev"), **ask)
    with pytest.raises(ValueError, match="points cannot be given"):
        deltaq.designs(heisenberg, {"mu0_1": [1.0]}, ("vakonomic", "chetaev"), points=3, **ask)


def test_what_is_refused(fitted):
    sledge = deltaq.built_in("sledge")
    film = {"t": [0.1, 0.2, 0.3], "x": [0.0, 0.1, 0.2]}
    for words, call in {
        "different lengths": dict(film=film | {"y": [0.0]}, free=["g"], sigma=1e-3),
        "no standard deviation": dict(film=film, free=["g"]),
        "film 1:2:9: column `atan2\\(y,x\\)`: `inf`": dict(film=film | {"atan2(y,x)": [np.inf, 0.0, 0.0]}, free=["g"], sigma=1e-3),
        "`z`": dict(film=film | {"z": [0.0] * 3}, free=["g"], sigma=1e-3),
        "not a number with a unit": dict(film=film, free=["g"], sigma="1inch"),
        "there are 1 films": dict(film=film, free=["g"], sigma=1e-3, known={"g@2": 9.8}),
        "the tolerance is": dict(film=film, free=["g"], sigma=1e-3, tolerance=2.0),
    }.items():
        with pytest.raises((ValueError, deltaq.DeltaqError), match=words):
            sledge.fit(call.pop("film"), **call)
    with pytest.raises(deltaq.UnknownNameError, match="no formulation 'kappa'"):
        fitted["kappa"]
    with pytest.raises(ValueError, match="for tell or for estimate"):
        sledge.design(film="60Hz,1mm,1s")
    with pytest.raises(ValueError, match="there is no length"):
        sledge.design(("chetaev", "vakonomic"), film="60Hz,1mm")
    with pytest.raises(ValueError, match="cannot be chosen"):
        sledge.design(("chetaev", "vakonomic"), film="60Hz,1mm,1s", over={"mu0_1": (0, 1)}, free=["x"])
