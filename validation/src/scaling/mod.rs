//! How cost grows with the size of a system: the train with n trailers, in every formulation.
//!
//! Three costs are measured: derivation (`System` to compiled tape, finding a removal included), one
//! right-hand side, and a solve over the scene's duration. Each time comes with a count that no machine
//! changes: expressions made, operations of a right-hand side, evaluations. Trains grow until a formulation's
//! derivation takes over [`Limits::seconds`]; solves that would are left out.

use std::time::Instant;

use anyhow::{Context, Result};
use bench::{Exponent, exponent};
use equations::{Compiled, Derivation, Formulation};
use mechanics::{ConstantsRule, Removal, System};
use motion::band::SEARCH_STEPS;
use motion::{
    CHETAEV, Prepared, REDUCED_CHETAEV, REDUCED_VAKONOMIC, REMOVED_CONSTRAINT, Setting, Settings, VAKONOMIC,
    VAKONOMIC_COSTATE, default_constants, prepare, setting, solve,
};
use scene::Scene;
use serde::Serialize;

use scene::catalogue::trailer::{Coordinates, scene};

/// Numbers of trailers.
pub const TRAILERS: [usize; 9] = [1, 2, 5, 10, 20, 40, 80, 160, 320];

/// Exponents are fitted from here.
pub const FROM: usize = 20;

/// Formulations that are measured, with the coordinates of the train in each.
pub const FORMULATIONS: [(&Formulation, Coordinates); 7] = [
    (REDUCED_CHETAEV, Coordinates::Maximal),
    (CHETAEV, Coordinates::Maximal),
    (REDUCED_VAKONOMIC, Coordinates::Maximal),
    (VAKONOMIC, Coordinates::Maximal),
    (VAKONOMIC_COSTATE, Coordinates::Maximal),
    (REMOVED_CONSTRAINT, Coordinates::Maximal),
    (REMOVED_CONSTRAINT, Coordinates::Minimal),
];

/// Limits of the measurements.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Longest train.
    pub trailers: usize,
    /// After a longer derivation, longer trains are left out; and solves that would take longer.
    pub seconds: f64,
    /// Repeats of everything that is timed; the shortest time counts.
    pub repeats: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { trailers: 320, seconds: 2.0, repeats: 5 }
    }
}

/// One formulation at one length.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// n.
    pub trailers: usize,
    /// Number of states.
    pub states: usize,
    /// Expressions in the graph after derivation and compilation.
    pub expressions: usize,
    /// Seconds from `System` to compiled tape.
    pub derivation: f64,
    /// [`Compiled::cost`].
    pub operations: usize,
    /// Seconds of one right-hand side.
    pub right_hand_side: f64,
    /// Seconds of a solve over the duration of the scene, both runs; none where it was not affordable.
    pub solve: Option<f64>,
    /// Right-hand sides of the kept run of that solve.
    pub evaluations: Option<usize>,
    /// How far the solve came; less than the duration where the motion stopped.
    pub reached: f64,
}

/// One formulation.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Name of the formulation, and of the coordinates.
    pub formulation: String,
    /// By rising length.
    pub points: Vec<Point>,
    /// Why longer trains are missing, where they are.
    pub ended: Option<String>,
}

impl Line {
    /// The exponent of a cost over n from [`FROM`] on; none with fewer than three points.
    pub fn exponent(&self, cost: impl Fn(&Point) -> Option<f64>) -> Option<Exponent> {
        let points = self.points.iter().filter(|p| p.trailers >= FROM);
        exponent(&points.filter_map(|p| Some((p.trailers as f64, cost(p)?))).collect::<Vec<(f64, f64)>>())
    }
}

/// Every formulation, as far as it goes.
///
/// # Errors
/// Where a train has no equations or no motion.
pub fn measure(limits: &Limits, progress: &mut dyn FnMut(&str, usize)) -> Result<Vec<Line>> {
    FORMULATIONS.into_iter().map(|measured| line(measured, limits, progress)).collect()
}

