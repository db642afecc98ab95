from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import Any, Final, Literal, TypeAlias, final

import numpy as np
import numpy.typing as npt

from ._films import FilmFit
from ._proof import Proof

_Array: TypeAlias = npt.NDArray[np.float64]
_Floats: TypeAlias = npt.ArrayLike
# text, or an expression of SymPy, which has no types
_Formula: TypeAlias = Any
_Expression: TypeAlias = _Formula | float
_Constants: TypeAlias = Literal["zero"] | Mapping[str, float] | npt.ArrayLike
_Verdict: TypeAlias = Literal["same", "different", "undecided"]

FORMULATIONS: tuple[str, ...]
METHODS: tuple[str, ...]
SCENES: tuple[str, ...]
__version__: str

class DeltaqError(Exception):
    """What deltaq refuses, and why."""

class SceneError(DeltaqError):
    """A fault in the description of a system, with its place: `file`, `line` and `column` (from 1; 0 where it is not in the text).
    """
    file: str
    line: int
    column: int

class UnknownNameError(DeltaqError, ValueError):
    """A name that means nothing where it stands: of a formulation, a removal, a number, a run."""
class SolveError(DeltaqError):
    """A motion that could not be started."""
class DerivationError(SolveError):
    """The formulation has no equations for this system."""
class RemovalError(SolveError):
    """A parametrization that does not remove the constraints."""
class StartError(SolveError):
    """Start values could not be found."""
class CompileError(SolveError):
    """The derived equations cannot be compiled."""
class EvaluationError(SolveError):
    """Equations that cannot be evaluated at a point."""
class BoundaryError(SolveError):
    """No free constants meet the condition at the horizon."""
class FaultError(DeltaqError):
    """A fault of deltaq itself, with its place; please report it."""
class CallError(SolveError):
    """The time integrator was called wrongly."""

_TABLE_SIZE: Final[int]

def load(path: str | PathLike[str], overrides: Mapping[str, float] | None = None) -> System:
    """A system from a scene file of at most 1 MiB.

    overrides: name to number: parameter, start value ("x", "x'"), "time", "duration", multiplier ("mu0_1").
    FileNotFoundError where there is no file; UnknownNameError for a name that the scene has not.
    """
def built_in(name: str, overrides: Mapping[str, float] | None = None) -> System:
    """The system of a built-in scene: one of SCENES, or "n-trailer-N", a car with N trailers.

    overrides: as in `load`.

    >>> deltaq.built_in("sledge", {"g": 1.6}).parameters["g"]
    1.6

    UnknownNameError for another name.
    """
def _read_again(name: str, text: str, overrides: list[tuple[str, float]]) -> System: ...
def _again(name: str, state: dict[str, Any]) -> Any: ...
def parse(text: str, overrides: Mapping[str, float] | None = None, *, name: str = "scene") -> System:
    """A system from the text of a scene file. `name` stands for the file in errors; overrides as in `load`."""

@final
class State:
    """A point of a motion: time, coordinates, velocities."""
    t: Final[float]
    """Time."""
    q: Final[_Array]
    """Coordinates, shape (n,), in the units of the system."""
    v: Final[_Array]
    """Velocities, shape (n,), in units of the coordinates per unit of time."""

