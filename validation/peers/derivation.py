"""The three formulations, derived from the text of a scene in the expressions of any tool.

    Chetaev             d/dt L_v - L_q = Q + A' lambda,   d/dt f = 0,     A = f_v;     z = (a, lambda)
    vakonomic           F = L + mu . f:   d/dt F_v - F_q = 0,  d/dt f = 0;             z = (a, mu')
    removed constraint  G = L + P . B:    d/dt G_u' - G_u = 0,  P' = -G_w,  w' = B;    z = u''

Each is K(y) z = r(y) with the rates of y linear in z. `eliminate` solves that by Gauss, in expressions: a tool that compiles what it integrates gets
straight-line code without a matrix in it. This is not the derivation of `validation/casadi`, which leaves K z = r to be solved in numbers.
"""

import numpy as np

from reader import value

# a pivot has at least this fraction of the largest entry of its column, at the start
THRESHOLD = 0.1


class Instant:
    """y with tags, K (k x k), r (k), z (k symbols), and the rates of y in (y, z)."""

    def __init__(self, tags, y, matrix, right, z, rates):
        self.tags, self.y, self.matrix, self.right, self.z, self.rates = tags, y, matrix, right, z, rates


def dot(xs, ys, zero):
    """Sum of products; what is zero as it stands is left out by the algebras themselves."""
    total = zero
    for x, y in zip(xs, ys):
        total = total + x * y
    return total


def symbols(algebra, letter, count):
    return [algebra.symbol(f"{letter}_{i}") for i in range(count)]


def system(scene, algebra, q, v, more=None):
    """L, f and Q of a scene without explicit time, q and v lists of expressions."""
    zero = algebra.number("0")
    names = scene.coordinates
    scope = scene.scope(algebra, zero, dict(zip(names, q)), dict(zip(names, v)), more)
    read = lambda text: value(text, scope, algebra)
    return read(scene.lagrangian), [read(f) for f in scene.constraints], [read(scene.forces.get(n, 0.0)) for n in names]


def chetaev(scene, algebra):
    n, h, zero = len(scene.coordinates), len(scene.constraints), algebra.number("0")
    q, v = symbols(algebra, "q", n), symbols(algebra, "v", n)
    lagrangian, f, force = system(scene, algebra, q, v)
    momenta = algebra.jacobian([lagrangian], v)[0]
    by_q = algebra.jacobian([lagrangian], q)[0]
    mass, coupling = algebra.jacobian(momenta, v), algebra.jacobian(momenta, q)
    reaction, slope = algebra.jacobian(f, v), algebra.jacobian(f, q)
    matrix = [mass[i] + [-reaction[k][i] for k in range(h)] for i in range(n)] + [reaction[k] + [zero] * h for k in range(h)]
    right = [by_q[i] + force[i] - dot(coupling[i], v, zero) for i in range(n)] + [-dot(slope[k], v, zero) for k in range(h)]
    a, multipliers = symbols(algebra, "a", n), symbols(algebra, "lambda", h)
    tags = [("q", x) for x in scene.coordinates] + [("v", x) for x in scene.coordinates]
    return Instant(tags, q + v, matrix, right, a + multipliers, v + a)


def vakonomic(scene, algebra):
    n, h, zero = len(scene.coordinates), len(scene.constraints), algebra.number("0")
    q, v, mu = symbols(algebra, "q", n), symbols(algebra, "v", n), symbols(algebra, "mu", h)
    lagrangian, f, _ = system(scene, algebra, q, v)
    augmented = lagrangian + dot(mu, f, zero)
    momenta, by_q = algebra.jacobian([augmented], v)[0], algebra.jacobian([augmented], q)[0]
    mass, coupling = algebra.jacobian(momenta, v), algebra.jacobian(momenta, q)
    reaction, slope = algebra.jacobian(f, v), algebra.jacobian(f, q)
    matrix = [mass[i] + [reaction[k][i] for k in range(h)] for i in range(n)] + [reaction[k] + [zero] * h for k in range(h)]
    right = [by_q[i] - dot(coupling[i], v, zero) for i in range(n)] + [-dot(slope[k], v, zero) for k in range(h)]
    a, mu_rate = symbols(algebra, "a", n), symbols(algebra, "mu_rate", h)
    tags = [("q", x) for x in scene.coordinates] + [("v", x) for x in scene.coordinates] + [("mu", str(i + 1)) for i in range(h)]
    return Instant(tags, q + v + mu, matrix, right, a + mu_rate, v + a + mu_rate)


