//! Derivatives of a motion by numbers of its scene: parameters, start, free constants.
//!
//! `x ↦ (y(t₀), c) ↦ y(t) ↦ outputs`. The first map is [`crate::sensitivity_start`]; derivatives of the
//! second are carried with the motion, eight at a time ([`equations::Tangents`]). They are under the error
//! control of the time loop, and as each motion is integrated twice, so are they: what the two runs differ
//! by is their error estimate.
//!
//! Nothing jumps at a time that moves: breakpoints are at times that are numbers, a motion ends where its
//! equations are singular, `u/sqrt(u^2)` at 0 among them, and where they have a kink rates are continuous,
//! so that derivatives are also exact.
//!
//! A number at which the equations have a kink all the time, as p = 0 for `sqrt(p^2) x`, is refused
//! ([`crate::kinks`]); so is one at which the start has one.

use equations::Outputs;
use integrate::{Dense, Options, Status, StopCause, Work};
use mechanics::ConstantsRule;
use scene::Scene;

use crate::band::Errors;
use crate::clock::Clock;
use crate::constants::places;
use crate::direction::Direction;
use crate::ending::vanishing_guard;
use crate::kinks::refuse_kinks;
use crate::sensitivity_start::{directions, kept_natural};
use crate::variational::{VariationalRun, Which};
use crate::wanted::wanted;
use crate::{ByName, Choice, Ending, Prepared, Settings, SolveError, TIGHTER, setting};

/// Derivatives of a motion.
#[derive(Clone, Debug)]
pub struct Sensitivities {
    /// Names of the numbers, as of [`Scene::starts`].
    pub names: Vec<String>,
    /// Names of the multipliers.
    pub multipliers: Vec<String>,
    /// Names of the invariants.
    pub invariants: Vec<String>,
    /// The times asked for, as far as both runs came.
    pub times: Vec<f64>,
    /// The others of the times asked for.
    pub missing: Vec<f64>,
    /// Outputs at these times.
    pub outputs: Vec<Outputs>,
    /// The derivatives at each time by each number.
    pub derivatives: Vec<Vec<Outputs>>,
    /// Largest differences of the derivatives of the two runs up to each time.
    pub errors: Vec<Vec<Outputs>>,
    /// How the motion ended, for all numbers.
    pub ending: Ending,
    /// Work of the kept runs.
    pub work: Work,
    /// Seconds of their integration, both runs, without the search for constants before and the outputs
    /// after.
    pub seconds: f64,
}

/// The derivatives of coordinates, velocities, multipliers and invariants at `times`, ascending, by the
/// numbers of these names: parameters, start values (constraints supply the velocities that they supply in
/// the scene), `mu0_1`, … and `P0_w`. Of constants that are natural at a horizon the motion has, for each
/// value of the numbers, its own.
///
/// ```
/// # let text = include_str!("../../scene/scenes/sledge.toml");
/// use motion::{Settings, choices, sensitivities};
/// let scene = scene::Scene::parse("sledge", text)?;
/// let found = sensitivities(&scene, &choices(&scene)[0], &["phi'"], &[2.0], &Settings::default())?;
/// // the sledge turns at a constant rate
/// assert!((found.derivatives[0][0].coordinates[2] - 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`ByName::new`] and [`crate::solve_choice`]; [`SolveError::Member`] without names, with a name on which
/// the start or the equations do not depend smoothly, or for a method other than
/// [`integrate::Method::Taylor`] and [`integrate::Method::Dop853`].
pub fn sensitivities(
    scene: &Scene,
    choice: &Choice,
    names: &[&str],
    times: &[f64],
    settings: &Settings,
) -> Result<Sensitivities, SolveError> {
    if names.is_empty() {
        let reason = "derivatives are asked for, and no number to derive by".into();
        return Err(SolveError::Member { reason });
    }
    settings.method.map_or(Ok(()), VariationalRun::check)?;
    let mut by_name = ByName::new(scene, choice, names, settings)?;
    let [mut along, constants] = directions(&mut by_name, scene, choice)?;
    let (start, end) = (scene.start.t, setting(scene).end);
    let prepared = by_name.varying_mut().prepared_mut();
    if let ConstantsRule::Natural { horizon } = choice.constants {
        keep_natural(prepared, horizon, settings, &mut along, &constants)?;
    }
    let named = |list: &[equations::Named]| list.iter().map(|n| n.name.clone()).collect();
    let (multipliers, invariants) = (named(&prepared.equations.multipliers), named(&prepared.equations.invariants));
    let wanted = Some(wanted([start, end], times));
    prepared.complete(prepared.method.method)?;
    let clock = Clock::start();
    let options = Options { wanted: wanted.clone(), ..settings.options(settings.tolerance * TIGHTER) };
    let mut kept = kept_run(prepared, &along, end, settings, options)?;
    let options = Options { method: kept.method, wanted, ..settings.options(settings.tolerance) };
    let mut looser = VariationalRun::by(prepared, &along, end, &options, Which::Looser)?;
    let seconds = clock.seconds();
    refuse_kinks(prepared, &kept, names, [start, end], times)?;
    let direction = (end - start).signum();
    let mut found = Sensitivities {
        names: names.iter().map(|name| name.to_string()).collect(),
        multipliers,
        invariants,
        times: Vec::new(),
        missing: Vec::new(),
        outputs: Vec::new(),
        derivatives: Vec::new(),
        errors: Vec::new(),
        ending: ending(prepared, [kept.status(), looser.status()], [start, end]),
        work: kept.work(),
        seconds,
    };
    let ends: Vec<f64> = kept.ends().chain(looser.ends()).collect();
    let reached = times.partition_point(|t| ends.iter().all(|end| direction * (t - end) <= 0.0));
    found.missing = times[reached..].to_vec();
    let mut errors = vec![Errors::default(); names.len()];
    for &t in &times[..reached] {
        let ((outputs, derivatives), (_, others)) = (kept.at(prepared, t)?, looser.at(prepared, t)?);
        errors.iter_mut().zip(derivatives.iter().zip(&others)).for_each(|(errors, (a, b))| errors.add([a, b]));
        found.times.push(t);
        found.outputs.push(outputs);
        found.derivatives.push(derivatives);
        found.errors.push(errors.iter().map(|Errors(errors)| errors.clone()).collect());
    }
    Ok(found)
}

