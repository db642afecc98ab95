//! The problem as the steppers and the time loop see it: every call counted, every value checked.

use std::cell::RefCell;

use crate::problem::{EvaluationError, Gauge, Problem};
use crate::status::{StopCause, Work};

/// Why a step could not be taken, though a shorter one may be possible.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the messages of StopCause say what fields are")]
pub enum Failure {
    /// [`StopCause::Evaluation`].
    Evaluation { reason: String },
    /// [`StopCause::NotFinite`].
    NotFinite { component: usize },
    /// [`StopCause::NotSmooth`].
    NotSmooth { component: usize },
    /// [`StopCause::OffConstraint`].
    OffConstraint { component: usize },
    /// A function changes within less than the step.
    Steep { t: f64 },
    /// The argument of a function has more round-off than the function changes within.
    Blurred { t: f64 },
    /// A divisor vanishes within the step.
    Pole { t: f64 },
}

impl From<EvaluationError> for Failure {
    fn from(error: EvaluationError) -> Self {
        Failure::Evaluation { reason: error.reason }
    }
}

impl From<Failure> for StopCause {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Evaluation { reason } => StopCause::Evaluation { reason },
            Failure::NotFinite { component } => StopCause::NotFinite { component },
            Failure::NotSmooth { component } => StopCause::NotSmooth { component },
            Failure::OffConstraint { component } => StopCause::OffConstraint { component },
            Failure::Pole { t } => {
                let reason = format!("a divisor in the equations vanishes or nearly so within a step near t = {t}");
                StopCause::Evaluation { reason }
            }
            Failure::Blurred { t } => {
                let reason = format!(
                    "the argument of a function in the equations has more round-off near t = {t} than the function \
                     changes within: it is too narrow for its place"
                );
                StopCause::Evaluation { reason }
            }
            Failure::Steep { t } => {
                let reason = format!("a function in the equations changes within less than a step near t = {t}");
                StopCause::Evaluation { reason }
            }
        }
    }
}

/// Refuses values that are NaN or infinite.
///
/// # Errors
/// [`Failure::NotFinite`] with the first of them.
pub fn check_finite(values: &[f64]) -> Result<(), Failure> {
    // 0 · x is 0 for finite x and NaN otherwise: one pass without branches, in sums that run side by side.
    let (groups, rest) = values.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for group in groups.iter().map(|g| &g[..]).chain([rest]) {
        for (sum, x) in sums.iter_mut().zip(group) {
            *sum += 0.0 * x;
        }
    }
    if sums.iter().sum::<f64>() == 0.0 {
        return Ok(());
    }
    let component = values.iter().position(|x| !x.is_finite()).unwrap_or(0);
    Err(Failure::NotFinite { component })
}

/// A problem, shared by the time loop and the stepper: every call is counted, every value checked. The
/// interior mutability serves libraries whose closures are `Fn`.
pub struct System<'p> {
    /// No step is longer.
    pub(crate) longest: f64,
    dimension: usize,
    events: usize,
    inner: RefCell<Inner<'p>>,
}

struct Inner<'p> {
    problem: &'p mut dyn Problem,
    work: Work,
    /// The first failure inside a callback that cannot return one; those after it may follow from its NaN.
    failure: Option<Failure>,
    /// Why there is no Jacobian, as long as there is none.
    no_jacobian: Option<Failure>,
    /// The point at which `jacobian` was evaluated; empty `y`: nowhere yet.
    jacobian_t: f64,
    jacobian_y: Vec<f64>,
    jacobian: Vec<f64>,
}

impl<'p> System<'p> {
    /// With steps of at most this length, and the work done before.
    pub(crate) fn new(problem: &'p mut dyn Problem, longest: f64, work: Work) -> Self {
        Self {
            longest,
            dimension: problem.dimension(),
            events: problem.events(),
            inner: RefCell::new(Inner {
                problem,
                work,
                failure: None,
                no_jacobian: None,
                jacobian_t: f64::NAN,
                jacobian_y: Vec::new(),
                jacobian: Vec::new(),
            }),
        }
    }

