"""A program that embeds deltaq: processes of joblib, threads over `rates`, and figures of its own."""

import sys
from concurrent.futures import ThreadPoolExecutor
from types import MappingProxyType

import matplotlib

matplotlib.use("Agg")
import deltaq
import matplotlib.pyplot as plt
import numpy as np
from joblib import Memory, Parallel, delayed, dump, load

folder = sys.argv[1]
times = np.linspace(0.0, 3.0, 31)
sledge = deltaq.built_in("sledge")


def slid(system, slope, formulation="chetaev"):
    return system.replace(MappingProxyType({"alpha": slope})).solve(formulation, times)


# motions come back from other processes, from a cache and from a file as they were
slopes = [0.2, 0.3, 0.4]
motions = Parallel(n_jobs=2)(delayed(slid)(sledge, slope) for slope in slopes)
cached = Memory(folder, verbose=0).cache(slid)
for slope, motion in zip(slopes, motions):
    for _ in range(2):
        np.testing.assert_array_equal(cached(sledge, slope).coordinates, motion.coordinates)
dump(motions, f"{folder}/motions.joblib")
np.testing.assert_array_equal(load(f"{folder}/motions.joblib")[1].at(1.5).coordinates, motions[1].at(1.5).coordinates)

# an integrator of its own, whose right-hand sides threads evaluate
equations, h = sledge.replace({"alpha": slopes[0]}).equations("chetaev"), 1e-3
with ThreadPoolExecutor(4) as pool:
    states = np.array([equations.initial_state()] * 4)
    for step in range(1000):
        half = states + h / 2 * np.array(list(pool.map(equations.rates, [step * h] * 4, states)))
        states = states + h * np.array(list(pool.map(equations.rates, [(step + 0.5) * h] * 4, half)))
assert np.ptp(states, axis=0).max() == 0.0 and abs(states[0, :3] - motions[0].at(1.0).coordinates).max() < 1e-5

# figures of its own stay open and are drawn into
figure, axes = plt.subplots(3, 1)
for motion in motions:
    motion.plot(ax=axes)
assert plt.get_fignums() == [figure.number] and all(len(axis.lines) == 3 for axis in axes)
figure.savefig(f"{folder}/slid.png")
print("the session has ended")
