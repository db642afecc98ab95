"""Certificates of `deltaq prove` are verified by a script that shares no code with it; forged ones are told from what it cannot read."""

import contextlib
import copy
import hashlib
import importlib.util
import io
import json
import os
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

import deltaq

ROOT = Path(__file__).resolve().parents[3]
CATALOGUE = ROOT / "crates/scene"
# the module is laid out beside the programs of its build
PROGRAM = Path(os.environ.get("DELTAQ", Path(sys.prefix).parent / "release" / "deltaq"))
EVIDENCE = PROGRAM.with_name("evidence")
SCRIPT = ROOT / "validation/proof/verify.py"
VERIFIED, FORGED, UNREADABLE = range(3)
# all single changes in the place of a drawn part
ALL = "PROOF_CHANGES" in os.environ
specification = importlib.util.spec_from_file_location("verify", SCRIPT)
verify = importlib.util.module_from_spec(specification)
specification.loader.exec_module(verify)


def written(folder, scene, *options, code=0, **changes):
    """The certificate of a scene file; a `__` in a name stands for a prime."""
    path, sets = folder / "certificate.json", [x for name, y in changes.items() for x in ("--set", f"{name.replace('__', chr(39))}={y}")]
    path.unlink(missing_ok=True)
    run = subprocess.run([PROGRAM, "prove", scene, *sets, *options, "--out", path], capture_output=True, text=True)
    assert run.returncode == code, run.stderr
    return run.stderr if code else json.loads(path.read_text())


def in_formulas(folder, file):
    """The file, or of a scene of bodies one that says what they mean."""
    if "[body." not in file.read_text():
        return file
    formulas = folder / f"formulas-{file.name}"
    formulas.write_text(subprocess.run([PROGRAM, "show", "--formulas", file], check=True, capture_output=True, text=True).stdout)
    return formulas


def verdict(folder, certificate, *scene):
    """What the script says of a certificate, with its code."""
    path = folder / "looked-at.json"
    path.write_text(json.dumps(certificate))
    scene = [in_formulas(folder, file) for file in scene]
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        code = verify.main(*map(str, scene), str(path))
    assert said.getvalue().startswith(("verified: ", "forged: ", "cannot read: ")[code])
    return code, said.getvalue()


def signed(certificate):
    """With the digest of its scene."""
    text = json.dumps(certificate["scene"], separators=(",", ":"))
    return certificate | {"digest": "sha256:" + hashlib.sha256(text.encode()).hexdigest()}


def scene_file(folder, system, coordinates="x = { start = 0.2 }\ny = { start = -1 }\nz = { start = 0 }", velocities="\"x'\" = 1\n\"y'\" = 0.5", **tables):
    """A scene of a particle, or with tables of its own."""
    path = folder / "scene.toml"
    more = "".join(f"[{name}]\n{text}\n" for name, text in tables.items())
    path.write_text(f'title = "t"\n{more}[coordinates]\n{coordinates}\n[system]\n{system}\n[start.velocities]\n{velocities}\n[run]\nduration = 1\n')
    return path


BUILT_IN = [
    ("scenes/sledge", 1, {}),
    ("scenes/particle", 1, {"x__": 0.3}),
    ("scenes/turntable", 1, {}),
    ("scenes/turntable", 1, {"x": 0.6, "psi__": 0.700001}),
    ("scenes/turntable", 3, {"psi__": 0.7}),
    ("scenes/ball-in-cone", 1, {}),
    ("scenes/three-cylinders", 4, {}),
    ("scenes/trailer", 4, {}),
    ("classics/falling-disc", 2, {}),
    ("classics/isokinetic", 1, {}),
    ("classics/unicycle-in-potential", 1, {}),
]