@final
class System:
    """A mechanical system with velocity constraints, its start and everything else that a scene file says.

    Expressions: numbers, or strings as in scene files: coordinates, velocities (`x'`), parameters, time `t`;
    or SymPy's: coordinates are dynamicsymbols or names, velocities their derivatives, parameters symbols.

    coordinates: names of the n coordinates. lagrangian: L(q, v, t). constraints: f(q, v, t), h of them, each
    to be zero. parameters: name to number. definitions: name to expression, usable in all others. units:
    coordinate to text. forces: coordinate to expression, generalized forces Q. virtual: what rates of virtual
    displacements satisfy, h of them, for the formulation prescribed. observables: name to
    expression, what motions list besides; invariants: likewise, what should stay constant. view: name of a
    body to {"shape": ..., "size": [...], "at": ..., "rotation": ...}, as in [view.NAME]. start: every
    coordinate to its start. velocities: some ("x'") to their start; constraints supply the others, and
    start_equations, as in ["dot(W, n) = 5"] or what is zero. guess: velocities near which these are sought.
    project: move given velocities onto the constraints.
    removals: name to {"parameters": [...], "rates": {...}, ...}, as in [removal.NAME] of scene files.
    multipliers: mu0, shape (h,), zero by default. time: t0. duration: length of the run. breakpoints: times
    at which a step ends, where something is switched. notes: remarks.

    >>> sledge = deltaq.System(
    ...     coordinates=["x", "y", "phi"],
    ...     lagrangian="(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*sin(alpha)*x",
    ...     constraints=["y'*cos(phi) - x'*sin(phi)"],
    ...     parameters={"g": 9.81, "alpha": 0.4, "k": 0.7},
    ...     start={"x": 0, "y": 0, "phi": 0},
    ...     velocities={"phi'": 1, "x'": 0},
    ... )
    >>> sledge.constraint(0.0, sledge.start.q, sledge.start.v)
    array([0.])

    SceneError names the line of the scene file that the arguments amount to.
    """
    def __new__(
        cls,
        coordinates: Iterable[_Formula],
        lagrangian: _Formula,
        constraints: Iterable[_Formula] | None = None,
        *,
        start: Mapping[Any, _Expression],
        parameters: Mapping[Any, _Expression] | None = None,
        definitions: Mapping[Any, _Expression] | None = None,
        units: Mapping[Any, str] | None = None,
        virtual: Iterable[_Formula] | None = None,
        forces: Mapping[Any, _Expression] | None = None,
        observables: Mapping[str, _Expression] | None = None,
        invariants: Mapping[str, _Expression] | None = None,
        view: Mapping[str, Mapping[str, Any]] | None = None,
        velocities: Mapping[Any, _Expression] | None = None,
        start_equations: Iterable[_Formula] | None = None,
        guess: Mapping[Any, _Expression] | None = None,
        project: bool = False,
        removals: Mapping[str, Mapping[str, Any]] | None = None,
        multipliers: _Floats | None = None,
        time: float = 0.0,
        duration: float = 1.0,
        breakpoints: Iterable[float] | None = None,
        name: str = "system",
        title: str | None = None,
        notes: str = "",
    ) -> System: ...
    name: Final[str]
    """Name: that of the file without its ending."""
    title: Final[str]
    """Title, one line."""
    source: Final[str]
    """Where the example is from, empty where that is not said."""
    notes: Final[str]
    """Remarks, empty where there are none."""
    coordinates: Final[list[str]]
    """Names of the coordinates, length n."""
    units: Final[dict[str, str]]
    """Units of the coordinates, by name."""
    dimension: Final[int]
    """Number of coordinates, n."""
    parameters: Final[dict[str, float]]
    """Values of the parameters, by name."""
    lagrangian: Final[str]
    """The Lagrangian, as text."""
    constraints: Final[list[str]]
    """The constraints, as text, length h."""
    virtual: Final[list[str]]
    """What rates of virtual displacements satisfy, as text, length h; empty where that is not prescribed."""
    forces: Final[dict[str, str]]
    """The generalized forces other than zero, as text, by coordinate."""
    start: Final[State]
    """The start: t0, q0 and v0 with f(q0, v0, t0) = 0."""
    multipliers: Final[list[float]]
    """Multipliers mu0 at the start of vakonomic motions, length h."""
    duration: Final[float]
    """Length of the run, in the unit of time."""
    breakpoints: Final[list[float]]
    """Times at which a step ends, where something is switched."""
    removals: Final[list[str]]
    """Names of removals for the removed-constraint formulation: those written by hand, then automatic ones.

    RemovalError where there is none.
    """
    integrability: Final[str]
    """Frobenius' verdict on the constraints, in words; RemovalError where they are dependent at the start."""
    latex: Final[str]
    """The Lagrangian and the constraints in LaTeX: one `aligned` environment."""
    def replace(self, overrides: Mapping[str, float]) -> System:
        """The same system with other numbers in some places; overrides as in `load`, over those of before.

        >>> sledge.replace({"g": 1.6}).parameters["g"]
        1.6
        """
    def to_toml(self) -> str:
        """The system as a scene file's text, every start value a number; `parse` of it gives the same system."""
    def constraint(self, t: _Floats, q: _Floats, v: _Floats) -> _Array:
        """Constraint residuals f(q, v, t), shape (h,) or (k, h); q, v: (n,) or (k, n); t: a number or (k,)."""
    def mass(self, t: _Floats, q: _Floats, v: _Floats) -> _Array:
        """Mass matrix M(q, v, t) = d²L/dv², shape (n, n) or (k, n, n); arguments as in `constraint`.

        Distances of configurations are measured by it everywhere: sqrt(dq' M dq).
        """
    def equations(
        self,
        formulation: str = "chetaev",
        removal: str | None = None,
        *,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
    ) -> Equations:
        """The equations of motion under a formulation, one of FORMULATIONS.

        removal: a name in `removals`, "coordinates" or "quasi-velocities"; by default the first.
        constants: those of `Equations.initial_state`, as in `solve`; by default zero if natural at a horizon.

        >>> equations = sledge.equations("chetaev")
        >>> equations.states
        ['x', 'y', 'phi', "x'", "y'", "phi'"]
        >>> equations.rates(0.0, equations.initial_state())[:3]
        array([0., 0., 1.])
        """
    def linearize(
        self,
        formulation: str = "chetaev",
        *,
        free: list[str] | None = None,
        at: float | None = None,
        find: bool = False,
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
    ) -> Linearization:
        """The equations of motion to first order about the start, which has to be a steady motion.

        free: coordinates whose eigenvalues are asked for, with those of all that is coupled with them both
        ways; by default all. at: a time; about the motion there, steady or not. find: about a steady motion
        of Chetaev's equations near the start. Else as in `equations`. SolveError with what moves.
        """
    def linearize_over(
        self,
        over: Mapping[str, _Floats],
        formulation: str = "chetaev",
        *,
        free: list[str] | None = None,
        find: bool = False,
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
    ) -> LinearizationSweep:
        """`linearize` over the values of one number, and where stability changes between them: `deltaq
        linearize --sweep`.

        over: one name to its values, shape (k,): a parameter, a start value ("x", "x'"), a multiplier
        ("mu0_1"). Between neighbours of different stability the value where it changes is found by
        bisection.
        """
    def prove(self, almost_every_start: bool = False) -> Proof:
        """Proves that no multipliers mu0 make the vakonomic motion Chetaev's, from the start or from almost every one.

        >>> sledge.prove().certificate["order"] >= 1
        True
        """
    def integrals(self, formulation: str = "chetaev", degree: int = 2, names: Iterable[str] = ()) -> dict[str, Any]:
        """Which invariant measure and first integrals there are: printed, counted, or proved to be none.

        formulation: its own equations are looked at in the ansatz; measures and numbers of integrals are answered for
        "chetaev" alone.
        degree: the highest one in the velocities, from 1 to 3.
        names: coordinates that the functions of the ansatz contain; those in L and in the constraints if left out.

        As `deltaq integrals --format json` and its schema. Numbers count as they were written.

        >>> sledge.integrals(degree=1)["polynomials"][0]["answer"]
        'local'
        """
    def fit(
        self,
        film: Any,
        *more: Any,
        free: Iterable[str],
        sigma: float | str | Mapping[str, float | str] | None = None,
        law: Iterable[str] = (),
        known: Mapping[str, float] | None = None,
        formulations: Iterable[str] = ("chetaev", "vakonomic"),
        starts: int = 16,
        robust: bool = False,
        tolerance: float = 1e-9,
        max_steps: int = 2_000,
    ) -> FilmFit:
        """Fits what is not known of the system to films of its motions, in each formulation: `deltaq fit`.

        film: path of a CSV file, or a mapping (a dict, a DataFrame) with "t" and columns that are expressions by their names,
        shape (k,) each; NaN for a gap. free: unknowns, "g", "x~0.1", "Omega~0.7±0.01", "x@2". sigma: standard deviation of all
        columns, or by column. law: "eps", "slip". known: "psi'@2" to a number of one film. Else as in the command.

        >>> import numpy as np
        >>> times = np.linspace(0.05, 2, 40)
        >>> motion = sledge.solve("chetaev", times)
        >>> noise = 1e-3 * np.random.default_rng(2).normal(size=(2, 40))
        >>> film = {"t": times, "x": motion.coordinates[:, 0] + noise[0], "y": motion.coordinates[:, 1] + noise[1]}
        >>> found = sledge.fit(film, free=["g", "phi'"], sigma=1e-3)
        >>> found["chetaev"].verdict, found["vakonomic"].verdict
        ('supported', 'excluded')
        """
    def design(
        self,
        tell: Sequence[str] | None = None,
        *,
        film: str,
        estimate: str | None = None,
        over: Mapping[str, tuple[float, float]] | None = None,
        free: Iterable[str] = (),
        films: int = 1,
        columns: Iterable[str] = (),
        sigma: float | str | Mapping[str, float | str] | None = None,
        law: Iterable[str] = (),
        starts: int = 8,
        points: int = 32,
        tolerance: float = 1e-9,
        max_steps: int = 2_000,
        threads: int = 0,
    ) -> dict[str, Any]:
        """The film that would tell two formulations apart best, or show a number best: `deltaq design`, and its schema.

        tell: the formulation that is right, and the other one. estimate: the number, in place of tell. film: "60Hz,0.5mm,10s".
        over: what can be chosen, by name its bounds. free, sigma, law: as in `fit`.

        >>> heisenberg = deltaq.built_in("heisenberg")
        >>> found = heisenberg.design(("vakonomic", "chetaev"), film="20Hz,1mm,1s", over={"mu0_1": (0.1, 1)}, free=["x'", "y'"], points=4)
        >>> found["best"]["at"], found["best"]["value"] > 15
        ([1.0], True)
        """
    def _fit(
        self,
        tables: list[tuple[str, str]],
        free: list[str],
        law: list[str],
        sigma: list[str],
        known: list[tuple[int, str, float]],
        formulations: list[str],
        starts: int,
        robust: bool,
        tolerance: float,
        max_steps: int,
    ) -> _Fitted: ...
    def _design(
        self,
        aim: list[str],
        over: list[str],
        film: str,
        films: int,
        columns: list[str],
        sigma: list[str],
        free: list[str],
        law: list[str],
        starts: int,
        points: int,
        tolerance: float,
        max_steps: int,
        threads: int,
    ) -> str: ...
    def _certificate(self, almost_every_start: bool) -> tuple[str | None, str | None]: ...
    def _integrals(self, formulation: str, degree: int, names: list[str]) -> str: ...
    def _review(
        self, file: str, text: str, wheres: list[str], formulation: str, tolerance: float
    ) -> str: ...
    def _review_states(self) -> list[tuple[float, list[float], list[float]]]: ...
    def connect(
        self,
        to: Mapping[str, float],
        at: float | None = None,
        formulation: str = "vakonomic",
        *,
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
        starts: int = 60,
        tolerance: float = 1e-11,
        threads: int = 0,
    ) -> Connections:
        """The motions under a formulation that end at other coordinates: a two-point problem.

        to: coordinates at the end, name to number, as many as there are unknowns: start velocities that the
        constraints leave free, and free constants. at: time of the end; by default that of `duration`.
        mu0, constants: a first guess. starts: from how many starts motions are searched. Else as in `solve`.

        BoundaryError where there are more or fewer coordinates than unknowns; no motion found is no error.

        >>> geodesics = deltaq.built_in("heisenberg").connect({"x": 0.2, "y": 0.5, "z": 0.3})
        >>> [shortest] = geodesics.motions
        >>> shortest.is_minimum, round(shortest.unknowns["mu0_1"], 9)
        (True, 0.443803456)
        """

    def residuals(
        self,
        names: Sequence[str],
        times: _Floats,
        data: Mapping[str, _Floats],
        formulation: str = "chetaev",
        *,
        sigma: Mapping[str, float] | None = None,
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
        method: str = "auto",
        tolerance: float = 1e-11,
        max_steps: int = 100_000,
        penalty: float = 1e6,
    ) -> Residuals:
        """What a motion misses of data, as a function of numbers of the system that never raises: for
        `scipy.optimize.least_squares`.

        names: parameters, start values ("x", "x'"), multipliers ("mu0_1", ...) or costates ("P0_w") that are
        to vary. times: of the data, shape (k,), ascending. data: name of a column, a coordinate, a velocity
        ("x'") or a multiplier, to its values, shape (k,). sigma: name of a column to its unit, 1 by default.
        constants: zero by default where the removal's are natural at a horizon. penalty: what
        residuals are at times that a motion does not reach. Else as in `solve`, in one run.

        >>> times = [0.5, 1.0]
        >>> miss = sledge.residuals(["phi'"], times, {"phi": [0.6, 1.2]}, sigma={"phi": 0.1})
        >>> miss([1.0]).round(9), miss.jac([1.0]).round(9).tolist()
        (array([-1., -2.]), [[5.0], [10.0]])
        """

    def solve(
        self,
        formulation: str = "chetaev",
        times: _Floats | None = None,
        *,
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
        form: str = "auto",
        method: str = "auto",
        tolerance: float = 1e-11,
        project: bool = True,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
        sensitivities: Sequence[str] | None = None,
    ) -> Motion:
        """Derives and integrates the motion under a formulation, one of FORMULATIONS.

        times: where it is read off, shape (k,), ascending, to the last. By default 101 over `duration`.
        removal: a name in `removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0: start multipliers of the vakonomic formulations, shape (h,). By default those of the system.
        constants: free constants, "zero", {"horizon": T} (natural at T) or an array. By default those of the
        removal or of the system.
        form: of the equations, "multipliers", "costates", "quasi-velocities" or auto, which suits the system.
        method: one of METHODS, or auto, which suits the motion. tolerance: of the looser run; the one that is
        kept has a hundredth of it.
        project: move velocities onto the constraint after every step. max_steps, time_limit: limits on the
        steps of a run and on its seconds, after which it stops. max_step: no step is longer.
        sensitivities: names of parameters, start values ("x", "x'"), multipliers ("mu0_1", ...) or costates
        ("P0_w") by which all is derived: `Motion.sensitivities`.

        Other threads go on; Ctrl-C ends it. SolveError without a motion; `status` says if it stops early.

        >>> motion = sledge.solve("chetaev", [0.0, 0.5, 1.0])
        >>> motion.coordinates[:, 2].round(9)
        array([0. , 0.5, 1. ])
        >>> motion.status, motion.error_estimate < 1e-9
        ('completed', True)
        """
    def ensemble(
        self,
        formulation: str = "chetaev",
        times: _Floats | None = None,
        *,
        vary: Mapping[str, _Floats],
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
        tolerance: float = 1e-11,
        project: bool = True,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
        threads: int = 0,
        estimate: bool = True,
    ) -> Ensemble:
        """Integrates many motions at once, by Taylor series, under a formulation: starts or parameters differ.

        vary: name to array, shape (m,): parameters, start values ("x", "x'"), multipliers ("mu0_1", ...).
        times: where they are read off, shape (k,), ascending, to the last. By default the end of `duration`.
        threads: 0 for one per processor; results do not depend on it. estimate: whether each member is run
        twice, as in `solve`, or once and without an error estimate. Else as in `solve`, constants for all,
        and time_limit for one run of 4096 members.

        A member that cannot start or that stops is in the answer with its cause. Ctrl-C as in `solve`.

        >>> sledge.ensemble("chetaev", [1.0], vary={"phi'": [0.5, 1.0]}).coordinates[:, 0, 2].round(9)
        array([0.5, 1. ])
        """
    def compare(
        self,
        *,
        tolerance: float = 1e-11,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
        fits: Literal["undecided", "all", "none"] = "undecided",
    ) -> Comparison:
        """Compares the motions of all formulations pair by pair; tolerance, max_steps, max_step and time_limit
        as in `solve`. fits: free constants are fitted where nothing is decided ("undecided"), always ("all"),
        which takes most of the time, or never ("none").

        >>> comparison = sledge.compare()
        >>> comparison.verdict("chetaev", "vakonomic")
        'different'
        >>> comparison.decided[0].answer, comparison.decided[0].proved
        ('none', True)
        """
    def _sweep_points(
        self,
        names: list[str],
        values: _Floats,
        formulations: list[str] | None,
        tolerance: float,
        max_steps: int,
        max_step: float | None,
        time_limit: float | None,
        threads: int,
    ) -> dict[str, list[Any]]: ...
    def _moving(self, curves: list[tuple[str, str, _Floats, _Floats]]) -> str | None: ...
    def __reduce__(self) -> tuple[Any, tuple[str, str, list[tuple[str, float]]]]: ...
    def _repr_latex_(self) -> str: ...

