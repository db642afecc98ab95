//! The motion in time, with the state either `(q, v)` or `(q, ν)`.

use integrate::{EvaluationError, Options, Problem, Projection, Solution, Start, Status, StopCause};
use mechanics::State;
use nalgebra::{ColPivQR, DMatrix, DVector, Dyn, LU, RowDVector};

use super::{Maggi, MaggiError, check_finite, dot, row_lengths, solve_square};

/// Largest [`Maggi::constraint_residual`] of a start.
pub const START_LIMIT: f64 = 1e-9;

/// A reduced run ends where the dependent part's determinant is under this fraction of that at the start.
pub const SPLITTING_LIMIT: f64 = 0.01;

/// The state that is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `(q, ν)`, n + m numbers, for `f = A(q,t) v + b(q,t)`: the quasi-velocities `ν` are the velocities of m
    /// coordinates chosen at the start, the other h follow from them, and the constraint holds identically:
    ///
    /// ```text
    /// v = N ν + c ,       N = [ 1 ; −A_d⁻¹A_i ] ,   c = [ 0 ; −A_d⁻¹b ]   (rows: independent; dependent)
    /// NᵀMN ν' = Nᵀ(F − M κ) ,                       κ = [ 0 ; −A_d⁻¹γ ] ,       a = N ν' + κ
    /// ```
    ///
    /// A run ends where `A_d` loses rank ([`Ending::SplittingLost`]).
    Reduced,
    /// `(q, v)`, 2n numbers, with `v' = a` of [`Maggi::accelerations`]. For any constraints; nothing breaks
    /// but what is singular in itself. `f` stays zero only as well as the integration is accurate.
    Accelerations,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At the end asked for.
    Completed,
    /// [`Form::Reduced`]: the dependent velocities no longer follow. [`Form::Accelerations`] goes on.
    SplittingLost {
        /// Where.
        t: f64,
        /// Determinant of the dependent part of `A` (rows of `A` of length 1) over that at the start.
        found: f64,
        /// [`SPLITTING_LIMIT`].
        limit: f64,
    },
    /// The integrator stopped.
    Stopped {
        /// Where.
        t: f64,
        /// Why; [`StopCause::Evaluation`] with [`MaggiError`]'s words where a matrix became singular.
        cause: StopCause,
    },
}

/// A motion, as far as it came.
#[derive(Clone, Debug)]
pub struct Motion {
    /// What was integrated.
    pub form: Form,
    /// The integrator's solution: `(q, v)` or `(q, ν)`, according to `form`; [`Motion::state`] reads both.
    pub solution: Solution,
    ending: Ending,
    maggi: Maggi,
    splitting: Option<Splitting>,
    y: Vec<f64>,
}

impl Motion {
    /// How the run ended. Whatever it says, the motion is valid up to [`Motion::end`].
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// How far the motion came.
    pub fn end(&self) -> f64 {
        self.solution.dense.end()
    }

    /// Time, positions and velocities at `t`.
    ///
    /// # Errors
    /// [`MaggiError::Dense`] for a time that the motion does not have.
    pub fn state(&mut self, t: f64) -> Result<State, MaggiError> {
        let n = self.maggi.n;
        self.solution.dense.try_evaluate(t, &mut self.y)?;
        let (q, rest) = self.y.split_at(n);
        let mut v = rest.to_vec();
        if let Some(splitting) = &self.splitting {
            v.resize(n, 0.0);
            splitting.velocities(&mut self.maggi, t, q, rest, &mut v)?;
        }
        Ok(State { t, q: q.to_vec(), v })
    }
}

/// See [`Maggi::solve`].
pub(super) fn solve(
    maggi: &mut Maggi,
    start: &State,
    end: f64,
    tolerance: f64,
    form: Form,
) -> Result<Motion, MaggiError> {
    let State { t, q, v } = start;
    maggi.accelerations(*t, q, v)?;
    let found = maggi.constraint_residual(*t, q, v)?;
    if found > START_LIMIT {
        return Err(MaggiError::OffConstraint { found, limit: START_LIMIT });
    }
    let splitting = match form {
        Form::Accelerations => None,
        Form::Reduced => Some(Splitting::new(maggi, *t, q)?),
    };
    let mut y = q.clone();
    match &splitting {
        None => y.extend(v),
        Some(splitting) => y.extend(splitting.independent.iter().map(|&i| v[i])),
    }
    let n = maggi.n;
    let mut run = Run { maggi, splitting, v: vec![0.0; n], unknowns: y.len() };
    let start = Start { t: *t, y };
    let options = Options { projection: Projection::Off, ..Options::with_tolerance(tolerance) };
    let solution = integrate::integrate(&mut run, &start, end, &options)?;
    let Run { splitting, .. } = run;
    let ending = match (&solution.status, &splitting) {
        (Status::Completed, _) => Ending::Completed,
        (Status::Stopped { t, cause: StopCause::Event { .. } }, Some(splitting)) => {
            let found = splitting.determinant(maggi, *t, &solution.dense.end_state()[..n])?;
            Ending::SplittingLost { t: *t, found, limit: SPLITTING_LIMIT }
        }
        (Status::Stopped { t, cause }, _) => Ending::Stopped { t: *t, cause: cause.clone() },
    };
    Ok(Motion { form, solution, ending, maggi: maggi.clone(), splitting, y: start.y })
}

