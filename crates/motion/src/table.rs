//! The table of formulations.

use equations::Formulation;
use symbolic::nearest;

/// Chetaev's equations of motion.
pub const CHETAEV: &Formulation = &chetaev::FORMULATION;
/// The vakonomic equations, with multipliers.
pub const VAKONOMIC: &Formulation = &vakonomic::FORMULATION;
/// The vakonomic equations in costates.
pub const VAKONOMIC_COSTATE: &Formulation = &vakonomic::COSTATE_FORM;
/// The removed-constraint equations.
pub const REMOVED_CONSTRAINT: &Formulation = &removed_constraint::FORMULATION;
/// The family between Chetaev's and the vakonomic equations.
pub const KAPPA: &Formulation = &kappa::FORMULATION;

/// The constraint law of first order.
pub const FIRST_ORDER: &Formulation = &first_order::FORMULATION;
/// Virtual displacements as the system prescribes them.
pub const PRESCRIBED: &Formulation = &chetaev::PRESCRIBED;

/// Every formulation, in the order of reports. A further one is one crate, and its constant here.
pub const FORMULATIONS: &[&Formulation] =
    &[CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE, REMOVED_CONSTRAINT, KAPPA, FIRST_ORDER, PRESCRIBED];

/// Chetaev's equations in quasi-velocities.
pub const REDUCED_CHETAEV: &Formulation = &reduction::REDUCED_CHETAEV;
/// The vakonomic equations in quasi-velocities.
pub const REDUCED_VAKONOMIC: &Formulation = &reduction::REDUCED_VAKONOMIC;

/// Other forms of the same equations, named `FORMULATION-reduced`: compared in no report.
pub const FORMS: &[&Formulation] = &[REDUCED_CHETAEV, REDUCED_VAKONOMIC];

/// A name that is that of no formulation and of no form.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown formulation `{name}`{}; known: {}", did_you_mean(name), names().collect::<Vec<_>>().join(", "))]
pub struct UnknownFormulation {
    /// What was asked for.
    pub name: String,
}

fn did_you_mean(name: &str) -> String {
    nearest(name, names()).map_or_else(String::new, |similar| format!(", did you mean `{similar}`?"))
}

fn names() -> impl Iterator<Item = &'static str> {
    FORMULATIONS.iter().chain(FORMS).map(|f| f.name)
}

/// The formulation or form of that name.
///
/// # Errors
/// [`UnknownFormulation`].
///
/// ```
/// use motion::{VAKONOMIC, formulation};
/// assert_eq!(formulation("vakonomic"), Ok(VAKONOMIC));
/// let error = formulation("vakonomik").unwrap_err().to_string();
/// assert!(error.starts_with("unknown formulation `vakonomik`, did you mean `vakonomic`?; known: chetaev,"));
/// ```
pub fn formulation(name: &str) -> Result<&'static Formulation, UnknownFormulation> {
    let mut all = FORMULATIONS.iter().chain(FORMS).copied();
    all.find(|f| f.name == name).ok_or_else(|| UnknownFormulation { name: name.into() })
}

/// Whether a formulation is one of the table, not a control.
pub fn is_in_table(formulation: &Formulation) -> bool {
    FORMULATIONS.iter().chain(FORMS).any(|own| *own == formulation)
}

/// Formulations beside their forms in quasi-velocities.
const REDUCED: [[&Formulation; 2]; 2] = [[CHETAEV, REDUCED_CHETAEV], [VAKONOMIC, REDUCED_VAKONOMIC]];

/// The form in quasi-velocities.
pub(crate) fn reduced(formulation: &Formulation) -> Option<&'static Formulation> {
    REDUCED.into_iter().find(|[own, _]| *own == formulation).map(|[_, form]| form)
}

/// The form in costates.
pub(crate) fn in_costates(formulation: &Formulation) -> Option<&'static Formulation> {
    (formulation == VAKONOMIC).then_some(VAKONOMIC_COSTATE)
}

/// The formulation of that name, or the one whose form in quasi-velocities has it.
pub(crate) fn as_derived(name: &str) -> Option<&'static Formulation> {
    let named = formulation(name).ok()?;
    Some(REDUCED.into_iter().find(|[_, form]| *form == named).map_or(named, |[own, _]| own))
}
