//! Coordinates at the start that constraints on positions leave nothing of.

use nalgebra::{DMatrix, DVector};
use symbolic::limits::SAME;
use symbolic::{CompileError, Evaluator, Expr, SplitMix, Symbol};

use crate::System;
use crate::newton::{Evaluation, NewtonOptions, solve};

/// Points from which Newton's method begins.
const STARTS: usize = 300;

/// Values of the coordinates `free` with which the constraints on positions hold, the others being given.
#[derive(Clone)]
pub struct Configurations {
    /// Constraints on positions, then their derivatives by `free` row by row; of numbers that vary, time and
    /// all positions.
    program: Evaluator<f64>,
    constraints: usize,
    free: Vec<usize>,
    is_angle: Vec<bool>,
}

impl Configurations {
    /// Of `system`, whose parameters `varied` come as inputs.
    ///
    /// # Errors
    /// [`CompileError`] where a constraint cannot be compiled.
    pub fn new(system: &System, varied: &[Symbol], free: &[usize]) -> Result<Self, CompileError> {
        let g = &system.graph;
        let constraints: Vec<Expr> = system.on_positions.iter().map(|(_, e)| *e).collect();
        let symbols = system.positions();
        let own: Vec<_> = free.iter().map(|&i| symbols[i]).collect();
        let inputs = [varied, &[system.time], &symbols[..]].concat();
        let outputs = [&constraints[..], g.jacobian(&constraints, &own).entries()].concat();
        Ok(Configurations {
            program: Evaluator::new(g.compile(&inputs, &outputs, &system.parameter_values())?),
            constraints: constraints.len(),
            is_angle: free.iter().map(|&i| matches!(system.coordinates[i].unit.as_str(), "rad" | "")).collect(),
            free: free.to_vec(),
        })
    }

    /// Residuals at positions `q` with `x` for the free ones; `before` are the numbers that vary, and time.
    fn at(&mut self, before: &[f64], q: &[f64], x: &DVector<f64>) -> Evaluation {
        let mut all = q.to_vec();
        self.free.iter().zip(x.iter()).for_each(|(&i, x)| all[i] = *x);
        let (m, n) = (self.constraints, self.free.len());
        let values = self.program.evaluate(&[before, &all[..]].concat());
        let jacobian = DMatrix::from_row_slice(m, n, &values[m..]);
        let size = 1.0 + all.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let magnitude = DVector::from_fn(m, |i, _| size * jacobian.row(i).amax());
        Evaluation { residual: DVector::from_row_slice(&values[..m]), jacobian, magnitude }
    }

    /// The root to which Newton's method leads from `x`, where constraints determine all free coordinates.
    fn root(&mut self, before: &[f64], q: &[f64], x: DVector<f64>) -> Option<DVector<f64>> {
        let root = solve(|x| self.at(before, q, x), x, &NewtonOptions::default()).ok()?;
        (root.rank == self.free.len()).then_some(root.x)
    }

    /// Moves the free coordinates of `q` to the root to which Newton's method leads; without one they stay.
    pub fn supply(&mut self, before: &[f64], q: &mut [f64]) {
        let from = DVector::from_iterator(self.free.len(), self.free.iter().map(|&i| q[i]));
        if let Some(root) = self.root(before, q, from) {
            self.free.iter().zip(root.iter()).for_each(|(&i, x)| q[i] = *x);
        }
    }

    /// All that are found at time `t`: from `q` itself, then from points up to three times as far away as its
    /// largest coordinate, angles from −π to π; those nearest to `q` come first.
    pub fn all(&mut self, t: f64, q: &[f64]) -> Vec<Vec<f64>> {
        let (n, is_angle) = (self.free.len(), self.is_angle.clone());
        let near = DVector::from_fn(n, |k, _| q[self.free[k]]);
        let size = q.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        let (mut random, mut found) = (SplitMix::new(4), Vec::<Vec<f64>>::new());
        for start in 0..STARTS {
            let mut draw = |k: usize| {
                let reach = if is_angle[k] { std::f64::consts::PI } else { 3.0 * size };
                reach * (2.0 * random.unit() - 1.0)
            };
            let from = if start == 0 { near.clone() } else { DVector::from_fn(n, |k, _| draw(k)) };
            let Some(mut x) = self.root(&[t], q, from) else { continue };
            // an angle and one that is full turns away are one configuration, where the constraints say so
            for k in (0..n).filter(|&k| is_angle[k]) {
                let mut turned = x.clone();
                turned[k] -= std::f64::consts::TAU * ((x[k] - near[k]) / std::f64::consts::TAU).round();
                if self.at(&[t], q, &turned).relative_residual(&turned) <= NewtonOptions::default().limit {
                    x = turned;
                }
            }
            let is_known =
                |known: &Vec<f64>| known.iter().zip(x.iter()).all(|(a, b)| (a - b).abs() <= SAME * (size + b.abs()));
            if !found.iter().any(is_known) {
                found.push(x.as_slice().to_vec());
            }
        }
        let distance = |x: &Vec<f64>| x.iter().zip(near.iter()).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        found.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        found
    }
}
