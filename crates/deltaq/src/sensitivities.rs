//! Derivatives of a motion by numbers of its scene: parameters, start, free constants.
//!
//! `x ↦ (y(t₀), c) ↦ y(t) ↦ outputs`. The first map is [`crate::sensitivity_start`]; derivatives of the
//! second are carried with the motion, eight at a time ([`equations::Tangents`]). They are under the error
//! control of the time loop, and as each motion is integrated twice, so are they: what the two runs differ
//! by is their error estimate.
//!
//! Nothing jumps at a time that moves: breakpoints are at times that are numbers, a motion ends where its
//! equations are singular, `u/sqrt(u^2)` at 0 among them, and where they have a kink rates are continuous,
//! so that derivatives are, too.

use equations::{Outputs, Tangents};
use integrate::{Dense, Method, Options, Status, StopCause, Work};
use mechanics::ConstantsRule;
use scene::Scene;

use crate::clock::Clock;
use crate::direction::Direction;
use crate::ending::vanishing_guard;
use crate::sensitivity_start::{Numbers, kept_natural};
use crate::single_run::SingleRun;
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
    /// What is read off at these times.
    pub outputs: Vec<Outputs>,
    /// The derivatives at each time by each number.
    pub derivatives: Vec<Vec<Outputs>>,
    /// What the derivatives of the two runs differ by at most, up to each time.
    pub errors: Vec<Vec<Outputs>>,
    /// How the motion ended, for all numbers.
    pub ending: Ending,
    /// Work of the kept runs.
    pub work: Work,
    /// Seconds of their integration, both runs; what was found before and reading off are not in them.
    pub seconds: f64,
}

/// The derivatives of coordinates, velocities, multipliers and invariants at `times`, ascending, by the
/// numbers of these names: parameters, start values (constraints supply the velocities that they supply in
/// the scene), `mu0_1`, … and `P0_w`. Of constants that are natural at a horizon the motion has, for each
/// value of the numbers, its own.
///
/// ```
/// # let text = include_str!("../../catalogue/scenes/sledge.toml");
/// use deltaq::{Settings, choices, sensitivities};
/// let scene = scene::Scene::parse("sledge", text)?;
/// let found = sensitivities(&scene, &choices(&scene)[0], &["phi'"], &[2.0], &Settings::default())?;
/// // the sledge turns at a constant rate
/// assert!((found.derivatives[0][0].coordinates[2] - 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`ByName::new`] and [`crate::solve_choice`]; [`SolveError::Member`] without names, with a name of which
/// the start is no smooth function, or for a method other than [`Method::Taylor`] and
/// [`Method::Dop853`].
pub fn sensitivities(
    scene: &Scene,
    choice: &Choice,
    names: &[&str],
    times: &[f64],
    settings: &Settings,
) -> Result<Sensitivities, SolveError> {
    let refused = |reason: String| Err(SolveError::Member { reason });
    if names.is_empty() {
        return refused("derivatives are asked for, and no number to derive by".into());
    }
    if let Some(method) = settings.method.filter(|method| ![Method::Taylor, Method::Dop853].contains(method)) {
        return refused(format!("derivatives are carried by taylor and dop853, not by {}", method.name()));
    }
    let by_name = ByName::new(scene, choice, names, settings)?;
    let mut numbers = Numbers::new(by_name, scene, choice, names)?;
    let mut along = (0..names.len()).map(|i| numbers.along_name(i)).collect::<Result<Vec<_>, _>>()?;
    numbers.reset()?;
    let carried = Carried { ends: [scene.start.t, setting(scene).end], settings: settings.clone() };
    if let ConstantsRule::Natural { horizon } = choice.constants {
        let constants = (0..numbers.own()).map(|i| numbers.along_constant(i)).collect::<Result<Vec<_>, _>>()?;
        numbers.reset()?;
        carried.keep_natural(numbers.varying.prepared_mut(), horizon, &mut along, &constants)?;
    }
    let prepared = numbers.varying.prepared_mut();
    let named = |list: &[equations::Named]| list.iter().map(|n| n.name.clone()).collect();
    let (multipliers, invariants) = (named(&prepared.equations.multipliers), named(&prepared.equations.invariants));
    let mut parts = along.chunks(Tangents::DIRECTIONS).map(|along| carried.part(prepared, along, times));
    let mut all = parts.next().expect("there are names")?;
    for part in parts {
        let part = part?;
        all.times.truncate(part.times.len());
        all.work = Work { steps: all.work.steps + part.work.steps, ..all.work };
        all.seconds += part.seconds;
        if all.ending == Ending::Completed {
            all.ending = part.ending;
        }
        all.derivatives.iter_mut().zip(part.derivatives).for_each(|(all, part)| all.extend(part));
        all.errors.iter_mut().zip(part.errors).for_each(|(all, part)| all.extend(part));
    }
    let reached = all.times.len();
    all.outputs.truncate(reached);
    all.derivatives.truncate(reached);
    all.errors.truncate(reached);
    Ok(Sensitivities { names: names.iter().map(|name| name.to_string()).collect(), multipliers, invariants, ..all })
}

