"""Twelve systems, typed from their literature, with equations that SymPy derives and SciPy integrates.

Nothing is shared with what is judged. With M = L_vv, A = f_v, C = f_qᵀ − Ȧᵀ and h = L_q − L_vq v, all constraints
linear in the velocities, accelerations a and multipliers λ or rates μ' are those of

    Chetaev, ε      M a = h + Q + Aᵀλ − ε C λ ,        A a = −f_q v
    slip            M a = h + Q + Aᵀλ − ε C λ ,        λ = −N f
    vakonomic       M a = h − Aᵀμ' + C μ ,             A a = −f_q v
    removed         G = L(u', u, w) + P·B,  w' = B :   d/dt G_u' = G_u ,  P' = −G_w .

`python systems.py` holds them against equations longhand (`by_hand.py`).
"""

import functools

import numpy as np
import sympy as sp
from by_hand import LONGHAND
from scipy.integrate import solve_ivp

EULER = "I/2*(vpsi**2 + vtheta**2 + vphi**2 + 2*vpsi*vphi*cos(theta))"
OMEGA_X = "(vtheta*cos(psi) + vphi*sin(theta)*sin(psi))"
OMEGA_Y = "(vtheta*sin(psi) - vphi*sin(theta)*cos(psi))"
BLADE = "vy*cos(phi) - vx*sin(phi)"
DISC = ["vx - R*vpsi*cos(phi)", "vy - R*vpsi*sin(phi)"]
ROLLING = {"m": 1, "R": 0.5, "I": 0.125, "J": 0.0625}
FLAT = "m/2*(vx**2 + vy**2) + I/2*vpsi**2 + J/2*vphi**2"
ARC = (["u", "phi"], {"x": "vu*cos(phi)", "y": "vu*sin(phi)"}, {"u": 0}, {"u": lambda p: p["x'"] / np.cos(p["phi"])})

