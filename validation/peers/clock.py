"""Seconds of a call: the least of as many repeats as fit into the time given."""

import gc
import time


def least(call, seconds, own=None):
    """(least seconds, last answer); at least one repeat, garbage collection off. `own` reads the seconds off
    an answer.
    """
    gc.collect()
    gc.disable()
    try:
        best, total = float("inf"), 0.0
        while best == float("inf") or total < seconds:
            spent, answer = once(call)
            best, total = min(best, own(answer) if own else spent), total + spent
        return best, answer
    finally:
        gc.enable()


def once(call):
    """(seconds, answer)."""
    begin = time.perf_counter()
    answer = call()
    return time.perf_counter() - begin, answer
