"""Direct transcription: curves that make the discretized action stationary, found without any equation of motion.

On each of N equal intervals a curve is a polynomial of degree S, given by its values at S + 1 Gauss-Lobatto points; neighbours share the value between
them. The action is the sum of the S-point Gauss rule (order 2 S), and the constraint holds at the Gauss points, with one multiplier each:

    vakonomic           sum_c w_c [ L(q, q', t) + mu_c . f(q, q', t) ]             stationary in q and mu; q(t0), q(t1) fixed
    removed constraint  sum_c w_c [ L(u', u, w, t) + P_c . (B(u', u, w, t) - w') ]  stationary in u, w and P; u(t0), u(t1), w(t0) fixed, w(t1) free

Where forces act, the sum of w_c Q_c . delta q_c is added to the change of that sum, and both together vanish.

Newton's method with CasADi's exact Jacobian of the change, from a guess that is wrong by some hundredths. The multipliers between the Gauss points are those of
the polynomial of degree S - 1 through the values of their interval. Removals whose B or L contains u'' are left to the other comparisons.
"""

import casadi as ca
import numpy as np

from formulations import Substitution, derive, system

S = 8
TOLERANCE = 1e-7
NEWTON_STEPS = 40
# size of the wrong guess, relative to the way of a variable (at least 1)
PERTURBATION = 0.02


def lagrange_basis(nodes, x):
    """Values (len(x) x len(nodes)) of the basis polynomials at x, and their derivatives."""
    values, slopes = np.ones((len(x), len(nodes))), np.zeros((len(x), len(nodes)))
    for j, node in enumerate(nodes):
        others = np.delete(nodes, j)
        polynomial = np.poly1d(others, r=True) / np.prod(node - others)
        values[:, j], slopes[:, j] = polynomial(x), polynomial.deriv()(x)
    return values, slopes


def points():
    """Lobatto points (S + 1), Gauss points and weights (S), all on [0, 1]."""
    legendre = np.polynomial.legendre.Legendre.basis(S)
    lobatto = np.concatenate([[-1.0], legendre.deriv().roots().real, [1.0]])
    gauss, weights = np.polynomial.legendre.leggauss(S)
    return (np.sort(lobatto) + 1) / 2, (gauss + 1) / 2, weights / 2


def problem(scene, case):
    """(x tags, lambda tags, [integrand, Q . q_(x, x', m)] (t, x, x', multipliers), function of x that gives q, tags free at the end)."""
    n, h = len(scene.coordinates), len(scene.constraints)
    t, multiplier = ca.SX.sym("t"), None
    if case["formulation"] == "vakonomic":
        q, v, multiplier = ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("mu", h)
        lagrangian, f, forces = system(scene, q, v, t)
        integrand = lagrangian + (ca.dot(multiplier, f) if h else 0)
        work = ca.vertcat(forces, ca.SX.zeros(n + h))
        integrand = ca.Function("integrand", [t, q, v, multiplier], [integrand, work])
        tags = [("q", x) for x in scene.coordinates]
        return tags, [("mu", str(i + 1)) for i in range(h)], integrand, ca.Function("q", [t, q], [q]), []
    s = Substitution(scene, case["removal"])
    k = len(s.memory)
    costate, dw = ca.SX.sym("P", k), ca.SX.sym("dw", k)
    integrand = s.lagrangian + (ca.dot(costate, s.rates - dw) if k else 0)
    if ca.depends_on(ca.vertcat(integrand, s.q), s.ddu):
        raise ValueError("L or B contains second rates")
    x, dx = ca.vertcat(s.u, s.w), ca.vertcat(s.du, dw)
    free = [("w", name) for name in s.memory]
    tags = [("u", name) for name in s.parameters] + free
    costates = [("P", name) for name in s.memory]
    # a removal may have q depend on u', and then on delta u'
    work = ca.mtimes(ca.jacobian(s.q, ca.vertcat(x, dx, costate)).T, s.forces)
    integrand = ca.Function("integrand", [s.t, x, dx, costate], [integrand, work])
    return tags, costates, integrand, ca.Function("q", [s.t, x], [s.q]), free


