"""Equations of motion in Python: methods of SymPy, expressions, functions, texts."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Lagrangian,
    Particle,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

import deltaq

SLEIGH = deltaq.built_in("sleigh")
m, a, inertia_about_g, g, r = sp.symbols("m a I g r")
t = dynamicsymbols._t


def sleigh():
    """Coordinates, Lagrangian and constraint of Chaplygin's sleigh, by hand."""
    x, y, phi = dynamicsymbols("x y phi")
    forward, sideways = x.diff(t) - a * phi.diff(t) * sp.sin(phi), y.diff(t) + a * phi.diff(t) * sp.cos(phi)
    kinetic = m * (forward**2 + sideways**2) / 2 + inertia_about_g * phi.diff(t) ** 2 / 2
    return (x, y, phi), kinetic, y.diff(t) * sp.cos(phi) - x.diff(t) * sp.sin(phi)


def test_lagranges_method_is_right_and_wrong():
    q, kinetic, blade = sleigh()
    right = LagrangesMethod(kinetic, q, nonhol_coneqs=[blade])
    found = deltaq.review(SLEIGH, right)
    assert (found["verdict"], found["numbers"], found["unknowns"]) == ("right", "field", ["lam1"])
    wrong = LagrangesMethod(kinetic + m * a**2 * q[2].diff(t) ** 2 / 2, q, nonhol_coneqs=[blade])
    found = deltaq.review(SLEIGH, wrong)
    assert found["verdict"] == "wrong"
    assert ["`m*a^2*phi'^2/2` is counted twice in L"] in found["explanations"]


def test_expressions_and_equalities():
    q, kinetic, blade = sleigh()
    force = sp.Symbol("N")
    rows = [kinetic.diff(c.diff(t)).diff(t) - kinetic.diff(c) - force * blade.diff(c.diff(t)) for c in q]
    assert deltaq.review(SLEIGH, [*rows, blade])["verdict"] == "right"
    assert deltaq.review(SLEIGH, [sp.Eq(row, 0) for row in rows] + [blade])["verdict"] == "right"
    with pytest.raises(TypeError, match="where an equation is expected"):
        deltaq.review(SLEIGH, [rows[0], object()])


def test_the_rolling_disc_by_lagrange_and_kane():
    """Lagrange with the velocity of the centre taken from rolling, V upwards, is wrong; Kane is right."""
    disc = deltaq.built_in("falling-disc")
    q1, q2, q3, u1, u2, u3 = dynamicsymbols("q1 q2 q3 u1 u2 u3")
    space = ReferenceFrame("N")
    yaw = space.orientnew("Y", "Axis", [q1, space.z])
    lean = yaw.orientnew("L", "Axis", [q2, yaw.x])
    where = {"phi": "q1", "theta": "-q2", "psi": "q3", "R": "r", "I": "m*r^2/2", "J": "m*r^2/4"}

    def body(frame):
        contact = Point("C")
        contact.set_vel(space, 0)
        centre = contact.locatenew("G", r * lean.z)
        centre.v2pt_theory(contact, space, frame)
        of = inertia(lean, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2)
        return centre, RigidBody("B", centre, frame, m, (of, centre))

    frame = lean.orientnew("R", "Axis", [q3, lean.y])
    _, rolling = body(frame)
    rolling.potential_energy = -m * g * r * sp.cos(q2)
    found = deltaq.review(disc, LagrangesMethod(Lagrangian(space, rolling), [q1, q2, q3]), where=where)
    assert found["explanations"][0] == ["constraint put into L", "gravity upwards (T + V instead of T − V)"]

    frame = lean.orientnew("R", "Axis", [q3, lean.y])
    rates = [q1.diff(t) - u3 / sp.cos(q2), q2.diff(t) - u1, q3.diff(t) - u2 + u3 * sp.tan(q2)]
    frame.set_ang_vel(space, u1 * lean.x + u2 * lean.y + u3 * lean.z)
    lean.set_ang_vel(space, u1 * lean.x + u3 * sp.tan(q2) * lean.y + u3 * lean.z)
    centre, rolling = body(frame)
    method = KanesMethod(space, q_ind=[q1, q2, q3], u_ind=[u1, u2, u3], kd_eqs=rates)
    method.kanes_equations([rolling], [(centre, -m * g * space.z)])
    found = deltaq.review(disc, method, where=where)
    assert (found["verdict"], found["numbers"]) == ("right", "field"), found


def test_functions_are_asked_at_states_on_the_constraints():
    numbers = {name: SLEIGH.parameters[name] for name in ("m", "a", "I")}

    def rates(_, y, sign=1):
        phi, vx, vy, w = y[2:]
        u = vx * np.cos(phi) + vy * np.sin(phi)
        du = sign * numbers["a"] * w**2
        dw = -numbers["m"] * numbers["a"] * u * w / (numbers["I"] + numbers["m"] * numbers["a"] ** 2)
        return [vx, vy, w, du * np.cos(phi) - u * w * np.sin(phi), du * np.sin(phi) + u * w * np.cos(phi), dw]

    assert deltaq.review(SLEIGH, rates)["verdict"] == "right"
    assert deltaq.review(SLEIGH, lambda t, y: rates(t, y)[3:])["verdict"] == "right"
    found = deltaq.review(SLEIGH, lambda t, y: rates(t, y, -1))
    assert (found["verdict"], found["numbers"]) == ("wrong", "floats")
    with pytest.raises(ValueError, match="gives 2 numbers, and 3 or 6 are needed"):
        deltaq.review(SLEIGH, lambda t, y: [0, 0])


def test_texts_and_files(tmp_path):
    theirs = tmp_path / "theirs.tex"
    theirs.write_text("\\ddot{x} = 0 \\\\ \\ddot{y} = 0 \\\\ \\ddot{\\varphi} = 0\n")
    assert deltaq.review(SLEIGH, theirs)["verdict"] == "wrong"
    with pytest.raises(deltaq.DeltaqError, match=r"theirs:1:7: expected a number"):
        deltaq.review(SLEIGH, "x'' = * 2")


def test_a_particle_of_kane_is_right():
    free = deltaq.System(["z"], "m*z'^2/2 - m*g*z", parameters={"m": 2, "g": 9.81}, start={"z": 1}, velocities={"z'": 0})
    z, v = dynamicsymbols("z v")
    space, place = ReferenceFrame("N"), Point("P")
    place.set_vel(space, v * space.z)
    method = KanesMethod(space, q_ind=[z], u_ind=[v], kd_eqs=[z.diff(t) - v])
    method.kanes_equations([Particle("p", place, m)], [(place, -m * g * space.z)])
    assert deltaq.review(free, method)["verdict"] == "right"