@final
class Outputs:
    """Coordinates, velocities, multipliers and invariants at one instant, or at k of them."""
    coordinates: Final[_Array]
    """Coordinates q, shape (n,) or (k, n), in the units of the system."""
    velocities: Final[_Array]
    """Velocities q', shape (n,) or (k, n), in units of the coordinates per unit of time."""
    multipliers: Final[dict[str, Any]]
    """Multipliers and costates by name, each a float or of shape (k,)."""
    invariants: Final[dict[str, Any]]
    """Quantities that should stay constant by name, each a float or of shape (k,)."""
    observables: Final[dict[str, Any]]
    """Observables of the system by name, each a float or of shape (k,)."""

@final
class Equations:
    """The equations of motion y' = F(t, y) of a system under one formulation.

    `states` names the states y, `constants` what (q0, v0) leaves open. All callables take one state, t a
    number and y of shape (m,), or k of them at once, y of shape (k, m) with t a number or of shape (k,).
    """
    formulation: Final[str]
    """Name of the formulation."""
    removal: Final[str | None]
    """Name of the removal, None where the formulation needs none."""
    states: Final[list[str]]
    """Names of the states y, length m."""
    constants: Final[list[str]]
    """Names of the free constants."""
    text: Final[str]
    """The equations and what was left out of them, in the language of scenes."""
    latex: Final[str]
    """The equations in LaTeX: one `aligned` environment."""
    def to_c(self) -> str:
        """A file of C99: functions for rates and outputs without allocation, the start, the parameters.

        SolveError where unknowns of the instant are not found by linear equations; so in all three languages.
        """
    def to_numpy(self) -> str:
        """A module of Python: rates(t, y) and outputs(t, y) in NumPy, for one state or many at once."""
    def to_sympy(self) -> str:
        """A module of Python: RATES, OUTPUTS, MATRIX and RIGHT as matrices of SymPy in STATES and UNKNOWNS."""
    def initial_state(self, constants: _Constants | None = None) -> _Array:
        """The state y(t0) that belongs to the start of the system, shape (m,).

        constants: the free constants, "zero", {"horizon": T} (natural at T) or an array; default: as derived.
        """
    def rates(self, t: _Floats, y: _Floats, parameters: Mapping[str, float] | None = None) -> _Array:
        """Rates y' = F(t, y), of the shape of y.

        parameters: name to number, for this call. Its first use compiles equations that have parameters of
        these names as inputs; from then on a call costs the evaluation.
        """
    def jacobian(self, t: _Floats, y: _Floats, parameters: Mapping[str, float] | None = None) -> _Array:
        """The exact Jacobian dF/dy, shape (m, m) or (k, m, m): [i, j] is the derivative of rate i by state j.
        parameters: as in `rates`.
        """
    def outputs(self, t: _Floats, y: _Floats) -> Outputs:
        """Coordinates, velocities, multipliers and invariants at (t, y)."""
    def acceleration(self, t: float, q: _Floats, v: _Floats, mu: _Floats | None = None) -> _Array:
        """Accelerations q'' at one point, shape (n,): t a number, q and v of shape (n,).

        The vakonomic formulation also needs mu, shape (h,). ValueError where the states are others.
        """
    def integrate(
        self,
        times: _Floats,
        *,
        y0: _Floats | None = None,
        parameters: Mapping[str, float] | None = None,
        constants: _Constants | None = None,
        mu0: _Floats | None = None,
        method: str = "auto",
        tolerance: float = 1e-11,
        project: bool = True,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
    ) -> Trajectory:
        """One run of the time loop from the start of the system to the last of `times`, shape (k,), in ascending
        order: half of what `System.solve` does, for those who know the error from elsewhere.

        y0: the state to start from, shape (m,). parameters: name to number, for this run; without y0 the
        start follows, as of `System.replace`. constants, mu0: the free constants of this run, as in
        `solve`. The first use of parameters of some names compiles equations that have them as inputs; then
        a call costs the run. method: one of METHODS; its first run compiles what it needs. tolerance:
        relative and absolute. project, max_steps, max_step, time_limit: as in `System.solve`. For the start
        and the last time alone nothing else is kept.

        Other threads go on; Ctrl-C ends it. SolveError without a run; `status` says if it stops early.
        """
    def _repr_latex_(self) -> str: ...

