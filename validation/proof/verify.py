"""Verifies that no multipliers mu_0 make a Chetaev motion vakonomic: python verify.py [SCENE.toml] CERTIFICATE.json

Plain Python, and nothing of the program that wrote the certificate (`deltaq prove SCENE --out CERTIFICATE.json`). It ends with 0: verified;
with 1: forged, something that was read is not so; with 2: cannot read, and what. Certificates of `deltaq integrals` are those of integrals.py.

Theorem. Let L, f, Q of the certificate's plain scene be analytic at its start (q, v, t), with f = 0 there, h constraints, A = f_v, and let the
bordered matrix [L_vv, -A'; A, 0] be regular. Then there is one Chetaev motion, E := d/dt L_v - L_q - Q = A' lambda with f = 0. It is
vakonomic if and only if some mu = mu_0 + mu_1 t + ... solves A' mu' + (d/dt A' - f_q') mu = -E in each power of t: forces Q act by
virtual work in every formulation, int (delta L + Q . delta q) dt = 0. Through order K these are linear equations S x = b for x = (mu_0 .. mu_(K+1)). If the named
rows of [S | -b] have a determinant that is not 0, no x solves them.

What is computed here are images mod p of numbers made from fractions, e^(2 pi i/M), e^(ia) and e^a for fractions a (independent over the
algebraic numbers: Lindemann, Weierstrass), and roots of primes. [M, z] says e^(2 pi i/M) -> z, of order M mod p. The power r of the images
of e^i and e is 1, so e^(n/d) has an image where r and d have no common factor. A root goes to a root, in the field of e^(2 pi i/M) to its
Gauss sum. This is a homomorphism on all quotients whose divisors do not go to 0: what is not 0 mod p is not 0, whoever has chosen p, z, r.
p is a prime over 2^50 and over K + 2, by which series divide. Doubt is left in two places: that f = 0 at a start with all velocities given
is found exactly where all numbers are fractions, else mod p and in decimals; and the scene file is held against the plain scene by Taylor
coefficients of L, f and Q along a random curve mod p. From a start drawn at random follows the same for almost every start on that piece of
f = 0, if this is a connected analytic manifold, as the minor is analytic on it. Where roots have branches, the piece is that of the start of
the file: the scenes are held against each other round that start, and intervals show that no root is 0 between it and the certificate's."""

import hashlib, json, math, operator, os, re, secrets, sys, tomllib
from fractions import Fraction
from functools import reduce
from itertools import product

class Forged(Exception): pass
class Unreadable(Exception): pass

def demand(true, words, fault=Forged):
    if not true:
        raise fault(words)

def readable(true, words):
    demand(true, words, Unreadable)

invert = lambda x: pow(x, -1, P)

def is_prime(n):
    """Miller and Rabin, with bases that leave no doubt under 2^64."""
    twos, bases = (n - 1 & 1 - n).bit_length() - 1, (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37)
    passes = lambda a: (x := pow(a, n - 1 >> twos, n)) == 1 or any(pow(x, 2**k, n) == n - 1 for k in range(twos))
    return n in bases or n > 1 and all(n % a and passes(a) for a in bases)

# Formulas ---------------------------------------------------------------------------------------------------------------------------------

UNARY = "sin cos exp log asin acos atan asinh acosh atanh".split()

