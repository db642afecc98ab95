"""Figures of motions on the turning table, from columns alone: `python plain.py A.csv B.csv C.csv`.

With z = x + iy, v = z', omega = omega_x + i omega_y: slip f = v + i a omega - i Omega z, zero where the ball rolls.
Growth and turning: `v ~ exp((growth + i turning) t)`, by Chetaev 0 and 2/7 Omega. Creep m/N and short arm s:
f = -(m/N) v' + s (i Omega z - v), where bodies sink into each other and the arm of the contact is (1 - s) a.
Fits leave out the first second, where contacts settle. Distance: of the centre to Chetaev's circle at the end.
Order: by differences of three files, each with half the step of the one before.
"""

import argparse
import csv

import numpy as np


def columns(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def figures(c, a, Omega, settle=1.0):
    t, z, v = c["t"], c["x"] + 1j * c["y"], c["x'"] + 1j * c["y'"]
    turn = np.exp(1j * c["psi"])
    omega = turn * (c["theta'"] - 1j * c["phi'"] * np.sin(c["theta"]))
    spin = c["psi'"] + c["phi'"] * np.cos(c["theta"])
    f = v + 1j * a * omega - 1j * Omega * z
    late = t >= settle
    logarithm = np.log(np.abs(v)) + 1j * np.unwrap(np.angle(v))
    rate = np.polyfit(t[late], logarithm[late].real, 1)[0] + 1j * np.polyfit(t[late], logarithm[late].imag, 1)[0]
    causes = np.array([-rate * v, 1j * Omega * z - v])[:, late]
    split = lambda c: np.concatenate([c.real, c.imag], axis=-1)
    (creep, short), *_ = np.linalg.lstsq(split(causes).T, split(f[late]))
    unexplained = np.abs(f[late] - creep * causes[0] - short * causes[1]).max()
    turning = 2j / 7 * Omega
    circle = z[0] + v[0] * (np.exp(turning * t) - 1) / turning
    return {
        "max|f| m/s": np.abs(f).max(), "late rms|f|": np.sqrt(np.mean(np.abs(f[late]) ** 2)), "m/N ms": 1e3 * creep,
        "arm short": short, "rest of f": unexplained, "growth 1/s": rate.real, "by slip alone": 8 / 343 * Omega**2 * creep,
        "turning-2/7": rate.imag / Omega - 2 / 7, "spin drift 1/s": np.polyfit(t[late], spin[late], 1)[0], "distance m": abs(z - circle)[-1],
    }, z[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE.csv")
    parser.add_argument("--radius", type=float, default=0.1, help="a, m")
    parser.add_argument("--rate", type=float, default=0.7, help="Omega, rad/s")
    arguments = parser.parse_args()
    ends = []
    for path in arguments.files:
        found, end = figures(columns(path), arguments.radius, arguments.rate)
        ends.append(end)
        print(path, ", ".join(f"{name} {value:.4g}" for name, value in found.items()))
    for A, B, C in zip(ends, ends[1:], ends[2:]):
        print(f"order {np.log2(abs(A - B) / abs(B - C)):.3f}; distance of the end from its limit, first order: {abs(B - C):.3g} m")


if __name__ == "__main__":
    main()
