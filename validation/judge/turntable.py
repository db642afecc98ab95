"""What adapters share: numbers of the scene `turntable`, the command line, the CSV.

An adapter calls `run(SETTINGS, motion, __doc__)`; its `motion(ball, dt, steps, every)` yields, every `every` steps,
`(t, centre, rotation, velocity, spin)`: s, m, ball to room as a matrix, m/s, rad/s, the last two seen from the room.
"""

import argparse
import csv
import json
import tomllib
from math import pi
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from attitude import angles, axes, rotation

SCENE = Path(__file__).resolve().parents[2] / "crates/scene/scenes/turntable.toml"
COORDINATES = ["x", "y", "psi", "theta", "phi"]
GRAVITY = 9.81  # m/s², presses the ball onto the table; the scene has none
SUNK = 0.1  # of the radius: how far the centre may be from its height
SAMPLES = 100, 600  # the fewest and the most steps that are written


def start(changes):
    """The ball and the table of the scene at the start; the two constraints supply theta' and phi'."""
    scene = tomllib.loads(SCENE.read_text("utf-8"))
    entries = scene["parameters"] | {q: c["start"] for q, c in scene["coordinates"].items()} | scene["start"]["velocities"]
    if unknown := changes.keys() - entries.keys():
        raise SystemExit(f"--set: the scene has no {', '.join(unknown)}; it has {', '.join(entries)}")
    n = {"pi": pi}
    for name, value in (entries | changes).items():
        n[name] = float(eval(str(value), {"__builtins__": {}}, n))
    turn = axes(n["psi"], n["theta"])
    across = np.array([n["Omega"] * n["x"] - n["y'"], n["x'"] + n["Omega"] * n["y"]]) / n["a"]
    rates = [n["psi'"], *np.linalg.solve(turn[:2, 1:], across)]
    return SimpleNamespace(
        changes=changes, m=n["m"], a=n["a"], Omega=n["Omega"], centre=np.array([n["x"], n["y"], n["a"]]), velocity=np.array([n["x'"], n["y'"], 0.0]),
        angles=[n["psi"], n["theta"], n["phi"]], rotation=rotation(n["psi"], n["theta"], n["phi"]), spin=turn @ rates)


def row(t, centre, R, velocity, spin, before):
    """One line of the CSV; angles go on from those before without jumps."""
    found = angles(R)
    found += 2 * pi * np.round((before - found) / (2 * pi))
    return [t, *centre[:2], *found, *velocity[:2], *np.linalg.solve(axes(*found[:2]), spin)]


def run(settings, motion, doc):
    """Reads the command line, makes the motion, writes it, and prints all settings as one line of JSON."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", metavar="OUT.csv")
    parser.add_argument("--dt", type=float, default=1e-3, help="length of a step, s")
    parser.add_argument("--end", type=float, default=5.0, help="length of the motion, s")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="another number of the scene")
    parser.add_argument("--with", action="append", default=[], metavar="NAME=JSON", help="another setting of the engine", dest="other")
    arguments = parser.parse_args()
    changes, other = (dict(pair.split("=", 1) for pair in pairs) for pairs in (arguments.set, arguments.other))
    if unknown := other.keys() - (names := settings.keys() - {"engine"}):
        raise SystemExit(f"--with: there is no {', '.join(unknown)}, but {', '.join(names)}")
    settings.update({name: json.loads(value) for name, value in other.items()})
    steps = round(arguments.end / arguments.dt)
    if abs(steps * arguments.dt - arguments.end) > 1e-9 * arguments.end:
        raise SystemExit(f"--end {arguments.end} s is not a whole number of steps of {arguments.dt} s")
    samples = max((s for s in range(SAMPLES[0], SAMPLES[1] + 1) if steps % s == 0), default=0)
    if not samples:
        raise SystemExit(f"{steps} steps are not a multiple of {SAMPLES[0]} to {SAMPLES[1]} samples: choose another --dt or --end")
    ball, rows = start(changes), []
    for state in motion(ball, arguments.dt, steps, steps // samples):
        rows.append(row(*state, np.array(rows[-1][3:6] if rows else ball.angles)))
        if not np.all(np.isfinite(rows[-1])) or abs(state[1][2] - ball.a) > SUNK * ball.a:
            raise SystemExit(f"t = {state[0]} s: centre at {state[1]} m; the limit is a height of {ball.a} m within {SUNK * ball.a} m")
    with open(arguments.out, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([["t", *COORDINATES, *(f"{q}'" for q in COORDINATES)], *rows])
    print(json.dumps(settings | {"dt": arguments.dt, "end": arguments.end, "set": changes}))
