//! The table of formulations.

use equations::Formulation;

/// Every formulation, in the order of reports. A further one is one crate and one line here.
pub const FORMULATIONS: &[Formulation] = &[
    chetaev::FORMULATION,
    vakonomic::FORMULATION,
    vakonomic::COSTATE_FORM,
    removed_constraint::FORMULATION,
    kappa::FORMULATION,
];

/// Other forms of the same equations: solved by name, and compared in no report.
pub const FORMS: &[Formulation] = &[reduction::REDUCED_CHETAEV, reduction::REDUCED_VAKONOMIC];

/// The formulation or form of that name.
pub fn formulation(name: &str) -> Option<&'static Formulation> {
    FORMULATIONS.iter().chain(FORMS).find(|f| f.name == name)
}
