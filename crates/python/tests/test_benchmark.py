"""Reference motions for other programs: ours in double precision come near them, and what is wrong is seen."""

import csv
import importlib.util
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import deltaq

FOLDER = Path(__file__).resolve().parents[3] / "validation/benchmark"


def module(name):
    specification = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    loaded = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(loaded)
    return loaded


judge, example = module("judge"), module("example")
SYSTEMS = judge.systems()


def table(name):
    with open(FOLDER / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def write(folder, name, lines):
    with open(folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, lines[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)


def scene(name):
    return next((FOLDER.parents[1] / "crates/scene").glob(f"*/{name}.toml"))


def solved(name, lines):
    """Answers to the lines of one motion, the start among them."""
    start, times = lines[0], [float(line["t"]) for line in lines]
    given = tomllib.loads(scene(name).read_text("utf-8"))["start"]["velocities"]
    coordinates = [c for c in SYSTEMS[name] if not c.endswith("'")]
    changes = {c: float(start[c]) for c in [*coordinates, *given]}
    constants = {"mu0": [], "constants": []}
    for column, value in start.items():
        if re.match(r"mu0_\d|P0_", column) and value:
            constants["mu0" if column.startswith("mu0") else "constants"].append(float(value))
    constants = {key: values for key, values in constants.items() if values}
    system = deltaq.built_in(name, changes)
    motion = system.solve(start["formulation"], times, tolerance=1e-12, project=False, **constants)
    states = np.hstack([motion.coordinates, motion.velocities])
    keys = [{key: line[key] for key in judge.KEY} for line in lines]
    return [key | dict(zip(SYSTEMS[name], map(repr, map(float, state)))) for key, state in zip(keys, states)]


@pytest.mark.parametrize("name", SYSTEMS)
def test_motions_in_double_precision_are_within(name, tmp_path, capsys):
    lines = table(name)
    motions = [[line for line in lines if (line["formulation"], line["start"]) == key]
               for key in dict.fromkeys((line["formulation"], line["start"]) for line in lines)]
    assert len(motions) == 30
    write(tmp_path, name, [answer for motion in motions for answer in solved(name, motion)])
    code = judge.main(str(tmp_path), "--within", "1e-8")
    said = capsys.readouterr().out
    assert code == 0 and said.endswith("3 of 3 within 1e-08\n") and said.count("50 of 50 states") == 3, said


def test_the_example_by_hand_is_within(tmp_path, capsys):
    example.main(tmp_path)
    assert judge.main(str(tmp_path)) == 0
    assert re.search(r"chetaev +50 of 50 states, \d.\de-1[0-9]  within", said := capsys.readouterr().out), said


def test_another_law_is_named_and_a_digit_is_seen(tmp_path, capsys):
    answers = [line | {"formulation": "chetaev"} for line in table("disc") if line["formulation"] == "vakonomic"]
    write(tmp_path, "disc", answers)
    assert judge.main(str(tmp_path)) == 1
    assert "not within: it is the vakonomic motion" in capsys.readouterr().out
    answers = table("disc")
    answers[7]["x"] = repr(float(answers[7]["x"]) * (1 + 1e-5) + 1e-5)
    write(tmp_path, "disc", answers)
    assert judge.main(str(tmp_path)) == 1
    said = capsys.readouterr().out
    assert "disc               chetaev              50 of 50 states" in said and said.endswith("2 of 3 within 1e-06\n"), said


@pytest.mark.parametrize("change, said", [
    ({"formulation": "gauss"}, "line 2: there is no gauss motion of start 1 at t = 0"),
    ({"t": "0.123"}, "there is no chetaev motion of start 1 at t = 0.123"),
    ({"y": "nan"}, "line 2, column `y`: `nan` is not a finite number"),
])
def test_what_cannot_be_compared_is_refused_with_its_place(change, said, tmp_path, capsys):
    write(tmp_path, "sledge", [table("sledge")[0] | change])
    assert judge.main(str(tmp_path)) == 2
    assert said in capsys.readouterr().err
    write(tmp_path, "sledge", [{k: v for k, v in table("sledge")[0].items() if k != "phi"}])
    assert judge.main(str(tmp_path)) == 2
    assert "there is no column `phi`" in capsys.readouterr().err
    assert judge.main(str(tmp_path / "nothing")) == 2