class Formulas:
    """Operations on numbers, each written once. What is read is the place of a number, or a list of such; `meaning` tells names."""
    def __init__(self, meaning=lambda formulas, name: formulas.put("name", name)):
        self.operations, self.places, self.known, self.meaning = [], {}, {}, meaning
    def put(self, *operation):
        if operation not in self.places:
            self.places[operation] = len(self.operations)
            self.operations.append(operation)
        return self.places[operation]
    def number(self, x):
        return self.put("number", Fraction(x))
    def add(self, a, b):
        return [self.add(x, y) for x, y in zip(a, b, strict=True)] if isinstance(a, list) else self.put("+", a, b)
    def times(self, a, b):
        if not isinstance(a, list):
            return [self.times(a, x) for x in b] if isinstance(b, list) else self.put("*", a, b)
        if not isinstance(b, list):
            return [self.times(x, b) for x in a]
        rows = [[self.dot(row, x) for x in (zip(*b) if isinstance(b[0], list) else [b])] for row in a]
        return rows if isinstance(b[0], list) else [row[0] for row in rows]
    def minus(self, a, b):
        return self.add(a, self.times(self.number(-1), b))
    def over(self, a, b):
        return self.times(a, self.put("^", b, self.number(-1)))
    def dot(self, a, b):
        return reduce(self.add, [self.times(x, y) for x, y in zip(a, b, strict=True)])
    def rate(self, a):
        return [self.rate(x) for x in a] if isinstance(a, list) else self.put("rate", a)
    def turn(self, n, angle):
        """cos I + sin [n]x + (1 - cos) n n'"""
        s, c = self.put("sin", angle), self.put("cos", angle)
        other = lambda i, j: c if i == j else self.times(s, self.times(self.number(1 if (i - j) % 3 == 1 else -1), n[3 - i - j]))
        along = lambda i, j: self.times(self.minus(self.number(1), c), self.times(n[i], n[j]))
        return [[self.add(along(i, j), other(i, j)) for j in range(3)] for i in range(3)]
    def call(self, name, a):
        x, minus, over, put = a[0], self.minus, self.over, self.put
        one, half, up = self.number(1), self.number("1/2"), lambda x: put("exp", x)
        down = lambda x: up(self.times(self.number(-1), x))
        tanh = lambda x: over(minus(up(x), down(x)), self.add(up(x), down(x)))
        transposed, spin = lambda m: [list(row) for row in zip(*m)], lambda m: [m[2][1], m[0][2], m[1][0]]
        written = {
            "ln": lambda: put("log", x), "sqrt": lambda: put("^", x, half), "pow": lambda: put("^", *a), "atan2": lambda: put("atan2", *a),
            "tan": lambda: over(put("sin", x), put("cos", x)), "cot": lambda: over(put("cos", x), put("sin", x)),
            "sec": lambda: over(one, put("cos", x)), "csc": lambda: over(one, put("sin", x)), "tanh": lambda: tanh(x),
            "sinh": lambda: self.times(half, minus(up(x), down(x))), "cosh": lambda: self.times(half, self.add(up(x), down(x))),
            "step": lambda: self.times(half, minus(*[tanh(over(minus(x, y), a[3])) for y in a[1:3]])),
            "dot": lambda: self.dot(*a), "norm": lambda: put("^", self.dot(x, x), half), "transpose": lambda: transposed(x),
            "cross": lambda: [minus(self.times(x[i - 2], a[1][i - 1]), self.times(x[i - 1], a[1][i - 2])) for i in range(3)],
            "diag": lambda: [[y if i == j else self.number(0) for j in range(len(a))] for i, y in enumerate(a)],
            "rotation": lambda: self.turn(self.times(put("over length", self.dot(x, x)), x), a[1]),
            "angular_velocity": lambda: spin(self.times(self.rate(x), transposed(x))),
            "body_angular_velocity": lambda: spin(self.times(transposed(x), self.rate(x))),
        }
        readable(name in written or name in UNARY and len(a) == 1, f"the function {name}")
        return written[name]() if name in written else put(name, x)

    def read(self, text):
        """Sums of products of powers. A name with its primes is one name, numbers are exact, and nothing is executed."""
        found = re.findall(r"((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*'*)|(\*\*|\.[A-Za-z]+|\S)", str(text), re.ASCII)
        tokens = [("number", a) if a else ("name", b) if b else ("^" if c == "**" else c, c) for a, b, c in found] + [("end", "the end")]
        def take(*kinds):
            readable(tokens[0][0] in kinds, f"`{tokens[0][1]}` in the formula {str(text)[:60]}")
            return tokens.pop(0)[1]
        def sums():
            value = products()
            while tokens[0][0] in ("+", "-"):
                value = (self.add if take("+", "-") == "+" else self.minus)(value, products())
            return value
        def products():
            value = signed()
            while tokens[0][0] in ("*", "/"):
                value = (self.times if take("*", "/") == "*" else self.over)(value, signed())
            return value
        def signed():
            if tokens[0][0] in ("+", "-"):
                return self.times(self.number(take("+", "-") + "1"), signed())
            value = primary()
            return self.put("^", value, (take("^"), signed())[1]) if tokens[0][0] == "^" else value
        def listed(close):
            values = []
            while tokens[0][0] != close:
                values.append(sums())
                tokens[0][0] == close or take(",")
            return (take(close), values)[1]
        def primary():
            kind, word = tokens[0][0], take("number", "name", "(", "[")
            if kind == "(":
                value = (sums(), take(")"))[0]
            elif kind != "name":
                value = listed("]") if kind == "[" else self.number(word)
            elif tokens[0][0] != "(":
                if word not in self.known:
                    self.known[word] = self.put("pi") if word == "pi" else self.meaning(self, word)
                value = self.known[word]
            elif word == "rotation" and set(tokens[1][1]) <= set("xyz") and tokens[2][0] == ",":
                axes, _, angles = (take("("), take("name"))[1], take(","), listed(")")
                turns = [self.turn([self.number(int(x == axis)) for x in "xyz"], angle) for axis, angle in zip(axes, angles, strict=True)]
                value = reduce(self.times, turns)
            else:
                value = self.call(word, (take("("), listed(")"))[1])
            while tokens[0][0] == "'" or re.fullmatch(r"\.[xyz]+", tokens[0][0]):
                value = self.rate(value) if tokens[0][0] == "'" else value
                for letter in take(tokens[0][0])[1:]:
                    value = value["xyz".index(letter)]
            return value
        try:
            value = sums()
        except (TypeError, IndexError, ValueError, RecursionError, ZeroDivisionError) as error:
            raise Unreadable(f"the formula {str(text)[:60]} ({error})")
        take("end")
        return value

    def below(self, places):
        """These operations and all that they are made of."""
        found, todo = set(), list(places)
        while todo:
            place = todo.pop()
            if place not in found:
                found.add(place)
                todo += [a for a in self.operations[place][1:] if isinstance(a, int)]
        return [self.operations[place] for place in sorted(found)]

    def branches(self, names):
        """Places of what stands under a root, or in atan2, and depends on these names."""
        varies, found = [], set()
        for place, (kind, *args) in enumerate(self.operations):
            varies.append(kind == "name" and args[0] in names or kind != "name" and any(varies[a] for a in args if isinstance(a, int)))
            exponent = self.operations[args[1]] if kind == "^" else ()
            root = kind == "over length" or kind == "^" and not (exponent[0] == "number" and exponent[1].denominator == 1)
            found |= {args[0]} if root and varies[args[0]] else {place} if kind == "atan2" and varies[-1] else set()
        return found

    def intervals(self, box):
        """Of all operations over the box {name: (from, to)}, in decimals, each wider than its round-off."""
        values, whole = [], (-math.inf, math.inf)
        rising = {name: getattr(math, name) for name in ("exp", "log", "asin", "atan", "asinh", "acosh", "atanh")}
        def of(kind, args):
            if kind == "number":
                return (float(args[0]),) * 2
            if kind in ("name", "pi"):
                return (math.pi,) * 2 if kind == "pi" else box.get(args[0], whole)
            (a, b), *more = [values[x] for x in args if isinstance(x, int)]
            c, d = more[0] if more else (0, 0)
            if kind == "+":
                return a + c, b + d
            if kind == "*":
                ends = [x * y if x and y else 0.0 for x in (a, b) for y in (c, d)]
                return min(ends), max(ends)
            if kind in ("sin", "cos"):
                at, half = getattr(math, kind)((a + b) / 2), (b - a) / 2
                return (max(at - half, -1.0), min(at + half, 1.0)) if half < 2 else (-1.0, 1.0)
            if kind == "acos" or kind in rising:
                ends = sorted((rising.get(kind) or math.acos)(x) for x in (a, b))
                return ends[0], ends[1]
            if kind == "^" and c == d and (a > 0 or c == int(c) and (c > 0 or b < 0)):
                ends = [x**c for x in (a, b)] + ([0.0] if a < 0 < b else [])
                return min(ends), max(ends)
            return whole
        for kind, *args in self.operations:
            try:
                a, b = of(kind, args)
            except (ValueError, OverflowError):
                a, b = whole
            exact = kind == "number" and Fraction(a) == args[0]
            wider = lambda x, by: x if exact or not math.isfinite(x) else x + by * abs(x)
            values.append((wider(a, -1e-12), wider(b, 1e-12)) if a <= b else whole)
        return values

    def on_one_branch(self, names, box):
        """Demands that no root is 0 in the box, and no angle of atan2 jumps."""
        places, intervals = self.branches(names), self.intervals(box)
        kinds = [(self.operations[place][0], intervals[place]) for place in places]
        kinds += [("x", intervals[args[1]]) for kind, *args in (self.operations[place] for place in places) if kind == "atan2"]
        apart = all(kind == "atan2" or a > 0 or kind != "x" and b < 0 for kind, (a, b) in kinds)
        readable(apart, "a root that may be 0 between the points of the certificate and of the file: they may be on two branches")

    def degrees(self, names):
        """Of each operation as a polynomial in these names; 2 for more, and for what is no polynomial."""
        found = []
        for kind, *args in self.operations:
            below = [found[a] for a in args if isinstance(a, int)]
            degree = sum(below) if kind == "*" else max(below, default=0) if kind == "+" else 2 * sum(below)
            found.append(int(args[0] in names) if kind == "name" else min(degree, 2))
        return found

    def run(self, scope, rates=()):
        """All values, where scope has those of names; the rate of what depends on x is made of pairs (x, x')."""
        values = []
        for kind, *args in self.operations:
            if kind == "name":
                readable(args[0] in scope, f"the name {args[0]}")
                values.append(scope[args[0]])
            elif kind == "number":
                values.append(Series.of(args[0]))
            elif kind == "rate":
                readable(rates, "a time derivative in a plain scene")
                slopes = slopes_of(values[args[0]], [x for x, _ in rates])
                values.append(Series([sum(c) % P for c in zip(*[convolve(slope, x.c) for slope, (_, x) in zip(slopes, rates)])]))
            else:
                values.append(Series([], (0, 1)) if kind == "pi" else APPLY[kind](*[values[a] for a in args]))
        return values

    def in_decimals(self, scope):
        values, known = [], {"+": operator.add, "*": operator.mul, "^": operator.pow, "number": float}
        known |= {"name": scope.get, "pi": lambda: math.pi}
        for kind, *args in self.operations:
            values.append((known.get(kind) or getattr(math, kind))(*[values[a] if isinstance(a, int) else a for a in args]))
        return values

