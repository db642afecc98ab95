"""What is solved, and by whom."""

import math
from dataclasses import dataclass, field, replace

import deltaq

# times at which errors are taken, the start among them
TIMES = 21
TRAILERS = (5, 20, 80)
# motions at once, ending of their name, and by how much of each start value one is from the next
MEMBERS = 8
TOGETHER = "-together"
APART = {"sledge": {"phi": 0.05, "phi'": -0.05}, "cone": {"r": 0.02, "gamma'": 0.05}}
# from axle to hitch
LENGTH = 0.8


@dataclass
class Case:
    """A scene in a formulation, as a tool gets it."""

    title: str
    name: str
    toml: str
    formulation: str
    duration: float
    removal: str | None = None
    trailers: int | None = None
    # (tool, form), ours first; a form is `scene`, derived from the text, or `reduced`, by hand, or for a train
    # also `multipliers`, by hand too
    entrants: list = field(default_factory=list)
    # of several motions at once what differs, by name: a value for each
    vary: dict = field(default_factory=dict)
    # what this tool gets
    form: str = "scene"
    purpose: str = "time"
    # what the states of the start are: kind and name; and their values, free constants included
    tags: list = field(default_factory=list)
    start: list = field(default_factory=list)
    # the same of each of several motions, the first of which is that of the scene
    starts: list = field(default_factory=list)

    @property
    def problem(self):
        """What is solved, once or for several motions at once."""
        return self.name.removesuffix(TOGETHER)

    @property
    def members(self):
        """The values that vary, for each of several motions; of a single one nothing does."""
        return [dict(zip(self.vary, values)) for values in zip(*self.vary.values())] or [{}]

    @property
    def times(self):
        return [self.duration * i / (TIMES - 1) for i in range(TIMES)]

    @property
    def bodies(self):
        """The text of a train with a place for every body."""
        return train(self.trailers, self.duration, bodies=True)


def train(n, duration, bodies=False):
    """`trailer.toml` with n trailers, coordinates x, y, theta0 ... theta_n, headings evenly from 0.3 to 0
    rad.

    Or the same with a place for every body, x, y, theta0, x1, y1, theta1 ..., hitches as constraints: each
    touches neighbours only.
    """
    coordinates, definitions, constraints, squares, turns = [], [], [], [], []
    x, y, front = 0.0, 0.0, ("", "")
    for i in range(n + 1):
        own, heading = str(i or ""), 0.3 * (1 - i / n)
        if i:
            x, y = x - LENGTH * math.cos(heading), y - LENGTH * math.sin(heading)
        if bodies or not i:
            coordinates += [f'{name}{own} = {{ unit = "m", start = {at!r} }}' for name, at in (("x", x), ("y", y))]
        coordinates.append(f'theta{i} = {{ unit = "rad", start = {heading!r} }}')
        vx, vy = (f"x{own}'", f"y{own}'") if bodies or not i else (f"vx{i}", f"vy{i}")
        behind = f"{front[0]} + d*theta{i}'*sin(theta{i})", f"{front[1]} - d*theta{i}'*cos(theta{i})"
        if i and not bodies:
            definitions += [f'{vx} = "{behind[0]}"', f'{vy} = "{behind[1]}"']
        constraints.append(f"{vy}*cos(theta{i}) - {vx}*sin(theta{i})")
        if i and bodies:
            constraints += [f"{vx} - ({behind[0]})", f"{vy} - ({behind[1]})"]
        squares.append(f"{vx}^2 + {vy}^2")
        turns.append(f"theta{i}'^2")
        front = vx, vy
    lines = [f'title = "Car with {n} trailers"', "[parameters]", "m = 1.0", "J = 0.1", f"d = {LENGTH}", "[coordinates]"]
    lines += coordinates + ["[definitions]"] + definitions
    lines += ["[system]", f'lagrangian = "m/2*({" + ".join(squares)}) + J/2*({" + ".join(turns)})"', "constraints = ["]
    lines += [f'  "{f}",' for f in constraints] + ["]", "[start.velocities]", '"x\'" = "1.2*cos(theta0)"', '"theta0\'" = 0.5']
    return "\n".join(lines + ["[run]", f"duration = {duration}", ""])


def problems():
    """Every problem, in the order of the page."""
    sledge, cone = (deltaq.built_in(name).to_toml() for name in ("sledge", "ball-in-cone"))
    cases = [
        Case("sledge, Chetaev", "sledge-chetaev", sledge, "chetaev", 10.0),
        Case("sledge, vakonomic", "sledge-vakonomic", sledge, "vakonomic", 10.0),
        Case("sledge, removed", "sledge-removed", sledge, "removed-constraint", 10.0, "arc-length"),
        Case("cone, Chetaev", "cone-chetaev", cone, "chetaev", 5.0),
        Case("cone, vakonomic", "cone-vakonomic", cone, "vakonomic", 5.0),
    ]
    for case in cases:
        tools = ["deltaq", "heyoka", "scipy", "casadi"] + (["sympy"] if case.formulation == "chetaev" else [])
        case.entrants = [(tool, "scene") for tool in tools] + [("heyoka", "reduced")]
    cases += [together(case) for case in cases]
    by_hand = [("heyoka", "reduced"), ("scipy", "reduced"), ("casadi", "reduced"), ("scipy", "multipliers")]
    ours, sympy = ("deltaq", "scene"), ("sympy", "scene")
    for n in TRAILERS:
        entrants = [ours] + by_hand + [("heyoka", "scene"), ("casadi", "scene")] + ([sympy] if n <= 20 else [])
        cases.append(car(n, entrants))
    # no motion: how long SymPy needs between the smallest and the largest of those it is asked for
    return cases + [car(10, [ours, sympy])]


def together(case):
    """The same for several motions, by us in lanes and by heyoka in its batch mode; their velocities are projected."""
    toml = case.toml.replace("[start]\n", "[start]\nproject = true\n")
    scene = deltaq.parse(toml)
    place = {name + prime: x for prime, values in (("", scene.start.q), ("'", scene.start.v)) for name, x in zip(scene.coordinates, values)}
    vary = {name: [place[name] + i * step for i in range(MEMBERS)] for name, step in APART[case.name.partition("-")[0]].items()}
    entrants = [("deltaq", "together"), ("heyoka", "reduced")]
    return replace(case, toml=toml, title=f"{case.title}, {MEMBERS} at a time", name=case.name + TOGETHER, entrants=entrants, vary=vary)


def car(n, entrants):
    text = train(n, 10.0)
    return Case(f"{n} trailers, Chetaev", f"trailers-{n}", text, "chetaev", 10.0, trailers=n, entrants=entrants)
