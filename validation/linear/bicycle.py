"""Eigenvalues of the benchmark bicycle, upright and straight, in 50 digits: writes bicycle.csv beside this file, or the file that is named.

The linear equations M q'' + v C1 q' + (g K0 + v^2 K2) q = 0, q = (lean, steer), are put together from the 25
parameters by the formulas of appendix A of Meijaard, Papadopoulos, Ruina and Schwab 2007. Nothing is taken
from the scene but its numbers: L and the constraints are not read.
"""

import csv
import sys
import tomllib
from pathlib import Path

from mpmath import cos, det, matrix, mp, mpf, polyroots, sin

mp.dps = 50
HERE = Path(__file__).resolve().parent
SCENE = HERE.parents[1] / "crates/scene/scenes/bicycle.toml"
# as the paper prints them
PRINTED = {
    "M": (80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686),
    "K0": (-80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618),
    "K2": (0, 76.59734589573222, 0, 2.65431523794604),
    "C1": (0, 33.86641391492494, -0.85035641456978, 1.68540397397560),
}


def parameters():
    """The numbers of the scene, in the axes of the paper: z points down there."""
    numbers = tomllib.loads(SCENE.read_text("utf-8"), parse_float=mpf)["parameters"]
    p = {name: mpf(x) for name, x in numbers.items()}
    return p | {name: -p[name] for name in ("zB", "zH", "IBxz", "IHxz")}


def canonical(p):
    """M, C1, K0 and K2 of appendix A."""
    w, c, la, rR, rF, mR, mB, mH, mF = (p[name] for name in "w c la rR rF mR mB mH mF".split())
    xB, zB, xH, zH = (p[name] for name in "xB zB xH zH".split())
    mT, mA = mR + mB + mH + mF, mH + mF
    xT = (xB * mB + xH * mH + w * mF) / mT
    zT = (-rR * mR + zB * mB + zH * mH - rF * mF) / mT
    ITxx = p["IRx"] + p["IBx"] + p["IHx"] + p["IFx"] + mR * rR**2 + mB * zB**2 + mH * zH**2 + mF * rF**2
    ITxz = p["IBxz"] + p["IHxz"] - mB * xB * zB - mH * xH * zH + mF * w * rF
    ITzz = p["IRx"] + p["IBz"] + p["IHz"] + p["IFx"] + mB * xB**2 + mH * xH**2 + mF * w**2
    xA, zA = (xH * mH + w * mF) / mA, (zH * mH - rF * mF) / mA
    IAxx = p["IHx"] + p["IFx"] + mH * (zH - zA) ** 2 + mF * (rF + zA) ** 2
    IAxz = p["IHxz"] - mH * (xH - xA) * (zH - zA) + mF * (w - xA) * (rF + zA)
    IAzz = p["IHz"] + p["IFx"] + mH * (xH - xA) ** 2 + mF * (w - xA) ** 2
    uA = (xA - w - c) * cos(la) - zA * sin(la)
    IAll = mA * uA**2 + IAxx * sin(la) ** 2 + 2 * IAxz * sin(la) * cos(la) + IAzz * cos(la) ** 2
    IAlx = -mA * uA * zA + IAxx * sin(la) + IAxz * cos(la)
    IAlz = mA * uA * xA + IAxz * sin(la) + IAzz * cos(la)
    mu = c / w * cos(la)
    SR, SF = p["IRy"] / rR, p["IFy"] / rF
    ST, SA = SR + SF, mA * uA + mu * mT * xT
    turn = mu * ST + SF * cos(la)
    M = matrix([[ITxx, IAlx + mu * ITxz], [IAlx + mu * ITxz, IAll + 2 * mu * IAlz + mu**2 * ITzz]])
    K0 = matrix([[mT * zT, -SA], [-SA, -SA * sin(la)]])
    K2 = matrix([[0, (ST - mT * zT) / w * cos(la)], [0, (SA + SF * sin(la)) / w * cos(la)]])
    C1 = matrix([
        [0, turn + ITxz / w * cos(la) - mu * mT * zT],
        [-turn, IAlz / w * cos(la) + mu * (SA + ITzz / w * cos(la))],
    ])
    return {"M": M, "C1": C1, "K0": K0, "K2": K2}


def polynomial(p, forms, v):
    """Coefficients of det(M s^2 + v C1 s + g K0 + v^2 K2), highest first."""
    K = p["g"] * forms["K0"] + v**2 * forms["K2"]
    entry = [[(forms["M"][i, j], v * forms["C1"][i, j], K[i, j]) for j in (0, 1)] for i in (0, 1)]

    def product(a, b):
        return [sum(a[i] * b[k - i] for i in range(3) if 0 <= k - i < 3) for k in range(5)]

    return [x - y for x, y in zip(product(entry[0][0], entry[1][1]), product(entry[0][1], entry[1][0]))]


def speed(p, forms, change, low, high):
    """Where a quantity that depends on the polynomial at v changes its sign."""
    low, high = mpf(low), mpf(high)
    sign = change(polynomial(p, forms, low)) > 0
    for _ in range(170):
        middle = (low + high) / 2
        low, high = (middle, high) if (change(polynomial(p, forms, middle)) > 0) == sign else (low, middle)
    return low


def hurwitz(a):
    """Zero where two roots are imaginary."""
    return a[1] * a[2] * a[3] - a[0] * a[3] ** 2 - a[1] ** 2 * a[4]


def main(file=HERE / "bicycle.csv"):
    p = parameters()
    forms = canonical(p)
    for name, printed in PRINTED.items():
        assert all(abs(x - y) < 1e-12 for x, y in zip(forms[name], printed)), (name, forms[name])
    assert det(forms["M"]) > 0
    with Path(file).open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["v", "real", "imaginary"])
        for v in range(11):
            roots = polyroots(polynomial(p, forms, mpf(v)), maxsteps=500, extraprec=400)
            for root in sorted(roots, key=lambda s: (-mpf(s.real), -mpf(s.imag))):
                # what has no imaginary part is left with one of round-off
                imaginary = mpf(0) if abs(root.imag) < mpf(10) ** -40 else root.imag
                rows.writerow([v, mp.nstr(root.real, 25), mp.nstr(imaginary, 25)])
        rows.writerow(["weave", mp.nstr(speed(p, forms, hurwitz, 4, 5), 25), ""])
        rows.writerow(["capsize", mp.nstr(speed(p, forms, lambda a: a[4], 6, 7), 25), ""])


if __name__ == "__main__":
    main(*sys.argv[1:])
