//! Options of an integration.

use std::sync::Arc;

use crate::interrupt::Interrupt;
use crate::status::Before;
use crate::stepper::shortest_step;

/// The time-stepping method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Method {
    /// Taylor series of an order that follows from the tolerance, dense output of that order; for smooth
    /// non-stiff problems that can be expanded ([`crate::Problem::taylor`]), at any accuracy.
    Taylor,
    /// Dormand and Prince's explicit Runge–Kutta 8(5,3), dense output of order 7; for non-stiff problems.
    Dop853,
    /// Tsitouras' explicit Runge–Kutta method of order 5(4) (diffsol).
    Tsit45,
    /// Backward differentiation formulas of variable order 1 to 5 (diffsol); for stiff problems.
    Bdf,
    /// The trapezoidal rule and BDF2 in a step, order 2, L-stable (diffsol); stiff problems, low accuracy.
    TrBdf2,
    /// Singly diagonally implicit Runge–Kutta method of order 3(4), L-stable (diffsol); for stiff problems.
    Esdirk34,
    /// Radau IIA of order 5, dense output of order 3, L-stable; for stiff problems, tight tolerances too.
    Radau5,
}

impl Method {
    /// Every method there is.
    pub const ALL: [Method; 7] =
        [Method::Taylor, Method::Dop853, Method::Tsit45, Method::Radau5, Method::Bdf, Method::TrBdf2, Method::Esdirk34];

    /// Its name, as on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Method::Dop853 => "dop853",
            Method::Taylor => "taylor",
            Method::Tsit45 => "tsit45",
            Method::Bdf => "bdf",
            Method::TrBdf2 => "tr-bdf2",
            Method::Esdirk34 => "esdirk34",
            Method::Radau5 => "radau5",
        }
    }

    /// The number of steps grows as `tolerance^(−1/order)` with this order, for [`Method::Bdf`] at least with
    /// it; [`Method::Taylor`] takes a higher order instead of more steps, and has none.
    pub fn order_in_steps(self) -> Option<f64> {
        match self {
            Method::Taylor => None,
            Method::Dop853 => Some(8.0),
            Method::Tsit45 => Some(5.0),
            Method::Bdf => Some(6.0),
            Method::TrBdf2 => Some(3.0),
            Method::Esdirk34 | Method::Radau5 => Some(4.0),
        }
    }

    /// The feature of this crate that builds the method in; none for one that is always there.
    pub fn feature(self) -> Option<&'static str> {
        match self {
            Method::Taylor | Method::Dop853 | Method::Radau5 => None,
            Method::Tsit45 | Method::Bdf | Method::TrBdf2 | Method::Esdirk34 => Some("diffsol"),
        }
    }

    /// Whether the method is built in; [`crate::integrate`] refuses any other one.
    pub fn is_built_in(self) -> bool {
        self.feature().is_none() || cfg!(feature = "diffsol")
    }

    /// Whether the method asks for [`crate::Problem::jacobian`].
    pub fn is_implicit(self) -> bool {
        matches!(self, Method::Bdf | Method::TrBdf2 | Method::Esdirk34 | Method::Radau5)
    }
}

/// Whether accepted states are moved back onto the invariant manifold ([`crate::Problem::project`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Projection {
    /// After each accepted step.
    EveryStep,
    /// Never.
    Off,
}

/// The stored part of the solution between its ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Dense {
    /// One polynomial per step. [`Method::Dop853`] needs three more evaluations per step for it.
    Everywhere,
    /// Only the two end points.
    EndOnly,
}

/// Method, tolerances and limits of an integration.
///
/// The local error `e` of a step is kept below `|e_i| ≤ absolute · size_i + relative · max(|y_i|, |y_i,new|)`
/// in the root mean square over the components.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The time-stepping method.
    pub method: Method,
    /// Tolerance relative to each component of the state; > 0. [`Method::Dop853`] reads what is below 2e-15,
    /// where its error estimate measures round-off, as 2e-15.
    pub relative_tolerance: f64,
    /// Tolerance in the state's own units; > 0.
    pub absolute_tolerance: f64,
    /// Factors of the absolute tolerance, one per component, each > 0; empty: all 1. Small components have
    /// small errors only if their size is given here.
    pub sizes: Vec<f64>,
    /// Whether accepted states are projected.
    pub projection: Projection,
    /// Limit on the number of attempted (accepted and rejected) steps, those before too; > 0.
    pub max_steps: usize,
    /// The run is given up where the rest needs more attempts than this, at the pace of its last 500.
    pub patience: f64,
    /// No step is longer; > 0, infinite without a limit.
    pub max_step: f64,
    /// Times at which a step ends, in any order, where the method begins anew: those within the run.
    pub breakpoints: Vec<f64>,
    /// The stored part between the ends.
    pub dense: Dense,
    /// Times at which the solution is wanted, ascending: if the steps of a run take more than 2 MB, only
    /// steps that contain one of these times are stored. `None`: all steps are.
    pub wanted: Option<Arc<[f64]>>,
    /// The flag that ends the run, with its cause ([`Interrupt::cause`]); looked at before each attempt.
    pub interrupt: Option<Interrupt>,
    /// Counters of the previous run, if this one continues it ([`crate::Solution::done`]).
    pub before: Option<Before>,
}

impl Options {
    /// The absolute tolerance of each of `n` components.
    pub(crate) fn absolute_tolerances(&self, n: usize) -> Vec<f64> {
        let size = |i: usize| self.sizes.get(i).copied().unwrap_or(1.0);
        (0..n).map(|i| self.absolute_tolerance_of(size(i))).collect()
    }

    /// That of a component of this size; a start in the tail of a pulse, at 1e-304 of it, asks for none of
    /// zero.
    pub(crate) fn absolute_tolerance_of(&self, size: f64) -> f64 {
        const LEAST: f64 = 1e-200;
        (self.absolute_tolerance * size).max(LEAST)
    }

    /// The breakpoints on the way from `start` to `end`, and `end`.
    pub(crate) fn stops(&self, start: f64, end: f64) -> Vec<f64> {
        let direction = (end - start).signum();
        let mut stops = self.breakpoints.clone();
        stops.sort_by(|a, b| (direction * a).total_cmp(&(direction * b)));
        let mut last = start;
        let room = |a: f64, b: f64| (b - a) * direction > shortest_step(start.abs().max(end.abs()));
        stops.retain(|&t| {
            let keep = room(last, t) && room(t, end);
            last = if keep { t } else { last };
            keep
        });
        stops.push(end);
        stops
    }

    /// [`Method::Dop853`], both tolerances equal, projection after each step, dense output, ≤ 100 000 steps.
    ///
    /// ```
    /// use integrate::{Method, Options};
    /// let options = Options { method: Method::Bdf, ..Options::with_tolerance(1e-8) };
    /// assert_eq!(options.relative_tolerance, options.absolute_tolerance);
    /// ```
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            method: Method::Dop853,
            relative_tolerance: tolerance,
            absolute_tolerance: tolerance,
            sizes: Vec::new(),
            projection: Projection::EveryStep,
            max_steps: 100_000,
            patience: f64::INFINITY,
            max_step: f64::INFINITY,
            breakpoints: Vec::new(),
            dense: Dense::Everywhere,
            wanted: None,
            interrupt: None,
            before: None,
        }
    }
}
