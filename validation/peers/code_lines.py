"""Straight-line Python from SymPy's expressions: for the interpreter as it is, and for numba."""

import sympy

from algebras import Sympy
from derivation import eliminate

HEAD = "import math\n\n\n"


class Lines:
    """Assignments in order, and what is handed back."""

    def __init__(self, instant, start):
        self.lines = []
        shared, (matrix, right, rates) = self.share(instant)
        self.lines += shared
        instant.matrix, instant.right = matrix, right
        z = self.eliminated(instant, start)
        table = dict(zip(instant.z, z))
        rates = [sympy.sympify(e).xreplace(table) for e in rates]
        fixed = {i: start[i] for i, e in enumerate(rates) if e == 0}
        values = {instant.y[i]: sympy.Float(x) for i, x in fixed.items()}
        self.lines = [(name, e.xreplace(values)) for name, e in self.lines]
        kept = [i for i in range(len(rates)) if i not in fixed]
        self.rates = [rates[i].xreplace(values) for i in kept]
        self.y, self.tags, self.start = [instant.y[i] for i in kept], [instant.tags[i] for i in kept], [start[i] for i in kept]
        self.fixed = {instant.tags[i]: x for i, x in fixed.items()}

    @staticmethod
    def share(instant):
        size = len(instant.z)
        flat = [sympy.sympify(e) for e in [e for row in instant.matrix for e in row] + list(instant.right) + list(instant.rates)]
        shared, flat = sympy.cse(flat, symbols=sympy.numbered_symbols("c"))
        matrix = [flat[size * i : size * (i + 1)] for i in range(size)]
        return shared, (matrix, flat[size * size : size * size + size], flat[size * size + size :])

    def eliminated(self, instant, start):
        algebra = Sympy()
        # pivots are chosen by their values at the start, for which the shared parts are needed
        values = dict(zip(instant.y, start))
        for name, e in self.lines:
            values[name] = float(e.xreplace({k: sympy.Float(x) for k, x in values.items() if k in e.free_symbols}))
        names = list(values)
        known = type(instant)(instant.tags, names, instant.matrix, instant.right, instant.z, instant.rates)
        return eliminate(known, algebra, list(values.values()), self.named)

    def named(self, e):
        if e.is_Atom:
            return e
        name = sympy.Symbol(f"e{len(self.lines)}")
        self.lines.append((name, e))
        return name

    def body(self, last):
        code = sympy.pycode
        lines = [f"    {', '.join(map(str, self.y))}, = y"]
        lines += [f"    {name} = {code(e)}" for name, e in self.lines]
        return "\n".join(lines + last)

    def for_python(self):
        """rates(t, y) with y an array and a list back; plain floats, which are faster than NumPy's scalars."""
        handed = f"    return [{', '.join(sympy.pycode(e) for e in self.rates)}]"
        return HEAD + "def rates(t, y):\n" + self.body([handed]).replace(" = y\n", " = y.tolist()\n", 1) + "\n"

    def for_numba(self):
        """rates(t, y) with arrays both ways."""
        lines = ["    dy = np.empty(len(y))"] + [f"    dy[{i}] = {sympy.pycode(e)}" for i, e in enumerate(self.rates)] + ["    return dy"]
        unpack = "\n".join(f"    {x} = y[{i}]" for i, x in enumerate(self.y))
        body = self.body(lines).split("\n", 1)[1]
        return HEAD + "import numpy as np\n\n\ndef rates(t, y):\n" + unpack + "\n" + body + "\n"


def function(source):
    """The function `rates` of a source."""
    names = {}
    exec(compile(source, "rates", "exec"), names)
    return names["rates"]
