//! The initial value problem as a trait.

use thiserror::Error;

/// An initial-value problem's right-hand side, with what belongs to it: Jacobian, projection, events.
///
/// ```text
/// y' = F(t, y),   y ∈ Rⁿ,   J(t, y) = ∂F/∂y (n×n, row-major),   g_k(t, y) = 0: event k
/// ```
///
/// All methods take `&mut self`, so that an implementation may keep work space. For equations
/// `W(t, y) y' = F` the caller factorises `W` inside [`rates`](Problem::rates) and hands over `y'` (the
/// library behind the implicit methods takes no mass matrix that depends on the state).
///
/// # Examples
/// ```
/// use integrate::{EvaluationError, Options, Problem, Start, integrate};
///
/// struct Oscillator;
/// impl Problem for Oscillator {
///     fn dimension(&self) -> usize { 2 }
///     fn rates(&mut self, _t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
///         rates[0] = y[1];
///         rates[1] = -y[0];
///         Ok(())
///     }
///     fn jacobian(&mut self, _t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
///         jacobian.copy_from_slice(&[0.0, 1.0, -1.0, 0.0]);
///         Ok(())
///     }
/// }
///
/// let start = Start { t: 0.0, y: vec![1.0, 0.0] };
/// let solution = integrate(&mut Oscillator, &start, 1.0, &Options::with_tolerance(1e-12)).unwrap();
/// let mut y = [0.0; 2];
/// solution.dense.evaluate(0.5, &mut y);
/// assert!((y[0] - 0.5f64.cos()).abs() < 1e-11);
/// ```
pub trait Problem {
    /// The number n of unknowns.
    fn dimension(&self) -> usize;

    /// Writes `F(t, y)`; `y` and `rates` have length n.
    ///
    /// # Errors
    /// [`EvaluationError`] where `F` is not defined. The integration then tries shorter steps, then stops.
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError>;

    /// Writes `∂F/∂y(t, y)`, row-major: `jacobian[i * n + j] = ∂F_i/∂y_j`. Only implicit methods ask for it.
    ///
    /// # Errors
    /// [`EvaluationError`] where it is not defined, and always where a problem does not say what it is.
    fn jacobian(&mut self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        Err(EvaluationError { reason: "the problem has no Jacobian".into() })
    }

    /// Whether [`taylor`](Problem::taylor) is there, which [`crate::Method::Taylor`] asks for.
    fn has_taylor(&self) -> bool {
        false
    }

    /// Writes coefficients of the solution through `(t, y)`, component by component, as far as there is room:
    ///
    /// ```text
    /// y_i(t + τ) = Σ_k coefficients[i m + k] (τ/unit)^k,  k = 0 … m − 1,  m = coefficients.len()/n, unit > 0
    /// ```
    ///
    /// A coefficient that overflows may be written as such.
    ///
    /// # Errors
    /// [`EvaluationError`] where `F` is not defined, and without [`has_taylor`](Problem::has_taylor).
    fn taylor(&mut self, _t: f64, _y: &[f64], _unit: f64, _coefficients: &mut [f64]) -> Result<(), EvaluationError> {
        Err(EvaluationError { reason: "the problem has no Taylor series".into() })
    }

    /// Moves `y` onto the invariant manifold, if any; returns the Euclidean length of the move (or 0).
    ///
    /// # Errors
    /// [`EvaluationError`] where no near point of the manifold was found. The step is retried, shorter.
    fn project(&mut self, _t: f64, _y: &mut [f64]) -> Result<f64, EvaluationError> {
        Ok(0.0)
    }

    /// Called with every accepted state, in order, except the start: later evaluations may start from it.
    ///
    /// # Errors
    /// [`EvaluationError`] where the state is not acceptable after all. The step is retried, shorter.
    fn accepted(&mut self, _t: f64, _y: &[f64]) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// The number of event functions; where one changes its sign or touches zero, the integration ends.
    fn events(&self) -> usize {
        0
    }

