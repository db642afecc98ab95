"""A robot description: two wheels, a castor and an arm, against the same robot as bodies by hand."""

import numpy as np
import pytest

import deltaq


def link(name, mass=0.0, moments=(0, 0, 0), origin="", radius=None):
    shape = f'<collision><geometry><cylinder radius="{radius}" length="0.04"/></geometry></collision>' if radius else ""
    tensor = " ".join(f'{word}="{x}"' for word, x in zip(("ixx", "iyy", "izz"), moments))
    inertial = f'<inertial>{origin}<mass value="{mass}"/><inertia {tensor} ixy="0" ixz="0" iyz="0"/></inertial>' if mass else ""
    return f'<link name="{name}">{shape}{inertial}</link>'


def joint(name, kind, parent, child, xyz="0 0 0", rpy="0 0 0", axis="0 0 1", more=""):
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{more}</joint>'


# wheels as most files have them: a cylinder along z, turned by 1.57 about x
PARTS = [
    link("base", 6, (0.3, 0.3, 0.4), '<origin xyz="0.1 0 0.05"/>'),
    link("right", 0.5, (0.0013, 0.0013, 0.0025), radius=0.1),
    link("left", 0.5, (0.0013, 0.0013, 0.0025), radius=0.1),
    link("fork"),
    link("castor", 0.2, (0.00013, 0.00025, 0.00013), radius=0.05),
    link("deck", 1, (0.02, 0.03, 0.04)),
    link("upper", 0.8, (0.01, 0.02, 0.02), '<origin xyz="0.15 0 0" rpy="0 0 1.5708"/>'),
    link("slide", 0.3, (0.001, 0.002, 0.003)),
    joint("r", "continuous", "base", "right", "0 -0.3 0", "-1.57 0 0", "0 0 1"),
    joint("l", "continuous", "base", "left", "0 0.3 0", "-1.57 0 0", "0 0 1"),
    joint("swivel", "continuous", "base", "fork", "0.4 0 0"),
    joint("roll", "continuous", "fork", "castor", "-0.06 0 -0.05", axis="0 1 0"),
    joint("top", "fixed", "base", "deck", "0 0 0.2"),
    joint("shoulder", "revolute", "deck", "upper", "0.1 0 0.1", axis="0 1 0", more='<dynamics damping="0.05"/>'),
    joint("reach", "prismatic", "upper", "slide", "0.3 0 0", axis="1 0 0"),
]
BY_HAND = """
title = "by hand"
gravity = [0, 0, -9.81]
[coordinates]
x = { start = 0 }
y = { start = 0 }
phi = { start = 0 }
r = { start = 0 }
l = { start = 0 }
swivel = { start = 0 }
roll = { start = 0 }
shoulder = { start = 0 }
reach = { start = 0 }
[body.base]
joint = { plane = ["x", "y", "phi"], at = [0, 0, 0.1] }
mass = 6
mass-centre = [0.1, 0, 0.05]
inertia = [0, 0, 0.4]
[body.right]
on = "base"
joint = { hinge = "y", angle = "r", at = [0, -0.3, 0] }
shape = "wheel"
size = [0.1]
mass = 0.5
inertia = [0.0013, 0.0025, 0.0013]
[body.left]
on = "base"
joint = { hinge = "y", angle = "l", at = [0, 0.3, 0] }
shape = "wheel"
size = [0.1]
mass = 0.5
inertia = [0.0013, 0.0025, 0.0013]
[body.fork]
on = "base"
joint = { hinge = "z", angle = "swivel", at = [0.4, 0, 0] }
[body.castor]
on = "fork"
joint = { hinge = "y", angle = "roll", at = [-0.06, 0, -0.05] }
shape = "wheel"
size = [0.05]
mass = 0.2
inertia = [0.00013, 0.00025, 0.00013]
[body.deck]
on = "base"
joint = { fixed = true, at = [0, 0, 0.2] }
mass = 1
inertia = [0.02, 0.03, 0.04]
[body.upper]
on = "deck"
joint = { hinge = "y", angle = "shoulder", at = [0.1, 0, 0.1] }
mass = 0.8
mass-centre = [0.15, 0, 0]
inertia = [0.02, 0.01, 0.02]
[body.slide]
on = "upper"
joint = { slider = "x", shift = "reach", at = [0.3, 0, 0] }
mass = 0.3
inertia = [0.001, 0.002, 0.003]
[contact]
right = { of = "right", law = "rolls" }
left = { of = "left", law = "rolls" }
castor = { of = "castor", law = "rolls" }
[motor]
right = { joint = "right", force = 0.2 }
left = { joint = "left", force = "0.1 - 0.01*l'" }
[damper]
upper = { joint = "upper", damping = 0.05 }
[start.velocities]
"r'" = 4
"l'" = 2
"shoulder'" = 0
"reach'" = 0
[run]
duration = 10
"""
WHEELS = ["right", "left", "castor"]
GIVEN = {"motors": {"r": 0.2, "l": "0.1 - 0.01*l'"}, "velocities": {"r'": 4.0, "l'": 2.0}}


