from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Final, Literal, TypeAlias, final, overload

import numpy as np
import numpy.typing as npt

from . import _animate, _code, _columns, _films, _notebook, _plots, _proof, _tables

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

    Parameters
    ----------
    path : str or path-like
        The file.
    overrides : mapping of str to float, optional
        Numbers in place of those of the text: parameters, start values ("x", "x'"), "time", "duration",
        multipliers ("mu0_1").

    Returns
    -------
    System
        The system.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    SceneError
        If the text has a fault, with its place.
    UnknownNameError
        If `overrides` has a name that is not in the scene.
    """
def built_in(name: str, overrides: Mapping[str, float] | None = None) -> System:
    """The system of a built-in scene.

    Parameters
    ----------
    name : str
        One of `SCENES`, or "n-trailer-N", a car with N trailers.
    overrides : mapping of str to float, optional
        Numbers in place of those of the text: parameters, start values ("x", "x'"), "time", "duration",
        multipliers ("mu0_1").

    Returns
    -------
    System
        The system.

    Raises
    ------
    UnknownNameError
        If there is no such scene, or no such number.

    Examples
    --------
    >>> deltaq.built_in("sledge", {"g": 1.6}).parameters["g"]
    1.6
    """
def _read_again(name: str, text: str, overrides: list[tuple[str, float]]) -> System: ...
def parse(text: str, overrides: Mapping[str, float] | None = None, *, name: str = "scene") -> System:
    """A system from the text of a scene file.

    Parameters
    ----------
    text : str
        The text, TOML.
    overrides : mapping of str to float, optional
        Numbers in place of those of the text: parameters, start values ("x", "x'"), "time", "duration",
        multipliers ("mu0_1").
    name : str
        Stands for the file in errors.

    Returns
    -------
    System
        The system.

    Raises
    ------
    SceneError
        If the text has a fault, with its place.
    UnknownNameError
        If `overrides` has a name that is not in the scene.
    """

@final
class State:
    """A point of a motion: time, coordinates, velocities."""
    t: Final[float]
    """Time."""
    q: Final[_Array]
    """Coordinates, shape (n,), in the units of the system."""
    v: Final[_Array]
    """Velocities, shape (n,), in units of the coordinates per unit of time."""
    @classmethod
    def _again(cls, state: dict[str, Any]) -> State: ...

@final
class System:
    """A mechanical system with velocity constraints, its start and everything else that a scene file says.

    A formula is a number or a string as in scene files, of coordinates, velocities (`x'`), parameters and the time
    `t`; or an expression of SymPy, whose coordinates are dynamicsymbols or names. Two systems are equal if they say
    the same, with the same numbers.

    Parameters
    ----------
    coordinates : iterable of formulas
        Names of the n coordinates.
    lagrangian : formula
        L(q, v, t).
    constraints : iterable of formulas, optional
        f(q, v, t), h of them, each to be zero.
    start : mapping
        Every coordinate to its start.
    parameters : mapping, optional
        Parameters to numbers.
    definitions : mapping, optional
        Names to expressions that all others can contain.
    units : mapping, optional
        Coordinates to the text of their unit.
    virtual : iterable of formulas, optional
        Equations of the rates of virtual displacements, h of them, for the formulation "prescribed".
    forces : mapping, optional
        Coordinates to generalized forces Q.
    observables : mapping, optional
        Names to expressions that motions list in addition.
    invariants : mapping, optional
        Names to expressions that should stay constant.
    view : mapping, optional
        Names of bodies to {"shape": ..., "size": [...], "at": ..., "rotation": ...}, as in [view.NAME].
    velocities : mapping, optional
        Some velocities ("x'") to their start; constraints and `start_equations` determine the others.
    start_equations : iterable of formulas, optional
        Equations of the start, as in ["dot(W, n) = 5"], or expressions that are zero.
    guess : mapping, optional
        Velocities near which the others are sought.
    project : bool
        Whether given velocities are projected onto the constraints.
    removals : mapping, optional
        Names to {"parameters": [...], "rates": {...}, ...}, as in [removal.NAME].
    multipliers : array_like of shape (h,), optional
        Start multipliers mu0; zero by default.
    time : float
        Time t0 of the start.
    duration : float
        Length of the run.
    breakpoints : iterable of float, optional
        Times at which a step ends because something is switched.
    name : str
        Name of the system.
    title : str, optional
        One line; by default the name.
    notes : str
        Remarks.

    Raises
    ------
    SceneError
        If an argument has a fault; it names the line of the scene file that the arguments amount to.

    Examples
    --------
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
    observables: Final[dict[str, str]]
    """What motions list in addition, as text, by name."""
    invariants: Final[dict[str, str]]
    """What should stay constant along motions, as text, by name."""
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
    def replace(self, overrides: Mapping[str, float] | None = None, /, **numbers: float) -> System:
        """The same system with other numbers in some places, over those that were replaced before.

        Parameters
        ----------
        overrides : mapping of str to float, optional
            Numbers in place of the system's: parameters, start values ("x", "x'"), "time", "duration",
            multipliers ("mu0_1").
        **numbers : float
            The same by keyword.

        Returns
        -------
        System
            The other system.

        Raises
        ------
        UnknownNameError
            If the system has no such number.
        TypeError
            If a number is given twice.

        Examples
        --------
        >>> sledge.replace(g=1.6) == sledge.replace({"g": 1.6})
        True
        """
    def to_toml(self) -> str:
        """The system as the text of a scene file, with every start value as a number.

        Returns
        -------
        str
            The text; `parse` of it gives an equal system.
        """
    def constraint(self, t: _Floats, q: _Floats, v: _Floats) -> _Array:
        """Constraint residuals f(q, v, t).

        Parameters
        ----------
        t : float or array_like of shape (k,)
            Times.
        q : array_like of shape (n,) or (k, n)
            Coordinates.
        v : array_like of shape (n,) or (k, n)
            Velocities.

        Returns
        -------
        ndarray of shape (h,) or (k, h)
            The residuals.

        Raises
        ------
        ValueError
            If a shape is wrong, or a number not finite.
        """
    def mass(self, t: _Floats, q: _Floats, v: _Floats) -> _Array:
        """Mass matrix M(q, v, t) = d²L/dv². Distances of configurations are sqrt(dq' M dq) everywhere.

        Parameters
        ----------
        t : float or array_like of shape (k,)
            Times.
        q : array_like of shape (n,) or (k, n)
            Coordinates.
        v : array_like of shape (n,) or (k, n)
            Velocities.

        Returns
        -------
        ndarray of shape (n, n) or (k, n, n)
            The matrix.

        Raises
        ------
        ValueError
            If a shape is wrong, or a number not finite.
        """
    def equations(
        self,
        formulation: str = "chetaev",
        removal: str | None = None,
        *,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
    ) -> Equations:
        """The equations of motion under a formulation.

        Parameters
        ----------
        formulation : str
            One of `FORMULATIONS`.
        removal : str, optional
            A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0 : array_like of shape (h,), optional
            Start multipliers of the vakonomic formulations; by default those of the system.
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values; by default as in `solve`, and zero
            instead of natural.

        Returns
        -------
        Equations
            Functions of arrays, and code.

        Raises
        ------
        UnknownNameError
            If there is no such formulation or removal.
        SolveError
            If the formulation has no equations for the system.

        Examples
        --------
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

        Parameters
        ----------
        formulation : str
            One of `FORMULATIONS`.
        free : list of str, optional
            Coordinates whose eigenvalues are wanted, with those of all that is coupled with them both ways; by
            default all.
        at : float, optional
            A time: about the motion there, steady or not.
        find : bool
            About a steady motion of Chetaev's equations near the start.
        removal : str, optional
            A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0 : array_like of shape (h,), optional
            Start multipliers of the vakonomic formulations; by default those of the system.
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values.

        Returns
        -------
        Linearization
            Jacobian and eigenvalues.

        Raises
        ------
        SolveError
            If the start is not a steady motion; it names what moves.
        UnknownNameError
            If a name is unknown.
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
        """`linearize` over the values of one number, and where stability changes between them: `deltaq linearize --sweep`.

        Parameters
        ----------
        over : mapping of str to array_like of shape (k,)
            One name to its values: a parameter, a start value ("x", "x'") or a multiplier ("mu0_1").
        formulation : str
            One of `FORMULATIONS`.
        free : list of str, optional
            Coordinates whose eigenvalues are wanted, with those of all that is coupled with them both ways; by
            default all.
        find : bool
            About steady motions of Chetaev's equations near the starts.
        removal : str, optional
            A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0 : array_like of shape (h,), optional
            Start multipliers of the vakonomic formulations; by default those of the system.
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values.

        Returns
        -------
        LinearizationSweep
            A linearization per value, and the values at which stability changes, by bisection.

        Raises
        ------
        ValueError
            If `over` does not have one name.
        SolveError
            If a start is not a steady motion.
        """
    prove = _proof.prove
    integrals = _proof.integrals
    fit = _films.fit
    design = _films.design
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

        Parameters
        ----------
        to : mapping of str to float
            Coordinates at the end, as many as there are unknowns: start velocities that the constraints leave free,
            and free constants.
        at : float, optional
            Time of the end; by default that of `duration`.
        formulation : str
            One of `FORMULATIONS`.
        removal : str, optional
            A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0 : array_like of shape (h,), optional
            First guess of the start multipliers of the vakonomic formulations.
        constants : "zero", {"horizon": T} or array_like, optional
            First guess of the free constants: zero, natural at time T, or their values.
        starts : int
            From how many starts motions are searched.
        tolerance : float
            Tolerance of the looser run; the one that is kept has a hundredth of it.
        threads : int
            0 for one per processor.

        Returns
        -------
        Connections
            The motions that were found; there may be none.

        Raises
        ------
        BoundaryError
            If there are more or fewer coordinates than unknowns.

        Examples
        --------
        >>> geodesics = deltaq.built_in("heisenberg").connect({"x": 0.2, "y": 0.5, "z": 0.3})
        >>> [shortest] = geodesics.motions
        >>> shortest.is_minimum, round(shortest.unknowns["mu0_1"], 9)
        (True, 0.443803456)
        """

    residuals = _columns.residuals

    def _residuals(
        self,
        names: Sequence[str],
        times: _Floats,
        data: Mapping[str, _Floats],
        formulation: str,
        *,
        sigma: Mapping[str, float] | None = None,
        removal: str | None = None,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
        method: str = "auto",
        tolerance: float = 1e-11,
        max_steps: int = 100_000,
        penalty: float = 1e6,
    ) -> Residuals: ...
    def solve(
        self,
        formulation: str = "chetaev",
        times: _Floats | None = None,
        *,
        parameters: Mapping[str, float] | None = None,
        start: Mapping[str, float] | None = None,
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
        """Derives and integrates the motion under a formulation.

        Other threads go on; Ctrl-C ends it.

        Parameters
        ----------
        formulation : str
            One of `FORMULATIONS`.
        times : float or array_like of shape (k,), optional
            Where the motion is read off, ascending, to the last; by default at 101 over `duration`. One time as a number leaves out the axis of times.
        parameters : mapping of str to float, optional
            Parameters for this call; `Motion.system` has them.
        start : mapping of str to float, optional
            Coordinates and velocities ("x", "x'") at the start for this call; `Motion.system` has them.
        removal : str, optional
            A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0 : array_like of shape (h,), optional
            Start multipliers of the vakonomic formulations; by default those of the system.
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values; by default those of
            the removal or of the system.
        form : str
            Of the equations: "multipliers", "costates", "quasi-velocities", or "auto", which suits the system.
        method : str
            One of `METHODS`, or "auto", which suits the motion.
        tolerance : float
            Tolerance of the looser run; the one that is kept has a hundredth of it.
        project : bool
            Whether velocities are projected onto the constraints after every step.
        max_steps : int
            Limit on the steps of a run.
        max_step : float, optional
            No step is longer.
        time_limit : float, optional
            Limit on the seconds of a run.
        sensitivities : sequence of str, optional
            Parameters, start values ("x", "x'"), multipliers ("mu0_1", ...) or costates ("P0_w") by which all is
            derived: `Motion.sensitivities`.

        Returns
        -------
        Motion
            The motion; `status` tells if it stops early.

        Raises
        ------
        SolveError
            If there is no motion.
        UnknownNameError
            If a name is unknown.
        ValueError
            If times do not ascend, or begin before the start.

        Examples
        --------
        >>> motion = sledge.solve("chetaev", [0.0, 0.5, 1.0])
        >>> motion["phi"].round(9)
        array([0. , 0.5, 1. ])
        >>> motion.status, motion.error_estimate < 1e-9
        ('completed', True)
        >>> sledge.solve("chetaev", 1.0, start={"phi'": 2}).coordinates[2].round(9)
        np.float64(2.0)
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

        Ctrl-C ends it, as in `solve`.

        Parameters
        ----------
        formulation : str
            One of `FORMULATIONS`.
        times : float or array_like of shape (k,), optional
            Where the members are read off, ascending, to the last; by default at the end of `duration`. One time as a number leaves out the axis of times.
        vary : mapping of str to array_like of shape (m,)
            Parameters, start values ("x", "x'") or multipliers ("mu0_1", ...).
        removal : str, optional
            A name in `System.removals`, "coordinates" or "quasi-velocities"; by default the first.
        mu0 : array_like of shape (h,), optional
            Start multipliers of the vakonomic formulations; by default those of the system.
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values, for all members.
        tolerance : float
            Tolerance of the looser run; the one that is kept has a hundredth of it.
        project : bool
            Whether velocities are projected onto the constraints after every step.
        max_steps : int
            Limit on the steps of a run.
        max_step : float, optional
            No step is longer.
        time_limit : float, optional
            Limit on the seconds of a run of 4096 members.
        threads : int
            0 for one per processor; results do not depend on it.
        estimate : bool
            Whether each member is run twice, as in `solve`, or once and without an error estimate.

        Returns
        -------
        Ensemble
            All members; one that cannot start, or that stops, has its cause.

        Raises
        ------
        ValueError
            If `vary` is empty or has arrays of different lengths.
        UnknownNameError
            If a name is unknown.

        Examples
        --------
        >>> sledge.ensemble("chetaev", 1.0, vary={"phi'": [0.5, 1.0]})["phi"].round(9)
        array([0.5, 1. ])
        """
    def compare(
        self,
        formulations: list[str] | None = None,
        *,
        extent: Literal["answer", "everything", "gaps"] = "answer",
        decision: bool = True,
        fits: Literal["undecided", "all", "none"] = "undecided",
        tolerance: float = 1e-11,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
    ) -> Comparison:
        """Compares the motions of all formulations pair by pair: `deltaq compare`.

        Parameters
        ----------
        formulations : list of str, optional
            Those to compare; by default all.
        extent : {"answer", "everything", "gaps"}
            What is computed in addition to the gaps: the growth of the gap between Chetaev's and the vakonomic motion,
            and whether some mu0 makes the second the first ("answer", which is what the command prints); the same of
            all pairs and families ("everything"); or nothing ("gaps").
        decision : bool
            Whether it is decided which families have which motions.
        fits : {"undecided", "all", "none"}
            Whether free constants are fitted if nothing is decided, always (which takes most of the time), or never.
        tolerance : float
            Tolerance of the looser run; the one that is kept has a hundredth of it.
        max_steps : int
            Limit on the steps of a run.
        max_step : float, optional
            No step is longer.
        time_limit : float, optional
            Limit on the seconds of a run.

        Returns
        -------
        Comparison
            Motions, pairs, decisions and fits.

        Raises
        ------
        SolveError
            If the constraints are dependent at the start.
        UnknownNameError
            If a name is unknown.

        Examples
        --------
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
        decision: bool,
        tolerance: float,
        max_steps: int,
        max_step: float | None,
        time_limit: float | None,
        threads: int,
    ) -> dict[str, list[Any]]: ...
    def _moving(self, curves: list[tuple[str, str, _Floats, _Floats]]) -> str | None: ...
    def __reduce__(self) -> tuple[Any, tuple[str, str, list[tuple[str, float]]]]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
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
    def __reduce__(self) -> tuple[Any, tuple[dict[str, Any]]]: ...

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
    parameters: Final[dict[str, float]]
    """Values of the parameters of the system, by name: those that `rates`, `jacobian` and `integrate` take."""
    text: Final[str]
    """The equations and what was left out of them, in the language of scenes."""
    latex: Final[str]
    """The equations in LaTeX: one `aligned` environment."""
    def to_c(self) -> str:
        """The equations as a file of C99: rates and outputs without allocation, the start, the parameters.

        Returns
        -------
        str
            The file.

        Raises
        ------
        SolveError
            If unknowns of the instant are not found by linear equations.
        """
    def to_numpy(self) -> str:
        """The equations as a module of Python: rates and outputs in NumPy, for one state or many at once.

        Returns
        -------
        str
            The module.

        Raises
        ------
        SolveError
            If unknowns of the instant are not found by linear equations.
        """
    def to_jax(self) -> str:
        """The module of `to_numpy` for JAX: jit, grad and vmap go through rates and outputs.

        Returns
        -------
        str
            The module.

        Raises
        ------
        SolveError
            If unknowns of the instant are not found by linear equations.
        """
    def to_numba(self) -> str:
        """The equations as a module of Python: rates and outputs for one state, compiled by Numba.

        Returns
        -------
        str
            The module.

        Raises
        ------
        SolveError
            If unknowns of the instant are not found by linear equations.
        """
    def to_sympy(self) -> str:
        """The equations as a module of Python: RATES, OUTPUTS, MATRIX, RIGHT as matrices of SymPy.

        Returns
        -------
        str
            The module.

        Raises
        ------
        SolveError
            If unknowns of the instant are not found by linear equations.
        """
    def initial_state(self, constants: _Constants | None = None) -> _Array:
        """The state y(t0) that belongs to the start of the system.

        Parameters
        ----------
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values; by default as derived.

        Returns
        -------
        ndarray of shape (m,)
            The state.

        Raises
        ------
        BoundaryError
            If no constants meet the condition at the horizon.
        """
    def rates(self, t: _Floats, y: _Floats, parameters: Mapping[str, float] | None = None) -> _Array:
        """Rates y' = F(t, y).

        Parameters
        ----------
        t : float or array_like of shape (k,)
            Times.
        y : array_like of shape (m,) or (k, m)
            States.
        parameters : mapping of str to float, optional
            Parameters for this call. The first use of some names compiles equations that have them as inputs; then a
            call costs the evaluation.

        Returns
        -------
        ndarray of the shape of y
            The rates.

        Raises
        ------
        EvaluationError
            If the equations cannot be evaluated there.
        UnknownNameError
            If a parameter is unknown.
        ValueError
            If a shape is wrong, or a number not finite.
        """
    def jacobian(self, t: _Floats, y: _Floats, parameters: Mapping[str, float] | None = None) -> _Array:
        """The exact Jacobian dF/dy.

        Parameters
        ----------
        t : float or array_like of shape (k,)
            Times.
        y : array_like of shape (m,) or (k, m)
            States.
        parameters : mapping of str to float, optional
            Parameters for this call. The first use of some names compiles equations that have them as inputs; then a
            call costs the evaluation.

        Returns
        -------
        ndarray of shape (m, m) or (k, m, m)
            [i, j] is the derivative of rate i by state j.

        Raises
        ------
        EvaluationError
            If the equations cannot be evaluated there.
        UnknownNameError
            If a parameter is unknown.
        ValueError
            If a shape is wrong, or a number not finite.
        """
    def outputs(self, t: _Floats, y: _Floats) -> Outputs:
        """Coordinates, velocities, multipliers and invariants at (t, y).

        Parameters
        ----------
        t : float or array_like of shape (k,)
            Times.
        y : array_like of shape (m,) or (k, m)
            States.

        Returns
        -------
        Outputs
            What is read off.

        Raises
        ------
        EvaluationError
            If the equations cannot be evaluated there.
        ValueError
            If a shape is wrong, or a number not finite.
        """
    def acceleration(self, t: float, q: _Floats, v: _Floats, mu: _Floats | None = None) -> _Array:
        """Accelerations q'' at one point.

        Parameters
        ----------
        t : float
            Time.
        q : array_like of shape (n,)
            Coordinates.
        v : array_like of shape (n,)
            Velocities.
        mu : array_like of shape (h,), optional
            Multipliers, which the vakonomic formulation needs.

        Returns
        -------
        ndarray of shape (n,)
            The accelerations.

        Raises
        ------
        ValueError
            If the states are not coordinates, velocities and mu.
        EvaluationError
            If the equations cannot be evaluated there.
        """
    def integrate(
        self,
        times: _Floats,
        *,
        y0: _Floats | None = None,
        t0: float | None = None,
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
        """One run of the time loop: half of what `System.solve` does, for those who know the error from elsewhere.

        Other threads go on; Ctrl-C ends it. For the start and the last time alone nothing else is kept.

        Parameters
        ----------
        times : float or array_like of shape (k,)
            Where the run is read off, ascending, to the last. One time as a number leaves out the axis of times.
        y0 : array_like of shape (m,), optional
            The state at the first of `times`, as in SciPy, or at `t0`. Without it a run starts with the system.
        t0 : float, optional
            Time of y0, if that is not the first of `times`.
        parameters : mapping of str to float, optional
            Parameters for this call. The first use of some names compiles equations that have them as inputs; then a
            call costs the run. Without y0 the start follows, as in `System.replace`.
        constants : "zero", {"horizon": T} or array_like, optional
            Free constants: zero, natural at time T, or their values.
        mu0 : array_like of shape (h,), optional
            Start multipliers of the vakonomic formulations; by default those of the system.
        method : str
            One of `METHODS`, or "auto"; its first run compiles what it needs.
        tolerance : float
            Relative and absolute tolerance.
        project : bool
            Whether velocities are projected onto the constraints after every step.
        max_steps : int
            Limit on the steps of a run.
        max_step : float, optional
            No step is longer.
        time_limit : float, optional
            Limit on the seconds of a run.

        Returns
        -------
        Trajectory
            States at the times; `status` tells if the run stops early.

        Raises
        ------
        SolveError
            If there is no run.
        UnknownNameError
            If a parameter is unknown.
        ValueError
            If times do not ascend, begin before t0, or end at t0.

        Examples
        --------
        >>> equations = sledge.equations("chetaev")
        >>> whole = equations.integrate([0.0, 0.5, 1.0])
        >>> rest = equations.integrate([0.5, 1.0], y0=whole.states[1])
        >>> abs(rest.states[-1] - whole.states[-1]).max() < 1e-10
        np.True_
        """
    functions = _code.functions
    to_scipy = _code.to_scipy
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
    by_half: Final[bool]
    """Whether the first half of the starts leads here."""

@final
class Residuals:
    """Residuals between a motion and data at k times, as a function of numbers p: for `scipy.optimize`.

    Residual i of a column is (value at time i - data)/sigma; columns follow one another, so that there are
    as many residuals as columns times k. They have no unit where `sigma` has that of its column.

    A call never raises for numbers: at times that the motion does not reach residuals are `penalty`, with
    derivatives zero, and `ended` says why. Numbers that are not a start give that at all times.
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
        """The exact derivatives of the residuals by p, finite whatever p is.

        Parameters
        ----------
        p : array_like of shape (P,)
            The numbers.

        Returns
        -------
        ndarray of shape (columns times k, P)
            The derivatives.

        Raises
        ------
        ValueError
            If p has another length.
        """
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
    _asked: Final[dict[str, Any]]
    """Arguments of `System.solve` by which it is asked for again."""
    system: Final[System]
    """The system that moves."""
    formulation: Final[str]
    """Name of the formulation."""
    removal: Final[str | None]
    """Name of the removal, None where the formulation needs none."""
    times: Final[_Array]
    """Times, shape (k,), in the unit of time of the system. If one time was asked for as a number, all
    arrays lack this axis.
    """
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
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[State]: ...
    def __contains__(self, name: object) -> bool: ...
    @overload
    def __getitem__(self, key: str) -> _Array: ...
    @overload
    def __getitem__(self, key: slice) -> Motion: ...
    def __reduce__(self) -> tuple[Any, tuple[dict[str, Any]]]: ...
    def _with(self, state: dict[str, Any]) -> Motion: ...
    def at(self, t: _Floats) -> Outputs:
        """Everything at time t, read off the dense output (order 7 for dop853).

        Parameters
        ----------
        t : float or array_like of shape (k,)
            From `start` to `end`, where its last digit does not count.

        Returns
        -------
        Outputs
            What is read off.

        Raises
        ------
        ValueError
            If a time is outside of the motion.
        """
    to_arrow = _tables.motion_to_arrow
    to_pandas = _tables.motion_to_pandas
    to_xarray = _tables.motion_to_xarray
    plot = _plots.motion
    animate = _animate.motion
    _repr_html_ = _notebook.motion

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
    to_arrow = _tables.ensemble_to_arrow
    to_pandas = _tables.ensemble_to_pandas
    to_xarray = _tables.ensemble_to_xarray
    plot = _plots.ensemble
    animate = _animate.ensemble
    _repr_html_ = _notebook.ensemble
    def __len__(self) -> int: ...
    def __contains__(self, name: object) -> bool: ...
    def __getitem__(self, name: str) -> _Array: ...

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
    """Its identifier: the name of the formulation, and of its removal: "removed-constraint:arc-length"."""
    title: Final[str]
    """The same in words, for people."""
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
        """The pair of two runs, in either order.

        Parameters
        ----------
        a, b : str
            Labels, titles, or formulations for the first run of each.

        Returns
        -------
        Pair
            The pair.

        Raises
        ------
        UnknownNameError
            If there is no such run.
        KeyError
            If the two were not compared.
        """
    def verdict(self, a: str, b: str) -> _Verdict:
        """The verdict on two runs.

        Parameters
        ----------
        a, b : str
            Named as in `pair`.

        Returns
        -------
        str
            "same", "different" or "undecided".

        Raises
        ------
        UnknownNameError
            If there is no such run.
        KeyError
            If the two were not compared.
        """
    to_pandas = _tables.comparison_to_pandas
    plot = _plots.comparison
    animate = _animate.comparison
    _repr_html_ = _notebook.comparison
