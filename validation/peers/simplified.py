"""Elimination in SymPy with trigonometric simplification along the way: closed forms where there are short ones."""

import sympy

from algebras import Sympy
from derivation import eliminate, without_constants

# an expression of more operations than this is left as it is
LONGEST = 60


def shorter(e):
    if e.is_Atom or e.count_ops() > LONGEST or not e.has(sympy.sin, sympy.cos):
        return e
    simple = sympy.trigsimp(e)
    return simple if simple.count_ops() < e.count_ops() else e


def explicit(instant, start):
    """As `derivation.explicit`, in SymPy's expressions."""
    algebra = Sympy()
    instant.matrix = [[shorter(sympy.sympify(e)) for e in row] for row in instant.matrix]
    instant.right = [shorter(sympy.sympify(e)) for e in instant.right]
    z = dict(zip(instant.z, eliminate(instant, algebra, start, shorter)))
    rates = [sympy.sympify(e).xreplace(z) for e in instant.rates]
    tags, y, rates, start, fixed = without_constants(algebra, instant.tags, instant.y, rates, start)
    return tags, y, [sympy.sympify(e) for e in rates], start, fixed
