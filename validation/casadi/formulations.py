"""The three formulations, derived by CasADi's differentiation from the text of L, f, Q and the removals.

    Chetaev             d/dt L_v - L_q = Q + A' lambda,   d/dt f = 0,     A = f_v;     unknowns z = (a, lambda)
    vakonomic           F = L + mu . f:   d/dt F_v - F_q = Q,  d/dt f = 0;             unknowns z = (a, mu')
    removed constraint  G = L + P . B:    d2/dt2 G_u'' - d/dt (G_u' + (dq/du')' Q) + G_u + (dq/du)' Q = 0,  P' = -G_w - (dq/dw)' Q,  w' = B;
                        unknowns z = u'' (u''' where G or the virtual work Q . dq holds u'')

Every formulation becomes an `Instant`: states y with tags, unknowns z, the residual R(z; t, y), linear in z, and the rates of y.
A tag is what a state is and of what: ("q", "x"), ("v", "x"), ("mu", "1"), ("u", "s"), ("du", "s"), ("ddu", "s"), ("p", "s"), ("w", "x"), ("P", "x").
"""

import casadi as ca
import numpy as np

from reader import CasadiAlgebra, value

ALGEBRA = CasadiAlgebra()


def vector(entries):
    """A column (k x 1) of expressions and numbers."""
    return ca.vertcat(*[ca.SX(e) for e in entries]) if entries else ca.SX(0, 1)


def rate(e, flow):
    """d/dt e (k x 1) along `flow`, a list of (variables, their rates)."""
    return ca.jtimes(e, ca.vertcat(*[x for x, _ in flow]), ca.vertcat(*[r for _, r in flow]))


def jacobian_product(e, x, y):
    """(de/dx)' y."""
    return ca.mtimes(ca.jacobian(e, x).T, y) if y.numel() else ca.SX.zeros(x.numel())


class Instant:
    """y (s x 1) with tags, z (k x 1), R(z; t, y) (k x 1), rates of y (s x 1) in (t, y, z); q and f for those who ask."""

    def __init__(self, t, tags, y, z, residual, rates, coordinates, constraints, multipliers=()):
        self.t, self.tags, self.y, self.z, self.rates = t, tags, y, z, rates
        self.coordinates, self.multipliers = coordinates, list(multipliers)
        self.matrix = ca.jacobian(residual, z)
        if ca.depends_on(self.matrix, z):
            raise ValueError("the equations of the instant are not linear in their unknowns")
        self.right = -ca.substitute(residual, z, ca.SX.zeros(z.numel()))
        self.numbers = ca.Function("instant", [t, y], [self.matrix, self.right])
        self.rate_function = ca.Function("rates", [t, y, z], [rates])
        self.coordinate_function = ca.Function("coordinates", [t, y], [coordinates])
        self.constraint_function = ca.Function("constraints", [t, y], [constraints])

    def ordered(self, tags, values):
        """Columns of `values` (N x len(tags)) in the order of our states; states that are not among `tags` are zero."""
        place = {tuple(tag): i for i, tag in enumerate(tags)}
        unknown = set(place) - set(self.tags)
        if unknown:
            raise ValueError(f"states that this formulation does not have: {sorted(unknown)}")
        out = np.zeros((values.shape[0], len(self.tags)))
        for column, tag in enumerate(self.tags):
            if tag in place:
                out[:, column] = values[:, place[tag]]
        return out

    def solve(self, times, states):
        """z (N x k), rates (N x s) and condition numbers (N) of the equilibrated matrices at N instants (N), (N x s)."""
        count, k = len(times), self.z.numel()
        t, y = np.reshape(times, (1, -1)), states.T
        if k == 0:
            rates = self.rate_function.map(count)(t, y, np.zeros((0, count)))
            return np.zeros((count, 0)), np.array(rates).T, np.ones(count)
        matrix, right = self.numbers.map(count)(t, y)
        # CasADi puts the N matrices side by side
        matrix = np.array(matrix).reshape(k, count, k).transpose(1, 0, 2)
        right = np.array(right).T
        rows = np.abs(matrix).max(axis=2, keepdims=True)
        rows[rows == 0] = 1.0
        scaled = matrix / rows
        columns = np.abs(scaled).max(axis=1, keepdims=True)
        columns[columns == 0] = 1.0
        scaled = scaled / columns
        good = np.isfinite(scaled).all(axis=(1, 2))
        condition = np.full(count, np.inf)
        condition[good] = np.linalg.cond(scaled[good])
        solvable = condition < 1e15
        z = np.full((count, k), np.nan)
        z[solvable] = np.linalg.solve(scaled[solvable], (right / rows[:, :, 0])[solvable][:, :, None])[:, :, 0]
        z /= columns[:, 0, :]
        rates = np.array(self.rate_function.map(count)(t, y, z.T)).T
        return z, rates, condition


