"""The referee: `python check.py JOB ANSWER`. Reads a job (JSON), compares, and writes the answer (JSON).

A job is {"scenes": [scene, ...]}; a scene {"name", "toml", "removals", "cases", "transcriptions", "lagranges_method"}, where `toml` is the text of
the scene and `removals` a text with all its removals; "decision" may hold what was decided of the multipliers. A case is one formulation: "formulation", "removal", "label", "tags" of the states, "samples" with
"states" (N x (1 + s): t, then y), "rates" (N x s), "multipliers" (N x h, Chetaev only), and "motion" with "tags", "start", "times", "coordinates",
"multipliers". The answer is {"rows": [row, ...]}, a row {"scene", "who", "what", "count", "largest", "tolerance", "verdict", "note"}.
"""

import json
import multiprocessing
import sys
import time

import numpy as np

import decision
import exceptional
import formulations
import trajectories
from reader import Scene

RATES_TOLERANCE = 1e-12
MOTION_TOLERANCE = 1e-8
MULTIPLIERS_TOLERANCE = 1e-6
# a referee whose own two runs are apart by more than MOTION_TOLERANCE agrees within their distance, if that is no more than this
COARSEST = 1e-5
# where a motion is further from theirs: it is compared as long as our two runs, at tolerances 1e-11 and 1e-13, are together within this
OWN_LIMIT = 1e-8
# instants whose matrix (rows and columns equilibrated) has a larger condition are left out
CONDITION_LIMIT = 1e8
EPSILON = np.finfo(float).eps


def row(scene, who, what, count, largest, tolerance, note=""):
    agrees = count > 0 and np.isfinite(largest) and largest <= tolerance
    verdict = "agrees" if agrees else "disagrees"
    largest = float(largest) if np.isfinite(largest) else None
    return {
        "scene": scene, "who": who, "what": what, "count": int(count), "largest": largest,
        "tolerance": tolerance, "verdict": verdict, "note": note,
    }  # fmt: skip


def failure(scene, who, what, error):
    note = f"{type(error).__name__}: {error}".splitlines()[0]
    return {"scene": scene, "who": who, "what": what, "count": 0, "largest": None, "tolerance": 0.0, "verdict": "failed", "note": note[:300]}


def compare_rates(name, case, instant):
    """Rates of all states and multipliers at the same states, relative to the largest of (rates, multipliers) of that instant."""
    samples = case["samples"]
    table = np.array(samples["states"], dtype=float)
    times, states = table[:, 0], instant.ordered(case["tags"], table[:, 1:])
    z, rates, condition = instant.solve(times, states)
    ours = instant.ordered(case["tags"], np.array(samples["rates"], dtype=float))
    theirs = rates
    if samples["multipliers"]:
        places = [place for _, _, place in instant.multipliers]
        ours = np.hstack([ours, np.array(samples["multipliers"], dtype=float)])
        theirs = np.hstack([theirs, z[:, places]])
    used = condition <= CONDITION_LIMIT
    size = np.maximum(np.abs(ours).max(axis=1), np.abs(theirs).max(axis=1))
    size[size == 0] = 1.0
    difference = np.abs(ours - theirs).max(axis=1) / size
    difference = np.where(used, difference, 0.0)
    worst = int(np.argmax(np.where(np.isnan(difference), np.inf, difference)))
    left_out = int((~used).sum())
    note = f"{left_out} nearly singular left out" if left_out else ""
    tolerance, excess = RATES_TOLERANCE, difference > RATES_TOLERANCE
    if excess.any() and (difference <= EPSILON * condition)[excess].all():
        # two solutions of one linear system in double precision differ by as much as that
        tolerance = 10.0 ** np.ceil(np.log10(EPSILON * condition[excess].max()))
        note = "; ".join(filter(None, [note, "round-off times the condition of the instant"]))
    what = "rates and multipliers" if samples["multipliers"] else "rates"
    answer = row(name, "CasADi", f"{case['label']}: {what}", used.sum(), difference[worst], tolerance, note)
    answer["condition"] = float(condition[worst])
    return answer


