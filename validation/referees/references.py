"""Reference motions of the three paper examples, from code that shares nothing with the Rust crates.

Each system is stated once more below (L, f, removal). SymPy derives the equations of the three formulations, they are evaluated in MPFR
arithmetic (gmpy2, 40 digits) and integrated by two methods that have nothing in common: Gragg-Bulirsch-Stoer extrapolation and
Gauss-Legendre collocation of order 16. What both agree on is printed, as tests/tests/references.csv. `--claims` also tests the statements
of the theory (bridge, matching constants, leading coefficients, invariants) and prints what it finds.

    pip install sympy gmpy2 mpmath
    python references.py            > ../../tests/tests/references.csv
    python references.py --claims
"""

import sys
from types import SimpleNamespace

import gmpy2
import mpmath
import sympy as sp
from gmpy2 import mpfr

gmpy2.get_context().precision = 140  # bits, 42 digits
mpmath.mp.prec = 140
FUNCTIONS = {name: getattr(gmpy2, name) for name in ("sin", "cos", "tan", "sqrt")}


ROUND = False  # True: parameters and starts as a double holds them, to see how much that alone moves the end state


def number(text):
    exact = mpfr(text)
    return mpfr(float(exact)) if ROUND else exact


# ---------------------------------------------------------------------------------------------------------------- numbers and linear algebra


def solve(matrix, right):
    """Gaussian elimination with column pivoting, on lists of mpfr."""
    n = len(right)
    rows = [list(row) + [right[i]] for i, row in enumerate(matrix)]
    for i in range(n):
        p = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[p] = rows[p], rows[i]
        pivot = rows[i]
        for r in range(i + 1, n):
            if rows[r][i] != 0:
                factor = rows[r][i] / pivot[i]
                row = rows[r]
                for c in range(i + 1, n + 1):
                    row[c] -= factor * pivot[c]
    out = [mpfr(0)] * n
    for i in reversed(range(n)):
        total = rows[i][n]
        for c in range(i + 1, n):
            total -= rows[i][c] * out[c]
        out[i] = total / rows[i][i]
    return out


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), mpfr(0))


