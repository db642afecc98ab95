from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, Final, Literal, TypeAlias, final

import numpy as np
import numpy.typing as npt

_Array: TypeAlias = npt.NDArray[np.float64]
_Floats: TypeAlias = npt.ArrayLike
# text, or an expression of SymPy, which has no types
_Formula: TypeAlias = Any
_Expression: TypeAlias = _Formula | float
_Constants: TypeAlias = Literal["zero"] | dict[str, float] | npt.ArrayLike
_Verdict: TypeAlias = Literal["same", "different", "undecided"]

FORMULATIONS: tuple[str, ...]
METHODS: tuple[str, ...]
__version__: str

class DeltaqError(Exception): ...

class SceneError(DeltaqError):
    file: str
    line: int
    column: int

class SolveError(DeltaqError): ...
class DerivationError(SolveError): ...
class RemovalError(SolveError): ...
class StartError(SolveError): ...
class CompileError(SolveError): ...
class EvaluationError(SolveError): ...
class BoundaryError(SolveError): ...
class CallError(SolveError): ...

def load(path: str | PathLike[str], overrides: Mapping[str, float] | None = None) -> System: ...
def _read_again(name: str, text: str, overrides: list[tuple[str, float]]) -> System: ...
def parse(text: str, overrides: Mapping[str, float] | None = None, *, name: str = "scene") -> System: ...

@final
class State:
    t: Final[float]
    q: Final[_Array]
    v: Final[_Array]

@final
class System:
    def __new__(
        cls,
        coordinates: Iterable[_Formula],
        lagrangian: _Formula,
        constraints: Iterable[_Formula] = (),
        *,
        start: dict[Any, _Expression],
        parameters: dict[Any, _Expression] | None = None,
        definitions: dict[Any, _Expression] | None = None,
        units: dict[Any, str] | None = None,
        forces: dict[Any, _Expression] | None = None,
        observables: dict[str, _Expression] | None = None,
        invariants: dict[str, _Expression] | None = None,
        view: dict[str, dict[str, Any]] | None = None,
        velocities: dict[Any, _Expression] | None = None,
        guess: dict[Any, _Expression] | None = None,
        project: bool = False,
        removals: dict[str, dict[str, Any]] | None = None,
        multipliers: _Floats | None = None,
        time: float = 0.0,
        duration: float = 1.0,
        name: str = "system",
        title: str | None = None,
    ) -> System: ...
    name: Final[str]
    title: Final[str]
    source: Final[str]
    coordinates: Final[list[str]]
    units: Final[dict[str, str]]
    dimension: Final[int]
    parameters: Final[dict[str, float]]
    lagrangian: Final[str]
    constraints: Final[list[str]]
    forces: Final[dict[str, str]]
    start: Final[State]
    multipliers: Final[list[float]]
    duration: Final[float]
    removals: Final[list[str]]
    integrability: Final[str]
    latex: Final[str]
    def replace(self, overrides: Mapping[str, float]) -> System: ...
    def to_toml(self) -> str: ...
    def constraint(self, t: _Floats, q: _Floats, v: _Floats) -> _Array: ...
    def mass(self, t: _Floats, q: _Floats, v: _Floats) -> _Array: ...
    def equations(
        self,
        formulation: str = "chetaev",
        removal: str | None = None,
        *,
        mu0: _Floats | None = None,
        constants: _Constants | None = None,
    ) -> Equations: ...
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
    ) -> Linearization: ...
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
    ) -> Motion: ...
    def ensemble(
        self,
        formulation: str = "chetaev",
        times: _Floats | None = None,
        *,
        vary: dict[str, _Floats],
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
    ) -> Ensemble: ...
    def compare(
        self,
        *,
        tolerance: float = 1e-11,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
        fits: Literal["undecided", "all", "none"] = "undecided",
    ) -> Comparison: ...
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
    coordinates: Final[_Array]
    velocities: Final[_Array]
    multipliers: Final[dict[str, Any]]
    invariants: Final[dict[str, Any]]
    observables: Final[dict[str, Any]]

@final
class Equations:
    formulation: Final[str]
    removal: Final[str | None]
    states: Final[list[str]]
    constants: Final[list[str]]
    text: Final[str]
    latex: Final[str]
    def to_c(self) -> str: ...
    def to_numpy(self) -> str: ...
    def to_sympy(self) -> str: ...
    def initial_state(self, constants: _Constants | None = None) -> _Array: ...
    def rates(self, t: _Floats, y: _Floats) -> _Array: ...
    def jacobian(self, t: _Floats, y: _Floats) -> _Array: ...
    def outputs(self, t: _Floats, y: _Floats) -> Outputs: ...
    def acceleration(self, t: float, q: _Floats, v: _Floats, mu: _Floats | None = None) -> _Array: ...
    def integrate(
        self,
        times: _Floats,
        *,
        method: str = "auto",
        tolerance: float = 1e-11,
        project: bool = True,
        max_steps: int = 1_000_000,
        max_step: float | None = None,
        time_limit: float | None = None,
    ) -> Trajectory: ...
    def _repr_latex_(self) -> str: ...

