"""Sweeps and long ensembles: the same to the bit however they are computed."""

import io
import os
import pickle
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from distributed import Client, LocalCluster

import deltaq

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = Path(sys.prefix).parent / "release" / "deltaq"
SCENE = ROOT / "crates/scene/scenes/turntable.toml"
OVER = {"Omega": [0.3, 0.6, 0.9], "psi'": [0.3, 0.45, 0.6, 0.75, 0.9]}


@pytest.fixture(scope="module")
def table_top():
    return deltaq.load(SCENE, {"x": 0.6})


@pytest.fixture(scope="module")
def undisturbed(table_top):
    return deltaq.sweep(table_top, OVER)


def test_it_is_what_the_command_says(undisturbed):
    ranges = [f"{name}={values[0]}:{values[-1]}:{len(values)}" for name, values in OVER.items()]
    options = [word for text in ranges for word in ("--sweep", text)]
    words = [PROGRAM, "compare", "turntable", "--set", "x=0.6", "--tolerance", "1e-10", *options, "--quiet"]
    answer = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    expected = pd.read_csv(io.StringIO(answer), keep_default_na=False, na_values={name: "" for name in ("apart", "order", "dimension")})
    found = undisturbed.to_pandas()
    assert list(found.columns) == list(expected.columns) and len(found) == len(undisturbed) == 15
    for name in ("verdict", "answer", "cause"):
        assert list(found[name]) == list(expected[name])
    for name in ("Omega", "psi'", "apart", "largest", "limit", "order", "dimension", "mismatch"):
        np.testing.assert_array_equal(found[name].to_numpy(float), expected[name].to_numpy(float), name)


def test_where_the_ball_turns_with_the_table(undisturbed):
    table = undisturbed.to_xarray()
    assert table.sizes == {"Omega": 3, "psi'": 5}
    some = table["answer"].str.startswith("some")
    np.testing.assert_array_equal(some, np.equal.outer(OVER["Omega"], OVER["psi'"]))
    figure = undisturbed.plot("mismatch")
    assert figure.axes[0].get_ylabel() == "Omega" and figure.axes[0].get_xlabel() == "psi' (rad/s)"
    with pytest.raises(ValueError, match="words or counts"):
        undisturbed.plot("answer")
    with pytest.raises(ValueError, match="no column 'gap'; there are Omega"):
        undisturbed.plot("gap")


def test_parts_that_are_there_are_kept(table_top, undisturbed, tmp_path):
    done = []
    sweep = lambda **more: deltaq.sweep(table_top, OVER, out=tmp_path, part=4, progress=lambda *counts: done.append(counts), **more)  # noqa: E731
    assert sweep().to_arrow().equals(undisturbed.to_arrow())
    assert done == [(1, 4), (2, 4), (3, 4), (4, 4)]
    bytes_before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    (tmp_path / "part-000002.parquet").unlink()
    (tmp_path / ".part-left-over").write_text("")
    done.clear()
    assert sweep().to_arrow().equals(undisturbed.to_arrow()) and done == [(4, 4)]
    assert {path.name: path.read_bytes() for path in tmp_path.glob("part-*")} == bytes_before
    with pytest.raises(ValueError, match="is of another call"):
        sweep(tolerance=1e-9)


def test_what_is_no_part_of_it_is_refused_by_name(table_top, tmp_path):
    path = tmp_path / "part-000000.parquet"
    path.write_text("mine")
    with pytest.raises(ValueError, match="part-000000.parquet is of another call"):
        deltaq.sweep(table_top, {"x": [0.6]}, out=tmp_path)
    assert path.read_text() == "mine"


def test_killed_three_times(table_top, undisturbed, tmp_path):
    code = f"""
import deltaq, os, signal, sys
system = deltaq.load({str(SCENE)!r}, {{"x": 0.6}})
kill = lambda done, count: os.kill(os.getpid(), signal.SIGKILL) if done == int(sys.argv[1]) else None
deltaq.sweep(system, {OVER!r}, out={str(tmp_path)!r}, part=2, progress=kill)
"""
    for done in (2, 3, 6):
        ended = subprocess.run([sys.executable, "-c", code, str(done)])
        assert ended.returncode == -signal.SIGKILL
        assert len(list(tmp_path.glob("part-*"))) == done
    assert deltaq.sweep(table_top, OVER, out=tmp_path, part=2).to_arrow().equals(undisturbed.to_arrow())


def test_killed_at_any_time(table_top, undisturbed, tmp_path):
    """KILLS=100 kills a hundred sweeps before their end, and -s shows how many."""
    wanted, out = int(os.environ.get("KILLS", 4)), tmp_path / "out"
    code = f"""
import deltaq
system = deltaq.load({str(SCENE)!r}, {{"x": 0.6}})
print(flush=True)
deltaq.sweep(system, {OVER!r}, out={str(out)!r}, part=1)
"""
    clock = time.perf_counter()
    deltaq.sweep(table_top, OVER, out=tmp_path / "whole", part=1)
    seconds = time.perf_counter() - clock
    whole = {path.name: path.read_bytes() for path in (tmp_path / "whole").iterdir()}
    killed = ended = attempts = 0
    while killed < wanted:
        assert attempts < 10 * wanted, f"{killed} of {attempts} were killed before their end"
        sweep = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
        sweep.stdout.readline()
        time.sleep(seconds * (attempts * (5**0.5 - 1) / 2 % 1))
        sweep.kill()
        sweep.communicate()
        killed += sweep.returncode != 0
        attempts += 1
        left = {path.name: path.read_bytes() for path in out.glob("part-*")} if out.exists() else {}
        assert all(whole[name] == read for name, read in left.items())
        if attempts % 3 == 0:
            assert deltaq.sweep(table_top, OVER, out=out, part=1).to_arrow().equals(undisturbed.to_arrow())
            assert {path.name: path.read_bytes() for path in out.glob("part-*")} == whole
            shutil.rmtree(out)
            ended += 1
    print(f"Python sweep: {killed} of {attempts} calls killed before their end, 0 broken; {ended} went on to it")


