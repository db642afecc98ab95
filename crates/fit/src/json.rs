//! Answers as JSON, printed by the command and read by Python. Infinite numbers are null.

use scene::Scene;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use crate::design::Chosen;
use crate::{Aim, Best, Column, Design, Film, Fit, FitError, Identifiability, Point, Row, Verdict, significance};

impl Verdict {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Verdict::Supported => "supported".into(),
            Verdict::Excluded { sigmas } => format!("excluded at {}", significance(*sigmas)),
            Verdict::Unsettled { sigmas } => {
                let sigmas = significance(*sigmas);
                format!("search not settled: excluded at {sigmas}, if the least χ² that was found is the least")
            }
            Verdict::Explained { with: None, from } => format!("these films cannot tell it from {}", from.join(", ")),
            Verdict::Explained { with: Some(with), from } => {
                format!("these films cannot tell it, with {with}, from {}; without, it is excluded", from.join(", "))
            }
            Verdict::CannotTell { from, needs } => {
                let each = from.iter().zip(needs).map(|(label, needs)| match needs {
                    Some(longer) => format!("{label} (if that is right, a film {longer} times as long can)"),
                    None => format!("{label} (no film up to 8 times as long was found that can)"),
                });
                format!("these films cannot tell it from {}", each.collect::<Vec<_>>().join(", "))
            }
            Verdict::None => "no verdict".into(),
            Verdict::NotFitted(error) => format!("not fitted: {error}"),
        }
    }
}

/// Unknown numbers and formulations from films: `deltaq fit --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "fit/2")]
pub struct Fitted<'a> {
    scene: &'a str,
    films: Vec<Fitting<'a>>,
    formulations: Vec<Formulation<'a>>,
}

#[derive(Serialize, JsonSchema)]
struct Fitting<'a> {
    file: &'a str,
    samples: usize,
    /// Cells that are not empty.
    numbers: usize,
    columns: &'a [Column],
}

#[derive(Serialize, JsonSchema)]
struct Formulation<'a> {
    formulation: &'static str,
    label: &'a str,
    verdict: Answer,
    words: String,
    /// Formulations that these films cannot tell it from.
    from: &'a [String],
    /// How many times as long a film excludes it, if each of these is right; null where none up to 8 times
    /// does.
    needs: &'a [Option<f64>],
    /// By how much it is excluded, or would be; null otherwise.
    sigmas: Option<f64>,
    /// What else has to be known of the verdict.
    notes: &'a [String],
    /// Whether films of these columns can show the unknowns at all; null where that could not be asked.
    shown: Option<Shown<'a>>,
    /// Null where it could not be fitted.
    fit: Option<&'a Fit>,
}

/// What films say of a formulation.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Answer {
    /// Nothing objects to it, and these films exclude every other one.
    Supported,
    /// These films exclude it.
    Excluded,
    /// They would, if the least chi squared that was found is the least.
    NotSettled,
    /// They cannot tell it from others.
    CannotTell,
    /// No verdict.
    None,
    /// It could not be fitted.
    NotFitted,
}

#[derive(Serialize, JsonSchema)]
struct Shown<'a> {
    answer: IsShown,
    /// The unknowns of each combination that no film shows.
    hidden: &'a [Vec<String>],
    /// Highest derivative that was looked at, where something is hidden.
    order: Option<usize>,
    words: String,
}

#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum IsShown {
    /// At almost all unknowns.
    Proved,
    /// Some are not, by ranks in two finite fields.
    Hidden,
    /// The words have the reason.
    Open,
}

impl<'a> Fitted<'a> {
    /// Of films and formulations.
    pub fn of(scene: &'a Scene, films: &'a [Film], rows: &'a [Row]) -> Self {
        let film = |f: &'a Film| Fitting { file: &f.name, samples: f.t.len(), numbers: f.count(), columns: &f.columns };
        Fitted {
            scene: &scene.name,
            films: films.iter().map(film).collect(),
            formulations: rows.iter().map(Formulation::of).collect(),
        }
    }
}

