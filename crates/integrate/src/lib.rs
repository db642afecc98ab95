//! Time integration: `y' = F(t, y)`; dense output, events, projection, work counters. Knows no mechanics.

mod boundary;
mod dense;
mod diffsol_methods;
mod dop853;
#[cfg(test)]
mod dop853_order_conditions;
mod dop853_tableau;
mod error;
mod events;
mod options;
mod problem;
mod root;
mod status;
mod stepper;
mod system;
mod time_loop;

pub use boundary::{BoundaryError, Residual, ShootOptions, Shot, fit, shoot};
pub use dense::DenseOutput;
pub use error::{CallError, DenseError};
pub use options::{Dense, Method, Options, Projection};
pub use problem::{EvaluationError, Problem, Start};
pub use root::find_root;
pub use status::{ProjectionReport, Solution, Status, StopCause, Work};

use stepper::{Stepper, shortest_step};
use system::System;

/// Integrates `y' = F(t, y)` from `start` to `end`, forwards or backwards.
///
/// `Err` is a bad call; how the run ended is [`Solution::status`]. A state or a rate that is NaN or infinite is never
/// part of a solution: the step is halved, and where that does not help, the run stops.
///
/// # Errors
/// See [`CallError`].
pub fn integrate(
    problem: &mut dyn Problem,
    start: &Start,
    end: f64,
    options: &Options,
) -> Result<Solution, CallError> {
    check_call(problem.dimension(), start, end, options)?;
    let system = System::new(problem);
    Ok(match options.method {
        Method::Dop853 => {
            let mut stepper = dop853::Dop853::new(&system, start, end, options).map_err(StopCause::from);
            let stepper = stepper.as_mut().map(|stepper| stepper as &mut dyn Stepper).map_err(|cause| cause.clone());
            time_loop::run(&system, stepper, start, end, options)
        }
        Method::Tsit45 | Method::Bdf | Method::TrBdf2 | Method::Esdirk34 => {
            diffsol_methods::run(&system, start, end, options)
        }
    })
}

fn check_call(dimension: usize, start: &Start, end: f64, options: &Options) -> Result<(), CallError> {
    if dimension == 0 {
        return Err(CallError::NoUnknowns { found: dimension, limit: 1 });
    }
    if start.y.len() != dimension {
        return Err(CallError::Dimension { expected: dimension, found: start.y.len() });
    }
    let relative = options.relative_tolerance;
    if !(relative > 0.0 && relative < 1.0) {
        return Err(CallError::RelativeTolerance { found: relative, limit: 1.0 });
    }
    let absolute = options.absolute_tolerance;
    if !(absolute > 0.0 && absolute.is_finite()) {
        return Err(CallError::AbsoluteTolerance { found: absolute, limit: 0.0 });
    }
    if let Some(component) = start.y.iter().position(|y| !y.is_finite()) {
        return Err(CallError::StartNotFinite { component, found: start.y[component] });
    }
    if !(start.t.is_finite() && end.is_finite()) {
        return Err(CallError::TimeNotFinite { start: start.t, end });
    }
    let limit = shortest_step(start.t.abs().max(end.abs()));
    if (end - start.t).abs() <= limit {
        return Err(CallError::EmptyInterval { start: start.t, end, limit });
    }
    if options.max_steps == 0 {
        return Err(CallError::MaxSteps { found: options.max_steps, limit: 1 });
    }
    Ok(())
}
