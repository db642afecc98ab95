"""Certificates that are true of another system, or on another branch of its roots, are none of the scene file.

Each forgery is a proof that is right for the plain scene in it, which has the values of the file where positions are positive, say. Of constraints on
positions there are none to forge: brackets stay on their leaves, and their multipliers are free, so that no minor has full size.
"""

import json
import random
import re
import subprocess

import pytest
import test_integrals_proof
import test_proof
from test_integrals_proof import images, integral, measure, plain  # noqa: F401
from test_proof import CATALOGUE, FORGED, PARTICLE, PROGRAM, UNREADABLE, VERIFIED, changed, changes, scene_file, signed, verdict, written

# a sleigh with its mass off the blade by l
SLEIGH = "((x' - l*sin(phi)*phi')^2 + (y' + l*cos(phi)*phi')^2)/2 + phi'^2/10 + s'^2/2"
BLADE = "y'*cos(phi) - x'*sin(phi)"
POINT = {"x": "1/7", "y": "2/5", "phi": "0", "s": "3/2"}
FREE = ["x'", "phi'", "s'"]


def sleigh_file(folder, l, s, more=""):
    """A scene file of the sleigh at s."""
    coordinates = f"x = {{ start = 0 }}\ny = {{ start = 0 }}\nphi = {{ start = 0 }}\ns = {{ start = {s} }}"
    system = f'lagrangian = "{SLEIGH}{more}"\nconstraints = ["{BLADE}"]'
    return scene_file(folder, system, coordinates, "\"x'\" = 0.6\n\"phi'\" = 0.5\n\"s'\" = 0.1", definitions=f'l = "{l}"')


def sleigh_plain(l="0", point=(), more=""):
    """A plain scene of it."""
    return plain(SLEIGH.replace("l*", f"({l})*") + more, [BLADE], **(POINT | dict(point)))


def test_a_root_that_is_left_out(images, tmp_path):
    # sqrt(s^2) - s is 0 for s > 0
    true = measure(images, sleigh_plain(), free=FREE)
    code, said = verdict(tmp_path, true, sleigh_file(tmp_path, "sqrt(s^2) - s", 2))
    assert code == VERIFIED and "on the branch of its start" in said
    for _ in range(3):
        code, said = verdict(tmp_path, true, sleigh_file(tmp_path, "sqrt(s^2) - s", -2))
        assert (code, said) == (FORGED, "forged: the Lagrangian is not that of the file\n")


def test_a_parameter_under_a_root(images, tmp_path):
    l = "sqrt((s - a)^2) - s + a"
    file = lambda s: sleigh_file(tmp_path, re.sub(r"\ba\b", "1", l), s)
    true = measure(images, sleigh_plain(l) | {"parameters": {"a": "1"}}, free=FREE)
    assert verdict(tmp_path, true)[0] == verdict(tmp_path, true, file(2))[0] == VERIFIED
    assert verdict(tmp_path, true, file(0.5))[0] == UNREADABLE
    assert verdict(tmp_path, measure(images, sleigh_plain(), free=FREE), file(0.5))[0] == FORGED


def test_a_kink_that_is_not_at_zero(images, tmp_path):
    # a buffer, which is not there for x < 2: points of both signs do not see it
    over = SLEIGH.replace("l*", "0*")
    true = integral(images, sleigh_plain(), "x'*cos(phi) + y'*sin(phi)")
    for power in "^2", "^3", "*(x - 2)":
        file = lambda x, power=power: scene_file(
            tmp_path, f'lagrangian = "{over} - (sqrt((x - 2)^2) + x - 2){power}"\nconstraints = ["{BLADE}"]',
            f"x = {{ start = {x} }}\ny = {{ start = 0 }}\nphi = {{ start = 0 }}\ns = {{ start = 1 }}", "\"x'\" = 0.6\n\"phi'\" = 0.5\n\"s'\" = 0",
        )
        assert verdict(tmp_path, true, file(-1))[0] == verdict(tmp_path, true, file(1))[0] == VERIFIED
        assert verdict(tmp_path, true, file(3)) == (FORGED, "forged: the Lagrangian is not that of the file\n")
        # so near that the branch is not seen
        assert verdict(tmp_path, true, file("2.001"))[0] == UNREADABLE


