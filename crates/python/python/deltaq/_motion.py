"""Motions and ensembles as tables of columns by name, and motions over time: length, instants, slices."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ._native import Ensemble, Motion, Outputs, State, UnknownNameError

Array = npt.NDArray[np.float64]


def times(self: Motion | Ensemble) -> Array:
    """The times, of shape (k,) also where one was asked for as a number."""
    return np.atleast_1d(self.times)


def columns(self: Motion | Ensemble) -> dict[str, Array]:
    """All columns but the time by name, each of the shape of the times and, before it, of the members."""
    found: dict[str, Array] = {}
    for prime, values in (("", self.coordinates), ("'", self.velocities)):
        found |= {name + prime: values[..., i] for i, name in enumerate(self.coordinate_names)}
    return found | self.multipliers | self.invariants | getattr(self, "observables", {})


def rows(self: Motion | Ensemble) -> dict[str, Array]:
    """The same with an axis of times also where one was asked for as a number."""
    one = np.ndim(self.times) == 0
    return {name: np.asarray(values)[..., None] if one else values for name, values in columns(self).items()}


def column(self: Motion | Ensemble, name: str) -> Array:
    """The column of that name."""
    if name == "t":
        return self.times
    known = columns(self)
    if name not in known:
        raise UnknownNameError(f"unknown column {name!r}; known: t, {', '.join(known)}")
    return known[name]


def length(self: Motion) -> int:
    return len(times(self))


def instants(self: Motion) -> Iterator[State]:
    """Time, coordinates and velocities at each of the times that were reached."""
    shape = (len(times(self)), len(self.coordinate_names))
    for i, (q, v) in enumerate(zip(np.reshape(self.coordinates, shape), np.reshape(self.velocities, shape))):
        if i < self.reached:
            yield State._again({"t": float(times(self)[i]), "q": q.copy(), "v": v.copy()})


def is_column(self: Motion | Ensemble, name: object) -> bool:
    return name == "t" or name in columns(self)


def item(self: Motion, key: str | slice) -> Any:
    """A column by its name; or the motion at those of its times that a slice has, both ends included."""
    if isinstance(key, str):
        return column(self, key)
    if not isinstance(key, slice):
        raise TypeError(f"{key!r} is not a column's name, and not a slice of times: motion['x'], motion[0.5:1.0], motion[::10]")
    if np.ndim(self.times) == 0:
        raise TypeError("a motion at one time has no slices")
    step = 1 if key.step is None else key.step
    if not isinstance(step, int) or step < 1:
        raise ValueError(f"the step {step!r} of a slice is not a number of instants, 1 or more")
    after = -np.inf if key.start is None else float(key.start)
    before = np.inf if key.stop is None else float(key.stop)
    chosen = np.flatnonzero((self.times >= after) & (self.times <= before))[::step]
    _, (state,) = self.__reduce__()
    for name in ("times", "coordinates", "velocities", "coordinate_error_estimates", "multipliers", "invariants", "observables", "multiplier_error_estimates", "sensitivities", "sensitivity_error_estimates"):
        state[name] = chosen_of(state[name], chosen)
    state["reached"] = int((chosen < self.reached).sum())
    return self._with(state)


def chosen_of(value: Any, chosen: npt.NDArray[np.intp]) -> Any:
    """The rows of an array, of outputs, or of all that a dict has."""
    if isinstance(value, dict):
        return {name: chosen_of(own, chosen) for name, own in value.items()}
    if isinstance(value, Outputs):
        again, (state,) = value.__reduce__()
        return again(chosen_of(state, chosen))
    return value[chosen]
