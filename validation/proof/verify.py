"""Verifies that no multipliers mu_0 make a Chetaev motion vakonomic: python verify.py SCENE.toml CERTIFICATE.json

Plain Python, and nothing of the program that wrote the certificate (`deltaq prove SCENE --out CERTIFICATE.json`). Numbers of a scene are
decimals, angles at the start multiples of 1/N and quarter turns. T = e^(i/N) is transcendental (Lindemann): T -> tau, i -> a root of -1
maps all that is computed here into the integers mod p, if nothing is divided by 0 there. Along the motion mu = mu_0 + mu_1 t + ... solves
A' mu' + (d/dt A' - f_q') mu = -E, E = d/dt L_v - L_q - Q = A' lambda, A = f_v, in each power of t: through order K these are linear
equations S x = b for x = (mu_0 .. mu_(K+1)). If the named rows of [S | -b], each an order and the number of a coordinate, have a
determinant that is not 0 mod p, then it is not 0 in the numbers themselves, and no x solves S x = b."""

import json, math, re, sys, tomllib
from fractions import Fraction
from itertools import product, zip_longest

demand = lambda true, words: true or sys.exit(f"refused: {words}")
invert = lambda x: pow(x, -1, P)
plus = lambda x, y: [(a + b) % P for a, b in zip_longest(x, y, fillvalue=0)]
times = lambda x, y: [sum(x[j] * y[k - j] for j in range(k + 1)) % P for k in range(SIZE)]

class Jet:
    """A series in t mod p, pi apart, its derivatives by seeds, and its first term as (fraction, quarter turns) where that is known."""
    def __init__(self, c, d=None, first=None):
        self.c, self.d, self.first = (list(c) + [0] * SIZE)[:SIZE], d or {}, first
    def of(x):
        """A number; one that is a multiple of pi/2 to all the digits of a double is meant as that."""
        if isinstance(x, Jet):
            return x
        text, turns = repr(float(x)), round(float(x) / (math.pi / 2))
        if len(re.sub(r"e.*|\D", "", text)) >= 14 and 0 < abs(turns) <= 8 and abs(float(x) / turns / (math.pi / 2) - 1) <= 2.3e-16:
            return Jet([], {}, (Fraction(0), turns))
        return Jet([Fraction(text).numerator * invert(Fraction(text).denominator) % P], {}, (Fraction(text), 0))
    def plain(self):
        demand(not (self.first and self.first[1]), "pi stands outside of an angle")
        return self
    def chain(self, value, slope, first=None):
        return Jet(value, {s: times(slope, e) for s, e in self.d.items()}, first)
    def __add__(a, b):
        b = Jet.of(b)
        first = (a.first[0] + b.first[0], a.first[1] + b.first[1]) if a.first and b.first else a.plain() and b.plain() and None
        return Jet(plus(a.c, b.c), {s: plus(a.d.get(s, []), b.d.get(s, [])) for s in a.d | b.d}, first)
    def __mul__(a, b):
        b = Jet.of(b)
        for x, y in (a, b), (b, a):  # pi may be multiplied by a fraction that stays, and by nothing else
            y.first and not y.first[1] and not y.d and not any(y.c[1:]) or x.plain()
        first = a.first and b.first and (a.first[0] * b.first[0], a.first[0] * b.first[1] + a.first[1] * b.first[0])
        return Jet(times(a.c, b.c), (a.chain([], b.c) + b.chain([], a.c)).d, first)
    def __truediv__(a, b):
        b, c = Jet.of(b).plain(), []
        for k in range(SIZE):
            c.append(((k == 0) - sum(c[j] * b.c[k - j] for j in range(k))) * invert(b.c[0]) % P)
        return a * b.chain(c, [-x for x in times(c, c)], b.first and (1 / b.first[0], 0))
    def __pow__(a, n):
        n = Jet.of(n).plain().first[0]
        demand(n.denominator == 1, "a power is no whole number")
        return math.prod([a if n >= 0 else Jet.of(1) / a] * abs(int(n)), start=Jet.of(1))
    def turn(a, up, i):
        """e^(ia) or e^(-ia)"""
        demand(a.first and a.first[0] * N % 1 == a.first[1] % 1 == 0, "an angle at the start is no multiple of 1/N")
        c = [pow(up, int(a.first[0] * N), P) * pow(i, int(a.first[1]), P) % P]
        for k in range(1, SIZE):
            c.append(i * invert(k) * sum(j * a.c[j] * c[k - j] for j in range(1, k + 1)) % P)
        return a.chain(c, [i * x for x in c])
    __neg__, __sub__ = lambda a: a * -1, lambda a, b: a + Jet.of(b) * -1
    sin = lambda a: (a.turn(TAU, I) - a.turn(invert(TAU), -I)) / Jet([2 * I])
    cos = lambda a: (a.turn(TAU, I) + a.turn(invert(TAU), -I)) / 2

