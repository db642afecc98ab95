"""The sledge and the ball in the cone, by hand: what a user writes who knows the system, where `trailers.py` has the car.

Each has a function from the states of the scene, by tag, to the states left and to the constants of the motion, and one to the rates of those states.
A state that the scene does not have is tagged "by hand"; its rate at the start is held against the derivative of the first function along our rates.
"""

import numpy as np


def sledge_chetaev_start(p, s):
    """u is the speed along the blade; phi' never changes."""
    c, sn = np.cos(s["q", "phi"]), np.sin(s["q", "phi"])
    return kept(s, "x", "y", "phi") | {("by hand", "u"): s["v", "x"] * c + s["v", "y"] * sn}, {"omega": s["v", "phi"]}


def sledge_chetaev(f, p, k, y, t):
    phi, u = y["q", "phi"], y["by hand", "u"]
    c = f.cos(phi)
    return [u * c, u * f.sin(phi), k["omega"], p["g"] * np.sin(p["alpha"]) * c]


def sledge_vakonomic_start(p, s):
    """p = L_v + mu f_v with p_x' = g sin(alpha), p_y' = 0: of L alone is p_phi = k^2 phi', and p_phi' = -mu u. From the others
    u = p_x cos(phi) + p_y sin(phi) and mu = p_y cos(phi) - p_x sin(phi).
    """
    c, sn, mu = np.cos(s["q", "phi"]), np.sin(s["q", "phi"]), s["mu", "1"]
    return kept(s, "x", "y", "phi", "phi'"), {"p_x": s["v", "x"] - mu * sn, "p_y": s["v", "y"] + mu * c}


def sledge_vakonomic(f, p, k, y, t):
    """Products of sines are sines of 2 phi: fewer products of series."""
    c, s = f.cos(2.0 * y["q", "phi"]), f.sin(2.0 * y["q", "phi"])
    p_x, p_y = k["p_x"] + p["g"] * np.sin(p["alpha"]) * t, k["p_y"]
    torque = (p_x * p_x - p_y * p_y) * s * 0.5 - p_x * p_y * c
    return [(p_x + p_x * c + p_y * s) * 0.5, (p_y + p_x * s - p_y * c) * 0.5, y["v", "phi"], torque * (1 / p["k"] ** 2)]


def sledge_removed_start(p, s):
    """G = (u'^2 + k^2 phi'^2)/2 + g x sin(alpha) + u' P_x cos(phi), P_x' = -g sin(alpha): u is cyclic, G_u' constant."""
    states = {tag: s[tag] for tag in (("w", "x"), ("w", "y"), ("u", "phi"), ("du", "phi"))}
    return states, {"P_x": s["P", "x"], "p_u": s["du", "u"] + s["P", "x"] * np.cos(s["u", "phi"])}


def sledge_removed(f, p, k, y, t):
    phi, omega = y["u", "phi"], y["du", "phi"]
    c, s = f.cos(phi), f.sin(phi)
    p_x = k["P_x"] - p["g"] * np.sin(p["alpha"]) * t
    speed = k["p_u"] - p_x * c
    across = speed * s
    return [speed * c, across, omega, p_x * across * (-1 / p["k"] ** 2)]


# Ball in the cone: turn rates of the ball along the generator, across and along the outward normal, g = (sin alpha, 0, cos alpha),
# n = (cos alpha, 0, -sin alpha) in the meridian plane, g x e = -n. The constraints are rho gamma' = -a w_g and r' = a w_e.


def turn_rates(p, s):
    """w_g, w_e, w_n from Euler's angles."""
    sn, c = np.sin(p["alpha"]), np.cos(p["alpha"])
    spin, nod = s["v", "phi"], s["v", "theta"]
    sin_theta, sin_chi, cos_chi = np.sin(s["q", "theta"]), np.sin(s["q", "chi"]), np.cos(s["q", "chi"])
    out = nod * cos_chi + spin * sin_theta * sin_chi
    up = s["v", "chi"] + s["v", "gamma"] + spin * np.cos(s["q", "theta"])
    return sn * out + c * up, nod * sin_chi - spin * sin_theta * cos_chi, c * out - sn * up


def euler_rates(f, p, y, gamma_rate, w_g, w_e, w_n):
    """phi', chi', theta'."""
    sn, c = np.sin(p["alpha"]), np.cos(p["alpha"])
    out, up = sn * w_g + c * w_n, c * w_g - sn * w_n
    sin_chi, cos_chi = f.sin(y["q", "chi"]), f.cos(y["q", "chi"])
    spin = (out * sin_chi - w_e * cos_chi) / f.sin(y["q", "theta"])
    return [spin, up - gamma_rate - spin * f.cos(y["q", "theta"]), out * cos_chi + w_e * sin_chi]


def rho(p, r):
    return r * np.sin(p["alpha"]) - p["a"] * np.cos(p["alpha"])


