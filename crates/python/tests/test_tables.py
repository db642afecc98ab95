"""Motions, ensembles and comparisons as tables, pictures and what a notebook shows."""

import pickle
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure


@pytest.fixture(scope="module")
def watched(sledge):
    return sledge.system(observables={"speed": "sqrt(x'^2 + y'^2)"}, invariants={"spin": "phi'"})


def test_observables(sledge, watched):
    motion = watched.solve("chetaev", np.linspace(0, 5, 11))
    np.testing.assert_allclose(motion.observables["speed"], abs(sledge.speed(motion.times)), atol=1e-9)
    np.testing.assert_allclose(motion.invariants["spin"], sledge.w, atol=1e-11)
    assert motion.at(1.0).observables["speed"] == pytest.approx(abs(sledge.speed(1.0)), abs=1e-9)
    equations = watched.equations("chetaev")
    now = equations.outputs(0.0, equations.initial_state())
    assert now.observables["speed"] == pytest.approx(sledge.u0)


def test_a_motion_as_a_table(watched):
    motion = watched.solve("vakonomic", [0.0, 0.5, 1.0])
    frame, table, data = motion.to_pandas(), motion.to_arrow(), motion.to_xarray()
    columns = ["x", "y", "phi", "x'", "y'", "phi'", "mu_1", "energy", "spin", "speed"]
    assert set(frame.columns) >= set(columns) and frame.index.name == "t"
    assert table.column_names == ["t", *frame.columns] and set(data.data_vars) == set(frame.columns)
    for i, name in enumerate(motion.coordinate_names):
        np.testing.assert_array_equal(frame[name], motion.coordinates[:, i])
        np.testing.assert_array_equal(data[name + "'"], motion.velocities[:, i])
    np.testing.assert_array_equal(table["speed"], motion.observables["speed"])


def test_pictures(sledge, system, tmp_path):
    comparison = sledge.system(duration=1.0).compare()
    many = system.ensemble("chetaev", [0.0, 1.0], vary={"phi": np.linspace(0, 1, 5)})
    end = system.ensemble("chetaev", vary={"phi": np.linspace(0, 1, 5)})
    for figure, axes in ((comparison.runs[0].motion.plot(), 3), (many.plot(), 3), (end.plot(), 3), (comparison.plot(), 4)):
        assert isinstance(figure, Figure) and len(figure.axes) == axes
        assert all(axis.has_data() and axis.get_ylabel() for axis in figure.axes)
        figure.savefig(tmp_path / "picture.png")
    assert end.plot().axes[-1].get_xlabel() == "phi (rad)" and many.plot().axes[-1].get_xlabel() == "t (s)"
    again = system.solve("vakonomic", [0, 1]).plot(ax=many.plot().axes)
    assert len(again.axes) == 3
    with pytest.raises(ValueError, match="ax has 1 axes; 3 are needed"):
        system.solve("chetaev", [0, 1]).plot(ax=again.axes[0])


def test_bodies_in_motion(sledge, tmp_path):
    view = {"sledge": {"shape": "blade", "size": [1.2, 0.3], "at": "[x, y]", "rotation": "phi"}}
    system = sledge.system(view=view, duration=2.0)
    animation = system.compare().animate()
    animation.save(tmp_path / "bodies.svg")
    root = ElementTree.parse(tmp_path / "bodies.svg").getroot()
    assert root.tag.endswith("svg") and "<animate" in animation.svg and animation._repr_html_() == animation.svg
    for label in ("Chetaev", "vakonomic", "removed constraint"):
        assert label in animation.svg
    assert "chetaev" in system.solve("chetaev", [0.0, 1.0]).animate().svg
    many = system.ensemble("chetaev", np.linspace(0, 2, 21), vary={"phi": np.linspace(0, 1, 20)}).animate()
    assert len(set(re.findall(r"phi = (\d+(?:\.\d+)?)", many.svg))) == 8
    assert pickle.loads(pickle.dumps(system)).solve("chetaev", [0.0, 1.0]).animate().svg
    with pytest.raises(ValueError, match="says nothing of bodies that move"):
        sledge.system().solve("chetaev", [0.0, 1.0]).animate()


def test_what_a_notebook_shows(sledge, system):
    comparison = sledge.system(duration=1.0, title="a < b").compare()
    shown = comparison._repr_html_()
    assert "<td>different</td>" in shown and "none, proved" in shown and shown.count("<table>") == 2
    assert "<td>completed</td>" in comparison.runs[0].motion._repr_html_()
    many = system.ensemble("chetaev", vary={"phi": [0.0, 1.0]})
    assert "phi: 0 to 1" in many._repr_html_()
    assert r"L &= " in system.latex and r"\dot{x}" in system.latex and system._repr_latex_().startswith("$")
    frame = comparison.to_pandas()
    assert len(frame) == len(comparison.pairs) and set(frame["verdict"]) <= {"same", "different", "undecided"}
    assert frame["time to 0.001"].dtype == float
