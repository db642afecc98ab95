//! Expressions of a system as numbers, and equations among them as a problem for Newton's method.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};
use symbolic::limits::HALF_THE_DIGITS;
use symbolic::{Bounded, CompileError, Evaluator, Expr, Scalar, Symbol};

use crate::newton::{Evaluation, NewtonError, NewtonOptions, Root, solve};
use crate::{SingularValues, State, System};

/// Compiled outputs, or the compile error, reported on first use.
#[derive(Clone)]
pub(super) struct Program<T>(Result<Evaluator<T>, CompileError>);

impl<T: Scalar> Program<T> {
    pub(super) fn new(system: &System, inputs: &[Symbol], outputs: &[Expr]) -> Self {
        Program(system.evaluator(inputs, outputs))
    }

    pub(super) fn evaluator(&mut self) -> Result<&mut Evaluator<T>, CompileError> {
        self.0.as_mut().map_err(|error| error.clone())
    }
}

/// Outputs at a state, for values of the parameters that vary.
#[derive(Clone)]
pub(super) struct AtState<T = f64> {
    program: Program<T>,
    point: Vec<T>,
}

impl<T: Scalar> AtState<T> {
    pub(super) fn new(system: &System, varied: &[Symbol], outputs: &[Expr]) -> Self {
        AtState { program: Program::new(system, &state_symbols(system, varied), outputs), point: Vec::new() }
    }

    pub(super) fn at(&mut self, state: &State, varied: &[f64]) -> Result<&[T], CompileError> {
        self.point.clear();
        self.point.extend(numbers(state).chain(varied).map(|&x| T::from_f64(x)));
        Ok(self.program.evaluator()?.evaluate(&self.point))
    }
}

/// `q, v, t` and the parameters that vary.
pub(super) fn state_symbols(system: &System, varied: &[Symbol]) -> Vec<Symbol> {
    [&system.positions()[..], &system.velocities(), &[system.time], varied].concat()
}

/// The values of the first of these.
pub(super) fn numbers(state: &State) -> impl Iterator<Item = &f64> {
    state.q.iter().chain(&state.v).chain([&state.t])
}

fn bounded(point: &[f64]) -> Vec<Bounded> {
    point.iter().map(|&x| Bounded::from_f64(x)).collect()
}

/// Its value, or zero where that is round-off, as of the cosine of a number that is nearest to π/2.
fn known_part(x: &Bounded) -> f64 {
    if x.value.abs() <= f64::EPSILON * x.magnitude { 0.0 } else { x.value }
}

/// Equations `e(x; known) = 0` in some symbols `x` of a graph, and outputs in them, compiled.
#[derive(Clone)]
pub(super) struct Problem {
    pub(super) unknowns: Vec<Symbol>,
    /// Whether every equation is linear in the unknowns.
    pub(super) is_linear: bool,
    equations: usize,
    /// The equations, their derivatives by the unknowns, and by what of the known is a result itself.
    measured: Program<Bounded>,
    /// The outputs, and their derivatives by the unknowns.
    outputs: Program<f64>,
    count: usize,
}

impl Problem {
    /// The unknowns are all symbols of `equations` and `outputs` that are not `known` and no parameters.
    /// Among the `known` are parameters that vary; of `results` is known how much was added up to them.
    pub(super) fn new(
        system: &System,
        equations: &[Expr],
        outputs: &[Expr],
        known: &[Symbol],
        results: &[Symbol],
    ) -> Self {
        let g = &system.graph;
        let parameters = system.parameter_values();
        let occurring: BTreeSet<Symbol> = equations.iter().chain(outputs).flat_map(|&e| g.symbols_of(e)).collect();
        let open = |s: &Symbol| !known.contains(s) && !parameters.contains_key(s);
        let unknowns: Vec<Symbol> = occurring.into_iter().filter(open).collect();
        let inputs = [&unknowns[..], known].concat();
        let jacobian = g.jacobian(equations, &unknowns);
        let bends = |&e: &Expr| g.symbols_of(e).iter().any(|s| unknowns.binary_search(s).is_ok());
        let measured = [equations, jacobian.entries(), g.jacobian(equations, results).entries()].concat();
        let read = [outputs, g.jacobian(outputs, &unknowns).entries()].concat();
        Problem {
            is_linear: !jacobian.entries().iter().any(bends),
            equations: equations.len(),
            measured: Program::new(system, &inputs, &measured),
            outputs: Program::new(system, &inputs, &read),
            count: outputs.len(),
            unknowns,
        }
    }

    /// Solves from `start`, one number per unknown; `sizes` are the sums of terms behind the results.
    pub(super) fn solve(&mut self, known: &[f64], sizes: &[f64], start: &[f64]) -> Result<Solved, CompileError> {
        match self.solved(known, sizes, start, |derivative| derivative.value)? {
            Solved::Root(root) if self.is_by_round_off(known, &root)? => self.solved(known, sizes, start, known_part),
            found => Ok(found),
        }
    }

    /// Whether an equation holds at `root` by a derivative that is round-off.
    fn is_by_round_off(&mut self, known: &[f64], root: &Root) -> Result<bool, CompileError> {
        let (m, n) = (self.equations, self.unknowns.len());
        let point = bounded(&[root.x.as_slice(), known].concat());
        let derivatives = &self.measured.evaluator()?.evaluate(&point)[m..m + m * n];
        let counts = |(place, d): (usize, &Bounded)| known_part(d) != d.value && root.x[place % n] != 0.0;
        Ok(derivatives.iter().enumerate().any(counts))
    }

