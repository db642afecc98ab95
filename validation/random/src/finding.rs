//! The finding on a claim for one system.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Word {
    /// It holds within the error estimates.
    Holds,
    /// It fails by more than the errors explain.
    Fails,
    /// The errors are too large to decide, or a motion could not be computed.
    Undecided,
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Word::Holds => "holds",
            Word::Fails => "fails",
            Word::Undecided => "undecided",
        })
    }
}

/// A claim that was put to the test on one system.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Number of the theorem; 0 for what must hold within one formulation.
    pub theorem: u8,
    /// The claim.
    pub claim: &'static str,
    /// The verdict.
    pub word: Word,
    /// The measured number.
    pub figure: f64,
    /// Its limit.
    pub limit: f64,
    /// Why it is undecided, or what else to say.
    pub note: String,
}

/// Something that is counted or measured, and that no claim forbids.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Number of the theorem that it belongs to.
    pub theorem: u8,
    /// What it is.
    pub what: &'static str,
    /// Its value; 0 or 1 for what is counted.
    pub value: f64,
}

/// Everything that was found on one system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Claims tested.
    pub findings: Vec<Finding>,
    /// Things measured.
    pub observations: Vec<Observation>,
}

impl Findings {
    /// Notes whether `figure` stays within `limit`. NaN does not.
    pub fn bound(&mut self, theorem: u8, claim: &'static str, figure: f64, limit: f64) {
        let word = if figure <= limit { Word::Holds } else { Word::Fails };
        self.findings.push(Finding { theorem, claim, word, figure, limit, note: String::new() });
    }

    /// Notes that the claim cannot be decided, and why.
    pub fn undecided(&mut self, theorem: u8, claim: &'static str, note: impl fmt::Display) {
        let (figure, limit, note) = (f64::NAN, f64::NAN, note.to_string());
        self.findings.push(Finding { theorem, claim, word: Word::Undecided, figure, limit, note });
    }

    /// Notes whether something is so.
    pub fn require(&mut self, theorem: u8, claim: &'static str, so: bool, note: impl fmt::Display) {
        let word = if so { Word::Holds } else { Word::Fails };
        self.findings.push(Finding { theorem, claim, word, figure: f64::NAN, limit: f64::NAN, note: note.to_string() });
    }

    /// Notes a measured value.
    pub fn observe(&mut self, theorem: u8, what: &'static str, value: f64) {
        self.observations.push(Observation { theorem, what, value });
    }

    /// Notes whether something that no claim forbids is so.
    pub fn count(&mut self, theorem: u8, what: &'static str, so: bool) {
        self.observe(theorem, what, f64::from(u8::from(so)));
    }

    /// The word on a theorem: fails if one claim fails, undecided if one is; `None` if none applied.
    pub fn word(&self, theorem: u8) -> Option<Word> {
        let words = || self.findings.iter().filter(|f| f.theorem == theorem).map(|f| f.word);
        [Word::Fails, Word::Undecided, Word::Holds].into_iter().find(|word| words().any(|w| w == *word))
    }

    /// Adds the findings of another test.
    pub fn join(&mut self, other: Findings) {
        self.findings.extend(other.findings);
        self.observations.extend(other.observations);
    }

    /// Claims that failed.
    pub fn failures(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|f| f.word == Word::Fails)
    }
}
