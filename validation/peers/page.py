"""The page `peers.md`."""

import math
import re

from problems import MEMBERS
from race import OURS, TARGETS, short

BY_HAND = "heyoka, reduced by hand"
# the error that verdicts are about
TARGET = 1e-10
# how much less time ours needs from the text of a scene to a trajectory
TOTAL = 50


def demanded(row):
    """How much faster ours has to be than the peer of a row: not slower than heyoka, three times as fast as
    any other.
    """
    return 1 if row.startswith("heyoka") else 3


def least(race, row, of, task="trajectory", target=TARGET):
    """The rung of a row that needs least of something at an error of at most `target`."""
    fit = [rung for rung in race.rungs if (rung.row, rung.task) == (row, task) and rung.error <= target]
    return min((rung for rung in fit if math.isfinite(of(rung))), key=of, default=None)


def ms(seconds):
    """Milliseconds with three significant digits at most."""
    x = 1e3 * seconds
    if not math.isfinite(x):
        return "–"
    digits = [digits for bound, digits in ((99.5, 0), (9.95, 1), (0.995, 2), (0.0995, 3)) if x >= bound]
    return f"{x:.{digits[0]}f}" if digits else short(x, 2)


def table(head, rows, column="---:|"):
    lines = [[""] + head] + rows
    written = ["| " + " | ".join(cells).lstrip() + " |" for cells in lines]
    return "\n".join([written[0].replace("|  |", "| |", 1), "|---|" + column * len(head)] + written[1:])


def grid(races, cell, column="---:|"):
    """A row for every row of the races, a column for every race."""
    rows = dict.fromkeys(rung.row for race in races for rung in race.rungs)
    return table([race.case.title for race in races], [[row] + [cell(race, row) for race in races] for row in rows], column)


def seconds(rung):
    return rung.seconds


def beside_ours(races, of, wanted):
    """Milliseconds of every row, how many times those of ours, and whether that is what was wanted."""

    def cell(race, row):
        theirs, ours = least(race, row, of), least(race, OURS, of)
        if theirs is None:
            return "not reached"
        if ours is None or row.startswith(OURS):
            return ms(of(theirs))
        ratio = of(theirs) / of(ours)
        return f"{ms(of(theirs))} (× {ms(ratio / 1e3)}, {'met' if ratio >= wanted(row) else '**missed**'})"

    return grid(races, cell)


def three(races, task):
    def cell(race, row):
        rungs = [least(race, row, seconds, task, target) for target in TARGETS]
        return " / ".join(ms(rung.seconds) if rung else "–" for rung in rungs)

    return grid(races, cell)


def settings(races):
    def cell(race, row):
        rung = least(race, row, seconds)
        return f"{rung.method}, {short(rung.tolerance)}: {short(rung.error)}" if rung else "–"

    return grid(races, cell, "---|")


def by_hand(races):
    """Every problem that heyoka has reduced by hand: its time, ours, and the ratio."""
    lines = []
    for race in races:
        theirs, ours = least(race, BY_HAND, seconds), least(race, OURS, seconds)
        if BY_HAND not in race.setups:
            continue
        if theirs is None or ours is None:
            lines.append([race.case.title, *("not reached" if rung is None else ms(rung.seconds) for rung in (theirs, ours)), "–", "–", "–"])
            continue
        ratio = theirs.seconds / ours.seconds
        setting = lambda rung: f"{rung.method}, {short(rung.tolerance)}: {short(rung.error)}"
        verdict = f"{ms(ratio / 1e3)}, {'met' if ratio >= 1 else '**missed**'}"
        lines.append([race.case.title, ms(theirs.seconds), ms(ours.seconds), verdict, setting(theirs), setting(ours)])
    return table(["heyoka, ms", "deltaq, ms", "ratio", "heyoka", "deltaq"], lines)


def set_up(races):
    """Set-up of the fastest setting: derivation, then compilation and what else comes before the first run."""

    def cell(race, row):
        rung = least(race, row, seconds)
        if rung is None or row.startswith(OURS):
            return ms(rung.total - rung.seconds) if rung else "–"
        return f"{ms(rung.setup)} + {ms(rung.prepare)}"

    return grid(races, cell)


def derivations(races):
    """Derivations that end without a motion: SymPy's."""
    rows = []
    for race in races:
        if ("sympy", "scene") not in race.case.entrants:
            continue
        cells = [f"{ms(race.setups[row])} ms" if row in race.setups else "–" for row in ("SymPy", OURS)]
        refused = [words for row, _, words in race.failures if row == "SymPy"]
        rows.append([race.case.title, refused[0] if refused and cells[0] == "–" else cells[0], cells[1]])
    return table(["SymPy, `LagrangesMethod`", "deltaq, derivation and compilation"], rows)


def page(races, provenance):
    """The page; in its tables the minus of an exponent is U+2212, where no line breaks."""
    lines = written(races, provenance).split("\n")
    return "\n".join(re.sub(r"(?<=\d)e-(?=\d)", "e\u2212", line) if line.startswith("|") else line for line in lines)


