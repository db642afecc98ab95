"""Every built-in scene, its constraints written in other ways: same ending in every form and method.

    python validation/equivalence/forms.py target/release/deltaq [SCENE ...]

Each constraint is multiplied by -1, by 3 and by 1 + q0^2, given twice the other way round (row combinations:
f1 + f2, f2), and expanded into `(f)*(1 + 1) - (f)`. `deltaq solve` is asked for the same formulation, form and
method as for the scene as it is. Compared are exit code, status, the cause without numbers, and the coordinates
at the end within ten times both error estimates. Vakonomic multipliers are zero at the start, as others belong
to a writing. Lines are printed for what differs; the last one counts.
"""

import json
import re
import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SCENES = Path(__file__).parents[2] / "crates/scene/scenes"
FORMS = [("chetaev", "multipliers"), ("chetaev", "quasi-velocities"), ("vakonomic", "multipliers"),
         ("vakonomic", "costates"), ("vakonomic", "quasi-velocities")]
METHODS = ["auto", "dop853", "radau5"]
RELATIVE = 1e-9
# it rides straight, which is unstable (2.7 per second, for 20 s): round-off decides where it falls
UNSTABLE = {"bicycle"}


def writings(constraints, coordinate):
    """Names and lists of constraints."""
    each = lambda pattern: [pattern.format(f) for f in constraints]
    yield "sign", each("-({})")
    yield "factor", each("3*({})")
    yield "content", each(f"(1 + {coordinate}^2)*({{}})")
    yield "expansion", each("2*({0}) - ({0})")
    if len(constraints) > 1:
        yield "rows", [f"({constraints[0]}) + ({constraints[1]})", *constraints[1:]]


def text_of(name, old, new):
    """The scene with other constraints."""
    text = (SCENES / f"{name}.toml").read_text()
    for before, after in zip(old, new):
        quoted = json.dumps(before)
        assert quoted in text, (name, before)
        text = text.replace(quoted, json.dumps(after), 1)
    return text


def solved(program, text, formulation, form, method):
    """Exit code, status, cause without numbers, coordinates at the end, their estimates."""
    command = [program, "solve", "-f", formulation, "--form", form, "--method", method, "--format", "json",
               "--time-limit", "20", "--quiet", "-"]
    if formulation == "vakonomic":
        command += ["--mu0", ",".join("0" for _ in tomllib.loads(text)["system"]["constraints"])]
    done = subprocess.run(command, input=text, capture_output=True, text=True, timeout=120)
    numberless = lambda words: re.sub(r"[-+]?\d[\d.e+-]*", "#", words or "")
    if not done.stdout:
        return done.returncode, "refused", "", None, None
    answer = json.loads(done.stdout)
    ends = [column[-1] for column in answer["coordinates"].values()]
    errors = [column[-1] for column in answer["error_estimates"]["coordinates"].values()]
    # what the run ends by, without the names of what is small there
    cause = numberless(answer["cause"]).split(";")[0].split(" at ")[0]
    return done.returncode, answer["status"], cause, ends, errors


def differ(own, other):
    """What differs between two answers, in words."""
    if own[:2] != other[:2]:
        return f"{own[:3]} against {other[:3]}"
    if own[3] is None or own[1] == "stopped":
        return None
    for a, b, e, d in zip(own[3], other[3], own[4], other[4]):
        if abs(a - b) > 10 * (e + d) + RELATIVE * max(abs(a), 1):
            return f"ends at {a!r} against {b!r}, errors {e:.1e}, {d:.1e}"
    return None


def main():
    program, only = sys.argv[1], sys.argv[2:]
    tasks = []
    for path in sorted(SCENES.glob("*.toml")):
        scene = tomllib.loads(path.read_text())
        constraints = scene.get("system", {}).get("constraints", [])
        if not constraints or path.stem in UNSTABLE or only and path.stem not in only:
            continue
        coordinate = next(iter(scene["coordinates"]))
        for formulation, form in FORMS:
            for method in METHODS:
                tasks.append((path.stem, constraints, coordinate, formulation, form, method))

    def check(task):
        name, constraints, coordinate, formulation, form, method = task
        own = solved(program, (SCENES / f"{name}.toml").read_text(), formulation, form, method)
        found = []
        for writing, new in writings(constraints, coordinate):
            other = solved(program, text_of(name, constraints, new), formulation, form, method)
            found.append((writing, differ(own, other)))
        return task, found

    count = other = 0
    with ThreadPoolExecutor(2) as pool:
        for task, found in pool.map(check, tasks):
            for writing, difference in found:
                count += 1
                if difference:
                    other += 1
                    print(task[0], *task[3:], writing, difference, flush=True)
    print(f"{count} runs in other writings, {other} with another ending")
    sys.exit(other > 0)


if __name__ == "__main__":
    main()