@pytest.mark.parametrize("scene, order, changes", BUILT_IN)
def test_a_certificate_is_verified(tmp_path, scene, order, changes):
    scene = CATALOGUE / f"{scene}.toml"
    certificate = written(tmp_path, scene, **changes)
    assert certificate["order"] == order
    code, said = verdict(tmp_path, certificate, scene)
    assert code == VERIFIED and f"(order {order}, minor {certificate['minor']}" in said and f"it is that of {in_formulas(tmp_path, scene)}" in said
    assert all(f"{name.replace('__', chr(39))} = {x}" in said for name, x in changes.items())
    assert verdict(tmp_path, certificate)[0] == VERIFIED
    code, said = verdict(tmp_path, written(tmp_path, scene, "--almost-every", **changes), scene)
    assert code == VERIFIED and "almost every one" in said


PARTICLE = 'lagrangian = "(x\'^2 + y\'^2 + z\'^2)/2 - %s"\nconstraints = ["%s"]'
ROLLING = 'lagrangian = "m/2*dot(c\', c\') + dot(W, diag(0.1, 0.2, 0.3)*W)/2 - m*9.81*c.z"\nconstraints = ["slip.x", "slip.y"]'
AXES = "x = { start = 0.1 }\ny = { start = 0 }\npsi = { start = 0.3 }\nth = { start = 1.2 }\nphi = { start = 0 }"
TURNING = "\"psi'\" = 1\n\"th'\" = 0.3\n\"phi'\" = 2"
# what the first verifier refused, each with a word of its plain scene
OWN = {
    "a parameter F": ({"system": PARTICLE % ("F*x*z", "z' - y*x'"), "parameters": "F = 1.5"}, "F"),
    "a parameter lambda": ({"system": PARTICLE % ("lambda*x*z", "z' - y*x'"), "parameters": "lambda = 1.5"}, "lambda"),
    "a parameter x_rate": ({"system": PARTICLE % ("x_rate*x*z", "z' - y*x_rate*x'"), "parameters": "x_rate = 1.5"}, "x_rate"),
    "definitions": ({"system": PARTICLE % ("w*z", "z' - w*x' - u'*y"), "definitions": 'w = "u^2 - z"\nu = "x + y"'}, ""),
    "exp": ({"system": PARTICLE % ("exp(-x/3)*z", "z' - exp(x/2)*y*x'")}, "exp"),
    "tanh and step": ({"system": PARTICLE % ("step(t, 1, 2, 0.5)*z*x", "z' - tanh(y)*x'")}, "tanh"),
    "roots": ({"system": PARTICLE % ("sqrt(x^2 + y^2 + 5)*z", "z' - sqrt(x + 0.8)*y^(2)*x'*(y + 2)^(3/2)")}, "sqrt"),
    "fractions": ({"system": PARTICLE % ("cos(x/43)*z", "z' - y*sin(y/97)*x'")}, "cos"),
    "a high order": ({"system": PARTICLE % ("0", "z' - (y + 1)^4*x'")}, ""),
    "vectors": ({"system": 'lagrangian = "dot(r\', r\')/2 - norm(r)*z"\nconstraints = ["dot(r\', cross([sin(x), cos(y), 1], [0, x, y]))"]',
                 "coordinates": "x = { start = 2 }\ny = { start = 1 }\nz = { start = 2 }", "definitions": 'r = "[x, y, z]"'}, ""),
    "rotations": ({"system": ROLLING, "coordinates": AXES, "velocities": TURNING, "parameters": "m = 1.5\na = 0.5", "definitions":
                   'R = "rotation(zxz, psi, th, phi)"\nW = "body_angular_velocity(R)"\nc = "[x, y, 0] + R*[0, 0, a/5]"\n'
                   'slip = "[x\', y\', 0] + cross(angular_velocity(R), [0, 0, -a])"'}, ""),
    "an axis that turns": ({"system": 'lagrangian = "(x\'^2 + y\'^2)/2 + dot(w, w)/3 + be\'^2/10"\nconstraints = ["d.x*y\' - d.y*x\'"]', "coordinates":
                            "x = { start = 0 }\ny = { start = 0 }\nal = { start = 0.4 }\nbe = { start = 0.3 }", "velocities": "\"al'\" = 1.1\n\"x'\" = 0.5\n\"be'\" = 0.2",
                            "definitions": 'R = "rotation([sin(be), 0, cos(be)], al)"\nd = "transpose(R)*[1, 0, 0]"\nw = "angular_velocity(R)"'}, ""),
    "a quadratic constraint": ({"system": PARTICLE % ("x*z", "x'^2 + y'^2 - z'^2"), "velocities": "\"x'\" = 3\n\"y'\" = 4\n[start.guess]\n\"z'\" = 5"}, ""),
    "round-off": ({"system": PARTICLE % ("x*z", "z' - sin(y)*x'"), "coordinates": "x = { start = 0.1 }\ny = { start = 0.3 }\nz = { start = 0 }",
                   "velocities": "\"x'\" = 1\n\"y'\" = 2\n\"z'\" = 0.29552020666133955"}, ""),
}


