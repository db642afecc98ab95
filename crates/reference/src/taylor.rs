//! Taylor series in time of high order, coefficients by the series tape of [`symbolic`] in the wide type.
//!
//! Unknowns' equations `R(z; t, y) = 0` are solved order by order: with the coefficient `z_k` at zero, `R_k`
//! is missing, and `∂R/∂z · z_k` makes up for it, `∂R/∂z` at the step's start. Steps: Jorba & Zou 2005.

use equations::Equations;
use symbolic::{CompileError, Expr, SeriesInput, SeriesTape, SeriesWorkspace};

use crate::instant::Instant;
use crate::limits::SHORTEST;
use crate::{ReferenceError, Wide};

pub(crate) const NAME: &str = "Taylor series";

pub(crate) struct Taylor<T: Wide> {
    tape: SeriesTape,
    workspace: SeriesWorkspace<T>,
    tolerance: f64,
    /// The states at the start of the step.
    y: Vec<T>,
}

impl<T: Wide> Taylor<T> {
    pub(crate) fn new(equations: &Equations, instant: &Instant<T>, tolerance: f64) -> Result<Self, CompileError> {
        let layout = &instant.layout;
        let unknowns = equations.blocks.iter().enumerate().flat_map(|(k, b)| b.unknowns.iter().map(move |_| k));
        let moving = [SeriesInput::Time]
            .into_iter()
            .chain((0..layout.states).map(SeriesInput::State))
            .chain(unknowns.map(SeriesInput::Unknown));
        let kinds = moving.chain(std::iter::repeat(SeriesInput::Steady));
        let inputs: Vec<_> = layout.symbols.iter().copied().zip(kinds).collect();
        let rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        let residuals: Vec<Vec<Expr>> = equations.blocks.iter().map(|b| b.residuals.clone()).collect();
        let tape = equations.graph.compile_series(&inputs, &[], &rates, &residuals, &[], &Default::default())?;
        // −½ ln ε + 1, the order with the least work per unit of time
        let order = (2.0 - 0.5 * tolerance.ln()).ceil() as usize + 1;
        Ok(Taylor { workspace: tape.workspace(order), tape, tolerance, y: Vec::new() })
    }

    /// Integrates to each of `times`, in order; calls `reached` there with the state.
    pub(crate) fn integrate(
        &mut self,
        instant: &mut Instant<T>,
        start: (f64, &[T]),
        times: &[f64],
        mut reached: impl FnMut(&mut Instant<T>, f64, &[T]) -> Result<(), ReferenceError>,
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
            let unknowns = instant.unknowns().to_vec();
            while let [time, later @ ..] = open {
                let ahead = T::from_f64(*time) - t;
                if ahead.to_f64() > step {
                    break;
                }
                reached(instant, *time, &self.evaluate(ahead))?;
                open = later;
            }
            instant.set_guess(&unknowns);
            let step = T::from_f64(step);
            self.y = self.evaluate(step);
            t = t + step;
        }
        Ok(())
    }

    /// Coefficients of the states at `(t, y)`, and of all that they depend on.
    fn expand(&mut self, instant: &mut Instant<T>, t: T) -> Result<(), ReferenceError> {
        instant.solve(t, &self.y)?;
        instant.expand(&self.tape, &mut self.workspace);
        Ok(())
    }

    /// Coefficients of a state, order after order; none but the first if it does not move.
    fn coefficients(&self, state: usize) -> &[T] {
        self.tape.input(1 + state, &self.workspace).unwrap_or(std::slice::from_ref(&self.y[state]))
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
        let order = self.workspace.order();
        for k in order - 2..=order {
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
        let horner = |i: usize| self.coefficients(i).iter().rev().fold(T::zero(), |sum, &c| sum * ahead + c);
        (0..self.y.len()).map(horner).collect()
    }
}
