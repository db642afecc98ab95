"""Scripts that no other check runs find what they read, and write what is kept."""

import runpy
import subprocess
import sys
from pathlib import Path

VALIDATION = Path(__file__).resolve().parents[3] / "validation"


def test_the_referee_of_the_bicycle_writes_the_eigenvalues_that_are_kept(tmp_path):
    folder = VALIDATION / "linear"
    subprocess.run([sys.executable, "-B", folder / "bicycle.py", tmp_path / "bicycle.csv"], check=True)
    assert (tmp_path / "bicycle.csv").read_text() == (folder / "bicycle.csv").read_text()


def test_the_problems_of_the_peers_are_there():
    cases = runpy.run_path(str(VALIDATION / "peers" / "problems.py"))["problems"]()
    names = {case.name for case in cases}
    assert {"sledge-chetaev", "cone-vakonomic", "trailers-80"} <= names, names
