"""Beside other work: the lock is released while integrating, and Ctrl-C ends it."""

import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import deltaq

LONG = 1e9


def test_other_threads_go_on(system):
    # a second thread counts while this one integrates; with the lock held it would get no turn
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    time.sleep(0.01)
    before, began = counted[0], time.perf_counter()
    motion = system.solve(times=[0, 1e5], max_steps=20_000)
    seconds, turns = time.perf_counter() - began, counted[0] - before
    done.set()
    thread.join()
    assert motion.status in ("stopped", "completed")
    assert turns > 1000, f"{turns} turns in {seconds:.3f} s"


def test_two_threads_give_what_one_gives(system):
    expected = system.solve("vakonomic").coordinates
    equations = system.equations("vakonomic")
    y = equations.initial_state()
    rates = equations.rates(0, y)
    found = []

    def work():
        for _ in range(5):
            found.append((system.solve("vakonomic").coordinates, equations.rates(0, y)))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 10
    for coordinates, again in found:
        np.testing.assert_array_equal(coordinates, expected)
        np.testing.assert_array_equal(again, rates)


def snake(links):
    """Links of length 2 on a plane, each with a wheel in its middle that does not slip sideways."""
    definitions = {f"d{i}": f"[cos(a{i}), sin(a{i})]" for i in range(links)}
    definitions |= {"r0": "[x, y]"} | {f"r{i}": f"r{i - 1} - d{i - 1} - d{i}" for i in range(1, links)}
    return deltaq.System(
        coordinates=["x", "y"] + [f"a{i}" for i in range(links)],
        definitions=definitions,
        lagrangian=" + ".join(f"dot(r{i}', r{i}')/2 + a{i}'^2/6" for i in range(links)),
        constraints=[f"r{i}'.y*d{i}.x - r{i}'.x*d{i}.y" for i in range(links)],
        start={"x": 0, "y": 0} | {f"a{i}": 0.2 * (-1) ** i for i in range(links)},
        velocities={"x'": 1.0, "a0'": 0.5},
    )


@pytest.mark.parametrize("ask", ["solve", "compare", "horizon", "ensemble", "derive"])
def test_control_c(sledge, system, ask):
    long = snake(60) if ask == "derive" else None
    endless = {
        "derive": lambda: long.equations("removed-constraint"),
        "solve": lambda: system.solve(times=[0, LONG], max_steps=2**60),
        "compare": lambda: sledge.system(duration=LONG).compare(max_steps=2**60),
        "horizon": lambda: system.solve("removed-constraint", constants={"horizon": LONG}, max_steps=2**60),
        "ensemble": lambda: system.ensemble(times=[LONG], vary={"g": [1, 2, 3]}, max_steps=2**60),
    }[ask]
    # a process that was started in the background ignores Ctrl-C from the start, and Python with it
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    timer.start()
    began = time.perf_counter()
    try:
        with pytest.raises(KeyboardInterrupt):
            endless()
    finally:
        timer.join()
        signal.signal(signal.SIGINT, before)
    assert 0.2 < time.perf_counter() - began < 5
    # and what comes after is not disturbed
    assert system.solve().status == "completed"


def test_a_program_that_embeds_it(tmp_path):
    session = Path(__file__).with_name("session.py")
    ended = subprocess.run([sys.executable, "-W", "error", session, tmp_path], capture_output=True, text=True, timeout=120)
    assert (ended.returncode, ended.stdout) == (0, "the session has ended\n"), ended.stderr
    assert (tmp_path / "slid.png").stat().st_size > 10_000


def test_eight_threads_with_one_object():
    # in a process of its own: what freezes holds Python's lock
    ended = subprocess.run([sys.executable, Path(__file__).with_name("together.py")], capture_output=True, text=True, timeout=120)
    assert ended.returncode == 0, ended.stderr
    assert "8 threads" in ended.stdout