def cone_chetaev_start(p, s):
    """Newton's and Euler's equations without the force of contact: h = rho^2 gamma' never changes, w_n' = gamma' r' cos(alpha)/a."""
    states = kept(s, "r", "gamma", "phi", "chi", "theta", "r'") | {("by hand", "w_n"): turn_rates(p, s)[2]}
    return states, {"h": rho(p, s["q", "r"]) ** 2 * s["v", "gamma"]}


def cone_chetaev(f, p, k, y, t):
    a, sn, c = p["a"], np.sin(p["alpha"]), np.cos(p["alpha"])
    v, w_n, distance = y["v", "r"], y["by hand", "w_n"], rho(p, y["q", "r"])
    gamma_rate = k["h"] / (distance * distance)
    across = k["h"] / distance
    v_rate = sn * gamma_rate * across - (5 / 7 * p["g"] * c) - (2 / 7 * a * c) * gamma_rate * w_n
    angles = euler_rates(f, p, y, gamma_rate, across * (-1 / a), v * (1 / a), w_n)
    return [v, gamma_rate, *angles, v_rate, (c / a) * gamma_rate * v]


def cone_vakonomic_start(p, s):
    """With F = L + mu f: pi = dF/dw for the turn rates w, of which no attitude is in F, so that pi' = (w - frame's) x pi in the frame;
    p_r = m r' + mu_2, p_gamma = rho (m rho gamma' + mu_1) + pi_z, which never changes.
    """
    m, a, distance = p["m"], p["a"], rho(p, s["q", "r"])
    inertia = m * 2 * a * a / 5
    w_g, w_e, w_n = turn_rates(p, s)
    g, e, n = inertia * w_g + a * s["mu", "1"], inertia * w_e - a * s["mu", "2"], inertia * w_n
    up = np.cos(p["alpha"]) * g - np.sin(p["alpha"]) * n
    more = {"p_r": m * s["v", "r"] + s["mu", "2"], "pi_g": g, "pi_e": e, "pi_n": n}
    states = kept(s, "r", "gamma", "phi", "chi", "theta") | {("by hand", name): value for name, value in more.items()}
    return states, {"p_gamma": distance * (m * distance * s["v", "gamma"] + s["mu", "1"]) + up}


def cone_vakonomic(f, p, k, y, t):
    m, a, sn, c = p["m"], p["a"], np.sin(p["alpha"]), np.cos(p["alpha"])
    p_r, g, e, n = (y["by hand", name] for name in ("p_r", "pi_g", "pi_e", "pi_n"))
    inertia = m * 2 * a * a / 5
    distance = rho(p, y["q", "r"])
    # m rho gamma' + mu_1
    side = (k["p_gamma"] - (c * g - sn * n)) / distance
    total = inertia + m * a * a
    w_g, w_e, w_n = (g - a * side) * (1 / total), (e + a * p_r) * (1 / total), n * (1 / inertia)
    gamma_rate = w_g * -a / distance
    # the ball's turn rates less those of the frame
    x_g, x_n = w_g - c * gamma_rate, w_n + sn * gamma_rate
    turned = [x_n * e - w_e * n, x_g * n - x_n * g, w_e * g - x_g * e]
    angles = euler_rates(f, p, y, gamma_rate, w_g, w_e, w_n)
    return [a * w_e, gamma_rate, *angles, sn * side * gamma_rate - m * p["g"] * c, *turned]


def kept(s, *names):
    """Coordinates, and velocities with a prime, that stay."""
    tags = [("v", name[:-1]) if name.endswith("'") else ("q", name) for name in names]
    return {tag: s[tag] for tag in tags}


SYSTEMS = {
    "sledge-chetaev": (sledge_chetaev_start, sledge_chetaev),
    "sledge-vakonomic": (sledge_vakonomic_start, sledge_vakonomic),
    "sledge-removed": (sledge_removed_start, sledge_removed),
    "cone-chetaev": (cone_chetaev_start, cone_chetaev),
    "cone-vakonomic": (cone_vakonomic_start, cone_vakonomic),
}


def start(case, parameters, values):
    """States left and constants of the motion, by tag and by name, at a start."""
    return SYSTEMS[case.problem][0](parameters, dict(zip(case.tags, values)))


def symbolic(case, parameters, algebra, constant, time):
    """Tags, states and rates in the expressions of a tool; `constant(i, value)` is the expression of a constant of the motion."""
    states, constants = start(case, parameters, case.start)
    y = [algebra.symbol(f"y_{i}") for i in range(len(states))]
    named = {name: constant(i, value) for i, (name, value) in enumerate(constants.items())}
    return list(states), y, SYSTEMS[case.problem][1](algebra, parameters, named, dict(zip(states, y)), time)


def rates_of(case, parameters, rates):
    """What the states that the scene does not have change by, from the rates of its own: derivatives by a complex step."""
    states, _ = start(case, parameters, np.array(case.start) + 1e-30j * np.array(rates))
    return {tag: value.imag / 1e-30 for tag, value in states.items() if tag[0] == "by hand"}
