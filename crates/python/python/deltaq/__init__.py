"""Mechanical systems with velocity constraints: three formulations of their motion, derived, integrated, compared.

    import deltaq
    system = deltaq.load("sledge.toml")           # or deltaq.System(...), parse(text), from_sympy(method)
    motion = system.solve("chetaev")              # Motion: times, coordinates, velocities, ...
    many = system.ensemble("chetaev", vary={"g": [1.6, 9.8]})   # Ensemble: as a motion, one axis more
    equations = system.equations("vakonomic")     # Equations: text, latex, rates(t, y), jacobian(t, y), ...
    steady = system.linearize(find=True)          # Linearization: eigenvalues about a steady motion
    comparison = system.compare()                 # Comparison: pairs with verdicts, fits of the free constants

All arrays are of float64. Everything that deltaq refuses is a DeltaqError; a wrong shape or an unknown name is a ValueError.
"""

from ._native import (
    FORMULATIONS,
    METHODS,
    BoundaryError,
    CallError,
    Comparison,
    CompileError,
    Decided,
    DeltaqError,
    DerivationError,
    Ensemble,
    Equations,
    EvaluationError,
    Fit,
    Growth,
    LeadingTerm,
    Linearization,
    Motion,
    Outputs,
    Pair,
    RemovalError,
    Run,
    SceneError,
    SolveError,
    StartError,
    State,
    System,
    Trajectory,
    __version__,
    load,
    parse,
)
from ._sympy import from_sympy

__all__ = [
    "FORMULATIONS",
    "METHODS",
    "BoundaryError",
    "CallError",
    "Comparison",
    "CompileError",
    "Decided",
    "DeltaqError",
    "DerivationError",
    "Ensemble",
    "Equations",
    "EvaluationError",
    "Fit",
    "Growth",
    "LeadingTerm",
    "Linearization",
    "Motion",
    "Outputs",
    "Pair",
    "RemovalError",
    "Run",
    "SceneError",
    "SolveError",
    "StartError",
    "State",
    "System",
    "Trajectory",
    "__version__",
    "from_sympy",
    "load",
    "parse",
]
