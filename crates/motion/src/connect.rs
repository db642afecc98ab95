//! Two-point problems: the motions of one formulation from `q(t₀)` to `q(t₁)`.
//!
//! Unknown are the start velocities that the constraints leave free, `n − h` of them, and the free constants
//! (`μ₀` of vakonomic motions, h of them; costates `P₀` of a removal):
//!
//! ```text
//! x = (v_free, c) ∈ Rᵏ ,   q_i(t₁; x) = q₁_i   for k coordinates i.
//! ```
//!
//! That is how vakonomic motions are meant, for which k = n: their action is stationary among the curves
//! between two points that keep the constraints. Curves with an abnormal lift may be so without multipliers,
//! and are not found (Proposition 12 of `docs/theory.md`). From each of several starts goes a search by
//! Levenberg and Marquardt with exact Jacobians `∂q(t₁)/∂x`, integrated with the motion. There may be several
//! motions, of different action; what was found is all that is known.
//!
//! A time t is conjugate to t₀ if `det ∂q(t)/∂x = 0`: neighbouring motions from q(t₀) meet there to first
//! order. With `W = ∂²(L + μ·f)/∂v²` positive on ker A along a vakonomic motion (Legendre) and none up to t₁
//! it is a local minimum of the action (Jacobi), with W negative a maximum; with one before t₁, or W
//! indefinite, it is neither; with the first at t₁ nothing is said. Nothing is said of a curve that is a
//! motion for several μ₀: it has an abnormal lift.
//!
//! Where the constraints are integrable every μ₀ gives the same motion, and none is unknown: the coordinates
//! that belong to v_free are aimed at, the others follow, or the end is on another leaf, which no motion
//! reaches.

mod action;
mod conjugate;
mod curves;
mod guesses;
mod leaf;
mod second_variation;
mod two_point;
mod velocities;

use std::sync::{Mutex, PoisonError};

use integrate::{BoundaryError, Interrupt, ShootOptions, shoot};
use mechanics::{ConstantsRule, State};
use scene::Scene;
use symbolic::limits::{HALF_THE_DIGITS, SAME};

use crate::band::{NEARLY_ZERO, RESIDUAL, SEARCH_STEPS};
use crate::constants::constant_names;
use crate::shooting::{BEGINNING, Minimum, distinct};
use crate::variational::{VariationalRun, Which};
use crate::{Choice, Motion, Settings, SolveError, TIGHTER, VAKONOMIC, over_threads, solve_choice};
use action::action;
pub use conjugate::{ConjugateTime, samples, times};
use curves::{ONE, one_per_curve};
pub use second_variation::SecondVariation;
use second_variation::second_variation;
use two_point::TwoPoint;

/// Where a motion is to end.
#[derive(Clone, Debug, PartialEq)]
pub struct Aim {
    /// `t₁`, after t₀.
    pub t: f64,
    /// Names of coordinates with their values at `t₁`: as many as there are unknowns.
    pub to: Vec<(String, f64)>,
    /// From how many starts it is searched; > 0.
    pub starts: usize,
    /// Threads; 0: as many as there are processors. No result depends on it.
    pub threads: usize,
}

/// Number of starts where none is given.
pub const CONNECT_STARTS: usize = 60;

/// The result of a two-point problem.
pub struct Connections {
    /// Names of the unknowns: free start velocities, free constants.
    pub unknowns: Vec<String>,
    /// The motions, by rising action.
    pub found: Vec<Connection>,
    /// Why the other starts led nowhere, and how many.
    pub failures: Vec<(String, usize)>,
    /// Motions integrated in the search, and how many of them with derivatives.
    pub runs: [usize; 2],
    /// Whether every constant gives the same motion.
    pub every_constant: bool,
    /// Why there is no motion at all.
    pub none: Option<String>,
}

/// A motion from `q(t₀)` to `q(t₁)`.
pub struct Connection {
    /// `(t₀, q₀, v₀)`
    pub start: State,
    /// The unknowns, in the order of [`Connections::unknowns`].
    pub unknowns: Vec<f64>,
    /// Error bounds of these: `|(∂q(t₁)/∂x)⁻¹|` times the sum of the miss of q(t₁) and its error estimate.
    pub errors: Vec<f64>,
    /// Condition number of `∂q(t₁)/∂x`, rows and columns in units of the problem.
    pub condition: f64,
    /// `∫ L dt`, and the error of its quadrature.
    pub action: [f64; 2],
    /// The motion, with an error estimate of its own.
    pub motion: Motion,
    /// `q_i(t₁) − q₁_i`, in the order of [`Aim::to`].
    pub residuals: Vec<f64>,
    /// The times conjugate to t₀, rising; `None` where `det ∂q(t)/∂x` vanishes at all times.
    pub conjugate: Option<Vec<ConjugateTime>>,
    /// What the second variation of the action says.
    pub second_variation: SecondVariation,
    /// Whether the action has a local minimum; `None` where that is not known.
    pub is_minimum: Option<bool>,
    /// How many starts led here.
    pub starts: usize,
    /// Whether the first half of the starts leads here.
    pub by_half: bool,
}