@final
class Trajectory:
    """One run of the time loop, without a second one: only its tolerance tells anything of its error."""
    times: Final[_Array]
    """The times asked for, shape (k,)."""
    states: Final[_Array]
    """States y at `times`, shape (k, m); `Equations.outputs` reads coordinates and all else off them."""
    reached: Final[int]
    """How many of the times it reached: from there on the states are NaN."""
    status: Final[Literal["completed", "stopped"]]
    """"completed" or "stopped"."""
    cause: Final[str | None]
    """Why the run stopped, None where it is complete."""
    work: Final[dict[str, int]]
    """What the run cost, as in `Motion.work`."""
    seconds: Final[float]
    """Wall-clock seconds of the run and of reading the states off."""

@final
class Linearization:
    """The equations of motion to first order about a steady motion, or about an instant of any other."""
    form: Final[str]
    """The form of the formulation whose states these are."""
    t: Final[float]
    """Time."""
    is_steady: Final[bool]
    """Whether the motion is steady; at an instant of any other the eigenvalues are frozen."""
    states: Final[list[str]]
    """Names of the states y, length N: coordinates, and velocities or what stands for them."""
    values: Final[_Array]
    """Their values, shape (N,)."""
    carried: Final[dict[str, float]]
    """Coordinates on which no rate depends, with their rates: no states here, their eigenvalues are zero."""
    matrix: Final[_Array]
    """J = dF/dy, shape (N, N)."""
    of: Final[list[str]]
    """Names of the states whose eigenvalues these are."""
    eigenvalues: Final[npt.NDArray[np.complex128]]
    """Eigenvalues other than zero, complex, shape (k,), by falling real part, in 1 over the unit of time."""
    errors: Final[_Array]
    """How far they move where J moves by its error, shape (k,)."""
    zeros: Final[int]
    """How many more eigenvalues there are, all zero."""
    zero_vectors: Final[int]
    """Independent eigenvectors of all zeros of J: fewer than these where deviations grow as powers of time."""
    zero_error: Final[float]
    """How far these may be from zero."""
    unstable: Final[int]
    """How many eigenvalues have a real part above their error."""
    growing: Final[str]
    """The same in words: "like t" where an eigenvalue on the imaginary axis has too few eigenvectors,
    "undecided" where errors leave it open or all eigenvalues are zero.
    """

