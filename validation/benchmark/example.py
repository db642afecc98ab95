"""Answers of another program, as an example: `python example.py FOLDER` writes `sledge.csv`, to be judged by `judge.py`.

The ice sledge by hand, `L = (x'^2 + y'^2 + k^2 phi'^2)/2 + G x`, `f = y' cos(phi) - x' sin(phi)`, `G = g sin(alpha)`, in steps
of Runge and Kutta, order 4. Chetaev: `x'' = G - lambda sin(phi)`, `y'' = lambda cos(phi)`, `phi'' = 0`. Vakonomic, with
`L + mu f`: `x'' - (mu sin(phi))' = G`, `y'' + (mu cos(phi))' = 0`, `k^2 phi'' = -mu (y' sin(phi) + x' cos(phi))`.
"""

import csv
import sys
from math import cos, sin
from pathlib import Path

G, K = 9.81 * sin(0.4), 0.7
STEP = 1e-3


def chetaev(y):
    x, v, phi, a, b, w, _ = y
    reaction = w * (a * cos(phi) + b * sin(phi)) + G * sin(phi)  # keeps f' = 0
    return [a, b, w, G - reaction * sin(phi), reaction * cos(phi), 0.0, 0.0]


def vakonomic(y):
    _, _, phi, a, b, w, mu = y
    along = a * cos(phi) + b * sin(phi)
    rate = -w * along - G * sin(phi)  # mu', which keeps f' = 0
    return [a, b, w, G + rate * sin(phi) + mu * w * cos(phi), -rate * cos(phi) + mu * w * sin(phi), -mu * along / K**2, rate]


def step(rates, y, h):
    def moved(k, part):
        return [a + part * h * b for a, b in zip(y, k)]

    k1 = rates(y)
    k2 = rates(moved(k1, 0.5))
    k3 = rates(moved(k2, 0.5))
    k4 = rates(moved(k3, 1.0))
    return [a + h / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in zip(y, k1, k2, k3, k4)]


def main(folder):
    columns = ["x", "y", "phi", "x'", "y'", "phi'"]
    with open(Path(__file__).with_name("sledge.csv"), newline="", encoding="utf-8") as file:
        references = list(csv.DictReader(file))
    answers = []
    for formulation, rates in [("chetaev", chetaev), ("vakonomic", vakonomic)]:
        t, y = 0.0, []
        for row in (row for row in references if row["formulation"] == formulation):
            if float(row["t"]) == 0.0:
                t, y = 0.0, [float(row[c]) for c in columns] + [float(row["mu0_1"] or 0)]
            while t < float(row["t"]) - STEP / 2:
                t, y = t + STEP, step(rates, y, STEP)
            answers.append([formulation, row["start"], row["t"], *y[:6]])
    Path(folder).mkdir(parents=True, exist_ok=True)
    with open(Path(folder) / "sledge.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([["formulation", "start", "t", *columns], *answers])


if __name__ == "__main__":
    main(sys.argv[1])