def test_a_cluster_that_loses_a_worker(table_top, undisturbed, tmp_path):
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            workers = list(client.run(os.getpid).values())
            assert os.getpid() not in workers and len(set(workers)) == 2
            killed = []

            def kill(done, count):
                if done == 3:
                    os.kill(workers[0], signal.SIGKILL)
                    killed.append(workers[0])

            found = deltaq.sweep(table_top, OVER, client=client, part=1, progress=kill)
            assert killed and found.to_arrow().equals(undisturbed.to_arrow())
            vary = {"x": np.linspace(0.1, 0.9, 40)}
            here = deltaq.ensemble(table_top, "vakonomic", [0.5, 1.0], vary=vary, part=16)
            there = deltaq.ensemble(table_top, "vakonomic", [0.5, 1.0], vary=vary, part=8, client=client, out=tmp_path)
            assert here.equals(there.to_table())


def test_an_ensemble_as_a_table(table_top, tmp_path):
    vary = {"x": np.linspace(0.1, 0.9, 10), "Omega": np.linspace(0.2, 1.1, 10)}
    many = table_top.ensemble("chetaev", [0.0, 1.0], vary=vary)
    table = deltaq.ensemble(table_top, "chetaev", [0.0, 1.0], vary=vary, out=tmp_path, part=3).to_table()
    assert table.equals(many.to_arrow()) and table.num_rows == 20
    np.testing.assert_array_equal(table["member"], np.repeat(np.arange(10), 2))
    np.testing.assert_array_equal(table["x'"].to_numpy().reshape(10, 2), many.velocities[:, :, 0])
    data = many.to_xarray()
    np.testing.assert_array_equal(data["set Omega"], vary["Omega"])
    np.testing.assert_array_equal(data["x"].sel(t=1.0), many.coordinates[:, 1, 0])
    with pytest.raises(ValueError, match="is of another call"):
        deltaq.ensemble(table_top, "chetaev", [0.0, 2.0], vary=vary, out=tmp_path, part=3)


def test_what_is_not_reached_is_null():
    # x' = u, u' = u^2 ends at t = 1/u0
    system = deltaq.System(
        coordinates=["x", "y"],
        lagrangian="(x'^2 + y'^2)/2",
        constraints=["y' - x'"],
        forces={"x": "2*x'^2"},
        start={"x": 0, "y": 0},
        velocities={"x'": 0.5},
    )
    many = system.ensemble("chetaev", [0.5, 1.5], vary={"x'": [0.5, 1.0, 1.5]})
    table = many.to_arrow()
    assert many.reached == [2, 1, 1] and table["x"].is_null().to_pylist() == [False, False, False, True, False, True]
    assert table["status"].to_pylist() == ["completed"] * 2 + ["stopped"] * 4
    assert table["cause"].to_pylist()[0] is None and table["cause"].to_pylist()[2].startswith("stopped at t = ")


def test_what_means_nothing_is_refused(table_top, tmp_path):
    out = tmp_path / "nothing"
    for over, words in (
        ({}, "over is empty"),
        ({"x": [[1.0]]}, "x has to be a list of finite numbers"),
        ({"x": [float("nan")]}, "x has to be a list of finite numbers"),
    ):
        with pytest.raises(ValueError, match=words):
            deltaq.sweep(table_top, over, out=out)
    with pytest.raises(deltaq.UnknownNameError, match="`omega`"):
        deltaq.sweep(table_top, {"omega": [1.0]}, out=out)
    with pytest.raises(deltaq.SolveError, match="P0_x"):
        deltaq.sweep(table_top, {"P0_x": [1.0]}, formulations=("chetaev", "vakonomic"), out=out)
    with pytest.raises(ValueError, match="names 1"):
        deltaq.sweep(table_top, {"x": [1.0]}, formulations=("chetaev",), out=out)
    with pytest.raises(ValueError, match="part is 0"):
        deltaq.sweep(table_top, {"x": [1.0]}, part=0, out=out)
    with pytest.raises(ValueError, match="as many values"):
        deltaq.ensemble(table_top, vary={"x": [1.0], "y": [1.0, 2.0]}, out=out)
    assert not out.exists()


def test_costates_vary(sledge):
    system = sledge.system(duration=1.0)
    found = deltaq.sweep(system, {"P0_x": [-1.0, 0.0, 1.0]}).to_pandas()
    assert list(found["verdict"]) == ["different"] * 3 and found["apart"].nunique() == 3
    many = system.ensemble("removed-constraint", [1.0], vary={"P0_x": [0.5, 1.0]})
    single = system.solve("removed-constraint", [1.0], constants=[1.0])
    np.testing.assert_allclose(many.coordinates[1, 0], single.coordinates[0], atol=1e-9)


def test_systems_are_pickled(table_top):
    again = pickle.loads(pickle.dumps(table_top))
    assert again.to_toml() == table_top.to_toml() and again.name == "turntable"
    changed = table_top.replace({"Omega": 0.25})
    assert changed.parameters["Omega"] == 0.25 and changed.start.q[0] == 0.6
    assert pickle.loads(pickle.dumps(changed)).to_toml() == changed.to_toml()