impl Connection {
    /// Whether no other motion is beside it: otherwise it may be one of a family.
    pub fn is_isolated(&self) -> bool {
        self.condition < HALF_THE_DIGITS.recip()
    }
}

/// The motions of `choice` from the start of `scene` that end where `aim` says, as far as its starts lead to
/// them. Constants of the choice are a first guess; costates that its rule makes zero, and that never move,
/// are not unknowns, unless they are given.
///
/// ```
/// # let text = include_str!("../../scene/scenes/heisenberg.toml");
/// use motion::{Aim, Settings, VAKONOMIC, choices, connect};
/// let scene = scene::Scene::parse("heisenberg", text)?;
/// let choice = choices(&scene).into_iter().find(|c| c.formulation == VAKONOMIC).unwrap();
/// // a quarter of the circle of radius 1 about the origin of the plane
/// let to = [("x", 0.5), ("y", 1.0), ("z", 0.5 * (std::f64::consts::FRAC_PI_4 - 0.5) + 0.25)];
/// let to = to.map(|(name, x)| (name.to_string(), x)).to_vec();
/// let aim = Aim { t: 1.0, to, starts: 8, threads: 1 };
/// let found = connect(&scene, &choice, &aim, &Settings::default())?;
/// assert_eq!(found.unknowns, ["x'", "y'", "mu0_1"]);
/// assert!(found.found.iter().all(|motion| motion.residuals.iter().all(|r| r.abs() < 1e-9)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SolveError::TwoPoint`] where there are not as many coordinates as unknowns, an unknown coordinate, a
/// time or value that makes no sense; [`SolveError::Interrupted`]; as [`crate::Varying::new`].
pub fn connect(scene: &Scene, choice: &Choice, aim: &Aim, settings: &Settings) -> Result<Connections, SolveError> {
    let problem = TwoPoint::new(scene, choice, aim, settings)?;
    let every_constant = problem.every_constant;
    let all = [&problem.goal[..], &problem.others].concat();
    if all.len() == scene.system.dimension() {
        let end: Vec<f64> = (0..all.len()).filter_map(|i| all.iter().find(|(j, _)| *j == i)).map(|(_, q)| *q).collect();
        if let none @ Some(_) = leaf::other_leaf(&scene.system, &scene.start, &end)? {
            let (found, failures) = (Vec::new(), Vec::new());
            return Ok(Connections { unknowns: problem.names, found, failures, runs: [0, 0], every_constant, none });
        }
    }
    let coarse = Settings { tolerance: SAME, max_steps: SEARCH_STEPS.min(settings.max_steps), ..settings.clone() };
    let guesses = guesses::guesses(&problem, aim.starts)?;
    let problem = Mutex::new(problem.scaled(&guesses.units, &guesses.sizes));
    let searched = from_all(&problem, aim.threads, &guesses.values, |problem, i, guess| {
        let plain = |problem: &mut TwoPoint| search(problem, guess, &coarse);
        match i % 2 {
            0 => grown(problem, guess, &coarse).map_or_else(|| plain(problem), Ok),
            _ => plain(problem).or_else(|error| grown(problem, guess, &coarse).ok_or(error)),
        }
    });
    let cause = settings.interrupt.as_ref().and_then(Interrupt::cause);
    if let Some(cause) = cause {
        return Err(SolveError::Interrupted { cause });
    }
    let mut runs = [0, 0];
    let (mut near, mut failures) = (Vec::new(), Vec::new());
    for (number, (shot, done)) in searched.into_iter().enumerate() {
        runs = [runs[0] + done[0], runs[1] + done[1]];
        match shot {
            Ok(unknowns) => near.push(Minimum::start(number, unknowns)),
            Err(error) => count(&mut failures, reason(&error), 1),
        }
    }
    each_once(&mut near, ONE[0]);
    let guesses: Vec<Vec<f64>> = near.iter().map(|near| near.unknowns.clone()).collect();
    let fine = from_all(&problem, aim.threads, &guesses, |problem, _, guess| search(problem, guess, settings));
    let mut exact = Vec::new();
    for ((shot, done), near) in fine.into_iter().zip(near) {
        runs = [runs[0] + done[0], runs[1] + done[1]];
        match shot {
            Ok(unknowns) => exact.push(Minimum { unknowns, ..near }),
            Err(error) => count(&mut failures, reason(&error), near.reached),
        }
    }
    each_once(&mut exact, ONE[1]);
    let mut problem = problem.into_inner().unwrap_or_else(PoisonError::into_inner);
    let exact = one_per_curve(exact, &mut problem);
    let completed = exact.iter().map(|exact| complete(&mut problem, (scene, choice), exact, settings));
    let (mut found, others): (Vec<Connection>, Vec<Connection>) = completed
        .collect::<Result<Vec<_>, _>>()?
        .into_iter()
        .partition(|motion| !every_constant || motion.residuals.iter().all(|r| r.abs() < ONE[0]));
    for other in others {
        count(&mut failures, "the motion ends at another place of the leaf".into(), other.starts);
    }
    found.sort_by(|a, b| a.action[0].total_cmp(&b.action[0]));
    failures.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    Ok(Connections { unknowns: problem.names, found, failures, runs, every_constant, none: None })
}