def read(folder, parts=PARTS, wheels=WHEELS, **given):
    file = folder / "robot.urdf"
    file.write_text('<?xml version="1.0"?><robot name="robot">' + "".join(parts) + "</robot>")
    return deltaq.from_urdf(file, wheels, **(GIVEN | given))


def test_a_robot_with_wheels_castor_and_arm(tmp_path):
    found, by_hand = read(tmp_path, save=tmp_path / "robot.toml"), deltaq.parse(BY_HAND)
    assert found.coordinates == by_hand.coordinates and len(found.constraints) == len(by_hand.constraints) == 5
    np.testing.assert_allclose(found.start.v, by_hand.start.v, atol=1e-14)
    random = np.random.default_rng(1)
    for _ in range(20):
        q, v = random.uniform(-0.5, 0.5, (2, 9))
        one, two = (system.equations().acceleration(0, q, v) for system in (found, by_hand))
        np.testing.assert_allclose(one, two, rtol=1e-10, atol=1e-10)
    assert deltaq.load(tmp_path / "robot.toml").to_toml().count("[") == found.to_toml().count("[")


def test_an_arm_alone_is_fixed_in_space(tmp_path):
    arm = read(tmp_path, wheels=(), motors={}, velocities={"r'": 0.0}, start={"shoulder": 0.3})
    assert arm.coordinates[:2] == ["r", "l"] and not arm.constraints and arm.start.q[arm.coordinates.index("shoulder")] == 0.3


def test_what_is_refused(tmp_path):
    last, loop = PARTS[:-1], joint("rod", "revolute", "base", "slide")
    for parts, wheels, given, message in [
        ([*PARTS, loop], WHEELS, {}, "`rod` closes a loop at the link `slide`"),
        ([*last, joint("reach", "planar", "upper", "slide")], WHEELS, {}, "`reach` is planar; read are revolute, continuous, prismatic, fixed"),
        ([*last, joint("reach", "prismatic", "upper", "slide", more='<mimic joint="r"/>')], WHEELS, {}, "`reach` mimics another joint"),
        ([*last, joint("reach", "prismatic", "upper", "slid")], WHEELS, {}, "the child of `reach` is not a link: `slid`"),
        (PARTS, ["wheel"], {}, "there is no link `wheel` that could be a wheel"),
        (PARTS, ["deck"], {}, "the wheel `deck` does not turn about the y axis of the root"),
        (PARTS, [*WHEELS, "upper"], {}, "the wheel `upper` has no cylinder or sphere that would give its radius"),
        ([part.replace("-0.06 0 -0.05", "-0.06 0 -0.04") for part in PARTS], WHEELS, {}, "the wheel `castor` is -0.01 m below the ground"),
        (PARTS, WHEELS, {"motors": {"R": 1}}, "no joint that moves is called `R`"),
        (PARTS, WHEELS, {"start": {"z": 1}}, "`z` is not a coordinate"),
        (["<!DOCTYPE bomb>"], (), {}, "a robot description has no document type"),
        (["<link>"], (), {}, "mismatched tag"),
        ([], (), {}, "expected <robot> with <link>s"),
        ([link("a"), link("b")], (), {}, "expected one link without a parent, found a, b"),
    ]:
        with pytest.raises(deltaq.DeltaqError, match=message):
            read(tmp_path, parts, wheels, **given)
