//! Words for the decisions: is there a `μ₀` with which the vakonomic motion is Chetaev's, and the like.

use comparison::words::decisions;
use comparison::{Answer, Comparison, Decided, Membership};
use motion::SolveError;
use serde_json::{Value, json};

use crate::table::Table;

/// Is the answer for a scene of this kind?
pub fn is(comparison: &Comparison, wanted: fn(&Answer) -> bool) -> bool {
    matches!(comparison.membership(), Some(Ok(membership)) if wanted(&membership.answer()))
}

/// The answer for Chetaev's motion and the multipliers in a word, in italics where it is not proved.
pub fn word(comparison: &Comparison) -> String {
    match comparison.membership() {
        None => "–".into(),
        Some(Err(_)) => "?".into(),
        Some(Ok(membership)) => match membership.answer() {
            Answer::NoneProved { .. } => "none".into(),
            Answer::None { .. } => "*none*".into(),
            Answer::SomeProved => which(membership),
            Answer::Some { .. } => format!("*{}*", which(membership)),
            Answer::Undecided => "?".into(),
        },
    }
}

/// Which families have which motions.
pub(crate) fn table(comparison: &Comparison) -> Table {
    let mut table = Table::new(["family", "has the motion", "for", "because"]);
    for [family, curve, which, reason] in decisions(comparison) {
        table.row(&[&family, &curve, &which, &reason]);
    }
    table
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
    let dimension = membership.dimension();
    match membership.answer() {
        Answer::NoneProved { order } => json!({ "answer": "none", "proved": true, "order": order }),
        Answer::None { unproved } => json!({ "answer": "none", "proved": false, "because": unproved }),
        Answer::SomeProved => json!({ "answer": "some", "proved": true, "dimension": dimension }),
        Answer::Some { order, .. } => {
            json!({ "answer": "some", "proved": false, "order": order, "dimension": dimension })
        }
        Answer::Undecided => json!({ "answer": "undecided" }),
    }
}

/// How many there are.
fn which(membership: &Membership) -> String {
    match membership.dimension() {
        0 => "one".into(),
        d if d == membership.decision.constants.len() => "every".into(),
        d => format!("{d} dimensions"),
    }
}
