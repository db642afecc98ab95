"""Films on which several formulations are right, or nothing is modelled that is there: is a right one excluded?

    python several.py PROGRAM [--films 300] [--seed 1] [--only tilt]

Films at 20 Hz of motions by Chetaev's law. *Contained*: the disc, the ball on the turntable with Ω unknown, and straight
lines are vakonomic motions as well, so that neither formulation may be excluded. *Not modelled*: a tilt of up to 0.2°, a
drag of up to 0.05/s, a clock up to 2 % fast, an inertia 1 to 5 % off; there Chetaev's formulation may not be excluded,
and no other one supported. Printed for each film, then for each kind: how many verdicts are wrong, and the exclusions that
are allowed, at the level of one in 9,300 films.
"""

import argparse
from collections import Counter

import numpy as np
from coverage import between, fitted, processor, table
from systems import COLUMNS, FREE, LAGRANGIAN, PARAMETERS, SECONDS, SYSTEMS, motion, truth

NOISE = [5e-4, 1e-3, 5e-3]
KINDS = {
    "contained": ["disc", "turntable", "heisenberg"],
    "tilt": ["disc", "heisenberg", "sledge"],
    "drag": ["disc", "sledge", "unicycle-in-potential"],
    "clock": ["sledge", "sleigh", "disc"],
    "inertia": ["sleigh", "unicycle-in-potential", "coin-on-incline"],
}
INERTIA = {"sleigh": "I", "unicycle-in-potential": "I", "coin-on-incline": "I"}
EVERY = 3


def made(kind, name, rng):
    """Times as they are told, rows, σ, and what is unknown."""
    system, sigma = SYSTEMS[name], float(rng.choice(NOISE))
    numbers = truth(name, "chetaev", rng)
    times = np.arange(1, int(60 * system[SECONDS]) + 1)[::EVERY] / 60
    told, own = times, name
    if kind == "tilt":
        push = 9.81 * np.radians(rng.uniform(0.02, 0.2))
        own = f"{name} tilted by {push}"
        mass = "m*" if "m" in system[PARAMETERS] else ""
        SYSTEMS[own] = (*system[:LAGRANGIAN], f"{system[LAGRANGIAN]} + {mass}{push}*y", *system[LAGRANGIAN + 1 :])
    if kind == "drag":
        numbers["drag"] = rng.uniform(0.005, 0.05)
    if kind == "clock":
        told = times * (1 + rng.uniform(0.002, 0.02))
    if kind == "inertia":
        known = INERTIA[name]
        numbers[known] = system[PARAMETERS][known] * (1 + rng.choice([-1, 1]) * rng.uniform(0.01, 0.05))
    rows = motion(own, "chetaev", numbers, times)
    return told, rows + sigma * rng.normal(size=rows.shape), sigma, list(system[FREE])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--films", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=KINDS)
    options = parser.parse_args()
    cases = [(kind, name) for kind, names in KINDS.items() for name in names if options.only in (None, kind)]
    counts = {}
    for number in range(options.films):
        kind, name = cases[number % len(cases)]
        told, rows, sigma, free = made(kind, name, np.random.default_rng([options.seed, number]))
        before = processor()
        try:
            answer = fitted(options.program, name, table(SYSTEMS[name][COLUMNS].split(), told, rows), free, sigma)
        except TimeoutError:
            answer = []
        verdicts = {row["formulation"]: row["verdict"] for row in answer}
        wrong = verdicts.get("chetaev") == "excluded" or verdicts.get("vakonomic") == "supported"
        wrong |= kind == "contained" and "excluded" in verdicts.values()
        word = "too slow" if not answer else "WRONG" if wrong else verdicts.get("chetaev", "not asked")
        counts.setdefault(kind, Counter())[word] += 1
        print(f"{number:3} {kind:10} {name:24} {sigma * 1e3:.1f} mm {processor() - before:5.2f} s {word:12} {verdicts}", flush=True)
    total = Counter()
    for kind, counter in counts.items():
        total += counter
        print(f"{kind:10} {dict(counter)}")
    print(f"{options.films} films, {total['WRONG']} wrong ({between(total['WRONG'], options.films)}), {options.films / 9300:.2f} by noise alone")


if __name__ == "__main__":
    main()