# Series mod p -----------------------------------------------------------------------------------------------------------------------------

def convolve(a, b):
    if any(a[1:]) and any(b[1:]):
        return [sum(map(operator.mul, a[: k + 1], b[k::-1])) % P for k in range(len(a))]
    a, b = (b, a) if any(a[1:]) else (a, b)
    return [a[0] * x % P for x in b]

def grown(first, step):
    """The series y with k y_k = step(k, y)."""
    y = [first % P]
    for k in range(1, SIZE):
        y.append(step(k, y) * invert(k) % P)
    return y

follow = lambda u, slope, k: sum(j * u[j] * slope[k - j] for j in range(1, k + 1))

def power(u, alpha, first):
    """u^alpha"""
    demand(u[0] % P, "a division by 0 mod p")
    over = invert(u[0])
    return grown(first, lambda k, y: over * sum((alpha * j - (k - j)) * u[j] * y[k - j] for j in range(1, k + 1)))

class Series:
    """A series in t mod p, its first term as (a, b) for a + b pi where this is known exactly, and what it depends on with slopes."""
    made = 0
    def __init__(self, c, first=None, slopes=(), leaf=False):
        Series.made += 1
        self.c, self.made, self.slopes = (list(c) + [0] * SIZE)[:SIZE], Series.made, [(x, slope) for x, slope in slopes if x.live]
        self.first, self.live = first, leaf or bool(self.slopes)
        if first and any(x.numerator.bit_length() + x.denominator.bit_length() > 4000 for x in first):
            self.plain().first = None
    def of(x):
        if isinstance(x, Series):
            return x
        x = Fraction(x)
        demand(x.denominator % P, "a division by 0 mod p")
        return Series([x.numerator * invert(x.denominator) % P], (x, 0))
    def plain(self):
        readable(not (self.first and self.first[1]), "pi stands outside of an angle")
        return self
    def fixed(self):
        return not self.live and not any(self.c[1:])
    def fraction(self, words):
        """The first term, which has to be known as a fraction."""
        readable(self.first and not self.first[1], f"{words} what is not known to be a fraction at the start")
        return Fraction(self.first[0])
    def __add__(a, b):
        b = Series.of(b)
        first = (a.first[0] + b.first[0], a.first[1] + b.first[1]) if a.first and b.first else a.plain() and b.plain() and None
        return Series([(x + y) % P for x, y in zip(a.c, b.c)], first, [(a, ONE), (b, ONE)])
    def __mul__(a, b):
        b = Series.of(b)
        for x, y in (a, b), (b, a):  # pi may be multiplied by a fraction that stays, and by nothing else
            x.first and x.first[1] and readable(y.fixed() and y.first and not y.first[1], "pi stands outside of an angle")
        first = a.first and b.first and (a.first[0] * b.first[0], a.first[0] * b.first[1] + a.first[1] * b.first[0])
        return Series(convolve(a.c, b.c), first, [(a, b.c), (b, a.c)])
    def __pow__(a, b):
        """Whole powers by multiplication, halves by the root, others of 1 or by exp and log."""
        a, b = a.plain(), Series.of(b).plain()
        if not b.fixed() or not b.first:
            return (b * function("log", a)).exp()
        b = Fraction(b.first[0])
        readable(abs(b) < 2**16, "a power that large")
        if b.denominator == 1 and b >= 0:
            result, base = Series.of(1), a
            for bit in bin(b.numerator)[:1:-1]:
                result, base = result * base if bit == "1" else result, base * base if b >= 2 else base
            return result
        if b.denominator == 2 and abs(b) > 1 or b.denominator == 1 and b < -1:
            return (a ** (abs(b) / b / b.denominator)) ** abs(b.numerator)
        if b > 0 and a.fixed() and a.first and not a.first[0]:
            return a
        demand(a.c[0], "a division by 0 mod p")
        if b == -1:
            first = invert(a.c[0]), a.first and a.first[0] and (1 / Fraction(a.first[0]), 0)
        elif abs(b) == Fraction(1, 2):
            image, exact = root(a.fraction("a root of"))
            first = (image, exact and (exact, 0)) if b > 0 else (invert(image), exact and (1 / exact, 0))
        else:
            readable(a.fraction("a power of") == 1, f"the power {b}")
            first = 1, (1, 0)
        alpha = b.numerator * invert(b.denominator) % P
        c = power(a.c, alpha, first[0])
        return Series(c, first[1], [(a, convolve([alpha, *ZERO[1:]], convolve(c, power(a.c, -1, invert(a.c[0])))))] if a.live else ())
    def exp(self):
        c = grown(exponential(self.fraction("exp of"), E), lambda k, y: follow(self.c, y, k))
        return Series(c, None if self.first[0] else (1, 0), [(self, c)])
    def sine(self, quarters):
        """The sine, some quarter turns on."""
        readable(self.first, "a sine or cosine of what is not known to be a fraction at the start, but for multiples of pi")
        part = Fraction(self.first[1]) * UNITY[0] / 2 + UNITY[0] // 4 * quarters
        readable(part.denominator == 1, f"an angle of {self.first[1]} pi")
        first = exponential(Fraction(self.first[0]), E_I) * pow(UNITY[1], part.numerator, P) % P
        up, down = [grown(x, lambda k, y: i * follow(self.c, y, k)) for x, i in ((first, I), (invert(first), -I))]
        known = KNOWN.get((Fraction(self.first[1]) + Fraction(quarters, 2)) % 2) if not self.first[0] else None
        slope = [(x + y) * invert(2) % P for x, y in zip(up, down)]
        return Series([(x - y) * invert(2 * I) % P for x, y in zip(up, down)], None if known is None else (known, 0), [(self, slope)])

