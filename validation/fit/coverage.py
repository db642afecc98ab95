"""How often the intervals of `deltaq fit` cover the truth, and how often its verdict is wrong.

    python coverage.py PROGRAM [--films 60] [--seed 1] [--log films.jsonl] [--only turntable,slip]

Films are made from equations of our own (`systems.py`): twelve scenes by Chetaev's law, with ε, with slip, with a drag,
by the vakonomic law and by removal, noise of 0.1 to 5 mm or mrad. Printed for each film: the verdict, the intervals
of 95 % that miss, and χ² of each row, of the true numbers first; then totals over all films of the log, in which films
are looked up before they are made. A verdict is
WRONG where the law of the film is excluded, or alone supported where another is known to fit (`TWINS`).
`--only small-ball` and `--only lab-ball`: vakonomic films of balls of 2 cm on the turntable, whose motions are violent.
"""

import argparse
import json
import resource
import signal
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np
from scipy.stats import beta
from systems import COLUMNS, EPS, FREE, REMOVAL, SET, SYSTEMS, VIOLENT, film

SMOOTH = [name for name in SYSTEMS if name not in VIOLENT]
DRAGGED = ["sledge", "turntable", "unicycle-in-potential", "ball-on-incline"]
CASES = (
    [(name, law) for name in SMOOTH for law in ("chetaev", "vakonomic")]
    + [(name, law) for name in SMOOTH for law in ("eps", "slip") if SYSTEMS[name][EPS]]
    + [(name, "removed") for name in SMOOTH if SYSTEMS[name][REMOVAL]]
    + [(name, "drag") for name in DRAGGED]
)
# motions by Chetaev's law that are vakonomic ones: heisenberg with μ = 0, the disc with μ₀ = −m (x', y'), and the ball on
# the turntable, Ω unknown: with Ω = 0, μ₀ = −m (x', y'), ψ' = 2/5 of the true Ω it runs on the same circle
TWINS = ["heisenberg", "disc", "turntable"]
ROW = {"chetaev": "chetaev", "drag": "chetaev", "eps": "first-order", "slip": "first-order", "vakonomic": "vakonomic"}
NOISE = [1e-4, 5e-4, 1e-3, 5e-3]
PATIENCE = 60  # seconds of a processor per film


def processor():
    """Seconds of a processor that the programs run so far have taken."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def between(found, count):
    """Clopper and Pearson's interval of 95 %, in percent."""
    low = beta.ppf(0.025, found, count - found + 1) if found else 0.0
    high = beta.ppf(0.975, found + 1, count - found) if found < count else 1.0
    return f"{100 * low:.1f} to {100 * high:.1f} %"


def table(columns, times, rows):
    lines = [",".join(["t", *columns])] + [",".join(repr(float(x)) for x in [t, *row]) for t, row in zip(times, rows)]
    return "\n".join(lines) + "\n"


