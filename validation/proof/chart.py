"""Series in several variables, and a plain scene along them: for integrals.py, with the arithmetic of verify.py."""

import re, secrets
from fractions import Fraction

import verify
from verify import Formulas, Series, demand, invert, readable, slopes_of

POINTS, BITS = 8, 10

# Series in several variables --------------------------------------------------------------------------------------------------------------

class Part(dict):
    """The terms of one weight of a polynomial mod p, by exponents in packs of bits. Series have such coefficients in the place of numbers:
    with the sum of w_i z_i d/dz_i for t d/dt the recurrences for powers, exp and sine are the same."""
    def __add__(a, b):
        total = Part(a)
        for key, x in b.items() if b else ():
            total[key] = total.get(key, 0) + x
        return total
    def __mul__(a, b):
        if isinstance(b, int):
            return Part({key: x * b for key, x in a.items()}) if b else 0
        total = Part()
        for i, x in a.items():
            for j, y in b.items():
                total[i + j] = total.get(i + j, 0) + x * y
        return total
    def __mod__(a, p):
        return Part({key: y for key, x in a.items() if (y := x % p)}) or 0
    __sub__, __rsub__, __neg__ = lambda a, b: a + b * -1, lambda a, b: a * -1 + b, lambda a: a * -1
    __radd__, __rmul__ = __add__, __mul__

class Chart:
    """Series in z, by weights."""
    def __init__(self, weights):
        self.weights = weights
    def split(self, terms):
        """The parts, from that of weight 0, a number, of a polynomial with the terms {exponents: coefficient}."""
        parts = [Part() for _ in range(verify.SIZE)]
        for exponents, x in terms.items():
            weight = sum(w * e for w, e in zip(self.weights, exponents))
            if weight < len(parts):
                key = sum(e << BITS * i for i, e in enumerate(exponents))
                parts[weight][key] = parts[weight].get(key, 0) + x
        return [parts[0].get(0, 0) % verify.P, *(part % verify.P for part in parts[1:])]
    def slope(self, part, i):
        """d/dz_i of a part"""
        shift, one = BITS * i, 1 << BITS * i
        return Part({key - one: x * e for key, x in part.items() if (e := key >> shift & 2**BITS - 1)}) % verify.P if part else 0
    def along(self, field, f):
        """The derivative of a series along a field."""
        total = Series.of(0)
        for i, y in enumerate(field[: len(self.weights)]):
            later = f.c[self.weights[i] :]
            if any(later) and any(y.c):
                parts = [self.slope(part, i) for part in later]
                total += y * Series([parts[0] and parts[0].get(0, 0), *parts[1:]])
        return total
    def bracket(self, Y, Z):
        minus = lambda a, b: a + b * -1
        return [minus(self.along(Y, z), self.along(Z, y)) for y, z in zip(Y, Z)]

dot = lambda a, b: sum((x * y for x, y in zip(a, b, strict=True)), Series.of(0))
turned = lambda matrix: [list(row) for row in zip(*matrix)]

def solve(matrix, right, words):
    """The X of (matrix) X = (right), of series."""
    rows = [[*a, *b] for a, b in zip(matrix, right, strict=True)]
    for i in range(len(rows)):
        k = next((k for k in range(i, len(rows)) if rows[k][i].c[0]), None)
        demand(k is not None, words)
        rows[i], rows[k] = rows[k], rows[i]
        over = rows[i][i] ** -1
        rows[i] = [x * over if any(x.c) else x for x in rows[i]]
        for row in rows:
            if row is not rows[i] and any(row[i].c):
                factor = row[i] * -1
                row[:] = [x + factor * y if any(y.c) else x for x, y in zip(row, rows[i])]
    return [row[len(rows) :] for row in rows]

class Span:
    """Sparse vectors mod p, with what they are made of."""
    def __init__(self):
        self.pivots = []
    def add(self, vector, made):
        """None for a vector that is independent of the earlier ones, else the combination of vectors that is 0."""
        for key, other, of in self.pivots:
            if factor := -vector.get(key, 0) % verify.P:
                for total, part in ((vector, other), (made, of)):
                    for k, x in part.items():
                        if y := (total.get(k, 0) + factor * x) % verify.P:
                            total[k] = y
                        else:
                            total.pop(k, None)
        if not vector:
            return made
        key = next(iter(vector))
        over = invert(vector[key])
        self.pivots.append((key, *({k: x * over % verify.P for k, x in part.items()} for part in (vector, made))))

