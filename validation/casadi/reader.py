"""Scene files, read without the help of the Rust crates.

What is taken from a scene: names of the coordinates, L(q, v, t), f(q, v, t), Q(q, v, t) and the removals, as text. A name with primes is a
time derivative. Expressions are put together by an *algebra*, any object with `number`, `power` and the functions below as attributes: CasADi's
and SymPy's are at the end, so that one reader serves both referees.
"""

import math
import re
import tomllib

TOKEN = re.compile(r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*'*)|(?P<op>\*\*|[-+*/^(),]))", re.ASCII)


class Formula:
    """A recursive descent through one formula: sums of products of powers; -2^2 = -4 and 2^3^2 = 2^9."""

    def __init__(self, text, scope, algebra):
        self.scope, self.algebra, self.text = scope, algebra, text
        self.tokens, place = [], 0
        text = text.rstrip()
        while place < len(text):
            match = TOKEN.match(text, place)
            if not match:
                raise ValueError(f"unexpected {text[place:]!r} in {text!r}")
            kind = match.lastgroup
            word = match.group(kind)
            self.tokens.append((kind, "^" if word == "**" else word))
            place = match.end()
        self.tokens.append(("end", ""))
        self.place = 0

    def read(self):
        value = self.sum()
        self.expect("")
        return value

    def peek(self):
        return self.tokens[self.place][1]

    def take(self):
        self.place += 1
        return self.tokens[self.place - 1]

    def expect(self, word):
        found = self.take()[1]
        if found != word:
            raise ValueError(f"{found!r} where {word!r} was expected in {self.text!r}")

    def sum(self):
        value = self.product()
        while self.peek() in ("+", "-"):
            value = value + self.product() if self.take()[1] == "+" else value - self.product()
        return value

    def product(self):
        value = self.signed()
        while self.peek() in ("*", "/"):
            value = value * self.signed() if self.take()[1] == "*" else value / self.signed()
        return value

    def signed(self):
        if self.peek() in ("+", "-"):
            return self.signed() if self.take()[1] == "+" else -self.signed()
        return self.power()

    def power(self):
        base = self.primary()
        if self.peek() != "^":
            return base
        self.take()
        return self.algebra.power(base, self.signed())

    def primary(self):
        kind, word = self.take()
        if kind == "number":
            return self.algebra.number(word)
        if word == "(":
            value = self.sum()
            self.expect(")")
            return value
        if kind != "name":
            raise ValueError(f"unexpected {word!r} in {self.text!r}")
        if self.peek() != "(":
            if word in self.scope:
                return self.scope[word]
            if word == "pi":
                return self.algebra.pi
            raise ValueError(f"undefined {word!r} in {self.text!r}")
        self.take()
        arguments = [self.sum()]
        while self.peek() == ",":
            self.take()
            arguments.append(self.sum())
        self.expect(")")
        return self.call(word, arguments)

    def call(self, name, arguments):
        algebra, x = self.algebra, arguments[0]
        if name == "sec":
            return 1 / algebra.cos(x)
        if name == "csc":
            return 1 / algebra.sin(x)
        if name == "cot":
            return algebra.cos(x) / algebra.sin(x)
        if name == "pow":
            return algebra.power(*arguments)
        return getattr(algebra, {"ln": "log"}.get(name, name))(*arguments)


class CasadiAlgebra:
    """Expressions of CasADi (SX); numbers are floats until they meet a symbol."""

    pi = math.pi

    def __init__(self):
        import casadi

        self.casadi = casadi

    def __getattr__(self, name):
        return getattr(self.casadi, name)

    def number(self, text):
        return float(text)

    def power(self, base, exponent):
        whole = isinstance(exponent, float) and exponent == int(exponent)
        return base ** (int(exponent) if whole else exponent)

    def vector(self, name, length):
        return self.casadi.SX.sym(name, length)


class SympyAlgebra:
    """Expressions of SymPy; numbers are exact rationals."""

    def __init__(self):
        import sympy

        self.sympy, self.pi = sympy, sympy.pi

    def __getattr__(self, name):
        return getattr(self.sympy, name)

    def number(self, text):
        return self.sympy.Rational(text)

    def power(self, base, exponent):
        return base**exponent


class Removal:
    """Text of one removal: parameters u, rates of coordinates and of other memory variables, coordinates given directly."""

    def __init__(self, table):
        self.parameters = table["parameters"]
        self.rates = table.get("rates", {})
        self.direct = table.get("direct", {})
        self.memory = list(self.rates) + list(table.get("memory", {}))
        self.texts = {**self.rates, **table.get("memory", {})}


class Scene:
    """What a scene file says about the system, as text."""

    def __init__(self, text):
        table = tomllib.loads(text)
        self.parameters = table.get("parameters", {})
        self.coordinates = list(table["coordinates"])
        self.definitions = table.get("definitions", {})
        system = table["system"]
        self.lagrangian = system["lagrangian"]
        self.constraints = system.get("constraints", [])
        self.forces = system.get("forces", {})
        removals = table.get("removal", {})
        if "parameters" in removals:
            removals = {"given": removals}
        self.removals = {name: Removal(entry) for name, entry in removals.items()}

    def scope(self, algebra, t, positions, velocities, more=None):
        """Names of this scene to expressions; `positions` and `velocities` by name of the coordinate, `more` for further names."""
        names = {name: algebra.number(repr(value)) for name, value in self.parameters.items()}
        names["t"] = t
        for name in self.coordinates:
            names[name] = positions[name]
            names[name + "'"] = velocities[name]
        names.update(more or {})
        for name, text in self.definitions.items():
            try:
                names[name] = value(text, names, algebra)
            except ValueError:
                pass  # holds what a removal has put away; an expression that uses it after all gets the error that it is undefined
        return names


def value(text, scope, algebra):
    """The expression of a text, or of a plain number."""
    if not isinstance(text, str):
        return algebra.number(repr(text))
    return Formula(text, scope, algebra).read()
