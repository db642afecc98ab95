//! Words for the decisions: is there a `μ₀` with which the vakonomic motion is Chetaev's, and the like.

use deltaq::{Answer, Comparison, Decided, Membership};
use serde_json::{Value, json};

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

/// Sentences for the head of the page of a scene.
pub(crate) fn sentences(comparison: &Comparison) -> Vec<String> {
    let mut sentences: Vec<String> = comparison.decided.iter().map(|decided| sentence(comparison, decided)).collect();
    if let Some(Ok(membership)) = comparison.membership() {
        sentences.extend(least_gap(comparison, &membership.answer()));
    }
    sentences
}

fn sentence(comparison: &Comparison, decided: &Decided) -> String {
    let [family, curve] = [decided.family, decided.curve].map(|i| &comparison.runs[i].choice);
    let c = if family.removal.is_some() { "P(t₀)" } else { "μ₀" };
    let (family, motion) = match curve.formulation {
        "chetaev" => (&family.label, "Chetaev's"),
        _ => (&family.label, "the vakonomic one"),
    };
    let membership = match &decided.outcome {
        Err(error) => return format!("Whether some {c} makes the {family} motion {motion} is undecided: {error}."),
        Ok(membership) => membership,
    };
    let decision = &membership.decision;
    let point: Vec<String> = decision.set.point.iter().map(|c| precise(*c)).collect();
    let which = match decision.set.dimension() {
        0 => format!("{c} = ({})", point.join(", ")),
        d if d == decision.constants.len() => format!("every {c}"),
        d => format!("every {c} of a set of dimension {d} around ({})", point.join(", ")),
    };
    let mismatch = format!(
        "the least mismatch of accelerations is {} of the motion's own",
        short(decision.least / decision.acceleration)
    );
    match membership.answer() {
        Answer::NoneProved { order } => {
            format!("No {c} makes the {family} motion {motion}: proved (order {order}); {mismatch}.")
        }
        Answer::None { unproved } => {
            format!("No {c} makes the {family} motion {motion}: {mismatch}; there is no proof, since {unproved}.")
        }
        Answer::SomeProved => {
            let section = membership.section.as_ref();
            let reason = section.map_or("proved by ranks that grow no more".to_owned(), |section| {
                format!("an identity, {c} = ({}), for all starts", section.expressions.join(", "))
            });
            format!("With {which} the {family} motion is {motion}: {reason}.")
        }
        Answer::Some { order } => {
            format!("With {which} the {family} motion is {motion}, {}.", how_far(membership, order))
        }
        Answer::Undecided => {
            format!("Whether some {c} makes the {family} motion {motion} is undecided: round-off hides it, {mismatch}.")
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

/// For machines: for each family and motion asked about the answer, its order and the dimension of the set.
pub(crate) fn value(comparison: &Comparison) -> Value {
    let label = |i: usize| comparison.runs[i].choice.label.clone();
    let of = |decided: &Decided| {
        let mut value = match &decided.outcome {
            Err(error) => json!({ "answer": "undecided", "because": error.to_string() }),
            Ok(membership) => answer(membership),
        };
        value["family"] = label(decided.family).into();
        value["motion"] = label(decided.curve).into();
        value
    };
    comparison.decided.iter().map(of).collect()
}

fn answer(membership: &Membership) -> Value {
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
