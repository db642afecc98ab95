"""The multipliers with which Chetaev's motion is vakonomic, by power series in 60 digits from the text of a scene.

A curve q(t) with f = 0 is vakonomic if and only if there is mu(t) with d/dt F_v - F_q = Q, F = L + mu . f, that is

    A' mu' + (d/dt A' - f_q') mu = -E,   E = d/dt L_v - L_q - Q,   A = f_v     (Chetaev's motion: E = A' lambda).

The motion is computed order by order in t. Then mu = mu_0 + mu_1 t + ... is unknown, and the equation through order K is one linear system for
all its coefficients together: no null space, no left inverse, nothing transported. What binds mu_0 alone, once the others are eliminated, is the
answer. Lengths, times and constraints are scaled, and what is then below `ZERO` is zero.
"""

import math
import tomllib
from decimal import Decimal, getcontext
from itertools import product
from operator import add, mul

import mpmath

from reader import Scene, value

getcontext().prec, mpmath.mp.dps = 60, 70
ZERO = Decimal("1e-25")
# what is below this is round-off, and no motion
REST = Decimal("1e-45")


def at(name, x):
    return Decimal(mpmath.nstr(getattr(mpmath, name)(mpmath.mpf(str(x))), 65))


class Series:
    """A power series in t and its derivatives by seeds, all of one length."""

    def __init__(self, c, d=None):
        self.c, self.d = c, d or {}

    def __add__(self, x):
        if not isinstance(x, Series):
            return Series([self.c[0] + x, *self.c[1:]], self.d)
        both = {s: list(map(add, self.d[s], x.d[s])) for s in self.d.keys() & x.d.keys()}
        return Series(list(map(add, self.c, x.c)), self.d | x.d | both)

    def __mul__(self, x):
        if not isinstance(x, Series):
            return Series([a * x for a in self.c], {s: [a * x for a in e] for s, e in self.d.items()})
        slopes = self.chain([], x.c) + x.chain([], self.c)
        return Series(convolved(self.c, x.c), slopes.d)

    def chain(self, y, slope):
        """y(x) for a known slope dy/dx."""
        return Series(y, {s: convolved(e, slope) for s, e in self.d.items()})

    def inverse(self):
        c = [1 / self.c[0]]
        for k in range(1, len(self.c)):
            c.append(-c[0] * sum(map(mul, self.c[1 : k + 1], c[::-1])))
        return self.chain(c, [-x for x in convolved(c, c)])

    def sqrt(self):
        c = [self.c[0].sqrt()]
        for k in range(1, len(self.c)):
            c.append((self.c[k] - sum(map(mul, c[1:k], c[:0:-1]))) / (2 * c[0]))
        return self.chain(c, [x / 2 for x in Series(c).inverse().c])

    def exp(self):
        c = [self.c[0].exp()]
        for k in range(1, len(self.c)):
            c.append(sum(j * self.c[j] * c[k - j] for j in range(1, k + 1)) / k)
        return self.chain(c, c)

    def integrated(self, first, slope):
        """y(x) with y = `first` at the start and dy/dx = `slope`, a series."""
        c = [first]
        for k in range(1, len(self.c)):
            c.append(sum(j * self.c[j] * slope.c[k - j] for j in range(1, k + 1)) / k)
        return self.chain(c, slope.c)

    def log(self):
        return self.integrated(self.c[0].ln(), self.inverse())

    __radd__, __rmul__ = __add__, __mul__
    __neg__, __sub__, __rsub__ = lambda self: self * -1, lambda self, x: self + -x, lambda self, x: -self + x
    __truediv__ = lambda self, x: self * (x.inverse() if isinstance(x, Series) else Decimal(1) / x)
    __rtruediv__ = lambda self, x: self.inverse() * x


def convolved(a, b):
    back, size = b[::-1], len(a)
    return [sum(map(mul, a[: k + 1], back[size - 1 - k :])) for k in range(size)]


