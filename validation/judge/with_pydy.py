"""PyDy: SymPy's Kane equations of the scene's two constraints, integrated by SciPy's LSODA. Licences BSD.

No contact: the table's rate stands in the constraints. The step `--dt` is the longest that LSODA may take.
"""

import importlib.metadata

import numpy as np
import sympy as sp
from pydy.system import System
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

import attitude
import turntable

SETTINGS = {
    "engine": f"PyDy {importlib.metadata.version('pydy')} with SymPy {sp.__version__}, SciPy {importlib.metadata.version('scipy')}",
    "integrator": "odeint",
    "rtol": 1e-9,
    "atol": 1e-9,
    "generator": "lambdify",
}


def kane():
    """Kane's equations in x', y' and the angular velocity in the room, from which psi', theta', phi' follow."""
    m, a, Omega = constants = sp.symbols("m a Omega")
    x, y, psi, theta, phi = q = dynamicsymbols("x y psi theta phi")
    u = dynamicsymbols("u1:6")
    room, body, contact = ReferenceFrame("R"), ReferenceFrame("B"), Point("C")
    body.orient_body_fixed(room, (psi, theta, phi), "zxz")
    rates = [s.diff(dynamicsymbols._t) for s in q]
    turning = body.ang_vel_in(room)
    kinematic = [rates[0] - u[0], rates[1] - u[1], *(turning.dot(n) - w for n, w in zip(room, u[2:]))]
    body.set_ang_vel(room, sum((w * n for n, w in zip(room, u[2:])), 0 * room.x))
    contact.set_vel(room, u[0] * room.x + u[1] * room.y)
    rolling = [u[0] - a * u[3] + Omega * y, u[1] + a * u[2] - Omega * x]
    about = inertia(room, *[sp.Rational(2, 5) * m * a**2] * 3)
    # Cramer's rule divides by sin(theta) alone; SymPy's own choice of pivots divides by cos(psi), zero at the start
    method = KanesMethod(room, list(q), [u[0], u[1], u[4]], kd_eqs=kinematic, u_dependent=[u[3], u[2]],
                         velocity_constraints=rolling, kd_eqs_solver="CRAMER")
    method.kanes_equations([RigidBody("ball", contact, body, m, (about, contact))], [])
    return method, q, u, constants


def motion(ball, dt, steps, every):
    method, q, u, constants = kane()
    values = [*ball.centre[:2], *ball.angles, *ball.velocity[:2], *ball.spin]
    times = dt * np.arange(0, steps + 1, every)
    numbers = dict(zip(constants, [ball.m, ball.a, ball.Omega]))
    system = System(method, constants=numbers, initial_conditions=dict(zip([*q, *u], values)), times=times)
    system.generate_ode_function(generator=SETTINGS["generator"])
    found = system.integrate(rtol=SETTINGS["rtol"], atol=SETTINGS["atol"], hmax=dt)
    order = [system.states.index(s) for s in [*q, *u]]
    for t, line in zip(times, found[:, order]):
        yield t, [*line[:2], ball.a], attitude.rotation(*line[2:5]), [*line[5:7], 0.0], line[7:10]


if __name__ == "__main__":
    turntable.run(SETTINGS, motion, __doc__)