def read(text, scope):
    """A formula of a scene by Python's own reader; a name with primes is one name, and numbers are exact."""
    text = re.sub(r"(\w)'+", lambda m: m[0].replace("'", "_rate"), str(text)).replace("^", "**")
    demand(not re.search(r"__|[A-Za-z_]\.|\.[A-Za-z_]|[^\w\s+\-*/().,]", text), f"the formula {text}")
    text = re.sub(r"(?<![\w.])(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", r"F('\g<0>')", text)
    names = {"F": Jet.of, "sin": Jet.sin, "cos": Jet.cos, "tan": lambda a: a.sin() / a.cos(), "pi": Jet([], {}, (Fraction(0), 2))}
    return eval(text, names | {"__builtins__": {}}, scope)

def determinant(rows):
    k = next((k for k, row in enumerate(rows) if row[0] % P), None)
    if k is None:
        return int(not rows)
    first = [x * invert(rows[k][0]) % P for x in rows[k]]
    rest = [[(x - row[0] * y) % P for x, y in zip(row, first)][1:] for row in rows[:k] + rows[k + 1 :]]
    return (-1) ** k * rows[k][0] * determinant(rest) % P

def by_removal(table, at, rates):
    """All velocities, where the start gives rates of parameters: every coordinate to first order in t by way of the first removal."""
    removal = table["removal"] if "parameters" in table["removal"] else next(iter(table["removal"].values()))
    texts, at, definitions = removal.get("rates", {}) | removal.get("memory", {}), dict(at), table.get("definitions", {})
    for texts_now in definitions | removal.get("start", {}), definitions:
        for name, text in texts_now.items():
            at[name] = read(text, at)
        at |= {x + "_rate": rate for x, rate in rates.items()}
        rates = {x: read(text, at) for x, text in texts.items()} | rates
        at |= {x: Jet([at[x].c[0], rate.c[0]], {}, at[x].first) for x, rate in rates.items()}
    return {x: Jet(read(text, at).c[1:]) for x, text in removal.get("direct", {}).items()} | rates

def balance(table, at, q, v):
    """f with its derivatives, L_v, L_q and Q along series for q and v (seeds 0 .. n-1, n .. 2n-1), and what formulas may contain."""
    names, scope = list(table["coordinates"]), at | {"t": Jet([at["t"].c[0], 1], {}, at["t"].first)}
    for j, name in enumerate(names):
        scope |= {name: Jet(q[j], {j: Jet([1]).c}, at[name].first), name + "_rate": Jet(v[j], {len(names) + j: Jet([1]).c})}
    for name, text in table.get("definitions", {}).items():
        scope[name] = read(text, scope)
    f, forces = [read(text, scope).plain() for text in table["system"]["constraints"]], table["system"].get("forces", {})
    slopes = [read(table["system"]["lagrangian"], scope).d.get(seed, Jet([]).c) for seed in range(2 * len(names))]
    return f, slopes[len(names) :], slopes[: len(names)], [read(forces.get(x, 0), scope).plain().c for x in names], scope

