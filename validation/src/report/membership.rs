//! Words for the decision: is there a `μ₀` with which the vakonomic motion is Chetaev's?

use deltaq::{Answer, Comparison, Membership, SolveError};
use serde_json::{Value, json};

use crate::report::numbers::{precise, short};

/// Is the answer for a scene of this kind?
pub(crate) fn is(comparison: &Comparison, wanted: fn(&Answer) -> bool) -> bool {
    matches!(&comparison.membership, Some(Ok(membership)) if wanted(&membership.answer()))
}

/// The answer in a few words.
pub(crate) fn words(comparison: &Comparison) -> String {
    match &comparison.membership {
        None => "–".into(),
        Some(Err(_)) => "undecided".into(),
        Some(Ok(membership)) => match membership.answer() {
            Answer::NoneProved { order } => format!("**none**: proved (order {order})"),
            Answer::None { .. } => "**none**, not proved".into(),
            Answer::SomeProved if membership.section.is_some() => format!("**{}**: identity", which(membership)),
            Answer::SomeProved => format!("**{}**: proved", which(membership)),
            Answer::Some { order } => format!("**{}**, {}", which(membership), how_far(membership, order)),
            Answer::Undecided => "undecided".into(),
        },
    }
}

/// Sentences for the head of the page of a scene.
pub(crate) fn sentences(comparison: &Comparison) -> Vec<String> {
    let membership = match &comparison.membership {
        None => return Vec::new(),
        Some(Err(error)) => return vec![format!("Whether some μ₀ gives Chetaev's motion is undecided: {error}.")],
        Some(Ok(membership)) => membership,
    };
    let mut sentences = vec![sentence(membership)];
    sentences.extend(least_gap(comparison, &membership.answer()));
    sentences
}

/// The answer in a sentence.
pub fn sentence(membership: &Membership) -> String {
    let decision = &membership.decision;
    let point: Vec<String> = decision.set.point.iter().map(|c| precise(*c)).collect();
    let which = match decision.set.dimension() {
        0 => format!("μ₀ = ({})", point.join(", ")),
        d if d == decision.constants.len() => "every μ₀".to_owned(),
        d => format!("every μ₀ of a set of dimension {d} around ({})", point.join(", ")),
    };
    let mismatch = format!(
        "the least mismatch of accelerations is {} of the motion's own",
        short(decision.least / decision.acceleration)
    );
    match membership.answer() {
        Answer::NoneProved { order } => {
            format!("No μ₀ makes the vakonomic motion Chetaev's: proved (order {order}); {mismatch}.")
        }
        Answer::None { unproved } => {
            format!("No μ₀ makes the vakonomic motion Chetaev's: {mismatch}; there is no proof, since {unproved}.")
        }
        Answer::SomeProved => {
            let section = membership.section.as_ref();
            let reason = section.map_or("proved by ranks that grow no more".to_owned(), |section| {
                format!("an identity, μ₀ = ({}), for all starts", section.expressions.join(", "))
            });
            format!("With {which} the vakonomic motion is the Chetaev motion: {reason}.")
        }
        Answer::Some { order } => {
            format!("With {which} the vakonomic motion is the Chetaev motion, {}.", how_far(membership, order))
        }
        Answer::Undecided => {
            format!("Whether some μ₀ gives Chetaev's motion is undecided: round-off hides it, {mismatch}.")
        }
    }
}

/// What a search over `μ₀` leaves of the gap, where there is none that leaves nothing.
fn least_gap(comparison: &Comparison, answer: &Answer) -> Option<String> {
    if matches!(answer, Answer::SomeProved | Answer::Some { .. }) {
        return None;
    }
    let (run, target) = (comparison.run("vakonomic")?, comparison.run("chetaev")?);
    let fitted = comparison.fits.iter().find(|f| f.run == run && f.target == target)?.fitted.as_ref()?;
    let constants: Vec<String> = fitted.constants.iter().map(|(_, c)| precise(*c)).collect();
    let (constants, gap) = (constants.join(", "), short(fitted.gap.largest));
    Some(format!("The least gap that a search found is {gap}, at μ₀ = ({constants})."))
}

/// For machines: the answer, its order and the dimension of the set; null where there is no constraint.
pub fn value(membership: Option<&Result<Membership, SolveError>>) -> Value {
    let Some(membership) = membership else { return Value::Null };
    let Ok(membership) = membership else { return json!({ "answer": "undecided" }) };
    let dimension = membership.decision.set.dimension();
    match membership.answer() {
        Answer::NoneProved { order } => json!({ "answer": "none", "proved": true, "order": order }),
        Answer::None { unproved } => json!({ "answer": "none", "proved": false, "because": unproved }),
        Answer::SomeProved => json!({ "answer": "some", "proved": true, "dimension": dimension }),
        Answer::Some { order } => {
            json!({ "answer": "some", "proved": false, "order": order, "dimension": dimension })
        }
        Answer::Undecided => json!({ "answer": "undecided" }),
    }
}

/// How many there are.
fn which(membership: &Membership) -> String {
    match membership.decision.set.dimension() {
        0 => "one".into(),
        d if d == membership.decision.constants.len() => "every one".into(),
        d => format!("dimension {d}"),
    }
}

/// How far it was looked, for a yes that is not proved.
fn how_far(membership: &Membership, order: Option<usize>) -> String {
    let decision = &membership.decision;
    let part = decision.least.max(decision.noise) / decision.acceleration;
    let part = format!("to 1e{:.0}", part.log10().ceil());
    order.map_or(part.clone(), |order| format!("through order {order} and {part}"))
}
