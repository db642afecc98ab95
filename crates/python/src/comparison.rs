//! All formulations of a system, pair by pair.

use comparison::{Extent, Fits, Gap, THRESHOLDS, Verdict};
use equations::Formulation;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::Scene;
use stubs::{answer, stubbed};

use crate::arrays::vector;
use crate::errors;
use crate::families::{Decided, Fit};
use crate::motion::{Asked, Motion, Sampled};
use crate::system::System;

#[answer("<deltaq.Growth {length:.3e} t^{exponent:.2}, exponent within {uncertainty:.0e}>")]
pub(crate) struct Growth;

#[answer]
pub(crate) struct LeadingTerm;

#[stubbed]
impl LeadingTerm {
    fn __repr__(&self) -> String {
        let proved = if self.proved { "proved" } else { "not proved" };
        format!("<deltaq.LeadingTerm {:.3e} t^{}, {proved}>", self.length, self.exponent)
    }
}

#[answer("<deltaq.Pair {first} - {second}: {verdict}, largest gap {largest_gap:.3e}>")]
pub(crate) struct Pair;

#[answer]
pub(crate) struct Run;

#[stubbed]
impl Run {
    fn __repr__(&self) -> String {
        format!("<deltaq.Run {}: {}>", self.label, self.error.as_deref().unwrap_or("a motion"))
    }
}

#[answer]
pub(crate) struct Comparison;

#[stubbed]
impl Comparison {
    fn pair(&self, py: Python<'_>, a: &str, b: &str) -> PyResult<Py<Pair>> {
        let (one, two) = (self.label(a)?, self.label(b)?);
        let is = |p: &Pair| (p.first == one && p.second == two) || (p.first == two && p.second == one);
        let found = self.pairs.iter().find(|p| is(p.get())).map(|p| p.clone_ref(py));
        found.ok_or_else(|| PyKeyError::new_err(format!("{one} and {two} were not compared")))
    }

    fn verdict(&self, py: Python<'_>, a: &str, b: &str) -> PyResult<String> {
        Ok(self.pair(py, a, b)?.get().verdict.clone())
    }

    fn __repr__(&self) -> String {
        format!("<deltaq.Comparison of {} runs, {} pairs>", self.runs.len(), self.pairs.len())
    }
}

impl Comparison {
    fn label(&self, name: &str) -> PyResult<String> {
        let runs = || self.runs.iter().map(Py::get);
        let found =
            runs().find(|r| r.label == name || r.title == name).or_else(|| runs().find(|r| r.formulation == name));
        let known = || runs().map(|r| r.label.as_str()).collect::<Vec<_>>().join(", ");
        found.map(|r| r.label.clone()).ok_or_else(|| errors::unknown(format!("no run `{name}`; there are {}", known())))
    }