def system(scene, q, v, t):
    """L (1 x 1), f (h x 1) and Q (n x 1) of a scene in the given expressions."""
    names = scene.coordinates
    positions = {name: q[i] for i, name in enumerate(names)}
    velocities = {name: v[i] for i, name in enumerate(names)}
    scope = scene.scope(ALGEBRA, t, positions, velocities)
    read = lambda text: value(text, scope, ALGEBRA)
    lagrangian = ca.SX(read(scene.lagrangian))
    return lagrangian, vector([read(f) for f in scene.constraints]), vector([read(scene.forces.get(n, 0.0)) for n in names])


def chetaev(scene):
    """d/dt L_v - L_q - Q - A' lambda = 0, d/dt f = 0."""
    n, h = len(scene.coordinates), len(scene.constraints)
    t, q, v, a = ca.SX.sym("t"), ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("a", n)
    reaction = ca.SX.sym("lambda", h)
    lagrangian, f, force = system(scene, q, v, t)
    flow = [(q, v), (v, a), (t, ca.SX(1))]
    balance = rate(ca.gradient(lagrangian, v), flow) - ca.gradient(lagrangian, q) - force - jacobian_product(f, v, reaction)
    residual = ca.vertcat(balance, rate(f, flow)) if h else balance
    tags = [("q", name) for name in scene.coordinates] + [("v", name) for name in scene.coordinates]
    multipliers = [("lambda", str(i + 1), n + i) for i in range(h)]
    return Instant(t, tags, ca.vertcat(q, v), ca.vertcat(a, reaction), residual, ca.vertcat(v, a), q, f, multipliers)


def vakonomic(scene):
    """F = L + mu . f: d/dt F_v - F_q = Q, d/dt f = 0."""
    n, h = len(scene.coordinates), len(scene.constraints)
    t, q, v, a = ca.SX.sym("t"), ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("a", n)
    mu, mu_rate = ca.SX.sym("mu", h), ca.SX.sym("mu_rate", h)
    lagrangian, f, force = system(scene, q, v, t)
    augmented = lagrangian + (ca.dot(mu, f) if h else 0)
    flow = [(q, v), (v, a), (mu, mu_rate), (t, ca.SX(1))]
    balance = rate(ca.gradient(augmented, v), flow) - ca.gradient(augmented, q) - force
    residual = ca.vertcat(balance, rate(f, flow)) if h else balance
    tags = [("q", x) for x in scene.coordinates] + [("v", x) for x in scene.coordinates]
    tags += [("mu", str(i + 1)) for i in range(h)]
    y, z = ca.vertcat(q, v, mu), ca.vertcat(a, mu_rate)
    return Instant(t, tags, y, z, residual, ca.vertcat(v, a, mu_rate), q, f)


