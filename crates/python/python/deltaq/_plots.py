"""Pictures, by matplotlib: one colour a formulation, times on the axis below."""

from typing import Any

import numpy as np

from ._motion import rows, times
from ._native import Comparison, Ensemble, Motion, UnknownNameError
from ._needs import needed
from ._tables import units

COLOURS = {"chetaev": "#0072b2", "vakonomic": "#d55e00", "removed-constraint": "#009e73", "kappa": "#cc79a7", "first-order": "#8a6d00"}
_STYLES: dict[str, Any] = {"chetaev": "-", "vakonomic": "--", "removed-constraint": "-.", "kappa": ":", "first-order": (0, (3, 1, 1, 1))}


def _look(formulation: str) -> dict[str, Any]:
    """Colour and dashes of a formulation; of a form of it likewise."""
    known = next((name for name in COLOURS if formulation.startswith(name)), None)
    return {} if known is None else {"color": COLOURS[known], "linestyle": _STYLES[known]}


# Lines of an ensemble that are drawn; more than these are a grey area.
_LINES = 200


def _columns(count: int, ax: Any) -> Any:
    """Axes one above the other, for as many curves."""
    if ax is not None:
        axes = np.atleast_1d(np.asarray(ax, dtype=object)).ravel()
        if len(axes) != count:
            raise ValueError(f"ax has {len(axes)} axes; {count} are needed")
        return axes
    plt = needed("matplotlib.pyplot")
    figure, axes = plt.subplots(count, 1, sharex=True, figsize=(7.2, 2.4 + 1.4 * count), squeeze=False, layout="constrained")
    # a notebook shows what is returned, and not once more what is open; a figure of the caller's stays open
    plt.close(figure)
    return axes[:, 0]


def _plain(text: str) -> str:
    """A text of a scene, in which matplotlib finds no formula."""
    return text.replace("$", r"\$")


def _with_unit(name: str, units: dict[str, str]) -> str:
    return _plain(f"{name} ({units[name]})" if units.get(name) else name)


def _finished(axes: Any, units: dict[str, str]) -> Any:
    axes[-1].set_xlabel(_with_unit("t", units))
    return axes[0].figure


def motion(self: Motion, ax: Any = None) -> Any:
    """Coordinates over time, one above the other, by matplotlib.

    Parameters
    ----------
    ax : matplotlib Axes or array of these, optional
        n axes to draw into.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    axes = _columns(len(self.coordinate_names), ax)
    for name, axis in zip(self.coordinate_names, axes):
        axis.plot(times(self), rows(self)[name], label=self.formulation, **_look(self.formulation))
        axis.set_ylabel(_with_unit(name, units(self.system)))
    axes[0].legend(frameon=False)
    return _finished(axes, units(self.system))


def ensemble(self: Ensemble, ax: Any = None) -> Any:
    """Coordinates of the members over time, one above the other; if they were read off at one time, over what varies first.

    Parameters
    ----------
    ax : matplotlib Axes or array of these, optional
        n axes to draw into.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    axes = _columns(len(self.coordinate_names), ax)
    colour = _look(self.formulation).get("color")
    along, (name, values) = len(times(self)) > 1, next(iter(self.varied.items()))
    shown = np.linspace(0, len(self) - 1, min(len(self), _LINES)).astype(int)
    for coordinate, axis in zip(self.coordinate_names, axes):
        if along:
            axis.plot(times(self), rows(self)[coordinate][shown].T, color=colour, alpha=0.5, linewidth=0.8)
        else:
            axis.plot(values, rows(self)[coordinate][:, 0], ".", color=colour, markersize=3)
        axis.set_ylabel(_with_unit(coordinate, units(self.system)))
    axes[0].set_title(f"{self.formulation}: {len(shown) if along else len(self)} of {len(self)} members", loc="left")
    figure = _finished(axes, units(self.system))
    if not along:
        axes[-1].set_xlabel(_with_unit(name, units(self.system)))
    return figure


