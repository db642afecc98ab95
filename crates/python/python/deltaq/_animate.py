"""Bodies in motion, as pictures that play by themselves."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from ._motion import times
from ._native import Comparison, Ensemble, Motion, System
from ._plots import COLOURS

# Points of a motion that are read off.
_POINTS = 961
# Members of an ensemble that are drawn.
_MEMBERS = 8


class Animation:
    """An SVG that plays by itself, without script; `svg` is its text. A notebook shows it."""

    def __init__(self, system: System, curves: list[tuple[str, str, Any, Any]]):
        svg = system._moving([curve for curve in curves if len(curve[2])])
        if svg is None:
            raise ValueError(f"{system.title!r} says nothing of bodies that move: give a view")
        self.svg = svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the SVG file."""
        Path(path).write_text(self.svg, "utf-8")

    def _repr_html_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<deltaq animation, {len(self.svg) / 1000:.0f} kB of SVG>"


def _curve(label: str, motion: Motion) -> tuple[str, str, Any, Any]:
    instants = np.linspace(motion.start, motion.end, _POINTS)
    return label, motion.formulation, instants, motion.at(instants).coordinates


def motion(self: Motion) -> Animation:
    """The bodies of the system's view along the motion, as a picture that plays by itself.

    Returns
    -------
    Animation
        An SVG, which notebooks show.

    Raises
    ------
    ValueError
        If the system has no view.
    """
    return Animation(self.system, [_curve(self.formulation, self)])


def comparison(self: Comparison) -> Animation:
    """The bodies of the system's view along the first motion of each formulation, in one picture that plays by itself.

    Returns
    -------
    Animation
        An SVG, which notebooks show.

    Raises
    ------
    ValueError
        If the system has no view.
    """
    shown = {run.formulation: (run.title, run.motion) for run in reversed(self.runs) if run.motion is not None}
    return Animation(self.system, [_curve(*shown[name]) for name in COLOURS if name in shown])


def ensemble(self: Ensemble) -> Animation:
    """The bodies of the system's view along eight of the members, straight between the ensemble's times.

    Returns
    -------
    Animation
        An SVG, which notebooks show.

    Raises
    ------
    ValueError
        If the system has no view.
    """
    name, values = next(iter(self.varied.items()))
    members = np.unique(np.linspace(0, len(self) - 1, min(len(self), _MEMBERS)).round().astype(int))
    reached = lambda i: slice(0, int(self.reached[i]))  # noqa: E731
    places = np.reshape(self.coordinates, (len(self), len(times(self)), -1))
    curve = lambda i: (f"{name} = {values[i]:g}", "", times(self)[reached(i)], places[i, reached(i)])  # noqa: E731
    return Animation(self.system, [curve(i) for i in members])
