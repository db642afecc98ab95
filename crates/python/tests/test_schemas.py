"""What the program answers in JSON is what its schema describes; and what is described is not just anything."""

import json
import subprocess
import sys
import tomllib
from hashlib import sha256
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from referencing import Registry

import deltaq

ROOT = Path(__file__).resolve().parents[3]
# the module is laid out beside the programs of its build
PROGRAM = Path(sys.prefix).parent / "release" / "deltaq"
EVIDENCE = PROGRAM.with_name("evidence")
# what the evidence answers, and not the tool
OF_EVIDENCE = {"random", "random-system", "stability", "scaling", "job", "bench", "bench-ensemble"}


def answer(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=True).stdout


# derived from the types of answers; what the evidence answers is described by hand
SCHEMAS = {kind: json.loads(answer("schema", kind)) for kind in answer("schema").split()}
SCHEMAS |= {path.stem: json.loads(path.read_text("utf-8")) for path in (ROOT / "docs" / "schemas").glob("*.json")}
REGISTRY = Registry().with_contents((schema["$id"], schema) for schema in SCHEMAS.values())
# by kind: calls with their exit codes; FOLDER is an empty one
ANSWERS = {
    "solve": {"solve sledge -f chetaev --times 0,1": 0, "solve sledge -f removed-constraint --removal along-x --constants zero": 3},
    "ensemble": {"ensemble ball-in-cone -f chetaev --vary theta=-0.4..0.4:3": 3},
    "list": {"list": 0},
    "show": {"show appell-hamel": 0, "show disc --latex": 0},
    "compare": {"compare sledge bowl --set duration=1": 0},
    "prove": {f"prove {scene} --out FOLDER/proof": code for scene, code in {"sledge": 0, "heisenberg": 3, "planar-body": 3}.items()},
    "connect": {"connect heisenberg --to x=0.2,y=0.5,z=1 --starts 8": 0, "connect disc -f chetaev --to psi=3,phi=1 --starts 2": 0},
    "integrals": {"integrals suslov": 0, "integrals turntable --degree 1": 0, "integrals sledge-with-friction --degree 1": 0},
    "integrals-certificate": {f"integrals {scene} --degree 1 --certificates FOLDER": 0 for scene in ("suslov", "heisenberg")},
    "judge": {"judge sledge FOLDER/motion.csv": 0, "judge sledge FOLDER/motion.csv FOLDER/motion.csv FOLDER/motion.csv --set g=5": 3},
    "review": {f"review sleigh {ROOT}/docs/derivations/{name}.txt": code for name, code in {"right": 0, "frozen": 1}.items()}
    | {f"review sleigh {ROOT}/docs/derivations/right.txt -f prescribed": 3},
    "fit": {"fit sledge FOLDER/film.csv --free x,y,phi,x',phi',g~9 --law eps --sigma 1mm": 0, "fit sledge FOLDER/film.csv --free x,y --sigma 1um": 3},
    "design": {"design heisenberg --tell vakonomic,chetaev --film 9Hz,1mm,1s --free x',y' --over mu0_1=0.1:1 --points 4": 0, "design disc --estimate eps --law eps --film 9Hz,1mm,1s": 0},
    "certificate": {"prove sledge --out -": 0},
    "linearize": {"linearize bicycle --free lean,steer --sweep v=4:5:2": 0, "linearize sledge --at 1": 0},
    "random": {"random --count 3": 0},
    "random-system": {"random --index 3": 0},
    "stability": {"stability --case blow-up": 0},
    "bench": {"bench bowl --seconds 0.0001": 0},
    "bench-ensemble": {"bench --ensemble 1e-6 --members 16": 0},
    "scaling": {"scaling --longest 2 --repeats 1": 0},
    "job": {"--scenes bowl --out FOLDER": 0},
}


def is_valid(kind, answer):
    return Draft202012Validator(SCHEMAS[kind], registry=REGISTRY).is_valid(answer)


def check(kind, text):
    """The answer is as described, says so at its head, and would not be with a field more, a field less, or of another version."""
    answer = json.loads(text)
    Draft202012Validator(SCHEMAS[kind], registry=REGISTRY).validate(answer)
    assert next(iter(answer)) == "schema"
    assert not is_valid(kind, answer | {"more": 0}) and not is_valid(kind, answer | {"schema": f"deltaq/{kind}/0"})
    for name in SCHEMAS[kind]["required"]:
        assert not is_valid(kind, {other: x for other, x in answer.items() if other != name}), name
        assert name == "schema" or not is_valid(kind, answer | {name: [[None]]}), name


