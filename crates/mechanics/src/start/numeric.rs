//! Expressions of a system as numbers, and equations among them as a problem for Newton's method.

use std::collections::{BTreeSet, HashMap};

use nalgebra::{DMatrix, DVector};
use symbolic::{Bounded, CompileError, Evaluator, Expr, Scalar, Symbol};

use crate::newton::{Evaluation, NewtonError, NewtonOptions, Root, solve};
use crate::{State, System};

/// `outputs` at a state.
pub(super) struct AtState(Evaluator<f64>);

impl AtState {
    pub(super) fn new(system: &System, outputs: &[Expr]) -> Result<Self, CompileError> {
        let inputs = [system.positions(), system.velocities(), vec![system.time]].concat();
        Ok(AtState(system.evaluator(&inputs, outputs)?))
    }

    pub(super) fn at(&mut self, state: &State) -> &[f64] {
        self.0.evaluate(&[&state.q[..], &state.v, &[state.t]].concat())
    }
}

pub(super) fn bounded(point: &[f64]) -> Vec<Bounded> {
    point.iter().map(|&x| Bounded::from_f64(x)).collect()
}

/// Equations `e(x; known) = 0` in some symbols `x` of a graph.
pub(super) struct Problem<'a> {
    pub(super) system: &'a System,
    pub(super) unknowns: Vec<Symbol>,
    pub(super) equations: Vec<Expr>,
    /// Values of the symbols that are neither unknown nor parameters.
    pub(super) known: HashMap<Symbol, f64>,
    /// Those of them that are results themselves, with the size of what was added up to them.
    pub(super) results: Vec<(Symbol, f64)>,
}

impl<'a> Problem<'a> {
    /// The unknowns are all symbols of `equations` and `outputs` that are not `known` and no parameters.
    pub(super) fn new(system: &'a System, equations: Vec<Expr>, outputs: &[Expr], known: HashMap<Symbol, f64>) -> Self {
        let parameters = system.parameter_values();
        let occurring: BTreeSet<Symbol> =
            equations.iter().chain(outputs).flat_map(|&e| system.graph.symbols_of(e)).collect();
        let open = |s: &Symbol| !known.contains_key(s) && !parameters.contains_key(s);
        let unknowns = occurring.into_iter().filter(open).collect();
        Problem { system, unknowns, equations, known, results: Vec::new() }
    }

    /// Known values in the order of their symbols, so that every run builds the same graph.
    fn known_in_order(&self) -> Vec<(Symbol, f64)> {
        let mut known: Vec<(Symbol, f64)> = self.known.iter().map(|(&s, &x)| (s, x)).collect();
        known.sort_by_key(|(s, _)| *s);
        known
    }

    /// Whether every equation is linear in the unknowns.
    pub(super) fn is_linear(&self) -> bool {
        let g = &self.system.graph;
        let jacobian = g.jacobian(&self.equations, &self.unknowns);
        !jacobian.entries().iter().any(|&e| self.unknowns.iter().any(|&s| g.depends_on(e, s)))
    }

    /// Solves from `guess`; unknowns that are not in it start at `default`.
    pub(super) fn solve(&self, guess: &HashMap<Symbol, f64>, default: f64) -> Result<Solved, CompileError> {
        let g = &self.system.graph;
        let (m, n) = (self.equations.len(), self.unknowns.len());
        let known = self.known_in_order();
        let known_symbols: Vec<Symbol> = known.iter().map(|k| k.0).collect();
        let (results, sizes): (Vec<Symbol>, Vec<f64>) = self.results.iter().copied().unzip();
        let mut outputs = self.equations.clone();
        outputs.extend(g.jacobian(&self.equations, &self.unknowns).entries());
        outputs.extend(g.jacobian(&self.equations, &results).entries());
        let inputs = [&self.unknowns[..], &known_symbols].concat();
        let mut measured = self.system.evaluator(&inputs, &outputs)?;
        let mut point: Vec<f64> = vec![0.0; n];
        point.extend(known.iter().map(|k| k.1));
        let evaluate = |x: &DVector<f64>| {
            point[..n].copy_from_slice(x.as_slice());
            let (residuals, derivatives) = measured.evaluate(&bounded(&point)).split_at(m);
            let (jacobian, by_results) = derivatives.split_at(m * n);
            let behind = |i: usize| by_results[i * sizes.len()..].iter().zip(&sizes);
            let sum = |i: usize| behind(i).map(|(d, size)| d.value.abs() * size).sum::<f64>();
            let size = |i: usize| Some(sum(i)).filter(|size| size.is_finite()).unwrap_or(0.0);
            Evaluation {
                magnitude: DVector::from_fn(m, |i, _| residuals[i].magnitude + size(i)),
                residual: DVector::from_iterator(m, residuals.iter().map(|r| r.value)),
                jacobian: DMatrix::from_row_iterator(m, n, jacobian.iter().map(|d| d.value)),
            }
        };
        let start = DVector::from_iterator(n, self.unknowns.iter().map(|s| *guess.get(s).unwrap_or(&default)));
        Ok(match solve(evaluate, start, &NewtonOptions::default()) {
            Ok(root) => Solved::Root(root),
            Err(NewtonError::NotConverged { best, .. }) => Solved::LeastSquares(*best),
            Err(NewtonError::NotFinite { .. }) => Solved::Nowhere,
        })
    }

