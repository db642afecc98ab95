"""Motions integrated by SUNDIALS (CVODES, and IDAS on the equations as they stand) from the start of ours, compared with ours.

The distance of two motions at one time is the largest over the coordinates of |difference| / way, where the way of a coordinate is how far it gets
from its start; a coordinate that moves less than a hundredth of what the one that moves most does is measured with that hundredth.
"""

import casadi as ca
import numpy as np

TOLERANCES = {"CVODES": 1e-14, "IDAS": 1e-11}
# how good a referee is, a second run at ten times the tolerance says; IDAS is of order 5 at most and refuses much less
LOOSER = 10.0
ABSOLUTE = {"CVODES": 1e-14, "IDAS": 1e-11}
COMMON = {"max_num_steps": 100_000}
OPTIONS = {
    "CVODES": {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"},
    "IDAS": {"calc_ic": True, "suppress_algebraic": True},
}


def start(instant, motion):
    """y(t0) (s) of our motion, states that ours left out at zero."""
    values = np.array([motion["start"]], dtype=float)
    return instant.ordered(motion["tags"], values)[0]


def integrate(instant, y0, times, solver, factor=1.0):
    """States (N x s) at the times; times[0] is the start.

    The tolerance is that of the table, times `factor`. CVODES gets y' = F(t, y) with z eliminated, IDAS the pair y' = F(t, y, z), R(z; t, y) = 0.
    """
    options = COMMON | OPTIONS[solver] | {"reltol": factor * TOLERANCES[solver], "abstol": ABSOLUTE[solver]}
    problem = {"t": instant.t, "x": instant.y}
    if solver == "CVODES":
        t, y = ca.MX.sym("t"), ca.MX.sym("y", instant.y.numel())
        matrix, right = instant.numbers(t, y)
        z = ca.solve(matrix, right, "csparse") if instant.z.numel() else ca.MX(0, 1)
        problem = {"t": t, "x": y, "ode": instant.rate_function(t, y, z)}
        guess = {}
    else:
        problem |= {"z": instant.z, "ode": instant.rates, "alg": ca.mtimes(instant.matrix, instant.z) - instant.right}
        guess = {"z0": instant.solve(times[:1], y0[None, :])[0][0]}
    run = ca.integrator("run", "cvodes" if solver == "CVODES" else "idas", problem, times[0], list(times[1:]), options)
    states = np.array(run(x0=y0, **guess)["xf"]).T
    return np.vstack([y0, states])


def distance(ours, theirs):
    """Largest relative difference of two tables of coordinates (N x n)."""
    way = np.abs(ours - ours[0]).max(axis=0)
    scale = np.maximum(way, 0.01 * way.max())
    if way.max() == 0:
        scale = np.ones_like(way)
    return float((np.abs(ours - theirs) / scale).max())


def largest_constraint(instant, times, states):
    """Largest |f| along their motion: nobody projects it."""
    if instant.constraint_function.size1_out(0) == 0:
        return 0.0
    f = instant.constraint_function.map(len(times))(np.reshape(times, (1, -1)), states.T)
    return float(np.abs(np.array(f)).max())


class Found:
    """Two motions at the same times: coordinates (N x n) of our kept run, of our looser run, and theirs; multipliers (N x h)."""

    def __init__(self, ours, looser, theirs, our_multipliers, their_multipliers, drift):
        self.ours, self.looser, self.theirs, self.drift = ours, looser, theirs, drift
        self.our_multipliers, self.their_multipliers = our_multipliers, their_multipliers
        self.has_multipliers = our_multipliers.size > 0
        # the referee's own looser run, where there was one
        self.their_looser = theirs

    def apart(self, count):
        """Distance of the first `count` points."""
        return distance(self.ours[:count], self.theirs[:count])

    def own(self, count):
        """Distance of our own two runs."""
        return distance(self.ours[:count], self.looser[:count])

    def referees(self, count):
        """Distance of the referee's own two runs, 0 where it made one only."""
        return distance(self.theirs[:count], self.their_looser[:count])

    def multipliers(self, count):
        """Largest difference of the multipliers, relative to the largest of them, or to 1."""
        scale = max(1.0, np.abs(self.our_multipliers[:count]).max())
        return float(np.abs(self.our_multipliers - self.their_multipliers)[:count].max() / scale)


def compare(instant, motion, solver):
    """Our motion and theirs from the same start, and the coordinates of a second run of theirs, to be made where they are asked for."""
    times = np.array(motion["times"], dtype=float)

    def run(factor):
        states = integrate(instant, start(instant, motion), times, solver, factor)
        return states, np.array(instant.coordinate_function.map(len(times))(times.reshape(1, -1), states.T)).T

    states, theirs = run(1.0)
    ours = np.array(motion["coordinates"], dtype=float)
    mu = [i for i, tag in enumerate(instant.tags) if tag[0] == "mu"]
    table = np.array(motion["multipliers"], dtype=float) if mu and motion["multipliers"] else np.zeros((len(times), 0))
    drift = largest_constraint(instant, times, states)
    found = Found(ours, ours - np.array(motion["differences"], dtype=float), theirs, table, states[:, mu], drift)
    return found, lambda: run(LOOSER)[1]
