//! Free constants from the natural boundary condition at a horizon.

use integrate::{BoundaryError, ShootOptions, shoot};

use crate::motion::{Settings, ending};
use crate::run::{Origin, Prepared};
use crate::{Ending, SolveError, TIGHTER};

/// Residual at the horizon that is accepted, over the tolerance of the integration.
const RESIDUAL: f64 = 1e3;

/// Steps that a run of the search may take on average, over those of the run from the guess: beside a singularity a run may take a thousand times more,
/// and the search does not get past it.
const LONGER: usize = 4;

/// Finds the constants `C` for which every [`equations::FreeConstant::natural`] quantity vanishes at `horizon`.
///
/// Single shooting from zero: the constants are the unknowns, the quantities at the horizon the residuals. All runs together may take as many steps as
/// [`LONGER`] times the first one, for each run that the search may make.
pub(crate) fn natural_constants(
    prepared: &mut Prepared,
    horizon: f64,
    settings: &Settings,
) -> Result<Vec<f64>, SolveError> {
    let equations = &prepared.equations;
    let constants = &equations.free_constants;
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
    let guess = vec![0.0; constants.len()];
    let tolerance = settings.tolerance * TIGHTER;
    let options = ShootOptions::with_tolerance(RESIDUAL * tolerance);
    let runs = options.max_iterations * (2 * guess.len() + 2);
    let (mut taken, mut limit) = (0, None);
    let mut failure = None;
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
        let settings = Settings { max_steps: left, ..settings.clone() };
        let run = prepared.run(constants, horizon, tolerance, Origin::Start, &settings).map_err(&mut refuse)?;
        let steps = run.solution.work.steps + run.solution.work.rejected;
        taken += steps;
        limit.get_or_insert(LONGER * runs * steps);
        let mut end = vec![0.0; prepared.equations.states.len()];
        if let Ending::Stopped { t, cause } = ending(&prepared.equations, &mut prepared.compiled, &run.solution) {
            return Err(BoundaryError::Residual { reason: format!("the motion stops at t = {t:.6}: {cause}") });
        }
        run.solution.dense.evaluate(horizon, &mut end);
        for (r, &place) in residual.iter_mut().zip(&places) {
            *r = end[place];
        }
        Ok(())
    };
    let shot = shoot(&mut residual, &guess, &options);
    match (shot, failure) {
        (Ok(shot), _) => Ok(shot.unknowns),
        (Err(_), Some(error)) => Err(error),
        (Err(error), None) => Err(SolveError::Boundary { horizon, error }),
    }
}
