//! The Python module `deltaq`: scenes, equations as functions of arrays, motions, comparisons.
//!
//! Nothing is derived, integrated or decided here: arguments are read, the facade is called, arrays are handed back. What integrates runs on
//! a thread of its own without Python's lock ([`background`]).

mod arguments;
mod arrays;
mod background;
mod comparison;
mod equations;
mod errors;
mod motion;
mod scene_text;
mod system;

#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::comparison::{Comparison, Fit, Growth, LeadingTerm, Pair, Run};
    #[pymodule_export]
    use crate::equations::Equations;
    #[pymodule_export]
    use crate::errors::{
        BoundaryError, CallError, CompileError, DeltaqError, DerivationError, EvaluationError, RemovalError,
        SceneError, SolveError, StartError,
    };
    #[pymodule_export]
    use crate::motion::{Motion, Outputs};
    #[pymodule_export]
    use crate::system::{State, System, load, parse};

    use integrate::Method;
    use pyo3::prelude::*;
    use pyo3::types::{PyModule, PyTuple};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let names = |list: Vec<&str>| PyTuple::new(module.py(), list);
        module.add("FORMULATIONS", names(deltaq::FORMULATIONS.iter().map(|f| f.name).collect())?)?;
        module.add("METHODS", names(Method::ALL.map(Method::name).to_vec())?)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