@pytest.mark.parametrize("what", OWN)
def test_of_all_that_a_scene_may_contain(tmp_path, what):
    tables, word = OWN[what]
    scene = scene_file(tmp_path, **tables)
    certificate = written(tmp_path, scene)
    assert verdict(tmp_path, certificate, scene)[0] == VERIFIED
    plain = certificate["scene"]
    texts = [plain["lagrangian"], *plain["constraints"]]
    assert word in " ".join(texts) and not re.search(r"\[|rotation|dot|''|norm", " ".join(texts))
    # one digit more in the file's first number of the system
    text = scene.read_text()
    start = text.index("[system]")
    scene.write_text(text[:start] + re.sub(r"(?<=[/(* -])(\d)(?=[^\d.(])", r"\g<1>.001", text[start:], count=1))
    assert verdict(tmp_path, certificate, scene)[0] == FORGED


def test_of_the_template(tmp_path):
    scene = tmp_path / "new.toml"
    subprocess.run([PROGRAM, "new", scene], check=True, capture_output=True)
    assert verdict(tmp_path, written(tmp_path, scene), scene)[0] == VERIFIED


@pytest.mark.parametrize("index", [5, 7, 9, 15, 29])
def test_of_random_systems(tmp_path, index):
    # their velocities are all decimals, some of which the constraints have to complete
    subprocess.run([EVIDENCE, "random", "--seed", "1", "--index", str(index), "--quiet", "--out", tmp_path], check=True, capture_output=True)
    scene = tmp_path / f"random-1-{index}.toml"
    certificate = written(tmp_path, scene)
    completed = certificate["completed"]
    code, said = verdict(tmp_path, certificate, scene)
    assert completed and code == VERIFIED and f"completed: {' '.join(completed)}" in said
    # one that is far from what the constraints say
    scene.write_text(re.sub(rf"(\"{completed[0]}\"\s*=\s*-?)", r"\g<1>7", scene.read_text()))
    assert verdict(tmp_path, certificate, scene)[0] == FORGED


def test_the_script_alone_ends_with_its_code(tmp_path):
    scene, path = in_formulas(tmp_path, CATALOGUE / "scenes" / "sledge.toml"), tmp_path / "certificate.json"
    certificate = written(tmp_path, scene)
    for code, text in enumerate((path.read_text(), json.dumps(certificate | {"minor": 1}), "{")):
        path.write_text(text)
        assert subprocess.run([sys.executable, SCRIPT, scene, path], capture_output=True).returncode == code
    assert subprocess.run([sys.executable, SCRIPT], capture_output=True).returncode == UNREADABLE


def test_the_prime_is_one_and_large(tmp_path):
    scene = scene_file(tmp_path, PARTICLE % ("0", "z' - y*x'"))
    true = written(tmp_path, scene)
    # 13 with order 14; a product of two primes that is one to the bases 2 to 23; a prime to which i is another
    for prime, words in ((13, "p is not a prime"), (3825123056546413051, "p is not a prime"), (2305843009213693921, "e^(2 pi i/M)")):
        code, said = verdict(tmp_path, true | {"prime": prime, "order": 14}, scene)
        assert code == FORGED and words in said
    assert all(verify.is_prime(n) == all(n % k for k in range(2, n)) for n in range(2, 3000))


