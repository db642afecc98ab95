//! Records of a bulk run, one per system, and their summary.

use std::collections::BTreeMap;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::claims::{CHECKS, DIVERGES, Divergence, make};
use super::finding::Word;
use super::{Case, Fault, Findings, Kind, NullTest, Recipe, null_test};

/// Of each kind, one system in this many also gets the thorough checks, and a null test after it.
pub const THOROUGH: u64 = 10;

/// Pairs of formulations in dispute: all of [`DIVERGES`] but the one with the control, which nobody defends.
const DISPUTED: &[Divergence] = DIVERGES.split_at(3).0;

/// T13 is on systems of its own, on which formulations differ by closed forms.
const NULL_TESTS: u8 = 13;

/// A claim on one system that does not hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Open {
    /// Number of the theorem.
    pub theorem: u8,
    /// The claim.
    pub claim: String,
    /// `fails` or `undecided`.
    pub word: Word,
    /// What was measured, and what it should not have passed, where there is a figure.
    pub figure: Option<(f64, f64)>,
    /// Why.
    pub note: String,
}

/// One system of a bulk run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Index of the system.
    pub index: u64,
    /// Its kind.
    pub kind: Kind,
    /// Number of coordinates.
    pub coordinates: usize,
    /// Number of constraints.
    pub constraints: usize,
    /// What it has besides: a switch, a root, a rare function, a start far from the origin.
    #[serde(default)]
    pub features: Vec<String>,
    /// Why the run was shortened, if it was.
    pub shortened: Option<String>,
    /// How often each claim held: theorem, claim, count.
    pub held: Vec<(u8, String, u32)>,
    /// Claims that did not hold.
    pub open: Vec<Open>,
    /// What was measured besides: theorem, what, value.
    pub observed: Vec<(u8, String, f64)>,
    /// Seconds: drawing, derivation and integration of all formulations, then each theorem's checks.
    pub seconds: (f64, Vec<(u8, f64)>),
}

impl Record {
    /// Puts one recipe to the test, and the numbers of a null test.
    pub(crate) fn of(recipe: Recipe, index: u64, thorough: bool, null: Option<&NullTest>, fault: &Fault) -> Record {
        let mut record = Record {
            index,
            kind: recipe.kind,
            coordinates: recipe.n(),
            constraints: recipe.h(),
            features: recipe.features.names().into_iter().chain(recipe.drawn.names()).map(String::from).collect(),
            shortened: None,
            held: Vec::new(),
            open: Vec::new(),
            observed: Vec::new(),
            seconds: (0.0, Vec::new()),
        };
        let clock = Instant::now();
        let case = Case::new(recipe, "random").and_then(|mut case| (fault.case)(&mut case).map(|()| case));
        let mut found = match case {
            Ok(mut case) => {
                record.seconds.0 = clock.elapsed().as_secs_f64();
                for check in CHECKS.iter().filter(|check| thorough || !check.thorough) {
                    let clock = Instant::now();
                    make(check, &mut case);
                    record.seconds.1.push((check.theorem, clock.elapsed().as_secs_f64()));
                }
                record.shortened = case.shortened;
                case.found
            }
            Err(error) => {
                let mut found = Findings::default();
                found.undecided(0, "every formulation has a motion", error);
                found
            }
        };
        match null.map(|numbers| null_test(numbers, fault)) {
            None => {}
            Some(Ok(null)) => found.join(null),
            Some(Err(error)) => found.undecided(13, "null tests", error),
        }
        record.take(found);
        record
    }

    fn take(&mut self, found: Findings) {
        let mut held: BTreeMap<(u8, &str), u32> = BTreeMap::new();
        for f in &found.findings {
            if f.word == Word::Holds {
                *held.entry((f.theorem, f.claim)).or_default() += 1;
                continue;
            }
            let figure = (f.figure.is_finite() && f.limit.is_finite()).then_some((f.figure, f.limit));
            let (theorem, claim, word, note) = (f.theorem, f.claim.to_string(), f.word, f.note.clone());
            self.open.push(Open { theorem, claim, word, figure, note });
        }
        self.held = held.into_iter().map(|((theorem, claim), count)| (theorem, claim.to_string(), count)).collect();
        let finite = found.observations.iter().filter(|o| o.value.is_finite());
        self.observed = finite.map(|o| (o.theorem, o.what.to_string(), o.value)).collect();
    }

    /// The word on a theorem; `None` where none of its claims applied.
    pub fn word(&self, theorem: u8) -> Option<Word> {
        let open = |word: Word| self.open.iter().any(|o| o.theorem == theorem && o.word == word);
        match () {
            () if open(Word::Fails) => Some(Word::Fails),
            () if open(Word::Undecided) => Some(Word::Undecided),
            () => self.held.iter().any(|(t, _, _)| *t == theorem).then_some(Word::Holds),
        }
    }