    /// Gauges `w` of functions `F(x)` in the equations that may change within little of their arguments
    /// `x(t, y)`: no step is taken along which a gauge grows by more than 4, however little the method sees
    /// of `F`. So nothing that is switched on and off between two evaluations is passed over.
    fn gauges(&self) -> &[Gauge] {
        &[]
    }

    /// The highest power, from 20 on, of a quantity without bounds in the equations; 0 where there is none.
    /// It may be nothing at both ends of a step, to all orders looked at: such steps are checked inside.
    fn highest_power(&self) -> f64 {
        0.0
    }

    /// Writes the arguments `x(t, y)` of the [`gauges`](Problem::gauges).
    ///
    /// # Errors
    /// [`EvaluationError`] where they are not defined. The step is retried, shorter.
    fn gauged(&mut self, _t: f64, _y: &[f64], _arguments: &mut [f64]) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// The sum of magnitudes behind each argument; round-off is proportional to it.
    ///
    /// # Errors
    /// As [`gauged`](Problem::gauged).
    fn terms_of_gauged(&mut self, _t: f64, _y: &[f64], terms: &mut [f64]) -> Result<(), EvaluationError> {
        terms.fill(0.0);
        Ok(())
    }

    /// The number of divisors in the equations that may vanish. A step along which one changes its sign or
    /// comes near zero is looked at there, as what is divided may be so small that it is seen nowhere else.
    fn divisors(&self) -> usize {
        0
    }

    /// Writes the values of the [`divisors`](Problem::divisors).
    ///
    /// # Errors
    /// [`EvaluationError`] where they are not defined. The step is retried, shorter.
    fn divided(&mut self, _t: f64, _y: &[f64], _values: &mut [f64]) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// Rows h and columns n of a matrix `B(t, y)` that has rank h along every solution: where it has not,
    /// several solutions go on, or none, and the integration ends. `(0, 0)` where there is none.
    fn rank(&self) -> (usize, usize) {
        (0, 0)
    }

    /// Writes `B(t, y)`, row-major, all of whose columns are in one unit.
    ///
    /// # Errors
    /// [`EvaluationError`] where it is not defined. The step is retried, shorter.
    fn rows(&mut self, _t: f64, _y: &[f64], _entries: &mut [f64]) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// The sum of magnitudes behind each rate; round-off is proportional to it. Called only where rates
    /// differ from the slope of a step's polynomial.
    ///
    /// # Errors
    /// [`EvaluationError`] where it is not defined. The step is retried, shorter.
    fn terms_of_rates(&mut self, _t: f64, _y: &[f64], terms: &mut [f64]) -> Result<(), EvaluationError> {
        terms.fill(0.0);
        Ok(())
    }

    /// Writes the event functions' values `g_k(t, y)`; `values` has length [`events`](Problem::events).
    ///
    /// # Errors
    /// [`EvaluationError`] where they are not defined.
    fn event_values(&mut self, _t: f64, _y: &[f64], _values: &mut [f64]) -> Result<(), EvaluationError> {
        Ok(())
    }
}

/// A monotone function of an argument: where it grows by 1, a function of the argument changes by about its
/// own size, and where it is constant that hardly changes. For `tanh x`: `x` between −20 and 20.
pub type Gauge = fn(f64) -> f64;

/// `F` (or its Jacobian, the projection, an event function) could not be evaluated here.
///
/// `reason` is the problem's own words, with the measured value and the limit:
/// "mass matrix singular: reciprocal condition 3e-17, limit 1e-14".
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{reason}")]
pub struct EvaluationError {
    /// The problem's own words.
    pub reason: String,
}

/// A point on the time axis and the state there: integration runs from `t` to `end`, forwards or backwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Start time.
    pub t: f64,
    /// State at the start, of length [`Problem::dimension`].
    pub y: Vec<f64>,
}
