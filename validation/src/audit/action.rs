//! The action as a number: perturbed directly, without any of the derivations that it is to judge.

use std::collections::HashMap;

use anyhow::{Context as _, Result};
use symbolic::{Evaluator, Symbol};

use super::context::Context;

/// A free function and its first two derivatives at an instant.
pub type Jet = [f64; 3];

/// Steps of the quadrature.
const STEPS: usize = 400;

/// Size of the perturbation; half of it is tried too.
const SIZE: f64 = 2e-3;

/// An action `∫ L dt` over curves of a context's free functions, with integrals in `L`.
pub(super) struct Action {
    evaluator: Evaluator<f64>,
    /// Values of the integrals at the start.
    pub(super) start: Vec<f64>,
}

impl Action {
    /// The action of `lagrangian` in `functions`, with all integrals needed (by integrands too), from `t₀`.
    pub(super) fn new(
        context: &Context,
        lagrangian: &str,
        functions: &[&str],
        integrals: &[&str],
        constants: &HashMap<Symbol, f64>,
    ) -> Result<Action> {
        let g = &context.graph;
        let mut inputs = vec![g.symbol("t")];
        for function in functions {
            inputs.extend(["", "'", "''"].map(|primes| g.symbol(&format!("{function}{primes}"))));
        }
        inputs.extend(integrals.iter().map(|name| g.symbol(name)));
        let mut outputs = Vec::new();
        for name in integrals {
            outputs.push(context.expression(&format!("{name}'"))?);
        }
        outputs.push(context.expression(lagrangian)?);
        let tape = g.compile(&inputs, &outputs, constants).context("the action cannot be compiled")?;
        Ok(Action { evaluator: Evaluator::new(tape), start: vec![0.0; integrals.len()] })
    }

    /// The action over `[t₀, t₁]`, by the rule of Simpson on the integrals and on `L` at once.
    pub(super) fn value(&mut self, curve: &dyn Fn(f64) -> Vec<Jet>, span: [f64; 2]) -> f64 {
        self.weighted(curve, &|_| 1.0, span)
    }

    /// The same with `L` times a weight.
    pub(super) fn weighted(
        &mut self,
        curve: &dyn Fn(f64) -> Vec<Jet>,
        weight: &dyn Fn(f64) -> f64,
        [start, end]: [f64; 2],
    ) -> f64 {
        let n = self.start.len() + 1;
        let h = (end - start) / STEPS as f64;
        let mut y = self.start.clone();
        y.push(0.0);
        let mut slopes = [vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        for k in 0..STEPS {
            let t = start + h * k as f64;
            for stage in 0..4 {
                let part = [0.0, 0.5, 0.5, 1.0][stage];
                let moved: Vec<f64> = match stage {
                    0 => y.clone(),
                    _ => y.iter().zip(&slopes[stage - 1]).map(|(y, s)| y + part * h * s).collect(),
                };
                self.rates(t + part * h, curve, &moved, &mut slopes[stage]);
                slopes[stage][n - 1] *= weight(t + part * h);
            }
            for i in 0..n {
                y[i] += h / 6.0 * (slopes[0][i] + 2.0 * slopes[1][i] + 2.0 * slopes[2][i] + slopes[3][i]);
            }
        }
        y[n - 1]
    }

    fn rates(&mut self, t: f64, curve: &dyn Fn(f64) -> Vec<Jet>, y: &[f64], rates: &mut [f64]) {
        let mut inputs = vec![t];
        inputs.extend(curve(t).into_iter().flatten());
        inputs.extend(&y[..self.start.len()]);
        rates.copy_from_slice(self.evaluator.evaluate(&inputs));
    }

    /// `dI/dε` at `ε = 0` on `curve + ε variation`: central differences of two sizes, extrapolated to zero.
    pub(super) fn derivative(
        &mut self,
        curve: &dyn Fn(f64) -> Vec<Jet>,
        variation: &dyn Fn(f64) -> Vec<Jet>,
        span: [f64; 2],
    ) -> f64 {
        let mut slope = |size: f64| {
            let mut at = |size: f64| {
                let moved = |t: f64| -> Vec<Jet> {
                    let pairs = curve(t).into_iter().zip(variation(t));
                    pairs.map(|(c, v)| [0, 1, 2].map(|i| c[i] + size * v[i])).collect()
                };
                self.value(&moved, span)
            };
            (at(size) - at(-size)) / (2.0 * size)
        };
        let (coarse, fine) = (slope(SIZE), slope(SIZE / 2.0));
        (4.0 * fine - coarse) / 3.0
    }
}

/// Variation `k` on `[t₀, t₁]`: `16 s²(1 − s)² Tₖ(2s − 1)`, zero at both ends with its first derivative.
pub fn bump(k: usize, [start, end]: [f64; 2], t: f64) -> Jet {
    let length = end - start;
    let s = (t - start) / length;
    let z = 2.0 * s - 1.0;
    // Chebyshev polynomial and its first two derivatives in s
    let tail = match k {
        0 => [1.0, 0.0, 0.0],
        1 => [z, 2.0, 0.0],
        2 => [2.0 * z * z - 1.0, 8.0 * z, 16.0],
        _ => [4.0 * z * z * z - 3.0 * z, 24.0 * z * z - 6.0, 96.0 * z],
    };
    let front = [
        16.0 * s * s * (1.0 - s) * (1.0 - s),
        32.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
        32.0 * (1.0 - 6.0 * s + 6.0 * s * s),
    ];
    let first = front[1] * tail[0] + front[0] * tail[1];
    let second = front[2] * tail[0] + 2.0 * front[1] * tail[1] + front[0] * tail[2];
    [front[0] * tail[0], first / length, second / (length * length)]
}

/// Number of variations.
pub const BUMPS: usize = 4;
