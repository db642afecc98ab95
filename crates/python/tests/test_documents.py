"""The Python that README and docs show runs as it is printed."""

import re
from pathlib import Path

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
    for code in found:
        exec(compile(code, path, "exec"), {})
