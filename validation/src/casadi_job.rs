//! CasADi as a referee: another program derives the equations again, and another integrator solves them.
//!
//! The referee is `validation/casadi/`, Python: its own reader of the *text* of `L`, `f`, `Q`, removals,
//! CasADi to differentiate, only numbers from Rust. With `𝓛 = L + μ·f` and `G = L + P·B` it states
//!
//! ```text
//! Chetaev             d/dt L_v − L_q = Q + Aᵀ λ ,                     d/dt f = 0
//! vakonomic           d/dt 𝓛_v − 𝓛_q = Q ,                            d/dt f = 0
//! removed constraint  d²/dt² G_ü − d/dt (G_u̇ + Q_u̇) + G_u + Q_u = 0 ,  Ṗ = −G_w − Q_w ,   ẇ = B
//! ```
//!
//! and compares
//!
//! - rates of all states, and `λ`, at random states near the start (and off the constraint), as derived;
//! - motions, with those of SUNDIALS' CVODES and IDAS;
//! - motions, with curves of stationary discretized action: no equation of motion (vakonomic: `f = 0`
//!   imposed, ends fixed; removed: `u` fixed at both ends, `w(t₁)` free, so that `P(t₁) = 0` must come out);
//! - Chetaev's accelerations, with those of SymPy's `LagrangesMethod`;
//! - where asked ([`Question::with_decision`]): all `μ₀` with which the vakonomic motion is Chetaev's (none,
//!   or a dimension and the least-norm one), against power series in sixty digits, without CasADi.
//!
//! The virtual environment is made when needed: in cargo's target folder; if installed, in the user's cache.

use anyhow::{Context, Result};
use scene::Scene;
use serde::Deserialize;

use program::parallel;
use random::{Batch, Kind, draw_recipe};

mod environment;
mod forced;
mod python_environment;
mod questions;
mod table;

pub use forced::forced;
pub use python_environment::{NotRun, cache, target};
pub use questions::{Amount, Question};
pub use table::{headline, referee_table, verdict_words};

/// What the referee says about one comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Word {
    /// Within the tolerance.
    Agrees,
    /// Not within the tolerance, or not finite.
    Disagrees,
    /// The referee has no result; the note says why.
    Failed,
}

/// One comparison.
#[derive(Clone, Debug, Deserialize)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Who compared: `CasADi`, `CVODES`, `IDAS`, `transcription`, `SymPy`, `power series`.
    pub who: String,
    /// What was compared: the run and the quantity.
    pub what: String,
    /// At how many states or times.
    pub count: usize,
    /// Largest relative difference; `None` where it is not finite or there is none.
    pub largest: Option<f64>,
    /// Largest difference that counts as agreement.
    pub tolerance: f64,
    /// The verdict.
    pub verdict: Word,
    /// Remarks.
    pub note: String,
    /// Condition of the equilibrated instant's matrix at the largest difference, for right-hand sides.
    #[serde(default)]
    pub condition: Option<f64>,
}

/// The answer of the scripts.
#[derive(Deserialize)]
struct Answer {
    rows: Vec<Row>,
}

/// What became of the section.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// The comparisons, scene after scene.
    Ran(Vec<Row>),
    /// Why there are none.
    NotRun(NotRun),
}

impl Outcome {
    /// The comparisons; none where the referee did not run.
    pub fn rows(&self) -> &[Row] {
        match self {
            Outcome::Ran(rows) => rows,
            Outcome::NotRun(_) => &[],
        }
    }
}

/// Puts questions to the referee.
///
/// # Errors
/// Where its answer cannot be read. That it could not run is [`Outcome::NotRun`].
pub fn ask(questions: &[Question]) -> Result<Outcome> {
    let found = environment::interpreter().and_then(|python| {
        let job = serde_json::json!({ "scenes": questions }).to_string();
        environment::answer(&python, &job)
    });
    match found {
        Ok(text) => {
            let answer: Answer = serde_json::from_str(&text).context("the answer of the referee")?;
            Ok(Outcome::Ran(answer.rows))
        }
        Err(reason) => Ok(Outcome::NotRun(reason)),
    }
}

/// Whether the environment is there, or can be made: before work is done for a referee that cannot run.
///
/// # Errors
/// [`NotRun`].
pub fn prepare() -> std::result::Result<(), NotRun> {
    environment::interpreter().map(|_| ())
}