/// What a guess leads to, with the runs that it took.
type Led = (Result<Vec<f64>, BoundaryError>, [usize; 2]);

/// What each guess leads to.
fn from_all(
    problem: &Mutex<TwoPoint>,
    threads: usize,
    guesses: &[Vec<f64>],
    search: impl Fn(&mut TwoPoint, usize, &[f64]) -> Result<Vec<f64>, BoundaryError> + Sync,
) -> Vec<Led> {
    over_threads(threads, guesses.len(), |i| {
        let mut own = problem.lock().unwrap_or_else(PoisonError::into_inner).clone();
        (search(&mut own, i, &guesses[i]), own.runs)
    })
}

/// Unknowns, in units of the problem, from this guess on.
fn search(problem: &mut TwoPoint, guess: &[f64], settings: &Settings) -> Result<Vec<f64>, BoundaryError> {
    problem.settings = settings.clone();
    Ok(shoot(problem, guess, &ShootOptions::with_tolerance(RESIDUAL * TIGHTER * settings.tolerance))?.unknowns)
}

/// The same where a motion that takes less time is found first, and followed as it takes more and more: what
/// a long motion folds, a short one does not. Velocities go as one over the time. Every second guess tries it
/// first.
fn grown(problem: &mut TwoPoint, guess: &[f64], settings: &Settings) -> Option<Vec<f64>> {
    let (start, end) = (problem.scene_start.t, problem.aim.t);
    let (mut part, mut step) = (BEGINNING, BEGINNING);
    problem.aim.t = start + part * (end - start);
    let short: Vec<f64> = guess.iter().map(|x| x / part).collect();
    let mut found = search(problem, &short, settings).ok();
    while let Some(x) = found.as_mut().filter(|_| part < 1.0) {
        let next = (part + step).min(1.0);
        let by_then = problem.followed(x, (next - part) * (end - start));
        problem.aim.t = if next < 1.0 { start + next * (end - start) } else { end };
        match by_then.and_then(|guess| search(problem, &guess, settings).ok()) {
            Some(longer) => (*x, part, step) = (longer, next, 1.5 * step),
            None => step *= 0.5,
        }
        problem.aim.t = start + part * (end - start);
        if step < NEARLY_ZERO * BEGINNING {
            found = None;
        }
    }
    problem.aim.t = end;
    found
}

/// Each once: those are one whose unknowns differ by less than this part of their units and sizes.
pub fn each_once(all: &mut Vec<Minimum>, one: f64) {
    let near = |(y, x): (&f64, &f64)| (x - y).abs() <= one * (1.0 + y.abs());
    distinct(all, |known, other| known.unknowns.iter().zip(&other.unknowns).all(near));
}

fn count(all: &mut Vec<(String, usize)>, reason: String, starts: usize) {
    match all.iter_mut().find(|(known, _)| *known == reason) {
        Some((_, count)) => *count += starts,
        None => all.push((reason, starts)),
    }
}

