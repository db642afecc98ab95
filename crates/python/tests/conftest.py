"""Systems that the tests share, with what is known of them. A panic is not a refusal that a test may expect: it is not caught."""

import os

os.environ.setdefault("DELTAQ_PANICS", "through")

import numpy as np
import pytest

import deltaq


class Sledge:
    """Ice sledge on an incline: blade contact x (down the slope), y (across), blade angle phi from the line of descent; unit mass.

    L = (x'^2 + y'^2)/2 + k^2 phi'^2/2 + g sin(alpha) x,   y' cos(phi) - x' sin(phi) = 0.

    Chetaev's sledge turns at a constant rate, phi = phi0 + w t, and runs along the blade at
    u = u0 + (g sin(alpha)/w) (sin(phi) - sin(phi0)): Neimark & Fufaev 1972.
    """

    g, alpha, k = 9.81, 0.4, 0.7
    phi0, w, u0 = 0.3, 1.1, 0.5
    duration = 10.0

    def system(self, **changes):
        arguments = dict(
            coordinates=["x", "y", "phi"],
            lagrangian="(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*x*sin(alpha)",
            constraints=["y'*cos(phi) - x'*sin(phi)"],
            parameters={"g": self.g, "alpha": self.alpha, "k": self.k},
            units={"x": "m", "y": "m", "phi": "rad"},
            start={"x": 0, "y": 0, "phi": self.phi0},
            velocities={"phi'": self.w, "x'": "0.5*cos(phi)"},
            removals={
                "arc-length": {
                    "parameters": ["u", "phi"],
                    "rates": {"x": "u'*cos(phi)", "y": "u'*sin(phi)"},
                    "start": {"u": 0},
                    "constants": {"horizon": self.duration},
                }
            },
            duration=self.duration,
            name="sledge",
            title="Ice sledge on an incline",
        )
        return deltaq.System(**(arguments | changes))

    def phi(self, t):
        return self.phi0 + self.w * t

    def speed(self, t):
        a = self.g * np.sin(self.alpha)
        return self.u0 + a / self.w * (np.sin(self.phi(t)) - np.sin(self.phi0))


@pytest.fixture(scope="session")
def sledge():
    return Sledge()


@pytest.fixture(scope="session")
def system(sledge):
    return sledge.system()
