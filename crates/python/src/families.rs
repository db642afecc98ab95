//! Which families have which motions: decided, and searched for.

use comparison::words::at_most;
use comparison::{Answer, Membership};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::pickled::kept;

/// The free constants with which one motion comes closest to another.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Fit {
    /// Label of the motion whose constants were fitted.
    pub(crate) run: String,
    /// Label of the motion that was to be met.
    pub(crate) target: String,
    /// The best constants by name; None where no constants lead to a motion over the whole time.
    pub(crate) constants: Option<Py<PyDict>>,
    /// "same", "different" or "undecided" of what is left; None as for `constants`.
    pub(crate) verdict: Option<String>,
    /// Largest gap that is left, the least that was found; None as for `constants`.
    pub(crate) largest_gap: Option<f64>,
    /// The same from half of the starts; None as for `constants`.
    pub(crate) largest_gap_by_half: Option<f64>,
    /// Whether both are the same to 1 percent: if not, digits mean nothing; None as for `constants`.
    pub(crate) settled: Option<bool>,
    /// Number of starts of the search, 0 for an identity; None as for `constants`.
    pub(crate) starts: Option<usize>,
    /// Whether the constants follow from those of the target, and nothing was searched.
    pub(crate) by_identity: bool,
}

kept!(Fit: run target constants verdict largest_gap largest_gap_by_half settled starts by_identity);

#[pymethods]
impl Fit {
    fn __repr__(&self) -> String {
        let word = if self.settled == Some(false) { " at most" } else { "" };
        let told = |gap: f64| if word.is_empty() { format!("{gap:.3e}") } else { format!("{:.0e}", at_most(gap)) };
        let left = self.largest_gap.map_or("no motion".into(), |gap| format!("gap left{word} {}", told(gap)));
        format!("<deltaq.Fit {} to {}: {left}>", self.run, self.target)
    }
}

/// Whether a motion belongs to the family that another formulation has for all values of its constants.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Decided {
    /// Label of the run whose constants are asked for.
    pub(crate) family: String,
    /// Label of the run that is to be met.
    pub(crate) motion: String,
    /// "some", "none" or "undecided".
    pub(crate) answer: String,
    /// Whether the answer is proved, in exact numbers or as an identity.
    pub(crate) proved: bool,
    /// The Taylor order that proves "none", or through which "some" was checked; None where there is neither.
    pub(crate) order: Option<usize>,
    /// What stands in the way of a proof or of a decision, else None.
    pub(crate) because: Option<String>,
    /// The constants of least norm, or of the nearest miss, by name.
    pub(crate) constants: Option<Py<PyDict>>,
    /// Dimension of the set of constants, None unless the answer is "some".
    pub(crate) dimension: Option<usize>,
    /// The constants as functions of the start, where an identity was found.
    pub(crate) identity: Option<Vec<String>>,
    /// Least mismatch of accelerations over the motion's own, None where nothing could be computed.
    pub(crate) mismatch: Option<f64>,
}

kept!(Decided: family motion answer proved order because constants dimension identity mismatch);

#[pymethods]
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