def verify(table, proof):
    """The determinant of the named rows, after the start, the motion and its uniqueness have been verified."""
    names, order, at, start = list(table["coordinates"]), proof["order"], {}, table["start"]
    n, q, reactions = len(names), [proof["motion"][x] for x in names], proof["reactions"]
    v = [[(k + 1) * x % P for k, x in enumerate(c[1:])] for c in q]
    places = {name: entry.get("start", 0) for name, entry in table["coordinates"].items()}
    for name, written in ({"t": start.get("time", 0)} | table.get("parameters", {}) | places).items():
        at[name] = read(proof["set"].get("time" if name == "t" else name, written), at)
    given = (start["velocities"] | proof["set"]).items()
    rates = {x[:-1]: read(text, at) for x, text in given if x[-1] == "'" and x not in proof["completed"]}
    rates = by_removal(table, at, rates) if rates.keys() - set(names) else rates
    for x, c in zip(names, q):
        demand(at[x].c[0] == c[0] and (x not in rates or rates[x].plain().c[0] == c[1]), f"{x} at the start")
    demand({len(c) for c in q} == {SIZE} and len(reactions) == order + 1, "the length of a series")
    f, momenta, slopes, Q, scope = balance(table, at, q, v)
    h, A, B = len(f), *([[x.d.get(i, Jet([]).c) for i in seeds] for x in f] for seeds in (range(n, 2 * n), range(n)))
    E = [[((k + 1) * momenta[i][k + 1] - slopes[i][k] - Q[i][k]) % P for k in range(order + 1)] for i in range(n)]
    for i, k in product(range(n), range(order + 1)):
        demand((E[i][k] - sum(A[j][i][k - l] * reactions[l][j] for l in range(k + 1) for j in range(h))) % P == 0, "the motion")
    demand(not any(c for x in f for c in x.c[: order + 2]), "the constraints along the motion")
    moved = [balance(table, at, q, [[c[0], c[1] + (i == j), *c[2:]] for i, c in enumerate(v)]) for j in range(n)]
    matrix = [[moved[j][1][i][1] - momenta[i][1] for j in range(n)] + [-A[j][i][0] for j in range(h)] for i in range(n)]
    free = [j for j, x in enumerate(names) if x not in rates]
    linear = all(y.d[s][1] == x.d[s][1] for j in free for x, y in zip(f, moved[j][0]) for s in x.d if s >= n)
    demand(len(free) in (0, h) and linear and proof["completed"] in ([], [names[j] + "'" for j in free]), "what the start leaves open")
    divided = {"constraints at the start": determinant([[A[i][j][0] for j in free] for i in range(h)] if free else [])}
    divided["equations of motion"] = determinant(matrix + [[x[0] for x in row] + [0] * h for row in A])
    divided |= {text: read(text, scope).c[0] for text in proof["divided_by"] if text not in divided}
    demand(divided == proof["divided_by"] and all(divided.values()), "what is divided by")
    system = [[0] * (h * (order + 2)) + [E[i][k]] for k, i in proof["rows"]]
    for row, (k, i) in zip(system, proof["rows"]):
        for l, j in product(range(k + 1), range(h)):
            row[h * (k - l + 1) + j] += A[j][i][l] * (k - l + 1)
            row[h * (k - l) + j] += (l + 1) * A[j][i][l + 1] - B[j][i][l]
    demand(min(map(min, proof["rows"])) >= 0 and {len(row) for row in system} == {len(system)}, "the rows")
    return determinant(system)

if __name__ == "__main__":
    try:
        TABLE, PROOF = tomllib.load(open(sys.argv[1], "rb")), json.load(open(sys.argv[2]), parse_float=str, parse_constant=str)
        P, I, N, TAU, SIZE = PROOF["prime"], PROOF["i"], int(PROOF["N"]), PROOF["tau"], PROOF["order"] + 3
        demand(PROOF["schema"] == "deltaq/certificate/1" and all(pow(a, P - 1, P) == 1 for a in (2, 3, 5, 7)) and (I * I + 1) % P == 0, "schema, p or i")
        demand(verify(TABLE, PROOF) == PROOF["minor"] != 0, "the minor")
    except Exception as error:
        sys.exit(f"refused: {type(error).__name__}, {error}")
    print(f"verified: no mu_0 (order {PROOF['order']}, minor {PROOF['minor']} mod {P})", *PROOF["completed"])