# coordinates, L, f, parameters, what is free with mean and deviation, columns, seconds, sizes of ε and μ₀, removal
SYSTEMS = {
    "sledge": ("x y phi", "(vx**2 + vy**2)/2 + k**2*vphi**2/2 + g*x*sin(alpha)", [BLADE], {"g": 9.81, "alpha": 0.4, "k": 0.7},
               {"x": (0, 0.02), "y": (0, 0.02), "phi": (0.3, 0.1), "x'": (0.5, 0.1), "phi'": (1.1, 0.2), "g": (9.81, 0.2)},
               "x y phi", 2, 2e-3, 0.3, ("arc-length", ARC)),
    "nonholonomic-oscillator": ("x y z", "(vx**2 + vy**2 + vz**2)/2 - k/2*y**2", ["vz - y*vx"], {"k": 1.5},
               {"x": (0, 0.05), "y": (-1, 0.1), "z": (0, 0.05), "x'": (1, 0.2), "y'": (0.5, 0.2), "k": (1.5, 0.1)},
               "x y z", 4, 5e-2, 0.3, None),
    "turntable": ("x y psi theta phi", "m/2*(vx**2 + vy**2) + " + EULER,
               [f"vx - a*{OMEGA_Y} + Omega*y", f"vy + a*{OMEGA_X} - Omega*x"],
               {"m": 1, "a": 0.1, "I": 0.004, "Omega": 0.7, "psi": np.pi / 2, "theta": np.pi / 2, "phi": 0},
               {"x": (0.65, 0.05), "y": (0, 0.05), "x'": (0, 0.02), "y'": (0.12, 0.02), "psi'": (0.2, 0.2), "Omega": (0.7, 0.05)},
               "x y", 6, 0.3, 0.3, None),
    "heisenberg": ("x y z", "(vx**2 + vy**2)/2", ["vz - (x*vy - y*vx)/2"], {},
               {"x": (0.5, 0.1), "y": (0, 0.1), "z": (0, 0.05), "x'": (0.6, 0.1), "y'": (0.8, 0.1)},
               "x y z", 4, None, 0.5, ("along-xy", (["x", "y"], {"z": "(x*vy - y*vx)/2"}, {}, {}))),
    "sleigh": ("x y phi", "m/2*((vx - a*vphi*sin(phi))**2 + (vy + a*vphi*cos(phi))**2) + I/2*vphi**2", [BLADE],
               {"m": 1, "I": 0.3, "a": 0.4},
               {"x": (0, 0.05), "y": (0, 0.05), "phi": (0.2, 0.1), "phi'": (1.5, 0.2), "x'": (-0.6, 0.1), "a": (0.4, 0.02)},
               "x y phi", 3, 2e-2, 0.3, ("arc-length", ARC)),
    "disc": ("x y psi phi", FLAT, DISC, ROLLING,
               {"x": (0, 0.05), "y": (0, 0.05), "psi": (0, 0.05), "phi": (0.4, 0.1), "psi'": (2, 0.2), "phi'": (0.7, 0.1), "R": (0.5, 0.02)},
               "x y psi phi", 4, 2e-2, 0.5, ("roll-and-turn", (["psi", "phi"], {"x": "R*vpsi*cos(phi)", "y": "R*vpsi*sin(phi)"}, {}, {}))),
    "coin-on-incline": ("x y psi phi", FLAT + " + m*g*s*x", DISC, ROLLING | {"g": 9.81, "s": 0.6},
               {"x": (0, 0.05), "y": (0, 0.05), "psi": (0, 0.05), "phi": (0.4, 0.1), "psi'": (2, 0.2), "phi'": (0.7, 0.1), "s": (0.6, 0.02)},
               "x y psi phi", 2, 5e-3, 0.3, None),
    "unicycle-in-potential": ("x y phi", "m/2*(vx**2 + vy**2) + I/2*vphi**2 - k/2*(x**2 + y**2)", [BLADE], {"m": 1, "I": 0.4, "k": 0.9},
               {"x": (0.5, 0.05), "y": (0.2, 0.05), "phi": (0.3, 0.1), "phi'": (0.6, 0.1), "x'": (0.8, 0.1), "k": (0.9, 0.05)},
               "x y phi", 4, 2e-2, 0.3, None),
    "turning-knife-edge": ("x y phi", "((vx - Omega*y)**2 + (vy + Omega*x)**2)/2 + k**2/2*(vphi + Omega)**2", [BLADE],
               {"Omega": 0.7, "k": 0.5},
               {"x": (0.4, 0.05), "y": (0, 0.05), "phi": (0.3, 0.1), "phi'": (1.1, 0.1), "x'": (0.5, 0.1), "Omega": (0.7, 0.05)},
               "x y phi", 3, 2e-2, 0.3, None),
    "martinet": ("x y z", "(vx**2 + vy**2 + vz**2)/2", ["vz - y**2*vx/2"], {},
               {"x": (0, 0.05), "y": (-1, 0.1), "z": (0, 0.05), "x'": (1, 0.1), "y'": (0.5, 0.1)}, "x y z", 4, 5e-2, 0.3, None),
    "roller-racer": ("x y theta phi", "m/2*(vx**2 + vy**2) + I1/2*vtheta**2 + I2/2*(vtheta + vphi)**2",
               ["vy*cos(theta) - vx*sin(theta)",
                "vy*cos(theta + phi) - vx*sin(theta + phi) + d1*vtheta*cos(phi) + d2*(vtheta + vphi)"],
               {"m": 1, "I1": 0.2, "I2": 0.05, "d1": 0.6, "d2": 0.2},
               {"x": (0, 0.05), "y": (0, 0.05), "theta": (0.2, 0.05), "phi": (0.7, 0.05), "theta'": (0.4, 0.03), "phi'": (-0.9, 0.05), "d1": (0.6, 0.02)},
               "x y theta phi", 2, 1e-2, 0.1, None),
    "ball-on-incline": ("x y psi theta phi", "m/2*(vx**2 + vy**2) + m*g*s*x + " + EULER, [f"vx - a*{OMEGA_Y}", f"vy + a*{OMEGA_X}"],
               {"m": 1, "a": 0.1, "I": 0.004, "g": 9.81, "s": 0.3, "psi": 0.3, "theta": 1.1, "phi": 0.2},
               {"x": (0, 0.05), "y": (0, 0.05), "x'": (0.2, 0.05), "y'": (0.1, 0.05), "psi'": (0.4, 0.2), "s": (0.3, 0.02)},
               "x y", 0.5, 3e-2, 0.1, None),
}  # fmt: skip
# balls of 2 cm, by the vakonomic law violent: on the built-in table, and as in a laboratory
TURNTABLE = SYSTEMS["turntable"]
SMALL = {"a": 0.02, "I": 0.00016}
LAB = {"x": (0.0667, 0.005), "y": (0, 0.005), "x'": (0, 0.005), "y'": (0.057, 0.005), "psi'": (0, 1), "Omega": (3, 0.1)}
VIOLENT = {
    "small-ball": (*TURNTABLE[:3], TURNTABLE[3] | SMALL, {x: y for x, y in TURNTABLE[4].items() if x != "Omega"}, "x y", 4, 0.3, 0.3, None),
    "lab-ball": (*TURNTABLE[:3], TURNTABLE[3] | SMALL, LAB, "x y", 2, 1e-3, 0.03, None),
}
SET = {"small-ball": ["a=0.02"], "lab-ball": ["a=0.02", "Omega=3", "c=0.0667", "psi'=0", "x=0.0667"]}
SYSTEMS |= VIOLENT
COORDINATES, LAGRANGIAN, CONSTRAINTS, PARAMETERS, FREE, COLUMNS, SECONDS, EPS, MULTIPLIER, REMOVAL = range(10)


