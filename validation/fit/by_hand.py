"""Motions of three systems from equations written by hand, in SciPy: nothing is shared with what is judged.

Each system: names of what is unknown, a draw of their true values, its laws as rates of states, the columns that
are filmed with their units, and the command line of `deltaq fit`. Chetaev's law has the number eps.
"""

import numpy as np
from scipy.integrate import solve_ivp


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
    return rates, start


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
    return rates, start


def turntable(law, p):
    """A homogeneous ball, I = 2 m a²/5, whose lowest point moves with the table.

    f = (x' − a ω_y + Ω y, y' + a ω_x − Ω x); along (δx, δy) and a turn δθ seen from the room
    C λ = (−Ω λ₂, Ω λ₁; a (λ₁ ω_z, λ₂ ω_z, −λ₁ ω_x − λ₂ ω_y)).
    """
    a, inertia, table, eps = 0.1, 0.4 * 0.01, p["Omega"], p.get("eps", 0.0)
    k = a * a / inertia

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
    return rates, start


def sledge_numbers(rng):
    return {"x": 0.02 * rng.normal(), "y": 0.02 * rng.normal(), "phi": 0.3 + 0.1 * rng.normal(), "x'": 0.5 + 0.1 * rng.normal(),
            "phi'": 1.1 + 0.2 * rng.normal(), "g": 9.81 + 0.2 * rng.normal()}  # fmt: skip


def oscillator_numbers(rng):
    return {"x": 0.05 * rng.normal(), "y": -1 + 0.1 * rng.normal(), "z": 0.05 * rng.normal(), "x'": 1 + 0.2 * rng.normal(),
            "y'": 0.5 + 0.2 * rng.normal(), "k": 1.5 + 0.1 * rng.normal()}  # fmt: skip


def turntable_numbers(rng):
    return {"x": 0.65 + 0.05 * rng.normal(), "y": 0.05 * rng.normal(), "x'": 0.02 * rng.normal(), "y'": 0.12 + 0.02 * rng.normal(),
            "Omega": 0.7 + 0.05 * rng.normal(), "psi'": 0.2 + 0.2 * rng.normal()}  # fmt: skip


# scene, equations, true numbers, multipliers, columns and their places among states, seconds, sizes of ε
SYSTEMS = {
    "sledge": (sledge, sledge_numbers, 1, ["x", "y", "phi"], [0, 1, 2], 2.0, 2e-3),
    "nonholonomic-oscillator": (oscillator, oscillator_numbers, 1, ["x", "y", "z"], [0, 1, 2], 4.0, 5e-2),
    "turntable": (turntable, turntable_numbers, 2, ["x", "y"], [0, 1], 6.0, 0.3),
}


def film(system, law, sigma, rng):
    """The true numbers of a film, its times, and rows of its columns with noise; none for a motion that goes too far."""
    equations, numbers, multipliers, _, places, seconds, size = SYSTEMS[system]
    truth = numbers(rng)
    if law == "vakonomic":
        truth |= {f"mu0_{i + 1}": 0.3 * rng.normal() for i in range(multipliers)}
    if law == "eps":
        truth["eps"] = size * rng.uniform(0, 1)
    rates, start = equations(law, truth)
    times = np.arange(1, int(60 * seconds) + 1) / 60
    motion = solve_ivp(rates, (0, seconds), start, "DOP853", times, rtol=1e-11, atol=1e-12)
    assert motion.success
    seen = motion.y[places].T
    return truth, times, seen + sigma * rng.normal(size=seen.shape)