class Action:
    """The discretized action with its constraints; unknowns are the nodes (d x (N S + 1)) and the multipliers (k x N S), column after column.

    Its change with the virtual work, and that change's Jacobian, are CasADi's at every Gauss point, in (x, x', m), and carried over to the unknowns by the chain rule: x = V nodes, x' = D nodes.
    """

    def __init__(self, integrand, d, k, times, intervals):
        lobatto, gauss, weights = points()
        self.values, self.slopes = lagrange_basis(lobatto, gauss)
        self.d, self.k, self.intervals = d, k, intervals
        self.length = (times[-1] - times[0]) / intervals
        self.slopes = self.slopes / self.length
        self.weights = np.tile(weights, intervals) * self.length
        self.times = times[0] + (np.arange(intervals)[:, None] + gauss[None, :]).ravel() * self.length
        t, z = ca.SX.sym("t"), ca.SX.sym("z", 2 * d + k)
        value, work = integrand(t, z[:d], z[d : 2 * d], z[2 * d :])
        change = ca.gradient(value, z) + work
        self.local = ca.Function("local", [t, z], [ca.densify(ca.jacobian(change, z)), ca.densify(change)]).map(len(self.times))
        self.nodes = d * (intervals * S + 1)
        self.size = self.nodes + k * intervals * S

    def evaluate(self, unknowns):
        """The change (size) at `unknowns` (size), and its Jacobian (size x size) before it."""
        d, k, count = self.d, self.k, self.intervals * S
        nodes = unknowns[: self.nodes].reshape(-1, d).T
        at = np.empty((2 * d + k, count))
        for i in range(self.intervals):
            local, part = nodes[:, i * S : (i + 1) * S + 1], slice(i * S, (i + 1) * S)
            at[:d, part], at[d : 2 * d, part] = local @ self.values.T, local @ self.slopes.T
        at[2 * d :] = unknowns[self.nodes :].reshape(-1, k).T if k else 0.0
        local_jacobian, local_change = (np.array(x) for x in self.local(self.times.reshape(1, -1), at))
        jacobian, total = np.zeros((self.size, self.size)), np.zeros(self.size)
        for p in range(count):
            i, c = divmod(p, S)
            # (x, x', m) at this point from the nodes of the interval and its own multipliers
            chain = np.zeros((2 * d + k, d * (S + 1) + k))
            chain[:d, : d * (S + 1)] = np.kron(self.values[c], np.eye(d))
            chain[d : 2 * d, : d * (S + 1)] = np.kron(self.slopes[c], np.eye(d))
            chain[2 * d :, d * (S + 1) :] = np.eye(k)
            first = i * S * d
            places = np.concatenate([np.arange(first, first + d * (S + 1)), self.nodes + p * k + np.arange(k)])
            block = local_jacobian[:, p * (2 * d + k) : (p + 1) * (2 * d + k)]
            jacobian[np.ix_(places, places)] += self.weights[p] * (chain.T @ block @ chain)
            total[places] += self.weights[p] * (chain.T @ local_change[:, p])
        return jacobian, total


def newton(action, unknowns, free):
    """Stationary values of the unknowns at the places `free`; (values of all, steps)."""
    relative = np.inf
    for step in range(NEWTON_STEPS):
        jacobian, total = action.evaluate(unknowns)
        change = -np.linalg.solve(jacobian[np.ix_(free, free)], total[free])
        unknowns[free] += change
        previous, relative = relative, np.abs(change).max() / max(1.0, np.abs(unknowns).max())
        if relative < 1e-13 or (relative < 1e-9 and relative >= previous):
            return unknowns, step + 1
        if not np.isfinite(relative):
            break
    raise ValueError(f"Newton's method did not converge: last step {relative:.1e} after {step + 1} steps")


