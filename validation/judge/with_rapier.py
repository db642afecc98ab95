"""Rapier in double precision, by the crate `validation/engine`: the table is a kinematic half-space. Licence Apache-2.0."""

import subprocess
import tomllib

import numpy as np
from scipy.spatial.transform import Rotation

import turntable

ROOT = turntable.SCENE.parents[3]
LOCK = tomllib.loads((ROOT / "Cargo.lock").read_text("utf-8"))
VERSION = next(p["version"] for p in LOCK["package"] if p["name"] == "rapier3d-f64")

SETTINGS = {
    "engine": f"rapier {VERSION}",
    "contacts": "shipped",  # all but the time step as shipped; or their natural frequency in Hz
    "friction": 1e9,  # fixed in the crate
}


def motion(ball, dt, steps, every):
    call = ["cargo", "run", "--release", "--quiet", "--package", "engine", "--bin", "turntable", "--"]
    call += [repr(dt), str(steps), str(every), str(SETTINGS["contacts"]), *(f"{name}={value}" for name, value in ball.changes.items())]
    lines = subprocess.run(call, check=True, capture_output=True, text=True, cwd=ROOT).stdout.splitlines()
    for line in lines:
        n = np.array([float(word) for word in line.split()])
        yield n[0], n[1:4], Rotation.from_quat(n[4:8], scalar_first=True).as_matrix(), n[8:11], n[11:14]


if __name__ == "__main__":
    turntable.run(SETTINGS, motion, __doc__)