def compare_motion(name, case, instant, solver):
    motion = case["motion"]
    times, label = motion["times"], case["label"]
    found, again = trajectories.compare(instant, motion, solver)
    count, apart, notes = len(times), found.apart(len(times)), []
    tolerance = MOTION_TOLERANCE
    if not apart <= tolerance:
        found.their_looser = again()
        estimate = found.referees(count)
        if solver == "IDAS" and tolerance < estimate <= COARSEST:
            tolerance = 10.0 ** np.ceil(np.log10(estimate))
            notes.append(f"as close as {solver} is to itself at ten times its tolerance")
    if motion["until"]:
        notes.append(f"up to 98 % of the time until {motion['until']}")
    if not apart <= tolerance:
        # a motion that magnifies errors is not known better than our two runs agree, or the referee's
        while count > 2 and ((ours := found.own(count) > OWN_LIMIT) or found.referees(count) > tolerance):
            count -= 1
            whose = "our" if ours else f"{solver}'s"
        if count < len(times):
            notes = [f"up to t = {times[count - 1]:.4g}, where {whose} own two runs part by {OWN_LIMIT if ours else tolerance:.0e}"]
    note = "; ".join(notes)
    answers = [row(name, solver, f"{label}: motion", count, found.apart(count), tolerance, note)]
    answers[0]["drift"] = found.drift
    if found.has_multipliers:
        answers.append(row(name, solver, f"{label}: μ(t)", count, found.multipliers(count), tolerance, note))
    return answers


def check_case(name, scene, case):
    rows, label = [], case["label"]
    try:
        instant = formulations.derive(scene, case["formulation"], case["removal"])
        if case.get("samples"):
            rows.append(compare_rates(name, case, instant))
    except Exception as error:  # whatever it is, the answer contains it
        return [failure(name, "CasADi", f"{label}: equations", error)]
    for solver in case.get("solvers", []):
        try:
            rows.extend(compare_motion(name, case, instant, solver))
        except Exception as error:
            rows.append(failure(name, solver, f"{label}: motion", error))
    return rows


def check_decision(entry):
    """The set of all multipliers with which the vakonomic motion is Chetaev's: empty or not, its dimension, its element of least norm."""
    ours = entry["decision"]
    dimension, point, _ = decision.decide(entry["toml"], ours["start"])
    point = np.array(point, dtype=float)
    same = dimension == ours["dimension"]
    apart = float(np.linalg.norm(point - ours["point"]) / max(1.0, np.linalg.norm(point))) if same else np.inf
    note = "empty" if dimension is None else f"dimension {dimension}"
    return row(entry["name"], "power series", "multipliers of Chetaev's motion", 1, apart, MULTIPLIERS_TOLERANCE, note)


def check_scene(entry):
    clock, name, rows = time.perf_counter(), entry["name"], []
    for case in entry["cases"]:
        text = entry["removals"] if case["removal"] is not None and case["automatic"] else entry["toml"]
        rows.extend(check_case(name, Scene(text), case))
    for case in entry.get("transcriptions", []):
        import transcription

        text = entry["removals"] if case["removal"] is not None and case["automatic"] else entry["toml"]
        try:
            rows.extend(row(name, *found) for found in transcription.compare(Scene(text), case))
        except Exception as error:
            rows.append(failure(name, "transcription", f"{case['label']}: action", error))
    if entry.get("lagranges_method"):
        import lagranges_method

        for case in entry["cases"]:
            if case["formulation"] == "chetaev" and case.get("samples"):
                try:
                    rows.append(row(name, *lagranges_method.compare(Scene(entry["toml"]), case, entry["lagranges_method"])))
                except Exception as error:
                    rows.append(failure(name, "SymPy", "Chetaev: accelerations", error))
    if entry.get("decision"):
        try:
            rows.append(check_decision(entry))
        except Exception as error:
            rows.append(failure(name, "power series", "multipliers of Chetaev's motion", error))
        if name in exceptional.STATED:
            try:
                rows.append(row(name, *exceptional.check(name, entry["toml"])))
            except Exception as error:
                rows.append(failure(name, "SymPy", exceptional.WHAT, error))
    return {"rows": rows, "scene": name, "seconds": time.perf_counter() - clock}


def main(job_path, answer_path):
    with open(job_path, encoding="utf-8") as file:
        scenes = json.load(file)["scenes"]
    order = sorted(range(len(scenes)), key=lambda i: -len(json.dumps(scenes[i]["toml"])))
    with multiprocessing.Pool(multiprocessing.cpu_count()) as pool:
        found = pool.map(check_scene, [scenes[i] for i in order], chunksize=1)
    answers = [found[order.index(i)] for i in range(len(scenes))]
    with open(answer_path, "w", encoding="utf-8") as file:
        json.dump({"scenes": answers, "rows": [r for answer in answers for r in answer["rows"]]}, file)


if __name__ == "__main__":
    main(*sys.argv[1:])
