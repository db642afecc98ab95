//! Words for the decisions: is there a `μ₀` with which the vakonomic motion is Chetaev's, and the like.

use crate::{Answer, Comparison, Decided, FittedMotion, Membership};
use motion::numbers::{at_most, precise, short};
use motion::{CHETAEV, VAKONOMIC};

/// Sentences for the head of the page of a scene, about multipliers and Chetaev's motion.
pub(super) fn sentences(comparison: &Comparison) -> Vec<String> {
    let Some(outcome) = comparison.membership() else { return Vec::new() };
    let membership = match outcome {
        Err(error) => return vec![format!("Whether some μ₀ gives Chetaev's motion is undecided: {error}.")],
        Ok(membership) => membership,
    };
    let mut sentences = vec![sentence(membership)];
    sentences.extend(gap_reached(comparison, &membership.answer()));
    sentences
}

/// Whether the vakonomic motion is proved to be Chetaev's for every `μ₀` with regular equations; without
/// constraints there is one equation of motion.
pub(super) fn proved_same(comparison: &Comparison) -> bool {
    let membership = comparison.membership().and_then(|found| found.as_ref().ok());
    comparison.scene.system.constraints.is_empty()
        || membership.is_some_and(|found| is_every(found) && found.answer() == Answer::SomeProved)
}

/// Whether the set that was found is that of all constants.
fn is_every(membership: &Membership) -> bool {
    membership.dimension() == membership.decision.constants.len()
}

/// For which `μ₀` two motions are different, and for which the same, in a few words after a comma; none
/// without constraints, which have no `μ₀`.
pub(super) fn in_brief(comparison: &Comparison) -> [String; 2] {
    let own = match comparison.scene.system.constraints.len() {
        0 => String::new(),
        _ => ", with the scene's μ₀".into(),
    };
    let Some(Ok(membership)) = comparison.membership() else { return [own.clone(), own] };
    let (some, proved) = match membership.answer() {
        Answer::NoneProved { .. } => (false, "proved"),
        Answer::None { .. } => (false, "computed, not proved"),
        Answer::SomeProved => (true, "proved"),
        Answer::Some { .. } => (true, "computed, not proved"),
        Answer::Undecided => return [format!("{own}; whether another μ₀ makes them the same is undecided"), own],
    };
    let constants = constants(membership, "μ₀");
    match some {
        false => [format!(", for every μ₀ ({proved})"), own],
        true if is_every(membership) => [own, format!(", for {constants} ({proved})")],
        true => [format!("{own}; the same with {constants} ({proved})"), own],
    }
}

/// The answer for Chetaev's motion and the vakonomic family, in a sentence.
pub fn sentence(membership: &Membership) -> String {
    let reason = reason(membership);
    match membership.answer() {
        Answer::NoneProved { .. } | Answer::None { .. } => {
            format!("No μ₀ makes the vakonomic motion Chetaev's: {reason}.")
        }
        Answer::Undecided => format!("Whether some μ₀ gives Chetaev's motion is undecided: {reason}."),
        Answer::SomeProved | Answer::Some { .. } => {
            format!("With {} the vakonomic motion is the Chetaev motion: {reason}.", constants(membership, "μ₀"))
        }
    }
}

/// Which families have which motions: family, motion, constants and why, in Markdown.
pub fn decisions(comparison: &Comparison) -> Vec<[String; 4]> {
    let row = |decided: &Decided| {
        let [family, curve] = [decided.family, decided.curve].map(|i| &comparison.runs[i].choice);
        let c = if family.removal.is_some() { "P(t₀)" } else { "μ₀" };
        let (which, reason) = match &decided.outcome {
            Err(error) => ("undecided".into(), error.to_string()),
            Ok(membership) => match membership.answer() {
                Answer::NoneProved { .. } | Answer::None { .. } => (format!("**no** {c}"), reason(membership)),
                Answer::SomeProved | Answer::Some { .. } => (constants(membership, c), reason(membership)),
                Answer::Undecided => ("undecided".into(), reason(membership)),
            },
        };
        [family.label.clone(), curve.label.clone(), which, reason]
    };
    comparison.decided.iter().map(row).collect()
}