impl Sensitivities {
    /// Up to when they are known, and why no longer; `None` if to all times asked for.
    pub fn complaint(&self) -> Option<String> {
        match &self.ending {
            Ending::Stopped { t, cause } if !self.missing.is_empty() => {
                Some(format!("derivatives are known up to t = {t:?}: {cause}"))
            }
            _ => None,
        }
    }
}

/// The run that is kept, by a method that suits unless one is asked for.
fn kept_run<'a>(
    prepared: &mut Prepared,
    along: &'a [Direction],
    end: f64,
    settings: &Settings,
    options: Options,
) -> Result<VariationalRun<'a>, SolveError> {
    let options = Options { method: prepared.method.method, ..options };
    let run = if settings.method.is_some() { VariationalRun::by } else { VariationalRun::run };
    run(prepared, along, end, &options, Which::Kept)
}

fn ending(prepared: &Prepared, runs: [&Status; 2], ends: [f64; 2]) -> Ending {
    let [kept, looser] = runs.map(|status| match status {
        Status::Completed => Ending::Completed,
        Status::Stopped { t, cause: StopCause::Event { index } } => {
            Ending::Stopped { t: *t, cause: vanishing_guard(&prepared.equations, *index) }
        }
        Status::Stopped { t, cause } => Ending::Stopped { t: *t, cause: cause.to_string() },
    });
    Ending::joint(kept, looser, ends)
}

/// Adds to directions what constants that are natural at `horizon` do along them.
fn keep_natural(
    prepared: &mut Prepared,
    horizon: f64,
    settings: &Settings,
    along: &mut [Direction],
    constants: &[Direction],
) -> Result<(), SolveError> {
    if constants.is_empty() {
        return Ok(());
    }
    let places = places(&prepared.equations, constants.len());
    let formulation = prepared.equations.formulation.to_string();
    let places = places.ok_or(SolveError::NoNaturalCondition { formulation })?;
    let all = [&*along, constants].concat();
    let options = Options { dense: Dense::EndOnly, ..settings.options(settings.tolerance * TIGHTER) };
    let kept = kept_run(prepared, &all, horizon, settings, options)?;
    if let Status::Stopped { t, cause } = kept.status() {
        let reason = format!("on the way to the horizon {horizon:?} the motion stops at t = {t:?}: {cause}");
        return Err(SolveError::Member { reason });
    }
    let quantities: Vec<Vec<f64>> =
        kept.end_moves().map(|moves| places.iter().map(|&place| moves[place]).collect()).collect();
    let (of_numbers, of_constants) = quantities.split_at(along.len());
    let dependent = || SolveError::Member {
        reason: format!(
            "the natural conditions at the horizon {horizon:?} do not determine the constants to first order"
        ),
    };
    kept_natural(along, constants, of_numbers, of_constants).ok_or_else(dependent)
}
