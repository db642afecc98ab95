"""Systems: from strings, from text, from files; faults and their places."""

import numpy as np
import pytest

import deltaq


def test_properties(sledge, system):
    assert (system.name, system.title, system.source) == ("sledge", "Ice sledge on an incline", "")
    assert system.coordinates == ["x", "y", "phi"] and system.dimension == 3
    assert system.units == {"x": "m", "y": "m", "phi": "rad"}
    assert system.parameters == {"g": 9.81, "alpha": 0.4, "k": 0.7}
    assert len(system.constraints) == 1 and "sin(phi)" in system.constraints[0]
    assert "sin(alpha)" in system.lagrangian and system.forces == {}
    assert system.multipliers == [0.0] and system.duration == 10.0
    assert system.removals[0] == "arc-length"
    assert system.integrability.startswith("nonholonomic")
    start = system.start
    np.testing.assert_allclose(start.q, [0, 0, 0.3])
    np.testing.assert_allclose(start.v, [0.5 * np.cos(0.3), 0.5 * np.sin(0.3), 1.1], rtol=1e-14)
    assert start.t == 0.0
    assert repr(system).startswith("<deltaq.System")


def test_text_and_back(tmp_path, system):
    text = system.to_toml()
    again = deltaq.parse(text, name="sledge")
    assert again.to_toml() == text
    path = tmp_path / "sledge.toml"
    path.write_text(text)
    loaded = deltaq.load(path, {"g": 1.62, "duration": 2})
    assert loaded.name == "sledge" and loaded.parameters["g"] == 1.62 and loaded.duration == 2.0
    assert deltaq.load(str(path)).to_toml() == text
    assert text.startswith("format = 1\n") and deltaq.parse(text.removeprefix("format = 1\n")).to_toml() == text
    with pytest.raises(deltaq.SceneError, match="of format 2; this version of deltaq reads formats up to 1"):
        deltaq.parse(text.replace("format = 1", "format = 2"))


def test_arguments_of_all_kinds():
    system = deltaq.System(
        ("x", "y"),
        "m/2*(x'^2 + y'^2) - h",
        parameters={"m": np.float32(2), "k": 3},
        definitions={"h": "k*x^2/2"},
        forces={"y": "-y'", "x": 0},
        start={"x": np.array(1.5), "y": "2*x"},
        velocities={"x'": True * 1, "y'": "x"},
        multipliers=np.zeros(0),
        time=np.float64(0.5),
    )
    assert system.parameters == {"m": 2.0, "k": 3.0} and list(system.forces) == ["y"]
    np.testing.assert_array_equal(system.start.q, [1.5, 3.0])
    np.testing.assert_array_equal(system.start.v, [1.0, 1.5])
    assert system.start.t == 0.5
    # m x'' = -k x: x = 1.5 cos(s) + sin(s)/w, s = w (t - t0)
    motion = system.solve(times=[0.5, 1.5])
    w = np.sqrt(1.5)
    assert motion.coordinates[1, 0] == pytest.approx(1.5 * np.cos(w) + np.sin(w) / w, rel=1e-12)


def test_faults_have_places(sledge):
    with pytest.raises(deltaq.SceneError) as caught:
        sledge.system(lagrangian="x'^2/2 + z")
    error = caught.value
    assert error.file == "sledge" and error.line > 0 and error.column > 0
    assert "undefined name `z`" in str(error) and str(error).startswith(f"sledge:{error.line}:{error.column}: ")
    text = sledge.system().to_toml()
    with pytest.raises(deltaq.SceneError) as caught:
        deltaq.parse(text.replace("[run]", "[runs]"))
    assert "unknown key" in str(caught.value) and caught.value.line == text.split("\n").index("[run]") + 1
    with pytest.raises(deltaq.UnknownNameError, match="did you mean"):
        deltaq.parse(text, {"alpah": 1})


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"start": {"x": 0, "y": 0}}, "`start` is missing"),
        ({"constraints": ["g"]}, "contains no velocity"),
        ({"constraints": ["y - x - 1"], "removals": None}, "one on positions, and the start is not on it"),
        ({"velocities": {"phi'": 1.1}}, "too few start velocities"),
        ({"velocities": {"phi'": 1.1, "x'": 1, "y'": 5}}, "contradict constraint 1"),
        ({"velocities": {"phi'": 1.1}, "start_equations": ["x' = 0.5", "2*x' = 3"]}, "start equation 2 contradicts .* -2.0000e0 there"),
        ({"parameters": {"g": np.nan, "alpha": 1, "k": 1}}, "finite"),
        ({"parameters": {"g": 1, "alpha": 1, "k": 1, 'a"b\n': 1}}, "cannot be a name"),
        ({"removals": {"wrong": {"parameters": ["x", "phi"], "rates": {"y": "x'"}}}}, "does not satisfy constraint 1"),
        ({"duration": 0}, "duration"),
        ({"multipliers": [1, 2]}, "multipliers"),
    ],
)
def test_faults_of_arguments(sledge, changes, words):
    with pytest.raises(deltaq.SceneError, match=words):
        sledge.system(**changes)


def test_a_start_may_be_an_equation(sledge):
    system = sledge.system(velocities={}, start_equations=["x'*cos(phi) + y'*sin(phi) = 0.5", "phi' - 1.1"])
    phi = system.start.q[2]
    assert np.allclose(system.start.v, [0.5 * np.cos(phi), 0.5 * np.sin(phi), 1.1], atol=1e-15)
    rows = system.ensemble(vary={"phi": [0.1, 0.7]}, times=[0, 1])
    assert np.allclose(rows.velocities[:, 0, 0], 0.5 * np.cos([0.1, 0.7]))


