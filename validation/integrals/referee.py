"""Referee of `deltaq integrals`: the same questions on the systems of the literature, without any of its code.

    python validation/integrals/referee.py [NAME ...] [--program target/release/deltaq] [--counts]

`literature.toml` has what is known, `scenes` and the catalogue what the program reads, systems.py the same by hand and
in other coordinates. All numbers are residues modulo a prime that is not the program's.

Measure: rho dq ds is invariant where v = N(q) s, A N = 0, iff X_b(log rho) = -(div X_b + d(s-dot^c)/ds^c, its part of
s^b). Taylor series of both sides at a random point, brackets of the X_b with what log rho has along them, ranks; rho may
have to be free of some coordinates (`free_of`).
Printed integrals: F-dot from accelerations by Lagrange's multipliers, in the scene's coordinates, at random states.
Counts (--counts, minutes): Taylor coefficients of F = k_I(q) s^I with F-dot = 0 to an order, in all coordinates. The
kernel as seen in its lower coefficients is a bound from above, and the number where it stays for three orders.
"""

import argparse
import itertools
import json
import random
import re
import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path

import numpy as np

from series import P, NoRoot, Series, coordinates, dot, residue
from systems import SYSTEMS

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
SEEDS = (1, 2)


def eliminated(forms, count):
    """A basis of the kernel of the forms, by Gauss-Jordan elimination of series; rows that vanish are dropped."""
    rows, pivots = [list(f) for f in forms], []
    for at in range(len(rows)):
        place = next(((i, j) for i in range(at, len(rows)) for j in range(count) if rows[i][j].constant()), None)
        if place is None:
            # rates are known to one order less
            left = [a for row in rows[at:] for x in row for a in x.terms if sum(a) < Series.order]
            assert not left, "the rank of the constraints drops at the point"
            break
        rows[at], rows[place[0]] = rows[place[0]], rows[at]
        over = rows[at][place[1]].inverse()
        rows[at] = [x * over for x in rows[at]]
        for i, row in enumerate(rows):
            if i != at and row[place[1]].terms:
                rows[i] = [x - row[place[1]] * y for x, y in zip(row, rows[at], strict=True)]
        pivots.append(place[1])
    free = [j for j in range(count) if j not in pivots]
    one = lambda i, j: -rows[pivots.index(i)][j] if i in pivots else Series.of(int(i == j))
    return [[one(i, j) for i in range(count)] for j in free]


def inverse(matrix):
    size = len(matrix)
    beside = [row + [Series.of(-int(i == j)) for j in range(size)] for i, row in enumerate(matrix)]
    kernel = eliminated(beside, 2 * size)
    return [[kernel[j][i] for j in range(size)] for i in range(size)]


def along(field, x):
    return sum((y * x.slope(i) for i, y in enumerate(field) if y.terms), Series({}))


def dynamics(system):
    """N, Gamma and G of s-dot^c = Gamma^c_ab s^a s^b + G^c, from N^T (d/dt dT/dv - dT/dq + dV/dq) = 0."""
    mass, basis = system.mass, eliminated(system.forms, system.count)
    m = len(basis)
    push = lambda x: [dot(row, x) for row in mass]
    momenta = [push(x) for x in basis]
    over = inverse([[dot(a, p) for p in momenta] for a in basis])
    lowered = [[[None] * m for _ in range(m)] for _ in range(m)]
    changes = [[[along(x, y) for y in row] for row in mass] for x in basis]
    for a, b in itertools.product(range(m), repeat=2):
        turned = push([along(basis[b], x) for x in basis[a]])
        moved = [dot(row, basis[a]) for row in changes[b]]
        for d in range(m):
            energy = Fraction(1, 2) * dot(basis[a], [dot(row, basis[b]) for row in changes[d]])
            lowered[a][b][d] = dot(basis[d], turned) + dot(basis[d], moved) - energy
    gamma = [[[-dot(over[c], lowered[a][b]) for b in range(m)] for a in range(m)] for c in range(m)]
    slopes = [along(x, system.potential) for x in basis]
    return basis, gamma, [-dot(row, slopes) for row in over]


def pivots_of(a):
    """Columns of the pivots of a matrix modulo P, from left to right; the matrix becomes its echelon form."""
    pivots = []
    for j in range(a.shape[1]):
        top = len(pivots)
        found = np.nonzero(a[top:, j])[0]
        if top == a.shape[0] or not len(found):
            continue
        a[[top, top + found[0]]] = a[[top + found[0], top]]
        a[top] = a[top] * pow(int(a[top, j]), -1, P) % P
        below = np.nonzero(a[:, j])[0]
        below = below[below != top]
        a[below, j:] = (a[below, j:] - a[below, j][:, None] * a[top, j:] % P) % P
        pivots.append(j)
    return pivots


def rank(rows):
    return len(pivots_of(np.array(rows, dtype=np.int64)))