/// How motions are integrated with their derivatives.
struct Carried {
    ends: [f64; 2],
    settings: Settings,
}

impl Carried {
    /// The kept and the looser run along these directions, by a method that suits.
    fn runs(
        &self,
        prepared: &mut Prepared,
        along: &[Direction],
        end: f64,
        options: &Options,
    ) -> Result<(Tangents, [SingleRun; 2]), SolveError> {
        let mut method = prepared.method.method;
        loop {
            prepared.complete(method)?;
            let mut tangents = Tangents::new(&prepared.compiled, along.len());
            for (l, direction) in along.iter().enumerate() {
                tangents.set_constants(&prepared.compiled, l, &direction.constants);
            }
            let starts: Vec<Vec<f64>> = along.iter().map(|direction| direction.start.clone()).collect();
            let mut run = |part: f64, moved: bool| {
                let own = self.settings.options(self.settings.tolerance * part);
                let options = Options { method, wanted: options.wanted.clone(), dense: options.dense, ..own };
                prepared.integrate_with(&mut tangents, &starts, end, &options, moved)
            };
            let kept = run(TIGHTER, false)?;
            let smooth = !matches!(&kept.solution.status, Status::Stopped { cause: StopCause::NotSmooth { .. }, .. });
            if smooth || method == Method::Dop853 || self.settings.method.is_some() {
                let looser = run(1.0, true)?;
                return Ok((tangents, [kept, looser]));
            }
            method = Method::Dop853;
        }
    }

    /// Outputs and derivatives by up to eight numbers.
    fn part(&self, prepared: &mut Prepared, along: &[Direction], times: &[f64]) -> Result<Sensitivities, SolveError> {
        let wanted = Some(wanted(self.ends, times));
        let options = Options { wanted, ..self.settings.options(self.settings.tolerance) };
        prepared.complete(prepared.method.method)?;
        let clock = Clock::start();
        let (mut tangents, runs) = self.runs(prepared, along, self.ends[1], &options)?;
        let seconds = clock.seconds();
        let (start, ends) = (self.ends[0], [runs[0].end(), runs[1].end()]);
        let direction = (self.ends[1] - start).signum();
        let is_reached = |t: f64| ends.iter().all(|end| direction * (t - end) <= 0.0);
        let mut found = Sensitivities {
            names: Vec::new(),
            multipliers: Vec::new(),
            invariants: Vec::new(),
            times: Vec::new(),
            outputs: Vec::new(),
            derivatives: Vec::new(),
            errors: Vec::new(),
            ending: self.ending(prepared, &runs),
            work: runs[0].solution.work,
            seconds,
        };
        let mut state = vec![0.0; prepared.start.len() * (1 + along.len())];
        for &t in times.iter().take_while(|t| is_reached(**t)) {
            let mut read = |run: &SingleRun| -> Result<(Outputs, Vec<Outputs>), SolveError> {
                run.states_at(&mut prepared.compiled, t, &mut state)?;
                let read = tangents.outputs(&mut prepared.compiled, t, &state);
                let (outputs, derivatives) = read.map_err(|failure| SolveError::Reading { t, failure })?;
                let by = |(outputs, direction): (Outputs, &Direction)| mapped(&outputs, |x| x / direction.scale);
                Ok((outputs, derivatives.into_iter().zip(along).map(by).collect()))
            };
            let ((outputs, derivatives), (_, looser)) = (read(&runs[0])?, read(&runs[1])?);
            let pairs = derivatives.iter().zip(&looser).enumerate();
            let errors = pairs.map(|(k, (kept, looser))| {
                let differences = joined(kept, looser, |a, b| (a - b).abs());
                let before = found.errors.last().map(|before: &Vec<Outputs>| &before[k]);
                before.map_or(differences.clone(), |before| joined(before, &differences, f64::max))
            });
            let errors = errors.collect();
            found.times.push(t);
            found.outputs.push(outputs);
            found.derivatives.push(derivatives);
            found.errors.push(errors);
        }
        Ok(found)
    }

