//! Taylor series in time of high order, coefficients by the series tape of [`symbolic`] in the wide type.
//!
//! Unknowns' equations `R(z; t, y) = 0` are solved order by order: with the coefficient `z_k` at zero, `R_k`
//! is missing, and `∂R/∂z · z_k` makes up for it, `∂R/∂z` at the step's start. Steps: Jorba & Zou 2005.

use equations::{Dynamics, Equations, Real, Series};
use symbolic::CompileError;

use crate::ReferenceError;
use crate::limits::SHORTEST;

pub(crate) const NAME: &str = "Taylor series";

pub(crate) struct Taylor<T: Real> {
    series: Series<T>,
    order: usize,
    tolerance: f64,
    /// The states at the start of the step.
    y: Vec<T>,
    /// Place of the first unknown among the inputs.
    known: usize,
}

impl<T: Real> Taylor<T> {
    pub(crate) fn new(equations: &Equations, tolerance: f64) -> Result<Self, CompileError> {
        // −½ ln ε + 1, the order with the least work per unit of time
        let order = (2.0 - 0.5 * tolerance.ln()).ceil() as usize + 1;
        let known = equations.known_symbols().len();
        Ok(Taylor { series: Series::plain(equations)?, order, tolerance, y: Vec::new(), known })
    }

    /// Integrates to each of `times`, in order; calls `reached` there with the state.
    pub(crate) fn integrate(
        &mut self,
        instant: &mut Dynamics<T>,
        start: (f64, &[T]),
        times: &[f64],
        mut reached: impl FnMut(&mut Dynamics<T>, f64, &[T]) -> Result<(), ReferenceError>,
    ) -> Result<(), ReferenceError> {
        let mut t = T::from_f64(start.0);
        self.y = start.1.to_vec();
        let end = times.last().copied().unwrap_or(start.0);
        let mut open = times;
        while !open.is_empty() {
            self.expand(instant, t)?;
            let step = self.step();
            if step.is_nan() || step <= SHORTEST * t.size().max((end - start.0).abs()) {
                return Err(ReferenceError::Stopped { method: NAME, time: t.to_f64(), step });
            }
            let unknowns = instant.guess().to_vec();
            while let [time, later @ ..] = open {
                let ahead = T::from_f64(*time) - t;
                if ahead.to_f64() > step {
                    break;
                }
                instant.set_guess(&self.unknowns(&unknowns, ahead));
                reached(instant, *time, &self.evaluate(ahead))?;
                open = later;
            }
            let step = T::from_f64(step);
            instant.set_guess(&self.unknowns(&unknowns, step));
            self.y = self.evaluate(step);
            t = t + step;
        }
        Ok(())
    }

    /// Coefficients of the states at `(t, y)`, and of all that they depend on.
    fn expand(&mut self, instant: &mut Dynamics<T>, t: T) -> Result<(), ReferenceError> {
        instant.settle(t, &self.y).map_err(ReferenceError::at(t))?;
        instant.expand(&mut self.series, self.order);
        Ok(())
    }

    /// Coefficients of a state, order after order; none but the first if it does not move.
    fn coefficients(&self, state: usize) -> &[T] {
        self.series.input(1 + state).unwrap_or(std::slice::from_ref(&self.y[state]))
    }

    /// The longest step at which the last terms are under the tolerance.
    fn step(&self) -> f64 {
        let size = |k: usize| {
            let relative = (0..self.y.len()).map(|i| match self.coefficients(i).get(k) {
                Some(c) => c.size() / (1.0 + self.y[i].size()),
                None => 0.0,
            });
            relative.fold(0.0, |worst: f64, x| if x.is_nan() { f64::NAN } else { worst.max(x) })
        };
        let mut step = f64::MAX;
        for k in self.order - 2..=self.order {
            let longest = (self.tolerance / size(k)).powf(1.0 / k as f64);
            if longest.is_nan() {
                return f64::NAN;
            }
            step = step.min(longest);
        }
        // a motion that is a polynomial has no longest step
        step.min(1e6)
    }

    fn evaluate(&self, ahead: T) -> Vec<T> {
        (0..self.y.len()).map(|i| horner(self.coefficients(i), ahead)).collect()
    }

    /// The unknowns of a later instant, for a guess, from those at the start of the step.
    fn unknowns(&self, start: &[T], ahead: T) -> Vec<T> {
        let of = |i: usize| self.series.input(self.known + i).map_or(start[i], |series| horner(series, ahead));
        (0..start.len()).map(of).collect()
    }
}

fn horner<T: Real>(series: &[T], ahead: T) -> T {
    series.iter().rev().fold(T::from_f64(0.0), |sum, &c| sum * ahead + c)
}