def measure(system, free_of=()):
    """Ranks of the brackets, without and with what log rho would have along them."""
    basis, gamma, _ = dynamics(system)
    m = len(basis)
    first = []
    for b, x in enumerate(basis):
        theta = sum((y.slope(i) for i, y in enumerate(x)), Series({}))
        first.append((x, -sum((gamma[c][c][b] + gamma[c][b][c] for c in range(m)), theta)))
    first += [([Series.of(int(i == j)) for i in range(system.count)], Series({})) for j in free_of]
    values = lambda all, with_rate: [[y.constant() for y in x] + [t.constant()] * with_rate for x, t in all]
    layer, fields = first, []
    while True:
        more = []
        for field in layer:
            if rank(values([*fields, *more, field], True)) > len(fields) + len(more):
                more.append(field)
        fields += more
        if not more or rank(values(fields, False)) < len(fields):
            return rank(values(fields, False)), len(fields)
        assert len(fields) <= system.count
        bracket = lambda x, t, y, u: ([along(x, z) - along(y, w) for w, z in zip(x, y, strict=True)], along(x, u) - along(y, t))
        layer = [bracket(*x, *y) for x in first for y in more]


def count(system, degree, order):
    """Dimensions of the integrals of a degree, as seen in coefficients up to 0, 1, ... order."""
    basis, gamma, force = dynamics(system)
    m, n = len(basis), system.count
    unknown = [k for d in range(degree, -1, -2) for k in itertools.combinations_with_replacement(range(m), d)]
    powers = [a for a in itertools.product(range(order + 1), repeat=n) if sum(a) <= order]
    powers.sort(key=sum, reverse=True)
    columns = [(k, a) for a in powers for k in unknown]
    rows = {}
    for at, (k, a) in enumerate(columns):
        z = Series({a: 1})
        terms = [((*k, b), along(x, z)) for b, x in enumerate(basis)]
        for place, c in enumerate(k):
            rest = k[:place] + k[place + 1 :]
            terms += [((*rest, i, j), z * gamma[c][i][j]) for i, j in itertools.product(range(m), repeat=2)]
            terms.append((rest, z * force[c]))
        for key, series in terms:
            for b, c in series.terms.items():
                if sum(b) < order:
                    row = rows.setdefault((tuple(sorted(key)), b), {})
                    row[at] = (row.get(at, 0) + c) % P
    matrix = np.zeros((len(rows), len(columns)), dtype=np.int64)
    for i, row in enumerate(rows.values()):
        matrix[i, list(row)] = list(row.values())
    pivots = set(pivots_of(matrix))
    return [sum(sum(a) <= low and at not in pivots for at, (_, a) in enumerate(columns)) for low in range(order + 1)]


def settled(name, degree):
    """The number of integrals of a degree, by the first order at which it stays over three lower ones; or a bound."""
    for order in range(4, 11):
        seen = count(at_random(name, SEEDS[0], order + 2), degree, order)
        if seen[1] == seen[2] == seen[3]:
            return seen[1]
    return f"<= {seen[0]}"


def at_random(name, seed, order):
    number, _, build = SYSTEMS[name]
    while True:
        try:
            return build(coordinates(number, (), seed, order))
        except NoRoot:
            seed += 1000


def solved(rows, draw):
    """A solution of rows (coefficients, right-hand side), random where it is free."""
    width = len(rows[0]) - 1
    matrix = np.array(rows, dtype=np.int64)
    pivots = pivots_of(matrix)
    assert width not in pivots
    x = [0 if j in pivots else draw.randrange(P) for j in range(width)]
    for i, j in enumerate(pivots):
        x[j] = (int(matrix[i, width]) - sum(int(matrix[i, k]) * x[k] for k in range(width) if k not in pivots)) % P
    return x


def change(name, text, names, parameters, seed):
    """The rate of a printed function of q and q' at a random state of the scene's own chart."""
    n, angles, build = SYSTEMS[name]
    q = coordinates(n, angles, seed, 3)
    system, draw = build(q), random.Random(seed)
    forms = [[x.constant() for x in f] for f in system.forms]
    v = solved([[*f, -b.constant() % P] for f, b in zip(forms, system.offsets, strict=True)], draw)
    flow = lambda x: sum(v[i] * x.slope(i).constant() for i in range(n))
    mass, gyro = system.mass, system.gyroscopic
    rows = []
    for k in range(n):
        energy = sum(v[i] * v[j] * mass[i][j].slope(k).constant() for i in range(n) for j in range(n)) * pow(2, -1, P)
        turning = sum(v[i] * gyro[i].slope(k).constant() for i in range(n))
        force = energy + turning - system.potential.slope(k).constant() - sum(v[j] * flow(mass[k][j]) for j in range(n))
        rows.append([*(x.constant() for x in mass[k]), *(-f[k] % P for f in forms), (force - flow(gyro[k])) % P])
    for f, form, b in zip(forms, system.forms, system.offsets, strict=True):
        rows.append([*f, *[0] * len(forms), -(sum(v[j] * flow(form[j]) for j in range(n)) + flow(b)) % P])
    a = solved(rows, draw)[:n]
    # the function, to first order in q and q'
    state = coordinates(n, angles, seed, 1, True)
    scope = {key: residue(x) for key, x in parameters.items()} | dict(zip(names, state, strict=False))
    unit = lambda i: tuple(int(i == j) for j in range(2 * n))
    scope |= {f"{x}_rate": Series({(0,) * 2 * n: v[i], unit(n + i): 1}) for i, x in enumerate(names)}
    scope |= {"sin": lambda x: x.sin, "cos": lambda x: x.cos, "tan": lambda x: x.sin / x.cos, "F": Fraction}
    text = re.sub(r"(\w)'", r"\1_rate", text)
    text = re.sub(r"(?<![\w.])(\d+\.?\d*(?:e[+-]?\d+)?)", r'F("\1")', text).replace("^", "**")
    value = Series.of(eval(text, {"__builtins__": {}}, scope))
    slopes = [value.slope(i).constant() for i in range(2 * n)]
    return sum(slopes[i] * v[i] + slopes[n + i] * a[i] for i in range(n)) % P


