//! Time integration, independent of mechanics:
//!
//! ```text
//! y' = F(t, y),   y(t₀) = y₀,        t from t₀ to t₁, forwards or backwards
//! y ∈ Rⁿ,  F: R × Rⁿ → Rⁿ,           J = ∂F/∂y ∈ Rⁿˣⁿ for the implicit methods
//! g_k(t, y(t)) = 0                   events: the first one ends the integration
//! y ∈ M(t)                           an invariant manifold onto which accepted states may be projected
//! ```
//!
//! and boundary values on top of it: constants `c ∈ Rᵏ` in `y₀` such that `r(y(t₁)) = 0`, or `|r|` least.
//!
//! - [`Problem`] is the initial value problem, [`Options`] has method and tolerances, [`integrate`] solves
//!   it.
//! - [`Solution`] has the [`Status`] (how the run ended, which is not an error), the [`DenseOutput`] (the
//!   solution as a function of time), the [`Work`] (steps and evaluations) and the [`ProjectionReport`].
//! - [`shoot`] and [`fit`] solve for constants; [`find_root`] finds roots.
//!
//! All methods share one time loop; a method is a way to attempt a step. A method's order and dense output:
//!
//! | method | order | order of the dense output | for |
//! |---|---|---|---|
//! | [`Method::Taylor`] | from the tolerance: 22 at 1e-9, 29 at 1e-12 | that of the step | smooth non-stiff
//! problems with Taylor series, any accuracy |
//! | [`Method::Dop853`] | 8 | 7 | non-stiff problems, high accuracy |
//! | [`Method::Radau5`] | 5 | 3 | stiff problems, down to tight tolerances |
//! | [`Method::Linked`] | | | those of another crate: [`stepping`] |
//!
//! # What the tolerance means
//! It bounds the estimated error *of one step* (see [`Options`]). The error at the end depends on how the
//! problem amplifies these errors. DOP853's dense output between the ends of the steps is not estimated at
//! all: on smooth problems it is about as good as the ends of the steps; on `y' = y cos t`, where the
//! estimate lets some steps be long, up to 300 times the tolerance has been measured. For a reliable error
//! estimate, take the difference from a second run with a tighter tolerance, at the times at which the
//! solution is wanted.
//!
//! # Events
//! Each accepted step is sampled in eight parts of equal length: a function whose signs at two neighbouring
//! points differ has a root between them, found by Brent's method on the dense output to round-off of θ; the
//! first root of the step ends the run, and the dense output is cut there. So an event is as accurate as the
//! dense output. A function that grows again, with the same sign, after it fell below 1e-17 of its largest
//! value so far has touched zero. A pair of roots (or a touching one) within an eighth of a step can be
//! missed. A function that is exactly zero at the start is ignored until it has a sign, and so is a root
//! within round-off of the start: a run that continues from the event of another one does not stop at once.
//!
//! # Projection
//! With [`Projection::EveryStep`], [`Problem::project`] is applied to each accepted state before it is
//! stored. Dop853 evaluates the rates at the projected state instead of the other one, so that projection
//! costs no evaluation, and the dense output stays continuously differentiable. Taylor continues from the
//! projected state at no cost; the move is added to the last coefficient of the step's polynomial. In each
//! case the order of the method is kept; between the ends of steps the solution is on the manifold to the
//! accuracy of the dense output.
//!
//! # What never happens
//! A NaN or an infinity is never part of a solution: a step with stages, state or rates that are not finite
//! is tried again at half its length, at most 60 times; then the run stops with [`StopCause::NotFinite`].
//! The same holds for [`EvaluationError`]s, with [`StopCause::Evaluation`] and the message of the problem,
//! and for a Taylor step across a point where the rates are not smooth, with [`StopCause::NotSmooth`].
//!
//! # Sources
//! E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., Springer 1993
//! (DOP853, dense output, starting step). Least squares:
//! [`levenberg-marquardt`](https://docs.rs/levenberg-marquardt).