def gap(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def function(arguments, expressions):
    """Expressions to a function on mpfr. Only dyadic fractions may be typed into formulas: Python would divide others in double."""
    flat = sp.Matrix(sp.flatten(expressions))
    for number in flat.atoms(sp.Rational):
        assert number.q & (number.q - 1) == 0, f"{number} would be rounded: make it a parameter"
    assert not flat.atoms(sp.Float)
    compiled = sp.lambdify(arguments, list(flat), modules=[FUNCTIONS], cse=True)
    return lambda *values: [mpfr(x) for x in compiled(*values)]


# ----------------------------------------------------------------------------------------------------------------------------- two integrators


def extrapolate(rhs, t, z, end, tolerance=mpfr("1e-24"), columns=14, mesh=None):
    """Gragg-Bulirsch-Stoer: modified midpoint rule with 2, 4, 6, ... substeps, extrapolated in h^2; step by the last column's change."""
    step = mpfr(end - t) / 64
    tolerance = mpfr(tolerance)
    t, end = mpfr(t), mpfr(end)
    while t < end:
        h = min(step, end - t)
        slope = rhs(t, z)
        table = []
        for j in range(1, columns + 1):
            n = 2 * j
            d = h / n
            before, now = z, [a + d * b for a, b in zip(z, slope)]
            for i in range(1, n):
                s = rhs(t + i * d, now)
                before, now = now, [a + 2 * d * b for a, b in zip(before, s)]
            s = rhs(t + h, now)
            row = [[(a + b + d * c) / 2 for a, b, c in zip(now, before, s)]]
            for k in range(1, j):
                ratio = (mpfr(n) / (2 * (j - k))) ** 2 - 1
                row.append([a + (a - b) / ratio for a, b in zip(row[k - 1], table[-1][k - 1])])
            table.append(row)
        error = max(abs(a - b) / (1 + abs(a)) for a, b in zip(table[-1][-1], table[-1][-2]))
        if error <= tolerance:
            t, z = t + h, table[-1][-1]
            if mesh is not None:
                mesh.append(h)
        scale = mpfr("0.9") * (tolerance / max(error, mpfr("1e-60"))) ** (mpfr(1) / (2 * columns - 1))
        step = h * min(max(scale, mpfr("0.2")), mpfr(3))
    return z


class Gauss:
    """Gauss-Legendre collocation, 8 stages, order 16, on a given mesh, stages by fixed-point iteration."""

    def __init__(self, stages=8):
        mp = mpmath.mp
        x = sp.Symbol("x")
        legendre = sp.Poly(sp.legendre(stages, 2 * x - 1), x)
        nodes = sorted(mpmath.polyroots([mp.mpf(int(c)) for c in legendre.all_coeffs()], maxsteps=500, extraprec=400))
        self.c = [mpfr(mpmath.nstr(mp.re(n), 45)) for n in nodes]
        rows = [[c**k for c in self.c] for k in range(stages)]  # sum_j a_ij c_j^k = c_i^{k+1}/(k+1)
        self.a = [solve(rows, [c ** (k + 1) / (k + 1) for k in range(stages)]) for c in self.c]
        self.b = solve(rows, [mpfr(1) / (k + 1) for k in range(stages)])

    def __call__(self, rhs, t, z, mesh):
        t = mpfr(t)
        slopes = [rhs(t, z)] * len(self.c)
        for h in mesh:
            for _ in range(200):
                points = [[zi + h * dot(row, (s[m] for s in slopes)) for m, zi in enumerate(z)] for row in self.a]
                fresh = [rhs(t + c * h, p) for c, p in zip(self.c, points)]
                change = h * max(gap(a, b) for a, b in zip(fresh, slopes))
                slopes = fresh
                if change < mpfr("1e-30"):
                    break
            else:
                raise ArithmeticError(f"stages do not converge at t = {t}")
            z = [zi + h * dot(self.b, (s[m] for s in slopes)) for m, zi in enumerate(z)]
            t += h
            slopes = [slopes[-1]] * len(self.c)
        return z


# ------------------------------------------------------------------------------------------------------------------- the three formulations


class System:
    """L and f in symbols. Velocities of `x` are the symbols `x_t`."""

    def __init__(self, name, coordinates, lagrangian, constraints, parameters, q0, v0=None):
        self.name, self.names = name, coordinates.split()
        self.q = sp.Matrix(sp.symbols(self.names))
        self.v = sp.Matrix(sp.symbols([n + "_t" for n in self.names]))
        self.n, self.h = len(self.q), len(constraints)
        self.L, self.f = sp.sympify(lagrangian), sp.Matrix(constraints)
        self.parameters = {sp.Symbol(k): number(v) for k, v in parameters.items()}
        self.q0 = [number(x) for x in q0]
        self.v0 = self.complete(v0) if v0 else None

    def function(self, arguments, expressions):
        inner = function([*self.parameters, *arguments], expressions)
        values = list(self.parameters.values())
        return lambda *x: inner(*values, *x)

    def complete(self, given):
        """All velocities from some of them and the constraints (linear in the velocities)."""
        assert len(given) == self.n - self.h
        rows = sp.Matrix([*self.f, *(sp.Symbol(k + "_t") for k in given)])
        jacobian = rows.jacobian(self.v)
        rest = rows.subs({v: 0 for v in self.v})
        values = self.function(self.q, [jacobian, rest])(*self.q0)
        matrix = [values[i * self.n : (i + 1) * self.n] for i in range(self.n)]
        targets = [mpfr(0)] * self.h + [number(x) for x in given.values()]
        return solve(matrix, [a - b for a, b in zip(targets, values[self.n * self.n :])])

    def bordered(self, unknowns, matrix, right):
        """(q, v, …) -> solution of the bordered system."""
        size = len(right)
        evaluate = self.function(unknowns, [matrix, right])

        def solution(*values):
            flat = evaluate(*values)
            return solve([flat[i * size : (i + 1) * size] for i in range(size)], flat[size * size :])

        return solution

    def chetaev(self):
        """d/dt L_v - L_q = A^T lambda."""
        momentum = sp.Matrix([self.L]).jacobian(self.v).T
        a = self.f.jacobian(self.v)
        matrix = sp.Matrix(sp.BlockMatrix([[momentum.jacobian(self.v), -a.T], [a, sp.zeros(self.h)]]))
        right = sp.Matrix([sp.Matrix([self.L]).jacobian(self.q).T - momentum.jacobian(self.q) * self.v, -self.f.jacobian(self.q) * self.v])
        inner = self.bordered([*self.q, *self.v], matrix, right)
        self.reaction = lambda q, v: inner(*q, *v)[self.n :]
        return lambda t, z: z[self.n :] + inner(*z)[: self.n]

    def vakonomic(self):
        """d/dt (L + mu f)_v - (L + mu f)_q = 0."""
        mu = sp.Matrix(sp.symbols(f"mu:{self.h}"))
        total = self.L + (mu.T * self.f)[0]
        momentum = sp.Matrix([total]).jacobian(self.v).T
        a = self.f.jacobian(self.v)
        matrix = sp.Matrix(sp.BlockMatrix([[momentum.jacobian(self.v), a.T], [a, sp.zeros(self.h)]]))
        right = sp.Matrix([sp.Matrix([total]).jacobian(self.q).T - momentum.jacobian(self.q) * self.v, -self.f.jacobian(self.q) * self.v])
        inner = self.bordered([*self.q, *self.v, *mu], matrix, right)
        self.energy = self.function([*self.q, *self.v, *mu], [(momentum.T * self.v)[0] - total])
        return lambda t, z: z[self.n : 2 * self.n] + inner(*z)


class Removal:
    """u: parameters; memory: w -> rate B(u_t, u, w); direct: q -> expression in (u, w). First order in u.

    d/dt G_{u_t} - G_u = 0,  P_t = -G_w,  G = L + P B.
    """

    def __init__(self, system, parameters, memory, direct=None):
        self.system = system
        self.u = sp.Matrix(sp.symbols(parameters.split(), seq=True))
        self.ut = sp.Matrix(sp.symbols([n + "_t" for n in parameters.split()], seq=True))
        self.w = sp.Matrix(sp.symbols(list(memory), seq=True))
        self.m, self.k = len(self.u), len(self.w)
        self.direct = dict(direct or {})
        place = {sp.Symbol(k): v for k, v in self.direct.items()}
        self.B = sp.Matrix([sp.sympify(b).subs(place) for b in memory.values()])
        rate = {sp.Symbol(k + "_t"): b for k, b in zip(memory, self.B)}
        for k, x in self.direct.items():
            rate[sp.Symbol(k + "_t")] = sum((sp.diff(x, a) * b for a, b in [*zip(self.u, self.ut), *zip(self.w, self.B)]), sp.S(0))
        self.insert = lambda e: sp.sympify(e).subs(rate, simultaneous=True).subs(place, simultaneous=True)
        self.q_of = sp.Matrix([self.insert(x) for x in system.q])
        self.v_of = sp.Matrix([self.insert(x) for x in system.v])
        self.P = sp.Matrix(sp.symbols(f"P:{self.k}"))
        self.residual = [self.insert(f) for f in system.f]
        self.G = self.insert(system.L) + (self.P.T * self.B)[0]
        state = [*self.u, *self.ut, *self.w, *self.P]
        self.configuration = system.function(state, [self.q_of, self.v_of])
        self.momentum = system.function(state, [sp.Matrix([self.G]).jacobian(self.ut)])
        g_u = sp.Matrix([self.G]).jacobian(self.ut).T
        self.energy = system.function(state, [(g_u.T * self.ut)[0] - self.G])

    def equations(self):
        G, u, ut, w, P = self.G, self.u, self.ut, self.w, self.P
        g_u = sp.Matrix([G]).jacobian(ut).T
        P_t = -sp.Matrix([G]).jacobian(w).T
        right = sp.Matrix([G]).jacobian(u).T - g_u.jacobian(u) * ut - g_u.jacobian(w) * self.B - g_u.jacobian(P) * P_t
        inner = self.system.function([*u, *ut, *w, *P], [g_u.jacobian(ut), right, self.B, P_t])
        m = self.m

        def rhs(t, z):
            flat = inner(*z)
            acceleration = solve([flat[i * m : (i + 1) * m] for i in range(m)], flat[m * m : m * m + m])
            return z[m : 2 * m] + acceleration + flat[m * m + m :]

        return rhs


# --------------------------------------------------------------------------------------------------------------------------- the three scenes

x, y, phi, r, gamma, chi, theta, phi1, phi2, u, W, s = sp.symbols("x y phi r gamma chi theta phi1 phi2 u W s")
x_t, y_t, phi_t, r_t, gamma_t, chi_t, theta_t, phi1_t, phi2_t, u_t, W_t = sp.symbols(
    "x_t y_t phi_t r_t gamma_t chi_t theta_t phi1_t phi2_t u_t W_t"
)
sin, cos, half = sp.sin, sp.cos, sp.Rational(1, 2)


def sledge():
    g, alpha, k = sp.symbols("g alpha k")
    lagrangian = half * (x_t**2 + y_t**2) + half * k**2 * phi_t**2 + g * x * sin(alpha)
    constants = dict(g="9.81", alpha="0.4", k="0.7")
    heading = number("0.3")
    system = System("sledge", "x y phi", lagrangian, [y_t * cos(phi) - x_t * sin(phi)], constants, [0, 0, heading],
                    {"x": mpfr("0.5") * gmpy2.cos(heading), "phi": "1.1"})  # fmt: skip
    removal = Removal(system, "u phi", {"x": u_t * cos(phi), "y": u_t * sin(phi)})
    removal.start = lambda P: [mpfr(0), heading, mpfr("0.5"), number("1.1"), mpfr(0), mpfr(0), *P]
    system.gravity_along = number("9.81") * gmpy2.sin(number("0.4"))
    return system, removal


def ball_in_cone():
    m, a, alpha, g, k2 = sp.symbols("m a alpha g k2")
    spin = phi_t**2 + (chi_t + gamma_t) ** 2 + theta_t**2 + 2 * phi_t * (chi_t + gamma_t) * cos(theta)
    slide = r_t**2 + (r * sin(alpha) - a * cos(alpha)) ** 2 * gamma_t**2
    lagrangian = half * m * slide + half * m * k2 * spin - m * g * r * cos(alpha)
    # rolling: derived from v_centre = a omega x n with omega in the frame (radial, azimuthal, vertical)
    omega_radial = theta_t * cos(chi) + phi_t * sin(theta) * sin(chi)
    omega_azimuthal = theta_t * sin(chi) - phi_t * sin(theta) * cos(chi)
    omega_vertical = chi_t + gamma_t + phi_t * cos(theta)
    omega_generator = sin(alpha) * omega_radial + cos(alpha) * omega_vertical
    first = sp.expand((r * sin(alpha) - a * cos(alpha)) * gamma_t + a * omega_generator)
    second = r_t - a * omega_azimuthal
    constants = dict(m="1", a="0.1", alpha="0.6", g="9.81", k2=mpfr("0.4") * mpfr("0.1") ** 2)
    system = System("ball-in-cone", "r gamma phi chi theta", lagrangian, [first, second], constants,
                    ["1", 0, 0, "0.4", "1.2"], {"r": "0.3", "gamma": "2", "theta": "0.5"})  # fmt: skip
    gamma_rate = sp.solve(first, gamma_t)[0]
    removal = Removal(system, "phi chi theta", {"r": a * omega_azimuthal, "gamma": gamma_rate})
    q, v = system.q0, system.v0
    removal.start = lambda P: [q[2], q[3], q[4], v[2], v[3], v[4], q[0], q[1], *P]
    return system, removal


def three_cylinders():
    R, rr, a, alpha, A, C, J1, J2 = sp.symbols("R rho a alpha A C J1 J2")
    lagrangian = half * (x_t**2 + y_t**2 + A * theta_t**2 + C * phi_t**2 + J1 * phi1_t**2 + J2 * phi2_t**2)
    # contact points of the upper cylinder lie at arms s1, s2 along its axis; each moves with the top of a lower cylinder
    arm1 = (rr * phi1 - y) / sin(theta)
    arm2 = (rr * phi2 + x * sin(alpha) - y * cos(alpha)) / sin(theta - alpha)
    swing = R * phi_t
    constraints = [
        x_t - (swing + theta_t * arm1) * sin(theta),
        y_t + (swing + theta_t * arm1) * cos(theta) - 2 * a * phi1_t,
        x_t - (swing + theta_t * arm2) * sin(theta) + 2 * a * phi2_t * sin(alpha),
        y_t + (swing + theta_t * arm2) * cos(theta) - 2 * a * phi2_t * cos(alpha),
    ]
    # (16), (17) carry a factor sin(theta - alpha): multipliers there are these divided by it; (14), (15) none
    constraints[2] *= sin(theta - alpha)
    constraints[3] *= sin(theta - alpha)
    constants = dict(R="0.2", rho="0.15", a="0.15", alpha="0.9", A="0.05", C="0.02", J1="0.03375", J2="0.03375")
    system = System("three-cylinders", "x y theta phi phi1 phi2", lagrangian, constraints, constants, ["0.2", "0.1", "1.6", 0, 0, 0])
    offset = rr * (phi2 * sin(theta) - phi1 * sin(theta - alpha)) / sin(alpha)
    across = 2 * a * W * sin(theta) * sin(theta - alpha) - offset  # x sin theta - y cos theta
    direct = {"x": s * cos(theta) + across * sin(theta), "y": s * sin(theta) - across * cos(theta)}
    memory = {"phi1": theta_t * W * sin(theta - alpha), "phi2": theta_t * W * sin(theta), "s": theta_t * offset}
    # phi from the first constraint alone; the other three must then vanish by themselves
    rates = dict(zip(sp.symbols("phi1 phi2 s"), memory.values())) | {theta: theta_t, W: W_t}
    x_rate = sum(sp.diff(direct["x"], p) * b for p, b in rates.items())
    memory["phi"] = (x_rate / sin(theta) - theta_t * (rr * phi1 - direct["y"]) / sin(theta)) / R
    removal = Removal(system, "W theta", memory, direct)
    x0, y0, heading = system.q0[:3]
    sn, cs, sna = gmpy2.sin(heading), gmpy2.cos(heading), gmpy2.sin(heading - number("0.9"))
    turn = (x0 * sn - y0 * cs) / (2 * number("0.15") * sn * sna)
    removal.start = lambda P: [turn, heading, number("0.6"), number("0.5"), mpfr(0), mpfr(0), x0 * cs + y0 * sn, mpfr(0), *P, mpfr(0)]
    values = removal.configuration(*removal.start([mpfr(0)] * 3))
    assert gap(values[:6], system.q0) < mpfr("1e-38")
    system.v0 = values[6:]
    return system, removal


# ------------------------------------------------------------------------------------------------------------------------- the reference motions

GAUSS = Gauss()


class Case:
    """One motion of one scene, and the times at which it is asked for."""

    def __init__(self, make, motion, times, constants=(), horizon=None, parts=8):
        self.make, self.motion, self.times, self.constants = make, motion, times, constants
        self.horizon, self.parts = horizon and mpfr(horizon), parts

    def prepare(self):
        system, removal = self.make()
        constants = [number(c) for c in self.constants]
        n = system.n
        if self.motion == "Chetaev":
            rhs = system.chetaev()
            return system, rhs, system.q0 + system.v0, lambda z: (z[:n], z[n:], system.reaction(z[:n], z[n:]))
        if self.motion == "Vakonomic":
            rhs = system.vakonomic()
            return system, rhs, system.q0 + system.v0 + constants, lambda z: (z[:n], z[n : 2 * n], z[2 * n :])
        rhs = removal.equations()
        if self.horizon is not None:
            constants = self.natural(system, removal, rhs)
        start = removal.start(constants)

        def read(z):
            both = removal.configuration(*z)
            return both[:n], both[n:], z[2 * removal.m + removal.k :]

        self.memory = [str(w) for w in removal.w]
        return system, rhs, start, read

    def natural(self, system, removal, rhs):
        """P(t0) for which P(horizon) = 0."""
        if system.name == "sledge":
            return [system.gravity_along * self.horizon, mpfr(0)]
        # ball in cone: gamma is in neither L nor B, so its costate is zero; one unknown, by secants from P_r = 0
        def end(p):
            return extrapolate(rhs, 0, removal.start([p, mpfr(0)]), self.horizon, "1e-26")[-2]

        p, q = mpfr(0), mpfr("0.01")
        fp, fq = end(p), end(q)
        while abs(q - p) > mpfr("1e-26"):
            p, q, fp = q, q - fq * (q - p) / (fq - fp), fq
            fq = end(q)
        return [q, mpfr(0)]

    def run(self):
        """[(t, q, v, extra, how far two methods are apart, how far rounding the data moves the state)]"""
        global ROUND
        system, rhs, z, read = self.prepare()
        results = []
        first = second = z
        before = mpfr(0)
        for t in map(mpfr, self.times):
            mesh = []
            first = extrapolate(rhs, before, first, t, mesh=mesh)
            second = GAUSS(rhs, before, second, [h / self.parts for h in mesh for _ in range(self.parts)])
            a, b = read(first), read(second)
            results.append([t, *a, max(gap(x, y) for x, y in zip(a, b) if x)])
            before = t
        ROUND = True
        _, rhs, z, read = self.prepare()
        ROUND = False
        before = mpfr(0)
        for row in results:
            z = extrapolate(rhs, before, z, row[0], "1e-20")
            moved = read(z)
            row.append(max(gap(x, y) for x, y in zip(row[1:4], moved) if x))
            before = row[0]
        return self, system.name, z, results


CASES = [
    Case(sledge, "Chetaev", (1, 5)),
    Case(sledge, "Vakonomic", (1, 5), ("0",)),
    Case(sledge, "Vakonomic", (1, 5), ("1.5",)),
    Case(sledge, "Removed", (1, 5), horizon=10),
    Case(ball_in_cone, "Chetaev", (1, "2.5")),
    Case(ball_in_cone, "Vakonomic", (1, "2.5"), ("0", "0")),
    Case(ball_in_cone, "Vakonomic", (1, "2.5"), ("0.2", "-0.1")),
    Case(ball_in_cone, "Removed", (1, "2.5"), ("0", "0")),
    Case(ball_in_cone, "Removed", (1, "2.5"), ("0.3", "-0.1")),
    Case(ball_in_cone, "Removed", ("0.25", "0.5"), horizon="0.5"),
    Case(three_cylinders, "Chetaev", ("0.5", 1)),
    Case(three_cylinders, "Vakonomic", ("0.5", 1), ("0", "0", "0", "0")),
    Case(three_cylinders, "Vakonomic", ("0.5", 1), ("0.02", "-0.01", "0.03", "0.01")),
    Case(three_cylinders, "Removed", ("0.5", 1), ("0.05", "-0.03", "0.08")),
]

COLUMNS = "scene,motion,constants,horizon,t,q,v,multipliers,agreement,rounding"
MOTIONS = {"Chetaev": "chetaev", "Vakonomic": "vakonomic", "Removed": "removed-constraint"}


def listed(values):
    return " ".join(repr(float(v)) for v in values)


def emit(case, name, results):
    constants = listed(mpfr(c) for c in case.constants) if case.motion == "Vakonomic" else ""
    if case.motion == "Removed":
        constants = " ".join(f"{w}={float(p)!r}" for w, p in zip(case.memory, case.costates))
    horizon = "" if case.horizon is None else repr(float(case.horizon))
    for t, q, v, extra, agreement, rounding in results:
        assert agreement < mpfr("1e-17"), (name, case.motion, float(t), float(agreement))
        state = [repr(float(t)), listed(q), listed(v), listed(extra), f"{float(agreement):.1e}", f"{float(rounding):.1e}"]
        print(",".join([name, MOTIONS[case.motion], constants, horizon, *state]))


def work(index):
    case = CASES[index]
    _, name, _, results = case.run()
    system, _, start, read = case.prepare()
    case.costates = read(start)[2]
    case.memory = getattr(case, "memory", [])
    for row in results:
        print(name, case.motion, case.constants, float(row[0]), f"{float(row[4]):.1e} {float(row[5]):.1e}", file=sys.stderr, flush=True)
    return case.memory, case.costates, name, results


def references():
    import multiprocessing

    with multiprocessing.Pool(2) as pool:
        done = pool.map(work, range(len(CASES)), chunksize=1)
    print(COLUMNS)
    for case, (case.memory, case.costates, name, results) in zip(CASES, done):
        emit(case, name, results)



# --------------------------------------------------------------------------------------------------------------------------------- the claims


def report(text, *values):
    print(f"{text:<100}", *(f"{float(v):.3e}" for v in values), flush=True)


def vanishes(expression, angles):
    """Exact: half-angle substitution makes a trigonometric expression rational."""
    halves = {a: sp.Symbol(f"h_{a}") for a in angles}
    e = sp.expand_trig(expression.replace(sp.tan, lambda a: sin(a) / cos(a)))
    e = e.subs({f(a): g for a, h in halves.items() for f, g in ((sin, 2 * h / (1 + h**2)), (cos, (1 - h**2) / (1 + h**2)))})
    return sp.cancel(sp.together(e)) == 0


def claim_residuals():
    for make in (sledge, ball_in_cone, three_cylinders):
        system, removal = make()
        angles = [a for a in sp.symbols("theta chi phi alpha") if any(e.has(sin(a), cos(a), sin(theta - a)) for e in removal.residual)]
        verdict = [vanishes(e, angles) for e in removal.residual]
        print(f"removal of {system.name} makes every constraint vanish identically (exact): {verdict}", flush=True)


def claim_bridge():
    """T2 on the sledge: augmented system, multipliers -P - L_v (and, to see that the sign matters, the others)."""
    system, removal = sledge()
    P = [system.gravity_along * 10, mpfr("0.3")]
    end = removal.configuration(*extrapolate(removal.equations(), 0, removal.start(P), 2))
    g, alpha, k = sp.symbols("g alpha k")
    wide = System("augmented", "x y phi u", system.L, [x_t - u_t * cos(phi), y_t - u_t * sin(phi)],
                  dict(g="9.81", alpha="0.4", k="0.7"), [0, 0, "0.3", 0], {"phi": "1.1", "u": "0.5"})  # fmt: skip
    rhs = wide.vakonomic()
    for name, a, b in (("mu = -P - L_v", -1, -1), ("mu = P - L_v", 1, -1), ("mu = P + L_v", 1, 1)):
        mu = [a * p + b * v for p, v in zip(P, wide.v0)]
        z = extrapolate(rhs, 0, wide.q0 + wide.v0 + mu, 2)
        report(f"T2 sledge, t = 2: removed against augmented vakonomic with {name}", gap(z[:3], end[:3]))


def claim_inside():
    """T2: where u are functions of the configuration, A^T mu0 = p_q - L_v is solvable and the motions are the same."""
    for make, P, t in ((ball_in_cone, ["0.3", "-0.1"], 1), (three_cylinders, ["0.05", "-0.03", "0.08"], 1)):
        system, removal = make()
        start = removal.start([mpfr(p) for p in P])
        full = start[2 * removal.m + removal.k :]
        old = [*removal.u, *removal.w]
        jacobian = removal.q_of.jacobian(old)
        flat = system.function([*removal.u, *removal.ut, *removal.w, *removal.P], [jacobian.T])(*start)
        size = len(old)
        p_q = solve([flat[i * size : (i + 1) * size] for i in range(size)], removal.momentum(*start) + [-p for p in full])
        A = system.function([*system.q, *system.v], [system.f.jacobian(system.v)])(*system.q0, *system.v0)
        rows = [A[i * system.n : (i + 1) * system.n] for i in range(system.h)]
        L_v = system.function([*system.q, *system.v], [sp.Matrix([system.L]).jacobian(system.v)])(*system.q0, *system.v0)
        target = [a - b for a, b in zip(p_q, L_v)]
        mu = solve([[dot(a, b) for b in rows] for a in rows], [dot(a, target) for a in rows])
        residual = gap(target, [dot(mu, [row[j] for row in rows]) for j in range(system.n)])
        one = removal.configuration(*extrapolate(removal.equations(), 0, start, t))
        two = extrapolate(system.vakonomic(), 0, system.q0 + system.v0 + mu, t)
        report(f"T2 {system.name}, t = {t}: residual of A^T mu0 = p - L_v; gap; mu0", residual, gap(one, two), *mu)


def claim_sledge_matching():
    """T3: t1 = -u_t/(g sin(alpha) cos(phi0)) and mu0 = g t1 sin(alpha) sin(phi0)."""
    system, removal = sledge()
    slope = system.gravity_along
    rhs, wide = removal.equations(), system.vakonomic()
    special = -mpfr("0.5") / (slope * gmpy2.cos(mpfr("0.3")))
    for t1, label in ((special, "special t1"), (mpfr(10), "t1 = 10"), (mpfr(1), "t1 = 1"), (special * mpfr("1.01"), "special t1 * 1.01")):
        mu = slope * t1 * gmpy2.sin(mpfr("0.3"))  # also what the accelerations at the start force, whatever t1
        gaps = []
        for t in ("0.01", "0.02", 3):
            one = removal.configuration(*extrapolate(rhs, 0, removal.start([slope * t1, mpfr(0)]), mpfr(t), "1e-22"))
            gaps.append(gap(one[:3], extrapolate(wide, 0, system.q0 + system.v0 + [mu], mpfr(t), "1e-22")[:3]))
        report(f"T3 sledge, {label}: gap to the vakonomic motion with mu0 = g' t1 sin(phi0) at t = 0.01, 0.02, 3", *gaps)


def claim_leading():
    """T5: (q_vak - q_chet)/t^2 -> Pi C mu0/2, and for mu0 = 0 (q_vak - q_chet)/t^3 -> -Pi C lambda0/6."""
    for make, mu in ((sledge, ["1.5"]), (ball_in_cone, ["0.2", "-0.1"]), (three_cylinders, ["0.02", "-0.01", "0.03", "0.01"])):
        system, _ = make()
        mu = [mpfr(m) for m in mu]
        A = system.f.jacobian(system.v)
        rate = sp.Matrix(*A.shape, lambda i, j: sum(sp.diff(A[i, j], a) * b for a, b in zip(system.q, system.v)))
        M = sp.Matrix([system.L]).jacobian(system.v).jacobian(system.v)
        n, h = system.n, system.h
        flat = system.function([*system.q, *system.v], [system.f.jacobian(system.q).T - rate.T, M, A])(*system.q0, *system.v0)
        C = [flat[i * h : (i + 1) * h] for i in range(n)]
        M = [flat[n * h + i * n : n * h + (i + 1) * n] for i in range(n)]
        A = [flat[n * h + n * n + i * n : n * h + n * n + (i + 1) * n] for i in range(h)]

        def projected(force):
            """Pi force: the acceleration of M a - A^T lambda = force, A a = 0."""
            rows = [M[i] + [-A[j][i] for j in range(h)] for i in range(n)] + [A[j] + [mpfr(0)] * h for j in range(h)]
            return solve(rows, force + [mpfr(0)] * h)[:n]

        chetaev, vakonomic = system.chetaev(), system.vakonomic()
        reaction = system.reaction(system.q0, system.v0)
        t = mpfr("1e-5")
        base = extrapolate(chetaev, 0, system.q0 + system.v0, t, "1e-36")[:n]
        for start, power, factor, constants in ((mu, 2, mpfr("0.5"), mu), ([mpfr(0)] * h, 3, -mpfr(1) / 6, reaction)):
            other = extrapolate(vakonomic, 0, system.q0 + system.v0 + start, t, "1e-36")[:n]
            measured = [(b - a) / t**power for a, b in zip(base, other)]
            predicted = [factor * p for p in projected([dot(row, constants) for row in C])]
            report(f"T5 {system.name}, order {power}: largest coefficient; measured - predicted at t = 1e-5", max(map(abs, predicted)), gap(measured, predicted))


def claim_energy():
    """T6: v 𝓛_v - 𝓛 along vakonomic, u_t G_{u_t} - G along removed motions."""
    for make, mu, P in ((sledge, ["1.5"], ["3", "0.2"]), (ball_in_cone, ["0.2", "-0.1"], ["0.3", "-0.1"]), (three_cylinders, ["0.02", "-0.01", "0.03", "0.01"], ["0.05", "-0.03", "0.08"])):
        system, removal = make()
        rhs = system.vakonomic()
        start = system.q0 + system.v0 + [mpfr(m) for m in mu]
        one = system.energy(*extrapolate(rhs, 0, start, 1))[0] - system.energy(*start)[0]
        start = removal.start([mpfr(p) for p in P])
        two = removal.energy(*extrapolate(removal.equations(), 0, start, 1))[0] - removal.energy(*start)[0]
        report(f"T6 {system.name}, t = 1: change of energy, vakonomic and removed", one, two)


def claims():
    claim_residuals()
    claim_bridge()
    claim_inside()
    claim_sledge_matching()
    claim_leading()
    claim_energy()


if __name__ == "__main__":
    if "--claims" in sys.argv:
        claims()
    else:
        references()
