"""Systems of the referee, by hand: twice the kinetic energy as squares of forms, forms that vanish, a potential.

Scenes have the same systems in Euler's angles and spherical coordinates; here a system takes either kind of chart.
"""

from fractions import Fraction as F

from series import Form, Series, attitude, component, cross, dot, in_body, plus, rate, rates, times, turn, unit_vector
from series import Angle

MOMENTS = [F(1, 10), F(13, 100), F(17, 100)]
OFF = (F(1, 20), F(3, 100), F(1, 10))
G = F(981, 100)


class System:
    """q; `squares`: (weight, form) of 2 T; `forms` + `offsets` = 0; the potential; a form in L beside all that."""

    def __init__(self, count, squares, forms, potential=0, offsets=None, gyroscopic=None):
        self.count, self.forms, self.potential = count, forms, Series.of(potential)
        self.offsets = [Series.of(x) for x in offsets or [0] * len(forms)]
        self.gyroscopic = gyroscopic or Form([Series({})] * count)
        entry = lambda i, j: sum((w * f[i] * f[j] for w, f in squares), Series({}))
        self.mass = [[entry(i, j) for j in range(count)] for i in range(count)]


def product(weight, f, g):
    """2 weight f g as squares."""
    return [(F(weight) / 2, f + g), (-F(weight) / 2, f - g)]


def body(rows, spin, moments):
    return list(zip(moments, in_body(rows, spin), strict=True))


def up():
    return [Series({}), Series({}), Series.of(1)]


def on_a_plane(q, off=(0, 0, 0), rubber=False, moments=MOMENTS, a=F(1, 2), m=1, g=0, table=0, rotor=None):
    """Ball; `off`: mass centre in the body; `table`: rate at which the plane turns; `rotor`: k of a gyrostat."""
    rows, spin = attitude(q[2:5], 5, 2)
    middle = rates(5, 0, 1, None)
    slip = plus(middle, times(-a, cross(spin, up())))
    arm = [dot(row, off) for row in rows]
    centre = plus(middle, cross(spin, arm))
    forms, offsets = slip[:2] + spin[2:] * rubber, [table * q[1], -table * q[0]] + [0] * rubber
    gyroscopic = component(in_body(rows, spin), rotor) if rotor else None
    return System(5, [(m, f) for f in centre] + body(rows, spin, moments), forms, m * g * arm[2], offsets, gyroscopic)


def on_a_sphere(q, rubber, a=1, b=F(1, 2)):
    n = unit_vector(*q[:2])
    rows, spin = attitude(q[2:5], 5, 2)
    middle = [rate((a + b) * x, 5) for x in n]
    slip = plus(middle, times(-b, cross(spin, n)))
    squares = [(1, f) for f in middle] + body(rows, spin, MOMENTS)
    return System(5, squares, slip + [component(spin, n)] * rubber)


def on_a_surface(q, height, a=F(1, 10), m=1, table=0):
    """Homogeneous ball; height of its middle as a function of x and y. Or, from azimuth and slope of the normal, the
    paraboloid whose curvatures `height` are."""
    rows, spin = attitude(q[2:5], 5, 2)
    if isinstance(q[0], Angle):
        tangent = q[1].sin / q[1].cos
        x, y = tangent * q[0].cos / height[0], tangent * q[0].sin / height[1]
        z = (height[0] * x * x + height[1] * y * y) * F(1, 2)
        normal, root = [-tangent * q[0].cos, -tangent * q[0].sin, Series.of(1)], 1 / q[1].cos
    else:
        x, y = q[:2]
        z = height(x, y)
        normal = [-z.slope(0), -z.slope(1), Series.of(1)]
        root = dot(normal, normal).sqrt()
    middle = [rate(x, 5), rate(y, 5), rate(z, 5)]
    slip = plus(times(root, middle), times(-a, cross(spin, normal)))
    contact = [root * x - a * normal[0], root * y - a * normal[1]]
    squares = [(m, f) for f in middle] + [(2 * m * a * a / 5, f) for f in spin]
    return System(5, squares, slip[:2], m * G * z, [table * contact[1], -table * contact[0]])


def paraboloid(kx, ky):
    return lambda x, y: (kx * x * x + ky * y * y) * F(1, 2)


