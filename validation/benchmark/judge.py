"""Compares motions of another program with the reference motions of this folder: `python judge.py FOLDER`.

FOLDER has, of as many systems as you like, `SYSTEM.csv` with the columns `formulation`, `start`, `t`, one of each coordinate
and, if you like, of each velocity; of as many formulations, starts and times of the references as you like, in any order.
The distance of an answer is `max |x - reference| / s` over its numbers, `s` the largest `|x|` of that column in the
references, or 1 where that is 0. Nothing but Python's own library is needed. Ends with 0 where all is within, with 1 where
something is not, with 2 where a file cannot be read.
"""

import argparse
import csv
import json
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
KEY = ["formulation", "start", "t"]
# Times that differ by no more, relative to 1 + |t|, are the same.
SAME_TIME = 1e-9


class Unreadable(Exception):
    """A file that cannot be read, with the place."""


def systems():
    """Of each system the columns of the state: coordinates, then velocities."""
    package = json.loads((HERE / "datapackage.json").read_text("utf-8"))
    fields = {r["name"]: [f["name"] for f in r["schema"]["fields"]] for r in package["resources"]}
    # the state is coordinates and as many velocities, which bear a prime
    return {name: [c for c in columns if c + "'" in columns or c.endswith("'")] for name, columns in fields.items()}


def rows(path, columns, all_of_them):
    """Lines of a table as `{(formulation, start): [(t, {column: number}, line)]}`."""
    found = {}
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file)
            names = reader.fieldnames or []
            needed = KEY + [c for c in columns if all_of_them or not c.endswith("'")]
            if missing := [c for c in needed if c not in names]:
                raise Unreadable(f"{path}: there is no column `{missing[0]}`")
            for row in reader:
                def number(column, path=path, row=row, line=reader.line_num):
                    try:
                        x = float(row[column])
                    except (TypeError, ValueError):
                        x = math.nan
                    if not math.isfinite(x):
                        raise Unreadable(f"{path}: line {line}, column `{column}`: `{row[column]}` is not a finite number")
                    return x
                state = {c: number(c) for c in columns if c in names}
                key = (row["formulation"], number("start"))
                found.setdefault(key, []).append((number("t"), state, reader.line_num))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Unreadable(f"{path}: {error}") from error
    return found


def at(motion, t):
    """The state of a reference at a time, or none."""
    return next((state for time, state, _ in motion if abs(time - t) <= SAME_TIME * (1 + abs(t))), None)


def judge(path, name, columns, within):
    """A line per formulation that is answered: what was answered, how far it is, what it is."""
    references = rows(HERE / f"{name}.csv", columns, True)
    answers = rows(path, columns, False)
    states = [state for motion in references.values() for _, state, _ in motion]
    size = {c: max(abs(state[c]) for state in states) or 1.0 for c in columns}
    formulations = list(dict.fromkeys(formulation for formulation, _ in references))
    farthest, counts = {}, {}
    for (formulation, start), motion in answers.items():
        for t, state, line in motion:
            if at(references.get((formulation, start), []), t) is None:
                raise Unreadable(f"{path}: line {line}: there is no {formulation} motion of start {start:g} at t = {t:g}")
            counts[formulation] = counts.get(formulation, 0) + 1
            for law in formulations:
                reference = at(references[law, start], t)
                far = max(abs(x - reference[c]) / size[c] for c, x in state.items())
                farthest[formulation, law] = max(far, farthest.get((formulation, law), 0.0))
    lines = []
    for formulation in counts:
        total = sum(len(motion) for (law, _), motion in references.items() if law == formulation)
        own = farthest[formulation, formulation]
        if own <= within:
            word = "within"
        else:
            others = [law for law in formulations if law != formulation and farthest[formulation, law] <= within]
            word = f"not within: it is the {' and the '.join(others)} motion" if others else "not within"
        lines.append((name, formulation, counts[formulation], total, own, word))
    return lines


def main(*arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--within", type=float, default=1e-6, metavar="DISTANCE", help="largest distance, 1e-6 if left out")
    options = parser.parse_args(arguments)
    try:
        known = systems()
        present = [name for name in known if (options.folder / f"{name}.csv").exists()]
        if not present:
            raise Unreadable(f"{options.folder}: there is no table of {', '.join(known)}")
        lines = [line for name in present for line in judge(options.folder / f"{name}.csv", name, known[name], options.within)]
        if not lines:
            raise Unreadable(f"{options.folder}: the tables have no lines")
    except Unreadable as error:
        print(error, file=sys.stderr)
        return 2
    for name, formulation, count, total, far, word in lines:
        print(f"{name:<18} {formulation:<19} {count:>3} of {total} states, {far:.1e}  {word}")
    good = sum(word == "within" for *_, word in lines)
    print(f"{good} of {len(lines)} within {options.within:g}")
    return 0 if good == len(lines) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
