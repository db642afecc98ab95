//! Which families have which motions: decided, and searched for.

use comparison::words::at_most;
use comparison::{Answer, Membership};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stubs::{answer, stubbed};

#[answer]
pub(crate) struct Fit;

#[stubbed]
impl Fit {
    fn __repr__(&self) -> String {
        let word = if self.settled == Some(false) { " at most" } else { "" };
        let told = |gap: f64| if word.is_empty() { format!("{gap:.3e}") } else { format!("{:.0e}", at_most(gap)) };
        let left = self.largest_gap.map_or("no motion".into(), |gap| format!("gap left{word} {}", told(gap)));
        format!("<deltaq.Fit {} to {}: {left}>", self.run, self.target)
    }
}

#[answer]
pub(crate) struct Decided;

#[stubbed]
impl Decided {
    fn __repr__(&self) -> String {
        let Decided { family, motion, answer, proved, .. } = self;
        let proved = if *proved { "proved" } else { "not proved" };
        format!("<deltaq.Decided {motion} in {family}: {answer}, {proved}>")
    }
}

impl Decided {
    pub(crate) fn new(
        py: Python<'_>,
        family: String,
        motion: String,
        outcome: Result<Membership, motion::SolveError>,
    ) -> PyResult<Self> {
        let (answer, proved, order, because) = match outcome.as_ref().map(Membership::answer) {
            Err(error) => ("undecided", false, None, Some(error.to_string())),
            Ok(Answer::NoneProved { order }) => ("none", true, Some(order), None),
            Ok(Answer::None { unproved }) => ("none", false, None, Some(unproved)),
            Ok(Answer::SomeProved) => ("some", true, None, None),
            Ok(Answer::Some { order, .. }) => ("some", false, order, None),
            Ok(Answer::Undecided) => ("undecided", false, None, Some("round-off hides it".into())),
        };
        let membership = outcome.ok();
        let constants = membership.as_ref().map(|m| -> PyResult<Py<PyDict>> {
            let dict = PyDict::new(py);
            let values = m.decision.constants.iter().zip(&m.decision.set.point);
            values.into_iter().try_for_each(|(name, value)| dict.set_item(name, value))?;
            Ok(dict.unbind())
        });
        let dimension = membership.as_ref().filter(|_| answer == "some").map(Membership::dimension);
        let mismatch = membership.as_ref().map(|m| m.decision.least / m.decision.acceleration);
        let identity = membership.and_then(|m| m.section).map(|section| section.expressions);
        let (constants, answer) = (constants.transpose()?, answer.into());
        Ok(Decided { family, motion, answer, proved, order, because, constants, dimension, identity, mismatch })
    }
}