/// Coordinates whose velocities follow from the constraints, and the others, whose velocities are `ν`.
#[derive(Clone, Debug)]
struct Splitting {
    dependent: Vec<usize>,
    independent: Vec<usize>,
    /// `det A_d` at the start, the rows of `A` having length 1.
    at_start: f64,
}

/// `A` and `b` of `f = A v + b`, with `A_d` factorized; rows divided by the lengths of the rows of `A`.
struct Kinematics<'a> {
    jacobian: &'a [f64],
    offset: &'a [f64],
    lengths: Vec<f64>,
    dependent: LU<f64, Dyn, Dyn>,
}

/// How the dependent velocities follow from the independent ones.
struct Dependence {
    /// `A_d⁻¹A_i`, h×m.
    slopes: DMatrix<f64>,
    /// `A_d`, its rows divided by `lengths`.
    factors: LU<f64, Dyn, Dyn>,
    lengths: Vec<f64>,
}

impl Splitting {
    /// The dependent coordinates are the pivots of a column-pivoted QR factorization of `A`.
    fn new(maggi: &mut Maggi, t: f64, q: &[f64]) -> Result<Self, MaggiError> {
        let (n, h) = (maggi.n, maggi.h);
        let (jacobian, _) = affine(maggi, t, q)?;
        let lengths = row_lengths(t, jacobian, n)?;
        let factors = ColPivQR::new(DMatrix::from_fn(h, n, |i, j| jacobian[i * n + j] / lengths[i]));
        let mut order = RowDVector::from_fn(n, |_, j| j);
        factors.p().permute_columns(&mut order);
        let (mut dependent, mut independent) = (order.as_slice()[..h].to_vec(), order.as_slice()[h..].to_vec());
        dependent.sort_unstable();
        independent.sort_unstable();
        let mut splitting = Splitting { dependent, independent, at_start: 1.0 };
        splitting.at_start = splitting.determinant(maggi, t, q)?;
        Ok(splitting)
    }