    /// Whether something is at stake: formulations certainly have different motions here, for constants that
    /// they are free to have.
    pub fn is_disputed(&self) -> bool {
        let differ = |what: &str| DISPUTED.iter().any(|names| names.differs == what);
        self.observed.iter().any(|(_, what, value)| *value == 1.0 && differ(what))
    }

    /// Theorems with a claim that failed.
    pub fn failures(&self) -> Vec<u8> {
        let mut theorems: Vec<u8> = self.open.iter().filter(|o| o.word == Word::Fails).map(|o| o.theorem).collect();
        theorems.dedup();
        theorems
    }
}

/// Milliseconds of work a system, on the average: of all formulations, then of each theorem's checks.
pub fn milliseconds(records: &[Record]) -> (f64, BTreeMap<u8, f64>) {
    let each = 1e3 / records.len().max(1) as f64;
    let mut checks: BTreeMap<u8, f64> = BTreeMap::new();
    for (theorem, seconds) in records.iter().flat_map(|record| &record.seconds.1) {
        *checks.entry(*theorem).or_default() += each * seconds;
    }
    (records.iter().map(|record| each * record.seconds.0).sum(), checks)
}

/// How often a word was said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Claim holds.
    pub holds: u64,
    /// Claim fails.
    pub fails: u64,
    /// Undecided.
    pub undecided: u64,
}

impl Count {
    fn add(&mut self, word: Word, times: u64) {
        match word {
            Word::Holds => self.holds += times,
            Word::Fails => self.fails += times,
            Word::Undecided => self.undecided += times,
        }
    }

    /// How often anything was said.
    pub fn total(self) -> u64 {
        self.holds + self.fails + self.undecided
    }
}

/// The summary of a bulk run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Number of systems.
    pub systems: u64,
    /// Systems of each kind.
    pub kinds: BTreeMap<String, u64>,
    /// Systems by number of coordinates and constraints.
    pub sizes: BTreeMap<String, u64>,
    /// Systems with each feature.
    pub features: BTreeMap<String, u64>,
    /// Systems whose run was shortened because a motion stops.
    pub shortened: u64,
    /// Systems on which a theorem holds, fails or is undecided; 0 is what must hold within each formulation.
    pub theorems: BTreeMap<u8, Count>,
    /// Of these, those on which something is at stake: [`Record::is_disputed`].
    pub at_stake: BTreeMap<u8, u64>,
    /// Single claims.
    pub claims: BTreeMap<u8, BTreeMap<String, Count>>,
    /// What was measured, sorted.
    pub observed: BTreeMap<u8, BTreeMap<String, Vec<f64>>>,
}

impl Summary {
    /// Adds up records.
    pub fn of(records: &[Record]) -> Summary {
        let mut summary = Summary { systems: records.len() as u64, ..Summary::default() };
        for record in records {
            *summary.kinds.entry(record.kind.to_string()).or_default() += 1;
            *summary.sizes.entry(format!("{}, {}", record.coordinates, record.constraints)).or_default() += 1;
            for feature in &record.features {
                *summary.features.entry(feature.clone()).or_default() += 1;
            }
            summary.shortened += u64::from(record.shortened.is_some());
            for theorem in 0..=CHECKS[CHECKS.len() - 1].theorem {
                if let Some(word) = record.word(theorem) {
                    summary.theorems.entry(theorem).or_default().add(word, 1);
                    *summary.at_stake.entry(theorem).or_default() +=
                        u64::from(theorem == NULL_TESTS || record.is_disputed());
                }
            }
            let mut claim = |theorem: u8, claim: &str, word: Word, times: u64| {
                summary.claims.entry(theorem).or_default().entry(claim.into()).or_default().add(word, times);
            };
            for (theorem, name, times) in &record.held {
                claim(*theorem, name, Word::Holds, u64::from(*times));
            }
            for open in &record.open {
                claim(open.theorem, &open.claim, open.word, 1);
            }
            for (theorem, what, value) in &record.observed {
                summary.observed.entry(*theorem).or_default().entry(what.clone()).or_default().push(*value);
            }
        }
        for values in summary.observed.values_mut().flat_map(BTreeMap::values_mut) {
            values.sort_by(f64::total_cmp);
        }
        summary
    }

    /// How many of these are on systems on which something is at stake.
    pub fn total_at_stake(&self) -> u64 {
        self.at_stake.values().sum()
    }

    /// All words on theorems together.
    pub fn total(&self) -> Count {
        self.theorems.values().fold(Count::default(), |mut sum, count| {
            sum.holds += count.holds;
            sum.fails += count.fails;
            sum.undecided += count.undecided;
            sum
        })
    }
}
