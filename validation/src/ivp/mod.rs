//! Mechanical problems of the Test Set for IVP Solvers: the ends that are printed, those of a referee in long
//! double (`validation/ivp/referee.py`, from the printed equations), and ours, from a Lagrangian.

mod fekete;

use std::collections::BTreeMap;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use integrate::Method;
use motion::{CHETAEV, Settings, choices_among, error_estimate, setting, solve_choice};
use scene::Scene;
use serde::{Deserialize, Serialize};

/// Tolerances that are tried; the second run of each motion, which is kept, has a hundredth.
pub const TOLERANCES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// Methods that are tried; `None` is the one that the program chooses.
pub const METHODS: [Option<Method>; 3] = [None, Some(Method::Dop853), Some(Method::Radau5)];

/// Radau's method of order 5 takes too many steps for tighter tolerances, and a factorization a step: it is
/// left out there, and on larger systems.
const RADAU: (f64, usize) = (1e-8, 10);

/// A solve that takes longer is not repeated; in seconds.
const LONG: f64 = 0.2;

/// Values at the end that somebody printed.
#[derive(Clone, Debug, Deserialize)]
pub struct Printed {
    /// Who computed them, and how.
    pub by: String,
    /// Coordinates, then multipliers as far as they are printed.
    pub values: Vec<f64>,
}

/// A problem of the test set.
#[derive(Clone, Debug, Deserialize)]
pub struct Problem {
    /// Name of its scene.
    pub name: String,
    /// Its name among the ends of the referee.
    end: String,
    /// What it is.
    pub said: String,
    /// The sign of our multipliers in the equations of the test set.
    multipliers: f64,
    /// What other programs report about it, from their own pages.
    pub others: String,
    /// Ends that are printed.
    pub printed: Vec<Printed>,
    /// The end of the referee: coordinates, then multipliers.
    #[serde(skip)]
    pub truth: Vec<f64>,
    /// How far the referee's run with half as many steps is from it.
    #[serde(skip)]
    pub gap: f64,
}

#[derive(Deserialize)]
struct End {
    gap: f64,
    end: Vec<f64>,
}

#[derive(Deserialize)]
struct Problems {
    problem: Vec<Problem>,
}

/// All problems.
///
/// # Errors
/// Where a table of `validation/ivp` is not as it should be.
pub fn problems() -> Result<Vec<Problem>> {
    let Problems { problem: mut problems } =
        toml::from_str(include_str!("../../ivp/problems.toml")).context("problems.toml")?;
    let mut ends: BTreeMap<String, End> = toml::from_str(include_str!("../../ivp/ends.toml")).context("ends.toml")?;
    for problem in &mut problems {
        let End { gap, end } = ends.remove(&problem.end).with_context(|| format!("no end of {}", problem.end))?;
        (problem.gap, problem.truth) = (gap, end);
    }
    Ok(problems)
}

/// Largest errors at the end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Of coordinates.
    pub coordinates: f64,
    /// Of multipliers; none where there are none, or none are printed.
    pub multipliers: Option<f64>,
}

/// A solve.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// Tolerance of the first run.
    pub tolerance: f64,
    /// What was asked for: a method, or none.
    pub method: Option<&'static str>,
    /// Seconds from the scene to the answer: derivation, compilation and two runs; the least of three.
    pub seconds: f64,
    /// Against the referee, or why there is no end.
    pub errors: Result<Errors, String>,
    /// The estimate for coordinates that came with the answer.
    pub estimate: f64,
}

impl Problem {
    /// The scene.
    ///
    /// # Errors
    /// Where it has a fault.
    pub fn scene(&self) -> Result<Scene> {
        let text = match self.name.as_str() {
            "car-axis" => include_str!("../../ivp/car-axis.toml").to_owned(),
            "andrews" => include_str!("../../ivp/andrews.toml").to_owned(),
            "pleiades" => include_str!("../../ivp/pleiades.toml").to_owned(),
            _ => fekete::text(),
        };
        Ok(Scene::parse(&self.name, &text)?)
    }

    /// How far values at the end are from the referee's.
    pub fn errors(&self, values: &[f64]) -> Errors {
        let coordinates = self.coordinates().min(values.len());
        let worst = |range: std::ops::Range<usize>| {
            let gaps = values[range.clone()].iter().zip(&self.truth[range]).map(|(x, truth)| (x - truth).abs());
            gaps.fold(0.0, f64::max)
        };
        let multipliers = (values.len() > coordinates).then(|| worst(coordinates..values.len()));
        Errors { coordinates: worst(0..coordinates), multipliers }
    }

    /// Whether a setting is tried.
    pub fn is_tried(&self, tolerance: f64, method: Option<Method>) -> bool {
        method != Some(Method::Radau5) || (tolerance >= RADAU.0 && self.coordinates() <= RADAU.1)
    }

    fn coordinates(&self) -> usize {
        match self.name.as_str() {
            "car-axis" => 4,
            "andrews" => 7,
            "fekete" => 60,
            _ => 14,
        }
    }

    /// One solve, up to three times.
    ///
    /// # Errors
    /// Where the scene has a fault.
    pub fn measure(&self, tolerance: f64, method: Option<Method>) -> Result<Point> {
        let scene = self.scene()?;
        let choice = choices_among(&scene, |formulation| formulation.name == CHETAEV.name);
        ensure!(choice.len() == 1, "{}: {} choices", self.name, choice.len());
        let settings = Settings { tolerance, method, ..Settings::default() };
        let (mut seconds, mut found) = (f64::INFINITY, Err("it was not tried".to_owned()));
        for _ in 0..3 {
            let clock = Instant::now();
            found = self.solved(&scene, &choice[0], &settings);
            seconds = seconds.min(clock.elapsed().as_secs_f64());
            if seconds > LONG {
                break;
            }
        }
        let (values, estimate) = match found {
            Ok((values, estimate)) => (Ok(values), estimate),
            Err(reason) => (Err(reason), f64::NAN),
        };
        let errors = values.map(|values| self.errors(&values));
        Ok(Point { tolerance, method: method.map(Method::name), seconds, errors, estimate })
    }

    /// Coordinates and multipliers at the end, as the test set signs them, and the largest error estimate.
    fn solved(&self, scene: &Scene, choice: &motion::Choice, settings: &Settings) -> Result<(Vec<f64>, f64), String> {
        let told = |error: motion::SolveError| error.to_string();
        let mut motion = solve_choice(scene, choice, settings).map_err(told)?;
        let end = scene.start.t + scene.duration;
        if !motion.is_complete() {
            return Err(format!("it ends at t = {}", motion.end()));
        }
        let outputs = motion.at(end).map_err(told)?;
        let estimate = error_estimate(&mut motion, setting(scene)).map_err(told)?;
        let estimate = estimate.coordinates.iter().copied().fold(0.0, f64::max);
        let multipliers = outputs.multipliers.iter().map(|x| x * self.multipliers);
        Ok((outputs.coordinates.iter().copied().chain(multipliers).collect(), estimate))
    }
}