def fitted(program, scene, text, free, sigma, more=()):
    """The answer of `deltaq fit` to a film; a scene by name, or with a drag added to its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.csv"
        path.write_text(text)
        if "drag" in free:
            source = subprocess.run([program, "show", scene, "--source"], capture_output=True, text=True, check=True).stdout
            source = source.replace("[parameters]", "[parameters]\ndrag = 0", 1)
            force = '[system.forces]\nx = "-drag*x\'"\ny = "-drag*y\'"\n'
            scene = Path(folder) / f"{scene}.toml"
            scene.write_text(source.replace("[start.velocities]", force + "[start.velocities]", 1))
        for number in SET.get(scene, []):
            more = [*more, "--set", number]
        scene = "turntable" if scene in VIOLENT else scene
        call = [program, "fit", scene, path, "--free", ",".join(free), "--sigma", repr(sigma), "--threads", "1", *more]
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 5))  # noqa: E731
        run = subprocess.run([*call, "--format", "json", "--quiet"], capture_output=True, text=True, preexec_fn=limit)
    if run.returncode == -signal.SIGXCPU:
        raise TimeoutError
    if run.returncode not in (0, 3) or not run.stdout:
        raise RuntimeError(f"{call}: {run.stderr}")
    return json.loads(run.stdout)["formulations"]


def made(number, seed, cases):
    """Film `number`: scene, law, σ, what it asks for, the truth, times, rows."""
    scene, law = cases[number % len(cases)]
    rng = np.random.default_rng([seed, number])
    sigma = float(NOISE[rng.integers(len(NOISE))])
    more = ["--law", law if law in ("eps", "slip") else rng.choice(["eps", "slip"]) if law == "chetaev" and SYSTEMS[scene][EPS] else "eps"]
    if law == "drag":
        more += ["--formulations", "chetaev"]
    if law == "removed":
        more = ["--formulations", "chetaev,vakonomic,removed-constraint"]
    return (scene, law, sigma, more, *film(scene, law, sigma, rng))


def ask(program, number, seed, cases):
    """A line of the log: what the film is, the answer in short."""
    scene, law, sigma, more, numbers, times, rows, noise = made(number, seed, cases)
    free = [*SYSTEMS[scene][FREE], *(["drag"] if law == "drag" else [])]
    line = {"number": number, "seed": seed, "scene": scene, "law": law, "sigma": sigma, "truth": numbers, "asked": more}
    line["chi true"] = float(((noise / sigma) ** 2).sum())
    before = processor()
    try:
        answer = fitted(program, scene, table(SYSTEMS[scene][COLUMNS].split(), times, rows), free, sigma, more)
    except TimeoutError:
        return line | {"seconds": PATIENCE, "verdict": "too slow", "chi": {}, "intervals": [], "words": ""}
    line["seconds"] = round(processor() - before, 2)
    by_removal = lambda row: law == "removed" and f"({SYSTEMS[scene][REMOVAL][0]})" in row["label"]  # noqa: E731
    right = next(row for row in answer if row["formulation"] == ROW.get(law) or by_removal(row))
    line |= {"verdict": right["verdict"], "words": right["words"], "intervals": intervals(right, numbers)}
    line["chi"] = {row["label"]: row["fit"]["chi_squared"] if row["fit"] else row["words"] for row in answer}
    line["right"] = right["label"]
    first = next((row for row in answer if row["formulation"] == "first-order"), None)
    if law == "chetaev" and first:
        at_bound = intervals(first, {"eps": 0.0, "slip": 0.0})
        line["intervals"] += [(name + " = 0", *rest) for name, *rest in at_bound]
    line["tests"] = [test["name"] for test in (right["fit"] or {"tests": []})["tests"] if test["objects"]]
    return line


def intervals(row, numbers):
    """Name, whether the interval covers, profiled or not, of what films show."""
    found = []
    for estimate in row["fit"]["estimates"] if row["fit"] else []:
        name = {"epsilon": "eps"}.get(estimate["name"], estimate["name"])
        low, high = estimate["low"], estimate["high"]
        # no interval: nothing below, or the bound of ε and of slip, and nothing above
        if name not in numbers or high is None and (low is None or name in ("eps", "slip")):
            continue
        covers = (low is None or low <= numbers[name]) and (high is None or numbers[name] <= high)
        found.append((name, bool(covers), estimate["profiled"]))
    return found


def kind(name):
    return name if name.split()[0] in ("eps", "slip", "drag") else "μ₀ and P₀" if name[:2] in ("mu", "P0") else "others"


def report(line):
    missed = [name for name, covers, _ in line["intervals"] if not covers]
    chi = {label: round(x, 1) if isinstance(x, float) else x[:40] for label, x in line["chi"].items()}
    verdict = {"supported": "right", "cannot-tell": "cannot tell", "none": "no verdict", "excluded": "WRONG", "not-fitted": "not fitted"}
    line["verdict"] = verdict.get(line["verdict"], line["verdict"])
    if line["verdict"] == "right" and line["law"] == "chetaev" and line["scene"] in TWINS:
        line["verdict"] = "WRONG"
    print(f"{line['number']:3} {line['scene']:24} {line['law']:10} {line['sigma'] * 1e3:.1f} mm {line['seconds']:5.1f} s "
          f"{line['verdict']:12} missed {missed} {line['chi true']:.1f} {chi}", flush=True)  # fmt: skip


def totals(lines):
    covering, counted, verdicts = Counter(), Counter(), {}
    for line in lines:
        verdicts.setdefault(line["law"], Counter())[line["verdict"]] += 1
        for name, covers, profiled in line["intervals"]:
            for key in (kind(name), "profiled" if profiled else "by standard errors", "law: " + line["law"], "ALL"):
                counted[key] += 1
                covering[key] += covers
    print("intervals that cover")
    for key, count in counted.items():
        print(f"  {key:20} {covering[key]:5} of {count:5}, {100 * covering[key] / count:.1f} %, {between(covering[key], count)}")
    print("verdicts")
    for law, counter in verdicts.items():
        print(f"  {law:10}", dict(counter))
    for line in lines:
        least = line["chi"].get(line.get("right"))
        others = [x for label, x in line["chi"].items() if label != line.get("right")]
        if line["verdict"] in ("WRONG", "not fitted", "no verdict", "too slow"):
            print(f"film {line['number']} {line['scene']} {line['law']}: {line['verdict']}; {line['words']} {line.get('tests')}")
        elif least > line["chi true"] + 0.5:
            print(f"film {line['number']} {line['scene']} {line['law']}: least χ² missed, {least:.1f} for {line['chi true']:.1f} of the truth")
        if line["verdict"] == "cannot tell" and not any(isinstance(x, float) and x - least < 15 for x in others):
            print(f"film {line['number']} {line['scene']} {line['law']}: cannot tell without a rival; {line['chi']}")
    reached = [line for line in lines if isinstance(line["chi"].get(line.get("right")), float)]
    reached = sum(line["chi"][line["right"]] <= line["chi true"] + 0.5 for line in reached)
    wrong = sum(line["verdict"] == "WRONG" for line in lines)
    print(f"{wrong} wrong verdicts, {between(wrong, len(lines))}")
    seconds = sorted(line["seconds"] for line in lines)
    print(f"processor seconds a film: median {seconds[len(lines) // 2]}, most {seconds[-1]}, up to 1 s {sum(s <= 1 for s in seconds)}")
    print(f"{len(lines)} films; the least χ² is not above that of the truth in {reached}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--films", type=int, default=60)
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--log", type=Path, help="films that were asked for, one JSON object a line")
    parser.add_argument("--only", help="scenes and laws, separated by commas")
    options = parser.parse_args()
    words = options.only.split(",") if options.only else []
    cases = [case for case in CASES + [(name, "vakonomic") for name in VIOLENT] * bool(words) if all(word in case for word in words)]
    known = {}
    if options.log and options.log.exists():
        known = {line["number"]: line for line in map(json.loads, options.log.read_text().splitlines())}
    lines = []
    for number in range(options.start, options.start + options.films):
        line = known.get(number) or ask(options.program, number, options.seed, cases)
        if options.log and number not in known:
            with options.log.open("a") as log:
                log.write(json.dumps(line) + "\n")
        report(line)
        lines.append(line)
    totals(lines)


if __name__ == "__main__":
    main()
