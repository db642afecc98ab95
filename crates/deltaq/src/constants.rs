//! Free constants: zero, given, or natural at a horizon.

use equations::Equations;
use integrate::{BoundaryError, Dense, Interrupt, Options, ShootOptions, shoot};
use mechanics::ConstantsRule;

use crate::charts::{self, Course};
use crate::{Ending, Prepared, Setting, Settings, SolveError, TIGHTER};

/// Compiles `equations` and computes what they start from. Nothing is integrated, unless the constants are
/// natural at a horizon; that is done as `settings` say.
///
/// # Errors
/// [`SolveError`] where there is no start.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// use deltaq::{Settings, choices, derive, prepare, setting};
/// // the ice sledge turns at a constant rate, y = (x, y, phi, x', y', phi')
/// let chetaev = choices(&scene).remove(0);
/// let equations = derive(&scene.system, &chetaev)?;
/// let mut prepared = prepare(setting(&scene), equations, &chetaev.constants, &Settings::default())?;
/// let mut rates = [0.0; 6];
/// prepared.compiled.rates(0.0, &prepared.start, &mut rates)?;
/// assert_eq!((rates[2], rates[5]), (1.0, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn prepare(
    setting: Setting,
    equations: Equations,
    constants: &ConstantsRule,
    settings: &Settings,
) -> Result<Prepared, SolveError> {
    let mut prepared = Prepared::new(setting, equations, settings)?;
    resolve(&mut prepared, constants, settings, Some(setting), None)?;
    Ok(prepared)
}

/// Sets the free constants as `rule` says; those that are natural are looked for from `near` on, or zero, and
/// where a `setting` is known by motions that go from chart to chart.
pub(crate) fn resolve(
    prepared: &mut Prepared,
    rule: &ConstantsRule,
    settings: &Settings,
    setting: Option<Setting>,
    near: Option<&[f64]>,
) -> Result<(), SolveError> {
    let own = prepared.own_constants().len();
    let constants = match rule {
        ConstantsRule::Zero => vec![0.0; own],
        ConstantsRule::Given(values) => given_constants(&prepared.equations, own, values)?,
        ConstantsRule::Natural { horizon } => natural_constants(prepared, *horizon, settings, setting, near)?,
    };
    prepared.set_constants(&constants);
    Ok(())
}

/// One value per free constant, or one per memory variable (then those without a costate have to be zero).
fn given_constants(equations: &Equations, own: usize, values: &[f64]) -> Result<Vec<f64>, SolveError> {
    let constants = &equations.free_constants[..own];
    if let Some(&value) = values.iter().find(|x| !x.is_finite()) {
        return Err(SolveError::ConstantNotFinite { formulation: equations.formulation.into(), value });
    }
    if values.len() == constants.len() {
        return Ok(values.to_vec());
    }
    let memory = equations.removal.as_ref().map(|r| r.memory.len());
    let used: Vec<Option<usize>> = constants.iter().map(|c| c.memory).collect();
    let unused_are_zero = values.iter().enumerate().all(|(i, &x)| x == 0.0 || used.contains(&Some(i)));
    if Some(values.len()) == memory && unused_are_zero {
        return Ok(used.into_iter().map(|i| i.map_or(0.0, |i| values[i])).collect());
    }
    Err(SolveError::ConstantCount {
        formulation: equations.formulation.into(),
        expected: constants.len(),
        names: constant_names(equations)[..own].join(", "),
        found: values.len(),
    })
}

/// Names of the free constants.
pub fn constant_names(equations: &Equations) -> Vec<String> {
    equations.free_constants.iter().map(|c| equations.graph.name(c.symbol)).collect()
}

/// Residual at the horizon that is accepted, over the tolerance of the integration and the costate's size.
const RESIDUAL: f64 = 1e3;

/// Steps that a run of the search may take on average, over those of the run from the guess: beside a
/// singularity a run may take a thousand times more, and the search does not get past it.
const LONGER: usize = 4;

