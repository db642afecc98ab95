"""A tool as a process of its own, asked through a pipe: so tools take turns, and one that is too slow can be
ended.
"""

import importlib
import multiprocessing
import os

import numpy as np

import clock

CONTEXT = multiprocessing.get_context("spawn")
# seconds for a tool to load its libraries, which are not counted
LOADING = 120


class Work:
    """A tool with a case; of several motions at once, seconds are those of one. `with_NAME.py` has a class Tool with

    setup(case), the derivation, which hands back seconds that do not count; methods(case), their names;
    rates(), (tags, rates) at the start; shared(method), a name and a call, what has to be done once for
    several tolerances or methods; prepare(method, tolerance, times), what else has to be done before a run;
    run(method, tolerance, times), a call that integrates, and a function from what it hands back to a table
    of coordinates. A tool that has a clock of its own says so by `seconds(answer)`.
    """

    def __init__(self, name):
        self.tool = importlib.import_module(f"with_{name}").Tool()

    def load(self):
        """Nothing more than what has been done."""

    def setup(self, case):
        self.case, self.done = case, {}
        seconds, uncounted = clock.once(lambda: self.tool.setup(case))
        return seconds - uncounted, self.tool.methods(case)

    def rates(self):
        tags, rates = self.tool.rates()
        return tags, [float(x) for x in rates]

    def asked(self, task):
        return self.case.times if task == "trajectory" else [self.case.times[0], self.case.times[-1]]

    def prepare(self, method, tolerance, task):
        """Seconds of what comes before the first run; what serves several tolerances counts for each of them."""
        key, work = self.tool.shared(method)
        if key not in self.done:
            self.done[key] = clock.once(work)[0]
        return self.done[key] + clock.once(lambda: self.tool.prepare(method, tolerance, self.asked(task)))[0]

    def run(self, method, tolerance, task, repeat=0.0):
        """Least seconds of a run, and the coordinates at the times that the task asks for."""
        call, coordinates = self.tool.run(method, tolerance, self.asked(task))
        seconds, answer = clock.least(call, repeat, getattr(self.tool, "seconds", None))
        # of several motions at once the coordinates of one stand beside those of the next
        table = np.asarray(coordinates(answer), dtype=float)
        if len(table) != len(self.asked(task)) or not np.isfinite(table).all():
            raise ValueError("the answer is incomplete or not finite")
        return seconds / len(self.case.members), table

    def total(self, method, tolerance):
        """Seconds from the text of the scene to the trajectory, measured as a whole."""
        return clock.once(lambda: self.tool.total(method, tolerance, self.case.times))[0]


def serve(name, pipe):
    # whatever a library prints, from C++ too
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    work = Work(name)
    while True:
        what, about = pipe.recv()
        try:
            said = True, getattr(work, what)(**about)
        except Exception as error:  # a failure of a tool is a result, listed on the page
            # CasADi says where first, and at the end what happened
            words = str(error).strip().splitlines()
            said = False, f"{type(error).__name__}: {words[-1] if words else ''}"[:200]
        pipe.send(said)


class Refusal(Exception):
    """Why there is no answer: a result."""


class Worker:
    """A tool that answers, until it is ended."""

    def __init__(self, name):
        self.pipe, theirs = CONTEXT.Pipe()
        self.process = CONTEXT.Process(target=serve, args=(name, theirs), daemon=True)
        self.process.start()
        theirs.close()
        self.ask("load", LOADING)

    def ask(self, what, limit, **about):
        try:
            self.pipe.send((what, about))
            if not self.pipe.poll(limit):
                self.end()
                raise Refusal(f"over the limit of {limit} s")
            answered, said = self.pipe.recv()
        except (EOFError, OSError):
            self.process.join()
            raise Refusal(f"the process ended with {self.process.exitcode}") from None
        if not answered:
            raise Refusal(said)
        return said

    def end(self):
        self.process.kill()
        self.process.join()