def test_a_proof_on_another_branch(images, tmp_path):
    # the root is there; the minor is not 0 at s < 0, and at s > 0 there is a measure
    scene = sleigh_file(tmp_path, "sqrt(s^2) - s", -2)
    folder = tmp_path / "certificates"
    subprocess.run([PROGRAM, "integrals", scene, "--certificates", folder, "--quiet"], check=True, capture_output=True)
    true = json.loads((folder / "scene-measure.json").read_text())
    assert true["kind"] == "no measure" and verdict(tmp_path, true, scene)[0] == VERIFIED
    code, said = verdict(tmp_path, true, sleigh_file(tmp_path, "sqrt(s^2) - s", 2))
    assert code == UNREADABLE and "two branches" in said
    # and with its point moved there
    moved = true["scene"] | {"positions": true["scene"]["positions"] | {"s": "2"}}
    assert verdict(tmp_path, signed(true | {"scene": moved}), sleigh_file(tmp_path, "sqrt(s^2) - s", 2))[0] == FORGED
    # the two certificates exclude each other: one of them is not of the start of the file
    other = measure(images, sleigh_plain("sqrt(s^2) - s"), free=FREE)
    assert verdict(tmp_path, other, sleigh_file(tmp_path, "sqrt(s^2) - s", 2))[0] == VERIFIED
    assert verdict(tmp_path, other, sleigh_file(tmp_path, "sqrt(s^2) - s", -2))[0] == UNREADABLE
    assert "on the branch of the point of the certificate" in verdict(tmp_path, other)[1]


def test_a_root_of_time_or_in_a_force(images, tmp_path):
    coordinates = lambda x: f"x = {{ start = {x} }}\ny = {{ start = 1 }}"
    file = lambda x, force, time=0: scene_file(
        tmp_path, f'lagrangian = "(x\'^2 + y\'^2)/2"\n[system.forces]\nx = "{force}"', coordinates(x), "\"x'\" = 1\n\"y'\" = 0", start=f"time = {time}")
    pushed = lambda force: plain("(x'^2 + y'^2)/2", [], forces={"x": force}, x="1/3", y="1")
    timed = integral(images, pushed("t"), "x' - t^2/2")
    assert verdict(tmp_path, timed, file(1, "sqrt(t^2)", 1))[0] == VERIFIED
    assert verdict(tmp_path, timed, file(1, "sqrt(t^2)", -1)) == (FORGED, "forged: the force on x is not that of the file\n")
    cubic = integral(images, pushed("x^3"), "x'^2/2 - x^4/4")
    for root in "(x^2)^(3/2)", "x^2*sqrt(x^2)", "sqrt(x^6)":
        assert verdict(tmp_path, cubic, file("0.5", root))[0] == VERIFIED
        assert verdict(tmp_path, cubic, file("-0.5", root)) == (FORGED, "forged: the force on x is not that of the file\n")


def test_a_root_that_is_left_out_of_a_proof_for_almost_every_start(tmp_path):
    coordinates = lambda x: f"x = {{ start = {x} }}\ny = {{ start = -1 }}\nz = {{ start = 0.3 }}"
    file = lambda of_x, f, x: scene_file(tmp_path, PARTICLE % (of_x, f), coordinates(x))
    for of_x, f, root in (("x*z", "z' - y*x'", "sqrt(x^2)*z"), ("z", "z' - y*x'*x", "z"), ("(x - 3)^3*z", "z' - y*x'", "-(((x - 3)^2)^(3/2))*z")):
        # the point is drawn, of any sign; its own start is that of the file
        true = written(tmp_path, file(of_x, f, 0.5), "--almost-every")
        rooted = f.replace("*x'*x", "*x'*sqrt(x^2)")
        assert verdict(tmp_path, true, file(root, rooted, 0.5))[0] == VERIFIED
        code, said = verdict(tmp_path, true, file(root, rooted, -0.5 if "3" not in of_x else 3.5))
        assert code == FORGED and "is not that of the file" in said
    # from one start alone: it is that start, on its branch
    start = written(tmp_path, file("x*z", "z' - y*x'", 0.5))
    assert verdict(tmp_path, start, file("sqrt(x^2)*z", "z' - y*x'", 0.5))[0] == VERIFIED
    assert verdict(tmp_path, start, file("sqrt(x^2)*z", "z' - y*x'", -0.5))[0] == FORGED
    own = written(tmp_path, file("sqrt(x^2)*z", "z' - y*x'", -0.5))
    assert verdict(tmp_path, own, file("-x*z", "z' - y*x'", -0.5))[0] == VERIFIED
    assert verdict(tmp_path, own, file("x*z", "z' - y*x'", -0.5))[0] == FORGED


