"""Certificates of `deltaq prove` are verified by a script that shares no code with it, and forged ones are refused."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import deltaq

VALIDATION = Path(__file__).resolve().parents[3] / "validation"
# the module is laid out beside the programs of its build
PROGRAM = Path(sys.prefix).parent / "release" / "deltaq"


def written(folder, scene, **changes):
    """The certificate of a scene; a `__` in a name stands for a prime."""
    path, options = folder / "certificate.json", [x for name, y in changes.items() for x in ("--set", f"{name.replace('__', chr(39))}={y}")]
    path.unlink(missing_ok=True)
    run = subprocess.run([PROGRAM, "prove", VALIDATION / f"{scene}.toml", *options, "--out", path], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return json.loads(path.read_text())


def verified(folder, scene, certificate):
    """What the script says."""
    path = folder / "looked-at.json"
    path.write_text(json.dumps(certificate))
    run = subprocess.run([sys.executable, VALIDATION / "proof" / "verify.py", VALIDATION / f"{scene}.toml", path], capture_output=True, text=True)
    said = run.stdout + run.stderr
    assert (run.returncode == 0) == said.startswith("verified") and (run.returncode == 1) == said.startswith("refused"), said
    return said


@pytest.mark.parametrize(
    "scene, order, changes",
    [
        ("scenes/sledge", 1, {}),
        ("scenes/particle", 1, {"x__": 0.3}),
        ("scenes/turntable", 1, {}),
        ("scenes/turntable", 1, {"x": 0.6, "psi__": 0.700001}),
        ("scenes/turntable", 3, {"psi__": 0.7}),
        ("scenes/ball-in-cone", 1, {}),
        ("scenes/three-cylinders", 4, {}),
        ("scenes/trailer", 4, {}),
        ("equivalence/falling-disc", 2, {}),
        ("equivalence/unicycle-in-potential", 1, {}),
    ],
)
def test_a_certificate_is_verified(tmp_path, scene, order, changes):
    certificate = written(tmp_path, scene, **changes)
    assert certificate["order"] == order
    assert verified(tmp_path, scene, certificate).startswith(f"verified: no mu_0 (order {order}, minor {certificate['minor']}")


@pytest.mark.parametrize("index", [5, 7, 9, 15, 29])
def test_of_random_systems(tmp_path, index):
    # their velocities are all decimals, some of which the constraints have to complete
    subprocess.run([PROGRAM, "random", "--seed", "1", "--index", str(index), "--quiet", "--out", tmp_path], check=True, capture_output=True)
    scene = tmp_path / f"random-1-{index}"
    certificate = written(tmp_path, scene)
    assert certificate["completed"]
    said = verified(tmp_path, scene, certificate)
    assert said.startswith("verified") and said.split()[-1] == certificate["completed"][-1]


def test_what_is_changed_is_refused(tmp_path):
    scene = "scenes/sledge"
    true = written(tmp_path, scene)
    assert verified(tmp_path, scene, true).startswith("verified")
    (first, second, *rest), motion, reactions = true["rows"], true["motion"], true["reactions"]
    divided_by = {what: x + 1 for what, x in true["divided_by"].items()}
    for field, others in {
        "schema": ["deltaq/certificate/2"],
        "prime": [true["prime"] + 2, 2305843009213693921],
        "i": [1, true["prime"] - true["i"]],
        "N": [true["N"] + "0", "1"],
        "tau": [true["tau"] + 1],
        "order": [0, 2],
        "rows": [[first, first, *rest], [second, first, *rest], [first, second], [[9, 9], second, *rest], [[-1, 0], second, *rest]],
        "minor": [0, true["minor"] + 1],
        "divided_by": [divided_by, {}, true["divided_by"] | {"x": 0}, true["divided_by"] | {"().__class__": 1}],
        "set": [{"phi'": 1.2}, {"g": 9.8}, {"x": 1}],
        "completed": [["x'"], ["nobody"]],
        "motion": [motion | {"phi": motion["x"]}, {"x": motion["x"]}, *(motion | {x: [*c[:-1], c[-1] + by]} for x, c in motion.items() for by in (1, 0.5))],
        "reactions": [reactions[:1], [[1], *reactions[1:]], [*reactions[:-1], [reactions[-1][0] + 1]]],
    }.items():
        for other in others:
            assert other != true[field]
            assert verified(tmp_path, scene, true | {field: other}).startswith("refused"), (field, other)
        assert verified(tmp_path, scene, {name: x for name, x in true.items() if name != field}).startswith("refused"), field


def test_a_proof_for_another_start_is_refused(tmp_path):
    scene = "scenes/turntable"
    other = written(tmp_path, scene, x=0.6, psi__=0.700001)
    assert "at the start" in verified(tmp_path, scene, other | {"set": {}})
    # this one is the ball that turns with its table, which is vakonomic
    assert "at the start" in verified(tmp_path, scene, other | {"set": {"x": 0.6, "psi'": 0.7}})
    assert "refused" in verified(tmp_path, "scenes/sledge", other)


def test_no_certificate_is_verified_where_there_are_multipliers(tmp_path):
    # straight ahead the particle is vakonomic with mu_0 = 0; everything but the minor is true
    scene = "scenes/particle"
    true = written(tmp_path, scene)
    still, minus = [0] * 4, true["prime"] - 1
    motion = {"x": [0, 1, 0, 0], "y": [minus, *still[1:]], "z": [0, minus, 0, 0]}
    forged = true | {"set": {"y'": 0.0}, "motion": motion, "reactions": [[0], [0]]}
    assert "the minor" in verified(tmp_path, scene, forged)
