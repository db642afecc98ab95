"""How often the intervals of `deltaq fit` cover the truth, and how often its verdict is wrong.

    python coverage.py PROGRAM [--films 60] [--seed 1]

Films are made from equations by hand (`by_hand.py`): three systems by three laws (Chetaev, Chetaev with ε,
vakonomic), noise of 0.1 to 5 mm. Printed for each film: verdicts, and which intervals of 95 % cover; then totals.
"""

import argparse
import json
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from by_hand import SYSTEMS, film

LAWS = ["chetaev", "eps", "vakonomic"]
NOISE = [1e-4, 5e-4, 1e-3, 5e-3]


def ask(program, number, seed):
    """Film `number`: what it is, and the answer."""
    system, law = list(SYSTEMS)[number % 3], LAWS[number // 3 % 3]
    rng = np.random.default_rng([seed, number])
    sigma = NOISE[rng.integers(len(NOISE))]
    truth, times, rows = film(system, law, sigma, rng)
    columns = SYSTEMS[system][3]
    free = [name for name in truth if name not in ("eps", "mu0_1", "mu0_2")]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.csv"
        lines = [",".join(["t", *columns])] + [",".join(repr(float(x)) for x in [t, *row]) for t, row in zip(times, rows)]
        path.write_text("\n".join(lines) + "\n")
        call = [program, "fit", system, path, "--free", ",".join(free), "--law", "eps", "--sigma", repr(sigma), "--format", "json", "--quiet"]
        clock = time.monotonic()
        run = subprocess.run(call, capture_output=True, text=True)
        seconds = time.monotonic() - clock
    if run.returncode not in (0, 3):
        raise RuntimeError(run.stderr)
    return system, law, sigma, truth, json.loads(run.stdout), seconds


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--films", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    total = {"intervals": 0, "covering": 0, "eps intervals": 0, "eps covering": 0, "right": 0, "cannot tell": 0, "wrong": 0, "no verdict": 0}
    minimum = [0, 0]
    with ThreadPoolExecutor(options.threads) as pool:
        answers = pool.map(lambda number: ask(options.program, number, options.seed), range(options.films))
        for number, (system, law, sigma, truth, answer, seconds) in enumerate(answers):
            rows = {row["formulation"]: row for row in answer["formulations"]}
            right = rows[{"chetaev": "chetaev", "eps": "first-order", "vakonomic": "vakonomic"}[law]]
            rival = rows["chetaev" if law == "vakonomic" else "vakonomic"]
            missed = []
            for estimate in right["fit"]["estimates"] if right["fit"] else []:
                name = {"epsilon": "eps"}.get(estimate["name"], estimate["name"])
                low = -np.inf if estimate["low"] is None else estimate["low"]
                high = np.inf if estimate["high"] is None else estimate["high"]
                if low == -np.inf and high == np.inf:
                    continue
                covers = low <= truth[name] <= high
                kind = "eps " if name == "eps" else ""
                total[kind + "intervals"] += 1
                total[kind + "covering"] += covers
                if not covers:
                    missed.append(name)
            if law == "vakonomic":
                fit = right["fit"]
                minimum[0] += bool(fit and fit["chi_squared"] < fit["freedom"] + 6 * (2 * fit["freedom"]) ** 0.5)
                minimum[1] += 1
            if right["verdict"] == "none":
                verdict = "no verdict"
            elif right["verdict"] in ("excluded", "not-fitted"):
                verdict = "wrong"
            else:
                verdict = "right" if rival["verdict"] == "excluded" else "cannot tell"
            total[verdict] += 1
            chi = {name: round(row["fit"]["chi_squared"], 1) for name, row in rows.items() if row["fit"]}
            print(f"{number:3} {system:24} {law:10} {sigma * 1e3:.1f} mm {seconds:5.1f} s {verdict:12} missed {missed} {chi}", flush=True)
    print(total)
    print(f"intervals cover {total['covering']} of {total['intervals']}; right minimum of vakonomic films {minimum[0]} of {minimum[1]}")


if __name__ == "__main__":
    main()
