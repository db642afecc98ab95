"""The Python that README and docs show runs as it is printed."""

import math
import re
from pathlib import Path

import deltaq
import pytest

ROOT = Path(__file__).resolve().parents[3]


def blocks(path, language):
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / path).read_text(), re.DOTALL)


@pytest.mark.parametrize("path", ["README.md", "docs/python.md"])
def test_examples_run(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("disc-on-slope.toml").write_text(blocks("README.md", "toml")[0])
    found = blocks(path, "python")
    assert found
    names = {}
    for code in found:
        exec(compile(code, path, "exec"), names)


def test_the_removal_in_the_scene_format_is_one():
    sledge = (ROOT / "validation/scenes/sledge.toml").read_text()
    *_, removal = blocks("docs/scenes.md", "toml")
    system = deltaq.parse(sledge[: sledge.index("[removal.")] + removal + "[run]\nduration = 1\n")
    assert system.removals[0] == "arc-length"
    # the momentum along the blade is constant: u' + P_x cos(phi), with P_x = g sin(alpha) (10 - t)
    g, alpha, motion = 9.81, 0.4, system.solve("removed-constraint", [0.0, 1.0])
    start, end = (
        (v @ [math.cos(q[2]), math.sin(q[2])]) + g * math.sin(alpha) * (10 - t) * math.cos(q[2])
        for t, q, v in zip((0.0, 1.0), motion.coordinates, motion.velocities[:, :2])
    )
    assert abs(start - end) < 1e-8
