//! Projection of a state onto its constraint.

use symbolic::limits::{ITERATIONS, NOTHING};
use symbolic::{CompileError, Evaluator, Symbol};

use crate::blocks::EvaluationFailure;
use crate::equations::{ConstraintProjection, Equations};
use mechanics::linear::{Factors, PIVOT_LIMIT, Singular};

/// A Newton step under this length relative to the velocity ends the iteration.
pub(crate) const LIMIT: f64 = 4.0 * f64::EPSILON;

/// Minimizes `δvᵀ M δv` subject to `f(q, v + δv, t) = 0`, by Newton steps
///
/// ```text
/// [ M  Aᵀ ] [ δv ]   [  0 ]
/// [ A  0  ] [ κ  ] = [ −f ]
/// ```
///
/// `M` regular on the kernel of `A` is enough. One step is exact where `f` is linear in `v`.
#[derive(Clone)]
pub(crate) struct Projector {
    /// Outputs: the matrix row-major, then `f`.
    pub(crate) program: Evaluator<f64>,
    /// Where the velocities stand in `y`.
    pub(crate) places: Vec<usize>,
    pub(crate) constraints: usize,
    factors: Factors,
    right: Vec<f64>,
}

impl Projector {
    pub(crate) fn new(
        equations: &Equations,
        projection: &ConstraintProjection,
        known: &[Symbol],
    ) -> Result<Self, CompileError> {
        let g = &equations.graph;
        let (n, h) = (projection.velocities.len(), projection.constraints.len());
        let mut outputs = Vec::with_capacity((n + h) * (n + h) + h);
        for i in 0..n + h {
            for j in 0..n + h {
                outputs.push(match (i < n, j < n) {
                    (true, true) => projection.metric[(i, j)],
                    (true, false) => projection.jacobian[(j - n, i)],
                    (false, true) => projection.jacobian[(i - n, j)],
                    (false, false) => g.zero(),
                });
            }
        }
        outputs.extend(&projection.constraints);
        let place = |v: &Symbol| known.iter().position(|s| s == v).map(|i| i - 1);
        Ok(Projector {
            program: equations.evaluator(known, &outputs)?,
            places: projection.velocities.iter().filter_map(place).collect(),
            constraints: h,
            factors: Factors::new(n + h),
            right: vec![0.0; n + h],
        })
    }

    /// `inputs` holds `t, y, constants`.
    pub(crate) fn project(&mut self, inputs: &mut [f64], y: &mut [f64]) -> Result<f64, EvaluationFailure> {
        let n = self.places.len();
        let size = n + self.constraints;
        let mut moved = vec![0.0; n];
        let (mut iterations, mut relative) = (0, 0.0);
        while iterations < ITERATIONS {
            let values = self.program.evaluate(inputs);
            let (matrix, f) = values.split_at(size * size);
            if f.iter().all(|&x| x == 0.0) {
                relative = 0.0;
                break;
            }
            self.right[..n].fill(0.0);
            for (r, x) in self.right[n..].iter_mut().zip(f) {
                *r = -x;
            }
            self.factors.factorize(matrix).map_err(|Singular { reciprocal }| EvaluationFailure::Singular {
                reciprocal,
                limit: PIVOT_LIMIT,
                regular: "constraint Jacobian of full row rank, metric regular on its kernel",
            })?;
            self.factors.solve(&mut self.right);
            let (mut step, mut speed) = (0.0_f64, 0.0_f64);
            for (i, &place) in self.places.iter().enumerate() {
                y[place] += self.right[i];
                inputs[1 + place] = y[place];
                moved[i] += self.right[i];
                step = step.max(self.right[i].abs());
                speed = speed.max(y[place].abs());
            }
            (iterations, relative) = (iterations + 1, if step == 0.0 { 0.0 } else { step / speed });
            if relative <= LIMIT || !moved.iter().all(|x| x.is_finite()) {
                break;
            }
        }
        if relative > NOTHING || !moved.iter().all(|x| x.is_finite()) {
            return Err(EvaluationFailure::NotProjected { iterations, step: relative, limit: NOTHING });
        }
        Ok(moved.iter().map(|x| x * x).sum::<f64>().sqrt())
    }
}
