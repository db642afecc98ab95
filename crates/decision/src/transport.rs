//! Costates along a curve as functions of the free constants, `η(t) = Φ c + φ`, integrated beside it.

use integrate::{
    Dense, DenseOutput, EvaluationError, Gauge, Method, Options, Problem, Start, Status, StopCause, integrate,
};
use mechanics::linear::PIVOT_LIMIT;
use mechanics::{SingularValues, State};
use nalgebra::{DMatrix, DVector};
use symbolic::{Bounded, Evaluator, Scalar};

use crate::DecisionError;
use crate::curve::{Curve, Point};
use crate::exact::{solve, subtract_product};
use crate::family::{CostateRate, Family};
use crate::lift::Lift;
use crate::scales::{self, Scales};

/// `AᵀA` in the unit of `M` is added to it with the first of these weights that makes it positive.
const WEIGHTS: [f64; 4] = [1.0, 1e2, 1e4, 1e6];
/// The smallest part of its scale that a state is held to have for its size.
const SMALLEST: f64 = 1e-3;

/// Mismatch of accelerations at one instant, `O c + y₀`, with the scales it is measured by.
pub(crate) struct Mismatch {
    /// n×(constants + 1), whitened: its Euclidean length is the length in the metric `M` on `ker A`.
    pub(crate) rows: DMatrix<f64>,
    /// `√(aᵀ M a)` of the curve's own acceleration, and `√(vᵀ M v)`.
    pub(crate) acceleration: f64,
    pub(crate) speed: f64,
    /// What it was made of.
    columns: DMatrix<f64>,
    unknowns: DMatrix<f64>,
    whitened: DMatrix<f64>,
}

/// An integrated path; no dense output where there are no states.
pub(crate) struct Path {
    pub(crate) dense: Option<DenseOutput>,
    pub(crate) end: f64,
    /// Why it ends early.
    pub(crate) stop: Option<DecisionError>,
}

/// `(states of the curve, u, w, Φ, φ)` as a problem for the time loop.
pub(crate) struct Transport<'a> {
    pub(crate) family: &'a Family,
    curve: &'a mut dyn Curve,
    own: usize,
    lift: Option<LiftNumbers<'a>>,
    instant: Evaluator<f64>,
    bounded: Evaluator<Bounded>,
    inputs: Vec<f64>,
    values: Vec<f64>,
    matrix: Vec<f64>,
    unknowns: Vec<f64>,
    point: Point,
    pub(crate) scales: Scales,
}

struct LiftNumbers<'a> {
    lift: &'a Lift,
    velocities: Evaluator<f64>,
    accelerations: Evaluator<f64>,
}

fn broken(reason: String) -> EvaluationError {
    EvaluationError { reason }
}

impl<'a> Transport<'a> {
    pub(crate) fn new(family: &'a Family, curve: &'a mut dyn Curve) -> Self {
        let lift = family.lift.as_ref().map(|lift| LiftNumbers {
            lift,
            velocities: Evaluator::new(lift.velocities.clone()),
            accelerations: Evaluator::new(lift.accelerations.clone()),
        });
        Transport {
            own: curve.states().len(),
            curve,
            lift,
            instant: family.evaluator(),
            bounded: family.evaluator(),
            inputs: Vec::new(),
            values: Vec::new(),
            matrix: Vec::new(),
            unknowns: Vec::new(),
            point: Point::default(),
            scales: Scales::default(),
            family,
        }
    }

    pub(crate) fn span(&self) -> (f64, f64) {
        self.curve.span()
    }

