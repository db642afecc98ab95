//! The table of formulations.

use mechanics::Formulation;

/// Every formulation, in the order of reports. A further one is one crate and one line here.
pub const FORMULATIONS: &[Formulation] =
    &[chetaev::FORMULATION, vakonomic::FORMULATION, vakonomic::COSTATE_FORM, removed_constraint::FORMULATION];

/// The formulation of that name.
pub fn formulation(name: &str) -> Option<&'static Formulation> {
    FORMULATIONS.iter().find(|f| f.name == name)
}