def interpolated(table, intervals, at):
    """Columns of a table of samples at the ends and middles of the intervals (2 N + 1 x d), between them linear, at fractions `at` of the whole."""
    grid = np.linspace(0, 1, 2 * intervals + 1)
    return np.array([np.interp(at, grid, column) for column in table.T])


def relative(ours, theirs):
    """Largest |difference| over the columns, each relative to the largest deviation of the table from its start, or to 1."""
    scale = max(1.0, float(np.abs(ours - ours[0]).max(initial=0.0)))
    return float(np.abs(ours - theirs).max(initial=0.0)) / scale


def compare(scene, case):
    """Rows (who, what, count, largest, tolerance, note) for the curve and for the multipliers."""
    tags, multiplier_tags, integrand, coordinates, free = problem(scene, case)
    instant = derive(scene, case["formulation"], case["removal"])
    times = np.array(case["times"])
    states = instant.ordered(case["tags"], np.array(case["states"]))
    column = {tag: i for i, tag in enumerate(instant.tags)}
    ours, ours_multipliers = states[:, [column[t] for t in tags]], states[:, [column[t] for t in multiplier_tags]]
    intervals, d, k = (len(times) - 1) // 2, len(tags), len(multiplier_tags)
    action = Action(integrand, d, k, times, intervals)

    lobatto, gauss, _ = points()
    place = np.concatenate([[0.0]] + [(i + lobatto[1:]) / intervals for i in range(intervals)])
    exact = interpolated(ours, intervals, place)
    random = np.random.default_rng(1)
    size = PERTURBATION * np.maximum(1.0, np.abs(ours - ours[0]).max(axis=0))[:, None]
    guess = exact + size * np.sin(np.pi * place)[None, :] * random.uniform(-1, 1, (d, 1)) + 0.1 * size * random.uniform(-1, 1, exact.shape)
    fixed = np.zeros(exact.shape, dtype=bool)
    fixed[:, 0] = True
    fixed[:, -1] = [tag not in free for tag in tags]
    guess[fixed] = exact[fixed]

    # multipliers start from zero
    unknowns = np.concatenate([guess.T.ravel(), np.zeros(k * intervals * S)])
    free_places = np.concatenate([np.flatnonzero(~fixed.T.ravel()), np.arange(action.nodes, action.size)])
    solution, steps = newton(action, unknowns, free_places)
    found = solution[: action.nodes].reshape(-1, d).T
    found_multipliers = solution[action.nodes :].reshape(intervals * S, k).T

    middle, _ = lagrange_basis(lobatto, np.array([0.0, 0.5, 1.0]))
    middle_multipliers, _ = lagrange_basis(gauss, np.array([0.0, 0.5, 1.0]))
    curve, path = np.empty((len(times), d)), np.empty((len(times), k))
    for i in range(intervals):
        curve[2 * i : 2 * i + 3] = middle @ found[:, i * S : (i + 1) * S + 1].T
        path[2 * i : 2 * i + 3] = middle_multipliers @ found_multipliers[:, i * S : (i + 1) * S].T
    q = lambda table: np.array(coordinates.map(len(times))(times.reshape(1, -1), table.T)).T
    label, note = case["label"], f"{steps} Newton steps"
    if free:
        label += ", P = 0 at the end"
    rows = [("transcription", f"{label}: curve of stationary action", len(times), relative(q(ours), q(curve)), TOLERANCE, note)]
    if k:
        name = "μ(t)" if case["formulation"] == "vakonomic" else "P(t)"
        rows.append(("transcription", f"{label}: {name}", len(times), relative_multipliers(ours_multipliers, path), TOLERANCE))
    return rows


def relative_multipliers(ours, theirs):
    """Largest |difference| relative to the largest multiplier, or to 1."""
    return float(np.abs(ours - theirs).max()) / max(1.0, float(np.abs(ours).max()))