def written(races, provenance):
    """The page; `provenance` has date, commit, seconds, machine, effort, ours and versions."""
    scenes = [race for race in races if not race.case.trailers and not race.case.vary]
    trains = [race for race in races if race.case.trailers and race.rungs]
    solve, total = beside_ours(scenes, seconds, demanded), beside_ours(scenes, lambda rung: rung.total, lambda row: TOTAL)
    met = [(text.count(", met)"), text.count(", met)") + text.count("**missed**")) for text in (solve, total)]
    failures = [(race.case.title, *failure) for race in races for failure in race.failures]
    failures += [(race.case.title, "all", "reference", race.reference) for race in races
                 if race.reference != "not timed" and isinstance(race.reference, str)]
    words = lambda text: text.replace("|", "\\|").replace("\n", " ")
    confirmed = [race for race in races if not isinstance(race.reference, str)]
    on_trains = f"""Milliseconds of one run to an error of {short(TARGET)}.

{beside_ours(trains, seconds, demanded)}

Derivation + compilation, milliseconds:

{set_up(trains)}

Method, tolerance and error:

{settings(trains)}"""
    return f"""# The same problems in other tools

**Solve time: {met[0][0]} of {met[0][1]} comparisons meet what was wanted; from scene file to trajectory: {met[1][0]} of {met[1][1]}.**

{INTRODUCTION}
## Solve time to an error of {short(TARGET)}

Milliseconds of one run (times those of ours; wanted: at least 1 for heyoka, 3 for any other).

{solve}

Method, tolerance and error of these:

{settings(scenes)}

To errors of {" / ".join(map(short, TARGETS))}:

{three(scenes, "trajectory")}

The same where only the end is wanted, with the error there:

{three(scenes, "end")}

## Beside heyoka, reduced by hand

Milliseconds of a motion to an error of {short(TARGET)}, without heyoka's time to compile, which is below; wanted: a ratio of at least 1. {MEMBERS} at a \
time are {MEMBERS} motions from other starts in one call on one thread, heyoka's in its batch mode, ours by `System.ensemble` with one run each; the time is \
that of one of them, the error the largest of all.

{by_hand(races)}

## Set-up

Milliseconds for the settings above: derivation + compilation.

{set_up(scenes)}

The derivation alone, by the tool that has a class for it (nothing is integrated):

{derivations(races)}

## From scene file to trajectory

Milliseconds for derivation, compilation and one run, of the setting for which the sum is least (times those of ours; wanted: at least {TOTAL}).

{total}

## Car with n trailers

{on_trains if trains else "Not timed in this run: `cargo xtask peers --only trailers`."}

## Error over time

{"".join(f"![{race.case.title}](peers-{race.case.name}.svg){2 * chr(10)}" for race in races if race.rungs and not race.case.vary)}## What was not measured, and why

<details><summary>{len(failures)} settings</summary>

| problem | who | what | what became of it |
|---|---|---|---|
{"".join("| " + " | ".join(map(words, failure)) + " |" + chr(10) for failure in failures)}
</details>

## Checks

| problem | our DOP853 at 1e-14 from the reference | right-hand sides at the start, largest relative difference from ours |
|---|---:|---:|
{"".join(f"| {race.case.title} | {short(race.reference, 1)} | {short(max(race.checks.values()), 1)} |{chr(10)}" for race in confirmed)}
## How this was made

`cargo xtask peers` on {provenance["date"]}, commit {provenance["commit"]}, in {provenance["seconds"]:.0f} s; {provenance["machine"]}. \
{provenance["effort"].rounds} turns of at least {provenance["effort"].repeat} s for each time that counts, a limit of {provenance["effort"].limit} s on \
each step of each tool, one thread.

{", ".join(f"{name} {version}" for name, version in provenance["versions"].items())}. Licences: {LICENCES}
"""


LICENCES = """\
heyoka MPL-2.0; CasADi LGPL-3.0, with SUNDIALS BSD-3-Clause; NumPy, SciPy, SymPy and mpmath BSD-3-Clause; numba and llvmlite BSD-2-Clause. \
They are run, and nothing of ours is linked with them."""

INTRODUCTION = r"""Every tool gets the text of the scene (heyoka also equations reduced by hand, and of the car with trailers all others, ours also a text \
with a place for every body), derives and compiles in its own way, in the best form that we know for it, and must have our right-hand side at the start to 1e-12, or \
it is not timed. All are driven from Python, ours through its module, each in a process of its own. A trajectory is the coordinates at 21 equidistant \
times. Its error is the largest of them in the kinetic metric $\sqrt{\Delta q^{\mathsf T} M \Delta q}$ against heyoka's Taylor method in 113 bits at \
1e-28, which our own integration confirms. A time is the least of repeated runs, tools taking turns; a tolerance is relative and absolute alike, and the \
fastest setting that reaches the error counts. Free constants of the removed-constraint motion are given to all, ours too. Imports and process starts are \
not counted. Our set-up is measured as part of a whole; for the others the parts are added up.

- **deltaq**: one run of the time loop with projection onto the constraint, dense output everywhere, by the module's own clock, which leaves out the call \
from Python; `solve` is what users call, with a second run at a hundredth of the tolerance as error estimate.
- **heyoka**: its own differentiation, elimination in expressions, one function a step or compact mode, with `fast_math`; or closed forms simplified by \
SymPy, whose time counts as set-up. *Reduced by hand* (`validation/peers/by_hand.py`): quasi-velocities; of the vakonomic sledge the known costates, of the \
sledge without constraint the cyclic momentum put in, of the cone momenta of the turn rates; angular momenta that never change are numbers. A quantity that the \
scene does not have is differentiated along our rates for the check. It compiles anew for every tolerance.
- **SciPy**: `solve_ivp` (DOP853, LSODA, Radau), SymPy's derivation, straight-line code for the right-hand side as Python or by numba; *compiled whole*: \
DOP853 with SciPy's tableau, step control and dense output as one numba function.
- **CasADi**: SX expressions; CVODES (Adams, BDF) with the unknowns eliminated, IDAS with the equations as they stand.
""".replace("\\\n", "")