/// One formulation.
///
/// # Errors
/// As [`measure`].
pub fn line(
    measured: (&'static Formulation, Coordinates),
    limits: &Limits,
    progress: &mut dyn FnMut(&str, usize),
) -> Result<Line> {
    let name = match measured {
        (formulation, Coordinates::Maximal) => formulation.name.into(),
        (formulation, Coordinates::Minimal) => format!("{} (minimal coordinates)", formulation.name),
    };
    let mut line = Line { formulation: name.clone(), points: Vec::new(), ended: None };
    for trailers in TRAILERS.into_iter().filter(|&n| n <= limits.trailers) {
        progress(&name, trailers);
        let before = line.points.last().and_then(|p| p.evaluations);
        let solves = line.points.iter().all(|p| p.solve.is_some());
        let evaluations = if solves { before.or(Some(0)) } else { None };
        let point = match point(measured, trailers, limits, evaluations) {
            Ok(point) => point,
            Err(error) if line.points.is_empty() => {
                return Err(error.context(format!("{name} with {trailers} trailers")));
            }
            // what works for short trains and is refused for this one is a result
            Err(error) => {
                line.ended = Some(format!("n = {trailers} is refused: {error}"));
                break;
            }
        };
        let seconds = point.derivation;
        line.points.push(point);
        if seconds > limits.seconds && trailers < limits.trailers {
            line.ended = Some(format!("the derivation for n = {trailers} took {seconds:.1} s"));
            break;
        }
    }
    Ok(line)
}

/// Counts of one formulation at one length, untimed: expressions made, operations of a right-hand side.
///
/// # Errors
/// As [`measure`].
pub fn counts(
    (formulation, coordinates): (&'static Formulation, Coordinates),
    trailers: usize,
) -> Result<(usize, usize)> {
    let scene = scene(trailers, coordinates)?;
    let derived = derivation(formulation, &scene)?;
    Ok((derived.ready.equations.graph.nodes(), derived.ready.compiled.cost()[1].operations()))
}

/// The result of a derivation. The removal's expressions live in the graph of `system`.
struct Derived {
    system: System,
    ready: Prepared,
    constants: ConstantsRule,
}

/// From `System` to compiled tape, in the form for the scene's start; free constants not given are zero.
fn derivation(entry: &Formulation, scene: &Scene) -> Result<Derived> {
    // on a graph of its own: what was derived before is in that of the scene
    let system = scene.system.clone();
    let removal = if entry.needs_removal() { Some(Removal::by_quasi_velocities(&system, &scene.start)?) } else { None };
    let constants = match &removal {
        Some(removal) => removal.constants.clone(),
        None => default_constants(entry, scene),
    };
    let derived = (entry.derive)(
        &system,
        &Derivation { removal: removal.as_ref(), start: Some(&scene.start), ..Default::default() },
    )?;
    let equations = derived.leave_out_unneeded();
    let known = match &constants {
        ConstantsRule::Given(_) => &constants,
        _ => &ConstantsRule::Zero,
    };
    let ready = prepare(Setting { system: &system, ..setting(scene) }, equations, known, &Settings::default())?;
    Ok(Derived { system, ready, constants })
}

/// `evaluations` is how many a shorter train took; none where its solve already was too long.
fn point(
    (formulation, coordinates): (&'static Formulation, Coordinates),
    trailers: usize,
    limits: &Limits,
    evaluations: Option<usize>,
) -> Result<Point> {
    let scene = scene(trailers, coordinates)?;
    let mut derived = None;
    let mut best = f64::INFINITY;
    for _ in 0..limits.repeats {
        let clock = Instant::now();
        derived = Some(derivation(formulation, &scene)?);
        let seconds = clock.elapsed().as_secs_f64();
        best = best.min(seconds);
        if seconds > limits.seconds {
            break;
        }
    }
    let Derived { system, ready, constants } = derived.context("at least one repeat")?;
    let Prepared { equations, mut compiled, start: y, t, .. } = ready;
    let seconds = right_hand_side(&mut compiled, t, &y, limits.repeats)?;
    let mut point = Point {
        trailers,
        states: y.len(),
        expressions: equations.graph.nodes(),
        derivation: best,
        operations: compiled.cost()[1].operations(),
        right_hand_side: seconds,
        solve: None,
        evaluations: None,
        reached: scene.start.t,
    };
    // two runs
    if evaluations.is_none_or(|count| 2.0 * seconds * count as f64 > limits.seconds) {
        return Ok(point);
    }
    let settings = Settings { max_steps: SEARCH_STEPS, ..Settings::default() };
    for _ in 0..limits.repeats {
        let motion = solve(Setting { system: &system, ..setting(&scene) }, equations.clone(), &constants, &settings)?;
        let seconds = motion.seconds.integrate;
        point.solve = Some(point.solve.map_or(seconds, |other: f64| other.min(seconds)));
        point.evaluations = Some(motion.work.evaluations);
        point.reached = motion.end();
        if seconds > limits.seconds {
            break;
        }
    }
    Ok(point)
}

/// Seconds of one right-hand side: the shortest of some batches.
fn right_hand_side(compiled: &mut Compiled, t: f64, y: &[f64], repeats: usize) -> Result<f64> {
    /// s, what one batch should take
    const BATCH: f64 = 2e-3;
    let mut rates = vec![0.0; y.len()];
    let mut best = f64::INFINITY;
    let mut count = 1;
    for _ in 0..repeats + 2 {
        let clock = Instant::now();
        for _ in 0..count {
            compiled.rates(t, y, &mut rates)?;
        }
        let seconds = clock.elapsed().as_secs_f64() / f64::from(count);
        best = best.min(seconds);
        count = ((BATCH / best) as u32).clamp(1, 10_000);
    }
    Ok(best)
}