    fn solved(
        &mut self,
        known: &[f64],
        sizes: &[f64],
        start: &[f64],
        derivative: fn(&Bounded) -> f64,
    ) -> Result<Solved, CompileError> {
        let (m, n) = (self.equations, self.unknowns.len());
        let measured = self.measured.evaluator()?;
        let mut point = bounded(start);
        point.extend(bounded(known));
        let evaluate = |x: &DVector<f64>| {
            point.iter_mut().zip(x.iter()).for_each(|(input, &x)| *input = Bounded::from_f64(x));
            let (residuals, derivatives) = measured.evaluate(&point).split_at(m);
            let (jacobian, by_results) = derivatives.split_at(m * n);
            let behind = |i: usize| by_results[i * sizes.len()..].iter().zip(sizes);
            let sum = |i: usize| behind(i).map(|(d, size)| d.value.abs() * size).sum::<f64>();
            let size = |i: usize| Some(sum(i)).filter(|size| size.is_finite()).unwrap_or(0.0);
            Evaluation {
                magnitude: DVector::from_fn(m, |i, _| residuals[i].magnitude + size(i)),
                residual: DVector::from_iterator(m, residuals.iter().map(|r| r.value)),
                jacobian: DMatrix::from_row_iterator(m, n, jacobian.iter().map(derivative)),
            }
        };
        Ok(match solve(evaluate, DVector::from_column_slice(start), &NewtonOptions::default()) {
            Ok(root) => Solved::Root(root),
            Err(NewtonError::NotConverged { best, .. }) => Solved::LeastSquares(*best),
            Err(NewtonError::NotFinite { .. }) => Solved::Nowhere,
        })
    }

    /// Which equations from `first` on hold to first order at `root` wherever all others do.
    pub(super) fn idle(&mut self, known: &[f64], root: &Root, first: usize) -> Result<Vec<usize>, CompileError> {
        let (m, n) = (self.equations, self.unknowns.len());
        let point = bounded(&[root.x.as_slice(), known].concat());
        let derivatives = &self.measured.evaluator()?.evaluate(&point)[m..m + m * n];
        let mut rows = DMatrix::from_row_iterator(m, n, derivatives.iter().map(|d| d.value));
        rows.row_iter_mut().for_each(|mut row| {
            let size = row.amax();
            row /= if size > 0.0 { size } else { 1.0 };
        });
        let rank = |rows: &DMatrix<f64>| SingularValues::of(rows).rank(NewtonOptions::default().rank_limit);
        Ok((first..m).filter(|&i| rank(&rows.clone().remove_row(i)) == rank(&rows)).collect())
    }

    /// Values of the outputs at `root`, and which of them the equations leave open.
    pub(super) fn outputs(&mut self, known: &[f64], root: &Root) -> Result<(Vec<f64>, Vec<bool>), CompileError> {
        let n = self.unknowns.len();
        let point = [root.x.as_slice(), known].concat();
        let (values, derivatives) = self.outputs.evaluator()?.evaluate(&point).split_at(self.count);
        let open = |i: usize| {
            let gradient = DVector::from_column_slice(&derivatives[i * n..(i + 1) * n]);
            let change = root.null_space.tr_mul(&gradient);
            change.norm() > HALF_THE_DIGITS * gradient.norm()
        };
        Ok((values.to_vec(), (0..self.count).map(open).collect()))
    }
}

/// The constraints, start equations and their derivatives at a state.
#[derive(Clone)]
pub(super) struct Residuals {
    conditions: AtState<Bounded>,
    count: usize,
}

/// The residual of a condition at a state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Residual {
    pub(super) value: f64,
    /// `|f| / (|f| + size of its terms)`.
    pub(super) relative: f64,
}

impl Residuals {
    pub(super) fn new(system: &System, equations: &[Expr], varied: &[Symbol]) -> Self {
        let (symbols, conditions) = (state_symbols(system, &[]), [&system.constraints, equations].concat());
        let outputs = [&conditions[..], system.graph.jacobian(&conditions, &symbols).entries()].concat();
        Residuals { conditions: AtState::new(system, varied, &outputs), count: conditions.len() }
    }

    /// Of each constraint, then of each start equation.
    pub(super) fn at(&mut self, state: &State, varied: &[f64]) -> Result<Vec<Residual>, CompileError> {
        let x = DVector::from_vec(numbers(state).copied().collect());
        let n = x.len();
        let (residuals, derivatives) = self.conditions.at(state, varied)?.split_at(self.count);
        let single = |(i, r): (usize, &Bounded)| {
            let gradient = derivatives[i * n..(i + 1) * n].iter().map(|d| d.value);
            let finite = gradient.map(|d| if d.is_finite() { d } else { 0.0 });
            let evaluation = Evaluation {
                residual: DVector::from_element(1, r.value),
                jacobian: DMatrix::from_iterator(1, n, finite),
                magnitude: DVector::from_element(1, if r.magnitude.is_finite() { r.magnitude } else { 0.0 }),
            };
            Residual { value: r.value, relative: evaluation.relative_residual(&x) }
        };
        Ok(residuals.iter().enumerate().map(single).collect())
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
