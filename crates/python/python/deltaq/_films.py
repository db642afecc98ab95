"""Films of motions: estimates with intervals, and which formulation a film supports."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _columns, _parts
from ._native import _TABLE_SIZE, DeltaqError, System, UnknownNameError, __version__, _Fitted
from ._needs import needed
from ._results import Design, Estimate, ResidualTest, Shown
from ._sweep import _Grid, _written

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.dataset as ds


class Profile:
    """How chi squared rises beside the estimate of a number, all others fitted again.

    `at`: values of the number, shape (k,). `rise`: above the least chi squared, shape (k,); 3.84 at the ends of an interval
    of 95 %; inf where there is no motion.
    """

    def __init__(self, name: str, label: str, at: npt.NDArray[np.float64], rise: npt.NDArray[np.float64]):
        self.name, self.label, self.at, self.rise = name, label, at, rise

    def plot(self, ax: Any = None) -> Any:
        """The rise over the number, with that of 95 %.

        Parameters
        ----------
        ax : matplotlib Axes or array of these, optional
            Axes to draw into.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        ImportError
            If matplotlib is not installed.
        """
        from ._plots import profile

        return profile(self, ax)

    def __repr__(self) -> str:
        return f"<deltaq.Profile of {self.name}, {self.label}>"


class FormulationFit:
    """A formulation fitted to films; `FilmFit` has one per formulation.

    `label`: its identifier; `title`: the same in words; `formulation`: its name. `verdict`: "supported", "excluded", "not-settled", "cannot-tell", "none" or
    "not-fitted", in `words`. `names`: of the unknowns, in the order of theta. `estimates`: by name value, error, low, high
    (of 95 %), profiled and at_bound, None for infinite. `shown`: whether such films can show the unknowns at all, with answer
    "proved", "hidden" or "open", hidden, order and words. `chi_squared`, `freedom`, `bic`, `tests`, `hidden`, `minima`,
    `starts`, `reached`, `by_half` as in the schema of `deltaq fit`; without a fit `estimates` is empty.
    """

    def __init__(self, fitted: _Fitted, place: int, answer: Mapping[str, Any]):
        self._fitted, self._place = fitted, place
        self.title: str = answer["label"]
        self.formulation: str = answer["formulation"]
        removal = self.title.partition(" (")[2].removesuffix(")")
        self.label: str = f"{self.formulation}:{removal}" if removal else self.formulation
        self.verdict: str = answer["verdict"]
        self.words: str = answer["words"]
        self.shown: Shown | None = None if answer["shown"] is None else Shown.of(answer["shown"])
        fit = answer["fit"] or {}
        self.estimates: dict[str, Estimate] = {own["name"]: Estimate.of(own) for own in fit.get("estimates", [])}
        self.chi_squared: float = fit.get("chi_squared", np.inf)
        self.freedom: int = fit.get("freedom", 0)
        self.bic: float = fit.get("bic", np.inf)
        self.tests: list[ResidualTest] = [ResidualTest.of(own) for own in fit.get("tests", [])]
        self.hidden: list[str] = fit.get("hidden", [])
        self.minima: list[float] = fit.get("minima", [])
        self.starts: int = fit.get("starts", 0)
        self.reached: int = fit.get("reached", 0)
        self.by_half: float | None = fit.get("by_half")
        self._bounds = dict(fitted.unknowns(place))
        self.names: list[str] = list(self._bounds)

    @property
    def theta(self) -> npt.NDArray[np.float64]:
        """The estimates in the order of `names`, shape (P,)."""
        return np.array([self.estimates[name].value for name in self.names])

    def logp(self, theta: npt.ArrayLike) -> float:
        """Logarithm of the likelihood with priors, -chi^2/2, for samplers.

        Parameters
        ----------
        theta : array_like of shape (P,)
            The unknowns, in the order of `names`.

        Returns
        -------
        float
            -inf if there is no motion.

        Raises
        ------
        ValueError
            If theta has another length.
        """
        return -0.5 * self._fitted.chi_squared(self._place, np.asarray(theta, dtype=float))

    def grad(self, theta: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Derivatives of `logp` by theta, exact.

        Parameters
        ----------
        theta : array_like of shape (P,)
            The unknowns, in the order of `names`.

        Returns
        -------
        ndarray of shape (P,)
            Zero if there is no motion.

        Raises
        ------
        ValueError
            If theta has another length.
        """
        return -0.5 * self._fitted.slopes(self._place, np.asarray(theta, dtype=float))

    def profile(self, name: str, at: npt.ArrayLike | None = None) -> Profile:
        """How chi squared rises if a number has these values and the others are fitted again.

        Parameters
        ----------
        name : str
            The number.
        at : array_like of shape (k,), optional
            Its values; by default about its interval.

        Returns
        -------
        Profile
            Values and rises.

        Raises
        ------
        UnknownNameError
            If there is no such unknown.
        ValueError
            If `at` is left out and the interval is open.
        """
        name = {"eps": "epsilon"}.get(name, name)
        if name not in self.names:
            raise UnknownNameError(f"no unknown {name!r}; there are {', '.join(self.names)}")
        if at is None:
            low, high = self.estimates[name].low, self.estimates[name].high
            if low is None or high is None:
                raise ValueError(f"the interval of {name} is open: say where the profile is wanted")
            bound = self._bounds[name]
            first = low - 0.5 * (high - low)
            at = np.linspace(first if bound is None else max(first, bound), high + 0.5 * (high - low), 41)
        values = np.atleast_1d(np.asarray(at, dtype=float))
        rise = self._fitted.rises(self._place, name, values.tolist())
        return Profile(name, self.label, values, np.array(rise, dtype=float))

    def residuals(self) -> dict[tuple[int, str], tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]]:
        """Residuals by film, from 1, and column.

        Returns
        -------
        dict
            (film, column) to times and (fitted - seen)/sigma, each of shape (k,).
        """
        found: dict[tuple[int, str], list[tuple[float, float]]] = {}
        for film, column, t, value in self._fitted.residuals(self._place):
            found.setdefault((film + 1, self._fitted.films[film][2][column][0]), []).append((t, value))
        return {place: (np.array(list(zip(*own))[0]), np.array(list(zip(*own))[1])) for place, own in found.items()}

    def __repr__(self) -> str:
        return f"<deltaq.FormulationFit {self.label}: {self.words}>"