@functools.cache
def derived(name):
    """Functions of (q, v, numbers): M, h, A, C, f_q v, f."""
    system = SYSTEMS[name]
    q = sp.symbols(system[COORDINATES])
    v = sp.symbols(["v" + str(x) for x in q])
    numbers = sp.symbols([x for x in system[PARAMETERS] if x not in system[COORDINATES].split()])
    local = {str(x): x for x in [*q, *v, *numbers]}
    L, f = sp.sympify(system[LAGRANGIAN], local), sp.Matrix([sp.sympify(text, local) for text in system[CONSTRAINTS]])
    along = lambda matrix: sum((matrix.diff(x) * w for x, w in zip(q, v)), matrix * 0)  # noqa: E731
    lv = sp.Matrix([L.diff(w) for w in v])
    a = f.jacobian(v)
    h = sp.Matrix([L.diff(x) for x in q]) - along(lv)
    c = f.jacobian(q).T - along(a).T
    assert not any(a.has(w) for w in v)
    return sp.lambdify([q, v, numbers], [lv.jacobian(v), h, a, c, along(f), f], "numpy", cse=True), [str(x) for x in numbers]


@functools.cache
def removed(name):
    """Functions of (u, u', w, P, numbers): G_u'u', the right side for u'', B, G_w."""
    system = SYSTEMS[name]
    parameters, rates, _, _ = system[REMOVAL][1]
    u, w = sp.symbols(parameters), sp.symbols(list(rates))
    du, p = sp.symbols([f"v{x}" for x in parameters]), sp.symbols([f"P{x}" for x in rates])
    numbers = sp.symbols(list(system[PARAMETERS]))
    local = {str(x): x for x in [*u, *w, *du, *numbers]}
    b = sp.Matrix([sp.sympify(text, local) for text in rates.values()])
    local |= {f"v{x}": rate for x, rate in zip(rates, b)}
    G = sp.sympify(system[LAGRANGIAN], local) + sum(x * y for x, y in zip(p, b))
    of = lambda names: sp.Matrix([G.diff(x) for x in names])  # noqa: E731
    momenta, dp = of(du), -of(w)
    right = of(u) - momenta.jacobian(u) * sp.Matrix(du) - momenta.jacobian(w) * b - momenta.jacobian(p) * dp
    return sp.lambdify([u, du, w, p, numbers], [momenta.jacobian(du), right, b, dp], "numpy", cse=True)


def start(name, p):
    """q and v: velocities that are not given are completed by f = 0."""
    q_names = SYSTEMS[name][COORDINATES].split()
    functions, numbers = derived(name)
    q = np.array([p[x] for x in q_names], float)
    v = np.array([p.get(x + "'", 0.0) for x in q_names])
    open_ = [i for i, x in enumerate(q_names) if x + "'" not in p]
    _, _, a, _, _, f = functions(q, v, [p[x] for x in numbers])
    v[open_] = np.linalg.solve(a[:, open_], -f.ravel())
    return q, v


