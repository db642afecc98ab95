"""One object of each class, and every method of it from eight threads at once; a freeze ends with the stacks.

A second long, or `ROUNDS` of them, whatever time they take."""

import faulthandler
import os
import pickle
import sys
import threading
import time

import deltaq
import numpy as np

THREADS, ROUNDS = 8, int(os.environ.get("ROUNDS", "0"))
SECONDS, FROZEN = (1e9, 36_000.0) if ROUNDS else (1.0, 100.0)
# seldom otherwise: a thread that gives Python's lock up finds another one that waits for it
sys.setswitchinterval(1e-5)
faulthandler.dump_traceback_later(FROZEN, exit=True)

times = np.linspace(0.0, 0.5, 6)
system, heisenberg, steady = map(deltaq.built_in, ("sledge", "heisenberg", "bicycle"))
start = system.start
film = {"t": np.linspace(0, 1, 12), "x": 0.4 * np.linspace(0, 1, 12)}
equations = system.equations("vakonomic")
y, mu = equations.initial_state(), np.zeros(1)
motion = system.solve("chetaev", times)
again = pickle.loads(pickle.dumps(motion))
residuals = system.residuals(["phi'"], times[1:], {"phi": times[1:]})
fitted = system.fit(film, free=["phi'"], sigma=1e-2, starts=1, formulations=["chetaev"])._fitted
comparison = system.compare()
connections = heisenberg.connect({"x": 0.2, "y": 0.5, "z": 0.9}, 1.0, starts=1)
objects = [system, start, equations, motion, again, residuals, fitted, comparison, connections]
objects += [*comparison.pairs[:1], *comparison.decided[:1], *comparison.runs[:1], *connections.motions[:1]]
objects += [equations.outputs(0.0, y), equations.integrate(times), system.ensemble(vary={"g": [9.0]})]
objects += [steady.linearize(), steady.linearize_over({"v": [1.0, 2.0]})]

# what takes long, once a thread
LONG = {
    ("System", "compare"): lambda s: s.compare(),
    ("System", "connect"): lambda s: heisenberg.connect({"x": 0.2, "y": 0.5, "z": 0.9}, 1.0, starts=1),
    ("System", "design"): lambda s: s.design(
        ("chetaev", "vakonomic"), film="5Hz,1mm,1s", over={"phi'": (0.5, 2)}, free=["x'"], points=1, columns=["x"], starts=1
    ),
    ("System", "fit"): lambda s: s.fit(film, free=["phi'"], sigma=1e-2, starts=1, formulations=["chetaev"]),
    ("System", "prove"): lambda s: s.prove(),
    ("System", "_sweep_points"): lambda s: s._sweep_points(["g"], [9.0], None, True, 1e-9, 10_000, None, None, 1),
}
SHORT = {
    ("System", "constraint"): lambda s: s.constraint(0.0, start.q, start.v),
    ("System", "ensemble"): lambda s: s.ensemble("chetaev", [0.1], vary={"g": [9.0, 10.0]}, threads=1),
    ("System", "equations"): lambda s: s.equations("chetaev"),
    ("System", "integrals"): lambda s: s.integrals(degree=1),
    ("System", "linearize"): lambda s: s.linearize(at=0.0),
    ("System", "linearize_over"): lambda s: steady.linearize_over({"v": [1.0]}),
    ("System", "mass"): lambda s: s.mass(0.0, start.q, start.v),
    ("System", "replace"): lambda s: s.replace({"g": 9.0}),
    ("System", "residuals"): lambda s: s.residuals(["g"], times[1:], {"phi": times[1:]}),
    ("System", "solve"): lambda s: s.solve("chetaev", times),
    ("System", "_moving"): lambda s: s._moving([("a", "chetaev", times, motion.coordinates)]),
    ("Equations", "acceleration"): lambda e: e.acceleration(0.0, start.q, start.v, mu),
    ("Equations", "integrate"): lambda e: (e.integrate(times), e.integrate(times, parameters={"g": 9.0})),
    ("Equations", "jacobian"): lambda e: e.jacobian(0.0, y),
    ("Equations", "outputs"): lambda e: e.outputs(0.0, y),
    ("Equations", "rates"): lambda e: (e.rates(0.0, y), e.rates(0.0, y, {"g": 9.0})),
    ("Motion", "at"): lambda m: m.at([0.1, 0.2]),
    ("Residuals", "jac"): lambda r: (r([1.0]), r.jac([1.0])),
    ("Comparison", "pair"): lambda c: c.pair("chetaev", "vakonomic"),
    ("Comparison", "verdict"): lambda c: c.verdict("chetaev", "vakonomic"),
    ("_Fitted", "chi_squared"): lambda f: f.chi_squared(0, [1.0]),
    ("_Fitted", "residuals"): lambda f: f.residuals(0),
    ("_Fitted", "rises"): lambda f: f.rises(0, "phi'", [1.0]),
    ("_Fitted", "slopes"): lambda f: f.slopes(0, [1.0]),
    ("_Fitted", "unknowns"): lambda f: f.unknowns(0),
}
# written in Python, of what others have
OTHERS = {"plot", "animate", "to_arrow", "to_pandas", "to_xarray", "_fit", "_design", "_certificate", "_integrals", "_review", "_review_states", "_residuals", "_with", "_again"}


def calls(thing):
    """Every attribute and method, the long ones last, as functions."""
    kind, long = type(thing).__name__, []
    yield lambda: repr(thing)
    if kind != "_Fitted":
        yield lambda: pickle.loads(pickle.dumps(thing))
    for name in dir(thing):
        if name.startswith("__") or name == "_repr_html_" or name in OTHERS:
            continue
        if (kind, name) in LONG:
            long.append(lambda name=name: LONG[kind, name](thing))
        elif (kind, name) in SHORT:
            yield lambda name=name: SHORT[kind, name](thing)
        elif callable(getattr(thing, name)):
            yield lambda name=name: getattr(thing, name)()
        else:
            yield lambda name=name: getattr(thing, name)
    yield from long


short, long, failed, rounds = [], [], [], []
for thing in objects:
    found = list(calls(thing))
    count = sum(kind == type(thing).__name__ for kind, _ in LONG)
    short += found[: len(found) - count]
    long += found[len(found) - count :]


def work(place):
    try:
        barrier.wait()
        for call in long[place % len(long) :] + long[: place % len(long)]:
            call()
        end, turn = time.monotonic() + SECONDS, 0
        while turn == 0 or (turn < (ROUNDS or 100) and time.monotonic() < end):
            first = (place * len(short)) // THREADS
            for call in short[first:] + short[:first]:
                call()
            turn += 1
        rounds.append(turn)
    except BaseException as error:
        failed.append(error)
        raise


barrier = threading.Barrier(THREADS)
threads = [threading.Thread(target=work, args=[place], daemon=True) for place in range(THREADS)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert not failed, failed
print(f"{len(short) + len(long)} calls, {len(threads)} threads, rounds: {min(rounds)} or more")