    /// States at the start of the curve.
    fn start(&mut self) -> Result<Start, DecisionError> {
        let (t, _) = self.curve.span();
        let mut y = self.curve.states();
        let mut rates = vec![0.0; self.own];
        let fault = |e: EvaluationError| DecisionError::Curve { reason: e.reason };
        let point = self.curve.point(t, &y, &mut rates).map_err(fault)?;
        if let Some(numbers) = &self.lift {
            y.extend(numbers.lift.start(&State { t, q: point.q, v: point.v })?);
        }
        let size = y.len() + self.family.shape.costates * (self.family.shape.constants + 1);
        y.resize(size, 0.0);
        let mut lifted = vec![0.0; size];
        self.load(t, &y, &mut lifted).map_err(fault)?;
        let begin = self.own + self.lifted();
        let mut columns = self.family.start(&self.inputs);
        if self.scales.residuals.is_empty() {
            self.scales = self.scales_at_start(&columns);
        }
        for row in columns.chunks_exact_mut(self.family.shape.constants + 1) {
            row.iter_mut().zip(&self.scales.constants).for_each(|(x, scale)| *x *= scale);
        }
        y[begin..].copy_from_slice(&columns);
        Ok(Start { t, y })
    }

    /// The scales at the start, where the inputs are loaded.
    fn scales_at_start(&mut self, costates: &[f64]) -> Scales {
        let shape = &self.family.shape;
        let bounded: Vec<Bounded> = self.inputs.iter().map(|&x| Bounded::from_f64(x)).collect();
        let bounded = self.bounded.evaluate(&bounded);
        // what round-off leaves of a zero says no size
        let values: Vec<f64> = bounded.iter().map(|x| if x.may_be_zero() { 0.0 } else { x.value }).collect();
        let terms: Vec<f64> = bounded.iter().map(|x| x.size()).collect();
        let (start, end) = self.curve.span();
        Scales::new(
            shape,
            &scales::Start {
                instant: shape.instant(&values),
                terms: shape.instant(&terms),
                velocities: &self.point.v,
                accelerations: &self.point.a,
                costates,
                time: (end - start).abs(),
            },
        )
    }

    fn lifted(&self) -> usize {
        self.lift.as_ref().map_or(0, |numbers| numbers.lift.parameters + numbers.lift.memory)
    }

    /// Fills the inputs for `(t, y)`, and the rates of all but `Φ, φ`.
    fn load(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        self.point = self.curve.point(t, &y[..self.own], &mut rates[..self.own])?;
        self.inputs.clear();
        self.inputs.extend(self.family.parameters());
        self.inputs.push(t);
        self.inputs.extend(&self.point.q);
        self.inputs.extend(&self.point.v);
        self.inputs.extend(&self.point.a);
        let Some(numbers) = &mut self.lift else { return Ok(()) };
        let Lift { parameters, memory, coordinates, .. } = *numbers.lift;
        let end = self.own + parameters + memory;
        self.inputs.extend(&y[self.own..end]);
        let values = numbers.velocities.evaluate(&self.inputs);
        let slopes = DMatrix::from_row_slice(coordinates, parameters, &values[..coordinates * parameters]);
        let rest = DVector::from_column_slice(&values[coordinates * parameters..]);
        let slopes = SingularValues::of(&slopes);
        let speeds = -slopes.solve(&rest, PIVOT_LIMIT * slopes.values.max());
        self.inputs.extend(speeds.iter());
        let values = numbers.accelerations.evaluate(&self.inputs);
        let seconds =
            -slopes.solve(&DVector::from_column_slice(&values[..coordinates]), PIVOT_LIMIT * slopes.values.max());
        rates[self.own..self.own + parameters].copy_from_slice(speeds.as_slice());
        rates[self.own + parameters..end].copy_from_slice(&values[coordinates..]);
        self.inputs.extend(seconds.iter());
        Ok(())
    }

