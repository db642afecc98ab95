"""The car with n trailers of `trailer.toml`, by hand: what a user writes who knows the system.

Axles e_i = (cos theta_i, sin theta_i), delta_i = theta_{i-1} - theta_i, masses m, inertias J, hitch to axle d, states x, y, theta_0 ... theta_n.
"""

import numpy as np


def reduced(sin, cos, theta, u, omega, m, J, d):
    """Rates of (x, y, theta_0 ... theta_n, u, omega) in the quasi-velocities u (forward speed of the car) and omega (its turn rate).

    Axle i runs forwards at c_i u and turns at k_i u, i > 0: c_0 = 1, c_i = c_{i-1} cos delta_i, k_i = c_{i-1} sin(delta_i)/d. By Maggi's equations
    A u' = -(sum m c_i c_i' + J k_i k_i') u with A = sum m c_i^2 + J k_i^2, and omega' = 0.
    """
    c, dc, turn = 1.0, 0.0, omega
    total, change = m, 0.0
    rates = [u * cos(theta[0]), u * sin(theta[0]), omega]
    for i in range(1, len(theta)):
        s, k = sin(theta[i - 1] - theta[i]), cos(theta[i - 1] - theta[i])
        bend, next_turn = c * s / d, c * s * u / d
        swing = turn - next_turn
        d_bend = (dc * s + c * k * swing) / d
        c, dc, turn = c * k, dc * k - c * s * swing, next_turn
        total = total + m * c * c + J * bend * bend
        change = change + m * c * dc + J * bend * d_bend
        rates.append(next_turn)
    return rates + [-(change * u) / total, 0.0 * omega]


def symbolic(scene, algebra):
    """Tags, states and rates of `reduced` in the expressions of a tool."""
    n = len(scene.coordinates) - 3
    tags = [("q", x) for x in scene.coordinates] + [("u", ""), ("omega", "")]
    y = [algebra.symbol(f"y_{i}") for i in range(n + 5)]
    m, J, d = (algebra.number(repr(scene.parameters[name])) for name in ("m", "J", "d"))
    rates = reduced(algebra.sin, algebra.cos, y[2 : n + 3], y[n + 3], y[n + 4], m, J, d)
    # the turn rate never changes
    return tags, y, rates[:-1] + [algebra.number("0")]


def reduced_loop(t, y, n, m, J, d):
    """The same for numba and for plain Python: y = (x, y, theta_0 ... theta_n, u), omega in the last place."""
    dy = np.empty(n + 5)
    u, omega = y[n + 3], y[n + 4]
    dy[0], dy[1], dy[2] = u * np.cos(y[2]), u * np.sin(y[2]), omega
    c, dc, turn, total, change = 1.0, 0.0, omega, m, 0.0
    for i in range(1, n + 1):
        delta = y[1 + i] - y[2 + i]
        s, k = np.sin(delta), np.cos(delta)
        bend, next_turn = c * s / d, c * s * u / d
        swing = turn - next_turn
        d_bend = (dc * s + c * k * swing) / d
        dc = dc * k - c * s * swing
        c, turn = c * k, next_turn
        total += m * c * c + J * bend * bend
        change += m * c * dc + J * bend * d_bend
        dy[2 + i] = next_turn
    dy[n + 3], dy[n + 4] = -change * u / total, 0.0
    return dy


def multipliers(t, y, n, m, J, d):
    """Rates of (q, v) from [[M, -A'], [A, 0]] (a, lambda) = r, put together by hand, solved by LAPACK; NumPy that numba compiles too."""
    size = n + 3
    theta, rate = y[2 : size], y[size + 2 :]
    s, c = np.sin(theta), np.cos(theta)
    matrix = np.zeros((2 * n + 4, 2 * n + 4))
    right = np.zeros(2 * n + 4)
    behind = np.arange(n + 1, 0, -1) * (m * d)  # mass that swings with trailer j, times d
    behind[0] = 0.0
    near = np.cos(theta.reshape(-1, 1) - theta.reshape(1, -1))
    places = np.arange(n + 1)
    outer = np.maximum(places.reshape(-1, 1), places.reshape(1, -1))
    matrix[0, 0] = matrix[1, 1] = m * (n + 1)
    matrix[0, 2:size] = behind * s
    matrix[1, 2:size] = -behind * c
    matrix[2:size, 0], matrix[2:size, 1] = behind * s, -behind * c
    matrix[2:size, 2:size] = (m * d * d) * (n + 1 - outer) * near
    matrix[2, 2:size] = 0.0
    matrix[2:size, 2] = 0.0
    for i in range(n + 1):
        matrix[2 + i, 2 + i] += J
    # what is left of the axles' accelerations when a = 0
    square = d * rate * rate
    square[0] = 0.0
    bias_x, bias_y = np.cumsum(square * c), np.cumsum(square * s)
    sum_x, sum_y = np.cumsum(bias_x[::-1])[::-1], np.cumsum(bias_y[::-1])[::-1]
    right[0], right[1] = -m * sum_x[0], -m * sum_y[0]
    right[2:size] = -m * d * (s * sum_x - c * sum_y)
    right[2] = 0.0
    # f_i = y_i' cos theta_i - x_i' sin theta_i
    swing = d * rate
    swing[0] = 0.0
    speed_x, speed_y = y[size] + np.cumsum(swing * s), y[size + 1] - np.cumsum(swing * c)
    for i in range(n + 1):
        row = size + i
        matrix[row, 0], matrix[row, 1] = -s[i], c[i]
        matrix[row, 3 : 3 + i] = -d * near[i, 1 : i + 1]
        right[row] = -(c[i] * bias_y[i] - s[i] * bias_x[i] - rate[i] * (speed_x[i] * c[i] + speed_y[i] * s[i]))
        for j in range(size):
            matrix[j, row] = -matrix[row, j]
    dy = np.empty(2 * size)
    dy[:size] = y[size:]
    dy[size:] = np.linalg.solve(matrix, right)[:size]
    return dy