    fn kinematics<'a>(&self, maggi: &'a mut Maggi, t: f64, q: &[f64]) -> Result<Kinematics<'a>, MaggiError> {
        let (n, h) = (maggi.n, maggi.h);
        let (jacobian, offset) = affine(maggi, t, q)?;
        let lengths = row_lengths(t, jacobian, n)?;
        let dependent = DMatrix::from_fn(h, h, |i, j| jacobian[i * n + self.dependent[j]] / lengths[i]);
        Ok(Kinematics { jacobian, offset, lengths, dependent: LU::new(dependent) })
    }

    /// `det A_d` over that at the start: 1 there, 0 where the splitting breaks, of the other sign beyond.
    fn determinant(&self, maggi: &mut Maggi, t: f64, q: &[f64]) -> Result<f64, MaggiError> {
        let kinematics = self.kinematics(maggi, t, q)?;
        Ok(if kinematics.lengths.is_empty() { 1.0 } else { kinematics.dependent.determinant() / self.at_start })
    }

    /// Writes `v = N ν + c`.
    fn velocities(
        &self,
        maggi: &mut Maggi,
        t: f64,
        q: &[f64],
        nu: &[f64],
        v: &mut [f64],
    ) -> Result<Dependence, MaggiError> {
        let (n, h, m) = (maggi.n, self.dependent.len(), self.independent.len());
        let Kinematics { jacobian, offset, lengths, dependent } = self.kinematics(maggi, t, q)?;
        let mut solved = DMatrix::from_fn(h, m + 1, |i, j| {
            let entry = if j < m { jacobian[i * n + self.independent[j]] } else { offset[i] };
            entry / lengths[i]
        });
        if h > 0 && !dependent.solve_mut(&mut solved) {
            return Err(MaggiError::DependentConstraints { t, found: 0.0, limit: SPLITTING_LIMIT });
        }
        for (&i, nu) in self.independent.iter().zip(nu) {
            v[i] = *nu;
        }
        for (k, &i) in self.dependent.iter().enumerate() {
            v[i] = -solved[(k, m)] - nu.iter().enumerate().map(|(j, nu)| solved[(k, j)] * nu).sum::<f64>();
        }
        check_finite("a dependent velocity", t, v)?;
        Ok(Dependence { slopes: solved.remove_column(m), factors: dependent, lengths })
    }

    /// Writes `v` and `ν'`.
    fn rates(
        &self,
        maggi: &mut Maggi,
        t: f64,
        q: &[f64],
        nu: &[f64],
        v: &mut [f64],
        nu_rates: &mut [f64],
    ) -> Result<(), MaggiError> {
        let (n, m) = (maggi.n, self.independent.len());
        let Dependence { slopes, factors, lengths } = self.velocities(maggi, t, q, nu, v)?;
        let instant = maggi.instant(t, q, v)?;
        let mut drift = DVector::from_iterator(lengths.len(), instant.gamma.iter().zip(&lengths).map(|(g, l)| g / l));
        if !lengths.is_empty() && !factors.solve_mut(&mut drift) {
            return Err(MaggiError::DependentConstraints { t, found: 0.0, limit: SPLITTING_LIMIT });
        }
        // Columns 0 to m − 1: N; column m: κ.
        let mut basis = DMatrix::zeros(n, m + 1);
        for (j, &i) in self.independent.iter().enumerate() {
            basis[(i, j)] = 1.0;
        }
        for (k, &i) in self.dependent.iter().enumerate() {
            for j in 0..m {
                basis[(i, j)] = -slopes[(k, j)];
            }
            basis[(i, m)] = -drift[k];
        }
        let column = |j: usize| &basis.as_slice()[j * n..(j + 1) * n];
        // Column j: M times column j of the basis.
        let carried = DMatrix::from_fn(n, m + 1, |i, j| dot(&instant.mass[i * n..(i + 1) * n], column(j)));
        let carried = carried.as_slice().chunks_exact(n).collect::<Vec<_>>();
        let scale = instant.mass_scale()?;
        let matrix = DMatrix::from_fn(m, m, |i, j| dot(column(i), carried[j]) / scale);
        let right = DVector::from_fn(m, |i, _| (dot(column(i), instant.force) - dot(column(i), carried[m])) / scale);
        nu_rates.copy_from_slice(solve_square(t, matrix, right)?.as_slice());
        Ok(())
    }
}

/// `A` (row-major) and `b` at `(t, q)`.
fn affine<'a>(maggi: &'a mut Maggi, t: f64, q: &[f64]) -> Result<(&'a [f64], &'a [f64]), MaggiError> {
    let entries = maggi.n * maggi.h;
    let program = maggi.affine.as_mut().map_err(|number| MaggiError::NotLinear { number: *number })?;
    let outputs = program.evaluate(t, q, &[]);
    check_finite("the constraint Jacobian or the constraint at rest", t, outputs)?;
    Ok(outputs.split_at(entries))
}

/// What the integrator integrates.
struct Run<'a> {
    maggi: &'a mut Maggi,
    splitting: Option<Splitting>,
    v: Vec<f64>,
    unknowns: usize,
}

impl Problem for Run<'_> {
    fn dimension(&self) -> usize {
        self.unknowns
    }

    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        let n = self.maggi.n;
        let (q, rest) = y.split_at(n);
        let (q_rates, rest_rates) = rates.split_at_mut(n);
        let done = match &self.splitting {
            None => {
                q_rates.copy_from_slice(rest);
                self.maggi.write_accelerations(t, q, rest, rest_rates)
            }
            Some(splitting) => {
                let done = splitting.rates(self.maggi, t, q, rest, &mut self.v, rest_rates);
                q_rates.copy_from_slice(&self.v);
                done
            }
        };
        done.map_err(in_words)
    }

    fn jacobian(&mut self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        Err(EvaluationError { reason: "the referee has no Jacobian of its rates".into() })
    }

    fn events(&self) -> usize {
        usize::from(self.splitting.is_some() && self.maggi.h > 0)
    }

    fn event_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvaluationError> {
        if let (Some(splitting), [value]) = (&self.splitting, values) {
            *value = splitting.determinant(self.maggi, t, &y[..self.maggi.n]).map_err(in_words)? - SPLITTING_LIMIT;
        }
        Ok(())
    }
}

fn in_words(error: MaggiError) -> EvaluationError {
    EvaluationError { reason: error.to_string() }
}
