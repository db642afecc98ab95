//! Time-stepping methods of the library [`diffsol`](https://docs.rs/diffsol), for [`integrate`]:
//!
//! | method | order | order of the dense output | for |
//! |---|---|---|---|
//! | [`TSIT45`] | 5 | 4 | non-stiff problems, low accuracy |
//! | [`BDF`] | 1 to 5 | that of the step | stiff problems |
//! | [`TR_BDF2`] | 2 | 2 | stiff problems, low accuracy |
//! | [`ESDIRK34`] | 3 | 3 | stiff problems |
//!
//! diffsol attempts the steps; events, projection, checks and dense output are those of our time loop. A
//! crate of its own, because diffsol brings fifty others: who does not name these methods compiles none.
//!
//! Where states are projected, all but [`BDF`] continue from the projected state, at one evaluation per step.
//! [`BDF`] uses several previous steps and would have to restart, so that its own solution is left
//! unprojected until the projection moves the state by more than 1000 tolerances; stored states are always
//! projected.
//!
//! ```
//! use integrate::{EvaluationError, Options, Problem, Start, integrate};
//!
//! /// y' = −1000 (y − cos t).
//! struct Stiff;
//! impl Problem for Stiff {
//!     fn dimension(&self) -> usize { 1 }
//!     fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
//!         rates[0] = -1e3 * (y[0] - t.cos());
//!         Ok(())
//!     }
//!     fn jacobian(&mut self, _t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
//!         jacobian[0] = -1e3;
//!         Ok(())
//!     }
//! }
//!
//! let options = Options { method: diffsol_methods::BDF, ..Options::with_tolerance(1e-8) };
//! let solution = integrate(&mut Stiff, &Start { t: 0.0, y: vec![1.0] }, 2.0, &options).unwrap();
//! // on the slow solution y = (10⁶ cos t + 10³ sin t)/(10⁶ + 1)
//! let exact = (1e6 * f64::cos(2.0) + 1e3 * f64::sin(2.0)) / (1e6 + 1.0);
//! assert!((solution.dense.end_state()[0] - exact).abs() < 1e-6 && solution.work.steps < 200);
//! ```

mod stepper;

use integrate::stepping::System;
use integrate::{LinkedMethod, Method, Options, Solution, Start};

use stepper::Diffsol;

/// Tsitouras' explicit Runge–Kutta method of order 5(4).
pub const TSIT45: Method = Method::Linked(&Diffsol::Tsit45);
/// Backward differentiation formulas of variable order 1 to 5.
pub const BDF: Method = Method::Linked(&Diffsol::Bdf);
/// The trapezoidal rule and BDF2 in a step, order 2, L-stable.
pub const TR_BDF2: Method = Method::Linked(&Diffsol::TrBdf2);
/// Singly diagonally implicit Runge–Kutta method of order 3(4), L-stable.
pub const ESDIRK34: Method = Method::Linked(&Diffsol::Esdirk34);

/// Every method: those of [`integrate`] and those here, explicit ones first.
pub const EVERY: [Method; 7] = [Method::Taylor, Method::Dop853, TSIT45, Method::Radau5, BDF, TR_BDF2, ESDIRK34];

impl LinkedMethod for Diffsol {
    fn name(&self) -> &'static str {
        match self {
            Diffsol::Tsit45 => "tsit45",
            Diffsol::Bdf => "bdf",
            Diffsol::TrBdf2 => "tr-bdf2",
            Diffsol::Esdirk34 => "esdirk34",
        }
    }

    fn order_in_steps(&self) -> f64 {
        match self {
            Diffsol::Tsit45 => 5.0,
            Diffsol::Bdf => 6.0,
            Diffsol::TrBdf2 => 3.0,
            Diffsol::Esdirk34 => 4.0,
        }
    }

    fn tightest(&self) -> i32 {
        match self {
            Diffsol::Tsit45 => 13,
            Diffsol::TrBdf2 => 8,
            Diffsol::Bdf | Diffsol::Esdirk34 => 11,
        }
    }

    fn is_implicit(&self) -> bool {
        *self != Diffsol::Tsit45
    }

    fn is_multistep(&self) -> bool {
        *self == Diffsol::Bdf
    }

    fn integrate(&self, system: &System, start: &Start, end: f64, options: &Options) -> Solution {
        stepper::run(*self, system, start, end, options)
    }
}
