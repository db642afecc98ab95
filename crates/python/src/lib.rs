//! The Python module `deltaq`: scenes, equations as functions of arrays, motions, ensembles, comparisons.
//!
//! Nothing is derived, integrated or decided here: arguments are read, the facade is called, arrays are
//! handed back. What integrates runs on a thread of its own without Python's lock ([`background`]).
// `>>>` begins an example of Python
#![allow(clippy::doc_lazy_continuation)]

mod answer;
mod arguments;
mod arrays;
mod at_run_time;
mod background;
mod comparison;
mod connect;
mod ensemble;
mod equations;
mod errors;
mod families;
mod films;
mod linearization;
mod motion;
mod outputs;
mod pickled;
mod proof;
mod questions;
mod reading;
mod residuals;
mod review;
mod scene_text;
mod sensitivities;
mod shared;
mod state;
mod system;
mod trajectory;

#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::{
        comparison::{Comparison, Growth, LeadingTerm, Pair, Run},
        connect::{Connection, Connections},
        ensemble::Ensemble,
        equations::Equations,
        errors::{
            BoundaryError, CallError, CompileError, DeltaqError, DerivationError, EvaluationError, FaultError,
            RemovalError, SceneError, SolveError, StartError,
        },
        families::{Decided, Fit},
        films::_Fitted,
        linearization::{Linearization, LinearizationSweep, StabilityChange},
        motion::Motion,
        outputs::Outputs,
        reading::{_read_again, built_in, load, parse},
        residuals::Residuals,
        state::State,
        system::System,
        trajectory::Trajectory,
    };

    use integrate::Method;
    use pyo3::prelude::*;
    use pyo3::types::{PyModule, PyTuple};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let names = |list: Vec<&str>| PyTuple::new(module.py(), list);
        module.add("FORMULATIONS", names(motion::FORMULATIONS.iter().map(|f| f.name).collect())?)?;
        module.add("SCENES", names(scene::catalogue::built_in().map(|(name, _)| *name).collect())?)?;
        module.add("METHODS", names(Method::ALL.map(Method::name).to_vec())?)?;
        module.add("UnknownNameError", crate::errors::unknown_name(module.py())?)?;
        module.add("_TABLE_SIZE", scene::TABLE_SIZE)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
