"""The ice sledge by diffrax: vector_field(t, y, args), y0 at t0, SaveAt, and the same run by deltaq."""

from collections.abc import Mapping
from typing import Any

import deltaq
import diffrax
import jax
import numpy as np
import numpy.typing as npt

jax.config.update("jax_enable_x64", True)
Array = npt.NDArray[np.float64]

EQUATIONS = deltaq.built_in("sledge").equations("chetaev")
JAX = EQUATIONS.functions("jax")


def vector_field(t: Any, y: Any, args: Mapping[str, float]) -> Any:
    """Rates of the state, with the parameters as args: what a diffrax.ODETerm takes."""
    return JAX.rates(t, y, JAX.parameters | dict(args))


def by_diffrax(t0: float, y0: Array, ts: Array, args: Mapping[str, float]) -> Array:
    """States at the times ts of the run that is at y0 at t0."""
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(vector_field),
        diffrax.Dopri8(),
        t0=t0,
        t1=float(ts[-1]),
        dt0=None,
        y0=y0,
        args=args,
        saveat=diffrax.SaveAt(ts=ts),
        stepsize_controller=diffrax.PIDController(rtol=1e-10, atol=1e-10),
    )
    return np.asarray(found.ys)


def by_deltaq(t0: float, y0: Array, ts: Array, args: Mapping[str, float]) -> Array:
    """The same by deltaq's own time loop."""
    return EQUATIONS.integrate(ts, y0=y0, t0=t0, parameters=args).states


def main() -> dict[str, float]:
    """Largest differences between the two: in one piece, in two pieces, and on the Moon."""
    y0, whole = EQUATIONS.initial_state(), np.linspace(0.5, 2.0, 4)
    earth, moon = {"g": 9.81}, {"g": 1.62}
    one = by_diffrax(0.0, y0, whole, earth)
    two = by_deltaq(0.5, one[0], whole[1:], earth)
    return {
        "one piece": float(abs(one - by_deltaq(0.0, y0, whole, earth)).max()),
        "two pieces": float(abs(one[1:] - two).max()),
        "moon": float(abs(by_diffrax(0.0, y0, whole, moon) - by_deltaq(0.0, y0, whole, moon)).max()),
        "earth and moon": float(abs(one - by_deltaq(0.0, y0, whole, moon)).max()),
    }


if __name__ == "__main__":
    print(main())
