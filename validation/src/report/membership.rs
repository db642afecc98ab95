//! Words for the decisions: is there a `μ₀` with which the vakonomic motion is Chetaev's, and the like.

use deltaq::{Answer, Comparison, Decided, Membership, SolveError};
use serde_json::{Value, json};

use crate::report::Table;
use crate::report::numbers::{precise, short};

/// Is the answer for a scene of this kind?
pub(crate) fn is(comparison: &Comparison, wanted: fn(&Answer) -> bool) -> bool {
    matches!(comparison.membership(), Some(Ok(membership)) if wanted(&membership.answer()))
}

/// The answer for Chetaev's motion and the multipliers, in a few words.
pub(crate) fn words(comparison: &Comparison) -> String {
    match comparison.membership() {
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

/// Sentences for the head of the page of a scene, about multipliers and Chetaev's motion.
pub(crate) fn sentences(comparison: &Comparison) -> Vec<String> {
    let Some(outcome) = comparison.membership() else { return Vec::new() };
    let membership = match outcome {
        Err(error) => return vec![format!("Whether some μ₀ gives Chetaev's motion is undecided: {error}.")],
        Ok(membership) => membership,
    };
    let mut sentences = vec![sentence(membership)];
    sentences.extend(least_gap(comparison, &membership.answer()));
    sentences
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

/// Which families have which motions.
pub(crate) fn table(comparison: &Comparison) -> Table {
    let mut table = Table::new(["family", "has the motion", "for", "because"]);
    for decided in &comparison.decided {
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
        table.row(&[&family.label, &curve.label, &which, &reason]);
    }
    table
}

/// The set that was found.
fn constants(membership: &Membership, c: &str) -> String {
    let set = &membership.decision.set;
    let point: Vec<String> = set.point.iter().map(|c| precise(*c)).collect();
    match set.dimension() {
        0 => format!("{c} = ({})", point.join(", ")),
        d if d == membership.decision.constants.len() => format!("every {c}"),
        d => format!("every {c} of a set of dimension {d} around ({})", point.join(", ")),
    }
}

fn reason(membership: &Membership) -> String {
    let decision = &membership.decision;
    let part = short(decision.least / decision.acceleration);
    let mismatch = format!("the least mismatch of accelerations is {part} of the motion's own");
    match membership.answer() {
        Answer::NoneProved { order } => format!("proved (order {order}); {mismatch}"),
        Answer::None { unproved } => {
            format!("{mismatch}{}; there is no proof, since {unproved}", up_to(decision.until))
        }
        Answer::SomeProved => {
            membership.section.as_ref().map_or("proved by ranks that grow no more".into(), |section| {
                format!("an identity, ({}), for all starts", section.expressions.join(", "))
            })
        }
        Answer::Some { order } => how_far(membership, order),
        Answer::Undecided => format!("round-off hides it, {mismatch}{}", up_to(decision.until)),
    }
}

/// Up to when the numbers were judged, where that is not the end.
fn up_to(until: Option<f64>) -> String {
    until.map_or(String::new(), |t| format!(" up to t = {}, after which round-off is too loud", precise(t)))
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

/// For machines: every family and motion asked about, with the answer.
pub(crate) fn values(comparison: &Comparison) -> Value {
    let label = |i: usize| comparison.runs[i].choice.label.clone();
    let of = |decided: &Decided| {
        let mut value = value(Some(&decided.outcome));
        value["family"] = label(decided.family).into();
        value["motion"] = label(decided.curve).into();
        value
    };
    comparison.decided.iter().map(of).collect()
}

/// For machines: the answer, its order and the dimension of the set; null where there is no constraint.
pub fn value(outcome: Option<&Result<Membership, SolveError>>) -> Value {
    let membership = match outcome {
        None => return Value::Null,
        Some(Err(error)) => return json!({ "answer": "undecided", "because": error.to_string() }),
        Some(Ok(membership)) => membership,
    };
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
    let part =
        if part < 1.0 { format!("to 1e{:.0}{}", part.log10().ceil(), up_to(decision.until)) } else { "at rest".into() };
    order.map_or(part.clone(), |order| format!("through order {order} and {part}"))
}
