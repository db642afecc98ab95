"""Tables of other libraries, and the module's own, as columns by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _motion
from ._native import Motion, Residuals, System

Array = npt.NDArray[np.float64]


def columns(table: Any) -> tuple[dict[str, Array], bool]:
    """The columns, the time under "t", and whether the table may have columns that are not data, as those of motions have."""
    if isinstance(table, Motion):
        return {"t": _motion.times(table)} | _motion.rows(table), True
    kind = {own.__module__.partition(".")[0] for own in type(table).__mro__}
    if "pyarrow" in kind:
        return {name: _floats(table[name].to_numpy()) for name in table.column_names}, True
    if "xarray" in kind:
        found = {str(name): _floats(np.atleast_1d(table[name].values)) for name in table.data_vars}
        return ({"t": _floats(np.atleast_1d(table["t"].values))} if "t" in table.coords else {}) | found, True
    found = {str(name): _floats(table[name]) for name in table}
    # a DataFrame whose index is the time
    if "t" not in found and "pandas" in kind:
        index: Any = table.index
        if index.name == "t" or index.name is None and index.dtype.kind == "f":
            found = {"t": _floats(index)} | found
    return found, "pandas" in kind


def _floats(values: Any) -> Array:
    return np.asarray(values, dtype=float)


def residuals(
    self: System,
    names: Sequence[str],
    times: Any = None,
    data: Any = None,
    formulation: str = "chetaev",
    *,
    sigma: Mapping[str, float] | None = None,
    removal: str | None = None,
    mu0: npt.ArrayLike | None = None,
    constants: Any = None,
    method: str = "auto",
    tolerance: float = 1e-11,
    max_steps: int = 100_000,
    penalty: float = 1e6,
) -> Residuals:
    """Residuals between a motion and data, as a function of numbers of the system that never raises: for
    `scipy.optimize.least_squares`.

    Parameters
    ----------
    names : sequence of str
        What varies: parameters, start values ("x", "x'"), multipliers ("mu0_1", ...) or costates ("P0_w").
    times : array_like of shape (k,), or table, optional
        Times of the data, ascending; without `data` the table, which has them.
    data : mapping of str to array_like of shape (k,), or table, optional
        Values by the name of a coordinate, a velocity ("x'") or a multiplier. A DataFrame, a Dataset of xarray, a table of
        Arrow or a Motion may have the time as column or index "t"; invariants and observables of a motion are left out.
    formulation : str
        One of `FORMULATIONS`.
    sigma : mapping of str to float, optional
        Columns to their units, 1 by default.
    removal : str, optional
        A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
    mu0 : array_like of shape (h,), optional
        Start multipliers of the vakonomic formulations; by default those of the system.
    constants : "zero", {"horizon": T} or array_like, optional
        Free constants: zero, natural at time T, or their values; zero by default
        instead of natural.
    method : str
        One of `METHODS`, or "auto".
    tolerance : float
        Tolerance of the run.
    max_steps : int
        Limit on the steps of a run.
    penalty : float
        Residuals at times that a motion does not reach.

    Returns
    -------
    Residuals
        A function of the numbers, with exact derivatives.

    Raises
    ------
    ValueError
        If a column has another length than the times, or a value that is not finite.
    UnknownNameError
        If a name is unknown.

    Examples
    --------
    >>> times = [0.5, 1.0]
    >>> miss = sledge.residuals(["phi'"], times, {"phi": [0.6, 1.2]}, sigma={"phi": 0.1})
    >>> miss([1.0]).round(9), miss.jac([1.0]).round(9).tolist()
    (array([-1., -2.]), [[5.0], [10.0]])
    """
    if data is None:
        times, data = None, times
    if data is None:
        raise TypeError("residuals needs data: columns by name, or a table with the time")
    found, may_have_more = columns(data)
    if times is None:
        if "t" not in found:
            raise ValueError(f"the data have no column t, and no times are given; there are {', '.join(found) or 'none'}")
        times = found.pop("t")
    if may_have_more:
        no_data = {"energy", *self.invariants, *self.observables}
        found = {name: x for name, x in found.items() if name not in no_data and not name.startswith("momentum ")}
        # what a motion did not reach
        reached = ~np.all([np.isnan(x) for x in found.values()], axis=0) if found else slice(None)
        times, found = np.asarray(times)[reached], {name: x[reached] for name, x in found.items()}
    call = dict(sigma=sigma, removal=removal, mu0=mu0, constants=constants, method=method)
    return self._residuals(list(names), times, found, formulation, **call, tolerance=tolerance, max_steps=max_steps, penalty=penalty)