/// Finds the constants `C` that make every [`equations::FreeConstant::natural`] vanish at `horizon`.
///
/// Single shooting from `near`, or zero: unknowns are the constants, residuals the quantities at the horizon,
/// both over the sizes that the quantities have on the motion from there.
/// All runs together may take [`LONGER`] times the first one's steps, for each run that the search may make.
fn natural_constants(
    prepared: &mut Prepared,
    horizon: f64,
    settings: &Settings,
    setting: Option<Setting>,
    near: Option<&[f64]>,
) -> Result<Vec<f64>, SolveError> {
    let equations = &prepared.equations;
    let constants = &equations.free_constants[..prepared.own_constants().len()];
    if constants.is_empty() {
        return Ok(Vec::new());
    }
    let start = prepared.t;
    if horizon.is_nan() || horizon <= start {
        return Err(SolveError::Horizon { horizon, start });
    }
    let formulation = || equations.formulation.to_string();
    // the quantities are states: costates of memory variables
    let places: Option<Vec<usize>> = constants
        .iter()
        .map(|c| {
            let symbol = equations.graph.as_symbol(c.natural?)?;
            equations.states.iter().position(|y| y.symbol == symbol)
        })
        .collect();
    let Some(places) = places else { return Err(SolveError::NoNaturalCondition { formulation: formulation() }) };
    let guess = near.map_or(vec![0.0; constants.len()], <[f64]>::to_vec);
    prepared.set_constants(&guess);
    let of_states = prepared.sizes(horizon);
    let sizes: Vec<f64> = places.iter().map(|&place| of_states[place]).collect();
    let guess: Vec<f64> = guess.iter().zip(&sizes).map(|(c, size)| c / size).collect();
    let in_units = |scaled: &[f64]| -> Vec<f64> { scaled.iter().zip(&sizes).map(|(c, size)| c * size).collect() };
    let tolerance = settings.tolerance * TIGHTER;
    let options = ShootOptions::with_tolerance(RESIDUAL * tolerance);
    let runs = options.max_iterations * (2 * guess.len() + 2);
    let (mut taken, mut limit) = (0, None);
    let mut failure = None;
    let method = Some(prepared.method.method);
    let of_all = Settings { method, ..settings.clone() }.options(tolerance);
    let mut residual = |constants: &[f64], residual: &mut [f64]| -> Result<(), BoundaryError> {
        let mut refuse = |error: SolveError| {
            let reason = error.to_string();
            failure = Some(error);
            BoundaryError::Residual { reason }
        };
        let left = limit.map_or(settings.max_steps, |limit: usize| settings.max_steps.min(limit.saturating_sub(taken)));
        if left == 0 {
            return Err(refuse(SolveError::Search { horizon, steps: taken }));
        }
        prepared.set_constants(&in_units(constants));
        if let Some(cause) = of_all.interrupt.as_ref().and_then(Interrupt::cause) {
            return Err(refuse(SolveError::Ended { horizon, cause }));
        }
        let run_options = Options { max_steps: left, dense: Dense::EndOnly, ..of_all.clone() };
        let AtHorizon { ending, states: end, steps } =
            at_horizon(prepared, horizon, &run_options, settings, setting).map_err(&mut refuse)?;
        taken += steps;
        limit.get_or_insert(LONGER * runs * steps);
        if let Ending::Stopped { t, cause } = ending {
            return Err(BoundaryError::Residual { reason: format!("the motion stops at t = {t:.6}: {cause}") });
        }
        for ((r, &place), size) in residual.iter_mut().zip(&places).zip(&sizes) {
            *r = end[place] / size;
        }
        Ok(())
    };
    let shot = shoot(&mut residual, &guess, &options);
    match (shot, failure) {
        (Ok(shot), _) => Ok(in_units(&shot.unknowns)),
        (Err(_), Some(error)) => Err(error),
        (Err(error), None) => Err(SolveError::Boundary { horizon, error }),
    }
}

/// How a run to the horizon ended.
struct AtHorizon {
    ending: Ending,
    /// In the first chart; zero where it was not reached.
    states: Vec<f64>,
    steps: usize,
}

/// One run to the horizon; where that leaves its chart and a `setting` is known, both runs of the motion from
/// chart to chart.
fn at_horizon(
    prepared: &mut Prepared,
    horizon: f64,
    options: &Options,
    settings: &Settings,
    setting: Option<Setting>,
) -> Result<AtHorizon, SolveError> {
    let run = prepared.integrate(horizon, options)?;
    let steps = run.solution.work.steps + run.solution.work.rejected;
    let ending = Ending::of(&prepared.equations, &mut prepared.compiled, &run.solution, &[]);
    let mut states = vec![0.0; prepared.start.len()];
    if ending == Ending::Completed {
        run.solution.dense.evaluate(horizon, &mut states);
    } else if let Some(setting) = setting.filter(|_| prepared.compiled.has_chart()) {
        let within =
            Settings { method: Some(options.method), max_steps: options.max_steps, times: None, ..settings.clone() };
        let course = charts::run(Setting { end: horizon, ..setting }, prepared, &within, f64::INFINITY)?;
        if let Course::Run(mut runs) = course {
            if runs.ending == Ending::Completed {
                states = runs.trajectories[0].state(&mut prepared.compiled, horizon)?;
            }
            let steps = steps + 2 * (runs.work.steps + runs.work.rejected);
            return Ok(AtHorizon { ending: runs.ending, states, steps });
        }
    }
    Ok(AtHorizon { ending, states, steps })
}
