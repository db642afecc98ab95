"""A tool as a process that is asked on standard input and answers on standard output, one JSON object a line.

    {"do": "setup", "case": {...}}                                        -> {"seconds", "methods"}
    {"do": "rates"}                                                       -> {"tags", "rates"}: rates of the states at the start
    {"do": "prepare", "method": M, "tolerance": e, "task": T}             -> {"seconds"}: what has to be done anew for a method and a tolerance
    {"do": "run", "method": M, "tolerance": e, "task": T, "repeat": s}    -> {"seconds", "repeats", "coordinates"}
    {"do": "version"}                                                     -> {"versions"}

The task "trajectory" wants the coordinates at all times of the case, "end" at the last one only. What fails answers {"failure": words}.
"""

import json
import os
import sys
from importlib.metadata import version

import numpy as np

import clock
from reader import Scene


def tool(name):
    """A tool has PACKAGES and

    methods(case), their names; setup(case, scene), the derivation, which hands back seconds that do not count; rates(), (tags, rates) at the start;
    shared(method), a name and a call, what else has to be done once for several tolerances or methods; prepare(method, tolerance, times), what else has to be done before a run; run(method, tolerance, times), a call that integrates and hands
    back a table of states at the times, and a function from that table to one of coordinates.
    """
    if name == "heyoka":
        from with_heyoka import Tool
    elif name == "scipy":
        from with_scipy import Tool
    elif name == "casadi":
        from with_casadi import Tool
    elif name == "sympy":
        from with_sympy import Tool
    else:
        raise ValueError(f"no tool {name!r}")
    return Tool()


def answer(it, request, state):
    if request["do"] == "version":
        return {"versions": {package: version(package) for package in it.PACKAGES}}
    if request["do"] == "setup":
        case = state["case"] = request["case"]
        state["shared"] = {}
        seconds, uncounted = clock.once(lambda: it.setup(case, Scene(case["toml"])))
        return {"seconds": seconds - uncounted, "methods": it.methods(case)}
    if request["do"] == "rates":
        tags, rates = it.rates()
        return {"tags": tags, "rates": [float(x) for x in rates]}
    times = state["case"]["times"]
    method, tolerance = request["method"], request["tolerance"]
    asked = [times[0], times[-1]] if request["task"] == "end" else times
    if request["do"] == "prepare":
        # what serves several tolerances counts for each of them
        key, work = it.shared(method)
        if key not in state["shared"]:
            state["shared"][key] = clock.once(work)[0]
        return {"seconds": state["shared"][key] + clock.once(lambda: it.prepare(method, tolerance, asked))[0]}
    call, coordinates = it.run(method, tolerance, asked)
    seconds, repeats, table = clock.least(call, request["repeat"])
    table = np.asarray(table, dtype=float)
    if table.shape[0] != len(asked) or not np.isfinite(table).all():
        raise ValueError("the answer is incomplete or not finite")
    return {"seconds": seconds, "repeats": repeats, "coordinates": coordinates(table).tolist()}


def main():
    # whatever a library prints, from C++ too, goes to standard error
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    it, state = tool(sys.argv[1]), {}
    for line in sys.stdin:
        try:
            said = answer(it, json.loads(line), state)
        except Exception as error:  # a failure of a tool is a result, listed on the page
            # CasADi says where first, and at the end what happened
            words = str(error).strip().splitlines()
            said = {"failure": f"{type(error).__name__}: {words[-1] if words else ''}"[:200]}
        print(json.dumps(said), file=out, flush=True)


if __name__ == "__main__":
    main()
