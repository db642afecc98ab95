"""End points of four problems of the Test Set for IVP Solvers in extended precision: `python referee.py > ends.toml`.

The equations are those that the test set prints (mass matrix, forces, constraints), not a Lagrangian: nothing is shared
with deltaq. Accelerations and multipliers solve the constraints differentiated twice; the drift from the constraints
is printed. Steps are those of Gragg, Bulirsch and Stoer with six columns, order 12, in long double, whose round-off is
1e-19 on x86-64. Every problem is solved twice, the second time with half the step; digits printed are those that agree.
"""

import sys
import tomllib
from pathlib import Path

import numpy as np

F = np.longdouble
PI = F(4) * np.arctan(F(1))
COLUMNS = [2 * n for n in range(1, 7)]


def number(text):
    """A decimal, exactly rounded."""
    return F(text)


def step(rates, t, y, h):
    """One step by extrapolation of the modified midpoint rule."""
    table = []
    for n in COLUMNS:
        d = h / n
        before, now = y, y + d * rates(t, y)
        for k in range(1, n):
            before, now = now, before + 2 * d * rates(t + k * d, now)
        column = [(before + now + d * rates(t + h, now)) / 2]
        for k, above in enumerate(table):
            ratio = (F(n) / COLUMNS[len(table) - 1 - k]) ** 2
            column.append(column[k] + (column[k] - above) / (ratio - 1))
        table = column
    return table[-1]


def solve(matrix, right):
    """Gaussian elimination with row pivots: LAPACK has no long double."""
    a = np.concatenate([matrix, right[:, None]], axis=1)
    n = len(right)
    for i in range(n):
        p = i + int(np.argmax(np.abs(a[i:, i])))
        a[[i, p]] = a[[p, i]]
        a[i + 1 :] -= np.outer(a[i + 1 :, i] / a[i, i], a[i])
    x = np.zeros(n, dtype=F)
    for i in reversed(range(n)):
        x[i] = (a[i, n] - a[i, i + 1 : n] @ x[i + 1 :]) / a[i, i]
    return x


def constrained(mass, force, jacobian, bias):
    """Accelerations and multipliers of M a = f - Gᵀ λ, G a + γ = 0."""
    n, h = len(force), len(bias)
    a = np.zeros((n + h, n + h), dtype=F)
    a[:n, :n], a[:n, n:], a[n:, :n] = mass, jacobian.T, jacobian
    x = solve(a, np.concatenate([force, -bias]))
    return x[:n], x[n:]


class CarAxis:
    """II.19: a car axis on a bumpy road."""

    names = ["xl", "yl", "xr", "yr"]
    end, steps = F(3), 1500
    L, L0, eps, M, r, w, g = map(number, ["1", "0.5", "0.01", "10", "0.1", "10", "1"])
    q = np.array([0, 0.5, 1, 0.5], dtype=F)
    v = np.array([-0.5, 0, -0.5, 0], dtype=F)

    def road(self, t):
        yb, dyb = self.r * np.sin(self.w * t), self.r * self.w * np.cos(self.w * t)
        ddyb = -self.w**2 * yb
        xb = np.sqrt(self.L**2 - yb**2)
        dxb = -yb * dyb / xb
        return xb, yb, dxb, dyb, -(dyb**2 + yb * ddyb + dxb**2) / xb, ddyb

    def residual(self, t, q):
        xb, yb, *_ = self.road(t)
        return np.array([q[0] * xb + q[1] * yb, (q[0] - q[2]) ** 2 + (q[1] - q[3]) ** 2 - self.L**2])

    def accelerations(self, t, q, v):
        xb, yb, dxb, dyb, ddxb, ddyb = self.road(t)
        xl, yl, xr, yr = q
        K = self.eps**2 * self.M / 2
        left, right = np.sqrt(xl**2 + yl**2), np.sqrt((xr - xb) ** 2 + (yr - yb) ** 2)
        pull, push = (self.L0 - left) / left, (self.L0 - right) / right
        force = np.array([pull * xl, pull * yl - K * self.g, push * (xr - xb), push * (yr - yb) - K * self.g])
        dx, dy = 2 * (xl - xr), 2 * (yl - yr)
        G = np.array([[xb, yb, F(0), F(0)], [dx, dy, -dx, -dy]])
        bias = np.array([2 * (v[0] * dxb + v[1] * dyb) + xl * ddxb + yl * ddyb, 2 * ((v[0] - v[2]) ** 2 + (v[1] - v[3]) ** 2)])
        a, multipliers = constrained(K * np.eye(4, dtype=F), force, G, bias)
        return a, -multipliers


