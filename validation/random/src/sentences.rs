//! What is said of a scene, for two writings of it.

use std::collections::BTreeMap;

use comparison::{Answer, Verdict, compare_unfitted};
use integrals::{Integrals, Measure, NoAnswer};
use mechanics::Integrability;
use motion::{CHETAEV, Settings, VAKONOMIC, choices_among};
use scene::Scene;

/// A sentence, as far as it can be compared.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    /// It is open, in doubt, or not asked.
    Open,
    /// Words that do not depend on how the scene is written.
    Word(String),
    /// Of a set of constants: its dimension, `None` where it is empty.
    Dimension(Option<usize>),
    /// Integrable combinations among the constraints.
    Integrable(usize),
    /// The first ranks of a growth vector at the start, or all.
    Ranks(Vec<usize>),
    /// A number and its error.
    Number(f64, f64),
}

impl Said {
    /// `same`, `open`, or nothing where the other says something else; a writing adds that many constraints
    /// that are integrable.
    pub fn beside(&self, other: &Said, adds: usize) -> Option<&'static str> {
        let is_same = match (self, other) {
            (Said::Open, _) | (_, Said::Open) => return Some("open"),
            (Said::Dimension(Some(one)), Said::Dimension(Some(two))) => one + adds == *two,
            (Said::Integrable(one), Said::Integrable(two)) => one + adds == *two,
            (Said::Ranks(one), Said::Ranks(two)) => one.iter().zip(two).all(|(one, two)| one == two),
            (Said::Number(one, error), Said::Number(two, more)) => {
                (one - two).abs() <= 100.0 * (error + more) + 1e-6 * one.abs()
            }
            _ => self == other,
        };
        is_same.then_some("same")
    }
}

fn word(word: impl ToString) -> Said {
    Said::Word(word.to_string())
}

/// All of them by what they are about; about measures and integrals as well, or not.
///
/// # Errors
/// In words: what contradicts something else, or why there is no comparison.
pub fn sentences(scene: &Scene, with_integrals: bool) -> Result<BTreeMap<String, Said>, String> {
    let mut all = BTreeMap::new();
    let choices = choices_among(scene, |own| own == CHETAEV || own == VAKONOMIC);
    let settings = Settings { max_steps: 20_000, ..Settings::default() };
    let compared =
        compare_unfitted(scene.clone(), choices.clone(), Vec::new(), &settings).map_err(|fault| fault.to_string())?;
    compared.is_sound().map_err(|fault| fault.to_string())?;
    let h = scene.system.constraints.len();
    let (mut generic, mut at_start) = (Said::Open, Said::Open);
    let integrable = match &compared.integrability {
        Integrability::Integrable { .. } => Said::Integrable(h),
        Integrability::PartlyIntegrable { integrals, .. } => Said::Integrable(*integrals),
        Integrability::Nonintegrable { growth, .. } => {
            if let Some(growth) = growth {
                generic = word(format!("{:?}", growth.generic));
                at_start = if growth.exact { Said::Ranks(growth.start.clone()) } else { Said::Open };
            }
            Said::Integrable(0)
        }
        Integrability::Unconstrained => Said::Integrable(0),
        Integrability::NonlinearInVelocity => word("nonlinear"),
        Integrability::Undecided { .. } => Said::Open,
    };
    all.insert("integrable".into(), integrable);
    all.insert("growth at almost every place".into(), generic);
    all.insert("growth at the start".into(), at_start);
    if let Some(Ok(found)) = compared.membership() {
        all.insert(
            "multipliers".into(),
            match found.answer() {
                Answer::NoneProved { .. } | Answer::None { .. } => Said::Dimension(None),
                Answer::SomeProved | Answer::Some { .. } => Said::Dimension(Some(found.dimension())),
                Answer::Undecided => Said::Open,
            },
        );
    }
    for pair in compared.pairs.iter().filter(|pair| pair.first == 0 && pair.second == 1) {
        let verdict = match pair.gap.verdict {
            Verdict::Same => word("same"),
            Verdict::Different => word("different"),
            Verdict::Undecided { .. } => Said::Open,
        };
        let ends = scene.start.t + scene.duration == pair.gap.end;
        if ends && pair.gap.verdict == Verdict::Different && pair.gap.certain_from.is_some() {
            let error = pair.gap.estimates.iter().sum();
            all.insert("gap".into(), Said::Number(pair.gap.largest, error));
        }
        all.insert("verdict".into(), verdict);
    }
    let chetaev = choices.iter().filter(|_| with_integrals).find(|choice| choice.formulation == CHETAEV);
    let Some(chetaev) = chetaev else { return Ok(all) };
    let found = match Integrals::find(scene, chetaev, 1, &[]) {
        Ok(found) => found,
        Err(NoAnswer::Contradicted(fault)) => return Err(fault.to_string()),
        Err(_) => return Ok(all),
    };
    if let Some(reversed) = &found.reversed {
        all.insert(
            "measure".into(),
            match &reversed.measure {
                Measure::None { .. } => word("none"),
                Measure::Local { .. } => word("some"),
                Measure::Open(_) => Said::Open,
            },
        );
        let linear = reversed.integrals.first().and_then(|found| found.as_ref().ok()).filter(|found| found.settled);
        all.insert("linear".into(), linear.map_or(Said::Open, |found| word(found.count)));
    }
    for (name, held) in found.invariants.iter().flatten() {
        all.insert(format!("`{name}`"), word(if *held { "constant" } else { "not constant" }));
    }
    Ok(all)
}
