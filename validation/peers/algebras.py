"""Expressions of each tool behind one set of operations, so that one derivation serves them all.

An algebra has `number`, `power` and the functions that the reader of scenes asks for, and besides: `symbol(name)`; `jacobian(es, xs)`, a list of
rows; `is_zero(e)`, whether e is zero as it stands; `substitute(es, table)`; `numbers(es, xs, values)`, the values of expressions at a point.
"""

import math
import time

import numpy as np


class Heyoka:
    """Expressions of heyoka; derivatives by its `diff_tensors`."""

    def __init__(self):
        import heyoka

        self.heyoka, self.pi = heyoka, heyoka.expression(math.pi)
        # seconds in `numbers`: heyoka compiles for it, while a user looks at the matrix and picks pivots by eye
        self.uncounted = 0.0

    def __getattr__(self, name):
        return getattr(self.heyoka, name)

    def number(self, text):
        return self.heyoka.expression(float(text))

    def power(self, base, exponent):
        return base**exponent

    def symbol(self, name):
        return self.heyoka.expression(name)

    def jacobian(self, es, xs):
        if not es or not xs:
            return [[self.number("0") for _ in xs] for _ in es]
        tensors = self.heyoka.diff_tensors([self.heyoka.expression(e) if isinstance(e, float) else e for e in es], diff_args=xs, diff_order=1)
        return [list(row) for row in np.atleast_2d(tensors.jacobian)]

    def is_zero(self, e):
        return e == self.number("0")

    def substitute(self, es, table):
        return self.heyoka.subs(es, {x: self.number(repr(float(value))) for x, value in table})

    def numbers(self, es, xs, values, parameters=()):
        begin = time.perf_counter()
        more = {"pars": np.array(parameters, dtype=float), "time": 0.0}
        found = np.array(self.heyoka.cfunc(es, vars=xs, compact_mode=True)(np.array(values, dtype=float), **more)) if es else np.zeros(0)
        self.uncounted += time.perf_counter() - begin
        return found


class Sympy:
    """Expressions of SymPy with floating-point constants, so that what is constant is computed once."""

    def __init__(self):
        import sympy

        self.sympy, self.pi = sympy, sympy.Float(math.pi)

    def __getattr__(self, name):
        return getattr(self.sympy, name)

    def number(self, text):
        value = float(text)
        return self.sympy.Integer(int(value)) if value == int(value) else self.sympy.Float(value)

    def power(self, base, exponent):
        return base**exponent

    def symbol(self, name):
        return self.sympy.Symbol(name, real=True)

    def jacobian(self, es, xs):
        return [[self.sympy.diff(e, x) for x in xs] for e in es]

    def is_zero(self, e):
        return e == 0

    def substitute(self, es, table):
        table = dict(table)
        return [self.sympy.sympify(e).xreplace({x: self.number(repr(float(value))) for x, value in table.items()}) for e in es]

    def numbers(self, es, xs, values):
        return np.array(self.sympy.lambdify(xs, es, modules="math", cse=True)(*map(float, values)), dtype=float) if es else np.zeros(0)


class Casadi:
    """Expressions of CasADi (SX)."""

    pi = math.pi

    def __init__(self):
        import casadi

        self.casadi = casadi

    def __getattr__(self, name):
        return getattr(self.casadi, name)

    def number(self, text):
        return self.casadi.SX(float(text))

    def power(self, base, exponent):
        return base**exponent

    def symbol(self, name):
        return self.casadi.SX.sym(name)

    def jacobian(self, es, xs):
        if not es or not xs:
            return [[self.number("0") for _ in xs] for _ in es]
        matrix = self.casadi.jacobian(self.casadi.vertcat(*es), self.casadi.vertcat(*xs))
        return [[matrix[i, j] for j in range(len(xs))] for i in range(len(es))]

    def is_zero(self, e):
        return self.casadi.SX(e).is_zero()

    def substitute(self, es, table):
        if not table:
            return es
        old, new = self.casadi.vertcat(*[x for x, _ in table]), self.casadi.vertcat(*[float(value) for _, value in table])
        whole = self.casadi.substitute(self.casadi.vertcat(*es), old, new)
        return [whole[i] for i in range(len(es))]

    def numbers(self, es, xs, values):
        if not es:
            return np.zeros(0)
        function = self.casadi.Function("numbers", [self.casadi.vertcat(*xs)], [self.casadi.vertcat(*es)])
        return np.array(function(np.array(values, dtype=float))).ravel()
