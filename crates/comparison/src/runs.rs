//! Runs of a scene, pairs of them, and what is decided about them.

use equations::Formulation;
use mechanics::ConstantsRule;
use scene::Scene;

use crate::gap::{Gap, Verdict, compare_motions};
use crate::growth::{Growth, LeadingTerm, growth};
use crate::{Membership, Pairing, costates_of};
use motion::{
    CHETAEV, Choice, KAPPA, Metric, Motion, SolveError, VAKONOMIC, VAKONOMIC_COSTATE, constant_names, is_in_table,
};

/// A choice and what became of it.
pub struct Run {
    /// The choice.
    pub choice: Choice,
    /// The motion, or why there is none.
    pub outcome: Result<Motion, SolveError>,
}

/// Two runs compared.
pub struct Pair {
    /// Index of the first run.
    pub first: usize,
    /// Index of the second run.
    pub second: usize,
    /// The gap between them.
    pub gap: Gap,
    /// Growth of `second − first` near the start, where it stands out from the errors.
    pub growth: Option<Growth>,
    /// Predicted leading term, if the first has Taylor series and the second no constants found by a search.
    pub predicted: Option<LeadingTerm>,
}

/// A motion with fitted constants.
pub struct FittedMotion {
    /// Names and values of the constants.
    pub constants: Vec<(String, f64)>,
    /// The gap that remains.
    pub gap: Gap,
    /// From how many values of the constants the gap was made smaller, of which the best is told; 0 for an
    /// identity.
    pub starts: usize,
    /// The largest gap that was found from the first half of these starts; infinite where these lead to no
    /// motion over the whole horizon.
    pub by_half: f64,
}

impl FittedMotion {
    /// Whether half of the starts find the same gap to one percent; where nothing is left, nothing has to be
    /// settled.
    pub fn is_settled(&self) -> bool {
        self.gap.verdict != Verdict::Different || self.by_half <= 1.01 * self.gap.largest
    }
}

/// Whether one motion belongs to the family of another formulation.
pub struct Decided {
    /// Index of the run whose constants are unknown.
    pub family: usize,
    /// Index of the run whose motion is the curve.
    pub curve: usize,
    /// The decision, or why it is impossible.
    pub outcome: Result<Membership, SolveError>,
    /// The family's motion with the constants that were found, where it had others; or why it is refused.
    pub witness: Option<Result<FittedMotion, String>>,
}

/// Results besides the gaps: how gaps begin, and which family contains which motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Of none: gaps and the verdicts that follow from them.
    Gaps,
    /// For Chetaev's motion and the vakonomic family only, as the printed answer needs.
    Answer,
    /// Of all.
    Everything,
}

/// Two runs with a motion compared, where that is worth it: the gap, and how it begins, as far as asked for.
pub(crate) fn compared(
    scene: &Scene,
    extent: Extent,
    [(first, before), (second, run)]: [(usize, &mut Run); 2],
    metric: &mut Metric,
) -> Result<Option<Pair>, SolveError> {
    let is_worth_it = worth_comparing(before, run);
    let (true, Ok(one), Ok(two)) = (is_worth_it, &mut before.outcome, &mut run.outcome) else { return Ok(None) };
    let mut gap = compare_motions(one, two, metric)?;
    let limit = |t: f64| gap.limit_at(t);
    let formulations = [before.choice.formulation, run.choice.formulation];
    let asked = match extent {
        Extent::Gaps => false,
        Extent::Answer => formulations == [CHETAEV, VAKONOMIC],
        Extent::Everything => true,
    };
    let growth = match gap.verdict {
        // where it cannot be read off, nothing is fitted
        Verdict::Different if asked => growth(two, one, metric, &limit).unwrap_or(None),
        _ => None,
    };
    let predicted = match gap.verdict {
        _ if extent == Extent::Gaps => None,
        Verdict::Different if growth.is_none() => None,
        // what no gap shows may be proved, of all motions that Chetaev's is compared with
        Verdict::Same | Verdict::Undecided { .. } if formulations[0] != CHETAEV => None,
        _ => predicted(scene, &before.choice, run),
    };
    if predicted.as_ref().is_some_and(|term| term.proved) {
        gap.prove();
    }
    Ok(Some(Pair { first, second, gap, growth, predicted }))
}

/// The costate form is compared with the vakonomic one only, a run from outside the table with Chetaev only.
fn worth_comparing(first: &Run, second: &Run) -> bool {
    let both = [first.choice.formulation, second.choice.formulation];
    let outside = both.iter().any(|own| !is_in_table(own));
    (!both.contains(&VAKONOMIC_COSTATE) || both.contains(&VAKONOMIC)) && (!outside || both.contains(&CHETAEV))
}

/// The leading term of the difference of two runs.
fn predicted(scene: &Scene, curve: &Choice, run: &Run) -> Option<LeadingTerm> {
    let (Ok(motion), Ok(pairing)) = (&run.outcome, Pairing::new(scene, curve, &run.choice)) else { return None };
    if matches!(run.choice.constants, ConstantsRule::Natural { .. }) {
        return None;
    }
    // costates that the motion has left out are zero
    let names = constant_names(&motion.equations);
    let value = |name| names.iter().position(|own| own == name).map_or(0.0, |i| motion.constants[i]);
    let constants: Vec<f64> = pairing.constants().iter().map(value).collect();
    pairing.leading_term(&constants).ok().flatten()
}

/// Families and motions: of Chetaev's it is asked whether it belongs to the other families, of the vakonomic
/// one whether it belongs to those of removals that have more than coordinates for their variables.
pub(crate) fn questions(scene: &Scene, runs: &[Run]) -> Vec<(usize, usize)> {
    let has = |i: &usize| {
        runs[*i].outcome.is_ok() && is_in_table(runs[*i].choice.formulation) && !scene.system.constraints.is_empty()
    };
    let of = |own: &Formulation| (0..runs.len()).filter(has).find(|&i| runs[i].choice.formulation == own);
    let own_variables = |i: &usize| {
        let removal = runs[*i].choice.removal.as_ref();
        removal.is_some_and(|r| !matches!(costates_of(scene, r, &scene.multipliers), Ok(Some(_))))
    };
    let removed: Vec<usize> = (0..runs.len()).filter(has).filter(own_variables).collect();
    let mut asked: Vec<(usize, usize)> = Vec::new();
    if let Some(curve) = of(CHETAEV) {
        asked.extend(of(VAKONOMIC).into_iter().chain(of(KAPPA)).chain(removed.clone()).map(|i| (i, curve)));
    }
    if let Some(curve) = of(VAKONOMIC) {
        asked.extend(removed.iter().map(|&i| (i, curve)));
    }
    asked
}

/// Whether the motion of the second run belongs to the family of the first.
pub(crate) fn decide(scene: &Scene, runs: &[Run], (family, curve): (usize, usize)) -> Decided {
    let end = runs[curve].outcome.as_ref().map_or(0.0, Motion::end);
    let pairing = Pairing::new(scene, &runs[curve].choice, &runs[family].choice);
    Decided { family, curve, outcome: pairing.and_then(|pairing| pairing.decide(end)), witness: None }
}
