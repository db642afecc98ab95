//! Words for the decisions: is there a `μ₀` with which the vakonomic motion is Chetaev's, and the like.

use comparison::words::decisions;
use comparison::{Answer, Comparison, Membership};
use motion::SolveError;
use schemars::JsonSchema;
use serde::Serialize;

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

/// A decision for machines.
#[derive(Serialize, JsonSchema)]
pub struct Decision {
    answer: Word,
    #[serde(skip_serializing_if = "Option::is_none")]
    proved: Option<bool>,
    /// Of the Taylor coefficient that shows it, or up to which they agree; null where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    order: Option<Option<usize>>,
    /// Of the set of constants.
    #[serde(skip_serializing_if = "Option::is_none")]
    dimension: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    because: Option<String>,
}

/// Whether some constants of a family give a motion.
#[derive(Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Word {
    /// No constants give it.
    None,
    /// Some do.
    Some,
    /// Neither is shown.
    Undecided,
    /// The scene has no constraint, and every motion is one of both.
    Unconstrained,
}

impl Decision {
    /// The answer in a word.
    pub fn word(answer: Word) -> Self {
        Decision { answer, proved: None, order: None, dimension: None, because: None }
    }

    /// None, proved at this order.
    pub fn none(order: usize) -> Self {
        Decision { proved: Some(true), order: Some(Some(order)), ..Decision::word(Word::None) }
    }

    /// The answer, its order and the dimension of the set.
    pub fn of(outcome: &Result<Membership, SolveError>) -> Self {
        let membership = match outcome {
            Err(error) => return Decision { because: Some(error.to_string()), ..Decision::word(Word::Undecided) },
            Ok(membership) => membership,
        };
        let dimension = Some(membership.dimension());
        let some = |proved, order| Decision { proved: Some(proved), order, dimension, ..Decision::word(Word::Some) };
        match membership.answer() {
            Answer::NoneProved { order } => Decision::none(order),
            Answer::None { unproved } => {
                Decision { proved: Some(false), because: Some(unproved), ..Decision::word(Word::None) }
            }
            Answer::SomeProved => some(true, None),
            Answer::Some { order, .. } => some(false, Some(order)),
            Answer::Undecided => Decision::word(Word::Undecided),
        }
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
