"""SymPy's expressions as formulas of deltaq, and its mechanical systems as a System. SymPy is imported only by those who have it."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any

from ._native import System

if TYPE_CHECKING:
    from sympy.physics.mechanics import KanesMethod, LagrangesMethod
    from sympy.physics.mechanics import System as SymPySystem

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def from_sympy(method: LagrangesMethod | KanesMethod | SymPySystem, **arguments: Any) -> System:
    """The system of a `LagrangesMethod`, a `KanesMethod` or a `System` of `sympy.physics.mechanics`.

    Parameters
    ----------
    method : LagrangesMethod, KanesMethod or System
        Coordinates, bodies or a Lagrangian, constraints and loads. Generalized speeds are replaced by their kinematic equations,
        and auxiliary ones are zero. Holonomic constraints are kept by their rate; multipliers are deltaq's own.
    **arguments
        Those of `System` that SymPy does not know, such as start, velocities, parameters, duration.

    Returns
    -------
    System
        The system.

    Raises
    ------
    TypeError
        If a constraint was put into the velocities of a body, so that they are not the rate of a place in the coordinates: Lagrange's
        equations would be wrong. Also for another kind of method, or one without bodies.
    """
    from sympy.physics.mechanics import KanesMethod, LagrangesMethod

    if isinstance(method, LagrangesMethod):
        coordinates, (lagrangian,) = list(method.q), method._L
        constraints = list(method._hol_coneqs) + list(method.coneqs)[len(method._hol_coneqs) :]
        forces = _forces(method.forcelist, method.inertial, coordinates, list(method.u), lambda vector: vector)
    elif isinstance(method, KanesMethod):
        if not method.bodies:
            raise TypeError("the KanesMethod has no bodies: give them to it, KanesMethod(..., bodies=..., forcelist=...)")
        zero = dict.fromkeys(method._uaux, 0)
        kinematic = [rate - speed for rate, speed in method.kindiffdict().items()]
        constraints = list(method._k_nh * method.u + method._f_nh) if method._k_nh else []
        given = (list(method.q), list(method.u), kinematic, method._inertial, method.bodies, method.forcelist or ())
        coordinates, lagrangian, constraints, forces = _by_speeds(*given, constraints, zero, has_potential=False)
    elif _is_system(method):
        loads = [*method.loads, *(load for actuator in method.actuators for load in actuator.to_loads())]
        zero = dict.fromkeys(method.u_aux, 0)
        given = (list(method.q), list(method.u), list(method.kdes), method.frame, method.bodies, loads)
        coordinates, lagrangian, constraints, forces = _by_speeds(*given, list(method.velocity_constraints), zero, has_potential=True)
    else:
        raise TypeError(f"{type(method)} where a LagrangesMethod, a KanesMethod or a System of SymPy is expected")
    return System(coordinates, lagrangian, constraints, forces=forces, **arguments)


def _is_system(method: Any) -> bool:
    return any(kind.__name__ == "System" and kind.__module__.startswith("sympy.physics.mechanics") for kind in type(method).__mro__)


def _forces(loads: Any, frame: Any, coordinates: list[Any], rates: list[Any], in_rates: Callable[[Any], Any]) -> dict[Any, Any]:
    """Generalized forces: the sum of force (or torque) times the derivative of its velocity by each rate."""
    from sympy.physics.mechanics import ReferenceFrame

    forces = dict.fromkeys(coordinates, 0)
    for place, force in loads:
        velocity = in_rates(place.ang_vel_in(frame) if isinstance(place, ReferenceFrame) else place.vel(frame))
        for q, rate in zip(coordinates, rates):
            forces[q] += velocity.diff(rate, frame).dot(in_rates(force))
    return forces


def _by_speeds(
    coordinates: list[Any],
    speeds: list[Any],
    kinematic: list[Any],
    frame: Any,
    bodies: Any,
    loads: Any,
    constraints: list[Any],
    zero: dict[Any, Any],
    *,
    has_potential: bool,
) -> tuple[list[Any], Any, list[Any], dict[Any, Any]]:
    """Coordinates, Lagrangian, constraints and forces of bodies that move by generalized speeds u.

    The kinematic equations give u in q'. An expression in u becomes one in q'; auxiliary speeds are zero.
    """
    import sympy as sp
    from sympy.physics.vector import dynamicsymbols

    if len(speeds) != len(coordinates):
        raise TypeError(
            f"{len(coordinates)} coordinates have {len(speeds)} generalized speeds: a constraint was put into the velocities; "
            "give speeds for all coordinates, and the constraint as one"
        )
    matrix, right = sp.linear_eq_to_matrix([e.subs(zero) for e in kinematic], speeds)
    by_rates = dict(zip(speeds, matrix.LUsolve(right)))
    rates = [q.diff(dynamicsymbols._t) for q in coordinates]

    def in_rates(thing: Any) -> Any:
        return thing.subs(zero).subs(by_rates)

    places = [body.masscenter for body in bodies] + [place for place, _ in loads if hasattr(place, "pos_from")]
    for point in dict.fromkeys(places):
        _refuse_unless_a_rate(point, in_rates(point.vel(frame).to_matrix(frame)), coordinates, rates)
    energy = sum(in_rates(body.kinetic_energy(frame)) for body in bodies)
    if has_potential:
        energy -= sum(in_rates(sp.sympify(body.potential_energy)) for body in bodies)
    in_q = [in_rates(sp.sympify(c)) for c in constraints]
    return coordinates, energy, in_q, _forces(loads, frame, coordinates, rates, in_rates)


def _refuse_unless_a_rate(point: Any, velocity: Any, coordinates: list[Any], rates: list[Any]) -> None:
    """TypeError unless a velocity is the rate of a place in the coordinates: its parts by q' then have equal mixed derivatives.

    If a constraint was put in, they differ; Lagrange's equations would be wrong. This is looked at in random numbers.
    """
    import random

    import sympy as sp

    parts = velocity.jacobian(rates)
    n = len(coordinates)
    mixed = [parts[c, i].diff(coordinates[j]) - parts[c, j].diff(coordinates[i]) for c in range(3) for i in range(n) for j in range(i)]
    symbols = sorted({s for e in mixed for s in e.atoms(sp.Symbol, sp.Function) if s.is_Symbol or isinstance(s, sp.core.function.AppliedUndef)}, key=str)
    drawn = random.Random(1)
    for _ in range(2):
        values = {symbol: drawn.uniform(0.2, 1.2) for symbol in symbols}
        worst = max((abs(float(e.subs(values))) for e in mixed if e != 0), default=0.0)
        if worst > 1e-9:
            raise TypeError(
                f"the velocity of the point {point} is not the rate of a place in the coordinates {', '.join(map(str, coordinates))}: "
                "a constraint was put into it; give the point coordinates of its own, and the constraint as one"
            )


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
