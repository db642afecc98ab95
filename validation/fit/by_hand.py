"""Equations of motion of three systems, longhand, in SciPy: the check of those that `systems.py` derives.

Each is a function of the law, `chetaev` or `vakonomic`, and numbers by name, `eps` among them: rates of states, a
start, and the places of filmed columns among the states.
"""

import numpy as np


def sledge(law, p):
    """f = y' cos φ − x' sin φ on a slope; C = (φ' cos φ, φ' sin φ, −u), u = x' cos φ + y' sin φ."""
    slope, k2, eps = p["g"] * np.sin(0.4), 0.49, p.get("eps", 0.0)

    def rates(t, s):
        _, _, phi, vx, vy, w, mu = s
        c, n = np.cos(phi), np.sin(phi)
        u = vx * c + vy * n
        force = w * u + slope * n
        if law == "vakonomic":
            return [vx, vy, w, slope + w * c * mu - n * force, w * n * mu + c * force, -u * mu / k2, -force]
        return [vx, vy, w, slope - (n + eps * w * c) * force, (c - eps * w * n) * force, eps * u * force / k2, 0.0]

    start = [p["x"], p["y"], p["phi"], p["x'"], p["x'"] * np.tan(p["phi"]), p["phi'"], p.get("mu0_1", 0.0)]
    return rates, start, [0, 1, 2]


def oscillator(law, p):
    """f = z' − y x', unit mass, a spring k across; C = (y', −x', 0)."""
    k, eps = p["k"], p.get("eps", 0.0)

    def rates(t, s):
        _, y, _, vx, vy, vz, mu = s
        if law == "vakonomic":
            dmu = -(vx * vy + y * vy * mu) / (1 + y * y)
            return [vx, vy, vz, vy * mu + y * dmu, -k * y - vx * mu, -dmu, dmu]
        force = vx * vy / (1 + y * y + eps * y * vy)
        return [vx, vy, vz, -(y + eps * vy) * force, -k * y + eps * vx * force, force, 0.0]

    start = [p["x"], p["y"], p["z"], p["x'"], p["y'"], p["y"] * p["x'"], p.get("mu0_1", 0.0)]
    return rates, start, [0, 1, 2]


def turntable(law, p):
    """A homogeneous ball, I = 2 m a²/5, whose lowest point moves with the table.

    f = (x' − a ω_y + Ω y, y' + a ω_x − Ω x); along (δx, δy) and a turn δθ seen from the room
    C λ = (−Ω λ₂, Ω λ₁; a (λ₁ ω_z, λ₂ ω_z, −λ₁ ω_x − λ₂ ω_y)).
    """
    a, table, eps = p.get("a", 0.1), p["Omega"], p.get("eps", 0.0)
    inertia, k = 0.4 * a * a, 2.5

    def rates(t, s):
        x, y, vx, vy, wz, m1, m2 = s
        wx, wy = (table * x - vy) / a, (vx + table * y) / a
        if law == "vakonomic":
            d1 = (-table * m2 - k * m2 * wz + table * vy) / (1 + k)
            d2 = (table * m1 + k * m1 * wz - table * vx) / (1 + k)
            return [vx, vy, -table * m2 - d1, table * m1 - d2, -a * (m1 * wx + m2 * wy) / inertia, d1, d2]
        ratio = (1 - 1j * eps * wz) / (1 - 1j * eps * table)
        pull = 1j * table * (vx + 1j * vy) / (1 + k * ratio)
        force = pull / (1 - 1j * eps * table)
        turn = eps * a / inertia * (force.real * wx + force.imag * wy)
        return [vx, vy, pull.real, pull.imag, turn, 0.0, 0.0]

    start = [p["x"], p["y"], p["x'"], p["y'"], p["psi'"], p.get("mu0_1", 0.0), p.get("mu0_2", 0.0)]
    return rates, start, [0, 1]


LONGHAND = {"sledge": sledge, "nonholonomic-oscillator": oscillator, "turntable": turntable}