# The scene --------------------------------------------------------------------------------------------------------------------------------

class System:
    """The formulas of a plain scene, and their values."""
    def __init__(self, scene, *texts):
        self.scene, self.names, self.formulas = scene, scene["coordinates"], Formulas()
        self.rates = [x + "'" for x in self.names]
        read = self.formulas.read
        self.L, self.f = read(scene["lagrangian"]), [read(text) for text in scene["constraints"]]
        self.Q = [read(scene["forces"].get(x, "0")) for x in self.names]
        self.texts = [read(text) for text in texts]
        places = [self.L, *self.f, *self.Q, *self.texts]
        readable(all(isinstance(place, int) for place in places), "a formula of the scene that is not a number")
        moving = {*self.names, *self.rates, "t"}
        self.box = None
        if self.formulas.branches(moving):
            self.box = verify.about(verify.decimals(verify.numbers_of(scene)), ["t", *self.names])
            self.formulas.on_one_branch(moving, self.box | verify.parameters_of(scene))
    def names_in(self, places):
        return {args[0] for kind, *args in self.formulas.below(places) if kind == "name"}
    def start(self):
        """The numbers of the certificate."""
        verify.resize(1)
        return verify.started(self.scene)
    def elsewhere(self):
        """The scene with a drawn point: on the branch of its own where roots have branches, else of any signs."""
        drawn = lambda: f"{secrets.choice('+-')}{secrets.randbelow(2**40) + 1}/{secrets.randbelow(2**10) + 1}"
        at = verify.drawn_in(self.box) if self.box else {x: drawn() for x in ["t", *self.names]}
        return self.scene | {"time": at.pop("t"), "positions": at}
    def draw(self):
        """Numbers of a drawn point."""
        verify.resize(1)
        return verify.started(self.elsewhere())
    def run(self, at, q, v, **more):
        still = {name: Series(x.c[:1], x.first) for name, x in at.items()}
        return self.formulas.run(still | dict(zip(self.names, q)) | dict(zip(self.rates, v)) | more)
    def free(self, names):
        demand(len(set(names)) == len(names) and set(names) <= set(self.rates), "the free velocities")
        demand(len(names) + len(self.f) == len(self.names), "the number of free velocities")
        return [self.rates.index(name) for name in names]
    def mechanical(self):
        """Demands L = v'Mv/2 - V, Q(q), A v = 0, at drawn points: the parallelogram of L, and the sum of f."""
        readable("t" not in self.names_in([self.L, *self.f, *self.Q]), "a scene that contains t")
        readable(not self.names_in(self.Q) & set(self.rates), "forces that contain velocities")
        for _ in range(POINTS):
            at = self.draw()
            u, v = ([secrets.randbelow(verify.P) for _ in self.names] for _ in range(2))
            values = [self.run(at, [], [Series([(a * x + b * y) % verify.P]) for x, y in zip(u, v)])
                      for a, b in ((0, 0), (1, 0), (0, 1), (1, 1), (1, -1))]
            none, first, second, both, other = ([x[place].plain().c[0] for place in (self.L, *self.f)] for x in values)
            square = both[0] + other[0] + 2 * (none[0] - first[0] - second[0])
            readable(square % verify.P == 0, "a Lagrangian that is not quadratic in v but for a function of q")
            linear = all((z - x - y) % verify.P == 0 for x, y, z in zip(first[1:], second[1:], both[1:]))
            readable(linear, "constraints that are not linear and homogeneous in v")
    def local(self, at, q, free):
        """M, V, Q and the columns of N as series along q."""
        M, A, n = [], [], len(self.names)
        for j in range(n):
            v = [Series([int(i == j)], (Fraction(i == j), 0), leaf=True) for i in range(n)]
            values = self.run(at, q, v)
            M.append([Series(c) for c in slopes_of(values[self.L].plain(), v)])
            A.append([Series(values[place].plain().c) for place in self.f])
        rest = self.run(at, q, [Series.of(0)] * n)
        others = [i for i in range(n) if i not in free]
        N = [[Series.of(int(i == b)) for i in range(n)] for b in free]
        right = [[A[b][j] * -1 for b in free] for j in range(len(self.f))]
        for i, row in zip(others, solve([[A[i][j] for i in others] for j in range(len(self.f))], right, "the free velocities")):
            for b, x in enumerate(row):
                N[b][i] = x
        return M, Series(rest[self.L].plain().c) * -1, [Series(rest[place].plain().c) for place in self.Q], N
    def near(self, at, free, size):
        """The series of `local` along q0 + z."""
        verify.resize(size)
        chart = Chart([1] * len(self.names))
        unit = lambda i: tuple(int(i == j) for j in range(len(self.names)))
        q = [Series(chart.split({unit(-1): at[x].c[0], unit(i): 1}), at[x].first) for i, x in enumerate(self.names)]
        return chart, *self.local(at, q, free)

    def jets(self, at, v):
        """Right sides of the equations [L_vv, -A'; A, 0] (a, lambda) = r at v + dv, of order 0 and 1 in dv; the matrix, f_q and the values.
        Series in tau and dv: q + tau (v + dv), v + dv, t + tau"""
        n, h = len(self.names), len(self.f)
        verify.resize(3)
        tau, dv = Part({1: 1}), [Part({1 << BITS * (j + 1): 1}) for j in range(n)]
        number = lambda at, x, *parts: Series([at[x].c[0], *parts], at[x].first, leaf=x != "t")
        q = [number(at, x, tau * v[j], tau * dv[j]) for j, x in enumerate(self.names)]
        speeds = [Series([v[j], dv[j]], leaf=True) for j in range(n)]
        values = self.run(at, q, speeds, t=number(at, "t", tau))
        slopes = slopes_of(values[self.L].plain(), [*q, *speeds])
        both = [slopes_of(values[place].plain(), [*q, *speeds]) for place in self.f]
        term = lambda c, *keys: c[len(keys)].get(sum(keys), 0) if c[len(keys)] else 0
        of_order = lambda c, *keys: [term(c, *keys) if keys else c[0], *(term(c, *keys, 1 << BITS * (j + 1)) for j in range(n))]
        A = [[c[0] for c in x[n:]] for x in both]
        matrix = [[*(term(c, 1 << BITS * (j + 1)) for j in range(n)), *(-row[i] for row in A)] for i, c in enumerate(slopes[n:])]
        matrix += [row + [0] * h for row in A]
        force = [of_order(values[place].plain().c) for place in self.Q]
        right = [[x + y - z for x, y, z in zip(of_order(slopes[i]), force[i], of_order(slopes[n + i], 1))] for i in range(n)]
        right += [[-x for x in of_order(values[place].c, 1)] for place in self.f]
        series = lambda rows: [[Series([x % verify.P]) for x in row] for row in rows]
        verify.resize(1)
        return solve(series(matrix), series(right), "the equations of motion are not regular"), A, [[c[0] for c in x[:n]] for x in both]

