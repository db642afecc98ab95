"""The ice sledge by SciPy: solve_ivp with the exact Jacobian, least_squares, and a controller sampled at 100 Hz."""

import deltaq
import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

Array = npt.NDArray[np.float64]

SLEDGE = deltaq.System(
    coordinates=["x", "y", "phi"],
    lagrangian="(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*sin(alpha)*x",
    constraints=["y'*cos(phi) - x'*sin(phi)"],
    forces={"phi": "torque + 0.1*sin(3*t)"},
    parameters={"g": 9.81, "alpha": 0.4, "k": 0.7, "torque": 0.0},
    start={"x": 0, "y": 0, "phi": 0.3},
    velocities={"phi'": 1.1, "x'": 0.5},
)
EQUATIONS = SLEDGE.equations("chetaev")


def by_solve_ivp(times: Array, method: str) -> Array:
    """States at the times; y0 belongs to the first of them."""
    fun, jac = EQUATIONS.to_scipy({"torque": 0.2})
    more = {"jac": jac} if method == "Radau" else {}
    span, y0 = (times[0], times[-1]), EQUATIONS.initial_state()
    found = solve_ivp(fun, span, y0, method=method, t_eval=times, rtol=1e-9, atol=1e-9, **more)
    return np.asarray(found.y.T)


def controlled(rate: float, seconds: float) -> tuple[Array, Array]:
    """Headings phi and torques of a sampled controller that turns the sledge to phi = 1: times ascend from piece to piece."""
    y, headings, torques = EQUATIONS.initial_state(), [], []
    for i in range(round(rate * seconds)):
        torque = 4.0 * (1.0 - y[2]) - 2.0 * y[5]
        piece = EQUATIONS.integrate([i / rate, (i + 1) / rate], y0=y, parameters={"torque": torque}, tolerance=1e-9)
        y = piece.states[-1]
        headings.append(y[2])
        torques.append(torque)
    return np.array(headings), np.array(torques)


def main() -> dict[str, float]:
    """Largest differences from deltaq's own run, what a fit finds, and where the controller ends."""
    times = np.linspace(0.0, 2.0, 21)
    own = EQUATIONS.integrate(times, y0=EQUATIONS.initial_state(), parameters={"torque": 0.2}).states
    film = SLEDGE.solve("chetaev", times, parameters={"g": 9.7}, start={"phi'": 0.9})
    miss = SLEDGE.residuals(["g", "phi'"], film, formulation="chetaev")
    fit = least_squares(miss, [9.81, 1.1], jac=miss.jac, x_scale=[1.0, 0.1])
    headings, torques = controlled(100.0, 5.0)
    found = {name: float(abs(by_solve_ivp(times, name) - own).max()) for name in ("DOP853", "Radau")}
    return found | {"g": float(fit.x[0]), "phi'": float(fit.x[1]), "phi": float(headings[-1]), "torque": float(torques[-1])}


if __name__ == "__main__":
    print(main())