    /// Solves the family's instant for all columns of `[Φ | φ]`: `self.unknowns` are `Δz`, `rates` become
    /// `η̇`; the inputs are loaded.
    fn solve(&mut self, t: f64, columns: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        let shape = &self.family.shape;
        let (size, k, width) = (shape.unknowns, shape.costates, shape.constants + 1);
        self.values.clear();
        self.values.extend_from_slice(self.instant.evaluate(&self.inputs));
        let instant = shape.instant(&self.values);
        self.matrix.clear();
        self.matrix.extend_from_slice(instant.matrix);
        self.unknowns.clear();
        self.unknowns.resize(size * width, 0.0);
        subtract_product(&mut self.unknowns, instant.by_costate, columns, k, width);
        for (row, rest) in self.unknowns.chunks_exact_mut(width).zip(instant.rest) {
            row[width - 1] -= rest;
        }
        let Scales { residuals, unknowns, .. } = &self.scales;
        for (i, factor) in residuals.iter().enumerate() {
            self.matrix[i * size..(i + 1) * size].iter_mut().zip(unknowns).for_each(|(x, scale)| *x *= factor * scale);
            self.unknowns[i * width..(i + 1) * width].iter_mut().for_each(|x| *x *= factor);
        }
        let solved = solve(&mut self.matrix, &mut self.unknowns, size, width, 1.0);
        if solved.is_none() || !self.unknowns.iter().all(|z| z.is_finite()) {
            return Err(broken(format!(
                "the equations of the {} family are singular at t = {t}",
                self.family.formulation
            )));
        }
        for (row, scale) in self.unknowns.chunks_exact_mut(width).zip(unknowns) {
            row.iter_mut().for_each(|z| *z *= scale);
        }
        for (row, rate) in rates.chunks_exact_mut(width).zip(&shape.rates) {
            match *rate {
                CostateRate::Unknown(place) => row.copy_from_slice(&self.unknowns[place * width..(place + 1) * width]),
                CostateRate::Explicit(place) => {
                    let (factors, rest) = instant.explicit[place * (k + 1)..(place + 1) * (k + 1)].split_at(k);
                    row.fill(0.0);
                    row[width - 1] = rest[0];
                    for (factor, column) in factors.iter().zip(columns.chunks_exact(width)) {
                        row.iter_mut().zip(column).for_each(|(x, c)| *x += factor * c);
                    }
                }
            }
        }
        Ok(())
    }

    /// What adds up in `Δz`, by column: `|J⁻¹| ((‖J‖ + |L| |U|) |Δz| + ‖R_η‖ |η| + ‖R₀‖ + |J| F)`; `‖·‖`
    /// sums all terms, `F` are the forces that balance in an acceleration of the curve. Elimination,
    /// `J = L U` with rows in another order, adds up more than `J` where rows are nearly dependent.
    fn terms(&mut self, columns: &DMatrix<f64>, solved: &DMatrix<f64>) -> DMatrix<f64> {
        let shape = &self.family.shape;
        let (size, k, last) = (shape.unknowns, shape.costates, shape.constants);
        let mut inputs: Vec<Bounded> = self.inputs.iter().map(|&x| Bounded::from_f64(x)).collect();
        // what vanishes along the curve is known to the digits of what moves there
        let (start, end) = self.span();
        let (n, time) = (shape.coordinates, (end - start).abs());
        let of_velocities = inputs[self.family.parameters().len() + 1 + n..].iter_mut().take(n);
        for (v, scale) in of_velocities.zip(&self.scales.coordinates) {
            v.magnitude = v.magnitude.max(scale / time);
        }
        let magnitudes: Vec<f64> = self.bounded.evaluate(&inputs).iter().map(|x| x.magnitude).collect();
        let instant = shape.instant(&magnitudes);
        let mut right = DMatrix::from_row_slice(size, k, instant.by_costate) * columns.abs();
        right += DMatrix::from_row_slice(size, size, instant.matrix) * solved.abs();
        for (r, rest) in right.column_mut(last).iter_mut().zip(instant.rest) {
            *r += rest;
        }
        // entries of an inverse are known to a part of the largest: all are of size 1
        let Scales { residuals, unknowns, .. } = &self.scales;
        let matrix = shape.instant(&self.values).matrix;
        let scaled = DMatrix::from_fn(size, size, |r, z| residuals[r] * matrix[r * size + z] * unknowns[z]);
        right.row_iter_mut().zip(residuals).for_each(|(mut row, factor)| row *= *factor);
        // the curve's own accelerations are known to the digits of the forces that balance in them
        let forces: Vec<f64> = instant.rest.iter().zip(residuals).map(|(rest, factor)| rest * factor).collect();
        for &z in &shape.accelerations {
            let column = scaled.column(z).abs();
            let force = column.iter().zip(&forces).filter(|(x, _)| **x > 0.0).map(|(_, f)| *f).fold(0.0, f64::max);
            right.column_mut(last).axpy(force, &column, 1.0);
        }
        let upper = DMatrix::from_row_slice(size, size, &self.matrix).upper_triangle();
        if let Some(lower) = upper.tr_solve_upper_triangular(&scaled.transpose()) {
            let own = DMatrix::from_fn(size, solved.ncols(), |z, c| (solved[(z, c)] / unknowns[z]).abs());
            right += lower.transpose().abs() * (upper.abs() * own);
        }
        let mut terms = scaled.try_inverse().map_or(right.clone(), |inverse| inverse.abs() * right);
        terms.row_iter_mut().zip(unknowns).for_each(|(mut row, scale)| row *= *scale);
        terms
    }

