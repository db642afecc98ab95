"""The Python that README and docs show runs as it is printed."""

import doctest
import importlib.util
import inspect
import math
import re
import sys
import types
from pathlib import Path

import dask_jobqueue
import dask_jobqueue.local
import deltaq
import nbformat
import numpy as np
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[3]
TUTORIALS = [f"docs/tutorials/{name}.md" for name in ("derive", "compare", "prove", "fit", "ensemble")]


def blocks(path, language):
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / path).read_text(), re.DOTALL)


def without_jax():
    """JAX where it is not installed: NumPy, and a central difference for a gradient."""
    grad = lambda f: lambda x, h=1e-4: (f(x + h) - f(x - h)) / (2 * h)
    return types.SimpleNamespace(numpy=np, grad=grad, config=types.SimpleNamespace(update=lambda name, value: None))


@pytest.mark.parametrize("path", ["README.md", "docs/python.md", "docs/fitting.md", "crates/python/README.md", *TUTORIALS])
def test_examples_run(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if importlib.util.find_spec("jax") is None:
        monkeypatch.setitem(sys.modules, "jax", without_jax())
        monkeypatch.setitem(sys.modules, "jax.numpy", np)
    Path("disc-on-slope.toml").write_text(blocks("README.md", "toml")[0])
    Path("disc-film.csv").write_text((ROOT / "crates/deltaq/examples/disc-film.csv").read_text())
    found = blocks(path, "python")
    assert found
    names = {}
    for code in found:
        exec(compile(code, path, "exec"), names)


# the jobs that stand in for Slurm's are not waited for
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
def test_the_page_about_clusters(tmp_path, monkeypatch, capsys):
    """Slurm's jobs are processes of this machine; their script is Slurm's."""
    monkeypatch.chdir(tmp_path)
    Path("own.toml").write_text((ROOT / "crates/scene/scenes/sledge.toml").read_text())
    scripts, asked = [], []

    def jobs(cores, processes, memory, walltime):
        with SLURMCluster(cores=cores, processes=processes, memory=memory, walltime=walltime) as cluster:
            scripts.append(cluster.job_script())
        return LocalCluster(cores=2, processes=2, memory=memory, walltime=walltime)

    class LocalCluster(dask_jobqueue.local.LocalCluster):
        def scale(self, jobs):
            asked.append(jobs)
            return super().scale(jobs=min(jobs, 1))

    SLURMCluster = dask_jobqueue.SLURMCluster
    monkeypatch.setattr(dask_jobqueue, "SLURMCluster", jobs)
    here, slurm = blocks("docs/cluster.md", "python")
    for code in (here.replace("n_workers=4", "n_workers=2"), slurm):
        exec(compile(code, "docs/cluster.md", "exec"), {"__name__": "__main__"})
    out = capsys.readouterr().out
    assert asked[0] == 10 and "#SBATCH -t 02:00:00" in scripts[0] and out.count("none proved") == 2 and "25 of 25 parts" in out
    assert len(list(Path("sweep-of-k").glob("part-*.parquet"))) == 25


def test_examples_of_docstrings_run():
    """Those of the system come first: the others take it from there."""
    objects = [deltaq.System, deltaq.built_in, deltaq.sweep, deltaq.ensemble, deltaq.designs]
    for cls in vars(deltaq).copy().values():
        if isinstance(cls, type) and cls.__module__ == "deltaq":
            objects += [cls, *(member for name, member in vars(cls).items() if not name.startswith("_"))]
    names, runner, parser, seen = {"deltaq": deltaq}, doctest.DocTestRunner(), doctest.DocTestParser(), set()
    for member in objects:
        text = inspect.getdoc(member)
        if text and ">>>" in text and id(member) not in seen:
            seen.add(id(member))
            test = parser.get_doctest(text, names, getattr(member, "__name__", "?"), None, 0)
            runner.run(test, clear_globs=False)
            names |= test.globs
    assert runner.failures == 0 and len(seen) >= 7, (runner.failures, len(seen))


@pytest.mark.parametrize("name", ["tour", "films"])
def test_notebooks_run(name, tmp_path):
    """All of them, in a new kernel, as they are printed."""
    notebook = nbformat.read(ROOT / f"docs/{name}.ipynb", 4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    printed = ["".join(output.get("text", "") for output in cell.outputs) for cell in code]
    assert len(code) > 5 and all(cell.execution_count for cell in code)
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert ["".join(output.get("text", "") for output in cell.outputs) for cell in code] == printed


def test_the_removal_in_the_scene_format_is_one():
    sledge = (ROOT / "crates/scene/scenes/sledge.toml").read_text()
    [removal] = [block for block in blocks("docs/scenes.md", "toml") if block.startswith("[removal.")]
    system = deltaq.parse(sledge[: sledge.index("[removal.")] + removal + "[run]\nduration = 1\n")
    assert system.removals[0] == "arc-length"
    # the momentum along the blade is constant: u' + P_x cos(phi), with P_x = g sin(alpha) (10 - t)
    g, alpha, motion = 9.81, 0.4, system.solve("removed-constraint", [0.0, 1.0])
    start, end = (
        (v @ [math.cos(q[2]), math.sin(q[2])]) + g * math.sin(alpha) * (10 - t) * math.cos(q[2])
        for t, q, v in zip((0.0, 1.0), motion.coordinates, motion.velocities[:, :2])
    )
    assert abs(start - end) < 1e-8
