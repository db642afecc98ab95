"""DOP853 as one function of numba: SciPy's tableau and step control, without the interpreter between the steps."""

import numpy as np
from numba import njit
from scipy.integrate._ivp import dop853_coefficients as tableau

STAGES, EXTENDED = tableau.N_STAGES, tableau.N_STAGES_EXTENDED
A, B, C, E3, E5, D = tableau.A, tableau.B, tableau.C, tableau.E3, tableau.E5, tableau.D


@njit
def norm(x, scale):
    return np.sqrt(np.mean((x / scale) ** 2))


@njit
def first_step(rates, t, y, dy, tolerance):
    scale = tolerance + np.abs(y) * tolerance
    d0, d1 = norm(y, scale), norm(dy, scale)
    h = 1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1
    d2 = norm(rates(t + h, y + h * dy) - dy, scale) / h
    largest = max(d1, d2)
    other = max(1e-6, h * 1e-3) if largest <= 1e-15 else (0.01 / largest) ** 0.125
    return min(100 * h, other)


@njit
def integrate(rates, t, y, times, tolerance):
    """States (N x s) at the times, the first of which is the start; in between by the dense output of order 7."""
    size, end = len(y), times[-1]
    found = np.empty((len(times), size))
    found[0] = y
    wanted = 1
    k, stage, new, y = np.empty((EXTENDED, size)), np.empty(size), np.empty(size), y.copy()
    k[0] = rates(t, y)
    h = first_step(rates, t, y, k[0], tolerance)
    rejected = False
    while t < end:
        h = min(h, end - t)
        if t + h == t:
            raise ValueError("the step became too small")
        for s in range(1, STAGES):
            for c in range(size):
                total = 0.0
                for j in range(s):
                    total += A[s, j] * k[j, c]
                stage[c] = y[c] + h * total
            k[s] = rates(t + C[s] * h, stage)
        for c in range(size):
            total = 0.0
            for j in range(STAGES):
                total += B[j] * k[j, c]
            new[c] = y[c] + h * total
        k[STAGES] = rates(t + h, new)
        square5, square3 = 0.0, 0.0
        for c in range(size):
            scale, five, three = tolerance + max(abs(y[c]), abs(new[c])) * tolerance, 0.0, 0.0
            for j in range(STAGES + 1):
                five += E5[j] * k[j, c]
                three += E3[j] * k[j, c]
            square5 += (five / scale) ** 2
            square3 += (three / scale) ** 2
        error = 0.0
        if square5 > 0.0 or square3 > 0.0:
            error = h * square5 / np.sqrt((square5 + 0.01 * square3) * size)
        if not np.isfinite(error):
            raise ValueError("the state is no longer finite")
        if error >= 1.0:
            h *= max(0.2, 0.9 * error**-0.125)
            rejected = True
            continue
        after = end if h == end - t else t + h
        if wanted < len(times) - 1 and times[wanted] < after:
            for s in range(STAGES + 1, EXTENDED):
                dy = np.zeros(size)
                for j in range(s):
                    dy += A[s, j] * k[j]
                k[s] = rates(t + C[s] * h, y + h * dy)
            f = np.empty((7, size))
            f[0] = new - y
            f[1] = h * k[0] - f[0]
            f[2] = 2 * f[0] - h * (k[STAGES] + k[0])
            for i in range(D.shape[0]):
                f[3 + i] = 0.0
                for j in range(EXTENDED):
                    f[3 + i] += h * D[i, j] * k[j]
            while wanted < len(times) - 1 and times[wanted] < after:
                x = (times[wanted] - t) / h
                value = np.zeros(size)
                for i in range(6, -1, -1):
                    value += f[i]
                    value *= x if i % 2 == 0 else 1.0 - x
                found[wanted] = y + value
                wanted += 1
        factor = 10.0 if error == 0.0 else min(10.0, 0.9 * error**-0.125)
        h *= min(1.0, factor) if rejected else factor
        rejected = False
        t = after
        y[:] = new
        k[0] = k[STAGES]
        while wanted < len(times) and times[wanted] <= t:
            found[wanted] = y
            wanted += 1
    return found