def test_an_exponent_that_moves_is_no_number(tmp_path):
    # for y^w along w = 2 + ..., as for y^2
    coordinates = "x = { start = 0.2 }\ny = { start = %s }\nz = { start = 0.3 }\nw = { start = 2 }"
    velocities = "\"x'\" = 1\n\"y'\" = 0.5\n\"w'\" = 0.3"
    text = PARTICLE.replace(" - %s", " + w'^2/2 - %s") % ("z*y^%s", "z' - y*x'")
    for y, code in (("3", UNREADABLE), ("1", FORGED)):
        true = written(tmp_path, scene_file(tmp_path, text % "2", coordinates % y, velocities))
        plain = true["scene"]
        forged = signed(true | {"scene": plain | {"lagrangian": plain["lagrangian"].replace("y^2", "y^w")}})
        assert forged["scene"] != plain
        assert verdict(tmp_path, forged)[0] == code
        assert verdict(tmp_path, true, scene_file(tmp_path, text % "w", coordinates % y, velocities))[0] == code
    # where y = 1 its logarithm is known
    assert verdict(tmp_path, written(tmp_path, tmp_path / "scene.toml"), tmp_path / "scene.toml")[0] == VERIFIED


def test_a_parameter_is_no_velocity(tmp_path):
    named = lambda name, also: scene_file(tmp_path, PARTICLE % ("x*z", f"z' - y*{name}*x'"), parameters=also)
    true = written(tmp_path, named("x'", ""))
    scene = named("x_rate", "x_rate = 1")
    assert verdict(tmp_path, true, scene)[0] == FORGED
    plain = json.loads(json.dumps(true["scene"]).replace("x'^2*y", "x_rate*x'*y"))
    assert plain != true["scene"]
    assert verdict(tmp_path, signed(true | {"scene": plain | {"parameters": {"x_rate": "1"}}}), scene)[0] == FORGED
    assert verdict(tmp_path, written(tmp_path, scene), scene)[0] == VERIFIED


def test_a_start_that_is_set_is_said(tmp_path):
    scene = CATALOGUE / "scenes" / "turntable.toml"
    other = written(tmp_path, scene, x=0.6, psi__=0.700001)
    code, said = verdict(tmp_path, other, scene)
    assert code == VERIFIED and "set: psi' = 0.700001, x = 0.6" in said and "start: t = 0, x = 0.6, " in said
    for sets in ({}, {"x": "0.6"}, {"x": "0.6", "psi'": "0.7"}):  # the last is the ball that turns with its table, which is vakonomic
        code, said = verdict(tmp_path, other | {"set": sets}, scene)
        assert code == FORGED and "at the start is not that of the file" in said
    assert verdict(tmp_path, other, CATALOGUE / "scenes" / "sledge.toml")[0] == FORGED


def test_another_scene_is_not_proved(tmp_path):
    # each with a proof of its own that is right
    file = lambda start, y, g, L, f, forces="": scene_file(
        tmp_path, PARTICLE % (L, f) + forces, coordinates=f"x = {{ start = {start} }}\ny = {{ start = {y} }}\nz = {{ start = 0 }}", parameters=f"g = {g}"
    )
    own = ("0.2", "-1", "9.81", "g*x*z", "z' - y*x'")
    true = written(tmp_path, file(*own))
    for i, other in enumerate(("0.21", '"-1 + x/1000"', "9.8100001", "g*x*z - 1e-9*z^3", "z' - y*x' - 1e-9*x*x'")):
        scene = file(*own[:i], other, *own[i + 1 :])
        assert verdict(tmp_path, true, scene)[0] == FORGED
        certificate = written(tmp_path, scene)
        assert verdict(tmp_path, certificate, scene)[0] == VERIFIED
        assert verdict(tmp_path, certificate, file(*own))[0] == FORGED
    # forces act by virtual work, and are part of what is proved
    pushed = file(*own, '\nforces = { x = "-1.001*x\'*z" }')
    certificate = written(tmp_path, pushed)
    assert certificate["scene"]["forces"].keys() == {"x"} and deltaq.load(pushed).prove()
    assert verdict(tmp_path, certificate, pushed)[0] == VERIFIED
    assert verdict(tmp_path, certificate, file(*own, '\nforces = { x = "-1.002*x\'*z" }')) == (FORGED, "forged: the force on x is not that of the file\n")
    assert verdict(tmp_path, true, file(*own, '\nforces = { x = "-1.001*x\'*z" }'))[0] == FORGED
    for forces in ({"x": "-x'*z"}, {}, {"x": "1.001*x'*z"}, {"w": "1"}):
        assert verdict(tmp_path, signed(certificate | {"scene": certificate["scene"] | {"forces": forces}}))[0] == FORGED