    /// The number of unknowns.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    pub(crate) fn events(&self) -> usize {
        self.events
    }

    pub(crate) fn work(&self) -> Work {
        self.inner.borrow().work
    }

    pub(crate) fn count_step(&self) {
        self.inner.borrow_mut().work.steps += 1;
    }

    /// Counts attempts that came to nothing.
    pub fn count_rejected(&self, attempts: usize) {
        self.inner.borrow_mut().work.rejected += attempts;
    }

    /// F(t, y).
    ///
    /// # Errors
    /// Where the problem has none, or one that is not finite.
    pub fn rates(&self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        let inner = &mut *self.inner.borrow_mut();
        inner.work.evaluations += 1;
        inner.problem.rates(t, y, rates)?;
        check_finite(rates)
    }

    /// Coefficients of the solution through `(t, y)`, finite or an error.
    pub(crate) fn taylor(
        &self,
        t: f64,
        y: &[f64],
        unit: f64,
        order: usize,
        coefficients: &mut [f64],
    ) -> Result<(), Failure> {
        let inner = &mut *self.inner.borrow_mut();
        inner.work.evaluations += 1;
        inner.work.orders += order;
        inner.problem.taylor(t, y, unit, coefficients)?;
        check_finite(coefficients).map_err(|failure| match failure {
            Failure::NotFinite { component } => Failure::NotFinite { component: component / (order + 1) },
            other => other,
        })
    }

    /// F(t, y) for callers without errors: a failure is kept for [`System::take_failure`], NaN is written.
    pub fn rates_or_nan(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        if let Err(failure) = check_finite(y).and_then(|()| self.rates(t, y, rates)) {
            self.inner.borrow_mut().failure.get_or_insert(failure);
            rates.fill(f64::NAN);
        }
    }

    /// ∂F/∂y(t, y), row-major, finite or an error.
    pub(crate) fn jacobian(&self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        let inner = &mut *self.inner.borrow_mut();
        if let Err(failure) = inner.evaluate_jacobian(t, y) {
            inner.jacobian_y.clear();
            return Err(failure);
        }
        jacobian.copy_from_slice(&inner.jacobian);
        Ok(())
    }

    /// `product = ∂F/∂y(t, y) · v`. The matrix is evaluated once a point, for any number of products.
    pub fn jacobian_product_or_nan(&self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) {
        let inner = &mut *self.inner.borrow_mut();
        if let Err(failure) = inner.evaluate_jacobian(t, y) {
            inner.no_jacobian = Some(failure);
            inner.jacobian_y.clear();
            product.fill(f64::NAN);
            return;
        }
        inner.no_jacobian = None;
        for (row, p) in inner.jacobian.chunks_exact(y.len()).zip(product) {
            *p = row.iter().zip(v).map(|(j, v)| j * v).sum();
        }
    }

    /// Why the last values that are NaN are so.
    pub fn take_failure(&self) -> Option<Failure> {
        let inner = &mut *self.inner.borrow_mut();
        let failure = inner.failure.take();
        inner.no_jacobian.clone().or(failure)
    }

    /// Projects `y`; returns the length of the move.
    pub(crate) fn project(&self, t: f64, y: &mut [f64]) -> Result<f64, Failure> {
        let moved = self.inner.borrow_mut().problem.project(t, y)?;
        check_finite(y)?;
        if moved.is_finite() {
            Ok(moved)
        } else {
            Err(Failure::Evaluation { reason: format!("the projection at t = {t} reports a move of length {moved}") })
        }
    }

    /// Tells the problem that `y` is accepted.
    pub(crate) fn accepted(&self, t: f64, y: &[f64]) -> Result<(), Failure> {
        Ok(self.inner.borrow_mut().problem.accepted(t, y)?)
    }

    pub(crate) fn highest_power(&self) -> f64 {
        self.inner.borrow().problem.highest_power()
    }

    pub(crate) fn gauges(&self) -> Vec<Gauge> {
        self.inner.borrow().problem.gauges().to_vec()
    }

    pub(crate) fn gauged(&self, t: f64, y: &[f64], arguments: &mut [f64]) -> Result<(), Failure> {
        self.inner.borrow_mut().problem.gauged(t, y, arguments)?;
        match arguments.iter().any(|x| x.is_nan()) {
            true => Err(Failure::Evaluation { reason: format!("the argument of a function is NaN at t = {t}") }),
            false => Ok(()),
        }
    }

    pub(crate) fn terms_of_gauged(&self, t: f64, y: &[f64], terms: &mut [f64]) -> Result<(), Failure> {
        Ok(self.inner.borrow_mut().problem.terms_of_gauged(t, y, terms)?)
    }

    pub(crate) fn divisors(&self) -> usize {
        self.inner.borrow().problem.divisors()
    }

    pub(crate) fn divided(&self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.inner.borrow_mut().problem.divided(t, y, values)?;
        match values.iter().any(|x| x.is_nan()) {
            true => Err(Failure::Evaluation { reason: format!("a divisor is NaN at t = {t}") }),
            false => Ok(()),
        }
    }

    pub(crate) fn terms_of_rates(&self, t: f64, y: &[f64], terms: &mut [f64]) -> Result<(), Failure> {
        Ok(self.inner.borrow_mut().problem.terms_of_rates(t, y, terms)?)
    }

    pub(crate) fn rank(&self) -> (usize, usize) {
        self.inner.borrow().problem.rank()
    }

    pub(crate) fn rows(&self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        self.inner.borrow_mut().problem.rows(t, y, entries)?;
        match entries.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => {
                Err(Failure::Evaluation { reason: format!("a row of the constraints is NaN or infinite at t = {t}") })
            }
        }
    }

    pub(crate) fn event_values(&self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.inner.borrow_mut().problem.event_values(t, y, values)?;
        match values.iter().position(|g| !g.is_finite()) {
            None => Ok(()),
            Some(index) => {
                Err(Failure::Evaluation { reason: format!("event function {index} is {} at t = {t}", values[index]) })
            }
        }
    }
}

impl Inner<'_> {
    fn evaluate_jacobian(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        check_finite(y)?;
        if self.jacobian_t == t && self.jacobian_y == y {
            return Ok(());
        }
        self.jacobian_t = t;
        self.jacobian_y.clear();
        self.jacobian_y.extend_from_slice(y);
        self.jacobian.resize(y.len() * y.len(), 0.0);
        self.work.jacobians += 1;
        self.problem.jacobian(t, y, &mut self.jacobian)?;
        check_finite(&self.jacobian).map_err(|_| Failure::Evaluation {
            reason: format!("the Jacobian has an entry that is NaN or infinite at t = {t}"),
        })
    }
}
