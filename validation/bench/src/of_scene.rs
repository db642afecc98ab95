//! Measurements on one scene.

mod kept;
mod measure;
mod truth;
mod usual;

pub use kept::{KeptMotion, KeptReferences};
pub use measure::{Measured, Point, Series};
pub use truth::Truth;
pub use usual::Usual;

use std::time::Instant;

use anyhow::{Context, Result};
use integrate::{Method, Work};
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Choice, REDUCED_CHETAEV, REDUCED_VAKONOMIC, Settings, VAKONOMIC, VAKONOMIC_COSTATE, choices, derive_at,
    forms, setting,
};
use program::parallel;
use scene::Scene;

/// Times at which errors are taken, equidistant, the last at the end.
pub const SAMPLES: usize = 20;

/// Errors for which the fastest setting is named.
pub const TARGETS: [f64; 4] = [1e-6, 1e-9, 1e-10, 1e-11];

/// The extent of the measurements.
#[derive(Clone, Debug)]
pub struct Effort {
    /// The methods that are measured.
    pub methods: Vec<Method>,
    /// Tolerances are powers of ten: all from 1e-3 on for 1, every third one for 3.
    pub every: usize,
    /// Runs of one setting are repeated until they took this many seconds together, except those that take
    /// over four times as long as a run of another method with no larger error.
    pub seconds: f64,
    /// And at least this often.
    pub repeats: usize,
    /// A run that takes more steps than this counts as failed.
    pub max_steps: usize,
    /// A method's tolerances are not tightened further once a run took longer than this, in seconds; Taylor
    /// series and DOP853, which reach the smallest errors, have four times as long.
    pub patience: f64,
}

impl Effort {
    /// For the main job, which has other things to do as well.
    pub fn brief(methods: &[Method], every: usize) -> Effort {
        let methods = methods.to_vec();
        Effort { methods, every, seconds: 0.0015, repeats: 2, max_steps: 50_000, patience: 0.008 }
    }
}

impl Default for Effort {
    fn default() -> Self {
        let methods = Method::ALL.to_vec();
        Effort { methods, every: 1, seconds: 0.02, repeats: 3, max_steps: 200_000, patience: 0.5 }
    }
}

/// The measurements on one scene.
#[derive(Clone, Debug)]
pub struct Bench {
    /// Name and title of the scene.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// Seconds from the text of the scene to the system.
    pub parse: f64,
    /// One per formulation, in the order of the table; then one per further form without guards.
    pub entries: Vec<Entry>,
}

/// The measurements on one formulation of a scene.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What the reader sees.
    pub label: String,
    /// Name of the formulation.
    pub formulation: &'static str,
    /// What it has in common with other forms of its formulation.
    pub motion: String,
    /// The measurements, or why there are none.
    pub outcome: Result<Measurements, String>,
}

/// Measurements against a reference.
#[derive(Clone, Debug)]
pub struct Measurements {
    /// Seconds from the system to equations, and from those to tapes.
    pub derive: f64,
    /// Seconds from equations to tapes.
    pub compile: f64,
    /// Number of states.
    pub states: usize,
    /// Start and end of the measured runs.
    pub span: (f64, f64),
    /// Whether the motion ends at a singularity, and the runs therefore a little before it.
    pub shortened: bool,
    /// Error of the reference.
    pub reference_error: f64,
    /// How the reference was computed.
    pub reference: String,
    /// One per method.
    pub series: Vec<Series>,
    /// The run with default options apart from the tolerance, or why there is none.
    pub usual: Result<Usual, String>,
}

