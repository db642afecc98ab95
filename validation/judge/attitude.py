"""Euler angles z-x-z as the scene has them, ball to room Rz(psi) Rx(theta) Rz(phi), 0 < theta < pi."""

import numpy as np


def rotation(psi, theta, phi):
    """Ball to room, 3 by 3."""
    about_z = lambda v: np.array([[np.cos(v), -np.sin(v), 0], [np.sin(v), np.cos(v), 0], [0, 0, 1]])
    about_x = np.array([[1, 0, 0], [0, np.cos(theta), -np.sin(theta)], [0, np.sin(theta), np.cos(theta)]])
    return about_z(psi) @ about_x @ about_z(phi)


def axes(psi, theta):
    """Angular velocity in the room is this matrix times (psi', theta', phi')."""
    body = [np.sin(theta) * np.sin(psi), -np.sin(theta) * np.cos(psi), np.cos(theta)]
    return np.array([[0, 0, 1], [np.cos(psi), np.sin(psi), 0], body]).T


def angles(R):
    """psi, theta, phi of a rotation, in rad, psi and phi from -pi to pi."""
    tilt = np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])
    return np.array([np.arctan2(R[0, 2], -R[1, 2]), tilt, np.arctan2(R[2, 0], R[2, 1])])