class Substitution:
    """A removal put into the system: symbols t, u, du, ddu (m x 1), w (k x 1), and B (k x 1), q, q' (n x 1), L, f, Q in them."""

    def __init__(self, scene, name):
        removal = scene.removals[name]
        self.parameters, self.memory = removal.parameters, removal.memory
        m, k = len(self.parameters), len(self.memory)
        self.t, self.w = ca.SX.sym("t"), ca.SX.sym("w", k)
        self.u, self.du, self.ddu = (ca.SX.sym(s, m) for s in ("u", "du", "ddu"))
        more, positions, velocities = {}, {}, {}
        for i, parameter in enumerate(self.parameters):
            more |= {parameter: self.u[i], parameter + "'": self.du[i], parameter + "''": self.ddu[i]}
        more |= {variable: self.w[i] for i, variable in enumerate(self.memory)}
        missing = {x: ca.SX.nan() for x in scene.coordinates}
        scope = scene.scope(ALGEBRA, self.t, missing, missing, more)
        self.rates = vector([value(removal.texts[x], scope, ALGEBRA) for x in self.memory])
        for x in scene.coordinates:
            positions[x] = value(removal.direct[x], scope, ALGEBRA) if x in removal.direct else more[x]
        self.q = vector([positions[x] for x in scene.coordinates])
        flow = [(self.u, self.du), (self.du, self.ddu), (self.w, self.rates), (self.t, ca.SX(1))]
        self.v = rate(self.q, flow)
        self.lagrangian, self.constraints, self.forces = system(scene, self.q, self.v, self.t)


def removed_constraint(scene, name):
    """G = L + P . B; first order in u unless G or Q . dq holds u'', and then with states u'' and p = G_u' + (dq/du')' Q - d/dt G_u''."""
    s = Substitution(scene, name)
    m, k = len(s.parameters), len(s.memory)
    costates, p, u3 = ca.SX.sym("P", k), ca.SX.sym("p", m), ca.SX.sym("u3", m)
    generating = s.lagrangian + (ca.dot(costates, s.rates) if k else 0)
    work = lambda x: jacobian_product(s.q, x, s.forces)
    first, second = ca.gradient(generating, s.du) + work(s.du), ca.gradient(generating, s.ddu)
    by_u, by_w = ca.gradient(generating, s.u) + work(s.u), ca.gradient(generating, s.w) + work(s.w)
    varied = ca.vertcat(generating, first, by_u, by_w)
    high = [i for i in range(m) if ca.depends_on(varied, s.ddu[i])]
    low = [i for i in range(m) if i not in high]
    pick = lambda x, places: vector([x[i] for i in places])
    flow = [(s.u, s.du), (s.du, s.ddu), (pick(s.ddu, high), pick(u3, high)), (s.w, s.rates), (costates, -by_w), (s.t, ca.SX(1))]
    unknowns = ca.vertcat(pick(s.ddu, low), pick(u3, high))
    balance = rate(first, flow) - by_u
    order_two = rate(second, flow) - first + p
    residual = ca.vertcat(pick(balance, low), pick(order_two, high))
    y = ca.vertcat(s.u, s.du, pick(s.ddu, high), pick(p, high), s.w, costates)
    rates = ca.vertcat(s.du, s.ddu, pick(u3, high), pick(by_u, high), s.rates, -by_w)
    tags = [("u", x) for x in s.parameters] + [("du", x) for x in s.parameters]
    tags += [("ddu", s.parameters[i]) for i in high] + [("p", s.parameters[i]) for i in high]
    tags += [("w", x) for x in s.memory] + [("P", x) for x in s.memory]
    constraints = s.constraints if not ca.depends_on(s.constraints, unknowns) else ca.SX(0, 1)
    return Instant(s.t, tags, y, unknowns, residual, rates, s.q, constraints)


def derive(scene, formulation, removal):
    """The instant of a formulation by name; `removal` is the name of a removal or None."""
    if formulation == "chetaev":
        return chetaev(scene)
    if formulation.startswith("vakonomic"):
        return vakonomic(scene)
    return removed_constraint(scene, removal)