def test_no_certificate_is_verified_where_there_are_multipliers(tmp_path):
    # straight ahead the particle is vakonomic with mu_0 = 0; everything but the minor is true
    scene = CATALOGUE / "scenes" / "particle.toml"
    true = written(tmp_path, scene)
    minus, zeros = true["prime"] - 1, [0, 0]
    motion = {"x": [0, 1, *zeros], "y": [minus, 0, *zeros], "z": [0, minus, *zeros]}
    plain = true["scene"] | {"velocities": true["scene"]["velocities"] | {"y'": "0"}}
    forged = signed(true | {"set": {"y'": "0"}, "motion": motion, "reactions": [[0], [0]], "scene": plain})
    assert verdict(tmp_path, forged, scene) == (FORGED, "forged: the minor\n")


def test_what_is_said_of_the_field_is_looked_at(tmp_path):
    scene = scene_file(tmp_path, PARTICLE % ("sin(y)*z", "z' - sin(y)*x'"))
    true = written(tmp_path, scene)
    plain, (M, z) = true["scene"], true["unity"]
    i = pow(z, M // 4, true["prime"])
    assert verdict(tmp_path, true | {"unity": [4, i]}, scene)[0] == VERIFIED
    for unity in ([1, 1], [8, i], [4 * 1000003, i], [4, i + 1], [4, 1]):
        assert verdict(tmp_path, true | {"unity": unity}, scene)[0] == FORGED
    # a derivative is none of the plain formulas, though that of x/x is 0
    code, said = verdict(tmp_path, signed(true | {"scene": plain | {"lagrangian": plain["lagrangian"] + " + (x/x)'"}}), scene)
    assert code == UNREADABLE and "time derivative" in said
    # one that holds mod p, but is not so
    with pytest.raises(verify.Forged, match="round-off"):
        verify.near(plain, {"x'": "1", "y'": "0.5", "z'": "0.1"})
    verify.near(plain, {"x'": "1", "y'": "0.5", "z'": "sin(-1)"})


def changes(value, path=()):
    """Single changes of a JSON value: the path to a field, and what stands there instead; None for nothing."""
    yield path, None
    if isinstance(value, dict):
        for name, x in value.items():
            yield from changes(x, (*path, name))
        yield path, value | {"more": "1"}
    elif isinstance(value, list):
        for i, x in enumerate(value):
            yield from changes(x, (*path, i))
        yield from ((path, other) for other in (value[1:], value[::-1], [*value, *value[:1]]) if other != value)
    elif isinstance(value, bool):
        yield path, not value
    elif isinstance(value, int):
        yield from ((path, x) for x in (value + 1, value - 1, 0, 1.5, str(value)) if x != value)
    else:
        tokens = list(re.finditer(r"\d+|[-+*/^]|[A-Za-z_]\w*'*", value))
        for token in tokens:
            other = {"+": "-", "-": "+", "*": "/", "/": "*", "^": "*"}.get(token[0]) or (str(int(token[0]) + 1) if token[0].isdigit() else "t")
            yield path, value[: token.start()] + other + value[token.end() :]


def changed(value, path, other):
    value = copy.deepcopy(value)
    place = value
    for step in path[:-1]:
        place = place[step]
    if other is None:
        del place[path[-1]]
    else:
        place[path[-1]] = other
    return value


def harmless(true, path, changed):
    """Why a certificate is as good with a change."""
    head = path[0]
    plain = changed["scene"]
    if path == ("scene", "parameters") and "more" in plain["parameters"]:
        return "a parameter that stands nowhere"
    if head == "scene" and path[1] in ("time", "positions", "velocities"):
        verify.resize(2)
        before, after = verify.started(true["scene"]), verify.started(plain)
        return "a start of the same numbers" if all(before[x].c == after[x].c for x in before) else None
    if head == "almost_every_start":
        return "a proof for one start is one for almost every start"
    if head == "rows" and sorted(changed["rows"]) == sorted(true["rows"]):
        return "rows in an even order have the same determinant"
    if head == "divided_by":
        return "what the script divides by it sees itself"
    if path[:2] == ("scene", "lagrangian") or path[:2] == ("scene", "constraints"):
        return "the same function in other words" if same_function(true["scene"], plain) else None
    return None


def same_function(one, other, signs={}):
    """Whether Lagrangian and constraints have the same values, in decimals at drawn points; of these signs, where there are two branches."""
    for seed in range(5):
        names = ["t", *one["coordinates"], *(x + "'" for x in one["coordinates"])]
        values = []
        for plain in one, other:
            scope = {name: verify.Formulas() for name in plain["parameters"]}
            scope = {name: formulas.in_decimals({})[place] for name, formulas in scope.items() for place in [formulas.read(plain["parameters"][name])]}
            formulas, point = verify.Formulas(), random.Random(seed)
            places = [formulas.read(text) for text in (plain["lagrangian"], *plain["constraints"])]
            found = formulas.in_decimals(scope | {name: signs.get(name, point.choice((-1, 1))) * point.uniform(0.5, 1.5) for name in names})
            values.append([found[place] for place in places])
        if values[0] != pytest.approx(values[1], rel=1e-12):
            return False
    return True


CHANGED = ["scenes/sledge", "scenes/particle", "scenes/turntable", "scenes/three-cylinders", "classics/unicycle-in-potential"]


@pytest.mark.parametrize("name", CHANGED)
def test_what_is_changed_is_forged_or_cannot_be_read(tmp_path, name):
    scene = CATALOGUE / f"{name}.toml"
    true = written(tmp_path, scene)
    found = [(path, other) for path, other in changes(true) if path]
    counts = [0, 0, 0]
    for path, other in found if ALL else random.Random(0).sample(found, 40):
        forged = changed(true, path, other)
        forged = signed(forged) if path[0] == "scene" and len(path) > 1 else forged
        code, said = verdict(tmp_path, forged, scene)
        counts[code] += 1
        assert code != VERIFIED or harmless(true, path, forged), (path, other, said)
        assert not re.search("Error", said), (path, other, said)
    print(name, *zip(("verified", "forged", "cannot be read"), counts))


@pytest.mark.parametrize("almost_every", [False, True])
def test_the_certificate_is_that_of_the_command(tmp_path, almost_every):
    path = tmp_path / "certificate.json"
    words = [PROGRAM, "prove", "sledge", "--out", path, *(["--almost-every"] if almost_every else [])]
    subprocess.run(words, check=True, capture_output=True)
    system = deltaq.load(CATALOGUE / "scenes/sledge.toml")
    proof = system.prove(almost_every_start=almost_every)
    assert proof and proof.because is None and proof.certificate == json.loads(path.read_text())
    proof.save(tmp_path / "ours.json")
    assert (tmp_path / "ours.json").read_bytes() == path.read_bytes()


def test_without_a_certificate_it_is_said_why(tmp_path):
    proof = deltaq.System(["x"], "x'^2/2", start={"x": 0}, velocities={"x'": 1}).prove()
    assert not proof and proof.certificate is None and proof.because == "nothing is constrained"
    with pytest.raises(ValueError, match="no certificate: nothing is constrained"):
        proof.save(tmp_path / "nothing.json")
