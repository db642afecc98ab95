"""Truncated Taylor series modulo a prime, forms on velocities, attitudes: what the systems of the referee are written in."""

import random
from fractions import Fraction

P = 2**31 - 1


class NoRoot(Exception):
    """A random number has no root modulo P: draw another."""


def residue(x):
    x = Fraction(str(x)) if isinstance(x, float) else Fraction(x)
    return x.numerator * pow(x.denominator, -1, P) % P


class Series:
    """Exponents to residues; terms of a degree over `order` are dropped. A derivative is known to one order less."""

    order = 4
    variables = 0

    def __init__(self, terms):
        self.terms = {a: c % P for a, c in terms.items() if c % P}

    @classmethod
    def of(cls, x):
        return x if isinstance(x, Series) else Series({(0,) * cls.variables: residue(x)})

    def constant(self):
        return self.terms.get((0,) * Series.variables, 0)

    def __add__(self, other):
        terms = dict(self.terms)
        for a, c in Series.of(other).terms.items():
            terms[a] = terms.get(a, 0) + c
        return Series(terms)

    def __neg__(self):
        return Series({a: -c for a, c in self.terms.items()})

    def __sub__(self, other):
        return self + -Series.of(other)

    def __rsub__(self, other):
        return Series.of(other) - self

    def __mul__(self, other):
        if isinstance(other, Form):
            return NotImplemented
        terms = {}
        right = [(sum(b), b, d) for b, d in Series.of(other).terms.items()]
        for a, c in self.terms.items():
            room = Series.order - sum(a)
            for size, b, d in right:
                if size <= room:
                    key = tuple(map(int.__add__, a, b))
                    terms[key] = terms.get(key, 0) + c * d
        return Series(terms)

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other):
        return self * Series.of(other).inverse()

    def __rtruediv__(self, other):
        return Series.of(other) * self.inverse()

    def __pow__(self, power):
        assert int(power) == power
        base, result = (self if power >= 0 else self.inverse()), Series.of(1)
        for _ in range(abs(int(power))):
            result = result * base
        return result

    def inverse(self):
        over = Series.of(pow(self.constant(), -1, P))
        for _ in range(Series.order.bit_length()):
            over = over * (2 - self * over)
        return over

    def sqrt(self):
        c = self.constant()
        if pow(c, (P - 1) // 2, P) != 1:
            raise NoRoot
        root = Series.of(pow(c, (P + 1) // 4, P))
        for _ in range(Series.order.bit_length()):
            root = (root + self / root) * Fraction(1, 2)
        return root

    def slope(self, i):
        lower = lambda a: a[:i] + (a[i] - 1,) + a[i + 1 :]
        return Series({lower(a): c * a[i] for a, c in self.terms.items() if a[i]})


class Angle(Series):
    """A coordinate that is an angle, with its sine and cosine, at a rational point of the circle."""

    def __init__(self, place, value, tangent):
        unit = [tuple(k if i == place else 0 for i in range(Series.variables)) for k in range(Series.order + 1)]
        super().__init__({unit[0]: value, unit[1]: 1})
        over = pow(1 + tangent * tangent, -1, P)
        turns = [2 * tangent * over, (1 - tangent * tangent) * over]  # sine and cosine of the constant term
        turns += [-turns[0], -turns[1]]
        taylor, factor = [], 1
        for k in range(Series.order + 1):
            taylor.append(factor)
            factor = factor * pow(k + 1, -1, P) % P
        self.sin, self.cos = (
            Series({unit[k]: turns[(k + first) % 4] * c for k, c in enumerate(taylor)}) for first in (0, 1)
        )


class Form(list):
    """A form on the velocities, by its coefficients."""

    def __add__(self, other):
        return Form(x + y for x, y in zip(self, other, strict=True))

    def __sub__(self, other):
        return Form(x - y for x, y in zip(self, other, strict=True))

    def __mul__(self, factor):
        return Form(x * factor for x in self)

    __rmul__ = __mul__


def dot(a, b):
    return sum((x * y for x, y in zip(a, b, strict=True)), Series({}))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(a, b):
    return [x + y for x, y in zip(a, b, strict=True)]


def times(factor, a):
    return [x * factor for x in a]


def component(forms, vector):
    """`vector`, of numbers, times a vector of forms."""
    return forms[0] * vector[0] + forms[1] * vector[1] + forms[2] * vector[2]


def rates(count, *places):
    """q'_i as forms, i in `places`; zero for None."""
    return [Form(Series.of(1 if i == at else 0) for i in range(count)) for at in places]


def rate(x, count):
    """dx/dt as a form."""
    return Form(Series.of(x).slope(i) for i in range(count))


def turn(q, count, at):
    """Cosine, sine and rate of an angle: q is the angle, or the tangent of its half."""
    (unit,) = rates(count, at)
    if isinstance(q, Angle):
        return q.cos, q.sin, unit
    over = 1 / (1 + q * q)
    return (1 - q * q) * over, 2 * q * over, unit * (2 * over)


def attitude(c, count, at):
    """Rows of R, from body to room, and the angular velocity in the room. Euler's angles z-x-z if c are angles;
    otherwise Cayley's parameters, R = (1 - C)^-1 (1 + C)."""
    first, second, third = rates(count, at, at + 1, at + 2)
    if isinstance(c[0], Angle):
        (cp, sp), (ct, st), (cf, sf) = ((x.cos, x.sin) for x in c)
        nodes, axis = [cp, sp, Series({})], [sp * st, -cp * st, ct]
        across = cross(axis, nodes)
        columns = [plus(times(cf, nodes), times(sf, across)), plus(times(-sf, nodes), times(cf, across)), axis]
        up = [Series({}), Series({}), Series.of(1)]
        spin = [second * n + third * e + first * u for n, e, u in zip(nodes, axis, up, strict=True)]
        return [list(row) for row in zip(*columns, strict=True)], spin
    over = 1 / (1 + dot(c, c))
    skew = [[0, -c[2], c[1]], [c[2], 0, -c[0]], [-c[1], c[0], 0]]
    entry = lambda i, j: (((1 - dot(c, c)) if i == j else 0) + 2 * c[i] * c[j] + 2 * skew[i][j]) * over
    spin = [(r + s) * (2 * over) for r, s in zip([first, second, third], cross(c, [first, second, third]), strict=True)]
    return [[entry(i, j) for j in range(3)] for i in range(3)], spin


def in_body(rows, vector):
    return [component(vector, [row[j] for row in rows]) for j in range(3)]


def unit_vector(u, v):
    """From azimuth and angle to the vertical, or stereographic coordinates."""
    if isinstance(u, Angle):
        return [v.sin * u.cos, v.sin * u.sin, v.cos]
    over = 1 / (1 + u * u + v * v)
    return [2 * u * over, 2 * v * over, (1 - u * u - v * v) * over]


def coordinates(count, angles, seed, order, velocities=False):
    """Random q as series in themselves, and velocities as further variables; `angles` are places of `Angle`s."""
    Series.variables, Series.order = count * (2 if velocities else 1), order
    draw = random.Random(seed)
    number = lambda i: Series({tuple(k * (i == j) for j in range(Series.variables)): 1 if k else draw.randrange(P) for k in (0, 1)})
    return [Angle(i, draw.randrange(P), draw.randrange(P)) if i in angles else number(i) for i in range(Series.variables)]