def certificates(folder, scene, *sets):
    """Those of `deltaq integrals`."""
    place = folder / "certificates"
    subprocess.run([PROGRAM, "integrals", scene, *sets, "--certificates", place, "--quiet"], check=True, capture_output=True)
    return [json.loads(file.read_text()) for file in sorted(place.glob("*.json"))]


def claim(said):
    """What is said to be verified, without the field in which it is."""
    return re.sub(r"\([^()]*mod \d+\)", "", said.split("\n")[0])


def why_harmless(true, path, other, said, claims, constant):
    """Why an altered certificate says nothing wrong; None where it does. `claims`: those of genuine certificates of the scene; `constant`:
    velocities that are constant along its motions."""
    if "kind" not in true:
        return test_proof.harmless(true, path, other)
    if path[:2] in (("scene", "lagrangian"), ("scene", "constraints")):
        signs = {x: -1 if at[0] == "-" else 1 for x, at in true["scene"]["positions"].items() if x == "s"}
        if not test_proof.same_function(true["scene"], other["scene"], signs):
            return None
    if claim(said) in claims:
        return f"the same claim, with another {path[1] if path[0] == 'scene' else path[0]}"
    if path == ("free",) and sorted(other["free"]) == sorted(true["free"]):
        return "the same fields in another order"
    return "another integral" if path == ("integral",) and differ_by(true, other, constant) else None


def differ_by(true, other, names):
    """Whether one integral is a multiple of the other but for a function of these names, in decimals."""
    verify, slopes = test_proof.verify, []
    for seed in range(3):
        point, kept, values = random.Random(seed), random.Random(9), []
        for _ in range(4):
            at = {x: point.uniform(-2, 2) for name in true["scene"]["coordinates"] for x in (name, name + "'")} | {"t": point.uniform(-2, 2)}
            at |= {name: kept.uniform(1, 2) if len(values) == 0 else values[0][2][name] for name in names}
            at |= verify.decimals(true["scene"]["parameters"].items())
            found = [verify.decimals([*((x, str(y)) for x, y in at.items()), ("F", proof["integral"])])["F"] for proof in (true, other)]
            values.append((*found, at))
        slopes += [(b[1] - a[1]) / (b[0] - a[0]) if b[0] != a[0] else b[1] - a[1] for a, b in zip(values, values[1:])]
    return slopes == pytest.approx([slopes[0]] * len(slopes), rel=1e-9)


def test_altered_fields(tmp_path):
    """Each is refused, or harmless for a reason; drawn from certificates of all kinds, with roots and without; a thousand with ALL."""
    scenes = [CATALOGUE / "scenes/sledge.toml", CATALOGUE / "scenes/particle.toml", CATALOGUE / "scenes/sleigh.toml"]
    roots = []
    for s in -2, 2:
        folder = tmp_path / str(s)
        folder.mkdir()
        roots.append(sleigh_file(folder, "sqrt(s^2) - s", s))
    all_certificates, claims, constant = [], {}, {}
    for scene in scenes + roots:
        folder = tmp_path / f"of-{len(all_certificates)}"
        folder.mkdir()
        all_certificates += [(true, scene) for true in certificates(folder, scene)]
    for scene in scenes[:2]:
        all_certificates += [(written(tmp_path, scene, *options), scene) for options in ((), ("--almost-every",))]
    drawn, reasons, counts, unexplained = random.Random(71), {}, [0, 0, 0], []
    each = (1000 if test_proof.ALL else 50) // len(all_certificates) + 1
    for true, scene in all_certificates:
        code, said = verdict(tmp_path, true, scene)
        assert code == VERIFIED
        claims.setdefault(scene, set()).add(claim(said))
        constant.setdefault(scene, []).extend(x for x in [true.get("integral", "")] if re.fullmatch(r"\w+'", x))
    for true, scene in all_certificates:
        found = [(path, other) for path, other in changes(true) if path]
        for path, other in drawn.sample(found, min(each, len(found))):
            forged = changed(true, path, other)
            forged = signed(forged) if path[0] == "scene" and len(path) > 1 else forged
            code, said = verdict(tmp_path, forged, scene)
            counts[code] += 1
            assert not re.search("Error", said), (path, other, said)
            if code == VERIFIED:
                reason = why_harmless(true, path, forged, said, claims[scene], constant[scene])
                unexplained += [] if reason else [(true.get("kind"), path, other, said)]
                reasons[reason] = reasons.get(reason, 0) + 1
    assert not unexplained, (sum(counts), unexplained)
    print(dict(zip(("verified", "forged", "cannot be read"), counts)), reasons)
