"""`cargo xtask peers`: times ours and the peers, writes `reports/evidence/peers.md` with its pictures, and everything
that was measured as JSON.
"""

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

# scenes are read by the reader of the other referee
sys.path.insert(0, str(Path(__file__).parents[1] / "casadi"))

from page import data, page
from picture import picture
from problems import problems
from race import QUICK, Effort, Race

PACKAGES = ("deltaq", "casadi", "heyoka", "numba", "numpy", "scipy", "sympy")


def said(*command):
    """What a program says, or that it is not known."""
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    return found.stdout.strip() if found.returncode == 0 else "unknown"


def processor():
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown")


def write(folder, files):
    """Whole or not at all: beside their places first and then moved."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.with_name(f".{path.name}").write_text(text)
    for name in files:
        path = folder / name
        os.replace(path.with_name(f".{path.name}"), path)
    print(", ".join(str(folder / name) for name in files))


def pictures(measured):
    """Of the problems with one motion at a time, from what was measured, as it is kept."""
    names = {case.title: case.name for case in problems() if not case.vary}
    drawn = [problem for problem in measured if problem["problem"] in names and problem["rungs"]]
    return {f"evidence/peers-{names[problem['problem']]}.svg": picture(problem["problem"], problem["rungs"]) for problem in drawn}


def main():
    parser = argparse.ArgumentParser("cargo xtask peers", description="The same problems in other tools, timed beside ours.")
    parser.add_argument("--quick", action="store_true", help="few tolerances and few repeats: for a look, not for figures that are kept")
    parser.add_argument("--only", metavar="TEXT,…", default="", help="only problems whose file names contain one of these")
    parser.add_argument("--redraw", action="store_true", help="no times: the pictures again, from what the last run measured")
    parser.add_argument("--out", metavar="DIR", type=Path, help="folder of the page: `reports` for a full run, that of build results for any other")
    parser.add_argument("--target", type=Path, required=True, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    kept = arguments.target / "peers.json"
    if arguments.redraw:
        return write(arguments.out or Path("reports"), pictures(json.loads(kept.read_text())["problems"]))
    begin, effort = time.monotonic(), QUICK if arguments.quick else Effort()
    races = []
    with tempfile.TemporaryDirectory() as home:
        # no compiled code of an earlier run is found in an empty home
        os.environ["HOME"] = home
        os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
        for case in problems():
            if any(text in case.name for text in arguments.only.split(",")):
                since = time.monotonic()
                races.append(race := Race(case, effort))
                found = f"{len(race.rungs)} timed, {len(race.failures)} failures"
                print(f"{case.title:<24} {found}, {time.monotonic() - since:.0f} s", flush=True)
    commit, changed = said("git", "rev-parse", "--short=12", "HEAD"), said("git", "status", "--porcelain", "--untracked-files=no")
    provenance = {
        "versions": {name: version(name) for name in PACKAGES},
        "commit": commit + (" with changes" if changed else ""),
        "machine": f"{processor()}, {os.cpu_count()} processors, {platform.system().lower()} {platform.machine()}",
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "effort": effort,
        "seconds": time.monotonic() - begin,
    }
    fields = ("reference", "setups", "checks", "rungs", "failures")
    measured = [{"problem": race.case.title} | {name: getattr(race, name) for name in fields} for race in races]
    text = json.dumps(provenance | {"effort": effort._asdict(), "problems": measured}, indent=1, default=vars)
    write(kept.parent, {kept.name: text + "\n"})
    whole = not arguments.quick and not arguments.only
    files = {"evidence/peers.md": page(races, provenance)} | data(races).files() | pictures(json.loads(text)["problems"])
    return write(arguments.out or (Path("reports") if whole else arguments.target), files)


if __name__ == "__main__":
    main()
