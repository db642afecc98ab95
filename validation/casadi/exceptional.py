"""All starts with which Chetaev's motion of a small system is vakonomic, and for which multipliers, in exact algebra by SymPy.

Along Chetaev's motion mu' = X C mu - lam with a left inverse X of A', and the motion is vakonomic just where p_0 = (1 - A' X) C mu and all
its rates p_1, p_2, ... vanish. With cos and sin of each angle for variables these are polynomials in (q, v, mu), so the pairs of a start and its multipliers
are a variety. STATED says what it is: a union of components, each by polynomials that vanish there. Two things are shown.

- There is nothing else: take one polynomial of every component; their product vanishes where p_0 ... p_K do, since 1 is in the ideal of these and of
  1 - z times the product (Rabinowitsch). Also complex solutions are excluded so.
- All of it belongs there: p_0 vanishes on every component, and so do the rates of the polynomials that it is given by. Then motions stay on it.

None of the components lies in the others. Numbers are those of the scene, but sines of numbers, which are any.
"""

import itertools

import sympy as sp

from reader import Scene, SympyAlgebra, value

# by name of the scene: how many rates p_1 ... p_K are needed, and the components; c_phi = cos(phi), s_phi = sin(phi)
STATED = {
    "sledge": (3, [["phi'", "s_phi", "mu1"], ["x'", "y'", "phi'", "c_phi"]]),
    "sleigh": (2, [["phi'", "mu1"], ["x'", "y'", "phi'"]]),
    "particle": (2, [["x'", "mu1"], ["y'", "mu1"], ["x'", "y'"]]),
    "nonholonomic-oscillator": (3, [["x'", "mu1"], ["y", "y'", "mu1"], ["x'", "y", "y'"]]),
    "martinet": (3, [["x'", "mu1"], ["y'", "mu1"], ["y", "y'"], ["x'", "y'"]]),
    "heisenberg": (1, [["mu1"], ["x'", "y'"]]),
    "disc": (2, [["mu1 + x'", "mu2 + y'"], ["phi'", "mu1*s_phi - mu2*c_phi"], ["phi'", "psi'"]]),
    "generalized-heisenberg": (1, [["mu1"], ["x1'", "y1'", "x2'", "y2'"]]),
    "mobile-robot": (2, [["mu1 + x'", "mu2 + y'"], ["phi'", "mu1*s_phi - mu2*c_phi"], ["phi'", "psi'", "c_psi"]]),
    "coin-on-incline": (3, [["phi'", "s_phi", "mu2"], ["phi'", "psi'", "c_phi"]]),
}

WHAT = "all starts with a multiplier"


