//! Questions and answers.

use std::collections::BTreeMap;

use scene::SceneError;
use serde::{Deserialize, Serialize};

/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ask {
    /// What can be varied, and which motions there are.
    Scene,
    /// Motions and gaps between them.
    Motions,
    /// The equations of the motions in LaTeX.
    Equations,
    /// The comparison in words.
    Decision,
    /// Invariant measures and integrals of the first motion.
    Integrals,
    /// Derivatives of where every motion ends by the numbers that can be set.
    Derivatives,
    /// The scene as a text with the numbers that are set in it; costates are not.
    Text,
    /// What a reviewer would ask about the text, as `deltaq check` says it.
    Check,
    /// Whether equations of motion are right ([`Question::theirs`]).
    Review,
}

/// A question about the text of a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Question {
    /// What is asked.
    pub ask: Ask,
    /// Name of the scene; stands for the file in faults.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Numbers in the place of those of the text.
    #[serde(default)]
    pub set: BTreeMap<String, f64>,
    /// Labels of the motions that are asked about ([`motion::Choice::label`]); the first is what gaps are to.
    #[serde(default)]
    pub motions: Vec<String>,
    /// Equal steps in which motions are sampled, of the whole duration.
    #[serde(default)]
    pub steps: usize,
    /// Integrals are polynomials in the velocities up to this degree.
    #[serde(default)]
    pub degree: usize,
    /// Equations to be reviewed.
    #[serde(default)]
    pub theirs: String,
    /// One run of every motion only, coarser and without an error estimate: to follow a hand on a slider.
    #[serde(default)]
    pub glance: bool,
    /// Velocities, reactions at the contacts and virtual displacements, too.
    #[serde(default)]
    pub forces: bool,
    /// What a hand takes hold of at the start, too.
    #[serde(default)]
    pub grips: bool,
}

/// An answer: an object of JSON, and the numbers to which it points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// The object; of a text that is no scene `faults`, of a question that cannot be answered `refused`.
    pub text: String,
    /// Samples, row by row.
    pub numbers: Vec<f64>,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Refused {
    /// The text is no scene.
    #[error(transparent)]
    Faulty(#[from] SceneError),
    /// A motion cannot be computed or evaluated.
    #[error(transparent)]
    Motion(#[from] motion::SolveError),
    /// Nothing can be said of integrals.
    #[error(transparent)]
    Integrals(#[from] integrals::NoAnswer),
    /// Equations cannot be read.
    #[error(transparent)]
    Review(#[from] review::ReviewError),
    /// The question is none.
    #[error("the question cannot be read: {0}")]
    Question(#[from] serde_json::Error),
}
