//! What is made again from a pickle or a copy.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use stubs::stubbed;

use crate::comparison::{Comparison, Growth, LeadingTerm, Pair, Run};
use crate::connect::{Connection, Connections};
use crate::ensemble::Ensemble;
use crate::families::{Decided, Fit};
use crate::linearization::{Linearization, LinearizationSweep, StabilityChange};
use crate::motion::Motion;
use crate::outputs::Outputs;
use crate::pickled::{Pickled, field};
use crate::state::State;
use crate::trajectory::Trajectory;

/// Equations are derived again.
fn equations_again<'py>(state: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    let arguments = state.copy()?;
    let system: Bound<'py, PyAny> = field(&arguments, "system")?;
    arguments.del_item("system")?;
    system.call_method("equations", (), Some(&arguments))
}

/// What a pickled or copied result is made from.
#[stubbed]
pub(crate) fn _again<'py>(name: &Bound<'py, PyString>, state: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    macro_rules! among {
        ($($class:ident)*) => {
            match &*name.to_cow()? {
                "Equations" => equations_again(state),
                $(stringify!($class) => Ok(Bound::new(name.py(), $class::again(state)?)?.into_any()),)*
                other => Err(PyTypeError::new_err(format!("no result is of the class {other}"))),
            }
        };
    }
    among!(
        Comparison Connection Connections Decided Ensemble Fit Growth LeadingTerm Linearization LinearizationSweep Motion
        Outputs Pair Run StabilityChange State Trajectory
    )
}