class Andrews:
    """II.20: Andrews' squeezing mechanism."""

    names = ["beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"]
    end, steps = F(3) / 100, 1000
    v = np.zeros(7, dtype=F)

    def __init__(self):
        scene = tomllib.loads((Path(__file__).parent / "andrews.toml").read_text(), parse_float=str)
        for name, value in scene["parameters"].items():
            setattr(self, name, number(str(value)))
        self.q = np.array([number(str(entry["start"])) for entry in scene["coordinates"].values()])
        s = self
        # rows of g: a constant, then c·cos or c·sin of a sum of angles
        crank_x = [(s.rr, np.cos, [0]), (-s.d, np.cos, [0, 1])]
        crank_y = [(s.rr, np.sin, [0]), (-s.d, np.sin, [0, 1])]
        self.g = [
            (-s.xb, crank_x + [(-s.ss, np.sin, [2])]),
            (-s.yb, crank_y + [(s.ss, np.cos, [2])]),
            (-s.xa, crank_x + [(-s.e, np.sin, [3, 4]), (-s.zt, np.cos, [4])]),
            (-s.ya, crank_y + [(s.e, np.cos, [3, 4]), (-s.zt, np.sin, [4])]),
            (-s.xa, crank_x + [(-s.zf, np.cos, [5, 6]), (-s.u, np.sin, [6])]),
            (-s.ya, crank_y + [(-s.zf, np.sin, [5, 6]), (s.u, np.cos, [6])]),
        ]

    def residual(self, t, q):
        return np.array([c + sum(a * f(q[i].sum()) for a, f, i in terms) for c, terms in self.g])

    def accelerations(self, t, q, v):
        s = self
        th, phi, om = q[1], q[3], q[5]
        G, bias = np.zeros((6, 7), dtype=F), np.zeros(6, dtype=F)
        for row, (_, terms) in enumerate(self.g):
            for a, f, i in terms:
                angle, rate = q[i].sum(), v[i].sum()
                G[row, i] += a * (-np.sin(angle) if f is np.cos else np.cos(angle))
                bias[row] -= a * f(angle) * rate**2
        ee, zz = s.e - s.ea, s.zf - s.fa
        M = np.zeros((7, 7), dtype=F)
        M[0, 0] = s.m1 * s.ra**2 + s.m2 * (s.rr**2 - 2 * s.da * s.rr * np.cos(th) + s.da**2) + s.i1 + s.i2
        M[0, 1] = M[1, 0] = s.m2 * (s.da**2 - s.da * s.rr * np.cos(th)) + s.i2
        M[1, 1] = s.m2 * s.da**2 + s.i2
        M[2, 2] = s.m3 * (s.sa**2 + s.sb**2) + s.i3
        M[3, 3] = s.m4 * ee**2 + s.i4
        M[3, 4] = M[4, 3] = s.m4 * (ee**2 + s.zt * ee * np.sin(phi)) + s.i4
        M[4, 4] = s.m4 * (s.zt**2 + 2 * s.zt * ee * np.sin(phi) + ee**2) + s.m5 * (s.ta**2 + s.tb**2) + s.i4 + s.i5
        M[5, 5] = s.m6 * zz**2 + s.i6
        M[5, 6] = M[6, 5] = s.m6 * (zz**2 - s.u * zz * np.sin(om)) + s.i6
        M[6, 6] = s.m6 * (zz**2 - 2 * s.u * zz * np.sin(om) + s.u**2) + s.m7 * (s.ua**2 + s.ub**2) + s.i6 + s.i7
        cg, sg = np.cos(q[2]), np.sin(q[2])
        xd, yd = s.sd * cg + s.sc * sg + s.xb, s.sd * sg - s.sc * cg + s.yb
        length = np.sqrt((xd - s.xc) ** 2 + (yd - s.yc) ** 2)
        pull = -s.c0 * (length - s.l0) / length
        fx, fy = pull * (xd - s.xc), pull * (yd - s.yc)
        force = np.array([
            s.mom - s.m2 * s.da * s.rr * v[1] * (v[1] + 2 * v[0]) * np.sin(th),
            s.m2 * s.da * s.rr * v[0] ** 2 * np.sin(th),
            fx * (s.sc * cg - s.sd * sg) + fy * (s.sd * cg + s.sc * sg),
            s.m4 * s.zt * ee * v[4] ** 2 * np.cos(phi),
            -s.m4 * s.zt * ee * v[3] * (v[3] + 2 * v[4]) * np.cos(phi),
            -s.m6 * s.u * zz * v[6] ** 2 * np.cos(om),
            s.m6 * s.u * zz * v[5] * (v[5] + 2 * v[6]) * np.cos(om),
        ])  # fmt: skip
        return constrained(M, force, G, bias)


