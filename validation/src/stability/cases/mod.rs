//! The cases.

mod blow_up;
mod cone;
mod cylinders;
mod dependent;
mod disc;
mod integral;
mod mass;
mod pulse;
mod rattleback;
mod sledge;
mod snakeboard;
mod units;
mod viscous;
mod wall;

use equations::Formulation;
use std::collections::HashMap;
use std::sync::LazyLock;

use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Choice, REMOVED_CONSTRAINT, Settings, Steps, VAKONOMIC, VAKONOMIC_COSTATE, choices, derive_at,
    solve_by_steps,
};
use scene::{Scene, SceneError};

use super::question::{Case, MAX_STEPS, Question, Subject, Texts};
use super::reference::Reference;

/// m/s², as in the scenes.
const GRAVITY: f64 = 9.81;

/// All cases, in the order of the page.
pub static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let texts = toml::from_str::<HashMap<String, Texts>>(include_str!("cases.toml"));
    let mut texts = texts.unwrap_or_else(|error| panic!("cases.toml: {error}"));
    let case = |(name, questions)| {
        let texts = texts.remove(name).unwrap_or_else(|| panic!("cases.toml has nothing on {name}"));
        Case { name, texts, questions }
    };
    QUESTIONS.into_iter().map(case).collect()
});

/// A name in the file of cases, and what makes the questions.
type Asked = (&'static str, fn() -> Vec<Question>);

/// Names and questions. A point was left out between two others with the same words for every method and
/// formulation (November 2026: 46 of 243).
const QUESTIONS: [Asked; 33] = [
    ("viscous", || powers_of(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 10]).flat_map(viscous::questions).collect()),
    ("added-mass", || powers_of(&[0, 1, 3, 4, 5, 6, 7, 8, 10, 11, 12]).flat_map(mass::added).collect()),
    ("mass-ratio", || powers(-8, 8, 4).flat_map(mass::ratio).collect()),
    ("sledge-k", || powers_of(&[-4, -2, -1, 0, 1, 3, 4]).flat_map(|k| sledge::questions(k, k, 10.0)).collect()),
    ("sledge-long", || powers(0, 3, 1).flat_map(|end| sledge::questions(end, sledge::RADIUS, end)).collect()),
    ("cone-apex", || powers_of(&[-8, -6, -5, -4, -3, -2, -1, 0]).flat_map(cone::apex).collect()),
    ("cone-chart", || powers_of(&[-8, -6, -5, -4, -3, -2, -1, 0]).flat_map(cone::chart).collect()),
    ("cylinders-turn", || {
        powers_of(&[-8, -4, -2, 0]).flat_map(|rate| cylinders::questions(rate, "theta'", rate)).collect()
    }),
    ("cylinders-heading", || powers(-2, 0, 1).flat_map(|at| cylinders::questions(at, "theta", at)).collect()),
    ("cylinders-angle", || {
        powers_of(&[-8, -6, -2, 0]).flat_map(|gap| cylinders::questions(gap, "theta", 0.9 + gap)).collect()
    }),
    ("rattleback", || [1.0, 5.0, 10.0, 20.0].into_iter().flat_map(rattleback::questions).collect()),
    ("snakeboard", || [0.5, 1.25, 1.4, 2.0].into_iter().flat_map(snakeboard::questions).collect()),
    // 10⁻² … 10⁻¹⁴, nearly
    ("dependent", || [-7, -13, -20, -23, -26, -30, -33, -40, -46].into_iter().flat_map(dependent::questions).collect()),
    ("unit-of-length", || {
        powers_of(&[-12, -4, 0, 8, 12]).flat_map(|unit| units::questions(unit, [1, 0, -2, -1])).collect()
    }),
    ("unit-of-time", || {
        powers_of(&[-12, -4, 0, 4, 12]).flat_map(|unit| units::questions(unit, [0, 1, 2, 1])).collect()
    }),
    ("unit-of-mass", || {
        powers_of(&[-12, -4, 0, 4, 12]).flat_map(|unit| units::questions(unit, [0, 0, -1, 0])).collect()
    }),
    ("blow-up", || powers(-2, 2, 2).flat_map(|y| blow_up::questions(y, 0.0, &FORMULATIONS)).collect()),
    ("blow-up-across", || powers(-2, 2, 1).flat_map(|y| blow_up::questions(y, 1.0, &[CHETAEV])).collect()),
    ("pulse-at-rest", || half_powers(-6).flat_map(|width| pulse::forces(width, [0.0, 0.0])).collect()),
    ("pulse-rolling", || {
        [-6, -4, -2, 0].into_iter().map(half_power).flat_map(|width| pulse::forces(width, [0.5, 0.2])).collect()
    }),
    ("potential-at-rest", || half_powers(-6).flat_map(|width| pulse::potentials(width, 0.0)).collect()),
    ("potential-rolling", || half_powers(-6).flat_map(|width| pulse::potentials(width, 0.3)).collect()),
    ("wall-tanh", || powers_of(&[-8, -6, -4, -3, -2, -1, 0]).flat_map(wall::tanh).collect()),
    ("wall-exp", || powers_of(&[-8, -6, -4, -3, -2, -1, 0]).flat_map(wall::exponential).collect()),
    ("wall-at-rest", || powers(-8, 0, 2).flat_map(wall::on_the_wall).collect()),
    ("step", || powers_of(&[-7, -5, -3, -1, 0]).flat_map(wall::step).collect()),
    ("hill", || powers_of(&[-6, -4, -3, -2, -1, 0]).flat_map(wall::hill).collect()),
    ("well", || powers(-6, 0, 2).flat_map(wall::well).collect()),
    ("valley", || powers(-8, 0, 2).flat_map(wall::valley).collect()),
    ("kink", || powers(-8, 0, 2).flat_map(wall::kinks).collect()),
    ("equal-steps", || [0.01, 0.1, 1.0, 2.0, 5.0, 10.0, 20.0, 1000.0].into_iter().flat_map(sledge::steps).collect()),
    ("equal-steps-pulse", || half_powers(-5).flat_map(pulse::steps).collect()),
    ("friction", || powers_of(&[-10, -9, -8, -7, -6, -5, -4, -3, -2, 0]).map(wall::friction).collect()),
];

