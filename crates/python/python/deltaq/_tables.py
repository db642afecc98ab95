"""Motions, ensembles and comparisons as tables of Arrow and pandas and as datasets of xarray."""

from typing import Any

import numpy as np

from ._motion import rows, times
from ._native import Comparison, Ensemble, Motion, System
from ._needs import needed


def units(system: System) -> dict[str, str]:
    """Units by name: of coordinates, of velocities (x') and, where some coordinate has one, of the time t."""
    places = {name: unit for name, unit in system.units.items() if unit}
    return places | {f"{name}'": f"{unit}/s" for name, unit in places.items()} | ({"t": "s"} if places else {})


def with_units(data: Any, units: dict[str, str]) -> Any:
    """The dataset of xarray with the units as attributes."""
    for name, unit in units.items():
        for of in (name, f"set {name}"):
            if of in data.variables:
                data[of].attrs["units"] = unit
    return data


def arrow_with_units(table: Any, units: dict[str, str]) -> Any:
    """The table of Arrow with the units as metadata of its columns."""
    pa = needed("pyarrow")
    unit = lambda name: units.get(name.removeprefix("set "))  # noqa: E731
    fields = [field.with_metadata({"units": unit(field.name)}) if unit(field.name) else field for field in table.schema]
    return table.cast(pa.schema(fields))


def motion_to_arrow(self: Motion) -> Any:
    """The motion as a table, one row per time: t, coordinates, velocities (x'), multipliers, invariants, observables.

    Returns
    -------
    pyarrow.Table
        What the motion did not reach is null; units are in the metadata of the columns.

    Raises
    ------
    ImportError
        If pyarrow is not installed.
    """
    pa = needed("pyarrow")
    missing = np.arange(len(times(self))) >= self.reached
    columns = {name: pa.array(values, mask=missing) for name, values in rows(self).items()}
    return arrow_with_units(pa.table({"t": times(self)} | columns), units(self.system))


def motion_to_pandas(self: Motion) -> Any:
    """The motion as a DataFrame with the columns of `to_arrow`; t is the index.

    Returns
    -------
    pandas.DataFrame
        One row per time.

    Raises
    ------
    ImportError
        If pandas is not installed.
    """
    pd = needed("pandas")
    return pd.DataFrame(rows(self), index=pd.Index(times(self), name="t"))


def motion_to_xarray(self: Motion) -> Any:
    """The motion as a Dataset over t with the columns of `to_arrow`.

    Returns
    -------
    xarray.Dataset
        Units are attributes.

    Raises
    ------
    ImportError
        If xarray is not installed.
    """
    data = {name: ("t", values.copy()) for name, values in rows(self).items()}
    return with_units(needed("xarray").Dataset(data, {"t": times(self)}), units(self.system))


def ensemble_to_arrow(self: Ensemble, first: int = 0) -> Any:
    """The members as a table, one row per member and time: member, what varies ("set x"), t, coordinates, velocities (x'),
    multipliers, invariants, error_estimate, status, cause.

    Parameters
    ----------
    first : int
        Number of the first member.

    Returns
    -------
    pyarrow.Table
        What a member did not reach is null; units are in the metadata of the columns.

    Raises
    ------
    ImportError
        If pyarrow is not installed.
    """
    pa = needed("pyarrow")
    members, instants = len(self), len(times(self))
    each = lambda values: np.repeat(np.asarray(values), instants)  # noqa: E731
    columns = {"member": each(np.arange(first, first + members))}
    columns |= {f"set {name}": each(values) for name, values in self.varied.items()}
    columns |= {"t": np.tile(times(self), members)}
    arrays = {name: pa.array(values) for name, values in columns.items()}
    missing = (np.arange(instants) >= np.asarray(self.reached)[:, None]).ravel()
    arrays |= {name: pa.array(values.ravel(), mask=missing) for name, values in rows(self).items()}
    estimate = each(self.error_estimate)
    arrays["error_estimate"] = pa.array(estimate, mask=np.isnan(estimate))
    for name, words in (("status", self.status), ("cause", self.cause)):
        arrays[name] = pa.array([word for word in words for _ in range(instants)], pa.string())
    return arrow_with_units(pa.table(arrays), units(self.system))


def ensemble_to_pandas(self: Ensemble) -> Any:
    """The members as a DataFrame with the columns of `to_arrow`.

    Returns
    -------
    pandas.DataFrame
        One row per member and time.

    Raises
    ------
    ImportError
        If pandas is not installed.
    """
    needed("pandas")
    return self.to_arrow().to_pandas()


def ensemble_to_xarray(self: Ensemble) -> Any:
    """The members as a Dataset over member, from 0, and t; what varies ("set x"), status and error_estimate over member.

    Returns
    -------
    xarray.Dataset
        Units are attributes.

    Raises
    ------
    ImportError
        If xarray is not installed.
    """
    data: dict[str, Any] = {name: (("member", "t"), values.copy()) for name, values in rows(self).items()}
    data |= {f"set {name}": ("member", values.copy()) for name, values in self.varied.items()}
    data |= {"error_estimate": ("member", self.error_estimate.copy()), "status": ("member", self.status)}
    dataset = needed("xarray").Dataset(data, {"t": times(self), "member": np.arange(len(self))})
    return with_units(dataset, units(self.system))


def comparison_to_pandas(self: Comparison) -> Any:
    """The pairs as a DataFrame: verdict, times to the thresholds, largest gap, growth, why not.

    Returns
    -------
    pandas.DataFrame
        One row per pair.

    Raises
    ------
    ImportError
        If pandas is not installed.
    """
    pd = needed("pandas")

    def row(pair: Any) -> dict[str, Any]:
        passes = {f"time to {threshold:g}": time for threshold, time in pair.tau.items()}
        growth = None if pair.growth is None else pair.growth.exponent
        cells = {"first": pair.first, "second": pair.second, "verdict": pair.verdict, **passes}
        return cells | {"largest gap": pair.largest_gap, "exponent": growth, "because": pair.because}

    return pd.DataFrame([row(pair) for pair in self.pairs])
