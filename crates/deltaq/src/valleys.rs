//! Minimization of the largest gap: steps to the linearized minimum, on longer and longer parts of the
//! motion, and a population of candidates for valleys too narrow for such steps.

use nalgebra::{DMatrix, DVector};

use crate::gap_search::{BEYOND, COARSE, FINE, GAIN, Search, Value};

/// Steps of a descent, at most.
const STEPS: usize = 10;

impl Search {
    /// Steps to the minimum of the largest gap of the linearized motion up to this part of it, as long as the
    /// gap decreases.
    pub(crate) fn descent(&mut self, start: Value, part: f64) -> Value {
        let fine = self.differences.largest(&start.0, part, FINE);
        let mut best = (start.0, fine);
        for _ in 0..STEPS {
            if self.differences.work > self.limit {
                break;
            }
            let Some(step) = self.linearized_step(&best.0, part) else { break };
            let before = best.1;
            for fraction in [1.0, 0.5, 0.25, 0.1, 0.03, 0.01] {
                let value: Vec<f64> = best.0.iter().zip(&step).map(|(c, s)| c + fraction * s).collect();
                let gap = self.gap_under(&value, best.1, part, FINE);
                if gap < best.1 {
                    best = (value, gap);
                    break;
                }
            }
            if best.1 > (1.0 - GAIN) * before {
                break;
            }
        }
        best
    }

    /// Where descents lead that meet the beginning first, and then more and more of the motion: what a long
    /// way folds, a short one does not.
    pub(crate) fn grown(&mut self, mut value: Vec<f64>) -> Value {
        const BY: f64 = 1.25;
        const FIRST: f64 = 0.05;
        let mut part = FIRST;
        while part < 1.0 && self.differences.work <= self.limit {
            value = self.descent((value, 0.0), part).0;
            part *= BY;
        }
        self.starts += 1;
        self.descent((value, 0.0), 1.0)
    }

    /// `δ` with the least `max_k |r_k + J_k δ|`, by Lawson's weights.
    fn linearized_step(&mut self, at: &[f64], part: f64) -> Option<DVector<f64>> {
        const WEIGHTINGS: usize = 40;
        let rest = self.differences.at(at, part, COARSE)?;
        let largest = at.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
        let size = |j: usize| at[j].abs().max(1e-2 * if largest > 0.0 { largest } else { self.sizes[j] });
        let steps: Vec<f64> = (0..at.len()).map(|j| self.part * size(j)).collect();
        let mut jacobian = DMatrix::zeros(rest.len(), at.len());
        for (j, h) in steps.into_iter().enumerate() {
            let mut moved = at.to_vec();
            moved[j] += h;
            jacobian.set_column(j, &((self.differences.at(&moved, part, COARSE)? - &rest) / h));
        }
        let n = self.differences.dimension();
        let instants = rest.len() / n;
        let mut weights = vec![1.0 / instants as f64; instants];
        let mut step = DVector::zeros(at.len());
        for _ in 0..WEIGHTINGS {
            let root = DVector::from_fn(rest.len(), |i, _| weights[i / n].sqrt());
            let weighted = DMatrix::from_fn(rest.len(), at.len(), |i, j| root[i] * jacobian[(i, j)]);
            let goal = rest.component_mul(&root);
            let inverse = (weighted.transpose() * &weighted).cholesky()?;
            step = -inverse.solve(&(weighted.transpose() * goal));
            let left = &rest + &jacobian * &step;
            let lengths = left.as_slice().chunks_exact(n).map(|d| d.iter().map(|x| x * x).sum::<f64>().sqrt());
            weights.iter_mut().zip(lengths).for_each(|(w, length)| *w *= length);
            let sum: f64 = weights.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                break;
            }
            weights.iter_mut().for_each(|w| *w /= sum);
        }
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// What a population comes to that is drawn around `best` with a covariance that adapts itself to
    /// the valleys in which gaps are small (CMSA-ES, Beyer and Sendhoff 2008): offspring `c + σ_l s_l`,
    /// with `σ_l = σ exp(N(0, 1)/√(2n))` and `s_l` of covariance `C`; the best quarter of them has the
    /// next `c`, `σ` and a part of the next `C`.
    pub(crate) fn evolved(&mut self, mut best: Value) -> Value {
        const OFFSPRING: usize = 32;
        const PARENTS: usize = 8;
        const GENERATIONS: usize = 120;
        const FIRST: f64 = 1e-2;
        const NARROW: f64 = 1e-9;
        let n = self.sizes.len();
        let learned = 1.0 / (1.0 + (n * (n + 1)) as f64 / (2 * PARENTS) as f64);
        let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(n, self.sizes.iter().map(|s| s * s)));
        let (mut center, mut sigma) = (DVector::from_column_slice(&best.0), FIRST);
        for _ in 0..GENERATIONS {
            let Some(factor) = covariance.clone().cholesky().map(|c| c.l()) else { break };
            if self.differences.work > self.limit || sigma * factor.norm() < NARROW * center.norm() {
                break;
            }
            let drawn: Vec<(f64, DVector<f64>)> = (0..OFFSPRING)
                .map(|_| {
                    let own = sigma * (self.normal() / (2.0 * n as f64).sqrt()).exp();
                    (own, &factor * DVector::from_fn(n, |_, _| self.normal()))
                })
                .collect();
            let values: Vec<Vec<f64>> = drawn.iter().map(|(own, s)| (&center + s * *own).as_slice().to_vec()).collect();
            let gaps = self.all_under(&values, best.1 * BEYOND);
            let mut order: Vec<usize> = (0..OFFSPRING).filter(|&l| gaps[l].is_finite()).collect();
            order.sort_by(|&a, &b| gaps[a].total_cmp(&gaps[b]));
            order.truncate(PARENTS);
            let Some(&first) = order.first() else {
                sigma *= 0.5;
                continue;
            };
            if gaps[first] < best.1 {
                best = (values[first].clone(), gaps[first]);
            }
            let part = 1.0 / order.len() as f64;
            let mean = |of: &dyn Fn(usize) -> f64| order.iter().map(|&l| of(l)).sum::<f64>() * part;
            center = DVector::from_fn(n, |j, _| mean(&|l| values[l][j]));
            sigma = mean(&|l| drawn[l].0);
            let spread = DMatrix::from_fn(n, n, |i, j| mean(&|l| drawn[l].1[i] * drawn[l].1[j]));
            covariance = covariance * (1.0 - learned) + spread * learned;
        }
        best
    }

    /// The gaps of these values, infinite where not under `bound`.
    fn all_under(&mut self, values: &[Vec<f64>], bound: f64) -> Vec<f64> {
        let mut gaps = vec![f64::INFINITY; values.len()];
        let mut left = 0;
        while left < values.len() {
            let (found, looked_at) = self.under(&values[left..], bound);
            for (value, gap) in found {
                let at = (left..left + looked_at).find(|&l| values[l] == value);
                at.into_iter().for_each(|l| gaps[l] = gap);
            }
            left += looked_at;
        }
        self.starts += values.len();
        gaps
    }

    /// A number of the standard normal distribution.
    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.number()).ln()).sqrt() * (std::f64::consts::TAU * self.number()).cos()
    }
}