@final
class _Fitted:
    """Fits of formulations to films, to be asked further."""
    answer: Final[str]
    """The answer as JSON."""
    films: Final[list[tuple[str, list[float], list[tuple[str, float, list[float]]]]]]
    """By film: name, times of shape (k,), columns with standard deviations, and what was seen, shape (k,)."""
    def unknowns(self, place: int) -> list[tuple[str, float | None]]:
        """Names of the unknowns of formulation `place`, in the order of theta, with the least that each can be."""
    def chi_squared(self, place: int, theta: _Floats) -> float:
        """χ² with priors; infinite where there is no motion."""
    def slopes(self, place: int, theta: _Floats) -> _Array:
        """Its derivatives, shape (P,); zero where there is no motion."""
    def rises(self, place: int, name: str, at: list[float]) -> list[float] | None:
        """How χ² rises above its least where an unknown has these values, shape (k,), and the others are fitted
        again; None where there is none of this name.
        """
    def residuals(self, place: int) -> list[tuple[int, int, float, float]]:
        """Residuals of formulation `place`: film, column, time, (fitted - seen)/sigma."""

@final
class Connections:
    """What `System.connect` found."""
    formulation: Final[str]
    """Name of the formulation."""
    unknowns: Final[list[str]]
    """Names of the unknowns: free start velocities, free constants."""
    motions: Final[list[Connection]]
    """The motions, by rising action."""
    starts: Final[int]
    """Number of starts of the search."""
    failures: Final[dict[str, int]]
    """Why starts led nowhere, and how many."""
    runs: Final[int]
    """Motions integrated in the search, those with derivatives among them."""
    with_derivatives: Final[int]
    """How many of them with derivatives."""
    every_constant: Final[bool]
    """Whether every mu0 gives the same motions, so that none is unknown."""
    none: Final[str | None]
    """Why there is no motion at all; None elsewhere."""
    def __len__(self) -> int: ...

