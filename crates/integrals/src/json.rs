//! Answers as JSON.

use mechanics::Domain;
use schemars::JsonSchema;
use serde::Serialize;

use crate::words::{density_words, factor_words, kind, names};
use crate::{Ansatz, Cyclic, Found, Integrals, Measure, Multiplier, Open, Printed, Reduction};

/// Invariant measures and first integrals: `deltaq integrals --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "integrals/1")]
pub struct Answer<'a> {
    scene: &'a str,
    formulation: &'a str,
    /// Where answers hold: almost every place, or those of the leaf and branch of the start.
    domain: String,
    /// Whether Chetaev's motion has an invariant measure exp(sigma(q)) dq dp, smooth and positive near
    /// almost every point; null for another formulation.
    measure: Option<AnswerOfMeasure>,
    /// Whether dtau = f dt makes Chetaev's motion over some of the coordinates Hamilton's, for each choice
    /// of these that has a motion of its own; null for another formulation.
    multipliers: Option<OrOpen<Vec<AnswerOfMultiplier>>>,
    /// Integrals that are polynomials in the velocities, near almost every point, degree by degree; null for
    /// another formulation than Chetaev's.
    polynomials: Option<Vec<Polynomials<'a>>>,
    ansatz: OrOpen<AnswerOfAnsatz<'a>>,
    /// The scene's own, or why none was tried.
    invariants: OrOpen<Vec<Invariant<'a>>>,
}

/// What was found, or why the question stays open.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
enum OrOpen<T> {
    Found(T),
    Open { reason: String },
}

#[derive(Serialize, JsonSchema)]
#[serde(tag = "answer", rename_all = "lowercase")]
enum AnswerOfMeasure {
    None {
        /// A minor of full size is not zero. Else ranks modulo two primes say so.
        proved: bool,
    },
    Local {
        /// In the names of the scene; null for one that is not printed.
        density: Option<String>,
        #[serde(flatten)]
        cyclic: Option<NoneFreeOf>,
    },
    Open {
        reason: String,
    },
}

#[derive(Serialize, JsonSchema)]
struct NoneFreeOf {
    /// Coordinates that L and the constraints do not contain, where every density depends on one of them.
    none_free_of: Vec<String>,
    /// As of none.
    proved: bool,
}

#[derive(Serialize, JsonSchema)]
#[serde(tag = "answer", rename_all = "lowercase")]
enum AnswerOfMultiplier {
    /// Proved.
    None { over: Vec<String> },
    Local {
        over: Vec<String>,
        /// f, in the names of the scene; null for one that is not printed.
        factor: Option<String>,
    },
}

#[derive(Serialize, JsonSchema)]
struct Polynomials<'a> {
    degree: usize,
    answer: Count,
    #[serde(flatten)]
    numbers: Option<&'a Found>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Count {
    /// No more than the trivial ones, proved.
    None,
    /// As many as at_most, by ranks.
    Local,
    Open,
}

#[derive(Serialize, JsonSchema)]
struct AnswerOfAnsatz<'a> {
    #[serde(flatten)]
    found: &'a Ansatz,
    printed: Vec<Integral<'a>>,
}

#[derive(Serialize, JsonSchema)]
struct Integral<'a> {
    #[schemars(extend("enum" = ["energy", "moving energy", "integral"]))]
    kind: &'static str,
    degree: usize,
    expression: &'a str,
    /// Largest change along the scene's motion, in parts of the sum of the terms without signs.
    #[serde(skip_serializing_if = "Option::is_none")]
    drift: Option<f64>,
    /// Why there is no motion to try it on.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_motion: Option<&'a str>,
}

#[derive(Serialize, JsonSchema)]
struct Invariant<'a> {
    name: &'a str,
    /// True: at random points of two fields. False: proved.
    constant: bool,
}

impl<T> OrOpen<T> {
    fn of<S>(found: Result<S, &Open>, answer: impl FnOnce(S) -> T) -> Self {
        found.map_or_else(|open| OrOpen::Open { reason: open.to_string() }, |found| OrOpen::Found(answer(found)))
    }
}

impl Integrals {
    /// What was found, for machines.
    pub fn answer(&self) -> Answer<'_> {
        let system = &self.scene.system;
        let reversed = self.reversed.as_ref();
        let measure = |measure: &Measure| match measure {
            Measure::None { proved } => AnswerOfMeasure::None { proved: *proved },
            Measure::Local { density, cyclic } => {
                let none_free_of = |Cyclic { places, proved }: &Cyclic| NoneFreeOf {
                    none_free_of: names(system, places),
                    proved: *proved,
                };
                let density = density.as_ref().map(|density| density_words(system, density));
                AnswerOfMeasure::Local { density, cyclic: cyclic.as_ref().map(none_free_of) }
            }
            Measure::Open(open) => AnswerOfMeasure::Open { reason: open.to_string() },
        };
        let multiplier = |found: &Reduction| {
            let over = names(system, &found.over);
            match &found.multiplier {
                Multiplier::None => AnswerOfMultiplier::None { over },
                Multiplier::Local(factor) => {
                    let factor = factor.as_ref().map(|factor| factor_words(system, factor));
                    AnswerOfMultiplier::Local { over, factor }
                }
            }
        };
        Answer {
            scene: &self.scene.name,
            formulation: self.formulation,
            domain: Domain::of(system).almost_every("place"),
            measure: reversed.map(|found| measure(&found.measure)),
            multipliers: reversed
                .map(|found| OrOpen::of(found.reductions.as_ref(), |found| found.iter().map(multiplier).collect())),
            polynomials: reversed.map(|found| found.integrals.iter().enumerate().map(count).collect()),
            ansatz: OrOpen::of(self.ansatz.as_ref(), |found| AnswerOfAnsatz {
                found,
                printed: found.printed.iter().enumerate().map(|(i, integral)| self.printed(i, integral)).collect(),
            }),
            invariants: OrOpen::of(self.invariants.as_ref(), |found| {
                found.iter().map(|(name, constant)| Invariant { name, constant: *constant }).collect()
            }),
        }
    }

    fn printed<'a>(&'a self, i: usize, integral: &'a Printed) -> Integral<'a> {
        Integral {
            kind: kind(integral),
            degree: integral.degree,
            expression: &integral.text,
            drift: self.drifts.as_ref().ok().map(|drifts| drifts[i].of_terms()),
            no_motion: self.drifts.as_ref().err().map(String::as_str),
        }
    }
}

/// Of the degree after `i`.
fn count((i, found): (usize, &Result<Found, Open>)) -> Polynomials<'_> {
    match found {
        Err(open) => Polynomials { degree: i + 1, answer: Count::Open, numbers: None, reason: Some(open.to_string()) },
        Ok(found) => Polynomials {
            degree: found.degree,
            answer: match found {
                _ if found.none_proved() => Count::None,
                _ if found.settled => Count::Local,
                _ => Count::Open,
            },
            numbers: Some(found),
            reason: None,
        },
    }
}