/// Why a search led nowhere, without its numbers.
fn reason(error: &BoundaryError) -> String {
    match error {
        BoundaryError::NotConverged { .. } => {
            "no end of the search, or a minimum of the distance that is not zero".into()
        }
        BoundaryError::Singular { .. } => "the unknowns do not determine the end".into(),
        _ => "the motion of the guess stops before the end".into(),
    }
}

/// Everything about the motion with these unknowns.
fn complete(
    problem: &mut TwoPoint,
    (scene, choice): (&Scene, &Choice),
    (found, several): &(Minimum, bool),
    settings: &Settings,
) -> Result<Connection, SolveError> {
    let x = problem.in_units(&found.unknowns);
    let (start, constants) = problem.start(&x)?;
    let end = problem.aim.t;
    let own = Scene { start: start.clone(), duration: end - start.t, ..scene.clone() };
    let given = Choice { constants: ConstantsRule::Given(constants), ..choice.clone() };
    let mut motion = solve_choice(&own, &given, &Settings { times: None, ..settings.clone() })?;
    let reached = motion.at(motion.end())?.coordinates;
    let aimed = [&problem.goal[..], &problem.others].concat();
    let miss = |name: &String| {
        let place = scene.system.coordinates.iter().position(|c| c.name == *name);
        let goal = aimed.iter().find(|(i, _)| Some(*i) == place);
        goal.map_or(f64::NAN, |&(i, q)| reached[i] - q)
    };
    let residuals: Vec<f64> = problem.aim.to.iter().map(|(name, _)| miss(name)).collect();
    problem.settings = settings.clone();
    problem.set(&x)?;
    let along = problem.directions(&x)?;
    let mut both = Vec::new();
    for (which, part) in [(Which::Kept, TIGHTER), (Which::Looser, 1.0)] {
        let options = problem.options(settings.tolerance * part);
        let prepared = problem.varying.prepared_mut();
        let mut carried = VariationalRun::run(prepared, &along, end, &options, which)?;
        let samples = conjugate::samples(start.t, end, &carried.step_times());
        let times = match several {
            true => None,
            false => conjugate::times(&mut |t| problem.matrix_at(&mut carried, t), &samples)?,
        };
        let (outputs, derivatives) = carried.at(problem.varying.prepared_mut(), end)?;
        both.push((times, outputs, problem.matrix(&derivatives)));
    }
    let [(times, kept, matrix), (looser_times, looser, _)] = &both[..] else { unreachable!("two runs") };
    let conjugate = times.as_ref().map(|times| conjugate::with_errors(times, looser_times.as_deref()));
    let misses: Vec<f64> = problem
        .goal
        .iter()
        .zip(&problem.sizes)
        .map(|(&(i, q), size)| ((kept.coordinates[i] - looser.coordinates[i]).abs() + (reached[i] - q).abs()) / size)
        .collect();
    let condition = conjugate::condition(matrix);
    let inverse = matrix.clone().try_inverse();
    let digits = |j: usize| 4.0 * f64::EPSILON * x[j].abs();
    let errors = (0..x.len()).map(|j| {
        let row = |inverse: &nalgebra::DMatrix<f64>| {
            inverse.row(j).iter().zip(&misses).map(|(a, m)| a.abs() * m).sum::<f64>()
        };
        inverse.as_ref().map_or(f64::INFINITY, row) * problem.units[j] + digits(j)
    });
    let is_stationary =
        (choice.formulation == VAKONOMIC || scene.system.constraints.is_empty()) && !scene.system.has_forces();
    let kernel_of_constants = || {
        let free = problem.velocities.free.len();
        let columns = (free..x.len()).filter(|&j| matrix.column(j).norm() <= HALF_THE_DIGITS * matrix.norm()).count();
        conjugate.is_none() && columns > 0
    };
    let second_variation = match is_stationary {
        false => SecondVariation::Unknown,
        true if *several || kernel_of_constants() => SecondVariation::Abnormal,
        true => {
            second_variation(&scene.system, &mut motion, conjugate.as_deref(), condition < HALF_THE_DIGITS.recip())?
        }
    };
    Ok(Connection {
        errors: errors.collect(),
        condition,
        action: action(&scene.system, &mut motion)?,
        motion,
        residuals,
        conjugate,
        second_variation,
        is_minimum: second_variation.is_minimum(),
        starts: found.reached,
        by_half: found.first < problem.aim.starts.div_ceil(2),
        unknowns: x,
        start,
    })
}

/// Names of the free constants of a motion that are not parameters.
fn own_constant_names(problem: &crate::Varying) -> Vec<String> {
    constant_names(&problem.prepared().equations)[..problem.constants().len()].to_vec()
}