impl<'a> Formulation<'a> {
    fn of(row: &'a Row) -> Self {
        let (mut from, mut needs, mut sigmas): (&[_], &[_], _) = (&[], &[], None);
        let verdict = match &row.verdict {
            Verdict::Supported => Answer::Supported,
            Verdict::Excluded { sigmas: by } => {
                sigmas = Some(*by);
                Answer::Excluded
            }
            Verdict::Unsettled { sigmas: by } => {
                sigmas = Some(*by);
                Answer::NotSettled
            }
            Verdict::CannotTell { from: others, needs: longer } => {
                (from, needs) = (others, longer);
                Answer::CannotTell
            }
            Verdict::Explained { from: others, .. } => {
                from = others;
                Answer::CannotTell
            }
            Verdict::None => Answer::None,
            Verdict::NotFitted(_) => Answer::NotFitted,
        };
        let shown = |shown: &'a Identifiability| {
            let (answer, hidden, order): (_, &[_], _) = match shown {
                Identifiability::Proved { .. } => (IsShown::Proved, &[], None),
                Identifiability::Hidden { combinations, order } => (IsShown::Hidden, combinations, Some(*order)),
                Identifiability::Open(_) => (IsShown::Open, &[], None),
            };
            Shown { answer, hidden, order, words: shown.words() }
        };
        Formulation {
            formulation: row.choice.formulation.name,
            label: &row.choice.label,
            verdict,
            words: row.verdict.words(),
            from,
            needs,
            sigmas,
            notes: &row.notes,
            shown: row.shown.as_ref().map(shown),
            fit: row.fit.as_ref().ok(),
        }
    }
}

/// The film that would show most: `deltaq design --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "design/2")]
pub struct Designed<'a> {
    scene: &'a str,
    /// How many films of this kind.
    films: usize,
    /// Of each film.
    samples: usize,
    columns: &'a [Column],
    /// The formulation that is right, and the one to be told from it; null beside estimate.
    tell: Option<Vec<&'a str>>,
    /// The number whose standard error is to be small; null beside tell.
    estimate: Option<&'a str>,
    /// What is chosen, in the order of at.
    chosen: &'a [Chosen],
    #[serde(flatten)]
    best: &'a Best,
}

impl<'a> Designed<'a> {
    /// Of films, and what a search for the best of them found.
    pub fn of(scene: &'a Scene, films: &'a [Film], design: &'a Design, best: &'a Best) -> Self {
        let (tell, estimate) = match design.aim() {
            Aim::Tell(..) => (Some(design.labels()), None),
            Aim::Estimate(name) => (None, Some(&name[..])),
        };
        Designed {
            scene: &scene.name,
            films: films.len(),
            samples: films[0].t.len(),
            columns: &films[0].columns,
            tell,
            estimate,
            chosen: design.chosen(),
            best,
        }
    }
}

/// A bound, or an end of an interval of 95 %; null where there is none.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Ends {
    low: Option<f64>,
    high: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct Number {
    name: String,
    value: f64,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ByStarts {
    starts: usize,
    value: Option<f64>,
}

pub(crate) fn ends<S: Serializer>(ends: &[f64; 2], to: S) -> Result<S::Ok, S::Error> {
    let [low, high] = ends.map(Some);
    Ends { low, high }.serialize(to)
}

pub(crate) fn numbers<S: Serializer>(numbers: &[(String, f64)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(numbers.iter().map(|(name, value)| Number { name: name.clone(), value: *value }))
}

pub(crate) fn by_starts<S: Serializer>(values: &[(usize, f64)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(values.iter().map(|&(starts, value)| ByStarts { starts, value: Some(value) }))
}

pub(crate) fn found<S: Serializer>(point: &Result<Point, FitError>, to: S) -> Result<S::Ok, S::Error> {
    point.as_ref().ok().serialize(to)
}