def rolls(q, contact, moments, m=1):
    """`contact`: from the vertical in the axes of the body, where it touches and how high the middle is."""
    rows, spin = attitude(q[2:5], 5, 2)
    r, h = contact(rows[2])
    middle = [*rates(5, 0, 1), rate(h, 5)]
    slip = plus(middle, cross(spin, [dot(row, r) for row in rows]))
    return System(5, [(m, f) for f in middle] + body(rows, spin, moments), slip, m * G * h)


def ellipsoid(q, axes):
    squares = [a * a for a in axes]

    def contact(n):
        h = dot(n, [d * x for d, x in zip(squares, n, strict=True)]).sqrt()
        return [-d * x / h for d, x in zip(squares, n, strict=True)], h

    return rolls(q, contact, [(sum(squares) - d) / 5 for d in squares])


def disc(q, radius=F(1, 2)):
    def contact(n):
        h = (1 - n[2] * n[2]).sqrt()
        return [-radius * n[0] / h, -radius * n[1] / h, Series({})], radius * h

    return rolls(q, contact, [F(1, 16), F(1, 16), F(1, 8)])


def about_a_point(q, coupling=0, veselova=False, potential=lambda n: 0, turning=0):
    rows, spin = attitude(q, 3, 0)
    own = in_body(rows, spin)
    squares = list(zip(MOMENTS, own, strict=True)) + (product(coupling, own[0], own[2]) if coupling else [])
    return System(3, squares, [spin[2] if veselova else own[2]], potential(rows[2]), [-turning])


def heisenberg(q):
    x, y, z = rates(3, 0, 1, 2)
    e = z - y * q[0]
    return System(3, [(1, x), (2, y), (3, e), *product(F(1, 2), x, e), *product(F(7, 10), y, e)], [e])


def sleigh(q, a=F(2, 5), m=1, inertia=F(3, 10), spring=0):
    c, s, w = turn(q[2], 3, 2)
    x, y = rates(3, 0, 1)
    return System(3, [(m, x - w * (a * s)), (m, y + w * (a * c)), (inertia, w)], [y * c - x * s], spring * q[2])


def snakeboard(q, m=1, r=F(2, 5), rotor=F(3, 50), wheels=F(1, 100)):
    (c, s, w), (d, t, u) = turn(q[2], 5, 2), turn(q[4], 5, 4)
    x, y, v = rates(5, 0, 1, 3)
    squares = [(m, x), (m, y), (m * r * r - rotor, w), (rotor, w + v), (wheels, u)]
    front = y * (c * d - s * t) - x * (s * d + c * t) + w * (r * d)
    back = y * (c * d + s * t) - x * (s * d - c * t) - w * (r * d)
    return System(5, squares, [front, back])


def roller_racer(q):
    (c, s, w), (d, t, u) = turn(q[2], 4, 2), turn(q[3], 4, 3)
    x, y = rates(4, 0, 1)
    second = y * (c * d - s * t) - x * (s * d + c * t) + w * (F(3, 5) * d) + (w + u) * F(1, 5)
    return System(4, [(1, x), (1, y), (F(1, 5), w), (F(1, 20), w + u)], [y * c - x * s, second])


def carriage(q, l=F(1, 5), m=F(3, 2), inertia=F(3, 10), wheel=F(1, 50), r=F(1, 4), half=F(1, 2)):
    c, s, w = turn(q[2], 5, 2)
    x, y, right, left = rates(5, 0, 1, 3, 4)
    squares = [(m, x), (m, y), (inertia, w), (wheel, right), (wheel, left), *product(l, w, y * c - x * s)]
    ahead = x * c + y * s - (right + left) * (r / 2)
    return System(5, squares, [y * c - x * s, ahead, w - (right - left) * (r / (2 * half))])


def plate(q, m=1, a=F(1, 10), mass=2, inertia=F(3, 10)):
    rows, spin = attitude(q[2:5], 8, 2)
    ball, above = rates(8, 0, 1, None), rates(8, 5, 6, None)
    w = turn(q[7], 8, 7)[2]
    under = plus(ball, times(-a, cross(spin, up())))
    top = plus(ball, times(a, cross(spin, up())))
    over = [top[0] - above[0] + w * (q[1] - q[6]), top[1] - above[1] - w * (q[0] - q[5])]
    squares = [(m, f) for f in ball[:2]] + [(2 * m * a * a / 5, f) for f in spin] + [(mass, f) for f in above[:2]]
    return System(8, [*squares, (inertia, w)], under[:2] + over)


