"""Chetaev's accelerations by SymPy's `LagrangesMethod`, a second derivation by other hands.

Its equations are d/dt L_v - L_q = Q + f_v' lam with the constraint differentiated once; what is compared are the accelerations.
"""

import numpy as np
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, ReferenceFrame, dynamicsymbols

from reader import Scene, SympyAlgebra, value

TOLERANCE = 1e-12


def accelerations(scene: Scene):
    """A function of t, q (n), v (n) to q'' (n)."""
    algebra, t = SympyAlgebra(), dynamicsymbols._t
    q = [dynamicsymbols(f"q_{i}") for i in range(len(scene.coordinates))]
    v = [x.diff(t) for x in q]
    names = scene.coordinates
    scope = scene.scope(algebra, t, dict(zip(names, q)), dict(zip(names, v)))
    read = lambda text: value(text, scope, algebra)
    if scene.forces:
        raise ValueError("forces are left to the other comparisons")
    constraints = [read(f) for f in scene.constraints]
    method = LagrangesMethod(read(scene.lagrangian), q, nonhol_coneqs=constraints, frame=ReferenceFrame("N"))
    method.form_lagranges_equations()
    plain_q, plain_v = sp.symbols(f"q:{len(q)}"), sp.symbols(f"v:{len(q)}")
    plain = lambda e: e.subs(dict(zip(v, plain_v))).subs(dict(zip(q, plain_q)))
    n, h = len(q), len(constraints)
    matrix, right = plain(method.mass_matrix_full), plain(method.forcing_full)
    evaluate = sp.lambdify([t, *plain_q, *plain_v], [matrix, right], modules="numpy", cse=True)

    def at(time, positions, velocities):
        matrix, right = evaluate(time, *positions, *velocities)
        full = np.linalg.solve(np.array(matrix, dtype=float), np.array(right, dtype=float).ravel())
        return full[n : 2 * n]

    assert matrix.shape == (2 * n + h, 2 * n + h)
    return at


def compare(scene, case, count):
    """Row (who, what, count, largest, tolerance) for the first `count` states of the case."""
    at = accelerations(scene)
    place = {tuple(tag): i for i, tag in enumerate(case["tags"])}
    q = [place[("q", x)] for x in scene.coordinates]
    v = [place[("v", x)] for x in scene.coordinates]
    states, rates = (np.array(case["samples"][key][:count], dtype=float) for key in ("states", "rates"))
    worst = 0.0
    for state, rate in zip(states, rates):
        found, ours = at(state[0], state[1:][q], state[1:][v]), rate[v]
        worst = max(worst, float(np.abs(found - ours).max() / max(np.abs(found).max(), np.abs(ours).max(), 1e-300)))
    return "SymPy", "Chetaev: accelerations (LagrangesMethod)", len(states), worst, TOLERANCE