/// What is known of the sledge of the scene, in a formulation.
pub(super) fn sledge_reference(formulation: &Formulation) -> Reference {
    sledge::Sledge { k: sledge::RADIUS }.reference(formulation)
}

/// The formulations of a scene that has multipliers: two forms of the vakonomic one among them.
const FORMULATIONS: [&Formulation; 4] = [CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE, REMOVED_CONSTRAINT];

/// The first choice of a scene with that formulation, free constants zero where the scene gives none.
pub(super) fn choice(scene: &Scene, formulation: &Formulation) -> Result<Choice, String> {
    let found = choices(scene).into_iter().find(|c| c.formulation == formulation);
    let mut choice = found.ok_or_else(|| format!("no formulation {}", formulation.name))?;
    if choice.removal.is_some() {
        choice.constants = ConstantsRule::Zero;
    }
    Ok(choice)
}

/// A scene in one formulation.
fn subject(scene: &Scene, choice: &Choice) -> Result<Subject, String> {
    let equations = derive_at(&scene.system, &scene.start, choice).map_err(|error| error.to_string())?;
    Ok(Subject {
        system: scene.system.clone(),
        start: scene.start.clone(),
        end: scene.start.t + scene.duration,
        equations,
        constants: choice.constants.clone(),
        choice: Some(choice.clone()),
        measured: scene.system.clone(),
    })
}

/// One question per formulation; where the scene itself is refused, that is the answer.
fn questions(
    point: f64,
    scene: impl Fn() -> Result<Scene, SceneError> + Clone + Send + Sync + 'static,
    formulations: &[&'static Formulation],
    reference: impl Fn(&'static Formulation) -> Reference,
) -> Vec<Question> {
    let one = |&formulation: &&'static Formulation| {
        let scene = scene.clone();
        let subject = move || {
            let scene = scene().map_err(|error| error.to_string())?;
            subject(&scene, &choice(&scene, formulation)?)
        };
        Question::new(point, formulation.title, subject, reference(formulation))
    };
    formulations.iter().map(one).collect()
}

/// The same by structure-preserving steps of this length.
fn stepped(
    mut questions: Vec<Question>,
    step: f64,
    scene: impl Fn() -> Result<Scene, SceneError> + Clone + Send + Sync + 'static,
    formulations: &[&'static Formulation],
) -> Vec<Question> {
    for (question, &formulation) in questions.iter_mut().zip(formulations) {
        let scene = scene.clone();
        question.stepped = Some(Box::new(move |composition| {
            let scene = scene().map_err(|error| error.to_string())?;
            let settings = Settings { max_steps: MAX_STEPS, ..Settings::default() };
            let choice = choice(&scene, formulation)?;
            solve_by_steps(&scene, &choice, Steps { step, composition }, &settings).map_err(|error| error.to_string())
        }));
    }
    questions
}

/// `10^(from/2), 10^((from + 1)/2), …, 1`.
fn half_powers(from: i32) -> impl Iterator<Item = f64> {
    (from..=0).map(half_power)
}

/// `10^(k/2)`.
fn half_power(k: i32) -> f64 {
    10.0_f64.powf(f64::from(k) / 2.0)
}

/// `10^k` for these `k`.
fn powers_of(exponents: &'static [i32]) -> impl Iterator<Item = f64> {
    exponents.iter().map(|&k| 10.0_f64.powi(k))
}

/// `10^from, 10^(from + step), …, 10^to`.
fn powers(from: i32, to: i32, step: usize) -> impl Iterator<Item = f64> {
    (from..=to).step_by(step).map(|k| 10.0_f64.powi(k))
}