def test_wrong_arguments(sledge, system):
    with pytest.raises(ValueError, match="`z` in start is not a coordinate"):
        sledge.system(start={"x": 0, "y": 0, "phi": 0, "z": 1})
    with pytest.raises(TypeError, match="a number, a string"):
        sledge.system(start={"x": object(), "y": 0, "phi": 0})
    with pytest.raises(TypeError):
        deltaq.System(["x"])
    for wrong in (
        lambda: system.solve("vakonomik"), lambda: system.solve("vakonomik", form="quasi-velocities"),
        lambda: system.equations("vakonomik"), lambda: system.linearize("vakonomik"),
        lambda: system.linearize_over({"g": [1.0]}, "vakonomik"), lambda: system.ensemble("vakonomik", vary={"g": [1.0]}),
        lambda: deltaq.ensemble(system, "vakonomik", vary={"g": [1.0]}),
        lambda: deltaq.sweep(system, {"g": [1.0]}, formulations=("chetaev", "vakonomik")),
    ):
        with pytest.raises(deltaq.UnknownNameError, match="`vakonomik`, did you mean `vakonomic`\\?; known: chetaev"):
            wrong()
    with pytest.raises(ValueError, match="unknown formulation `substitution`; known: chetaev"):
        system.solve("substitution")
    with pytest.raises(ValueError, match="unknown removal `tangent`; known: arc-length"):
        system.solve("removed-constraint", removal="tangent")
    with pytest.raises(ValueError, match="takes no removal"):
        system.solve("chetaev", removal="arc-length")
    with pytest.raises(ValueError, match="unknown method"):
        system.solve(method="euler")
    with pytest.raises(ValueError, match="none of"):
        system.solve("removed-constraint", constants="one")
    with pytest.raises(ValueError, match="none of"):
        system.solve("removed-constraint", constants={"horizont": 1})
    with pytest.raises(TypeError, match="none of"):
        system.solve("removed-constraint", constants=object())
    with pytest.raises(TypeError, match="not both"):
        system.solve("vakonomic", mu0=[1], constants=[1])


def test_one_exception_for_each_error(sledge, system):
    with pytest.raises(deltaq.DerivationError, match="a parameter `kappa` is needed"):
        sledge.system().solve("kappa")
    with pytest.raises(deltaq.CallError, match="tolerance"):
        system.solve(tolerance=0)
    with pytest.raises(deltaq.SolveError, match="horizon"):
        system.solve("removed-constraint", constants={"horizon": -1})
    with pytest.raises(deltaq.SolveError, match="2 were given"):
        system.solve("vakonomic", mu0=[1, 2])
    with pytest.raises(deltaq.SolveError, match="no natural boundary condition"):
        system.solve("vakonomic", constants={"horizon": 1})
    cone = deltaq.System(
        ["x", "y", "z"],
        "(x'^2 + y'^2 + z'^2)/2",
        ["z'^2 - x'^2 - y'^2"],
        start=dict(x=0, y=0, z=0),
        velocities={"x'": 3, "y'": 4, "z'": 5},
    )
    for ask in (lambda: cone.removals, lambda: cone.solve("removed-constraint")):
        with pytest.raises(deltaq.RemovalError, match="not linear"):
            ask()
    # without constants phi runs into pi/2, where the chart of this removal ends
    along_x = {"along-x": {"parameters": ["x", "phi"], "rates": {"y": "x'*tan(phi)"}}}
    blind = sledge.system(lagrangian="(x'^2 + y'^2)/2 + phi'^2/4 + 4*x + y", removals=along_x)
    with pytest.raises(deltaq.BoundaryError, match="horizon"):
        blind.solve("removed-constraint", constants={"horizon": 30})
    for name in ("DerivationError", "RemovalError", "StartError", "CompileError", "EvaluationError", "BoundaryError"):
        assert issubclass(getattr(deltaq, name), deltaq.SolveError)
    assert issubclass(deltaq.SolveError, deltaq.DeltaqError) and issubclass(deltaq.SceneError, deltaq.DeltaqError)


def test_reactions_of_ones_own():
    # a skate whose bow is kept from going sideways by a force at its stern, a distance c behind
    c, m, inertia, speed, turn = 0.25, 80.0, 12.0, 0.8, 1.1
    skate = deltaq.System(
        ["x", "y", "phi"],
        "m/2*(x'^2 + y'^2) + J/2*phi'^2",
        ["y'*cos(phi) - x'*sin(phi)"],
        virtual=["y'*cos(phi) - x'*sin(phi) - c*phi'"],
        parameters={"m": m, "J": inertia, "c": c},
        start={"x": 0, "y": 0, "phi": 0},
        velocities={"x'": speed, "phi'": turn},
    )
    assert len(skate.virtual) == 1 and deltaq.parse(skate.to_toml()).virtual == skate.virtual
    times = np.linspace(0, 1, 5)
    decay = c * m * speed / inertia
    found = skate.solve("prescribed", times=times).velocities[:, 2]
    np.testing.assert_allclose(found, turn * np.exp(-decay * times), rtol=1e-11)
    np.testing.assert_allclose(skate.solve("chetaev", times=times).velocities[:, 2], turn, rtol=1e-12)
    with pytest.raises(deltaq.SceneError, match="2 conditions in `virtual` for 1 constraints"):
        deltaq.System(
            ["x", "y"], "x'^2 + y'^2", ["y' - x"], virtual=["x'", "y'"], start={"x": 0, "y": 0}, velocities={"x'": 1}
        )
