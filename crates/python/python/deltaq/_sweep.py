"""Sweeps and long ensembles: tables over processes and clusters. pyarrow is imported only where a table is made."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _parts
from ._native import System, __version__
from ._needs import needed
from ._tables import arrow_with_units, units, with_units

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.dataset as ds

_COLUMNS = {
    "verdict": "string",
    "apart": "double",
    "largest": "double",
    "limit": "double",
    "answer": "string",
    "order": "int32",
    "dimension": "int32",
    "mismatch": "double",
    "cause": "string",
}
_SWEEP_PART = 64
_ENSEMBLE_PART = 4096


class _Grid:
    """All combinations of some values, in parts of `size` rows; the last ones change fastest."""

    def __init__(self, over: dict[str, list[float]], size: int):
        self.over, self.size = over, size

    def count(self) -> int:
        return math.prod(len(values) for values in self.over.values())

    def rows(self, part: int) -> npt.NDArray[np.float64]:
        first = part * self.size
        index = np.arange(first, min(first + self.size, self.count()))
        places = np.unravel_index(index, [len(values) for values in self.over.values()])
        return np.stack([np.asarray(v)[i] for v, i in zip(self.over.values(), places)], axis=1)


class _SweepPart(_Grid):
    """Rows of a sweep."""

    def __init__(self, system: System, over: dict[str, list[float]], size: int, options: tuple[Any, ...]):
        super().__init__(over, size)
        self.system, self.options = system, options

    def __call__(self, part: int) -> pa.Table:
        pa = needed("pyarrow")
        values = self.rows(part)
        found = self.system._sweep_points(list(self.over), values, *self.options)
        columns = {name: pa.array(values[:, i]) for i, name in enumerate(self.over)}
        columns |= {name: pa.array(found[name], pa.type_for_alias(kind)) for name, kind in _COLUMNS.items()}
        return arrow_with_units(pa.table(columns), _units(self.system))


class Sweep:
    """Two motions of a system compared over the values of one or more numbers, one row per point.

    `table` is an Arrow table or, in a folder, a dataset of Parquet files. Columns: what varies, then `verdict` ("same",
    "different", "undecided", "" without a motion), `apart` (time to a gap of 1e-3), `largest` (gap, kinetic metric),
    `limit` (what a gap has to pass), `answer` (whether some constants make the second motion the first), `order` (of
    the Taylor coefficient that proves they do not), `dimension` (of the set of such constants), `mismatch` (least one of
    accelerations over the motion's own), `cause` (why something is missing).
    """

    def __init__(self, table: pa.Table | ds.Dataset, over: dict[str, npt.NDArray[np.float64]], title: str, units: dict[str, str]):
        self.table, self.over, self.title, self.units = table, over, title, units

    def to_arrow(self) -> pa.Table:
        """The table, in memory.

        Returns
        -------
        pyarrow.Table
            One row per point.
        """
        return self.table if hasattr(self.table, "column_names") else self.table.to_table()

    def to_pandas(self) -> Any:
        """The table as a DataFrame.

        Returns
        -------
        pandas.DataFrame
            One row per point.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        needed("pandas")
        return self.to_arrow().to_pandas()

    def to_xarray(self) -> Any:
        """The table as a Dataset over what varies.

        Returns
        -------
        xarray.Dataset
            Units are attributes.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        xarray = needed("xarray")
        shape, table = [len(values) for values in self.over.values()], self.to_arrow()
        cells = {name: table[name].to_numpy().reshape(shape) for name in _COLUMNS}
        data = xarray.Dataset({name: (list(self.over), values) for name, values in cells.items()}, dict(self.over))
        return with_units(data, self.units)

    def plot(self, column: str = "apart", ax: Any = None) -> Any:
        """A column over one number as a line, over two as a map with dots if some constants do.

        Parameters
        ----------
        column : str
            One of numbers.
        ax : matplotlib Axes or array of these, optional
            Axes to draw into.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        UnknownNameError
            If there is no such column.
        ValueError
            If it has no numbers, or more than two vary.
        """
        from ._plots import sweep

        return sweep(self, column, ax)

    def __len__(self) -> int:
        return math.prod(len(values) for values in self.over.values())

    def __repr__(self) -> str:
        over = ", ".join(f"{name}: {len(values)}" for name, values in self.over.items())
        return f"<deltaq.Sweep {self.title!r}, {len(self)} points ({over})>"

    def _repr_html_(self) -> str:
        return str(self.to_pandas()._repr_html_())


def sweep(
    system: System,
    over: Mapping[str, npt.ArrayLike],
    *,
    formulations: Sequence[str] | None = None,
    decision: bool = True,
    tolerance: float = 1e-10,
    max_steps: int = 1_000_000,
    max_step: float | None = None,
    time_limit: float | None = None,
    client: Any = None,
    out: str | os.PathLike[str] | None = None,
    part: int = _SWEEP_PART,
    progress: Callable[[int, int], None] | None = None,
) -> Sweep:
    """Compares two motions of a system at all combinations of some values: `deltaq compare --sweep`.

    A row is a pure function of its numbers: no cluster, thread or part changes a bit of it.

    Parameters
    ----------
    system : System
        The system.
    over : mapping of str to array_like
        Values of parameters, start values ("x", "x'"), multipliers ("mu0_1") or costates ("P0_w") of the first removal.
    formulations : sequence of two str, optional
        By default Chetaev's and the vakonomic motion or, if costates vary, the one without constraints.
    decision : bool
        Whether it is decided if some constants make the second motion the first. Without it a point has a verdict and gaps alone,
        and takes less time.
    tolerance : float
        Tolerance of the looser run; the one that is kept has a hundredth of it.
    max_steps : int
        Limit on the steps of a run.
    max_step : float, optional
        No step is longer.
    time_limit : float, optional
        Limit on the seconds of a run.
    client : dask.distributed.Client, optional
        Its workers compute; by default this machine does.
    out : path, optional
        A folder for Parquet files; what a call that was cut off has left there is kept.
    part : int
        points of a file.
    progress : callable, optional
        Called with the number of parts that are there, and of all.

    Returns
    -------
    Sweep
        One row per point; a start that does not exist is a row with a cause.

    Raises
    ------
    UnknownNameError
        If a name is unknown.
    ValueError
        If `over` has no finite values.

    Examples
    --------
    >>> where = deltaq.sweep(sledge, {"k": [0.5, 1.0], "phi'": [0.5, 1.0, 1.5]})
    >>> len(where), where.to_xarray()["answer"].sel(k=0.5).values.tolist()
    (6, ['none proved', 'none proved', 'none proved'])
    """
    needed("pyarrow")
    values = {name: np.asarray(numbers, dtype=float) for name, numbers in over.items()}
    for name, numbers in values.items():
        if numbers.ndim != 1 or numbers.size == 0 or not np.isfinite(numbers).all():
            found = "a number" if numbers.ndim == 0 else f"of shape {numbers.shape}"
            raise ValueError(f"over: {name} has to be a list of finite numbers; it is {found}")
    if not values:
        raise ValueError("over is empty; it needs values for something that varies")
    if formulations is not None and len(formulations) != 2:
        raise ValueError(f"formulations names {len(formulations)}; two can be compared")
    chosen = None if formulations is None else list(formulations)
    limits = (chosen, decision, tolerance, max_steps, max_step, time_limit)
    lists = {name: numbers.tolist() for name, numbers in values.items()}
    # a name that means nothing is refused before anything is computed or written
    system._sweep_points(list(lists), np.empty((0, len(lists))), *limits, 1)
    work = _SweepPart(system, lists, _size(part), (*limits, 0 if client is None else 1))
    text = _written(system)
    mark = _parts.identity(sweep=text, over=lists, limits=limits, part=part, version=__version__)
    count = -(-work.count() // part)
    table = _parts.run(work, count, mark, client=client, out=out, progress=progress)
    return Sweep(table, values, system.title, _units(system))


class _EnsemblePart:
    """Members of an ensemble as rows, one per member and time."""

    def __init__(self, system: System, vary: dict[str, npt.NDArray[np.float64]], size: int, options: dict[str, Any]):
        self.system, self.vary, self.size, self.options = system, vary, size, options

    def __call__(self, part: int) -> pa.Table:
        first = part * self.size
        vary = {name: values[first : first + self.size] for name, values in self.vary.items()}
        return self.system.ensemble(vary=vary, **self.options).to_arrow(first)


def ensemble(
    system: System,
    formulation: str = "chetaev",
    times: npt.ArrayLike | None = None,
    *,
    vary: Mapping[str, npt.ArrayLike],
    client: Any = None,
    out: str | os.PathLike[str] | None = None,
    part: int = _ENSEMBLE_PART,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> pa.Table | ds.Dataset:
    """`System.ensemble` as a table, one row per member and time, for more members than memory has room for.

    A member does not depend on the others, nor on parts and workers.

    Parameters
    ----------
    system : System
        The system.
    formulation : str
        One of `FORMULATIONS`.
    times : float or array_like of shape (k,), optional
        Where the members are read off, ascending, to the last; by default at the end of `duration`.
    vary : mapping of str to array_like of shape (m,)
        As in `System.ensemble`.
    client : dask.distributed.Client, optional
        Its workers compute; by default this machine does.
    out : path, optional
        A folder for Parquet files; what a call that was cut off has left there is kept.
    part : int
        members of a file.
    progress : callable, optional
        Called with the number of parts that are there, and of all.
    **options
        Those of `System.ensemble`.

    Returns
    -------
    pyarrow.Table or pyarrow.dataset.Dataset
        A dataset with `out`, which reads only what is used. Columns as of `Ensemble.to_arrow`.

    Raises
    ------
    ValueError
        If `vary` is empty or has arrays of different lengths.

    Examples
    --------
    >>> table = deltaq.ensemble(sledge, "chetaev", [0.5, 1.0], vary={"phi'": [0.5, 1.0]})
    >>> table.column_names[:4], table.num_rows
    (['member', "set phi'", 't', 'x'], 4)
    """
    needed("pyarrow")
    values = {name: np.asarray(numbers, dtype=float) for name, numbers in vary.items()}
    for name, numbers in values.items():
        if numbers.ndim != 1:
            found = "is a number" if numbers.ndim == 0 else f"has shape {numbers.shape}"
            raise ValueError(f"vary: {name} {found}; a list or an array is needed")
    lengths = {name: len(numbers) for name, numbers in values.items()}
    if not values or len(set(lengths.values())) > 1 or 0 in lengths.values():
        raise ValueError(f"vary needs as many values of each, and some: {lengths}")
    instants = None if times is None else np.asarray(times, dtype=float).tolist()
    options |= {"formulation": formulation, "times": instants}
    if client is not None:
        options.setdefault("threads", 1)
    count = -(-next(iter(lengths.values())) // _size(part))
    listed = {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in options.items()}
    listed.pop("threads", None)
    digests = {name: hashlib.sha256(numbers.tobytes()).hexdigest() for name, numbers in values.items()}
    text = _written(system)
    mark = _parts.identity(ensemble=text, first=0, vary=digests, options=listed, part=part, version=__version__)
    work = _EnsemblePart(system, values, part, options)
    return _parts.run(work, count, mark, client=client, out=out, progress=progress)


def _units(system: System) -> dict[str, str]:
    """`apart` is a time."""
    known = units(system)
    return known | ({"apart": known["t"]} if known else {})


def _size(part: int) -> int:
    if part < 1:
        raise ValueError(f"part is {part}; it must be at least 1")
    return part


def _written(system: System) -> Any:
    """What a system is read from."""
    _, arguments = system.__reduce__()
    return arguments