@final
class Connection:
    """A motion between two points."""
    system: Final[System]
    """The system with the start velocities and multipliers of this motion, until its end: `solve` it with
    `constants`.
    """
    unknowns: Final[dict[str, float]]
    """The unknowns by name."""
    errors: Final[dict[str, float]]
    """How far they may be wrong, by name."""
    constants: Final[_Array]
    """Free constants, shape (c,)."""
    velocities: Final[_Array]
    """Start velocities, shape (n,)."""
    action: Final[float]
    """The integral of L over time."""
    action_error: Final[float]
    """Error of its quadrature."""
    residuals: Final[dict[str, float]]
    """What the end is missed by, by coordinate."""
    condition: Final[float]
    """Condition number of the end by the unknowns, in units of the problem."""
    is_isolated: Final[bool]
    """Whether no other motion is beside it."""
    conjugate_times: Final[_Array | None]
    """Times conjugate to the start, shape (k,), rising; None where the unknowns are dependent at all times."""
    conjugate_errors: Final[_Array | None]
    """Their errors, shape (k,): what two runs differ by."""
    multiplicities: Final[list[int] | None]
    """By how much the rank falls there, length k."""
    is_minimum: Final[bool | None]
    """Whether the action has a local minimum, by conjugate times; None where that is not known."""
    second_variation: Final[str]
    """What the second variation of the action says, in words."""
    starts: Final[int]
    """How many starts led here."""

@final
class Residuals:
    """What a motion misses of data at k times, as a function of numbers p of its system: for `scipy.optimize`.

    Residual i of a column is (value at time i - data)/sigma; columns follow one another, so that there are
    as many residuals as columns times k. They have no unit where `sigma` has that of its column.

    A call never raises for numbers: at times that the motion does not reach residuals are `penalty`, with
    derivatives zero, and `ended` says why. Numbers that are no start give that at all times.
    """
    names: Final[list[str]]
    """Names of the numbers p, length P."""
    columns: Final[list[str]]
    """Names of the columns: coordinates ("x"), velocities ("x'"), multipliers and costates."""
    penalty: Final[float]
    """Residuals at times that a motion does not reach."""
    ended: Final[str | None]
    """Why the motion of the last call ended before the last time; None where it did not."""
    def __call__(self, p: _Floats) -> _Array: ...
    def jac(self, p: _Floats) -> _Array:
        """Their exact derivatives by p, shape (columns times k, P), finite whatever p is."""
    def __len__(self) -> int: ...

@final
class LinearizationSweep:
    """Steady motions over one number of a system, and where stability changes."""
    system: Final[System]
    """The system."""
    name: Final[str]
    """What varies."""
    values: Final[_Array]
    """Its values in the states that are linearized, shape (k,)."""
    asked: Final[_Array]
    """Its values in the starts from which these states were found, shape (k,); the same without `find`."""
    points: Final[list[Linearization]]
    """The equations to first order at each value."""
    changes: Final[list[StabilityChange]]
    """Where the number of eigenvalues with a positive real part changes, by rising value asked for."""
    def __len__(self) -> int: ...

@final
class StabilityChange:
    """A value at which stability changes."""
    value: Final[float]
    """The value, in the steady motion there."""
    width: Final[float]
    """Width of the interval in which it is: no error leaves another one open."""
    asked: Final[float]
    """The value in the start from which that motion was found; the same without `find`."""
    below: Final[int]
    """Eigenvalues with a positive real part below it."""
    above: Final[int]
    """Eigenvalues with a positive real part above it."""
    frequency: Final[float]
    """Imaginary part of the eigenvalue that crosses, not negative: 0 for one that does not oscillate."""