    /// Integrates to the end of the curve or as far as it gets; it stops where the rest would need more than
    /// `steps` steps.
    pub(crate) fn run(&mut self, tolerance: f64, steps: usize) -> Result<Path, DecisionError> {
        let start = self.start()?;
        let (_, end) = self.span();
        if start.y.is_empty() {
            return Ok(Path { dense: None, end, stop: None });
        }
        let options = Options {
            method: Method::Dop853,
            dense: Dense::Everywhere,
            sizes: self.sizes(&start, end)?,
            max_steps: steps,
            patience: steps as f64,
            ..Options::with_tolerance(tolerance)
        };
        let solution = integrate(self, &start, end, &options)?;
        let stop = match solution.status {
            Status::Completed => None,
            Status::Stopped { cause: StopCause::TooManySteps { .. } | StopCause::Slow { .. }, .. } => {
                Some(DecisionError::Steps { limit: steps })
            }
            Status::Stopped { cause, t } => Some(DecisionError::Curve { reason: format!("{cause} (at t = {t})") }),
        };
        Ok(Path { end: solution.dense.end(), dense: Some(solution.dense), stop })
    }

    /// Size of each state by its start and its rate there, if under its scale; at least a thousandth of that.
    fn sizes(&mut self, start: &Start, end: f64) -> Result<Vec<f64>, DecisionError> {
        let mut rates = vec![0.0; start.y.len()];
        self.rates(start.t, &start.y, &mut rates).map_err(|e| DecisionError::Curve { reason: e.reason })?;
        let way = (end - start.t).abs();
        let own = self.curve.scales(&self.scales.coordinates, way);
        let begin = self.own + self.lifted();
        let width = self.family.shape.constants + 1;
        let size = |(i, (y, rate)): (usize, (&f64, &f64))| {
            let size = y.abs() + rate.abs() * way;
            let scale = match i.checked_sub(begin) {
                Some(place) => Some(self.scales.costates[place / width]),
                None => own.get(i).copied().flatten(),
            };
            let size = scale.map_or(size, |scale| size.clamp(SMALLEST * scale, scale));
            if size > 0.0 && size.is_finite() { size } else { 1.0 }
        };
        Ok(start.y.iter().zip(&rates).enumerate().map(size).collect())
    }