KNOWN = {Fraction(k, 6): Fraction(x, 2) for k, x in zip((0, 1, 3, 5, 6, 7, 9, 11), (0, 1, 2, 1, 0, -1, -2, -1))}  # sines of multiples of pi

def function(name, u):
    """The integral of a slope, from the one point where it is known."""
    at = int(name in ("log", "acosh"))
    readable(u.fraction(f"{name} of") == at, f"{name} of another number than {at}")
    first = (0, Fraction(name == "acos") / 2)
    if u.fixed():
        return Series([], first)
    sign, square, alpha = {
        "log": (1, u + -1, -1), "asin": (1, u * u * -1, "-1/2"), "acos": (-1, u * u * -1, "-1/2"), "atan": (1, u * u, -1),
        "asinh": (1, u * u, "-1/2"), "atanh": (1, u * u * -1, -1), "acosh": (1, u * u + -2, "-1/2"),
    }[name]
    slope = (square + 1) ** Fraction(alpha) * sign
    return Series(grown(0, lambda k, y: follow(u.c, slope.c, k)), first, [(u, slope.c)])

def arc(y, x):
    readable(x.fraction("atan2 with") > 0, "atan2 where x is not over 0")
    return function("atan", y * x**-1)

APPLY = {name: (lambda u, name=name: function(name, u)) for name in UNARY} | {
    "+": operator.add, "*": operator.mul, "^": operator.pow, "exp": lambda u: u.plain().exp(), "atan2": arc, "sin": lambda u: u.sine(0),
    "cos": lambda u: u.sine(1), "over length": lambda u: Series.of(1) if u.c == ONE else u ** Fraction(-1, 2),
}

def exponential(x, base):
    readable(math.gcd(x.denominator, R) == 1, f"e to a power with the denominator {x.denominator}")
    return pow(base, x.numerator * pow(x.denominator, -1, R) % R, P)