/// States and times for each formulation of a built-in scene in the main job.
pub const BUILT_IN: Amount = Amount { states: 1_000, times: 20 };
/// States for each formulation of a scene in which forces act.
pub const FORCED: usize = 200;
/// States and times for a random system.
pub const RANDOM: Amount = Amount { states: 40, times: 0 };
/// Random systems in the main job.
pub const RANDOM_SYSTEMS: usize = 50;
/// Of this batch; without constraints nearer than 1e-3, which the referee would have to solve as they stand.
const SEED: u64 = 1;
/// States that go to SymPy.
pub const SYMPY_STATES: usize = 20;

/// Scenes whose action is discretized: horizon and number of intervals.
const TRANSCRIBED: [(&str, f64, usize); 4] =
    [("sledge", 1.0, 12), ("particle", 2.0, 8), ("disc", 1.0, 12), ("ball-in-cone", 0.3, 20)];
/// Scenes for SymPy.
const SYMPY_SCENES: [&str; 4] = ["sledge", "disc", "particle", "appell-hamel"];

/// Everything about a built-in scene.
///
/// # Errors
/// Where there is no such scene, or a motion of ours cannot be read off.
pub fn built_in(name: &str, amount: Amount) -> Result<Question> {
    let (_, text) = scene::catalogue::SCENES.iter().find(|(known, _)| *known == name).context("no such scene")?;
    let scene = Scene::parse(name, text)?;
    let mut question = Question::new(&scene, &scene.without_bodies(text), amount)?;
    if SYMPY_SCENES.contains(&name) {
        question = question.with_lagranges_method(SYMPY_STATES);
    }
    if let Some((_, horizon, intervals)) = TRANSCRIBED.iter().find(|(scene, ..)| *scene == name) {
        question = question.with_transcription(&scene, *horizon, *intervals)?;
    }
    Ok(question)
}

/// The right-hand sides of a scene in which forces act, and its motions where the built-in scene's action is
/// discretized.
///
/// # Errors
/// Where the text is no scene, or a rate of ours cannot be evaluated.
pub fn pushed(name: &str, text: &str, states: usize) -> Result<Question> {
    let scene = Scene::parse(name, text)?;
    let question = Question::new(&scene, &scene.without_bodies(text), Amount { states, times: 0 })?;
    match TRANSCRIBED.iter().find(|(scene, ..)| name.strip_suffix(forced::SUFFIX) == Some(scene)) {
        // with forces the sledge comes to the end of a chart within its horizon
        Some((_, horizon, intervals)) => question.with_transcription(&scene, horizon / 2.0, *intervals),
        None => Ok(question),
    }
}

/// The right-hand sides of a random system.
///
/// # Errors
/// Where a rate of ours cannot be evaluated.
pub fn random(index: u64, amount: Amount) -> Result<Question> {
    let batch = Batch { seed: SEED, kinds: Kind::ALL.to_vec() };
    let scene = batch.scene(index);
    let text = scene.to_toml();
    Question::new(&scene, &text, amount)
}

/// The section of the main job: the named built-in scenes, and, where all of them are, those in which forces
/// act, and random systems.
///
/// # Errors
/// Where a motion of ours cannot be read off, or the answer of the referee cannot be read.
pub fn section(names: &[&str]) -> Result<Outcome> {
    if let Err(reason) = prepare() {
        return Ok(Outcome::NotRun(reason));
    }
    let forces = forced();
    let mut tasks: Vec<Task> = names.iter().map(|&name| Task::BuiltIn(name)).collect();
    if names.len() == scene::catalogue::SCENES.len() {
        let is_solved = |index: &u64| draw_recipe(SEED, *index, &Kind::ALL).drawn.closeness.is_none();
        tasks.extend(forces.iter().map(|(name, text)| Task::Forced(name, text)));
        tasks.extend((0..).filter(is_solved).take(RANDOM_SYSTEMS).map(Task::Random));
    }
    let questions = parallel::map(&tasks, |task| match task {
        Task::BuiltIn(name) => built_in(name, BUILT_IN).with_context(|| format!("scene `{name}`")),
        Task::Forced(name, text) => pushed(name, text, FORCED).with_context(|| format!("scene `{name}`")),
        Task::Random(index) => random(*index, RANDOM).with_context(|| format!("random system {index}")),
    });
    ask(&questions.into_iter().collect::<Result<Vec<_>>>()?)
}

enum Task<'a> {
    BuiltIn(&'a str),
    Forced(&'a str, &'a str),
    Random(u64),
}