class Fekete:
    """II.17: twenty particles on the unit sphere."""

    names = [f"{c}{i}" for i in range(1, 21) for c in "xyz"]
    end, steps = F(1000), 8000
    grid = staticmethod(lambda s: s**2)  # it rests in the end
    v = np.zeros(60, dtype=F)

    def __init__(self):
        rings = [(3, 0, PI / 13, 3 * PI / 8), (7, 0, PI / 29, PI / 8), (6, 0, PI / 7, -2 * PI / 15), (4, -1, PI / 17, -3 * PI / 10)]
        points = []
        for n, first, turn, height in rings:
            for i in range(1 + first, n + 1 + first):
                a = 2 * PI * i / n + turn
                points += [np.cos(a) * np.cos(height), np.sin(a) * np.cos(height), np.sin(height)]
        self.q = np.array(points, dtype=F)

    def residual(self, t, q):
        return (q.reshape(20, 3) ** 2).sum(axis=1) - 1

    def accelerations(self, t, q, v):
        p, u = q.reshape(20, 3), v.reshape(20, 3)
        between = p[:, None] - p
        squares = (between**2).sum(axis=2) + np.eye(20, dtype=F)
        a = (between / squares[..., None]).sum(axis=1) - u / 2
        multipliers = -((p * a).sum(axis=1) + (u**2).sum(axis=1)) / (2 * (p**2).sum(axis=1))
        return (a + 2 * multipliers[:, None] * p).ravel(), multipliers


class Pleiades:
    """II.5: seven stars in a plane, no constraint."""

    names = [f"{c}{i}" for c in "xy" for i in range(1, 8)]
    end, steps = F(3), 12000
    q = np.array([3, 3, -1, -3, 2, -2, 2, 3, -3, 2, 0, 0, -4, 4], dtype=F)
    v = np.array([0, 0, 0, 0, 0, 1.75, -1.5, 0, 0, 0, -1.25, 1, 0, 0], dtype=F)

    def residual(self, t, q):
        return np.zeros(1, dtype=F)

    def accelerations(self, t, q, v):
        p = q.reshape(2, 7)
        between = p[:, None, :] - p[:, :, None]
        cubes = ((between**2).sum(axis=0) + np.eye(7, dtype=F)) ** (F(3) / 2)
        return ((between / cubes) * np.arange(1, 8, dtype=F)).sum(axis=2).ravel(), np.zeros(0, dtype=F)


def motion(problem, steps):
    """State and multipliers at the end, in so many steps; and the largest residual of a constraint there."""
    n = len(problem.q)
    y = np.concatenate([problem.q, problem.v])
    grid = getattr(problem, "grid", lambda s: s)
    times = [problem.end * grid(F(k) / steps) for k in range(steps + 1)]

    def rates(t, y):
        return np.concatenate([y[n:], problem.accelerations(t, y[:n], y[n:])[0]])

    for now, then in zip(times, times[1:]):
        y = step(rates, now, y, then - now)
    multipliers = problem.accelerations(problem.end, y[:n], y[n:])[1]
    return np.concatenate([y[:n], multipliers]), float(np.abs(problem.residual(problem.end, y[:n])).max())


def main(names):
    assert np.finfo(F).eps < 1e-18, "long double is no longer than double here"
    print("# Written by referee.py: ends in long double, and how far a run with twice the step is from them.")
    for problem in (CarAxis(), Andrews(), Fekete(), Pleiades()):
        name = type(problem).__doc__.split(":")[0]
        if names and type(problem).__name__ not in names:
            continue
        (coarse, _), (fine, drift) = motion(problem, problem.steps), motion(problem, 2 * problem.steps)
        gap = float(np.abs(fine - coarse).max())
        print(f"\n[{type(problem).__name__.lower()}]  # {name}; residual of the constraints at the end {drift:.1e}")
        print(f"gap = {gap:.1e}\nend = [")
        for value in fine:
            print(f"  {np.format_float_scientific(value, precision=18, unique=False)},")
        print("]", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