class System:
    """Polynomials of a scene; `rate` differentiates them along Chetaev's motion."""

    def __init__(self, text, orders):
        scene, algebra = Scene(text), SympyAlgebra()
        names = scene.coordinates
        q, v = [sp.symbols(names), sp.symbols([f"{x}'" for x in names])]
        n, h = len(names), len(scene.constraints)
        mu = sp.symbols(f"mu1:{h + 1}")
        scope = scene.scope(algebra, sp.Integer(0), dict(zip(names, q)), dict(zip(names, v)))
        read = lambda entry: value(entry, scope, algebra)
        L, f = read(scene.lagrangian), sp.Matrix([read(x) for x in scene.constraints])
        Q = sp.Matrix([read(scene.forces.get(x, 0)) for x in names])
        angles = sorted({x for e in [L, *f, *Q] for g in e.atoms(sp.sin, sp.cos) for x in g.free_symbols}, key=str)
        circle = {x: sp.symbols(f"c_{x} s_{x}") for x in angles}
        exchange = [(g, y) for x in angles for g, y in zip((sp.cos(x), sp.sin(x)), circle[x])]
        # a sine of a number is a number of its own: the answer then holds for almost every value of it
        numbers = sorted({g for e in [L, *f, *Q] for g in e.atoms(sp.sin, sp.cos) if not g.free_symbols}, key=str)
        exchange += [(g, sp.Symbol(f"k{i}")) for i, g in enumerate(numbers)]
        plain = lambda m: m.subs(exchange)
        A, M = f.jacobian(v), sp.hessian(L, v)
        rest = Q + sp.Matrix([L.diff(x) for x in q]) - sp.Matrix([L]).jacobian(v).T.jacobian(q) * sp.Matrix(v)
        rate_of_A = sp.Matrix(h, n, lambda i, j: sum(A[i, j].diff(x) * y for x, y in zip(q, v)))
        C = f.jacobian(q).T - rate_of_A.T
        A, M, C, rest, drift = map(plain, (A, M, C, rest, f.jacobian(q) * sp.Matrix(v)))
        self.relations = [plain(x) for x in f] + [c**2 + s**2 - 1 for c, s in circle.values()]
        saddle = sp.Matrix(sp.BlockMatrix([[M, -A.T], [A, sp.zeros(h, h)]]))
        gram = A * A.T
        self.nonzero = [saddle.det(method="berkowitz"), gram.det(), *(sp.Symbol(f"k{i}") for i in range(len(numbers)))]
        solved = saddle.adjugate() * rest.col_join(-drift) / self.nonzero[0]
        pull = C * sp.Matrix(mu)
        left = gram.adjugate() * A / self.nonzero[1]
        rates = dict(zip(v, solved[:n])) | dict(zip(mu, left * pull - solved[n:, :]))
        for x, y in zip(q, v):
            rates |= {circle[x][0]: -circle[x][1] * y, circle[x][1]: circle[x][0] * y} if x in circle else {x: y}
        used = set().union(*(e.free_symbols for e in [*self.relations, *pull, *rates.values()])) | set(v) | set(mu)
        self.rates = {x: e for x, e in rates.items() if x in used or x in v}
        self.variables = sorted(used, key=str)
        self.names = {str(x): x for x in self.variables}
        self.basis = sp.groebner(self.relations, *self.variables, order="grevlex")
        conditions = [self.reduced(x) for x in pull - A.T * (left * pull)]
        self.first = conditions
        self.conditions = list(conditions)
        for _ in range(orders):
            conditions = [self.rate(p) for p in conditions]
            self.conditions += conditions

    def reduced(self, e):
        """The numerator of `e` modulo the relations; what denominators are made of is in `nonzero`."""
        return self.basis.reduce(sp.expand(sp.fraction(sp.together(e))[0]))[1]

    def rate(self, p):
        return self.reduced(sum(p.diff(x) * e for x, e in self.rates.items() if p.has(x)))

    def polynomial(self, text):
        return sp.sympify(value(text, self.names, SympyAlgebra()))

    def vanishes(self, p, where):
        """Whether p is zero wherever the polynomials `where` and the relations are, and nothing is divided by zero."""
        z, product = sp.Dummy(), sp.prod([p, *self.nonzero])
        found = sp.groebner([*self.relations, *where, 1 - z * product], z, *self.variables, order="grevlex")
        return found.exprs == [1]


def faults(text, orders, stated):
    """What of the statement is not so, in words."""
    system = System(text, orders)
    components = [[system.polynomial(p) for p in component] for component in stated]
    found = []
    for choice in itertools.product(*components):
        if not system.vanishes(sp.prod(choice), system.conditions):
            found.append(f"more solutions: {', '.join(map(str, choice))} need not vanish")
    for component in components:
        inside = [*system.first, *(system.rate(p) for p in component)]
        if not all(system.vanishes(p, component) for p in inside if p != 0):
            found.append(f"{component}: not all of it are solutions")
        others = itertools.product(*(other for other in components if other is not component))
        if all(system.vanishes(sp.prod(choice), component) for choice in others):
            found.append(f"{component}: lies in the others")
    return found


def check(name, text):
    """Row (who, what, count, largest, tolerance, note); `largest` is the number of faults."""
    orders, stated = STATED[name]
    found = faults(text, orders, stated)
    return "SymPy", WHAT, len(stated), float(len(found)), 0.0, "; ".join(found)
