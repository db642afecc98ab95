"""What is needed by some, and which extra of the package brings it."""

from importlib import import_module
from typing import Any

_EXTRAS = {"pyarrow": "tables", "pandas": "tables", "xarray": "tables", "matplotlib": "plot", "distributed": "cluster"}
# What no extra brings.
_OTHERS = {"jax", "numba"}


def needed(name: str) -> Any:
    """The module of that name; ImportError names the extra that has it."""
    try:
        return import_module(name)
    except ModuleNotFoundError as missing:
        package = name.partition(".")[0]
        if (missing.name or "").partition(".")[0] != package:
            raise
        of_ours = f"the extra [{_EXTRAS.get(package)}] of deltaq brings it, or: "
        extra = ("" if package in _OTHERS else of_ours) + f"pip install {package}"
        raise ImportError(f"this needs {package}, which is not there: {extra}", name=package) from None
