//! Newton's method for one step, without allocation. If it does not converge quickly, the step is refused as
//! too long: a distant root belongs to another motion.

use std::collections::HashMap;

use mechanics::linear::Factors;
use symbolic::limits::{CONTRACTION, HALF_THE_DIGITS, ITERATIONS, LAST_DIGITS};
use symbolic::{Evaluator, Expr, Graph, Symbol};

use crate::DiscreteError;

/// What corrections under this part of the unknowns lead to is near.
const FAR: f64 = 1e-2;

/// As many equations as unknowns, the unknowns being the last inputs.
#[derive(Clone, Debug)]
pub(crate) struct Iteration {
    pub(crate) inputs: Vec<f64>,
    /// Residuals, then their Jacobian row by row.
    program: Evaluator<f64>,
    factors: Factors,
    correction: Vec<f64>,
    /// Whether one correction solves the equations.
    linear: bool,
    /// Rates come first, then multipliers; the two have units of their own.
    rates: usize,
    /// The least sizes of either that corrections are compared with.
    floor: [f64; 2],
}

impl Iteration {
    /// `residuals` in the last of `inputs`: `rates`, then multipliers. `guess` has their sizes.
    pub(crate) fn new(
        g: &Graph,
        inputs: &[Symbol],
        residuals: &[Expr],
        parameters: &HashMap<Symbol, f64>,
        guess: &[f64],
        rates: usize,
    ) -> Result<Self, DiscreteError> {
        let count = residuals.len();
        let unknowns = &inputs[inputs.len() - count..];
        let jacobian = g.jacobian(residuals, unknowns);
        let linear = !jacobian.entries().iter().any(|&e| unknowns.iter().any(|&z| g.depends_on(e, z)));
        let outputs = [residuals, jacobian.entries()].concat();
        let floor = |values: &[f64]| Some(largest(values)).filter(|&x| x > 0.0).unwrap_or(1.0);
        Ok(Iteration {
            inputs: vec![0.0; inputs.len()],
            program: Evaluator::new(g.compile(inputs, &outputs, parameters)?),
            factors: Factors::new(count),
            correction: vec![0.0; count],
            linear,
            rates,
            floor: [floor(&guess[..rates]), floor(&guess[rates..])],
        })
    }

    /// Solves from the unknowns that stand in `inputs`, and leaves the solution there. `t` is for errors.
    pub(crate) fn solve(&mut self, t: f64) -> Result<(), DiscreteError> {
        let count = self.correction.len();
        let first = self.inputs.len() - count;
        let (mut before, mut found) = (f64::INFINITY, f64::INFINITY);
        for iterations in 1..=ITERATIONS {
            let outputs = self.program.evaluate(&self.inputs);
            check_finite("an equation of a step", t, &outputs[..count])?;
            let (residuals, jacobian) = outputs.split_at(count);
            self.factors.factorize(jacobian).map_err(|_| DiscreteError::Singular { t })?;
            self.correction.copy_from_slice(residuals);
            self.factors.solve(&mut self.correction);
            check_finite("a correction", t, &self.correction)?;
            let impulses = impulses(jacobian, &self.inputs[first..], &self.correction, self.rates);
            let unknowns = &mut self.inputs[first..];
            for (z, change) in unknowns.iter_mut().zip(&self.correction) {
                *z -= change;
            }
            found = self.relative_correction(first);
            // of a quadratically convergent sequence the next term is found · (found / before)²; under the
            // last digit it is not noticed
            let next = found * (found / before).powi(2);
            if self.linear || found <= LAST_DIGITS || (before.is_finite() && next <= f64::EPSILON) {
                return Ok(());
            }
            let shrinks = found < CONTRACTION * before;
            if !shrinks && found <= HALF_THE_DIGITS {
                return Ok(());
            }
            if !shrinks && self.of_rates(first).max(impulses) > FAR {
                return Err(DiscreteError::NotConverged { t, iterations, found, limit: LAST_DIGITS });
            }
            before = found;
        }
        Err(DiscreteError::NotConverged { t, iterations: ITERATIONS, found, limit: LAST_DIGITS })
    }

    fn relative_correction(&self, first: usize) -> f64 {
        let multipliers = largest(&self.inputs[first + self.rates..]).max(self.floor[1]);
        self.of_rates(first).max(largest(&self.correction[self.rates..]) / multipliers)
    }

    fn of_rates(&self, first: usize) -> f64 {
        let rates = largest(&self.inputs[first..first + self.rates]).max(self.floor[0]);
        largest(&self.correction[..self.rates]) / rates
    }
}

/// What the correction of the multipliers does to the equations of the rates, over what these make of them:
/// of a short step the multipliers may change by much and move nothing.
fn impulses(jacobian: &[f64], z: &[f64], correction: &[f64], rates: usize) -> f64 {
    let rows = || jacobian.chunks_exact(z.len()).take(rates);
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>().abs();
    let impulse = rows().map(|row| sum(&row[rates..], &correction[rates..])).fold(0.0, f64::max);
    let size = rows().map(|row| sum(&row[..rates], &z[..rates])).fold(0.0, f64::max);
    if impulse > 0.0 { impulse / size } else { 0.0 }
}

pub(crate) fn check_finite(what: &'static str, t: f64, values: &[f64]) -> Result<(), DiscreteError> {
    match values.iter().find(|x| !x.is_finite()) {
        None => Ok(()),
        Some(&found) => Err(DiscreteError::NotFinite { what, found, t }),
    }
}

/// `max |a_i|`, 0 for none.
pub(crate) fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m, x| m.max(x.abs()))
}
