"""What notebooks show."""

from html import escape
from typing import Any

from ._motion import rows, times
from ._native import Comparison, Ensemble, Motion


def _table(rows: list[list[Any]], head: list[str] | None = None) -> str:
    cells = lambda row, tag: "".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in row)  # noqa: E731
    top = "" if head is None else f"<thead><tr>{cells(head, 'th')}</tr></thead>"
    body = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
    return f"<table>{top}<tbody>{body}</tbody></table>"


def motion(self: Motion) -> str:
    method = "" if self.method is None else self.method[0]
    shown = [
        ["formulation", self.formulation],
        ["form, method", f"{self.form[0]}, {method}"],
        ["time", f"{self.start:g} to {self.end:g}"],
        ["status", self.status if self.cause is None else f"{self.status}: {self.cause}"],
        ["error estimate", f"{self.error_estimate:.1e}"],
    ]
    shown += [[name, f"{rows(self)[name][self.reached - 1]:.9g} at t = {times(self)[self.reached - 1]:g}"] for name in self.coordinate_names if self.reached]
    return _table(shown)


def ensemble(self: Ensemble) -> str:
    counts = {word: self.status.count(word) for word in ("completed", "untrusted", "stopped", "refused")}
    over = ", ".join(f"{name}: {values.min():g} to {values.max():g}" for name, values in self.varied.items())
    return _table([["formulation", self.formulation], ["members", len(self)], *map(list, counts.items()), ["over", over]])


def comparison(self: Comparison) -> str:
    def time(pair: Any) -> str:
        passed = pair.tau[1e-3]
        return "" if passed is None else f"{passed:.4g}"

    pairs = [[pair.first, pair.second, pair.verdict, time(pair), f"{pair.largest_gap:.4g}"] for pair in self.pairs]
    decided = [
        [f"Is {d.motion} one of {d.family}, for some constants?", d.answer + (", proved" if d.proved else ""), d.dimension]
        for d in self.decided
    ]
    runs = [[run.title, run.error] for run in self.runs if run.error is not None]
    parts = [f"<p><strong>No verdict, results contradict each other: {escape(found)}</strong></p>" for found in self.contradictions]
    parts += [f"<p>The constraints: {escape(self.integrability)}</p>"]
    parts += [_table(pairs, ["motion", "motion", "verdict", "time to 1e-3", "largest gap"])] if pairs else []
    parts += [_table(decided, ["question", "answer", "dimension"])] if decided else []
    parts += [_table(runs, ["no motion", "because"])] if runs else []
    return "".join(parts)