class Algebra:
    """Series and plain numbers for the reader of scenes."""

    pi = at("acos", -1)

    def number(self, text):
        turns = round(float(text) / (float(self.pi) / 2))  # a multiple of pi/2 to all its digits is meant as that
        return turns * self.pi / 2 if len(text) > 15 and float(text) == turns * (float(self.pi) / 2) else Decimal(text)

    def sin(self, x):
        return at("sin", x) if not isinstance(x, Series) else self.circle(x)[0]

    def cos(self, x):
        return at("cos", x) if not isinstance(x, Series) else self.circle(x)[1]

    def circle(self, x):
        s, c = [at("sin", x.c[0])], [at("cos", x.c[0])]
        for k in range(1, len(x.c)):
            rates = [j * x.c[j] / k for j in range(k, 0, -1)]
            s, c = s + [sum(map(mul, rates, c))], c + [-sum(map(mul, rates, s))]
        return x.chain(s, c), x.chain(c, [-a for a in s])

    def tan(self, x):
        return self.sin(x) / self.cos(x)

    def sqrt(self, x):
        return x.sqrt()

    def exp(self, x):
        return x.exp()

    def log(self, x):
        return x.log() if isinstance(x, Series) else x.ln()

    def sinh(self, x):
        return (self.exp(x) - self.exp(-x)) / 2

    def cosh(self, x):
        return (self.exp(x) + self.exp(-x)) / 2

    def tanh(self, x):
        twice = self.exp(2 * x)
        return (twice - 1) / (twice + 1)

    def asin(self, x):
        return self.inverse_function("asin", x, lambda x: 1 / self.sqrt(1 - x * x))

    def acosh(self, x):
        return self.inverse_function("acosh", x, lambda x: 1 / self.sqrt(x * x - 1))

    def atan2(self, y, x):
        if (x.c[0] if isinstance(x, Series) else x) <= 0:
            raise ValueError("atan2 beyond a quarter turn")
        return self.inverse_function("atan", y / x, lambda z: 1 / (1 + z * z))

    def inverse_function(self, name, x, slope):
        return x.integrated(at(name, x.c[0]), slope(x)) if isinstance(x, Series) else at(name, x)

    def power(self, x, n):
        if not isinstance(x, Series) and not isinstance(n, Series):
            return x**n
        if isinstance(n, Series) or n != int(n):
            return self.exp(n * self.log(x))
        return math.prod([x if n > 0 else 1 / x] * abs(int(n)), start=1)


class Motion:
    """Chetaev's motion of a scene, order by order, with what the balances of its coordinates are made of."""

    def __init__(self, text, start, orders):
        self.scene, self.table, self.algebra = Scene(text), tomllib.loads(text), Algebra()
        self.names = self.scene.coordinates
        n, h = len(self.names), len(self.scene.constraints)
        q, v = self.start(start)
        self.q, self.v = [[x, y] for x, y in zip(q, v)], [[x] for x in v]
        for k in range(orders):
            # E_k - A' lambda_k and the rate of f are linear in (a_k, lambda_k): from a_k = 0, and the slopes at order 0
            for c in self.v:
                c.append(Decimal(0))
            A, _, E, f, _ = self.look()
            if k == 0:
                slopes = [self.nudged(j)[i] - E[i][0] for i in range(n) for j in range(n)]
                matrix = [slopes[i * n : (i + 1) * n] + [-A[j][i][0] for j in range(h)] for i in range(n)]
                matrix += [[x[0] for x in row] + [Decimal(0)] * h for row in A]
                reactions = []
            pull = lambda i: sum(A[j][i][k - l] * reactions[l][j] for l in range(k) for j in range(h))
            solved = solve(matrix, [pull(i) - E[i][k] for i in range(n)] + [-(k + 1) * f[j][k + 1] for j in range(h)])
            reactions.append(solved[n:])
            for i in range(n):
                self.v[i][-1] = solved[i] / (k + 1)
                self.q[i].append(self.v[i][-1] / (k + 2))

    def series(self):
        """f, L and Q along the motion as it is known, with derivatives by q (seeds 0 .. n-1) and v (n .. 2n-1)."""
        size, n, read = len(self.v[0]), len(self.names), lambda x: value(x, scope, self.algebra)
        one, t = [Decimal(1)] + [Decimal(0)] * (size - 1), [self.time, Decimal(1)] + [Decimal(0)] * size
        q = {x: Series(self.q[i][:size], {i: one}) for i, x in enumerate(self.names)}
        v = {x: Series(self.v[i], {n + i: one}) for i, x in enumerate(self.names)}
        scope = self.scene.scope(self.algebra, Series(t[:size]), q, v)
        zero = Series([Decimal(0)] * size)
        f, Q = self.scene.constraints, [self.scene.forces.get(x, 0) for x in self.names]
        return [zero + read(x) for x in f], zero + read(self.scene.lagrangian), [zero + read(x) for x in Q]

    def look(self):
        """A, f_q, E without its last order, f, and the size of what E is made of."""
        f, L, Q = self.series()
        n, size = len(self.names), len(self.v[0])
        of = lambda x, i: x.d.get(i, [Decimal(0)] * size)
        E, sizes = [], []
        for i in range(n):
            rate = [(k + 1) * x for k, x in enumerate(of(L, n + i)[1:])]
            terms = list(zip(rate, of(L, i), Q[i].c))
            E.append([a - b - c for a, b, c in terms])
            sizes.append([abs(a) + abs(b) + abs(c) for a, b, c in terms])
        A, B = ([[of(x, i) for i in seeds] for x in f] for seeds in (range(n, 2 * n), range(n)))
        return A, B, E, [x.c for x in f], sizes

    def nudged(self, j):
        """E at the start with one more for the acceleration of a coordinate."""
        self.v[j][1] += 1
        E = self.look()[2]
        self.v[j][1] -= 1
        return [x[0] for x in E]

    def start(self, rounded):
        """Positions and given velocities as they are written; the others from the constraints, which decimals may miss by round-off."""
        start, scope, read = self.table.get("start", {}), {}, lambda x: value(x, scope, self.algebra)
        scope |= {name: read(x) for name, x in self.scene.parameters.items()}
        self.time = scope["t"] = Decimal(repr(start.get("time", 0)))
        for name in self.names:
            scope[name] = read(self.table["coordinates"][name].get("start", 0))
        q, given = [scope[name] for name in self.names], start.get("velocities", {})
        v = [read(given[x + "'"]) if x + "'" in given else Decimal(y) for x, y in zip(self.names, rounded)]
        self.q, self.v = [[x] for x in q], [[x] for x in v]
        h, free = len(self.scene.constraints), [j for j, x in enumerate(self.names) if x + "'" not in given]
        free = free if len(free) >= h else list(range(len(q)))
        for _ in range(8 if h else 0):
            A, _, _, f, _ = self.look()
            rows = [[A[i][j][0] for j in free] + [-f[i][0]] for i in range(h)]
            for j, step in pivoted(rows, len(free))[0].items():
                self.v[free[j]][0] += step[-1]
        return q, [c[0] for c in self.v]