    fn ending(&self, prepared: &Prepared, runs: &[SingleRun; 2]) -> Ending {
        let [kept, looser] = runs.each_ref().map(|run| match &run.solution.status {
            Status::Completed => Ending::Completed,
            Status::Stopped { t, cause: StopCause::Event { index } } => {
                Ending::Stopped { t: *t, cause: vanishing_guard(&prepared.equations, *index) }
            }
            Status::Stopped { t, cause } => Ending::Stopped { t: *t, cause: cause.to_string() },
        });
        Ending::joint(kept, looser, self.ends)
    }

    /// Adds to directions what constants that are natural at `horizon` do along them.
    fn keep_natural(
        &self,
        prepared: &mut Prepared,
        horizon: f64,
        along: &mut [Direction],
        constants: &[Direction],
    ) -> Result<(), SolveError> {
        if constants.is_empty() {
            return Ok(());
        }
        let (equations, n) = (&prepared.equations, prepared.start.len());
        let symbols = equations.free_constants[..constants.len()].iter();
        let places: Option<Vec<usize>> = symbols
            .map(|c| {
                let symbol = equations.graph.as_symbol(c.natural?)?;
                equations.states.iter().position(|y| y.symbol == symbol)
            })
            .collect();
        let formulation = equations.formulation.to_string();
        let places = places.ok_or(SolveError::NoNaturalCondition { formulation })?;
        let all = [&*along, constants].concat();
        let mut quantities: Vec<Vec<f64>> = Vec::new();
        for part in all.chunks(Tangents::DIRECTIONS) {
            let options = Options { dense: Dense::EndOnly, ..self.settings.options(self.settings.tolerance) };
            let (_, [kept, _]) = self.runs(prepared, part, horizon, &options)?;
            if let Status::Stopped { t, cause } = &kept.solution.status {
                let reason = format!("on the way to the horizon {horizon:?} the motion stops at t = {t:?}: {cause}");
                return Err(SolveError::Member { reason });
            }
            let end = kept.solution.dense.end_state();
            quantities.extend((1..=part.len()).map(|l| places.iter().map(|place| end[l * n + place]).collect()));
        }
        let (of_numbers, of_constants) = quantities.split_at(along.len());
        let dependent = || SolveError::Member {
            reason: format!(
                "the natural conditions at the horizon {horizon:?} do not determine the constants to first order"
            ),
        };
        kept_natural(along, constants, of_numbers, of_constants).ok_or_else(dependent)
    }
}

/// Every number of what is read off, mapped.
fn mapped(a: &Outputs, f: impl Fn(f64) -> f64) -> Outputs {
    joined(a, a, |x, _| f(x))
}

/// Numbers of what is read off, two and two.
fn joined(a: &Outputs, b: &Outputs, f: impl Fn(f64, f64) -> f64) -> Outputs {
    let each = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect();
    Outputs {
        coordinates: each(&a.coordinates, &b.coordinates),
        velocities: each(&a.velocities, &b.velocities),
        multipliers: each(&a.multipliers, &b.multipliers),
        invariants: each(&a.invariants, &b.invariants),
    }
}