@final
class Motion:
    """One motion: the trajectory of a system under one formulation, with its error estimate.

    `times` are those asked for; all arrays belong to them. What the motion did not reach is NaN: `reached`
    counts the times that it did, `status` and `cause` say why. `at(t)` gives any other time; a motion that
    was pickled or copied is integrated anew for it, once.
    """
    system: Final[System]
    """The system that moves."""
    formulation: Final[str]
    """Name of the formulation."""
    removal: Final[str | None]
    """Name of the removal, None where the formulation needs none."""
    times: Final[_Array]
    """Times, shape (k,), in the unit of time of the system."""
    reached: Final[int]
    """How many of the times it reached."""
    coordinate_names: Final[list[str]]
    """Names of the coordinates, length n."""
    coordinates: Final[_Array]
    """Coordinates q at `times`, shape (k, n), in the units of the system."""
    velocities: Final[_Array]
    """Velocities q' at `times`, shape (k, n), in units of the coordinates per unit of time."""
    multipliers: Final[dict[str, _Array]]
    """Multipliers and costates by name, each of shape (k,)."""
    invariants: Final[dict[str, _Array]]
    """Quantities that should stay constant by name, each of shape (k,)."""
    observables: Final[dict[str, _Array]]
    """Observables of the system by name, each of shape (k,)."""
    error_estimate: Final[float]
    """Largest difference of the two runs, in the kinetic metric sqrt(dq' M dq): in practice an error bound."""
    relative_error_estimate: Final[float]
    """The error estimate over the largest distance from the start."""
    coordinate_error_estimates: Final[_Array]
    """Largest difference of the two runs in each coordinate up to each of `times`, shape (k, n), in the
    units of the system: the kinetic metric hides those of little inertia.
    """
    velocity_error_estimates: Final[_Array]
    """The same of velocities, shape (k, n)."""
    multiplier_error_estimates: Final[dict[str, _Array]]
    """The same of multipliers and costates, by name, each of shape (k,)."""
    sensitivities: Final[dict[str, Outputs]]
    """Derivatives of all this by the numbers asked for, by name; NaN from where they are not known."""
    sensitivity_error_estimates: Final[dict[str, Outputs]]
    """What the derivatives of the two runs differ by at most up to each of `times`, by name."""
    status: Final[Literal["completed", "untrusted", "stopped"]]
    """"completed", "untrusted" (the estimate is doubted or too large, for all or for one coordinate),
    "stopped".
    """
    cause: Final[str | None]
    """Why the motion is not completed, else None."""
    doubt: Final[str | None]
    """Why the error estimate is not to be trusted, None where nothing speaks against it."""
    start: Final[float]
    """Time of the start."""
    end: Final[float]
    """Last time at which the motion can be read off."""
    method: Final[tuple[str, str] | None]
    """The time-stepping method and why it was taken."""
    form: Final[tuple[str, str]]
    """Name of the form of the equations that was integrated, and why."""
    charts: Final[list[tuple[float, str]]]
    """Times from which the motion went on by "multipliers" or by "canonical momenta", because pivots became
    small.
    """
    constants: Final[dict[str, float]]
    """Values of the free constants, by name."""
    work: Final[dict[str, int]]
    """What the kept run cost: steps, rejected, evaluations, jacobians, orders (of Taylor series, summed)."""
    projection: Final[dict[str, float]]
    """What the projections moved: count, largest, total (Euclidean lengths of changes of the velocities)."""
    seconds: Final[dict[str, float]]
    """Wall-clock seconds: derive, compile, integrate."""
    def at(self, t: _Floats) -> Outputs:
        """Everything at time t, read off the dense output (order 7 for dop853).

        t is a number or of shape (k,), from start to end, where its last digit does not count; ValueError
        elsewhere.
        """
    def to_arrow(self) -> Any:
        """A pyarrow.Table, one row per time: t, coordinates, velocities (x'), multipliers, invariants, observables.

        What the motion did not reach is null; units are in the metadata of the columns.
        """
    def to_pandas(self) -> Any:
        """A pandas.DataFrame with the columns of `to_arrow`; t is the index."""
    def to_xarray(self) -> Any:
        """An xarray.Dataset over t with the columns of `to_arrow`; units are attributes."""
    def plot(self, ax: Any = None) -> Any:
        """Coordinates over time, one above the other, by matplotlib; a Figure. ax: n axes to draw into."""
    def animate(self) -> Any:
        """The bodies of the system's view along the motion, as a picture that plays by itself."""
    def _repr_html_(self) -> str: ...

@final
class Ensemble:
    """Motions of m members of one system: different starts or parameters, one formulation.

    `times` are those asked for; all arrays belong to members and times. What a member did not reach is NaN:
    `reached` counts the times that it did, `status` and `cause` say why.
    """
    system: Final[System]
    """The system that moves."""
    formulation: Final[str]
    """Name of the formulation."""
    removal: Final[str | None]
    """Name of the removal, None where the formulation needs none."""
    times: Final[_Array]
    """Times, shape (k,), in the unit of time of the system."""
    varied: Final[dict[str, _Array]]
    """What varies, by name, each of shape (m,)."""
    coordinate_names: Final[list[str]]
    """Names of the coordinates, length n."""
    coordinates: Final[_Array]
    """Coordinates q, shape (m, k, n), in the units of the system."""
    velocities: Final[_Array]
    """Velocities q', shape (m, k, n), in units of the coordinates per unit of time."""
    multipliers: Final[dict[str, _Array]]
    """Multipliers and costates by name, each of shape (m, k)."""
    invariants: Final[dict[str, _Array]]
    """Quantities that should stay constant by name, each of shape (m, k)."""
    error_estimate: Final[_Array]
    """Largest difference of the two runs of each member at these times, in the kinetic metric, shape (m,);
    NaN where there is one run only.
    """
    relative_error_estimate: Final[_Array]
    """The error estimate over the largest distance from the start at these times, shape (m,)."""
    status: Final[list[Literal["completed", "untrusted", "stopped", "refused"]]]
    """Per member "completed", "untrusted" (too large an error estimate), "stopped" or "refused" (no motion)."""
    cause: Final[list[str | None]]
    """Of each member why it is not completed, else None."""
    reached: Final[list[int]]
    """Of each member how many of the times it reached."""
    alone: Final[list[str | None]]
    """Of each member why it was integrated alone and not in company, else None: slower, and no worse."""
    seconds: Final[float]
    """Wall-clock seconds of the integration of all members."""
    def to_arrow(self, first: int = 0) -> Any:
        """A pyarrow.Table, one row per member and time: member (its place in the arrays, from `first` on), what varies
        ("set x"), t, coordinates, velocities (x'), multipliers, invariants, error_estimate, status, cause. What a member
        did not reach is null; units are in the metadata of the columns.
        """
    def to_pandas(self) -> Any:
        """A pandas.DataFrame with the columns of `to_arrow`."""
    def to_xarray(self) -> Any:
        """An xarray.Dataset over member, from 0, and t; what varies ("set x"), status and error_estimate over member.
        """
    def plot(self, ax: Any = None) -> Any:
        """Coordinates of the members over time, one above the other; a Figure. ax: n axes to draw into.

        Of an ensemble that was read off at one time, over what varies first.
        """
    def animate(self) -> Any:
        """The bodies of the system's view along eight of the members, straight between the ensemble's times."""
    def _repr_html_(self) -> str: ...
    def __len__(self) -> int: ...

@final
class Growth:
    """How a gap grows near the start: gap = length * (t - t0)**exponent."""
    exponent: Final[float]
    """Measured exponent."""
    uncertainty: Final[float]
    """By how much the exponent is uncertain."""
    coefficient: Final[_Array]
    """Leading coefficient of the second motion minus the first, shape (n,)."""
    length: Final[float]
    """Its length in the kinetic metric."""

