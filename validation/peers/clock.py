"""Seconds of a call: the least of as many repeats as fit into the time given."""

import gc
import time


def least(call, seconds):
    """(least seconds, repeats, last answer); at least one repeat, garbage collection off."""
    gc.collect()
    gc.disable()
    try:
        best, total, repeats = float("inf"), 0.0, 0
        while repeats == 0 or total < seconds:
            begin = time.perf_counter()
            answer = call()
            spent = time.perf_counter() - begin
            best, total, repeats = min(best, spent), total + spent, repeats + 1
        return best, repeats, answer
    finally:
        gc.enable()


def once(call):
    """(seconds, answer)."""
    begin = time.perf_counter()
    answer = call()
    return time.perf_counter() - begin, answer