def asked(program, entry):
    """What the program says; names of coordinates and numbers of its scene."""
    scene = entry["scene"]
    file = HERE / scene
    command = [program, "integrals", str(file) if file.exists() else scene, "--format", "json"]
    command += ["--degree", "2" if "quadratic" in entry else "1"]
    command += [word for key, x in entry.get("set", {}).items() for word in ("--set", f"{key}={x}")]
    answer = json.loads(subprocess.run(command, check=True, capture_output=True, text=True, timeout=600).stdout)
    built_in = (ROOT / "crates/scene" / folder / f"{scene}.toml" for folder in ("scenes", "classics"))
    text = tomllib.loads(next(f for f in (file, *built_in) if f.is_file()).read_text())
    return answer, list(text["coordinates"]), text["parameters"] | entry.get("set", {})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--program", default=str(ROOT / "target/release/deltaq"))
    parser.add_argument("--counts", action="store_true")
    options = parser.parse_args()
    entries = tomllib.loads((HERE / "literature.toml").read_text())["entry"]
    # what is not constant is noticed
    assert change("sleigh", "x'^2 + y'^2 + phi'^2", ["x", "y", "phi"], {}, SEEDS[0])
    wrong = 0
    for entry in entries:
        name = entry["name"]
        if options.names and name not in options.names:
            continue
        said, names, parameters = asked(options.program, entry)
        words = {"none": "none", "local": "some", "open": "open"}
        program = {"measure": words[said["measure"]["answer"]]}
        if program["measure"] != "open":
            program["reduced"] = "some" if program["measure"] == "some" and "none_free_of" not in said["measure"] else "none"
        for found in said["polynomials"]:
            open_ = found["answer"] == "open"
            most = f"<= {found['at_most']}" if "at_most" in found else "open"
            program[["linear", "quadratic"][found["degree"] - 1]] = most if open_ else found["at_most"]
        referee = {}
        if not entry.get("affine"):
            ranks = {measure(at_random(name, seed, 5), entry.get("free_of", ())) for seed in SEEDS}
            local = {measure(at_random(name, seed, 5)) for seed in SEEDS}
            referee = {"measure": " or ".join("some" if a == b else "none" for a, b in local)}
            if "free_of" in entry:
                referee["reduced"] = " or ".join("some" if a == b else "none" for a, b in ranks)
            if options.counts:
                referee |= {key: settled(name, d + 1) for d, key in enumerate(("linear", "quadratic")) if key in entry}
        print(f"{name}: {entry['claim']}", flush=True)
        for key in ("measure", "reduced", "linear", "quadratic"):
            known = [x[key] for x in (entry, program, referee) if key in x and not str(x[key]).startswith(("<", "open"))]
            agree = len(set(map(str, known))) <= 1
            wrong += not agree
            if key in entry:
                shown = [str(x.get(key, "-")) for x in (entry, program, referee)]
                print(f"  {key:10} known {shown[0]}, program {shown[1]}, referee {shown[2]}{'' if agree else '   DISAGREE'}")
        if entry.get("density", "") not in (said["measure"].get("density") or ""):
            wrong += 1
            print(f"  density {said['measure'].get('density')}, known {entry['density']}   DISAGREE")
        printed = [x["expression"] for x in said["ansatz"].get("printed", [])]
        for text in [*printed, *entry.get("integrals", [])]:
            kept = not any(change(name, text, names, parameters, seed) for seed in SEEDS)
            wrong += not kept
            print(f"  {'constant' if kept else 'NOT CONSTANT'}: {text[:90]}{'...' * (len(text) > 90)}")
        missing = entry.get("printed", len(printed)) - len(printed)
        wrong += missing != 0
        if missing:
            print(f"  {missing} fewer printed than known   DISAGREE")
    print(f"{len(entries) if not options.names else len(options.names)} entries, {wrong} disagreements")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