@final
class LeadingTerm:
    """The leading term of the second motion minus the first, by Taylor coefficients of their accelerations."""
    exponent: Final[int]
    """Exponent of t - t0."""
    coefficient: Final[_Array]
    """Leading coefficient, shape (n,)."""
    length: Final[float]
    """Its length in the kinetic metric."""
    proved: Final[bool]
    """Whether exact numbers prove that this term is the first one, so that the motions differ."""

@final
class Pair:
    """Two motions compared."""
    first: Final[str]
    """Label of the first motion."""
    second: Final[str]
    """Label of the second motion."""
    verdict: Final[_Verdict]
    """"same", "different" or "undecided"."""
    because: Final[str | None]
    """Why the verdict is undecided, else None."""
    tau: Final[dict[float, float | None]]
    """First time at which the gap passes each threshold (1e-6, 1e-3, 0.1); None where it never does."""
    largest_gap: Final[float]
    """Largest gap sqrt(dq' M dq), among the certain ones where there are any."""
    largest_by_coordinate: Final[dict[str, float]]
    """Largest difference of each coordinate, by name."""
    certain_from: Final[float | None]
    """First sample at which the gap is certain, None where it never is."""
    error_estimates: Final[tuple[float, float]]
    """Largest error estimates of both motions, kinetic metric."""
    end: Final[float]
    """Time up to which both motions exist."""
    times: Final[_Array]
    """Samples of the gap: times, shape (k,)."""
    gap: Final[_Array]
    """Samples of the gap: gaps, shape (k,)."""
    limit: Final[_Array]
    """Samples of the gap: what each has to pass to count, shape (k,)."""
    growth: Final[Growth | None]
    """Growth near the start, None where the gap does not stand out from the errors there."""
    predicted: Final[LeadingTerm | None]
    """Predicted leading term; None if the gap has no growth, or the pair has no Taylor series."""

@final
class Fit:
    """The free constants with which one motion comes closest to another."""
    run: Final[str]
    """Label of the motion whose constants were fitted."""
    target: Final[str]
    """Label of the motion that was to be met."""
    constants: Final[dict[str, float] | None]
    """The best constants by name; None where no constants lead to a motion over the whole time."""
    verdict: Final[_Verdict | None]
    """"same", "different" or "undecided" of what is left; None as for `constants`."""
    largest_gap: Final[float | None]
    """Largest gap that is left, the least that was found; None as for `constants`."""
    largest_gap_by_half: Final[float | None]
    """The same from half of the starts; None as for `constants`."""
    settled: Final[bool | None]
    """Whether both are the same to 1 percent: if not, digits mean nothing; None as for `constants`."""
    starts: Final[int | None]
    """Number of starts of the search, 0 for an identity; None as for `constants`."""
    by_identity: Final[bool]
    """Whether the constants follow from those of the target, and nothing was searched."""

@final
class Decided:
    """Whether a motion belongs to the family that another formulation has for all values of its constants."""
    family: Final[str]
    """Label of the run whose constants are asked for."""
    motion: Final[str]
    """Label of the run that is to be met."""
    answer: Final[Literal["some", "none", "undecided"]]
    """"some", "none" or "undecided"."""
    proved: Final[bool]
    """Whether the answer is proved, in exact numbers or as an identity."""
    order: Final[int | None]
    """The Taylor order that proves "none", or through which "some" was checked; None where there is neither."""
    because: Final[str | None]
    """What stands in the way of a proof or of a decision, else None."""
    constants: Final[dict[str, float] | None]
    """The constants of least norm, or of the nearest miss, by name."""
    dimension: Final[int | None]
    """Dimension of the set of constants, None unless the answer is "some"."""
    identity: Final[list[str] | None]
    """The constants as functions of the start, where an identity was found."""
    mismatch: Final[float | None]
    """Least mismatch of accelerations over the motion's own, None where nothing could be computed."""

@final
class Run:
    """One formulation with all choices made, and what became of it."""
    label: Final[str]
    """Label: the formulation, and the removal where there are several."""
    formulation: Final[str]
    """Name of the formulation."""
    removal: Final[str | None]
    """Name of the removal, None where the formulation needs none."""
    motion: Final[Motion | None]
    """The motion, None where there is none."""
    error: Final[str | None]
    """Why there is no motion, None where there is one."""

@final
class Comparison:
    """A system in every formulation, pair by pair."""
    system: Final[System]
    """The system that moves."""
    integrability: Final[str]
    """Frobenius' verdict on the constraints, in words."""
    runs: Final[list[Run]]
    """All runs."""
    pairs: Final[list[Pair]]
    """All pairs that were compared."""
    fits: Final[list[Fit]]
    """Fits of free constants."""
    decided: Final[list[Decided]]
    """Which families have which motions: decided, not searched."""
    contradictions: Final[list[str]]
    """Results that exclude each other, in words: none, unless the program is wrong."""
    def pair(self, a: str, b: str) -> Pair:
        """The pair of two runs, in either order, named by label, or by formulation for the first of its kind.

        UnknownNameError where there is no such run, KeyError where the two were not compared.
        """
    def verdict(self, a: str, b: str) -> _Verdict:
        """"same", "different" or "undecided" for two runs, named as in `pair`."""
    def to_pandas(self) -> Any:
        """A pandas.DataFrame, a row a pair: verdict, times to the thresholds, largest gap, growth, why not."""
    def plot(self, ax: Any = None) -> Any:
        """Coordinates of all motions over time, then the gaps of the pairs with what they have to pass; a Figure.

        ax: n + 1 axes to draw into.
        """
    def animate(self) -> Any:
        """The bodies of the system's view along the first motion of each formulation, in one picture that plays by itself.
        """
    def _repr_html_(self) -> str: ...