@final
class Trajectory:
    times: Final[_Array]
    states: Final[_Array]
    status: Final[Literal["completed", "stopped"]]
    cause: Final[str | None]
    work: Final[dict[str, int]]
    seconds: Final[float]

@final
class Linearization:
    form: Final[str]
    t: Final[float]
    is_steady: Final[bool]
    states: Final[list[str]]
    values: Final[_Array]
    carried: Final[dict[str, float]]
    matrix: Final[_Array]
    of: Final[list[str]]
    eigenvalues: Final[npt.NDArray[np.complex128]]
    errors: Final[_Array]
    zeros: Final[int]
    zero_vectors: Final[int]
    zero_error: Final[float]
    unstable: Final[int]
    growing: Final[str]

@final
class Motion:
    system: Final[System]
    formulation: Final[str]
    removal: Final[str | None]
    times: Final[_Array]
    coordinate_names: Final[list[str]]
    coordinates: Final[_Array]
    velocities: Final[_Array]
    multipliers: Final[dict[str, _Array]]
    invariants: Final[dict[str, _Array]]
    observables: Final[dict[str, _Array]]
    error_estimate: Final[float]
    relative_error_estimate: Final[float]
    coordinate_error_estimates: Final[_Array]
    multiplier_error_estimates: Final[dict[str, _Array]]
    status: Final[Literal["completed", "untrusted", "stopped"]]
    cause: Final[str | None]
    doubt: Final[str | None]
    start: Final[float]
    end: Final[float]
    method: Final[tuple[str, str] | None]
    form: Final[tuple[str, str]]
    charts: Final[list[tuple[float, str]]]
    constants: Final[dict[str, float]]
    work: Final[dict[str, int]]
    projection: Final[dict[str, float]]
    seconds: Final[dict[str, float]]
    def at(self, t: _Floats) -> Outputs: ...
    def to_arrow(self) -> Any: ...
    def to_pandas(self) -> Any: ...
    def to_xarray(self) -> Any: ...
    def plot(self, ax: Any = None) -> Any: ...
    def animate(self) -> Any: ...
    def _repr_html_(self) -> str: ...

@final
class Ensemble:
    system: Final[System]
    formulation: Final[str]
    removal: Final[str | None]
    times: Final[_Array]
    varied: Final[dict[str, _Array]]
    coordinate_names: Final[list[str]]
    coordinates: Final[_Array]
    velocities: Final[_Array]
    multipliers: Final[dict[str, _Array]]
    invariants: Final[dict[str, _Array]]
    error_estimate: Final[_Array]
    relative_error_estimate: Final[_Array]
    status: Final[list[Literal["completed", "untrusted", "stopped", "refused"]]]
    cause: Final[list[str | None]]
    reached: Final[list[int]]
    alone: Final[list[str | None]]
    seconds: Final[float]
    def to_arrow(self, first: int = 0) -> Any: ...
    def to_pandas(self) -> Any: ...
    def to_xarray(self) -> Any: ...
    def plot(self, ax: Any = None) -> Any: ...
    def animate(self) -> Any: ...
    def _repr_html_(self) -> str: ...
    def __len__(self) -> int: ...

@final
class Growth:
    exponent: Final[float]
    uncertainty: Final[float]
    coefficient: Final[_Array]
    length: Final[float]

@final
class LeadingTerm:
    exponent: Final[int]
    coefficient: Final[_Array]
    length: Final[float]
    proved: Final[bool]

@final
class Pair:
    first: Final[str]
    second: Final[str]
    verdict: Final[_Verdict]
    because: Final[str | None]
    tau: Final[dict[float, float | None]]
    largest_gap: Final[float]
    largest_by_coordinate: Final[dict[str, float]]
    certain_from: Final[float | None]
    error_estimates: Final[tuple[float, float]]
    end: Final[float]
    times: Final[_Array]
    gap: Final[_Array]
    limit: Final[_Array]
    growth: Final[Growth | None]
    predicted: Final[LeadingTerm | None]

@final
class Fit:
    run: Final[str]
    target: Final[str]
    constants: Final[dict[str, float] | None]
    verdict: Final[_Verdict | None]
    largest_gap: Final[float | None]
    by_identity: Final[bool]

@final
class Decided:
    family: Final[str]
    motion: Final[str]
    answer: Final[Literal["some", "none", "undecided"]]
    proved: Final[bool]
    order: Final[int | None]
    because: Final[str | None]
    constants: Final[dict[str, float] | None]
    dimension: Final[int | None]
    identity: Final[list[str] | None]
    mismatch: Final[float | None]

@final
class Run:
    label: Final[str]
    formulation: Final[str]
    removal: Final[str | None]
    motion: Final[Motion | None]
    error: Final[str | None]

@final
class Comparison:
    system: Final[System]
    integrability: Final[str]
    runs: Final[list[Run]]
    pairs: Final[list[Pair]]
    fits: Final[list[Fit]]
    decided: Final[list[Decided]]
    contradictions: Final[list[str]]
    def pair(self, a: str, b: str) -> Pair: ...
    def verdict(self, a: str, b: str) -> _Verdict: ...
    def to_pandas(self) -> Any: ...
    def plot(self, ax: Any = None) -> Any: ...
    def animate(self) -> Any: ...
    def _repr_html_(self) -> str: ...