    /// The mismatch at `t` of what was integrated.
    pub(crate) fn mismatch(&mut self, path: &Path, t: f64) -> Result<Mismatch, DecisionError> {
        let fault = |reason: String| DecisionError::Curve { reason };
        let mut y = vec![0.0; self.dimension()];
        if let Some(dense) = &path.dense {
            dense.try_evaluate(t, &mut y).map_err(|e| fault(e.to_string()))?;
        }
        let mut rates = vec![0.0; y.len()];
        self.load(t, &y, &mut rates).map_err(|e| fault(e.reason))?;
        let begin = self.own + self.lifted();
        self.solve(t, &y[begin..], &mut rates[begin..]).map_err(|e| fault(e.reason))?;
        let shape = &self.family.shape;
        let width = shape.constants + 1;
        let columns = DMatrix::from_row_slice(shape.costates, width, &y[begin..]);
        let unknowns = DMatrix::from_row_slice(shape.unknowns, width, &self.unknowns);
        let instant = shape.instant(&self.values);
        let n = shape.coordinates;
        let to_acceleration = DMatrix::from_row_slice(n, shape.accelerations.len(), instant.to_acceleration);
        let factor = root_of_mass(n, instant.mass, instant.jacobian);
        let factor = factor.ok_or_else(|| fault(format!("M is not positive on ker A at t = {t}")))?;
        let mass = DMatrix::from_row_slice(n, n, instant.mass);
        let length = |x: &[f64]| {
            let x = DVector::from_column_slice(x);
            x.dot(&(&mass * &x)).max(0.0).sqrt()
        };
        let whitened = factor * to_acceleration;
        let rows = &whitened * unknowns.select_rows(&shape.accelerations);
        let (acceleration, speed) = (length(&self.point.a), length(&self.point.v));
        Ok(Mismatch { rows, acceleration, speed, columns, unknowns, whitened })
    }

    /// What was added up to the rows of the last mismatch, without regard to signs: round-off is a part.
    pub(crate) fn terms_of(&mut self, last: &Mismatch) -> DMatrix<f64> {
        let terms = self.terms(&last.columns, &last.unknowns);
        last.whitened.abs() * terms.select_rows(&self.family.shape.accelerations)
    }
}

/// `√M` (n×n) for mismatches: these lie in ker A, there alone M has to be positive, and `M + c AᵀA` is M.
pub(crate) fn root_of_mass(n: usize, mass: &[f64], jacobian: &[f64]) -> Option<DMatrix<f64>> {
    let h = jacobian.len() / n;
    // each velocity in the unit in which its mass is 1
    let own = |i: usize| scales::power(mass[i * n + i].abs().sqrt().recip());
    let units: Vec<f64> = (0..n).map(own).collect();
    let mass = DMatrix::from_fn(n, n, |i, j| units[i] * mass[i * n + j] * units[j]);
    let mut jacobian = DMatrix::from_fn(h, n, |i, j| jacobian[i * n + j] * units[j]);
    jacobian.row_iter_mut().for_each(|mut row| row *= scales::power(row.amax().recip()));
    let normal = jacobian.transpose() * &jacobian;
    let unit = if h == 0 { 0.0 } else { mass.norm() / normal.norm() };
    let factor = WEIGHTS.iter().find_map(|weight| (&mass + &normal * (unit * weight)).cholesky());
    let mut root = factor?.l().transpose();
    root.column_iter_mut().zip(units).for_each(|(mut column, unit)| column /= unit);
    Some(root)
}

impl Problem for Transport<'_> {
    fn dimension(&self) -> usize {
        self.own + self.lifted() + self.family.shape.costates * (self.family.shape.constants + 1)
    }

    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        self.load(t, y, rates)?;
        let begin = self.own + self.lifted();
        self.solve(t, &y[begin..], &mut rates[begin..])
    }

    fn gauges(&self) -> &[Gauge] {
        self.curve.gauges()
    }

    fn gauged(&mut self, t: f64, y: &[f64], arguments: &mut [f64]) -> Result<(), EvaluationError> {
        self.curve.gauged(t, &y[..self.own], arguments);
        Ok(())
    }

    fn jacobian(&mut self, _: f64, _: &[f64], _: &mut [f64]) -> Result<(), EvaluationError> {
        Err(broken("the transport of constants has no Jacobian".into()))
    }
}