def motion(name, law, p, times):
    """Coordinates at `times` by `law`, with numbers `p`; `eps`, `slip`, `drag`, `mu0_1`, `P0_x` among them."""
    system = SYSTEMS[name]
    p = {**system[PARAMETERS], **p}
    q_names = system[COORDINATES].split()
    functions, number_names = derived(name)
    numbers = [p[x] for x in number_names]
    q0, v0 = start(name, p)
    n, h, eps = len(q0), len(system[CONSTRAINTS]), p.get("eps", 0.0)
    drag = np.array([p.get("drag", 0.0) * (x in ("x", "y")) for x in q_names])

    def rates(t, s):
        q, v = s[:n], s[n : 2 * n]
        m, g, a, c, fv, f = functions(q, v, numbers)
        g, fv, f = g.ravel() - drag * v, fv.ravel(), f.ravel()
        if law == "slip":
            reaction = -f / p["slip"]
            return np.concatenate([v, np.linalg.solve(m, g + (a.T - eps * c) @ reaction)])
        if law == "vakonomic":
            found = np.linalg.solve(np.block([[m, a.T], [a, np.zeros((h, h))]]), np.concatenate([g + c @ s[2 * n :], -fv]))
            return np.concatenate([v, found])
        found = np.linalg.solve(np.block([[m, eps * c - a.T], [a, np.zeros((h, h))]]), np.concatenate([g, -fv]))
        return np.concatenate([v, found[:n]])

    def without(t, s):
        u, w, du, costates = np.split(s, [k, k + len(memory), 2 * k + len(memory)])
        m, right, b, dp = reduced(u, du, w, costates, [p[x] for x in system[PARAMETERS]])
        return np.concatenate([du, np.ravel(b), np.linalg.solve(m, np.ravel(right)), np.ravel(dp)])

    if law == "removed":
        parameters, memory, at, speeds = system[REMOVAL][1]
        k, reduced = len(parameters), removed(name)
        place = lambda x: at.get(x, p.get(x))  # noqa: E731
        speed = lambda x: speeds[x](p) if x in speeds else p[x + "'"]  # noqa: E731
        first = [*map(place, parameters), *map(place, memory), *map(speed, parameters), *(p["P0_" + x] for x in memory)]
        q_names = [*parameters, *memory]
        rates = without
    else:
        first = [*q0, *v0, *(p[f"mu0_{i + 1}"] for i in range(h) if law == "vakonomic")]
    if name in VIOLENT:  # without Euler angles, which turn fast
        rates, first, _ = LONGHAND["turntable"](law, p)
    found = solve_ivp(rates, (0, times[-1]), first, "DOP853", times, rtol=1e-11, atol=1e-12)
    if not found.success:
        raise ArithmeticError(found.message)
    return found.y[[q_names.index(x) for x in system[COLUMNS].split()]].T


def truth(name, law, rng):
    """True numbers of a film: those that are free in any case, then those of the law."""
    system = SYSTEMS[name]
    numbers = {x: mean + deviation * rng.normal() for x, (mean, deviation) in system[FREE].items()}
    if law == "vakonomic":
        numbers |= {f"mu0_{i + 1}": system[MULTIPLIER] * rng.normal() for i in range(len(system[CONSTRAINTS]))}
    if law == "removed":
        numbers |= {"P0_" + x: system[MULTIPLIER] * rng.normal() for x in system[REMOVAL][1][1]}
    if law == "eps":
        numbers["eps"] = system[EPS] * rng.uniform(0, 1)
    if law == "slip":
        numbers["slip"] = 10 ** rng.uniform(-3, -1.5)
    if law == "drag":
        numbers["drag"] = rng.uniform(0, 0.3)
    return numbers


def film(name, law, sigma, rng):
    """The true numbers of a film, its times at 60 Hz, rows of its columns with noise, and the noise."""
    numbers = truth(name, law, rng)
    times = np.arange(1, int(60 * SYSTEMS[name][SECONDS]) + 1) / 60
    seen = motion(name, law, numbers, times)
    noise = sigma * rng.normal(size=seen.shape)
    return numbers, times, seen + noise, noise


if __name__ == "__main__":
    for name, longhand in LONGHAND.items():
        for law in ("chetaev", "eps", "vakonomic"):
            numbers = truth(name, law, np.random.default_rng(1))
            times = np.linspace(0, SYSTEMS[name][SECONDS], 50)
            rates, first, places = longhand(law, numbers)
            by_hand = solve_ivp(rates, (0, times[-1]), first, "DOP853", times, rtol=1e-11, atol=1e-12).y[places].T
            gap = np.abs(motion(name, law, numbers, times) - by_hand).max()
            print(f"{name:24} {law:10} largest difference {gap:.1e}")
            assert gap < 1e-8
