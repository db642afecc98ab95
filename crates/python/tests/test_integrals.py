"""Invariant measures that the program writes down, against the divergence of Chetaev's motion by differences."""

import json
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import deltaq

PROGRAM = Path(sys.prefix).parent / "release" / "deltaq"
STEP = 1e-3
# scenes whose det(g) is one number
CONSTANT = ["disc"]


def density(scene):
    """What is said: names of the free velocities, exponents of |det(g)| and of |sin| and |cos| by coordinate."""
    said = subprocess.run([PROGRAM, "integrals", scene, "--degree", "1", "--format", "json"], check=True, capture_output=True, text=True)
    text = json.loads(said.stdout)["measure"]["density"]
    factors = {name: Fraction(power or 1) for name, power in re.findall(r"(\|\w+\(\w+\)\|)(?:\^\(([^)]*)\))?", text.split(" dq ds")[0])}
    return re.search(r"s = \(([^)]*)\)", text)[1].split(", "), factors


class Motion:
    """Chetaev's motion in (q, s), s some of the velocities."""

    def __init__(self, scene, free):
        self.system = deltaq.built_in(scene)
        self.equations = self.system.equations()
        self.names = list(self.system.coordinates)
        self.free = [self.names.index(name.removesuffix("'")) for name in free]

    def basis(self, q):
        """Velocities by the free ones: f = A v is linear."""
        n = len(self.names)
        rows = np.array([self.system.constraint(0.0, q, v) for v in np.eye(n)]).T
        bound = [i for i in range(n) if i not in self.free]
        basis = np.zeros((n, len(self.free)))
        basis[self.free] = np.eye(len(self.free))
        basis[bound] = -np.linalg.solve(rows[:, bound], rows[:, self.free])
        return basis

    def rates(self, q, s):
        v = self.basis(q) @ s
        return v, np.asarray(self.equations.acceleration(0.0, q, v))[self.free]

    def density(self, q, factors):
        basis = self.basis(q)
        value = np.linalg.det(basis.T @ self.system.mass(0.0, q, np.zeros(len(q))) @ basis) ** float(factors.get("|det(g)|", 0))
        for name, power in factors.items():
            if found := re.match(r"\|(sin|cos)\((\w+)\)\|", name):
                value *= abs(getattr(np, found[1])(q[self.names.index(found[2])])) ** float(power)
        return value

    def divergence(self, q, s, factors):
        """Of density times rates, over density and size of the rates; differences of order 4."""
        def slope(of):
            return (8 * (of(STEP) - of(-STEP)) - (of(2 * STEP) - of(-2 * STEP))) / (12 * STEP)

        def moved(x, i, h):
            return x + h * np.eye(len(x))[i]

        def flow(i, h):
            there = moved(q, i, h)
            return self.density(there, factors) * self.rates(there, s)[0][i]

        total = sum(slope(lambda h, i=i: flow(i, h)) for i in range(len(q))) / self.density(q, factors)
        total += sum(slope(lambda h, a=a: self.rates(q, moved(s, a, h))[1][a]) for a in range(len(s)))
        return total / np.linalg.norm(s)


@pytest.mark.parametrize("scene", ["chaplygin-sphere", "rubber-chaplygin-sphere", "veselova", "snakeboard", "disc", "martinet"])
def test_the_flow_keeps_the_density_that_is_written(scene):
    free, factors = density(scene)
    motion, random = Motion(scene, free), np.random.default_rng(1)
    start = np.asarray(motion.system.start.q)
    off = []
    for _ in range(5):
        q, s = start + 0.3 * random.uniform(-1, 1, len(start)), random.uniform(-1, 1, len(free))
        assert abs(motion.divergence(q, s, factors)) < 1e-8
        # another power of the metric is not kept where that varies
        off.append(abs(motion.divergence(q, s, factors | {"|det(g)|": factors.get("|det(g)|", 0) + 1})))
    assert max(off) > 1e-3 or scene in CONSTANT, off