class FilmFit:
    """Formulations fitted to films, the answer of `System.fit`: `fit["vakonomic"]` is one of them, `fit.best` the least.

    `answer` is that of `deltaq fit --format json`. `logp`, `grad` and `profile` are those of `best`, of the law of first
    order where it was asked for.
    """

    def __init__(self, system: System, call: dict[str, Any]):
        self.system, self._call = system, call
        self._fitted = system._fit(**call)
        self.answer: dict[str, Any] = json.loads(self._fitted.answer)
        self.rows = [FormulationFit(self._fitted, place, row) for place, row in enumerate(self.answer["formulations"])]

    @property
    def best(self) -> FormulationFit:
        """The formulation of the least chi squared; the law of first order, where it was asked for and is within 15 of it."""
        least = min(self.rows, key=lambda row: row.chi_squared)
        law = [row for row in self.rows if row.formulation == "first-order" and row.chi_squared < least.chi_squared + 15]
        return (law or [least])[0]

    def __getitem__(self, name: str) -> FormulationFit:
        for row in self.rows:
            if name in (row.label, row.title, row.formulation):
                return row
        raise UnknownNameError(f"no formulation {name!r}; there are {', '.join(row.label for row in self.rows)}")

    def logp(self, theta: npt.ArrayLike) -> float:
        """Logarithm of the likelihood of `best` with priors, -chi^2/2, for samplers.

        Parameters
        ----------
        theta : array_like of shape (P,)
            The unknowns, in the order of `names`.

        Returns
        -------
        float
            -inf if there is no motion.

        Raises
        ------
        ValueError
            If theta has another length.
        """
        return self.best.logp(theta)

    def grad(self, theta: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Derivatives of `logp` by theta, exact.

        Parameters
        ----------
        theta : array_like of shape (P,)
            The unknowns, in the order of `names`.

        Returns
        -------
        ndarray of shape (P,)
            Zero if there is no motion.

        Raises
        ------
        ValueError
            If theta has another length.
        """
        return self.best.grad(theta)

    def profile(self, name: str, at: npt.ArrayLike | None = None) -> Profile:
        """How chi squared of `best` rises if a number has these values and the others are fitted again.

        Parameters
        ----------
        name : str
            The number.
        at : array_like of shape (k,), optional
            Its values; by default about its interval.

        Returns
        -------
        Profile
            Values and rises.

        Raises
        ------
        UnknownNameError
            If there is no such unknown.
        ValueError
            If `at` is left out and the interval is open.
        """
        return self.best.profile(name, at)

    def plot(self, ax: Any = None) -> Any:
        """The films' columns over time with the fitted motions, one above the other.

        Parameters
        ----------
        ax : matplotlib Axes or array of these, optional
            Axes to draw into.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        ImportError
            If matplotlib is not installed.
        """
        from ._plots import films

        return films(self, ax)

    def __reduce__(self) -> tuple[Any, ...]:
        return FilmFit, (self.system, self._call)

    def __repr__(self) -> str:
        return f"<deltaq.FilmFit {'; '.join(f'{row.label}: {row.verdict}' for row in self.rows)}>"


def _table(table: Any) -> str:
    """A film as CSV: numbers to their last digit."""
    columns, _ = _columns.columns(table)
    if len({len(values) for values in columns.values()}) > 1:
        raise ValueError(f"columns have different lengths: {', '.join(f'{name} {len(x)}' for name, x in columns.items())}")
    rows = zip(*columns.values())
    names = ",".join('"' + name.replace('"', '""') + '"' for name in columns)
    return "\n".join([names, *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n"


def _read(film: Any, place: int) -> tuple[str, str]:
    if isinstance(film, (str, os.PathLike)):
        with Path(film).open(encoding="utf-8") as file:
            return str(film), file.read(_TABLE_SIZE + 1)
    return f"film {place}", _table(film)


def _sigmas(sigma: float | str | Mapping[str, float | str] | None) -> list[str]:
    if sigma is None:
        return []
    if isinstance(sigma, Mapping):
        return [f"{name}={value}" for name, value in sigma.items()]
    return [str(sigma)]


def fit(
    self: System,
    film: Any,
    *more: Any,
    free: Iterable[str],
    sigma: float | str | Mapping[str, float | str] | None = None,
    law: Iterable[str] = (),
    known: Mapping[str, float] | None = None,
    formulations: Iterable[str] = ("chetaev", "vakonomic"),
    starts: int = 16,
    robust: bool = False,
    tolerance: float = 1e-9,
    max_steps: int = 2_000,
) -> FilmFit:
    """Fits what is not known of the system to films of its motions, in each formulation: `deltaq fit`.

    Parameters
    ----------
    film : path or table
        A CSV file; or a mapping, a DataFrame, a Dataset of xarray, a table of Arrow or a Motion, with the time "t", as a
        column or as the index, and columns that are expressions by their names; NaN for a gap. Multipliers and invariants of
        a motion are not fitted.
    *more : path or table
        Further films.
    free : iterable of str
        Unknowns: "g", "x~0.1", "Omega~0.7±0.01", "x@2".
    sigma : float, str or mapping of str to these, optional
        Standard deviation of all columns, or by column: 1e-3, "1mm", "free".
    law : iterable of str
        Parameters of the first-order law to fit as well: "eps", "slip".
    known : mapping of str to float, optional
        Numbers of one film: "psi'@2".
    formulations : iterable of str
        Those to fit.
    starts : int
        Starts of the search.
    robust : bool
        Whether outliers count less.
    tolerance : float
        Tolerance of the looser run; the one that is kept has a hundredth of it.
    max_steps : int
        Limit on the steps of a run.

    Returns
    -------
    FilmFit
        A fit per formulation, with a verdict.

    Raises
    ------
    ValueError
        If a table cannot be read; it names the place.
    UnknownNameError
        If a name is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.linspace(0.05, 2, 40)
    >>> motion = sledge.solve("chetaev", times)
    >>> noise = 1e-3 * np.random.default_rng(2).normal(size=(2, 40))
    >>> film = {"t": times, "x": motion["x"] + noise[0], "y": motion["y"] + noise[1]}
    >>> found = sledge.fit(film, free=["g", "phi'"], sigma=1e-3)
    >>> found["chetaev"].verdict, found["vakonomic"].verdict
    ('supported', 'excluded')
    """
    places = [(int(name.rpartition("@")[2]), name.rpartition("@")[0], float(x)) for name, x in (known or {}).items()]
    tables = [_read(own, place + 1) for place, own in enumerate((film, *more))]
    call = dict(tables=tables, free=list(free), law=list(law), sigma=_sigmas(sigma), known=places, formulations=list(formulations))
    return FilmFit(self, call | dict(starts=starts, robust=robust, tolerance=tolerance, max_steps=max_steps))


def design(
    self: System,
    tell: Sequence[str] | None = None,
    *,
    film: str,
    estimate: str | None = None,
    over: Mapping[str, tuple[float, float]] | None = None,
    free: Iterable[str] = (),
    films: int = 1,
    columns: Iterable[str] = (),
    sigma: float | str | Mapping[str, float | str] | None = None,
    law: Iterable[str] = (),
    starts: int = 8,
    points: int = 32,
    tolerance: float = 1e-9,
    max_steps: int = 2_000,
    threads: int = 0,
) -> Design:
    """The film that would tell two formulations apart best, or show a number best: `deltaq design`.

    Parameters
    ----------
    tell : sequence of two str, optional
        The formulation that is right, and the other one.
    film : str
        Rate, error and length: "60Hz,0.5mm,10s".
    estimate : str, optional
        The number to show, instead of `tell`.
    over : mapping of str to (float, float), optional
        What can be chosen, with its bounds.
    free : iterable of str
        Unknowns, as in `fit`.
    films : int
        How many films of this kind.
    columns : iterable of str
        What a film shows; by default the coordinates.
    sigma : float, str or mapping of str to these, optional
        Standard deviation of all columns, or by column: 1e-3, "1mm", "free".
    law : iterable of str
        Parameters of the first-order law to fit as well: "eps", "slip".
    starts : int
        Starts of each fit.
    points : int
        Choices that are tried first.
    tolerance : float
        Tolerance of the looser run; the one that is kept has a hundredth of it.
    max_steps : int
        Limit on the steps of a run.
    threads : int
        0 for one per processor.

    Returns
    -------
    Design
        The answer of `deltaq design --format json`: as attributes, and as a mapping.

    Raises
    ------
    ValueError
        If neither or both of `tell` and `estimate` are given.
    UnknownNameError
        If a name is unknown.

    Examples
    --------
    >>> heisenberg = deltaq.built_in("heisenberg")
    >>> found = heisenberg.design(("vakonomic", "chetaev"), film="20Hz,1mm,1s", over={"mu0_1": (0.1, 1)}, free=["x'", "y'"], points=4)
    >>> found.best.at, found.best.value > 15
    ((1.0,), True)
    """
    if (tell is None) == (estimate is None):
        raise ValueError("design asks for tell or for estimate")
    aim = [str(estimate)] if tell is None else list(tell)
    if tell is not None and len(aim) != 2:
        raise ValueError(f"tell: two formulations are needed, there are {len(aim)}")
    ranges = [f"{name}={low!r}:{high!r}" for name, (low, high) in (over or {}).items()]
    found: dict[str, Any] = json.loads(
        self._design(aim, ranges, film, films, list(columns), _sigmas(sigma), list(free), list(law), starts, points, tolerance, max_steps, threads)
    )
    return Design.of(found)


class _DesignPart(_Grid):
    """Rows of a grid of films: what each shows, no other one looked for."""

    def __init__(self, system: System, over: dict[str, list[float]], size: int, options: dict[str, Any]):
        super().__init__(over, size)
        self.system, self.options = system, options

    def __call__(self, part: int) -> pa.Table:
        pa = needed("pyarrow")
        values = self.rows(part)
        found: list[tuple[float | None, int, str]] = []
        for row in values:
            try:
                best = self.system.replace(dict(zip(self.over, row.tolist()))).design(points=0, threads=1, **self.options).best
                found.append((best.value, best.minima, ""))
            except UnknownNameError:
                raise
            except (ValueError, DeltaqError) as fault:
                found.append((None, 0, str(fault)))
        columns = {name: pa.array(values[:, i]) for i, name in enumerate(self.over)}
        kinds = {"value": pa.float64(), "minima": pa.int32(), "cause": pa.string()}
        return pa.table(columns | {name: pa.array(column, kind) for (name, kind), column in zip(kinds.items(), zip(*found))})


def designs(
    system: System,
    over: Mapping[str, npt.ArrayLike],
    tell: Sequence[str] | None = None,
    *,
    client: Any = None,
    out: str | os.PathLike[str] | None = None,
    part: int = 4,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> pa.Table | ds.Dataset:
    """What films show at all combinations of some numbers, a row each, on a cluster as in `sweep`.

    Parameters
    ----------
    system : System
        The system.
    over : mapping of str to array_like
        Values by name.
    tell : sequence of two str, optional
        As in `System.design`.
    client : dask.distributed.Client, optional
        Its workers compute; by default this machine does.
    out : path, optional
        A folder for Parquet files; what a call that was cut off has left there is kept.
    part : int
        rows of a file.
    progress : callable, optional
        Called with the number of parts that are there, and of all.
    **options
        film, estimate, free, films, columns, sigma, law, starts, tolerance, max_steps: as in `System.design`.

    Returns
    -------
    pyarrow.Table or pyarrow.dataset.Dataset
        What varies, then `value` (least chi squared of the other formulation, or the standard error; null if films do not show it or
        there is no motion), `minima` (that the search found), `cause` (why there is no value).

    Raises
    ------
    ValueError
        If `over` has no finite values, or an option cannot be given.

    Examples
    --------
    >>> grid = deltaq.designs(deltaq.built_in("heisenberg"), {"mu0_1": [0.01, 1.0]}, ("vakonomic", "chetaev"), film="20Hz,1mm,1s", free=["x'", "y'"])
    >>> [value > 15 for value in grid["value"].to_pylist()]
    [False, True]
    """
    lists = {name: np.asarray(numbers, dtype=float).tolist() for name, numbers in over.items()}
    if not lists or not all(lists.values()) or part < 1 or not all(np.isfinite(numbers).all() for numbers in lists.values()):
        raise ValueError("over needs finite values for something that varies, and part is 1 at least")
    unknown = set(options) & {"over", "points", "threads"}
    if unknown:
        raise ValueError(f"designs looks for nothing else: {', '.join(sorted(unknown))} cannot be given")
    work = _DesignPart(system, lists, part, {"tell": tell} | options)
    mark = _parts.identity(design=_written(system), over=lists, options=repr(sorted(options.items())), tell=tell, part=part, version=__version__)
    return _parts.run(work, -(-work.count() // part), mark, client=client, out=out, progress=progress)
