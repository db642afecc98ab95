//! Questions about films, and the fit problem of each formulation.

use equations::{Formulation, Needs};
use mechanics::{ConstantsRule, Parameter};
use motion::{
    Choice, FIRST_ORDER, FORMULATIONS, Settings, UnknownFormulation, VAKONOMIC_COSTATE, constants_of, formulation,
    is_costate,
};
use scene::Scene;

use crate::unknown::{constant_names, with_start};
use crate::{Film, FitError, Problem, Unknown};

/// Residuals above this size count linearly where the weight of outliers is to be reduced.
pub const ROBUST: f64 = 1.345;

/// The constraint law with fitted parameters. κ is not one of them: where Chetaev's law is right, κ is
/// infinite, and motions with large κ are stiff; ε = 1/κ replaces it.
pub(crate) const LAW: &Formulation = FIRST_ORDER;
pub(crate) const SLIP: &str = "slip";

/// Formulations of these names; `all` is every one, but the form in costates beside the vakonomic one.
///
/// # Errors
/// [`UnknownFormulation`].
pub fn formulations(names: &[String]) -> Result<Vec<&'static Formulation>, UnknownFormulation> {
    match names.iter().any(|name| name == "all") {
        true => Ok(FORMULATIONS.iter().copied().filter(|f| **f != *VAKONOMIC_COSTATE).collect()),
        false => names.iter().map(|name| formulation(name)).collect(),
    }
}

/// A question about films.
#[derive(Clone)]
pub struct Question<'a> {
    /// Unknowns of every formulation. Multipliers and costates at the start are unknowns of formulations that
    /// have them, and need not be named. `start` stands for coordinates and given velocities.
    pub unknowns: &'a [Unknown],
    /// Unknown numbers of the first-order law, `eps` or `slip`: they add a row.
    pub law: &'a [Unknown],
    /// Starts of the search; four times as many where no formulation fits.
    pub starts: usize,
    /// Residuals above this size count linearly.
    pub robust: Option<f64>,
    /// How motions are integrated.
    pub settings: Settings,
    /// Threads, which share the formulations; 0: as many as there are processors. No result depends on it.
    pub threads: usize,
}

impl Question<'_> {
    /// The scene with the parameters of the law that it lacks, the numbers of the law, and the unknowns one
    /// by one.
    ///
    /// # Errors
    /// [`FitError::Unknown`] for a number of another law.
    pub(crate) fn prepared(&self, scene: &Scene) -> Result<(Scene, Vec<Unknown>, Vec<Unknown>), FitError> {
        let mut law: Vec<Unknown> = self.law.iter().map(Unknown::of_law).collect();
        law.dedup_by(|b, a| a.name == b.name);
        if let Some(unknown) = law.iter().find(|u| !is_of_a_law(&u.name)) {
            let names = LAW.needs.parameters().join(", ");
            let reason = format!("it is not a number of the law of first order; these are {names}");
            return Err(FitError::Unknown { text: unknown.name.clone(), reason });
        }
        let mut scene = scene.clone();
        for unknown in &law {
            let symbol = scene.system.graph.symbol(&unknown.name);
            if !scene.system.parameters.iter().any(|p| p.symbol == symbol) {
                scene.system.parameters.push(Parameter { symbol, value: unknown.start.unwrap_or(0.0), formula: None });
            }
        }
        let unknowns = with_start(&scene, self.unknowns);
        Ok((scene, law, unknowns))
    }

    /// Its numbers of the law that a formulation is.
    pub(crate) fn law_of(&self, formulation: &Formulation) -> impl Iterator<Item = &Unknown> {
        let names = formulation.needs.parameters();
        self.law.iter().filter(move |unknown| names.contains(&unknown.name.as_str()))
    }
}

/// Whether a formulation is a law with numbers.
pub(crate) fn is_law(formulation: &Formulation) -> bool {
    matches!(formulation.needs, Needs::Parameters(_))
}

/// Whether a number is one of the law.
pub(crate) fn is_of_a_law(name: &str) -> bool {
    LAW.needs.parameters().contains(&name)
}

/// Unknowns of a formulation beside those of the question: constants that it starts from, numbers of its law.
fn own(scene: &Scene, choice: &Choice, question: &Question) -> Vec<Unknown> {
    let constants = if has_constants(choice) { constant_names(scene, choice) } else { Vec::new() };
    let named = |name: &str| question.unknowns.iter().any(|u| u.name == name && u.film.is_none());
    let constants = constants.iter().filter(|name| !named(name)).map(|name| Unknown::named(name));
    question.law_of(choice.formulation).cloned().chain(constants).collect()
}

/// The films as motions of `choice`: constants to start from are unknown, and no others of their kind.
///
/// # Errors
/// As [`Problem::new`].
pub(crate) fn problem_of(
    scene: &Scene,
    choice: &Choice,
    films: &[Film],
    question: &Question,
) -> Result<Problem, FitError> {
    let mut unknowns: Vec<Unknown> = question.unknowns.to_vec();
    unknowns.retain(|u| {
        !is_constant(&u.name) || (is_costate(&u.name) == choice.removal.is_some()) && has_constants(choice)
    });
    unknowns.extend(own(scene, choice, question));
    let constants = match (&choice.removal, constants_of(choice, scene)) {
        (Some(_), ConstantsRule::Natural { .. }) => ConstantsRule::Zero,
        (_, rule) => rule,
    };
    let choice = Choice { constants, ..choice.clone() };
    Ok(Problem::new(scene, &choice, films, &unknowns, &question.settings)?.robust(question.robust))
}

/// Whether a number is a multiplier or a costate at the start.
pub(crate) fn is_constant(name: &str) -> bool {
    name.starts_with("mu0_") || is_costate(name)
}

/// Whether motions have constants to start from, `μ₀` or `P₀`.
pub(crate) fn has_constants(choice: &Choice) -> bool {
    choice.formulation.starts_multipliers || choice.removal.is_some()
}
