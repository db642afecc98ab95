"""Motions, ensembles and comparisons as tables of Arrow and pandas and as datasets of xarray."""

from typing import Any

import numpy as np

from ._native import Comparison, Ensemble, Motion


def _named(motion: Motion | Ensemble) -> dict[str, np.ndarray]:
    """Columns by name, each of the shape of the times and, before it, of the members."""
    columns = {}
    for prime, values in (("", motion.coordinates), ("'", motion.velocities)):
        columns |= {name + prime: values[..., i] for i, name in enumerate(motion.coordinate_names)}
    return columns | motion.multipliers | motion.invariants | getattr(motion, "observables", {})


def motion_to_arrow(self: Motion) -> Any:
    """A pyarrow.Table, a row a time: t, coordinates, velocities (x'), multipliers, invariants, observables."""
    import pyarrow as pa

    return pa.table({"t": self.times} | _named(self))


def motion_to_pandas(self: Motion) -> Any:
    """A pandas.DataFrame with the columns of `to_arrow`, of which t is the index."""
    import pandas as pd

    return pd.DataFrame(_named(self), index=pd.Index(self.times, name="t"))


def motion_to_xarray(self: Motion) -> Any:
    """An xarray.Dataset over t with the columns of `to_arrow`."""
    import xarray

    return xarray.Dataset({name: ("t", values) for name, values in _named(self).items()}, {"t": self.times})


def ensemble_to_arrow(self: Ensemble, first: int = 0) -> Any:
    """A pyarrow.Table, a row a member and time: member (from first + 1 on), what varies ("set x"), t, coordinates,
    velocities (x'), multipliers, invariants, error_estimate, status, cause. What a member did not reach is null."""
    import pyarrow as pa

    members, instants = len(self), len(self.times)
    each = lambda values: np.repeat(np.asarray(values), instants)  # noqa: E731
    columns = {"member": each(np.arange(first + 1, first + members + 1))}
    columns |= {f"set {name}": each(values) for name, values in self.varied.items()}
    columns |= {"t": np.tile(self.times, members)}
    arrays = {name: pa.array(values) for name, values in columns.items()}
    missing = (np.arange(instants) >= np.asarray(self.reached)[:, None]).ravel()
    arrays |= {name: pa.array(values.ravel(), mask=missing) for name, values in _named(self).items()}
    estimate = each(self.error_estimate)
    arrays["error_estimate"] = pa.array(estimate, mask=np.isnan(estimate))
    for name, words in (("status", self.status), ("cause", self.cause)):
        arrays[name] = pa.array([word for word in words for _ in range(instants)], pa.string())
    return pa.table(arrays)


def ensemble_to_pandas(self: Ensemble) -> Any:
    """A pandas.DataFrame with the columns of `to_arrow`."""
    return self.to_arrow().to_pandas()


def ensemble_to_xarray(self: Ensemble) -> Any:
    """An xarray.Dataset over member and t; what varies ("set x"), status and error_estimate over member."""
    import xarray

    data = {name: (("member", "t"), values) for name, values in _named(self).items()}
    data |= {f"set {name}": ("member", values) for name, values in self.varied.items()}
    data |= {"error_estimate": ("member", self.error_estimate), "status": ("member", self.status)}
    return xarray.Dataset(data, {"t": self.times, "member": np.arange(1, len(self) + 1)})


def comparison_to_pandas(self: Comparison) -> Any:
    """A pandas.DataFrame, a row a pair: verdict, times to the thresholds, largest gap, growth, why not."""
    import pandas as pd

    def row(pair: Any) -> dict[str, Any]:
        times = {f"time to {threshold:g}": time for threshold, time in pair.tau.items()}
        growth = None if pair.growth is None else pair.growth.exponent
        cells = {"first": pair.first, "second": pair.second, "verdict": pair.verdict, **times}
        return cells | {"largest gap": pair.largest_gap, "exponent": growth, "because": pair.because}

    return pd.DataFrame([row(pair) for pair in self.pairs])
