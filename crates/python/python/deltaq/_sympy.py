"""SymPy's expressions as formulas of deltaq, and its LagrangesMethod as a System. SymPy is imported only by those who have it."""

from __future__ import annotations

import re
import sys
from functools import cache
from typing import TYPE_CHECKING, Any

from ._native import System

if TYPE_CHECKING:
    from sympy.physics.mechanics import LagrangesMethod

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def from_sympy(method: LagrangesMethod, **arguments: Any) -> System:
    """The system of a `sympy.physics.mechanics.LagrangesMethod`: coordinates, Lagrangian, constraints, generalized forces.

    Its holonomic constraints g(q, t) = 0 are constraints of the system as they are, and kept by their rate. Multipliers are
    deltaq's own. arguments: those of `System` that SymPy does not know, such as start, velocities, parameters, duration.

    TypeError for another method: KanesMethod has no Lagrangian.
    """
    from sympy.physics.mechanics import LagrangesMethod, ReferenceFrame

    if not isinstance(method, LagrangesMethod):
        raise TypeError(f"{type(method)} where a LagrangesMethod is expected, which has a Lagrangian")
    frame, (lagrangian,), holonomic = method.inertial, method._L, list(method._hol_coneqs)
    forces = dict.fromkeys(method.q, 0)
    for place, force in method.forcelist:
        velocity = place.ang_vel_in(frame) if isinstance(place, ReferenceFrame) else place.vel(frame)
        for q, rate in zip(method.q, method.u):
            forces[q] += velocity.diff(rate, frame).dot(force)
    constraints = holonomic + list(method.coneqs)[len(holonomic) :]
    return System(method.q, lagrangian, constraints, forces=forces, **arguments)


def text(thing: object) -> str | None:
    """A formula in deltaq's language; None where `thing` is not a SymPy expression.

    TypeError with what the language does not have, ValueError with a symbol that cannot be a name.
    """
    sympy = sys.modules.get("sympy")
    if sympy is None or not isinstance(thing, sympy.Basic) or isinstance(thing, sympy.MatrixBase):
        return None
    expression = thing.doit()
    names: dict[str, object] = {}
    for node in sympy.preorder_traversal(expression):
        refuse_unless_known(sympy, node)
        if node.is_Symbol or isinstance(node, sympy.core.function.AppliedUndef):
            name = node.name
            if not NAME.fullmatch(name):
                raise ValueError(f"`{name}` of SymPy cannot be a name: names have letters of English, digits and _")
            if names.setdefault(name, node) != node:
                raise ValueError(f"`{name}` stands for two symbols of SymPy, {names[name]} and {node}, of one name")
    return str(printer().doprint(expression))


def refuse_unless_known(sympy: Any, node: Any) -> None:
    """TypeError unless `node` is arithmetic of finite real numbers, a function, or a function of time with its derivatives."""
    t = sympy.physics.vector.dynamicsymbols._t if "sympy.physics.vector" in sys.modules else sympy.Symbol("t")
    in_time = isinstance(node, sympy.core.function.AppliedUndef) and node.args == (t,)
    if isinstance(node, sympy.Derivative):
        known = isinstance(node.expr, sympy.core.function.AppliedUndef) and set(node.variables) == {t}
    elif node.is_Number:
        known = node.is_finite
    elif isinstance(node, (sympy.Function, sympy.Max, sympy.Min)):
        known = in_time or not isinstance(node, (sympy.core.function.AppliedUndef, sympy.Piecewise))
    else:
        known = node.is_Symbol or node.is_Add or node.is_Mul or node.is_Pow or node in (sympy.pi, sympy.E)
        known = known or isinstance(node, sympy.Tuple)  # (t, 2) of a derivative
    if not known:
        raise TypeError(f"deltaq has no {type(node).__name__}: `{node}` is not written as a formula")


@cache
def printer() -> Any:
    from sympy.core.function import AppliedUndef
    from sympy.printing.precedence import PRECEDENCE
    from sympy.printing.str import StrPrinter

    class Printer(StrPrinter):
        """The language of scenes, in which functions that have no derivative are refused by their name, with a substitute."""

        def _print_Symbol(self, symbol):
            return symbol.name

        def _print_Function(self, function):
            if isinstance(function, AppliedUndef):  # a function of time
                return function.name
            return f"{type(function).__name__.lower()}({self.stringify(function.args, ', ')})"

        _print_Max = _print_Min = _print_LatticeOp = _print_Function

        def _print_Derivative(self, derivative):
            return derivative.expr.name + "'" * len(derivative.variables)

        def _print_Pow(self, power, rational=False):
            base, exponent = power.base, power.exp
            if exponent.is_Rational and abs(exponent) * 2 == 1:
                return ("" if exponent > 0 else "1/") + f"sqrt({self._print(base)})"
            if exponent == -1:
                return "1/" + self.parenthesize(base, PRECEDENCE["Mul"])
            return self.parenthesize(base, PRECEDENCE["Pow"]) + "^" + self.parenthesize(exponent, PRECEDENCE["Func"])

        def _print_Float(self, number):
            return repr(float(number))

        def _print_Exp1(self, number):
            return "exp(1)"

    return Printer()