@pytest.mark.parametrize("kind", SCHEMAS.keys() - {"verdicts"})
def test_answers_are_as_described(kind, tmp_path):
    Draft202012Validator.check_schema(SCHEMAS[kind])
    if kind == "judge":
        motion = subprocess.run([PROGRAM, "solve", "sledge", "-f", "chetaev"], capture_output=True, text=True, check=True).stdout
        (tmp_path / "motion.csv").write_text(motion)
    if kind == "fit":
        (tmp_path / "film.csv").write_bytes((ROOT / "crates" / "deltaq" / "tests" / "film.csv").read_bytes())
    for call, code in ANSWERS[kind].items():
        form = [] if kind.endswith("certificate") else ["--format", "json"]
        words = call.replace("FOLDER", str(tmp_path)).split(" ") + form
        run = subprocess.run([EVIDENCE if kind in OF_EVIDENCE else PROGRAM, *words, "--quiet"], capture_output=True, text=True)
        assert run.returncode == code, (call, run.stderr)
        texts = [run.stdout]
        if kind == "integrals-certificate":
            texts = [path.read_text("utf-8") for path in tmp_path.glob("*.json")]
            assert len(texts) > 1
        for text in texts:
            check(kind, text)


# by kind and version: what its fields and types come to. Another value needs another version
FIELDS = {
    "certificate:2": "9dd12fab",
    "compare:2": "5dd33148",
    "connect:2": "e93da3bb",
    "design:2": "3aac89d6",
    "ensemble:1": "67a83169",
    "fit:2": "ce1ab856",
    "integrals-certificate:1": "14282135",
    "integrals:1": "248ed7ae",
    "judge:1": "f1390102",
    "linearize:2": "0ddd522d",
    "list:1": "9f5c9e92",
    "prove:1": "2c9baf44",
    "review:1": "01e7baa5",
    "show:1": "0ef760d0",
    "solve:2": "8d784957",
}


def bare(schema):
    """A schema without words, and without the order in which fields are named."""
    if isinstance(schema, dict):
        return {name: sorted(x) if name == "required" else bare(x) for name, x in schema.items() if name not in ("description", "title") or isinstance(x, dict)}
    return [bare(x) for x in schema] if isinstance(schema, list) else schema


def test_fields_and_types_change_only_with_the_version():
    derived = [json.loads(answer("schema", kind)) for kind in answer("schema").split()]
    digest = {s["$id"].removeprefix("urn:deltaq:"): sha256(json.dumps(bare(s), sort_keys=True).encode()).hexdigest()[:8] for s in derived}
    assert digest == FIELDS


def test_committed_verdicts_are_as_described():
    check("verdicts", (ROOT / "reports" / "verdicts.json").read_text("utf-8"))


WHOLE = """
format = 1
title = 'a'
[parameters]
g = '2*pi'
[coordinates]
x = { unit = 'm', start = 0 }
[system]
lagrangian = "x'^2"
constraints = []
[start]
project = true
[vakonomic]
multipliers = []
[removal.a]
parameters = ['x']
constants = 'zero'
[run]
duration = 1
"""
# what a schema can know to be wrong, keys and types; the rest is the reader's
BROKEN = {
    "format = 1": ["format = 2", "format = 0", "format = '1'"],
    "title = 'a'": ["title = 1", "tilte = 'a'", ""],
    "g = '2*pi'": ["g = true"],
    "x = { unit = 'm', start = 0 }": ["x = 0", "x = { unit = 'm', start = 0, begin = 1 }", "x = { unit = 1, start = 0 }", "x = { strt = 0 }"],
    "lagrangian = ": ["lagrangain = ", "lagrangian = 1\nforce = "],
    "constraints = []": ["constraints = 'x'", "constraints = [[]]"],
    "project = true": ["project = 0", "projects = true"],
    "multipliers = []": ["multiplier = []", "multipliers = 0"],
    "parameters = ['x']": ["parameters = 'x'", ""],
    "constants = 'zero'": ["constants = 'nil'", "constants = { end = 1 }"],
    "duration = 1": ["length = 1", ""],
}


def test_scene_files_are_as_the_editor_is_told():
    text = answer("new", "--schema")
    assert (ROOT / "docs" / "scene.schema.json").read_text("utf-8") == text, "deltaq new --schema > docs/scene.schema.json"
    Draft202012Validator.check_schema(json.loads(text))
    scenes = Draft202012Validator(json.loads(text))
    names = [scene["name"] for scene in json.loads(answer("list", "--format", "json"))["scenes"]]
    assert len(names) > 35
    for text in [answer("new"), WHOLE, *(answer("show", name, "--source") for name in [*names, "n-trailer-3"])]:
        scenes.validate(tomllib.loads(text))
    for sound, all_broken in BROKEN.items():
        assert WHOLE.count(sound) == 1
        for broken in all_broken:
            assert not scenes.is_valid(tomllib.loads(WHOLE.replace(sound, broken))), broken
