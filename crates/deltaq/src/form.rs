//! The form in which the equations of a motion are integrated, where none was asked for.

use equations::{Equations, Formulation};
use mechanics::{State, System};

use crate::choice::derive_at;
use crate::table::reduced;
use crate::{Choice, SolveError, formulation};

/// Which of the forms of a formulation is integrated; the motions are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// The one that suits the system: quasi-velocities, where there are any.
    #[default]
    Suited,
    /// That of the name that was asked for.
    Named,
}

/// What a form can be asked for by: the one that suits, that with multipliers, other forms by name.
pub const FORM_WORDS: [&str; 4] = ["auto", "multipliers", "costates", "quasi-velocities"];

/// The formulation of that name in the form of that word; none where there is no such formulation or form.
pub fn formulation_in(word: &str, name: &str) -> Option<(&'static Formulation, Form)> {
    let own = formulation(name)?;
    match word {
        "auto" => Some((own, Form::Suited)),
        "multipliers" => (own.name == "chetaev" || own.name == "vakonomic").then_some((own, Form::Named)),
        "costates" => Some((formulation(&format!("{name}-costate"))?, Form::Named)),
        "quasi-velocities" => Some((reduced(name)?, Form::Named)),
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
/// in the velocities; in the vakonomic formulation also `L` quadratic in them, for the equations of the
/// instant are not linear otherwise.
///
/// # Errors
/// As [`derive_at`].
pub fn derive_in_form(
    system: &System,
    start: &State,
    choice: &Choice,
    form: Form,
) -> Result<(Equations, ChosenForm), SolveError> {
    let why = match (form, reduced(choice.formulation)) {
        (Form::Named, _) => "asked for".into(),
        (Form::Suited, None) => "the only one".into(),
        (Form::Suited, Some(_)) if system.constraints.is_empty() => "there is no constraint".into(),
        (Form::Suited, Some(entry)) if entry.starts_multipliers && !is_quadratic(system) => {
            "L is not quadratic in the velocities".into()
        }
        (Form::Suited, Some(entry)) => {
            match derive_at(system, start, &Choice { formulation: entry.name, ..choice.clone() }) {
                Ok(mut equations) => {
                    equations.formulation = formulation(choice.formulation).map_or(entry.name, |own| own.name);
                    let why = "the constraints are linear in the velocities".into();
                    return Ok((equations, ChosenForm { name: entry.name, why }));
                }
                Err(error) => error.to_string(),
            }
        }
    };
    Ok((derive_at(system, start, choice)?, ChosenForm { name: choice.formulation, why }))
}

/// Whether the second derivatives of `L` by the velocities are free of them.
fn is_quadratic(system: &System) -> bool {
    let g = &system.graph;
    let (v, hessian) = (system.velocities(), system.velocity_hessian());
    let free = |&e: &_| g.symbols_of(e).iter().all(|s| !v.contains(s));
    hessian.entries().iter().all(free)
}