def comparison(self: Comparison, ax: Any = None) -> Any:
    """Coordinates of all motions over time, then the gaps of the pairs with their limits.

    Parameters
    ----------
    ax : matplotlib Axes or array of these, optional
        n + 1 axes to draw into.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    # the costate form is a form of the vakonomic motion
    runs = [(run, run.motion) for run in self.runs if run.motion is not None and run.formulation in COLOURS]
    names = runs[0][1].coordinate_names if runs else []
    axes = _columns(len(names) + 1, ax)
    for place, (run, motion) in enumerate(runs):
        # of several removals the first is the widest
        width = 1.8 / (1 + sum(other.formulation == run.formulation for other, _ in runs[:place]))
        for i, axis in enumerate(axes[:-1]):
            axis.plot(motion.times, motion.coordinates[:, i], label=_plain(run.title), linewidth=width, **_look(run.formulation))
    for name, axis in zip(names, axes):
        axis.set_ylabel(_with_unit(name, units(self.system)))
    below = axes[-1]
    labels = {run.label for run, _ in runs}
    for pair in (pair for pair in self.pairs if {pair.first, pair.second} <= labels):
        [line] = below.plot(pair.times, np.where(pair.gap > 0, pair.gap, np.nan), label=_plain(f"{pair.first}, {pair.second}"))
        below.plot(pair.times, np.where(pair.limit > 0, pair.limit, np.nan), ":", color=line.get_color(), linewidth=0.8)
    below.set(yscale="log", ylabel="gap")
    for axis, columns in ((axes[0], 2), (below, 1)):
        if axis.get_legend_handles_labels()[0]:
            axis.legend(frameon=False, fontsize="small", loc="lower left", bbox_to_anchor=(0, 1), ncols=columns)
    return _finished(axes, units(self.system))


def sweep(self: Any, column: str, ax: Any) -> Any:
    """See `Sweep.plot`."""
    table = self.to_arrow()
    if column not in table.column_names:
        raise UnknownNameError(f"no column {column!r}; there are {', '.join(table.column_names)}")
    if table[column].type != "double":
        raise ValueError(f"the column {column!r} has words or counts; a column of numbers can be drawn")
    if len(self.over) > 2:
        raise ValueError(f"{len(self.over)} numbers vary; one or two can be drawn: take to_xarray()")
    [axis] = _columns(1, ax)
    names, axes = list(self.over), list(self.over.values())
    values = table[column].to_numpy()
    contained = np.array([answer.startswith("some") for answer in table["answer"].to_pylist()])
    if len(names) == 1:
        axis.plot(axes[0], values, color=COLOURS["vakonomic"])
        axis.plot(axes[0][contained], values[contained], "o", color="black", label="some constants")
        axis.set_ylabel(_with_unit(column, self.units))
    else:
        shape = [len(numbers) for numbers in axes]
        positive = values[np.isfinite(values) & (values > 0)]
        norm = needed("matplotlib.colors").LogNorm(positive.min(), positive.max()) if positive.size else None
        map = axis.pcolormesh(axes[1], axes[0], values.reshape(shape), norm=norm, shading="nearest", cmap="viridis")
        axis.figure.colorbar(map, ax=axis, label=_with_unit(column, self.units))
        down, across = np.nonzero(contained.reshape(shape))
        axis.plot(axes[1][across], axes[0][down], "o", color="white", markeredgecolor="black", markersize=5, label="some constants")
        axis.set_ylabel(_with_unit(names[0], self.units))
    if contained.any():
        axis.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1))
    figure = axis.figure
    axis.set_xlabel(_with_unit(names[-1], self.units))
    axis.set_title(_plain(self.title), loc="right", fontsize="small")
    return figure


def profile(self: Any, ax: Any) -> Any:
    """See `Profile.plot`."""
    [axis] = _columns(1, ax)
    finite = np.isfinite(self.rise)
    axis.plot(self.at[finite], self.rise[finite], color=COLOURS["chetaev"])
    axis.axhline(3.84, linestyle=":", color="grey", linewidth=0.8)
    axis.set(xlabel=_plain(self.name), ylabel="rise of chi squared")
    axis.set_title(_plain(self.label), loc="left")
    return axis.figure


def films(self: Any, ax: Any) -> Any:
    """See `FilmFit.plot`."""
    seen = self._fitted.films
    places = [(number, name, sigma, np.array(t), np.array(x)) for number, (_, t, own) in enumerate(seen, 1) for name, sigma, x in own]
    axes = _columns(len(places), ax)
    for (number, name, sigma, t, x), axis in zip(places, axes):
        axis.plot(t, x, ".", color="grey", markersize=3, label="film")
        for row in self.rows:
            instants, residuals = row.residuals().get((number, name), (np.empty(0), np.empty(0)))
            fitted = np.interp(instants, t[np.isfinite(x)], x[np.isfinite(x)]) + sigma * residuals
            axis.plot(instants, fitted, label=_plain(f"{row.title}: {row.verdict}"), **_look(row.formulation))
        axis.set_ylabel(_plain(name if len(seen) == 1 else f"{name}, film {number}"))
    axes[0].legend(frameon=False, fontsize="small", loc="lower left", bbox_to_anchor=(0, 1))
    axes[-1].set_xlabel("t")
    return axes[0].figure
