"""A robot description in URDF as a scene of bodies."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from math import cos, pi, sin
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ._native import DeltaqError, System, parse

Vector = list[float]
Matrix = list[list[float]]

# an angle as near as this to a quarter turn is one: files round pi/2 to 1.57
QUARTER = 1e-3
# how much the height of a wheel may differ from that of the first one, in parts of its radius
LEVEL = 1e-3


def from_urdf(
    file: str | Path,
    wheels: Iterable[str] = (),
    *,
    motors: Mapping[str, str | float] | None = None,
    start: Mapping[str, float] | None = None,
    velocities: Mapping[str, float] | None = None,
    gravity: float = 9.81,
    duration: float = 10.0,
    save: str | Path | None = None,
) -> System:
    """The system of a robot description (URDF).

    Parameters
    ----------
    file : str or Path
        The file. Links are bodies; revolute, continuous, prismatic and fixed joints are read, and damping at joints.
    wheels : iterable of str
        Links that roll on the ground without slip: a radius is that of their collision or visual geometry. With wheels the root moves in
        the plane by `x`, `y` and `phi`; without, it is fixed in space.
    motors : mapping, optional
        By name of a joint, the torque or force at it: a number or a formula in coordinates and `t`.
    start, velocities : mapping, optional
        Coordinates and velocities at the start, by name. Missing coordinates are 0. Constraints supply missing velocities; those of an arm are 0.
    gravity : float
        Acceleration of free fall along -z, in m/s².
    duration : float
        Of motions, in s.
    save : str or Path, optional
        Where the scene of bodies is written, for further work.

    Returns
    -------
    System
        The system.

    Raises
    ------
    DeltaqError
        If the file is not URDF, has a closed loop, a joint of another kind, or a wheel that does not stand on the ground as drawn.
    """
    path = Path(file)
    text = path.read_text("utf-8")
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise DeltaqError(f"{path}: a robot description has no document type")
    try:
        robot = ElementTree.fromstring(text)
    except ElementTree.ParseError as fault:
        raise DeltaqError(f"{path}: {fault}") from None
    scene = _Robot(path, robot).scene(list(wheels), dict(motors or {}), dict(start or {}), dict(velocities or {}), gravity, duration)
    if save is not None:
        Path(save).write_text(scene, "utf-8")
    return parse(scene)


def _numbers(element: ElementTree.Element | None, key: str, default: str) -> Vector:
    return [float(x) for x in (default if element is None else element.get(key, default)).split()]


def _axes(rpy: Vector) -> Matrix:
    """Fixed axes x, y, z: Rz(yaw) Ry(pitch) Rx(roll), of angles that are exact at quarter turns."""
    pairs = []
    for angle in rpy:
        quarters = round(2 * angle / pi)
        exact = abs(angle - quarters * pi / 2) < QUARTER
        pairs.append(([1.0, 0.0, -1.0, 0.0][quarters % 4], [0.0, 1.0, 0.0, -1.0][quarters % 4]) if exact else (cos(angle), sin(angle)))
    (cr, sr), (cp, sp), (cy, sy) = pairs
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr], [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]]


def _times(a: Matrix, b: Matrix) -> Matrix:
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def _turned(a: Matrix, v: Vector) -> Vector:
    return [sum(x * y for x, y in zip(row, v)) for row in a]


def _written(values: Iterable[float]) -> str:
    return "[" + ", ".join(repr(round(x, 12) + 0.0) for x in values) + "]"


class _Robot:
    """Links and joints. In the scene all axes are those of the root where every joint is at 0."""

    def __init__(self, path: Path, robot: ElementTree.Element) -> None:
        self.path = path
        self.links = {self.name(link): link for link in robot.findall("link")}
        if robot.tag != "robot" or not self.links:
            raise DeltaqError(f"{path}: expected <robot> with <link>s")
        self.joint: dict[str, ElementTree.Element] = {}
        self.parent: dict[str, str] = {}
        for joint in robot.findall("joint"):
            ends = [self.end(joint, word) for word in ("parent", "child")]
            if ends[1] in self.joint:
                raise DeltaqError(f"{path}: `{self.name(joint)}` closes a loop at the link `{ends[1]}`: write it as [loop] of a scene")
            self.parent[ends[1]], self.joint[ends[1]] = ends[0], joint
        roots = [link for link in self.links if link not in self.joint]
        if len(roots) != 1:
            raise DeltaqError(f"{path}: expected one link without a parent, found {', '.join(roots) or 'none: a closed loop'}")
        self.root = roots[0]
        self.order = [self.root]
        for link in self.order:
            self.order += [child for child, parent in self.parent.items() if parent == link]
        if len(self.order) < len(self.links):
            raise DeltaqError(f"{path}: a closed loop of the links {', '.join(self.links.keys() - set(self.order))}")

    def name(self, element: ElementTree.Element) -> str:
        name = element.get("name")
        if not name:
            raise DeltaqError(f"{self.path}: a <{element.tag}> without a name")
        return name

    def end(self, joint: ElementTree.Element, word: str) -> str:
        end = joint.find(word)
        link = "" if end is None else end.get("link", "")
        if link not in self.links:
            raise DeltaqError(f"{self.path}: the {word} of `{self.name(joint)}` is not a link: `{link}`")
        return link

    def coordinate(self, joint: ElementTree.Element) -> str:
        return re.sub(r"\W|^(?=\d)", "_", self.name(joint), flags=re.ASCII)

    def scene(
        self, wheels: list[str], motors: dict[str, Any], start: dict[str, float], velocities: dict[str, float], gravity: float, duration: float
    ) -> str:
        for wheel in wheels:
            if wheel not in self.joint:
                raise DeltaqError(f"{self.path}: there is no link `{wheel}` that could be a wheel")
        coordinates = {"x": "m", "y": "m", "phi": "rad"} if wheels else {}
        axes: dict[str, Matrix] = {self.root: _axes([0.0, 0.0, 0.0])}
        place: dict[str, Vector] = {self.root: [0.0, 0.0, 0.0]}
        bodies, links, height = [], "", None
        for link in self.order:
            lines = [f'[body."{link}"]']
            if link == self.root:
                lines.append('joint = { plane = ["x", "y", "phi"], at = [0, 0, HEIGHT] }' if wheels else "at = [0, 0, 0]")
            else:
                joint, parent = self.joint[link], self.parent[link]
                kind, origin, name = joint.get("type", ""), joint.find("origin"), self.name(joint)
                at = _turned(axes[parent], _numbers(origin, "xyz", "0 0 0"))
                place[link] = [a + b for a, b in zip(place[parent], at)]
                axes[link] = _times(axes[parent], _axes(_numbers(origin, "rpy", "0 0 0")))
                axis = _turned(axes[link], _numbers(joint.find("axis"), "xyz", "1 0 0"))
                if joint.find("mimic") is not None:
                    raise DeltaqError(f"{self.path}: `{name}` mimics another joint: write that as a constraint of a scene")
                moves = {"revolute": ("hinge", "angle"), "continuous": ("hinge", "angle"), "prismatic": ("slider", "shift"), "fixed": None}
                if kind not in moves:
                    raise DeltaqError(f"{self.path}: `{name}` is {kind or 'of no type'}; read are {', '.join(moves)}")
                q = self.coordinate(joint)
                if words := moves[kind]:
                    if q in coordinates or q == "t":
                        raise DeltaqError(f"{self.path}: two coordinates would be called `{q}`")
                    coordinates[q] = "m" if kind == "prismatic" else "rad"
                    damping = _numbers(joint.find("dynamics"), "damping", "0")[0]
                    links += f'[damper."{name}"]\njoint = "{link}"\ndamping = {damping!r}\n' if damping else ""
                    links += f'[motor."{name}"]\njoint = "{link}"\nforce = {self.formula(motors.pop(name))}\n' if name in motors else ""
                moved = f'{words[0]} = {_written(axis)}, {words[1]} = "{q}"' if words else "fixed = true"
                lines += [f'on = "{parent}"', f"joint = {{ {moved}, at = {_written(at)} }}"]
            lines += self.inertia(link, axes[link])
            if link in wheels:
                if abs(abs(axis[1]) - 1) > QUARTER or kind not in ("continuous", "revolute"):
                    raise DeltaqError(f"{self.path}: the wheel `{link}` does not turn about the y axis of the root, but about {_written(axis)}")
                radius = self.radius(link)
                stands = radius - place[link][2]
                height = stands if height is None else height
                if abs(stands - height) > LEVEL * radius:
                    raise DeltaqError(f"{self.path}: the wheel `{link}` is {stands - height:.3g} m below the ground on which the first one stands")
                lines += ['shape = "wheel"', f"size = [{radius - stands + height!r}]"]
                links += f'[contact."{link}"]\nof = "{link}"\nlaw = "rolls"\n'
            bodies.append("\n".join(lines).replace("HEIGHT", repr(height)) if height is not None else "\n".join(lines))
        if motors:
            raise DeltaqError(f"{self.path}: no joint that moves is called `{next(iter(motors))}`")
        carries = {self.coordinate(self.joint[link]) for wheel in wheels for link in self.chain(wheel)} | {"x", "y", "phi"}
        rates = {f"{q}'": 0.0 for q in coordinates if not (wheels and q in carries)} | velocities
        text = f'title = "{self.path.stem}"\ngravity = [0, 0, {-gravity!r}]\n[coordinates]\n'
        text += "".join(f'{q} = {{ unit = "{unit}", start = {start.get(q, 0.0)!r} }}\n' for q, unit in coordinates.items())
        if unknown := [name for name in start if name not in coordinates]:
            raise DeltaqError(f"{self.path}: `{unknown[0]}` is not a coordinate; they are {', '.join(coordinates)}")
        text += "\n".join(bodies).replace("HEIGHT", repr(height)) + "\n" + links + "[start.velocities]\n"
        return text + "".join(f'"{name}" = {x!r}\n' for name, x in rates.items()) + f"[run]\nduration = {duration!r}\n"

    def chain(self, link: str) -> list[str]:
        """The link and those that carry it, without the root."""
        return [] if link == self.root else [link, *self.chain(self.parent[link])]

    def formula(self, force: str | float) -> str:
        return f'"{force}"' if isinstance(force, str) else repr(float(force))

    def inertia(self, link: str, axes: Matrix) -> list[str]:
        """Mass, mass centre and moments about it."""
        inertial = self.links[link].find("inertial")
        if inertial is None:
            return []
        origin, tensor = inertial.find("origin"), inertial.find("inertia")
        own = _times(axes, _axes(_numbers(origin, "rpy", "0 0 0")))
        of = lambda name: _numbers(tensor, name, "0")[0]  # noqa: E731
        rows = [[of("ixx"), of("ixy"), of("ixz")], [of("ixy"), of("iyy"), of("iyz")], [of("ixz"), of("iyz"), of("izz")]]
        rows = _times(_times(own, rows), [list(column) for column in zip(*own)])
        diagonal = all(rows[i][j] == 0 for i in range(3) for j in range(3) if i != j)
        moments = _written(rows[i][i] for i in range(3)) if diagonal else "[" + ", ".join(_written(row) for row in rows) + "]"
        mass = _numbers(inertial.find("mass"), "value", "0")[0]
        return [f"mass = {mass!r}", f"mass-centre = {_written(_turned(axes, _numbers(origin, 'xyz', '0 0 0')))}", f"inertia = {moments}"]

    def radius(self, link: str) -> float:
        for word in ("collision", "visual"):
            geometry = self.links[link].find(f"{word}/geometry")
            for shape in () if geometry is None else geometry:
                if radius := shape.get("radius"):
                    return float(radius)
        raise DeltaqError(f"{self.path}: the wheel `{link}` has no cylinder or sphere that would give its radius")
