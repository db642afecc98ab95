"""Judges the engines of this folder and writes a page: `python run.py DELTAQ PAGE`, `DELTAQ` the program.

In an environment with `requirements.txt`; any folder will do to run it in.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
STEPS = ["0.002", "0.001", "0.0005"]
ENGINES = [("MuJoCo", "mujoco"), ("PyBullet", "pybullet"), ("Rapier", "rapier"), ("PyDy", "pydy")]
# When a contact that was not pressed at the start has come to rest, s.
SETTLED = 1.0
# Ratios of numbers that are no farther from each other are alike.
ALIKE = 0.05

TITLE = "# Which law do rigid-body engines integrate?\n\n"
HEAD = """
A ball on a turning table, the scene `turntable`: an engine has a table on a driven joint, a ball, a contact with friction, and
the start of the scene; PyDy has the two constraints. Its motions, 500 samples in 5 s, from 1 s on, went to `deltaq judge`. Results depend on the settings
listed; they are not a criticism of the engines. Errors are those of the regression, one standard error. A law
that leaves more than 1 % of the forces does not fit; the numbers are then those of the law that leaves least, Chetaev's.

"""

TAIL = """
`slip` is 1/N, in s/kg for a ball of 1 kg: how fast the contact creeps per newton. `ε` is the trace of vakonomic mechanics, in s. `drag` is γ of a force −γ M v.
`constraint` is the rms of the velocity of slip beside that of its parts.

Again, in five lines:

```console
$ cargo build --release --package deltaq
$ python3 -m venv engines
$ engines/bin/pip install -r validation/judge/requirements.txt
$ engines/bin/python validation/judge/run.py target/release/deltaq reports/evidence/judge.md
$ cargo run --release -- reports --stamp evidence/judge.md
```
"""


def judged(deltaq, files):
    """The answer of `deltaq judge`, which ends with 3 where no law fits."""
    call = [deltaq, "judge", "turntable", *files, "--steps", ",".join(STEPS), "--format", "json"]
    answer = subprocess.run(call, capture_output=True, text=True)
    if answer.returncode not in (0, 3):
        sys.exit(answer.stderr)
    return json.loads(answer.stdout)


def settle(file):
    """Leaves out what was before the contact had settled."""
    head, *rows = Path(file).read_text().splitlines()
    rows = [row for row in rows if float(row.split(",", 1)[0]) >= SETTLED]
    Path(file).write_text("\n".join([head, *rows]) + "\n")


def number(found, digits=2):
    if found is None:
        return "–"
    return f"{found['value']:.{digits}e} ± {found['error']:.0e}"


def main(deltaq, page):
    text = "| engine | step | law | leaves | slip | ε | drag | constraint |\n| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n"
    notes, answers = "", []
    with tempfile.TemporaryDirectory() as folder:
        for name, package in ENGINES:
            files = [str(Path(folder) / f"{package}-{step}.csv") for step in STEPS]
            for step, file in zip(STEPS, files):
                call = [sys.executable, HERE / f"with_{package}.py", file, "--dt", step]
                said = subprocess.run(call, check=True, capture_output=True, text=True).stdout
                settings = {key: value for key, value in json.loads(said).items() if key not in ("dt", "end", "set")}
                engine = settings.pop("engine")
                settle(file)
            answer = judged(deltaq, files)
            for step, motion in zip(STEPS, answer["motions"]):
                found = motion["numbers"]
                least = min(law["residual"] for law in motion["laws"]) / motion["scale"]
                slipping = max(c["rms"] / c["parts"] for c in motion["constraints"])
                cells = [name, f"{float(step) * 1e3:g} ms", ", ".join(motion["fitting"]) or "none of these"]
                cells += [f"{least:.1e}", *(number(found[key]) for key in ("slip", "epsilon", "drag"))]
                text += "| " + " | ".join([*cells, f"{slipping:.1e}"]) + " |\n"
            slips = [motion["numbers"]["slip"] for motion in answer["motions"]]
            parts = slips[0]["value"] / slips[-1]["value"], float(STEPS[0]) / float(STEPS[-1])
            said = "no creep is seen"
            if all(abs(slip["value"]) > 1e-9 for slip in slips):
                said = "the contact creeps"
                said += " in proportion to the step" if abs(parts[0] / parts[1] - 1) < ALIKE else ""
                said += " whatever the step" if abs(parts[0] - 1) < ALIKE else ""
            laws = {", ".join(motion["fitting"]) or "none of these laws" for motion in answer["motions"]}
            answers.append(f"{name}: {' or '.join(sorted(laws))}, {said}.")
            if answer["order"] and "rtol" not in settings:
                said += f"; order in the step {answer['order']['order']:.2f}"
            settings = ", ".join(f"{key} = {value}" for key, value in settings.items())
            notes += f"- **{engine}**: {said}. Settings: {settings}.\n"
    Path(page).write_text(TITLE + f"**{' '.join(answers)}**\n" + HEAD + text + "\n" + notes + TAIL)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