def root_of_prime(l):
    d = 8 if l == 2 else l
    if UNITY[0] % d == 0:
        z = pow(UNITY[1], UNITY[0] // d, P)
        gauss = (z + invert(z) if l == 2 else sum(pow(z, k * k, P) for k in range(l)) * (1 if l % 4 == 1 else -I)) % P
        demand(ROOTS.get(str(l), gauss) == gauss, f"the root of {l}")
        return gauss
    readable(str(l) in ROOTS, f"the root of {l}: it has no image")
    demand(pow(ROOTS[str(l)], 2, P) == l % P, f"the root of {l}")
    return ROOTS[str(l)]

def root(x):
    """The image of the root of a fraction, and that itself where it is one."""
    readable(x > 0, "a root of what is not over 0")
    n, outside, image = x.numerator * x.denominator, Fraction(1, x.denominator), 1
    for l in range(2, 4096):
        while n % (l * l) == 0:
            n, outside = n // (l * l), outside * l
        if n % l == 0:
            n, image, outside = n // l, image * root_of_prime(l) % P, outside
    whole = math.isqrt(n)
    rational = image == 1 and whole * whole == n
    image = image * (whole if whole * whole == n else root_of_prime(n) if is_prime(n) else readable(False, f"the root of {n}"))
    return image * Series.of(outside).c[0] % P, outside * whole if rational else None

def slopes_of(y, leaves):
    """The derivatives of y by leaves, found from the end."""
    found, todo = {}, [y]
    while todo:
        x = todo.pop()
        if x.made not in found:
            found[x.made] = x
            todo += [a for a, _ in x.slopes]
    total = {y.made: ONE}
    for made in sorted(found, reverse=True):
        for a, slope in found[made].slopes:
            part = convolve(total[made], slope)
            total[a.made] = [(x + z) % P for x, z in zip(total[a.made], part)] if a.made in total else part
    return [total.get(x.made, ZERO) for x in leaves]

def determinant(rows):
    rows, result = [list(row) for row in rows], 1
    for i in range(len(rows)):
        k = next((k for k in range(i, len(rows)) if rows[k][i] % P), None)
        if k is None:
            return 0
        if k != i:
            rows[i], rows[k], result = rows[k], rows[i], -result
        result, over = result * rows[i][i] % P, invert(rows[i][i])
        for row in rows[i + 1 :]:
            if row[i]:
                factor = row[i] * over % P
                row[i:] = [(x - factor * y) % P for x, y in zip(row[i:], rows[i][i:])]
    return result % P

# The proof --------------------------------------------------------------------------------------------------------------------------------

def resize(size):
    global SIZE, ZERO, ONE
    SIZE, ZERO, ONE = size, [0] * size, [1] + [0] * (size - 1)

def value(text, scope, meaning=None):
    formulas = Formulas(meaning) if meaning else Formulas()
    place = formulas.read(text)
    readable(isinstance(place, int), f"{text}: no number")
    return formulas.run(scope)[place]

def started(scene):
    """The numbers of the start, by name."""
    at = {name: value(text, {}) for name, text in scene["parameters"].items()}
    written = [("t", scene["time"]), *((x, scene["positions"][x]) for x in scene["coordinates"]), *scene["velocities"].items()]
    for name, text in written:
        at[name] = value(text, dict(at))
    return at

def along(names, at, q, v, t):
    """What formulas may contain, q, v and t being series that slopes are taken by."""
    first = lambda name: at[name].first if name in at else None
    curve = [*zip(names, q), *((x + "'", c) for x, c in zip(names, v)), ("t", t)]
    return at | {name: Series(c, first(name), leaf=True) for name, c in curve}

UNIQUE = "constraints at the start", "equations of motion"

def verify(proof):
    """The determinant of the named rows, after the start, the motion and its uniqueness have been verified."""
    scene, order, reactions = proof["scene"], proof["order"], proof["reactions"]
    names, resized = scene["coordinates"], resize(order + 3)
    n, q, at, remark = len(names), [proof["motion"][x] for x in names], started(scene), ""
    v = [[(k + 1) * x % P for k, x in enumerate(c[1:])] + [0] for c in q]
    for x, c in zip(names, q):
        demand(len(c) == SIZE and at[x].c[0] == c[0] and (x + "'" not in at or at[x + "'"].plain().c[0] == c[1]), f"{x} at the start")
    formulas = Formulas()
    L, f = formulas.read(scene["lagrangian"]), [formulas.read(text) for text in scene["constraints"]]
    forces = [formulas.read(scene["forces"].get(x, "0")) for x in names]
    divisors = {text: formulas.read(text) for text in proof["divided_by"] if text not in UNIQUE}
    scope = along(names, at, q, v, [at["t"].c[0], 1])
    values, leaves = formulas.run(scope), [scope[x] for x in names] + [scope[x + "'"] for x in names]
    slopes, h = slopes_of(values[L].plain(), leaves), len(f)
    both = [slopes_of(values[place].plain(), leaves) for place in f]
    A, B, momenta = [x[n:] for x in both], [x[:n] for x in both], slopes[n:]
    demand(h > 0 and len(reactions) == order + 1 and all(len(x) == h for x in reactions), "the number of reactions")
    Q = [values[place].plain().c for place in forces]
    E = [[((k + 1) * momenta[i][k + 1] - slopes[i][k] - Q[i][k]) % P for k in range(order + 1)] for i in range(n)]
    for i, k in product(range(n), range(order + 1)):
        demand((E[i][k] - sum(A[j][i][k - l] * reactions[l][j] for l in range(k + 1) for j in range(h))) % P == 0, "the motion")
    demand(not any(c for place in f for c in values[place].c[: order + 2]), "the constraints along the motion")
    # the start is unique
    free = [j for j, x in enumerate(names) if x + "'" not in scene["velocities"]]
    degrees = formulas.degrees([names[j] + "'" for j in free])
    demand(len(free) in (0, h) and proof["completed"] in ([], [names[j] + "'" for j in free]), "what the start leaves open")
    readable(all(degrees[place] <= 1 for place in f), "constraints that are not linear in the velocities they supply")
    divided = {UNIQUE[0]: determinant([[A[i][j][0] for j in free] for i in range(h)] if free else [])}
    if not free:
        demand(all(values[place].first in (None, (0, 0)) for place in f), "the constraints at the start")
        if not all(values[place].first for place in f):
            near(scene, scene["velocities"])
            remark = "; the constraints hold there mod p and to 1e-6"
    # the motion is unique: L_v moves by L_vv where v moves
    resize(2)
    matrix = [[0] * n + [-A[j][i][0] for j in range(h)] for i in range(n)] + [[x[0] for x in row] + [0] * h for row in A]
    start = {name: Series(x.c, x.first) for name, x in at.items()}
    for j in range(n):
        moved = along(names, start, q, [[c[0], int(i == j)] for i, c in enumerate(v)], [at["t"].c[0]])
        moved |= {x: Series([c[0]], at[x].first, leaf=True) for x, c in zip(names, q)}
        for i, slope in enumerate(slopes_of(formulas.run(moved)[L], [moved[x + "'"] for x in names])):
            matrix[i][j] = slope[1]
    divided |= {UNIQUE[1]: determinant(matrix)} | {text: values[place].plain().c[0] for text, place in divisors.items()}
    demand(divided == proof["divided_by"] and all(divided.values()), "what is divided by")
    system = [[0] * (h * (order + 2)) + [E[i][k]] for k, i in proof["rows"]]
    for row, (k, i) in zip(system, proof["rows"]):
        for l, j in product(range(k + 1), range(h)):
            row[h * (k - l + 1) + j] += A[j][i][l] * (k - l + 1)
            row[h * (k - l) + j] += (l + 1) * A[j][i][l + 1] - B[j][i][l]
    demand({len(row) for row in system} == {len(system)}, "the number of rows")
    demand(determinant(system) == proof["minor"] != 0, "the minor")
    return remark

# The scene file ---------------------------------------------------------------------------------------------------------------------------

def hold(table, proof):
    """Holds the plain scene, for which the certificate is verified, against the file."""
    readable("body" not in table, "bodies; `deltaq show --formulas` writes the scene that they mean")
    scene, given, order = proof["scene"], proof["set"], proof["order"]
    names, extra = list(table["coordinates"]), []
    start, definitions, parameters = [table.get(section, {}) for section in ("start", "definitions", "parameters")]
    removal = next(iter(table.get("removal", {}).values()), {})
    own = [x for x in removal.get("parameters", []) if x not in names] + list(removal.get("memory", {}))
    leaves = {x + dash for x in names + own for dash in ("", "'")} | {"t"}
    def meaning(formulas, name):
        if name in leaves:
            return formulas.put("name", name)
        if name in definitions or name in parameters:
            return formulas.read(given.get(name, parameters[name]) if name in parameters else definitions[name])
        readable(name[-1] == "'" and name[:-1] + "'" not in leaves and name[:-1] not in leaves, f"the name {name}")
        return formulas.rate(meaning(formulas, name[:-1]))
    demand(names == scene["coordinates"], "the coordinates are not those of the file")
    elsewhere = r"duration|kappa|mu\d+|P0_\w+"
    for name in given:
        known = name in parameters or name in leaves or name == "time" or re.fullmatch(elsewhere, name)
        demand(known, f"what is set: the file has no {name}")
    resize(order + 3)
    at, same = started(scene), lambda a, b: a.c == b.c and a.first == b.first
    for name in parameters:
        demand(name not in scene["parameters"] or same(value(name, {}, meaning), at[name]), f"{name} is not that of the file")
    if not proof["almost_every_start"]:
        here = {"t": value(given.get("time", start.get("time", 0)), {}, meaning)}
        demand(same(here["t"], at["t"]), "the time of the start is not that of the file")
        for x, entry in table["coordinates"].items():
            here[x] = value(given.get(x, entry["start"]), dict(here), meaning)
            demand(same(here[x], at[x]), f"{x} at the start is not that of the file")
        texts = start.get("velocities", {}) | {name: text for name, text in given.items() if name[-1] == "'"}
        readable(not start.get("project"), "velocities that are projected")
        readable(not start.get("equations"), "start equations")
        rates = {name: value(text, dict(here), meaning) for name, text in texts.items()}
        readable(all(name in leaves and name[-1] == "'" for name in rates), "a velocity of no coordinate")
        if any(name[:-1] not in names for name in rates):
            rates = by_removal(removal, here, rates, names, meaning)
            readable(len(rates) == len(names), "a removal that does not give all velocities")
        for name, x in rates.items():
            demand(name in proof["completed"] or name in at and x.c[0] == at[name].c[0], f"{name} at the start is not that of the file")
        extra = [name for name in scene["velocities"] if name not in rates]
        demand(set(proof["completed"]) <= set(rates), "what is completed")
        if proof["completed"]:
            near(scene, texts)
    plain, formulas = Formulas(), Formulas(meaning)
    forces, flat = table["system"].get("forces", {}), lambda x: [z for y in x for z in flat(y)] if isinstance(x, list) else [x]
    f = flat([formulas.read(text) for text in table["system"].get("constraints", [])])
    for i, place in enumerate(f):
        below = formulas.below([place])
        if not any(kind == "rate" or kind == "name" and args[0][-1] == "'" for kind, *args in below):
            f[i] = formulas.rate(place)
    file = [formulas.read(table["system"]["lagrangian"]), *f, *(formulas.read(forces.get(x, 0)) for x in names)]
    texts = [scene["lagrangian"], *scene["constraints"], *(scene["forces"].get(x, "0") for x in names)]
    words = ["the Lagrangian", *(f"constraint {i + 1}" for i in range(len(f))), *(f"the force on {x}" for x in names)]
    demand(len(file) == len(texts), "the number of constraints is not that of the file")
    own, point, branch = [plain.read(text) for text in texts], proof.get("point", scene), ""
    moving = {*leaves, *(x + "'" for x in names)}
    if proof["almost_every_start"] and (formulas.branches(moving) or plain.branches(moving)):
        # where roots have branches, on that of the start of the file
        first = [("t", given.get("time", start.get("time", 0))), *((x, given.get(x, entry["start"])) for x, entry in table["coordinates"].items())]
        box = about(decimals(first, meaning), ["t", *names])
        formulas.on_one_branch(moving, box)
        other, drawn = about(decimals(numbers_of(point)), ["t", *names]), drawn_in(box)
        plain.on_one_branch(moving, parameters_of(scene) | {x: (min(a, other[x][0]), max(b, other[x][1])) for x, (a, b) in box.items()})
        at |= started(scene | {"time": drawn.pop("t"), "positions": drawn, "velocities": {}})
        branch = ", on the branch of its start"
    # Taylor coefficients along a random curve
    curves = lambda firsts: [[x, *(secrets.randbelow(P) for _ in range(SIZE - 1))] for x in firsts]
    q, v = curves(at[x].c[0] for x in names), curves(proof["motion"][x][1] for x in names)
    scope = along(names, at, q, v, curves([at["t"].c[0]])[0])
    rates = [(scope[x], scope[x + "'"]) for x in names] + [(scope["t"], Series.of(1))]
    values, others = formulas.run(scope, rates), plain.run(scope)
    for place, mine, word in zip(file, own, words):
        demand(values[place].plain().c == others[mine].plain().c, f"{word} is not that of the file")
    return branch + (f", which leaves {' '.join(extra)} to the constraints" if extra else "")

def by_removal(removal, here, rates, names, meaning):
    """All velocities, where the start gives rates of parameters of the first removal."""
    at, moving = dict(here), removal.get("rates", {}) | removal.get("memory", {})
    at |= {x: value(text, at, meaning) for x, text in removal.get("start", {}).items()}
    at = {x: Series(y.c, y.first, leaf=True) for x, y in at.items()} | rates
    for x, text in moving.items():
        rates[x + "'"] = at[x + "'"] = value(text, at, meaning)
    pairs = [(at[x], at[x + "'"]) for x in at if x + "'" in at] + [(at["t"], Series.of(1))]
    for x, text in removal.get("direct", {}).items():
        formulas = Formulas(meaning)
        place = formulas.rate(formulas.read(text))
        rates[x + "'"] = formulas.run(at, pairs)[place]
    return {name: x for name, x in rates.items() if name[:-1] in names}

def decimals(texts, meaning=None):
    """The numbers of these texts by name, each made of those before it."""
    at = {}
    for name, text in texts:
        formulas = Formulas(meaning) if meaning else Formulas()
        place = formulas.read(text)
        at[name] = formulas.in_decimals(at)[place]
    return at

def numbers_of(scene):
    """Names and texts of parameters, time and positions."""
    return [*scene["parameters"].items(), ("t", scene["time"]), *((x, scene["positions"][x]) for x in scene["coordinates"])]

def about(at, names):
    """The box about a point: as far as the program draws from a start where roots have branches."""
    sizes = [abs(at[x]) for x in names if at[x]]
    size = lambda x: abs(at[x]) or min(sizes, default=1.0)
    return {x: (at[x] - size(x) / 512, at[x] + size(x) / 512) for x in names}

def parameters_of(scene):
    """Intervals of the parameters, which do not vary."""
    return {x: (at, at) for x, at in decimals(scene["parameters"].items()).items()}

def drawn_in(box):
    """Texts of fractions in a box."""
    part = lambda: Fraction(secrets.randbelow(2**20), 2**20)
    return {x: str(Fraction(a) + (Fraction(b) - Fraction(a)) * part()) for x, (a, b) in box.items()}

def near(scene, texts):
    """Demands of velocities that they fulfil the constraints but for round-off."""
    at = decimals([*numbers_of(scene), *texts.items()])
    formulas = Formulas()
    f = [formulas.read(text) for text in scene["constraints"]]
    values = formulas.in_decimals(at)
    for place in f:
        moves = sum(abs(formulas.in_decimals(at | {name: 0.0})[place] - values[place]) for name in texts)
        demand(abs(values[place]) <= 1e-6 * moves, "velocities miss the constraints by more than round-off")

# Reading ----------------------------------------------------------------------------------------------------------------------------------

WHOLE, WORD, TRUTH = lambda x: type(x) is int and 0 <= x < 2**64, lambda x: type(x) is str, lambda x: type(x) is bool
MANY, NAMED = lambda kind: lambda x: type(x) is list and all(map(kind, x)), lambda kind: lambda x: type(x) is dict and all(map(kind, x.values()))
PAIR = lambda x: MANY(WHOLE)(x) and len(x) == 2
EXACTLY = lambda kinds: lambda x: type(x) is dict and x.keys() == kinds.keys() and all(kind(x[key]) for key, kind in kinds.items())
SCENE = {"coordinates": MANY(WORD), "constraints": MANY(WORD), "lagrangian": WORD, "time": WORD}
SCENE |= {name: NAMED(WORD) for name in ("parameters", "forces", "positions", "velocities")}
COMMON = {"schema": WORD, "scene": EXACTLY(SCENE), "digest": WORD, "prime": WHOLE, "unity": PAIR, "roots": NAMED(WHOLE), "set": NAMED(WORD)}
COMMON |= {"exponents": EXACTLY({"order": WHOLE, "e^i": WHOLE, "e": WHOLE})}

def of_kind(proof, kinds):
    """The certificate, where every field is of its kind; its scene and its images are looked at, and the images taken."""
    fields = COMMON | kinds
    for name, kind in fields.items():
        readable(kind(proof.get(name)), f"the field {name}")
    readable(proof.keys() == fields.keys(), f"the fields {proof.keys() - fields.keys()}")
    plain, names = proof["scene"], set(proof["scene"]["coordinates"])
    rates = {x + "'" for x in names}
    demand(names == plain["positions"].keys() and len(names) == len(plain["coordinates"]), "the coordinates")
    readable(all(re.fullmatch(r"[A-Za-z_]\w*", x, re.ASCII) for x in [*names, *plain["parameters"]]), "the name of a coordinate or parameter")
    demand(plain["forces"].keys() <= names, "a force on no coordinate")
    demand(plain["velocities"].keys() <= rates, "a velocity of no coordinate")
    demand(not names & {"t", "pi"} and not plain["parameters"].keys() & (names | {"t", "pi"}), "a name that is used twice")
    digest = hashlib.sha256(json.dumps(plain, separators=(",", ":"), ensure_ascii=False).encode()).hexdigest()
    demand(proof["digest"] == "sha256:" + digest, "the digest of the scene")
    p, (M, z), exponents = proof["prime"], proof["unity"], proof["exponents"]
    order = exponents["order"]
    demand(is_prime(p) and p > max(2**50, proof.get("order", 0) + 2), "p is not a prime over 2^50")
    readable(0 < M < 2**32, "M")
    small = [l for l in range(2, 2**16) if M % l == 0 and is_prime(l)]
    large = [M // d for d in range(1, 2**16) if M % d == 0 and is_prime(M // d)]
    demand(M % 4 == 0 and pow(z, M, p) == 1 and all(pow(z, M // l, p) != 1 for l in small + large), "the image of e^(2 pi i/M)")
    demand(order > 0 and pow(exponents["e^i"], order, p) == pow(exponents["e"], order, p) == 1, "the images of e^i and e")
    return map_to(p, [M, z], exponents, proof["roots"]) or proof

def map_to(prime, unity, exponents, roots):
    """Images mod p from here on."""
    global P, I, R, E, E_I, UNITY, ROOTS
    P, UNITY, ROOTS, R, E_I, E = prime, unity, roots, exponents["order"], exponents["e^i"], exponents["e"]
    I = pow(unity[1], unity[0] // 4, P)

def checked(proof):
    """The certificate, where every field is of its kind."""
    readable(type(proof) is dict and proof.get("schema") == "deltaq/certificate/2", "the schema")
    order, rows = lambda x: WHOLE(x) and x < 200, MANY(PAIR)
    kinds = {"almost_every_start": TRUTH, "order": order, "rows": rows, "minor": WHOLE, "divided_by": NAMED(WHOLE), "completed": MANY(WORD)}
    of_kind(proof, kinds | {"motion": NAMED(MANY(WHOLE)), "reactions": MANY(MANY(WHOLE))})
    names = set(proof["scene"]["coordinates"])
    demand(proof["motion"].keys() == names, "the coordinates")
    demand(all(i < len(names) and k <= proof["order"] for k, i in proof["rows"]), "the rows")
    demand(all(x < P for c in [*proof["motion"].values(), *proof["reactions"]] for x in c), "a coefficient that is not under p")
    return proof

def answered(verified, *files):
    """Prints what a script finds of a certificate, a line about the file among it, and returns the exit code."""
    sys.setrecursionlimit(20000)
    try:
        readable(0 < len(files) < 3, "the arguments; python verify.py [SCENE.toml] CERTIFICATE.json")
        with open(files[-1]) as file:
            proof = json.load(file)
        lines, against = verified(proof)
        held, table = "; no scene file was given to hold it against", None
        if files[1:]:
            with open(files[0], "rb") as file:
                table = tomllib.load(file, parse_float=str)
            try:
                held = f"; it is that of {files[0]}" + hold(table, against)
            except (Unreadable, KeyError, TypeError, AttributeError) as fault:
                raise Unreadable(f"{files[0]}: {fault}; the certificate is verified for its own plain scene")
    except Forged as fault:
        return print(f"forged: {fault}") or 1
    except Unreadable as fault:
        return print(f"cannot read: {fault}") or 2
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError, OverflowError) as fault:
        return print(f"cannot read: {type(fault).__name__}: {fault}") or 2
    print("\n".join(lines))
    if proof["set"]:
        print("set:", ", ".join(f"{name} = {text}" for name, text in proof["set"].items()))
    print(f"scene: {proof['digest']}{held}")
    return 0

def no_multipliers(proof):
    """What is verified, in lines, and what the scene file is held against."""
    remark = verify(checked(proof))
    scene = proof["scene"]
    start = {"t": scene["time"]} | {x: scene["positions"][x] for x in scene["coordinates"]} | scene["velocities"]
    open_ = [x + "'" for x in scene["coordinates"] if x + "'" not in scene["velocities"]]
    everywhere = " and from almost every one on its piece of the constraints" if proof["almost_every_start"] else ""
    of = f"(order {proof['order']}, minor {proof['minor']} mod {P})"
    lines = [f"verified: no mu_0 makes Chetaev's motion from this start{everywhere} vakonomic {of}"]
    supplied = f"; from the constraints: {' '.join(open_)}" if open_ else ""
    lines.append("start: " + ", ".join(f"{name} = {text}" for name, text in start.items()) + supplied + remark)
    if proof["completed"]:
        lines.append(f"completed: {' '.join(proof['completed'])}, which decimals of the scene miss by round-off")
    return lines, proof

def of_integrals(file):
    """Whether a file is a certificate of `deltaq integrals`."""
    try:
        with open(file) as text:
            return json.load(text)["schema"].startswith("deltaq/integrals-certificate/")
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return False

def main(*files):
    if files and of_integrals(files[-1]):
        sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
        return __import__("integrals").main(*files)
    return answered(no_multipliers, *files)

if __name__ == "__main__":
    sys.modules["verify"] = sys.modules["__main__"]
    sys.exit(main(*sys.argv[1:]))