def pivoted(rows, width):
    """Gauss and Jordan with the largest pivots in the first `width` columns: {column: row} of those above `ZERO`, and the other rows."""
    rows, found = [row[:] for row in rows], {}
    while rows:
        places = ((i, j) for i, j in product(range(len(rows)), range(width)) if j not in found)
        i, j = max(places, key=lambda place: abs(rows[place[0]][place[1]]), default=(0, None))
        if j is None or abs(rows[i][j]) <= ZERO:
            break
        row = rows.pop(i)
        row = [x / row[j] for x in row]
        clear = lambda other: [x - other[j] * y for x, y in zip(other, row)] if other[j] else other
        rows, found = [clear(r) for r in rows], {c: clear(r) for c, r in found.items()} | {j: row}
    return found, rows


def solve(matrix, right):
    scale = [max(map(abs, row)) for row in matrix]
    found, _ = pivoted([[x / s for x in row] + [b / s] for row, b, s in zip(matrix, right, scale)], len(right))
    return [found[j][-1] for j in range(len(right))]


def decide(text, start):
    """Dimension and least-norm element of the set, None and nothing where it is empty, and how far the equations left over are from 0 = 0.

    `start` are velocities to begin with where the text does not say them.
    """
    h = len(Scene(text).constraints)
    most = 2 * h + 4
    motion = Motion(text, start, most + 2)
    A, B, E, _, sizes = motion.look()
    n, orders = len(motion.names), range(1, most + 2)
    # scales: of the constraints, of time (`fast` is its inverse), of the coordinates, of what E is made of
    of = [max(abs(x[0]) for x in row) for row in A]
    speed = max(abs(c[0]) for c in motion.v) or Decimal(1)
    series = [(c, speed) for c in motion.v] + [(x, of[j]) for j in range(h) for x in A[j]]
    rates = ((abs(c[k]) / scale, Decimal(1) / k) for c, scale in series for k in orders)
    fast = max((rate**power for rate, power in rates if rate > REST), default=Decimal(1))
    A = [[[x / fast**k / of[j] for k, x in enumerate(A[j][i])] for i in range(n)] for j in range(h)]
    B = [[[x / fast ** (k + 1) / of[j] for k, x in enumerate(B[j][i])] for i in range(n)] for j in range(h)]
    width = [max(abs(x) for j in range(h) for x in A[j][i]) or Decimal(1) for i in range(n)]
    size = max(x / fast ** (k + 1) / width[i] for i in range(n) for k, x in enumerate(sizes[i])) or Decimal(1)
    rows = []
    for k, i in product(range(most + 1), range(n)):
        row = [Decimal(0)] * (h * (most + 2)) + [-E[i][k] / fast ** (k + 1) / width[i] / size]
        for l, j in product(range(k + 1), range(h)):
            row[h * (k - l + 1) + j] += A[j][i][l] * (k - l + 1) / width[i]
            row[h * (k - l) + j] += ((l + 1) * A[j][i][l + 1] - B[j][i][l]) / width[i]
        rows.append(row[h:-1] + row[:h] + row[-1:])
    _, rows = pivoted(rows, h * (most + 1))
    bound, rest = pivoted([row[-h - 1 :] for row in rows], h)
    left = max([abs(row[-1]) for row in rest], default=0)
    if left > ZERO:
        return None, [], left
    # in the units of mu_0, the shortest x with M x = b: x = M' (M M')^-1 b
    M, b = [[x * of[j] for j, x in enumerate(row[:h])] for row in bound.values()], [row[-1] * size for row in bound.values()]
    y = solve([[sum(map(mul, r, s)) for s in M] for r in M], b) if M else []
    return h - len(M), [sum(y[k] * M[k][j] for k in range(len(M))) for j in range(h)], left
