"""Films with something wrong that no formulation knows: do tests on residuals object before a verdict is given?

    python faults.py PROGRAM [--seed 1]

Ten faults of four sizes each, films of 1 mm of four scenes by two laws. A fault that is too small to be seen does no
harm where the verdict stays right; what must not be is a wrong verdict.
"""

import argparse
from collections import Counter

import numpy as np
from coverage import fitted, table
from systems import COLUMNS, FREE, LAGRANGIAN, SECONDS, SYSTEMS, motion, truth

SCENES = ["sledge", "nonholonomic-oscillator", "sleigh", "turntable"]
SIZES = [1, 1 / 4, 1 / 16, 1 / 64]
SIGMA = 1e-3
# name: what it is at size 1
FAULTS = {
    "wrong number": "g, k, a, Omega of the scene 5 % off",
    "spring": "a spring of 0.3 N/m along x",
    "drag": "a drag of 0.1/s",
    "clock": "2 % fast",
    "outliers": "20 σ, 3 % of cells",
    "swapped": "x and y, from the end back over the whole film",
    "camera": "x, y turned by 4°",
    "lost frames": "8 in the middle, times not moved",
    "pixels": "of 8 σ",
    "noise": "3 times σ",
}


def faulty(fault, size, scene, law, rng):
    """Rows of a film with a fault; starts are unknown, the scene's parameter is not."""
    system = SYSTEMS[scene]
    numbers = truth(scene, law, rng)
    *free, parameter = system[FREE]
    numbers[parameter] = system[FREE][parameter][0]
    times = np.arange(1, int(60 * system[SECONDS]) + 1) / 60
    told, name, sigma = times, scene, SIGMA
    if fault == "wrong number":
        numbers[parameter] *= 1 + 0.05 * size
    if fault == "spring":
        name = f"{scene} with a spring of {0.3 * size}"
        SYSTEMS[name] = (*system[:LAGRANGIAN], f"{system[LAGRANGIAN]} - {0.15 * size}*x**2", *system[LAGRANGIAN + 1 :])
    if fault == "drag":
        numbers["drag"] = 0.1 * size
    if fault == "clock":
        told = times * (1 + 0.02 * size)
    if fault == "lost frames":
        told, times = times, times + 8 / 60 * size * (times > times[-1] / 2)
    if fault == "noise":
        sigma *= 1 + 2 * size
    rows = motion(name, law, numbers, times)
    rows += sigma * rng.normal(size=rows.shape)
    if fault == "outliers":
        rows += 20 * size * SIGMA * (rng.uniform(size=rows.shape) < 0.03) * rng.choice([-1, 1], rows.shape)
    if fault == "swapped":
        last = slice(len(rows) - int(size * len(rows)), None)
        rows[last, :2] = rows[last, 1::-1]
    if fault == "camera":
        angle = np.radians(4 * size)
        rows[:, :2] = rows[:, :2] @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    if fault == "pixels":
        rows = np.round(rows / (8 * size * SIGMA)) * 8 * size * SIGMA
    return told, rows, free


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    counts = {}
    for i, fault in enumerate(FAULTS):
        for j, scene in enumerate(SCENES):
            for k, law in enumerate(("chetaev", "vakonomic")):
                for size in SIZES:
                    times, rows, free = faulty(fault, size, scene, law, np.random.default_rng([options.seed, i, j, k]))
                    answer = fitted(options.program, scene, table(SYSTEMS[scene][COLUMNS].split(), times, rows), free, SIGMA)
                    right = next(row for row in answer if row["formulation"] == law)
                    best = min((row for row in answer if row["fit"]), key=lambda row: row["fit"]["chi_squared"])
                    words = {"none": "objects", "supported": "right", "cannot-tell": "cannot tell"}
                    verdict = words.get(right["verdict"], "WRONG")
                    counts.setdefault(fault, {}).setdefault(size, Counter())[verdict] += 1
                    tests = [test["name"] for test in best["fit"]["tests"] if test["objects"]]
                    chi = {row["label"]: round(row["fit"]["chi_squared"], 1) if row["fit"] else row["words"][:40] for row in answer}
                    print(f"{fault:12} {size:8.5f} {scene:24} {law:10} {verdict:12} {tests} {best['fit']['freedom']} {chi}", flush=True)
    for fault, sizes in counts.items():
        print(f"{fault:12} ({FAULTS[fault]})")
        for size, counter in sizes.items():
            print(f"    times {size:8.5f}: {dict(counter)}")


if __name__ == "__main__":
    main()