    /// `|e| / (|e| + size of its terms)` of each equation, all of whose symbols must be known.
    pub(super) fn relative_residuals(&self) -> Result<Vec<f64>, CompileError> {
        let (symbols, point): (Vec<Symbol>, Vec<f64>) = self.known_in_order().into_iter().unzip();
        let mut outputs = self.equations.clone();
        outputs.extend(self.system.graph.jacobian(&self.equations, &symbols).entries());
        let mut measured = self.system.evaluator(&symbols, &outputs)?;
        let (residuals, derivatives) = measured.evaluate(&bounded(&point)).split_at(self.equations.len());
        let n = point.len();
        let x = DVector::from_column_slice(&point);
        let single = |(i, r): (usize, &Bounded)| {
            let gradient = derivatives[i * n..(i + 1) * n].iter().map(|d| d.value);
            let finite = gradient.map(|d| if d.is_finite() { d } else { 0.0 });
            let evaluation = Evaluation {
                residual: DVector::from_element(1, r.value),
                jacobian: DMatrix::from_iterator(1, n, finite),
                magnitude: DVector::from_element(1, if r.magnitude.is_finite() { r.magnitude } else { 0.0 }),
            };
            evaluation.relative_residual(&x)
        };
        Ok(residuals.iter().enumerate().map(single).collect())
    }

    /// Known values and those of the unknowns at `root`.
    pub(super) fn values(&self, root: &Root) -> HashMap<Symbol, f64> {
        let mut values = self.known.clone();
        values.extend(self.unknowns.iter().copied().zip(root.x.iter().copied()));
        values
    }

    /// Values of `outputs` at `root`, and which of them the equations leave open.
    pub(super) fn outputs(&self, outputs: &[Expr], root: &Root) -> Result<(Vec<f64>, Vec<bool>), CompileError> {
        /// Part of a kernel direction that is not round-off.
        const OPEN: f64 = 1e-8;
        let (values, n) = (self.values(root), self.unknowns.len());
        let mut inputs: Vec<Symbol> = values.keys().copied().collect();
        inputs.sort();
        let mut all = outputs.to_vec();
        all.extend(self.system.graph.jacobian(outputs, &self.unknowns).entries());
        let point: Vec<f64> = inputs.iter().map(|s| values[s]).collect();
        let mut numeric = self.system.evaluator(&inputs, &all)?;
        let (values, derivatives) = numeric.evaluate(&point).split_at(outputs.len());
        let mut open = Vec::with_capacity(outputs.len());
        for i in 0..outputs.len() {
            let gradient = DVector::from_column_slice(&derivatives[i * n..(i + 1) * n]);
            let change = root.null_space.tr_mul(&gradient);
            open.push(change.norm() > OPEN * gradient.norm());
        }
        Ok((values.to_vec(), open))
    }
}

/// How solving a [`Problem`] ended.
pub(super) enum Solved {
    Root(Root),
    /// The equations contradict each other; the relative residual is over the limit.
    LeastSquares(Root),
    /// The equations are not finite at the guess.
    Nowhere,
}
