//! State of a search: evaluations for the minimizer, and the best point found.

use std::cell::RefCell;

use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

use super::{BoundaryError, Residuals, SINGULAR, ShootOptions, Shot};
use crate::limits::HUGE;

/// A guess this much better than the tolerance is not improved; for others Jacobians are taken.
pub const AT_ONCE: f64 = 1e-3;

fn condition(jacobian: &DMatrix<f64>) -> f64 {
    let values = jacobian.singular_values();
    // Sorted, largest first; there is at least one.
    let (largest, smallest) = (values[0], values[values.len() - 1]);
    if smallest > 0.0 { largest / smallest } else { f64::INFINITY }
}

/// The residuals, and what is known of them so far.
pub(super) struct Search<'a> {
    residual: &'a mut dyn Residuals,
    residuals: usize,
    options: &'a ShootOptions,
    enough: f64,
    noise: f64,
    at: Vec<f64>,
    best: Vec<f64>,
    /// r there.
    nearest: Vec<f64>,
    smallest: f64,
    iterations: usize,
    exact: usize,
    evaluations: usize,
    /// r at the guess, until the minimiser asks for it.
    first: Option<Vec<f64>>,
    /// The last Jacobian.
    last: Option<DMatrix<f64>>,
}

impl<'a> Search<'a> {
    /// From a guess at which there have to be residuals, this number of them.
    pub(super) fn new(
        (residual, residuals): (&'a mut dyn Residuals, usize),
        guess: &[f64],
        options: &'a ShootOptions,
        [enough, noise]: [f64; 2],
    ) -> Result<Self, BoundaryError> {
        let mut search = Search {
            residual,
            residuals,
            options,
            enough,
            noise,
            at: guess.to_vec(),
            best: guess.to_vec(),
            nearest: Vec::new(),
            smallest: f64::INFINITY,
            iterations: 0,
            exact: 0,
            evaluations: 0,
            first: None,
            last: None,
        };
        search.first = Some(search.values(guess)?);
        Ok(search)
    }

    /// r(c), finite or an error; remembers the best c.
    fn values(&mut self, unknowns: &[f64]) -> Result<Vec<f64>, BoundaryError> {
        let mut values = vec![0.0; self.residuals];
        self.evaluations += 1;
        self.residual.residual(unknowns, &mut values)?;
        if let Some(index) = values.iter().position(|r| !r.is_finite()) {
            return Err(BoundaryError::NotFinite { index, found: values[index] });
        }
        let norm = values.iter().map(|r| r * r).sum::<f64>().sqrt();
        if norm < self.smallest {
            self.smallest = norm;
            self.best.copy_from_slice(unknowns);
            self.nearest.clone_from(&values);
        }
        Ok(values)
    }

    /// ∂r/∂c, the caller's or by differences. A column is zero where all that its unknown does within the
    /// width of a difference is noise.
    fn derivatives(&mut self, unknowns: &[f64]) -> Result<DMatrix<f64>, BoundaryError> {
        let mut entries = vec![0.0; self.residuals * unknowns.len()];
        let given = self.residual.jacobian(unknowns, &mut entries) == Ok(true);
        let jacobian = if given && entries.iter().all(|x| x.is_finite()) {
            self.exact += 1;
            let mut jacobian = DMatrix::from_row_slice(self.residuals, unknowns.len(), &entries);
            for (mut column, unknown) in jacobian.column_iter_mut().zip(unknowns) {
                let is_noise = column.norm() * 2.0 * self.step(*unknown) <= self.noise;
                column *= if is_noise { 0.0 } else { 1.0 };
            }
            jacobian
        } else {
            self.differences(unknowns)?
        };
        self.last = Some(jacobian.clone());
        Ok(jacobian)
    }

    /// Half the width of a difference.
    fn step(&self, unknown: f64) -> f64 {
        self.options.difference_step * unknown.abs().max(self.options.scale)
    }

    /// ∂r/∂c by central differences; one-sided where one side cannot be evaluated.
    fn differences(&mut self, unknowns: &[f64]) -> Result<DMatrix<f64>, BoundaryError> {
        let mut jacobian = DMatrix::zeros(self.residuals, unknowns.len());
        let mut shifted = unknowns.to_vec();
        for (j, mut column) in jacobian.column_iter_mut().enumerate() {
            let step = self.step(unknowns[j]);
            shifted[j] = unknowns[j] + step;
            let above = self.values(&shifted);
            shifted[j] = unknowns[j] - step;
            let below = self.values(&shifted);
            shifted[j] = unknowns[j];
            let (above, below, width) = match (above, below) {
                (Ok(above), Ok(below)) => (above, below, 2.0 * step),
                (Ok(above), Err(_)) => (above, self.values(unknowns)?, step),
                (Err(_), Ok(below)) => (self.values(unknowns)?, below, step),
                (Err(error), Err(_)) => return Err(error),
            };
            for (i, entry) in column.iter_mut().enumerate() {
                *entry = above[i] - below[i];
            }
            column *= if column.norm() > self.noise { width.recip() } else { 0.0 };
        }
        Ok(jacobian)
    }

    /// One step more by a Jacobian of this condition, kept where it is one nearer; none where what was found
    /// is not good enough.
    fn finish(&mut self, condition: f64) {
        if self.smallest == 0.0 || self.smallest > self.enough {
            return;
        }
        let (best, last) = (self.best.clone(), self.last.take().filter(|_| condition <= SINGULAR));
        let Some(jacobian) = last else { return };
        if let Some(step) = jacobian.lu().solve(&DVector::from_column_slice(&self.nearest)) {
            // what cannot be evaluated is not nearer
            let _ = self.values(&best.iter().zip(step.iter()).map(|(c, s)| c - s).collect::<Vec<_>>());
        }
    }
}

/// What the minimiser sees.
pub(super) struct Target<'a>(RefCell<Search<'a>>);

impl<'a> Target<'a> {
    pub(super) fn new(search: Search<'a>) -> Self {
        Target(RefCell::new(search))
    }

    /// What was found, after one step more.
    pub(super) fn found(self) -> Shot {
        let mut search = self.0.into_inner();
        let condition = search.last.as_ref().map_or(f64::INFINITY, condition);
        search.finish(condition);
        let Search { best, smallest, iterations, exact, evaluations, options, .. } = search;
        let exhausted = iterations >= options.max_iterations;
        Shot { unknowns: best, residual: smallest, iterations, exact, evaluations, exhausted, condition }
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Target<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, unknowns: &DVector<f64>) {
        self.0.get_mut().at.copy_from_slice(unknowns.as_slice());
    }

    fn params(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.0.borrow().at)
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let search = &mut *self.0.borrow_mut();
        let at = search.at.clone();
        // it asks for the guess first
        let values = match search.first.take() {
            Some(values) => Ok(values),
            None => search.values(&at),
        };
        let values = values.unwrap_or_else(|_| vec![HUGE; search.residuals]);
        Some(DVector::from_vec(values))
    }

    /// `None` ends the minimisation: good enough, out of iterations, or no derivatives.
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let search = &mut *self.0.borrow_mut();
        let enough = if search.iterations == 0 { AT_ONCE * search.enough } else { search.enough };
        if search.smallest <= enough || search.iterations >= search.options.max_iterations {
            return None;
        }
        search.iterations += 1;
        let at = search.at.clone();
        search.derivatives(&at).ok()
    }
}