mod boundary;
#[doc(hidden)]
pub mod dense;
#[doc(hidden)]
pub mod divisor_zeros;
mod dop853;
#[doc(hidden)]
pub mod dop853_tableau;
mod error;
mod events;
mod interrupt;
mod lanes;
mod limits;
mod options;
mod problem;
mod radau5;
#[doc(hidden)]
pub mod radau5_tableau;
mod rank;
mod root;
#[doc(hidden)]
pub mod stall_detector;
mod status;
mod step_resolution;
mod stepper;
pub mod stepping;
mod system;
mod taylor;
mod taylor_step;
mod time_loop;

pub use boundary::{AT_ONCE, BoundaryError, Residuals, ShootOptions, Shot, fit, shoot};
pub use dense::DenseOutput;
pub use error::{CallError, DenseError};
pub use events::PARTS;
pub use interrupt::Interrupt;
pub use lanes::{LANES, Lane, LaneProblem, LaneRun, LaneStart, Left, Shortest, integrate_lanes};
pub use options::{Dense, LinkedMethod, Method, Options, Projection};
pub use problem::{EvaluationError, Gauge, Problem, Start};
pub use rank::{cosine, may_lose as may_lose_rank, orthonormal};
pub use root::{find_root, least};
pub use status::{Before, ProjectionReport, Solution, Status, StopCause, Work};
pub use step_resolution::{GAUGE_LIMIT, GAUGE_NODES, gauge_growth};

use stepper::shortest_step;
use system::System;

/// Integrates `y' = F(t, y)` from `start` to `end`, forwards or backwards.
///
/// `Err` is a bad call; how the run ended is [`Solution::status`]. A state or a rate that is NaN or infinite
/// is never part of a solution: the step is halved, and where that does not help, the run stops.
///
/// # Errors
/// See [`CallError`].
pub fn integrate(problem: &mut dyn Problem, start: &Start, end: f64, options: &Options) -> Result<Solution, CallError> {
    check_call(problem.dimension(), start, end, options)?;
    if options.method == Method::Taylor && !problem.has_taylor() {
        return Err(CallError::NoTaylor);
    }
    let stops = options.stops(start.t, end);
    let mut all = between_breakpoints(problem, start, stops[0], options)?;
    for &stop in &stops[1..] {
        if all.status != Status::Completed {
            break;
        }
        let options = Options { before: Some(all.done()), ..options.clone() };
        all.append(between_breakpoints(problem, &all.last(), stop, &options)?);
    }
    Ok(all)
}

fn between_breakpoints(
    problem: &mut dyn Problem,
    start: &Start,
    end: f64,
    options: &Options,
) -> Result<Solution, CallError> {
    let before = options.before.as_ref().map_or(Work::default(), |before| before.work);
    let system = System::new(problem, options.max_step, before);
    Ok(match options.method {
        Method::Taylor => {
            time_loop::drive(&system, taylor::Taylor::new(&system, start, end, options), start, end, options)
        }
        Method::Dop853 => {
            time_loop::drive(&system, dop853::Dop853::new(&system, start, end, options), start, end, options)
        }
        Method::Radau5 => {
            time_loop::drive(&system, radau5::Radau5::new(&system, start, end, options), start, end, options)
        }
        Method::Linked(method) => method.integrate(&system, start, end, options),
    })
}

/// Whether [`integrate`] would take `start`, whose length is that of the problem, `end` and `options`.
///
/// # Errors
/// See [`CallError`].
pub fn check_start(start: &Start, end: f64, options: &Options) -> Result<(), CallError> {
    check_call(start.y.len(), start, end, options)
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
    if !options.sizes.is_empty() && options.sizes.len() != dimension {
        return Err(CallError::Sizes { expected: dimension, found: options.sizes.len() });
    }
    if let Some(component) = options.sizes.iter().position(|size| !(*size > 0.0 && size.is_finite())) {
        return Err(CallError::Size { component, found: options.sizes[component], limit: 0.0 });
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
    if options.max_step.is_nan() || options.max_step <= 0.0 {
        return Err(CallError::MaxStep { found: options.max_step, limit: 0.0 });
    }
    if let Some(i) = options.breakpoints.iter().position(|t| !t.is_finite()) {
        return Err(CallError::Breakpoint { number: i + 1, found: options.breakpoints[i] });
    }
    if options.max_steps == 0 {
        return Err(CallError::MaxSteps { found: options.max_steps, limit: 1 });
    }
    Ok(())
}
