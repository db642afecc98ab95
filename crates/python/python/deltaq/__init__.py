"""Mechanical systems with velocity constraints: three formulations of their motion, derived, integrated, compared.

    import deltaq
    system = deltaq.load("sledge.toml")           # or built_in("sledge"), System(...), parse(text), from_sympy(method)
    motion = system.solve("chetaev")              # Motion: times, coordinates, velocities, ...
    many = system.ensemble("chetaev", vary={"g": [1.6, 9.8]})   # Ensemble: as a motion, one axis more
    equations = system.equations("vakonomic")     # Equations: text, latex, rates(t, y), jacobian(t, y), ...
    steady = system.linearize(find=True)          # Linearization: eigenvalues about a steady motion
    fit = system.fit(film, free=["g"], sigma=1e-3)      # FilmFit: which formulation a film supports, numbers with intervals
    comparison = system.compare()                 # Comparison: pairs with verdicts, fits of the free constants
    found = deltaq.review(system, equations)      # are these equations of motion right, and if not, whose are they?
    where = deltaq.sweep(system, {"k": [0.5, 1.0]})     # Sweep: where two motions part, on all cores or a cluster
    table = deltaq.ensemble(system, vary={"g": [1.6]})  # a table of Arrow, or Parquet files

Motions, ensembles, comparisons and sweeps have to_arrow, to_pandas, to_xarray and plot where these make sense; they
need pyarrow, pandas, xarray and matplotlib, a cluster dask.distributed: deltaq[tables], [plot], [cluster].

All arrays are of float64. Results cannot be written to, and can be pickled. Everything that deltaq refuses is a
DeltaqError, an unknown name an UnknownNameError; a wrong shape is a ValueError, a missing file a FileNotFoundError.
"""

from . import _animate, _code, _columns, _films, _motion, _notebook, _plots, _proof, _tables
from ._native import (
    FORMULATIONS,
    METHODS,
    SCENES,
    BoundaryError,
    CallError,
    Comparison,
    CompileError,
    Connection,
    Connections,
    Decided,
    DeltaqError,
    DerivationError,
    Ensemble,
    Equations,
    EvaluationError,
    FaultError,
    Fit,
    Growth,
    LeadingTerm,
    Linearization,
    LinearizationSweep,
    Motion,
    Outputs,
    Pair,
    RemovalError,
    Residuals,
    Run,
    SceneError,
    SolveError,
    StabilityChange,
    StartError,
    State,
    System,
    Trajectory,
    UnknownNameError,
    __version__,
    _Fitted,
    _read_again,
    built_in,
    load,
    parse,
)
from ._code import Functions
from ._films import FilmFit, FormulationFit, Profile, designs
from ._proof import Proof
from ._results import Design, Estimate, Integrals
from ._review import review
from ._sweep import Sweep, ensemble, sweep
from ._sympy import from_sympy
from ._urdf import from_urdf

__all__ = [
    "FORMULATIONS",
    "METHODS",
    "SCENES",
    "BoundaryError",
    "CallError",
    "Comparison",
    "CompileError",
    "Connection",
    "Connections",
    "Decided",
    "DeltaqError",
    "DerivationError",
    "Design",
    "Ensemble",
    "Equations",
    "Estimate",
    "EvaluationError",
    "FaultError",
    "FilmFit",
    "Fit",
    "FormulationFit",
    "Functions",
    "Growth",
    "Integrals",
    "LeadingTerm",
    "Linearization",
    "LinearizationSweep",
    "Motion",
    "Outputs",
    "Pair",
    "Profile",
    "Proof",
    "RemovalError",
    "Residuals",
    "Run",
    "SceneError",
    "SolveError",
    "StabilityChange",
    "StartError",
    "State",
    "Sweep",
    "System",
    "Trajectory",
    "UnknownNameError",
    "__version__",
    "built_in",
    "designs",
    "ensemble",
    "from_sympy",
    "from_urdf",
    "load",
    "parse",
    "review",
    "sweep",
]

for _class, _module in ((Motion, "motion"), (Ensemble, "ensemble"), (Comparison, "comparison")):
    setattr(_class, "plot", getattr(_plots, _module))
    setattr(_class, "animate", getattr(_animate, _module))
    setattr(_class, "_repr_html_", getattr(_notebook, _module))
    for _kind in ("arrow", "pandas", "xarray"):
        _function = getattr(_tables, f"{_module}_to_{_kind}", None)
        if _function is not None:
            setattr(_class, f"to_{_kind}", _function)

for _class in (Motion, Ensemble):
    setattr(_class, "__getitem__", _motion.column)
    setattr(_class, "__contains__", _motion.is_column)
for _name, _function in (("__getitem__", _motion.item), ("__len__", _motion.length), ("__iter__", _motion.instants)):
    setattr(Motion, _name, _function)

setattr(Equations, "functions", _code.functions)
setattr(Equations, "to_scipy", _code.to_scipy)
setattr(System, "prove", _proof.prove)
setattr(System, "integrals", _proof.integrals)
setattr(System, "fit", _films.fit)
setattr(System, "residuals", _columns.residuals)
setattr(System, "design", _films.design)
