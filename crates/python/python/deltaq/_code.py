"""Equations of motion as functions of Python: of NumPy, JAX and Numba, and as SciPy's integrators take them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._native import Equations
from ._needs import needed

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Functions:
    """Equations as functions of a module: `rates(t, y, parameters)` and `outputs(t, y, parameters)`.

    JAX can trace and differentiate those of "jax"; those of "numba" are compiled, take one state, and the parameters as an
    array in the order of `parameters`, such as `values`.
    """

    module: Literal["numpy", "jax", "numba"]
    """Whose arrays these are: "numpy", "jax" or "numba"."""
    rates: Callable[..., Any]
    """rates(t, y, parameters) is F(t, y)."""
    outputs: Callable[..., Any]
    """outputs(t, y, parameters): what is read off, in the order of `output_names`."""
    states: list[str]
    """Names of the states y, length m."""
    output_names: list[str]
    """Names of the outputs."""
    parameters: dict[str, float]
    """Values of parameters and free constants, by name."""
    time: float
    """Time of the start."""
    start: Any
    """State at the start, shape (m,)."""
    text: str = field(repr=False)
    """The module as text."""

    @property
    def values(self) -> Array:
        """The parameters as an array, in their order."""
        return np.array([*self.parameters.values()], dtype=float)

    def __repr__(self) -> str:
        return f"<deltaq.Functions of {self.module}, states ({', '.join(self.states)})>"


def functions(self: Equations, module: Literal["numpy", "jax", "numba"] = "numpy") -> Functions:
    """The equations as functions of Python, which other libraries can trace or compile.

    Parameters
    ----------
    module : {"numpy", "jax", "numba"}
        Whose arrays the functions take; JAX and Numba have to be installed.

    Returns
    -------
    Functions
        `rates(t, y, parameters)`, `outputs(t, y, parameters)`, and what these start from.

    Raises
    ------
    ImportError
        If the module is not installed.
    SolveError
        If unknowns of the instant are not found by linear equations.

    Examples
    --------
    >>> equations = sledge.equations("chetaev")
    >>> made = equations.functions()
    >>> made.rates(0.0, made.start, made.parameters | {"g": 1.6})[:3]
    array([0., 0., 1.])
    """
    writers = {"numpy": self.to_numpy, "jax": self.to_jax, "numba": self.to_numba}
    if module not in writers:
        raise ValueError(f"module is {module!r}; known: {', '.join(writers)}")
    needed(module)
    text, made = writers[module](), dict[str, Any]()
    exec(compile(text, f"<equations of {self.formulation}>", "exec"), made)
    return Functions(
        module, made["rates"], made["outputs"], list(made["STATES"]), list(made["OUTPUTS"]), dict(made["PARAMETERS"]), made["TIME"], made["START"], text
    )


def to_scipy(
    self: Equations, parameters: Mapping[str, float] | None = None
) -> tuple[Callable[[float, npt.ArrayLike], Array], Callable[[float, npt.ArrayLike], Array]]:
    """The pair (fun, jac) that `scipy.integrate.solve_ivp` takes: rates and their exact Jacobian.

    Parameters
    ----------
    parameters : mapping of str to float, optional
        Parameters with other values, by name.

    Returns
    -------
    fun : callable
        fun(t, y), the rates, shape (m,).
    jac : callable
        jac(t, y), their derivatives by the state, shape (m, m).

    Raises
    ------
    UnknownNameError
        At the first call, if a parameter is unknown.

    Examples
    --------
    >>> fun, jac = sledge.equations("chetaev").to_scipy({"g": 1.6})
    >>> jac(0.0, sledge.equations("chetaev").initial_state()).shape
    (6, 6)
    """
    if parameters is None:
        return self.rates, self.jacobian
    numbers = dict(parameters)
    return partial(self.rates, parameters=numbers), partial(self.jacobian, parameters=numbers)
