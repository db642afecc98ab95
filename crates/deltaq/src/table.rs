//! The table of formulations.

use equations::Formulation;

use crate::SolveError;

/// Every formulation, in the order of reports. A further one is one crate and one line here.
pub const FORMULATIONS: &[Formulation] = &[
    chetaev::FORMULATION,
    vakonomic::FORMULATION,
    vakonomic::COSTATE_FORM,
    removed_constraint::FORMULATION,
    kappa::FORMULATION,
];

/// Other forms of the same equations, named `FORMULATION-reduced`: compared in no report.
pub const FORMS: &[Formulation] = &[reduction::REDUCED_CHETAEV, reduction::REDUCED_VAKONOMIC];

/// The formulation or form of that name.
pub fn formulation(name: &str) -> Option<&'static Formulation> {
    FORMULATIONS.iter().chain(FORMS).find(|f| f.name == name)
}

/// [`formulation`] of what a choice says.
pub(crate) fn known(name: &str) -> Result<&'static Formulation, SolveError> {
    let unknown = || {
        let known: Vec<&str> = FORMULATIONS.iter().chain(FORMS).map(|f| f.name).collect();
        SolveError::UnknownFormulation { name: name.into(), known: known.join(", ") }
    };
    formulation(name).ok_or_else(unknown)
}

/// The form of that formulation in quasi-velocities.
pub(crate) fn reduced(name: &str) -> Option<&'static Formulation> {
    FORMS.iter().find(|form| form.name.strip_suffix(REDUCED) == Some(name))
}

/// The formulation of which `name` is a form in quasi-velocities, or that of the name.
pub(crate) fn as_derived(name: &str) -> Option<&'static Formulation> {
    formulation(name.strip_suffix(REDUCED).unwrap_or(name))
}

const REDUCED: &str = "-reduced";