impl Bench {
    /// The fastest setting of all forms of a motion whose error is at most `target`.
    pub fn fastest(&self, motion: &str, target: f64) -> Option<Fastest> {
        let forms = self.entries.iter().filter(|entry| entry.motion == motion);
        let each = forms.filter_map(|entry| entry.outcome.as_ref().ok()?.fastest(target, None));
        each.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}

/// A setting that reaches an error.
#[derive(Clone, Copy, Debug)]
pub struct Fastest {
    /// The method.
    pub method: Method,
    /// Its tolerance.
    pub tolerance: f64,
    /// Seconds, least of several runs.
    pub seconds: f64,
    /// Error reached.
    pub error: f64,
    /// What it cost.
    pub work: Work,
}

impl Measurements {
    /// The fastest setting of all methods, or of one, whose error is at most `target`.
    pub fn fastest(&self, target: f64, method: Option<Method>) -> Option<Fastest> {
        let settings = self.series.iter().filter(|s| method.is_none_or(|m| m == s.method)).flat_map(|series| {
            series.points.iter().filter_map(|point| {
                let m = point.outcome.as_ref().ok()?;
                let Measured { seconds, error, work } = *m;
                (error <= target).then_some(Fastest {
                    method: series.method,
                    tolerance: point.tolerance,
                    seconds,
                    error,
                    work,
                })
            })
        });
        settings.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}

/// A scene with a reference for each of its motions.
pub struct Prepared {
    name: String,
    truths: Vec<(String, Result<Truth, String>)>,
}

/// Every formulation of a scene, and forms without guards: guards stop a run where quasi-velocities break.
fn entries(scene: &Scene) -> Vec<Choice> {
    let regular = |form: &Choice| derive_at(&scene.system, &scene.start, form).is_ok_and(|e| e.guards.is_empty());
    choices(scene).into_iter().chain(forms(scene).into_iter().filter(regular)).collect()
}

/// The motion of a choice: forms of one formulation share it.
fn motion(choice: &Choice) -> String {
    match choice.formulation {
        form if form == REDUCED_CHETAEV => CHETAEV.name.into(),
        form if [VAKONOMIC_COSTATE, REDUCED_VAKONOMIC].contains(&form) => VAKONOMIC.name.into(),
        own if choice.removal.is_none() => own.name.into(),
        _ => choice.label.clone(),
    }
}

/// References of `name`, a built-in scene or a scene file's path, except those that are `kept`: not timed,
/// several may run at once.
///
/// # Errors
/// Where the scene cannot be read.
pub fn prepare(name: &str, kept: &KeptReferences) -> Result<Prepared> {
    let scene = scene::catalogue::find(name, &[])?;
    let truth = |choice: &Choice| -> Result<Truth> {
        let equations = derive_at(&scene.system, &scene.start, choice)?;
        let ready = motion::prepare(setting(&scene), equations, &choice.constants, &Settings::default())?;
        Truth::new(&scene, &ready, SAMPLES, kept).context("no reference")
    };
    let mut truths: Vec<(String, Result<Truth, String>)> = Vec::new();
    for choice in choices(&scene) {
        let motion = motion(&choice);
        if truths.iter().all(|(known, _)| *known != motion) {
            truths.push((motion, truth(&choice).map_err(|error| format!("{error:#}"))));
        }
    }
    Ok(Prepared { name: name.into(), truths })
}

/// Measures every formulation and further form, by every method; nothing else should run meanwhile.
///
/// # Errors
/// Where the scene cannot be read. A formulation that cannot be measured is an [`Entry`] that says why.
pub fn measure(prepared: Prepared, effort: &Effort, tell: impl Fn(&str)) -> Result<Bench> {
    let clock = Instant::now();
    let scene = scene::catalogue::find(&prepared.name, &[])?;
    let parse = clock.elapsed().as_secs_f64();
    let mut truths = prepared.truths;
    let entries = entries(&scene).into_iter().map(|choice| {
        tell(&format!("{}, {}", scene.name, choice.label));
        let motion = motion(&choice);
        let outcome = match truths.iter_mut().find(|(known, _)| *known == motion) {
            None => Err("no reference".into()),
            Some((_, Err(reason))) => Err(reason.clone()),
            Some((_, Ok(truth))) => measurements(&scene, &choice, truth, effort).map_err(|error| format!("{error:#}")),
        };
        Entry { label: choice.label, formulation: choice.formulation.name, motion, outcome }
    });
    Ok(Bench { entries: entries.collect(), scene: scene.name.clone(), title: scene.title.clone(), parse })
}

fn measurements(scene: &Scene, choice: &Choice, truth: &mut Truth, effort: &Effort) -> Result<Measurements> {
    let clock = Instant::now();
    let equations = derive_at(&scene.system, &scene.start, choice)?;
    let derive = clock.elapsed().as_secs_f64();
    let settings = Settings { method: Some(Method::Taylor), ..Settings::default() };
    let clock = Instant::now();
    let mut ready = motion::prepare(setting(scene), equations, &choice.constants, &settings)?;
    let compile = clock.elapsed().as_secs_f64();
    let constants = ConstantsRule::Given(ready.constants.clone());
    let usual = Usual::new(setting(scene), &Choice { constants, ..choice.clone() }, truth, effort);
    let mut series: Vec<Series> = Vec::new();
    for method in effort.methods.iter().copied() {
        series.push(Series::new(method, &mut ready, truth, effort, &series));
    }
    Ok(Measurements {
        derive,
        compile,
        states: ready.start.len(),
        span: (ready.t, truth.end()),
        shortened: truth.shortened,
        reference_error: truth.error,
        reference: truth.origin.clone(),
        series,
        usual,
    })
}

/// References of these scenes, over all processors; those that are `kept` are not computed again.
pub fn references(names: &[&str], kept: &KeptReferences, quiet: bool) -> Result<Vec<Prepared>> {
    parallel::try_map(names, quiet, |_| "references".into(), |name| prepare(name, kept))
}

/// Measurements, one after the other.
pub fn bench_all(prepared: Vec<Prepared>, effort: &Effort, quiet: bool) -> Result<Vec<Bench>> {
    let bar = parallel::progress(prepared.len(), quiet);
    let benches = prepared.into_iter().map(|prepared| {
        let measured = measure(prepared, effort, |words| bar.set_message(words.to_string()));
        bar.inc(1);
        measured
    });
    let benches = benches.collect();
    bar.finish_and_clear();
    benches
}