/// The set of values of the constants `c` that was found.
fn constants(membership: &Membership, c: &str) -> String {
    let set = &membership.decision.set;
    // last digits of the others are no number
    let noise = 8.0 * f64::EPSILON * set.point.iter().fold(1.0_f64, |size, c| size.max(c.abs()));
    let point: Vec<String> = set.point.iter().map(|c| precise(if c.abs() <= noise { 0.0 } else { *c })).collect();
    let all = membership.decision.constants.len();
    match (set.dimension(), membership.ranked()) {
        // what fixes a constant may be less than round-off, and what is round-off seem to
        (d, Some(ranked)) if d != ranked => {
            format!("{c} of a set of dimension {ranked} by ranks, {d} in numbers, through ({})", point.join(", "))
        }
        (0, _) => format!("{c} = ({})", point.join(", ")),
        (d, _) if d == all && membership.where_regular => format!("every {c} with regular equations"),
        (d, _) if d == all => format!("every {c}"),
        (d, _) => format!("every {c} of a set of dimension {d} through ({})", point.join(", ")),
    }
}

/// Why the answer is what it is.
fn reason(membership: &Membership) -> String {
    if let Some(contradiction) = membership.contradiction() {
        return format!("two results contradict each other: {contradiction}");
    }
    let decision = &membership.decision;
    let mismatch = match decision.least / decision.acceleration {
        part if part.is_finite() => format!("{} times the motion's own", short(part)),
        _ => short(decision.least),
    };
    let mismatch = format!("the least mismatch of accelerations is {mismatch}");
    match membership.answer() {
        Answer::NoneProved { order } => format!("proved (order {order}); {mismatch}"),
        Answer::None { unproved } => {
            format!("{mismatch}{}; not proved: {unproved}", up_to(decision.until))
        }
        Answer::SomeProved => identity(membership),
        Answer::Some { order, settled } => how_far(membership, order, settled),
        Answer::Undecided => format!("round-off hides it, {mismatch}{}", up_to(decision.until)),
    }
}

/// What is proved where there is an identity.
fn identity(membership: &Membership) -> String {
    if let Some(theorem) = membership.theorem {
        return format!("{theorem}: proved");
    }
    let Some(section) = &membership.section else { return String::new() };
    let which = if section.every { String::new() } else { format!(", ({}),", section.expressions.join(", ")) };
    let dimension = match membership.dimension() {
        0 => "",
        _ if section.every => "",
        _ => "; the dimension by ranks modulo two primes",
    };
    format!("an identity{which} for all starts: proved{dimension}")
}

/// Up to when the numbers were judged, where that is not the end.
fn up_to(until: Option<f64>) -> String {
    until.map_or(String::new(), |time| format!(" up to {} s, and later undecided", short(time)))
}

/// The best that a search over `μ₀` has found, where none leaves nothing: smaller gaps may exist.
fn gap_reached(comparison: &Comparison, answer: &Answer) -> Option<String> {
    if matches!(answer, Answer::SomeProved | Answer::Some { .. }) {
        return None;
    }
    let (run, target) = (comparison.run(VAKONOMIC)?, comparison.run(CHETAEV)?);
    let fitted = comparison.fits.iter().find(|f| f.run == run && f.target == target)?.fitted.as_ref()?;
    let constants: Vec<String> = fitted.constants.iter().map(|(_, c)| precise(*c)).collect();
    let (constants, gap) = (constants.join(", "), reached(fitted));
    Some(format!(
        "The best found of {} starts, μ₀ = ({constants}), leaves a largest gap of {gap}; half of the starts: {}.",
        fitted.starts,
        by_half(fitted)
    ))
}

/// The largest gap that fitted constants leave; where it depends on the number of starts, without digits.
pub fn reached(fitted: &FittedMotion) -> String {
    match fitted.is_settled() {
        true => short(fitted.gap.largest),
        false => format!("at most {} (not settled)", short(at_most(fitted.gap.largest))),
    }
}

/// The same from half of the starts.
pub fn by_half(fitted: &FittedMotion) -> String {
    let largest = fitted.by_half.max(fitted.gap.largest);
    if largest.is_infinite() {
        return "no motion".into();
    }
    short(if fitted.is_settled() { largest } else { at_most(largest) })
}

/// How far it was looked, for a yes that is not proved.
pub fn how_far(membership: &Membership, order: Option<usize>, settled: bool) -> String {
    let part = membership.proof.domain.part();
    if let Some(section) = &membership.section {
        let section = section.expressions.join(", ");
        let until = if settled { None } else { membership.decision.until };
        return format!("({section}) at random starts{part} modulo two primes (not proved){}", up_to(until));
    }
    if settled {
        let at = if part.is_empty() { "" } else { " at random starts" };
        return format!("supported by rank computations modulo two primes{at}{part} (not proved)");
    }
    let decision = &membership.decision;
    let part = decision.part();
    let part = match part < 1.0 {
        true => format!("to 1e{:.0}", part.log10().ceil()),
        false if decision.moves() => "without acceleration".into(),
        false => "at rest".into(),
    } + &up_to(decision.until);
    order.map_or(part.clone(), |order| format!("through order {order} and {part}"))
}