    pub(crate) fn new(system: &Bound<'_, System>, compared: Compared) -> PyResult<Comparison> {
        let py = system.py();
        let Compared { scene, settings, integrability, runs, pairs, fits, decided, contradictions } = compared;
        let labels: Vec<String> = runs.iter().map(|r| identifier(&r.0)).collect();
        let names: Vec<&str> = scene.system.coordinates.iter().map(|c| c.name.as_str()).collect();
        let pair = |p: comparison::Pair| -> PyResult<Py<Pair>> {
            let (verdict, because) = words(&p.gap);
            let (tau, by_coordinate) = (PyDict::new(py), PyDict::new(py));
            for (threshold, time) in THRESHOLDS.iter().zip(p.gap.passes) {
                tau.set_item(threshold, time)?;
            }
            for (name, difference) in names.iter().zip(&p.gap.largest_by_coordinate) {
                by_coordinate.set_item(name, difference)?;
            }
            let growth = p.growth.map(|g| -> PyResult<Py<Growth>> {
                let (exponent, uncertainty, length) = (g.exponent, g.uncertainty, g.length);
                Py::new(py, Growth { exponent, uncertainty, length, coefficient: vector(py, g.coefficient)? })
            });
            let predicted = p.predicted.map(|term| -> PyResult<Py<LeadingTerm>> {
                let (exponent, length, proved) = (term.exponent as usize, term.length, term.proved);
                Py::new(py, LeadingTerm { exponent, length, proved, coefficient: vector(py, term.coefficient)? })
            });
            let samples = |pick: fn(&comparison::GapPoint) -> f64| vector(py, p.gap.points.iter().map(pick).collect());
            let pair = Pair {
                first: labels[p.first].clone(),
                second: labels[p.second].clone(),
                verdict: verdict.into(),
                because,
                tau: tau.unbind(),
                largest_gap: p.gap.largest,
                largest_by_coordinate: by_coordinate.unbind(),
                certain_from: p.gap.certain_from,
                error_estimates: p.gap.estimates.into(),
                end: p.gap.end,
                times: samples(|p| p.t)?,
                gap: samples(|p| p.gap)?,
                limit: samples(|p| p.limit)?,
                growth: growth.transpose()?,
                predicted: predicted.transpose()?,
            };
            Py::new(py, pair)
        };
        let fit = |f: comparison::Fit| -> PyResult<Py<Fit>> {
            let constants = f.fitted.as_ref().map(|m| -> PyResult<Py<PyDict>> {
                let dict = PyDict::new(py);
                m.constants.iter().try_for_each(|(name, value)| dict.set_item(name, value))?;
                Ok(dict.unbind())
            });
            let fit = Fit {
                run: labels[f.run].clone(),
                target: labels[f.target].clone(),
                constants: constants.transpose()?,
                verdict: f.fitted.as_ref().map(|m| words(&m.gap).0.into()),
                largest_gap: f.fitted.as_ref().map(|m| m.gap.largest),
                largest_gap_by_half: f.fitted.as_ref().map(|m| m.by_half),
                settled: f.fitted.as_ref().map(comparison::FittedMotion::is_settled),
                starts: f.fitted.as_ref().map(|m| m.starts),
                by_identity: f.by_identity,
            };
            Py::new(py, fit)
        };
        let run = |(choice, outcome): (motion::Choice, Result<Sampled, motion::SolveError>)| {
            let (motion, error) = match outcome {
                Ok(sampled) => {
                    let asked = Asked { choice: &choice, form: "auto", times: None, settings: &settings };
                    (Some(Py::new(py, Motion::new(system, sampled, &asked)?)?), None)
                }
                Err(error) => (None, Some(error.to_string())),
            };
            let (label, formulation) = (identifier(&choice), choice.formulation.name.into());
            let removal = choice.removal.map(|r| r.name);
            Py::new(py, Run { label, title: choice.label, formulation, removal, motion, error })
        };
        let membership = |d: comparison::Decided| {
            Py::new(py, Decided::new(py, labels[d.family].clone(), labels[d.curve].clone(), d.outcome)?)
        };
        Ok(Comparison {
            system: system.clone().unbind(),
            integrability,
            contradictions,
            decided: decided.into_iter().map(membership).collect::<PyResult<_>>()?,
            runs: runs.into_iter().map(run).collect::<PyResult<_>>()?,
            pairs: pairs.into_iter().map(pair).collect::<PyResult<_>>()?,
            fits: fits.into_iter().map(fit).collect::<PyResult<_>>()?,
        })
    }
}

/// What a run is called.
fn identifier(choice: &motion::Choice) -> String {
    let removal = choice.removal.as_ref().map_or(String::new(), |removal| format!(":{}", removal.name));
    choice.formulation.name.to_owned() + &removal
}

fn words(gap: &Gap) -> (&'static str, Option<String>) {
    let because = match &gap.verdict {
        Verdict::Undecided { because } => Some(because.clone()),
        Verdict::Same | Verdict::Different => None,
    };
    (gap.verdict.word(), because)
}

/// A comparison, with its motions read off.
pub(crate) struct Compared {
    scene: Scene,
    settings: motion::Settings,
    integrability: String,
    contradictions: Vec<String>,
    runs: Vec<(motion::Choice, Result<Sampled, motion::SolveError>)>,
    pairs: Vec<comparison::Pair>,
    fits: Vec<comparison::Fit>,
    decided: Vec<comparison::Decided>,
}

/// What is asked of a comparison.
pub(crate) struct Wanted {
    /// Formulations, all where none are named.
    pub(crate) only: Option<Vec<&'static Formulation>>,
    pub(crate) extent: Extent,
    /// Whether families are decided on.
    pub(crate) decision: bool,
    pub(crate) fits: Fits,
}

/// Compares formulations of `scene`.
pub(crate) fn compare(
    scene: Scene,
    wanted: &Wanted,
    settings: &motion::Settings,
) -> Result<Compared, motion::SolveError> {
    let is_wanted = |own: &Formulation| wanted.only.as_ref().is_none_or(|only| only.contains(&own));
    let choices = motion::choices_among(&scene, is_wanted);
    let mut compared = comparison::Comparison::new(scene, wanted.extent, settings)?;
    for choice in choices {
        compared.solve(choice, settings)?;
    }
    while wanted.decision && compared.decide_next().is_some() {}
    compared.fit(wanted.fits, settings)?;
    let contradictions = compared.contradictions().iter().map(ToString::to_string).collect();
    let comparison::Comparison { scene, integrability, runs, pairs, fits, decided, .. } = compared;
    let read = |motion| Sampled::new(motion, motion::setting(&scene), None);
    let runs = runs.into_iter().map(|run| (run.choice, run.outcome.and_then(read))).collect();
    let integrability = integrability.to_string();
    let settings = settings.clone();
    Ok(Compared { integrability, contradictions, runs, pairs, fits, decided, scene, settings })
}