def removed_constraint(scene, algebra, name):
    """For removals whose rates B hold u and u' only and that give no coordinate directly."""
    removal, zero = scene.removals[name], algebra.number("0")
    if removal.direct:
        raise ValueError(f"the removal {name} gives coordinates directly")
    m, k = len(removal.parameters), len(removal.memory)
    u, du, w, costates = (symbols(algebra, letter, size) for letter, size in (("u", m), ("du", m), ("w", k), ("P", k)))
    more = {}
    for i, parameter in enumerate(removal.parameters):
        more |= {parameter: u[i], parameter + "'": du[i]}
    more |= dict(zip(removal.memory, w))
    # the rates of a removal may hold its own variables and nothing else: None would fail in any expression
    missing = dict.fromkeys(scene.coordinates)
    scope = scene.scope(algebra, zero, {x: more[x] for x in scene.coordinates}, missing, more)
    rates = [value(removal.texts[x], scope, algebra) for x in removal.memory]
    speeds = dict(zip(removal.memory, rates)) | dict(zip(removal.parameters, du))
    lagrangian, _, _ = system(scene, algebra, [more[x] for x in scene.coordinates], [speeds[x] for x in scene.coordinates], more)
    generating = lagrangian + dot(costates, rates, zero)
    momenta = algebra.jacobian([generating], du)[0]
    by_u, by_w = algebra.jacobian([generating], u)[0], algebra.jacobian([generating], w)[0]
    costate_rates = [-e for e in by_w]
    flow, flow_rates = u + w + costates, du + rates + costate_rates
    along = algebra.jacobian(momenta, flow)
    matrix = algebra.jacobian(momenta, du)
    right = [by_u[i] - dot(along[i], flow_rates, zero) for i in range(m)]
    ddu = symbols(algebra, "ddu", m)
    tags = [("u", x) for x in removal.parameters] + [("du", x) for x in removal.parameters]
    tags += [("w", x) for x in removal.memory] + [("P", x) for x in removal.memory]
    return Instant(tags, u + du + w + costates, matrix, right, ddu, du + ddu + rates + costate_rates)


def derive(scene, algebra, formulation, removal):
    if formulation == "chetaev":
        return chetaev(scene, algebra)
    if formulation == "vakonomic":
        return vakonomic(scene, algebra)
    return removed_constraint(scene, algebra, removal)


def ordered(tags, theirs, values):
    """Start values in the order of `tags`; a state that is not among `theirs` starts at zero."""
    table = dict(zip(theirs, values))
    return [table.get(tag, 0.0) for tag in tags]


def eliminate(instant, algebra, start, name=lambda e: e):
    """z as expressions. `name` may give an intermediate result a name of its own and return that.

    Pivots: of the entries that are large enough at the start, the one that fills in least (Markowitz).
    """
    size = len(instant.z)
    flat = [e for row in instant.matrix for e in row]
    values = algebra.numbers(flat, instant.y, start).reshape(size, size) if size else np.zeros((0, 0))
    rows = [[None if algebra.is_zero(e) else e for e in row] for row in instant.matrix]
    right = [None if algebra.is_zero(e) else e for e in instant.right]
    values = values.copy()
    free, pivots = set(range(size)), []
    columns = set(range(size))
    while free:
        best = None
        for j in sorted(columns):
            largest = max((abs(values[i, j]) for i in free if rows[i][j] is not None), default=0.0)
            down = sum(1 for i in free if rows[i][j] is not None) - 1
            for i in sorted(free):
                if rows[i][j] is None or abs(values[i, j]) < THRESHOLD * largest or values[i, j] == 0.0:
                    continue
                across = sum(1 for c in columns if rows[i][c] is not None) - 1
                cost = (down * across, down + across, i, j)
                if best is None or cost < best:
                    best = cost
        if best is None:
            raise ValueError("the equations of the instant are singular at the start")
        _, _, i, j = best
        free.discard(i)
        columns.discard(j)
        pivots.append((i, j))
        for other in sorted(free):
            if rows[other][j] is None:
                continue
            factor, number = name(rows[other][j] / rows[i][j]), values[other, j] / values[i, j]
            for c in sorted(columns):
                if rows[i][c] is None:
                    continue
                product = factor * rows[i][c]
                rows[other][c] = name(-product if rows[other][c] is None else rows[other][c] - product)
                values[other, c] -= number * values[i, c]
            if right[i] is not None:
                product = factor * right[i]
                right[other] = name(-product if right[other] is None else right[other] - product)
            rows[other][j] = None
    z = [None] * size
    for i, j in reversed(pivots):
        total = right[i]
        for c in range(size):
            if c != j and rows[i][c] is not None and z[c] is not None:
                product = rows[i][c] * z[c]
                total = -product if total is None else total - product
        z[j] = None if total is None else name(total / rows[i][j])
    return [algebra.number("0") if e is None else e for e in z]


def explicit(instant, algebra, start):
    """Tags, states, rates and start of y' = F(y), a state that never changes replaced by its value; for tools that keep shared terms shared."""
    z = dict(zip(map(str, instant.z), eliminate(instant, algebra, start)))
    return without_constants(algebra, instant.tags, instant.y, [z.get(str(e), e) for e in instant.rates], start)


def without_constants(algebra, tags, y, rates, start):
    fixed = [i for i, e in enumerate(rates) if algebra.is_zero(e)]
    kept = [i for i in range(len(y)) if i not in fixed]
    rates = algebra.substitute([rates[i] for i in kept], [(y[i], start[i]) for i in fixed])
    # a constant rate may have turned into a number of the host language
    return [tags[i] for i in kept], [y[i] for i in kept], list(rates), [start[i] for i in kept], {tags[i]: start[i] for i in fixed}


class Places:
    """Columns of coordinates in tables of states, by tags; a state that never changes has a value instead of a column."""

    def __init__(self, coordinates, tags, fixed):
        self.places = []
        for name in coordinates:
            known = [tag for tag in (("q", name), ("w", name), ("u", name)) if tag in tags or tag in fixed]
            if not known:
                raise ValueError(f"no state is the coordinate {name}")
            self.places.append((tags.index(known[0]), None) if known[0] in tags else (None, fixed[known[0]]))

    def __call__(self, table):
        picked = [table[:, j] if j is not None else np.full(len(table), x) for j, x in self.places]
        return np.stack(picked, axis=1)