def root(l, p):
    """s with s^2 = l: (x + s)^((p-1)/2) = a + b s in F_p[s] is 1 and -1 for the two s if a = 0"""
    a = 1
    while a:
        (a, b), (c, d), power = (1, 0), (secrets.randbelow(p), 1), p // 2
        while power:
            if power & 1:
                a, b = (a * c + b * d * l) % p, (a * d + b * c) % p
            c, d, power = (c * c + d * d * l) % p, 2 * c * d % p, power >> 1
    return pow(b, -1, p)

def own_images(proof):
    """Images of the verifier's own: e^(2 pi i/M) as in the certificate, e^i and e of a prime order, roots of the same primes."""
    M, r = proof["unity"][0], 4
    while not verify.is_prime(r):
        r = 2**60 + secrets.randbelow(2**60)
    roots = [int(l) for l in proof["roots"] if re.fullmatch(r"[1-9]\d*", l)]
    readable(len(roots) == len(proof["roots"]) < 10, "the roots")
    while not verify.is_prime(p := M * r * (secrets.randbelow(2**40) + 1) + 1) or any(pow(l, p // 2, p) != 1 for l in roots):
        pass
    def of_order(n, primes):
        x = 1
        while any(pow(x, n // l, p) == 1 for l in primes):
            x = pow(secrets.randbelow(p - 1) + 1, (p - 1) // n, p)
        return x
    divisors = [l for l in range(2, 2**16) if M % l == 0 and verify.is_prime(l)]
    divisors += [M // d for d in range(1, 2**16) if M % d == 0 and verify.is_prime(M // d)]
    unity, e_i, e = of_order(M, divisors), of_order(r, [r]), of_order(r, [r])
    cyclotomic = lambda l: M % (8 if l == 2 else l) == 0
    found = {str(l): root(l, p) for l in roots if not cyclotomic(l)}
    verify.map_to(p, [M, unity], {"order": r, "e^i": e_i, "e": e}, found)
