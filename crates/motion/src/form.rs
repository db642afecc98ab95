//! The form in which the equations of a motion are integrated, where none was asked for.

use equations::{Equations, Formulation};
use mechanics::{State, System};

use crate::choice::derive_at;
use crate::table::{in_costates, reduced};
use crate::{CHETAEV, Choice, SolveError, VAKONOMIC};

/// Which of the forms of a formulation is integrated; the motions are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// The one that suits the system: quasi-velocities, where there are any.
    #[default]
    Suited,
    /// The form whose name was given.
    Named,
}

/// Words for forms: `auto` for the one that suits, then forms by name.
pub const FORM_WORDS: [&str; 4] = ["auto", "multipliers", "costates", "quasi-velocities"];

/// The formulation in the form named by `word`; `None` where it has no such form.
pub fn formulation_in(word: &str, own: &'static Formulation) -> Option<(&'static Formulation, Form)> {
    match word {
        "auto" => Some((own, Form::Suited)),
        "multipliers" => [CHETAEV, VAKONOMIC].contains(&own).then_some((own, Form::Named)),
        "costates" => Some((in_costates(own)?, Form::Named)),
        "quasi-velocities" => Some((reduced(own)?, Form::Named)),
        _ => None,
    }
}

/// In which form equations are, and why.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChosenForm {
    /// Name of the formulation or form.
    pub name: &'static str,
    /// Why, in words.
    pub why: String,
}

/// The equations of `choice` in the form in which its motion is integrated; they bear the name of the
/// formulation.
///
/// Quasi-velocities have fewer unknowns, nothing to project and cheaper rates. They need constraints linear
/// in the velocities, and no pivot that may vanish along the way; in the vakonomic formulation also `L`
/// quadratic in them, for the equations of the instant are not linear otherwise. Beside a pivot the vakonomic
/// motion is taken in costates, Chetaev's with multipliers.
///
/// # Errors
/// As [`derive_at`].
pub fn derive_in_form(
    system: &System,
    start: &State,
    choice: &Choice,
    form: Form,
) -> Result<(Equations, ChosenForm), SolveError> {
    let derived = |form: &'static Formulation, why| {
        let mut equations = derive_at(system, start, &Choice { formulation: form, ..choice.clone() })?;
        equations.formulation = choice.formulation.name;
        Ok((equations, ChosenForm { name: form.name, why }))
    };
    let own = choice.formulation;
    let Some(entry) = reduced(own).filter(|_| form == Form::Suited) else {
        let why = if form == Form::Named { "asked for" } else { "the only one" };
        return derived(own, why.into());
    };
    if system.constraints.is_empty() {
        return derived(own, "there is no constraint".into());
    }
    let in_costates = in_costates(own);
    if in_costates.is_some() && !is_quadratic(system) {
        return derived(own, "L is not quadratic in the velocities".into());
    }
    let (equations, chosen) = match derived(entry, "the constraints are linear in the velocities".into()) {
        Ok(reduced) => reduced,
        Err(error) => return derived(own, error.to_string()),
    };
    if equations.chart.as_ref().is_none_or(|chart| !chart.may_vanish) {
        return Ok((equations, chosen));
    }
    // a pole of a constraint is passed in costates as if it were none
    let regular = equations.singularities(&system.graph, &system.constraints).is_empty();
    let other = in_costates.filter(|_| regular).unwrap_or(own);
    derived(other, "quasi-velocities have pivots that may vanish".into())
}

/// Whether the second derivatives of `L` by the velocities are free of them.
fn is_quadratic(system: &System) -> bool {
    let g = &system.graph;
    let (v, hessian) = (system.velocities(), system.velocity_hessian());
    let free = |&e: &_| g.symbols_of(e).iter().all(|s| !v.contains(s));
    hessian.entries().iter().all(free)
}
