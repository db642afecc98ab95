//! Options of an integration.

use std::fmt;
use std::sync::Arc;

use crate::interrupt::Interrupt;
use crate::limits::HUGE;
use crate::problem::Start;
use crate::status::{Before, Solution};
use crate::stepper::shortest_step;
use crate::system::System;

/// The time-stepping method.
#[derive(Clone, Copy)]
pub enum Method {
    /// Taylor series of an order that follows from the tolerance, dense output of that order; for smooth
    /// non-stiff problems that can be expanded ([`crate::Problem::taylor`]), at any accuracy.
    Taylor,
    /// Dormand and Prince's explicit Runge–Kutta 8(5,3), dense output of order 7; for non-stiff problems.
    Dop853,
    /// Radau IIA of order 5, dense output of order 3, L-stable; for stiff problems, tight tolerances too.
    Radau5,
    /// A method of another crate, such as those of the library diffsol in `diffsol-methods`.
    Linked(&'static dyn LinkedMethod),
}

/// A method that another crate brings along.
pub trait LinkedMethod: Sync {
    /// Its name, as on the command line and in reports; no other method has it.
    fn name(&self) -> &'static str;

    /// As [`Method::order_in_steps`].
    fn order_in_steps(&self) -> f64;

    /// As [`Method::tightest`].
    fn tightest(&self) -> i32;

    /// Whether it asks for [`crate::Problem::jacobian`].
    fn is_implicit(&self) -> bool;

    /// Whether a step continues several before it: then a projection may move a state by what they add up.
    fn is_multistep(&self) -> bool;

    /// Integrates from `start` to `end`, by [`crate::stepping::drive`].
    fn integrate(&self, system: &System, start: &Start, end: f64, options: &Options) -> Solution;
}

impl Method {
    /// The methods of this crate.
    pub const ALL: [Method; 3] = [Method::Taylor, Method::Dop853, Method::Radau5];

    /// Its name, as on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Method::Dop853 => "dop853",
            Method::Taylor => "taylor",
            Method::Radau5 => "radau5",
            Method::Linked(method) => method.name(),
        }
    }

    /// The number of steps grows as `tolerance^(−1/order)` with this order, for a method of variable order at
    /// least with it; [`Method::Taylor`] takes a higher order instead of more steps, and has none.
    pub fn order_in_steps(self) -> Option<f64> {
        match self {
            Method::Taylor => None,
            Method::Dop853 => Some(8.0),
            Method::Radau5 => Some(4.0),
            Method::Linked(method) => Some(method.order_in_steps()),
        }
    }

    /// The tightest tolerance at which its error is worth measuring is `10^(−tightest)`: at tighter ones it
    /// takes too many steps, or measures round-off.
    pub fn tightest(self) -> i32 {
        match self {
            Method::Taylor => 16,
            Method::Dop853 => 15,
            Method::Radau5 => 12,
            Method::Linked(method) => method.tightest(),
        }
    }

    /// Whether the method asks for [`crate::Problem::jacobian`].
    pub fn is_implicit(self) -> bool {
        match self {
            Method::Taylor | Method::Dop853 => false,
            Method::Radau5 => true,
            Method::Linked(method) => method.is_implicit(),
        }
    }

    pub(crate) fn is_multistep(self) -> bool {
        matches!(self, Method::Linked(method) if method.is_multistep())
    }
}

impl PartialEq for Method {
    fn eq(&self, other: &Method) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Method {}

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
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
    pub fn absolute_tolerances(&self, n: usize) -> Vec<f64> {
        let size = |i: usize| self.sizes.get(i).copied().unwrap_or(1.0);
        (0..n).map(|i| self.absolute_tolerance_of(size(i))).collect()
    }

    /// That of a component of this size; a start in the tail of a pulse, at 1e-304 of it, asks for none of
    /// zero.
    pub(crate) fn absolute_tolerance_of(&self, size: f64) -> f64 {
        (self.absolute_tolerance * size).max((HUGE * HUGE).recip())
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
    /// let options = Options { method: Method::Radau5, ..Options::with_tolerance(1e-8) };
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