def field(n):
    return dot((F(3, 10), F(1, 2), 0), n)


def quadratic_field(n):
    return dot((F(1, 10), F(1, 4), F(9, 20)), [x * x for x in n])


BALL = {"moments": [F(1, 250)] * 3, "a": F(1, 10)}
ROUTH = {"off": (0, 0, F(-1, 10)), "moments": [F(3, 100), F(3, 100), F(1, 40)], "a": F(3, 10), "g": G}
# name: coordinates, those that are angles in the scene, the system, chart of the referee
SYSTEMS = {
    "sleigh": (3, [2], sleigh),
    "suslov": (3, [0, 1, 2], lambda q: about_a_point(q, F(3, 100))),
    "suslov-principal": (3, [0, 1, 2], about_a_point),
    "suslov-kharlamova": (3, [0, 1, 2], lambda q: about_a_point(q, potential=field)),
    "suslov-klebsh-tisserand": (3, [0, 1, 2], lambda q: about_a_point(q, potential=quadratic_field)),
    "suslov-inhomogeneous": (3, [0, 1, 2], lambda q: about_a_point(q, F(3, 100), turning=F(7, 10))),
    "veselova": (3, [0, 1, 2], lambda q: about_a_point(q, veselova=True)),
    "heisenberg-skew": (3, [], heisenberg),
    "snakeboard": (5, [2, 3, 4], snakeboard),
    "roller-racer": (4, [2, 3], roller_racer),
    "two-wheeled-carriage": (5, [2, 3, 4], carriage),
    "two-wheeled-carriage-balanced": (5, [2, 3, 4], lambda q: carriage(q, 0)),
    "chaplygin-sphere": (5, [2, 3, 4], on_a_plane),
    "rubber-chaplygin-sphere": (5, [2, 3, 4], lambda q: on_a_plane(q, rubber=True)),
    "routh-sphere": (5, [2, 3, 4], lambda q: on_a_plane(q, **ROUTH)),
    "turntable": (5, [2, 3, 4], lambda q: on_a_plane(q, **BALL, table=F(7, 10))),
    "ball-on-turning-table-chaplygin": (5, [2, 3, 4], lambda q: on_a_plane(q, table=F(7, 10))),
    "ball-with-gyrostat": (5, [2, 3, 4], lambda q: on_a_plane(q, rotor=(F(1, 50), F(1, 20), F(3, 100)))),
    "rubber-ball-off-centre": (5, [2, 3, 4], lambda q: on_a_plane(q, OFF, True)),
    "chaplygin-top": (5, [2, 3, 4], lambda q: on_a_plane(q, OFF)),
    "rubber-ball-on-sphere": (5, [0, 1, 2, 3, 4], lambda q: on_a_sphere(q, True)),
    "marble-ball-on-sphere": (5, [0, 1, 2, 3, 4], lambda q: on_a_sphere(q, False)),
    "plane-on-a-ball": (8, [2, 3, 4, 7], plate),
    "falling-disc": (5, None, disc),
    "ellipsoid-three-axes": (5, None, lambda q: ellipsoid(q, (F(1, 5), F(3, 20), F(1, 10)))),
    "ellipsoid-of-revolution": (5, None, lambda q: ellipsoid(q, (F(1, 5), F(1, 5), F(1, 10)))),
}
for name, kx, ky, table in [
    ("ball-in-paraboloid", F(6, 5), F(6, 5), 0),
    ("ball-in-elliptic-paraboloid", F(6, 5), F(7, 10), 0),
    ("ball-in-rotating-paraboloid", F(6, 5), F(6, 5), F(4, 5)),
]:

    def in_a_paraboloid(q, k=(kx, ky), table=table):
        return on_a_surface(q, k if isinstance(q[0], Angle) else paraboloid(*k), table=table)

    SYSTEMS[name] = (5, [0, 1, 2, 3, 4], in_a_paraboloid)
