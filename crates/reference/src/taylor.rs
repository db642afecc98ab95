//! Taylor series in time of high order, from the residuals of the instant themselves.
//!
//! The equations `R(z; t, y) = 0` are solved order by order: with the coefficient `z_k` left at zero, coefficient `k` of `R` is what is missing, and
//! `∂R/∂z · z_k` has to make up for it, with `∂R/∂z` at the start of the step. Order and step as in Jorba & Zou 2005.

use symbolic::{CompileError, Expr};

use equations::Equations;

use crate::instant::Instant;
use crate::series::{Part, Series};
use crate::trace::{Node, Traced, record};
use crate::{ReferenceError, Wide};

/// Shortest step, relative to the time.
const SHORTEST: f64 = 1e-12;

pub(crate) const NAME: &str = "Taylor series";

pub(crate) struct Taylor<T> {
    series: Series<T>,
    /// Residuals, block after block, and rates.
    residuals: Vec<Node>,
    blocks: Vec<usize>,
    rates: Vec<Node>,
    order: usize,
    tolerance: f64,
    /// Coefficient `k` of all inputs of the tapes.
    inputs: Vec<Vec<T>>,
}

impl<T: Wide> Taylor<T> {
    pub(crate) fn new(equations: &Equations, instant: &Instant<T>, tolerance: f64) -> Result<Self, CompileError> {
        let layout = &instant.layout;
        let rates = equations.states.iter().map(|y| y.rate);
        let residuals = equations.blocks.iter().flat_map(|b| b.residuals.iter().copied());
        let outputs: Vec<Expr> = residuals.chain(rates).collect();
        let tape = layout.compile(equations, &outputs)?;
        let (operations, nodes) = record(|| {
            let inputs: Vec<Traced> = (0..tape.inputs()).map(Traced::input).collect();
            let mut outputs = vec![inputs[0]; tape.outputs()];
            tape.evaluate(&inputs, &mut tape.workspace(), &mut outputs);
            outputs.into_iter().map(|node| node.0).collect::<Vec<Node>>()
        });
        // −½ ln ε + 1, the order with the least work per unit of time
        let order = (2.0 - 0.5 * tolerance.ln()).ceil() as usize + 1;
        let unknowns = 1 + layout.states..1 + layout.states + layout.unknowns;
        let series = Series::new(operations, order + 1, |i| unknowns.contains(&i), |i| i >= unknowns.end);
        Ok(Taylor {
            series,
            residuals: nodes[..layout.unknowns].to_vec(),
            rates: nodes[layout.unknowns..].to_vec(),
            blocks: equations.blocks.iter().map(|b| b.unknowns.len()).collect(),
            order,
            tolerance,
            inputs: vec![vec![T::zero(); layout.symbols.len()]; order + 1],
        })
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
        let mut y = start.1.to_vec();
        let end = times.last().copied().unwrap_or(start.0);
        let mut open = times;
        while !open.is_empty() {
            self.expand(instant, t, &y)?;
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
            y = self.evaluate(step);
            t = t + step;
        }
        Ok(())
    }

    /// Coefficients of the states at `(t, y)`.
    fn expand(&mut self, instant: &mut Instant<T>, t: T, y: &[T]) -> Result<(), ReferenceError> {
        let factors = instant.solve(t, y)?;
        let (states, unknowns) = (y.len(), self.residuals.len());
        let fixed = 1 + states + unknowns;
        let input = &mut self.inputs[0];
        input[0] = t;
        input[1..=states].copy_from_slice(y);
        input[1 + states..fixed].copy_from_slice(instant.unknowns());
        for (x, &value) in input[fixed..].iter_mut().zip(&instant.layout.fixed) {
            *x = T::from_f64(value);
        }
        self.inputs[1][0] = T::from_f64(1.0);
        for k in 0..self.order {
            self.inputs[k][1 + states..fixed].fill(T::zero());
            if k == 0 {
                self.inputs[0][1 + states..fixed].copy_from_slice(instant.unknowns());
            }
            self.series.advance(k, Part::All, |place| self.inputs[k][place]);
            let mut first = 0;
            for (&size, factors) in self.blocks.iter().zip(&factors).take(if k == 0 { 0 } else { usize::MAX }) {
                let missing: Vec<T> =
                    self.residuals[first..first + size].iter().map(|&r| self.series.at(r, k)).collect();
                for (i, x) in factors.solve(&missing).into_iter().enumerate() {
                    self.inputs[k][1 + states + first + i] = -x;
                }
                self.series.advance(k, Part::ByUnknown, |place| self.inputs[k][place]);
                first += size;
            }
            let next = T::from_ratio(1, k as i64 + 1);
            for (i, &rate) in self.rates.iter().enumerate() {
                self.inputs[k + 1][1 + i] = self.series.at(rate, k) * next;
            }
        }
        Ok(())
    }

    /// The longest step at which the last terms are under the tolerance.
    fn step(&self) -> f64 {
        let states = self.rates.len();
        let size = |k: usize| {
            let relative = (1..=states).map(|i| self.inputs[k][i].size() / (1.0 + self.inputs[0][i].size()));
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
        let coefficient = |i: usize, k: usize| self.inputs[k][1 + i];
        let horner =
            |i: usize| (0..self.order).rev().fold(coefficient(i, self.order), |sum, k| sum * ahead + coefficient(i, k));
        (0..self.rates.len()).map(horner).collect()
    }
}
