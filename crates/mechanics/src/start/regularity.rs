//! Whether a system has well-posed equations of motion at a point, whatever its units.

use nalgebra::{DMatrix, DVector};
use symbolic::limits::{DEPENDENT, ITERATIONS, OF_TERMS, SAME};
use symbolic::{Bounded, Symbol};

use super::error::{Quantity, StartError, check_lengths};
use super::numeric::AtState;
use crate::newton::decompose;
use crate::{SingularValues, State, System};

/// The part of the rows of `M` that is balance enough.
const BALANCED: f64 = 0.5;

/// Checks at `state` that `L`, `f` and `Q` are finite, that `A = ∂f/∂v` has full row rank and that `NᵀMN` is
/// regular: `M = ∂²L/∂v²`, the columns of `N` a basis of ker `A`. `M` itself may be singular, or indefinite.
///
/// Entries are compared within their row and column, and those that may be round-off (`sin(pi)`) are zero, so
/// that neither units nor round-off can feign a rank.
///
/// # Errors
/// [`StartError::NotFinite`], [`StartError::DependentConstraints`], [`StartError::SingularMassMatrix`].
pub fn check_regularity(system: &System, state: &State) -> Result<(), StartError> {
    check_lengths(system, state)?;
    Regularity::new(system, &[]).check(state, &[])
}

/// Checks at `state` that reactions along the rows of `W`, of [`System::virtual_conditions`], can keep the
/// constraints: that `W` has full row rank, and `(N_W)ᵀ M N_A` is regular, whose columns are bases of ker `W`
/// and ker `A`. For regular `M` that is to say that `W M⁻¹ Aᵀ` is.
///
/// # Errors
/// [`StartError::SingularReactions`]; as [`check_regularity`].
pub fn check_reactions(system: &System, state: &State) -> Result<(), StartError> {
    check_lengths(system, state)?;
    let scaled = |system: &System| Regularity::new(system, &[]).scaled(state, &[]);
    let own = System { constraints: system.virtual_conditions.clone(), ..system.clone() };
    let (own, kept) = (scaled(&own)?, scaled(system)?);
    let singular = |singular_values, ratio| StartError::SingularReactions { singular_values, ratio, limit: DEPENDENT };
    if let Err(StartError::DependentConstraints { singular_values, ratio, .. }) = own.check_constraints(DEPENDENT) {
        return Err(singular(singular_values, ratio));
    }
    let between = own.kernel()?.tr_mul(&(&kept.mass * kept.kernel()?));
    match ratio(&decompose(&between)?.values) {
        (ratio, _) if ratio > DEPENDENT => Ok(()),
        (ratio, singular_values) => Err(singular(singular_values, ratio)),
    }
}

/// `A` in units that make its entries of order 1, and the ratio of its singular values; `None` where that is
/// over a limit.
pub(super) fn nearly_dependent(
    system: &System,
    state: &State,
    limit: f64,
) -> Result<Option<(ScaledMatrices, f64)>, StartError> {
    let scaled = Regularity::new(system, &[]).scaled(state, &[])?;
    let ratio = scaled.check_constraints(limit)?;
    Ok((ratio <= limit).then_some((scaled, ratio)))
}

/// What [`check_regularity`] checks, compiled for values of some parameters.
#[derive(Clone)]
pub(super) struct Regularity {
    /// `L`, `f` and `Q`, one by one: faults have a name.
    finite: Vec<(Quantity, AtState)>,
    /// `A`, then `M`.
    entries: AtState<Bounded>,
    /// h and n.
    shape: (usize, usize),
}

impl Regularity {
    pub(super) fn new(system: &System, varied: &[Symbol]) -> Self {
        let constraints = system.constraints.iter().enumerate();
        let forces = system.forces.iter().zip(&system.coordinates);
        let quantities = std::iter::once((Quantity::Lagrangian, system.lagrangian))
            .chain(constraints.map(|(i, &f)| (Quantity::Constraint(i + 1), f)))
            .chain(forces.map(|(&f, c)| (Quantity::Force(c.name.clone()), f)));
        let entries = [system.constraint_jacobian().entries(), system.velocity_hessian().entries()].concat();
        Regularity {
            finite: quantities.map(|(quantity, e)| (quantity, AtState::new(system, varied, &[e]))).collect(),
            entries: AtState::new(system, varied, &entries),
            shape: (system.constraints.len(), system.dimension()),
        }
    }

    pub(super) fn check(&mut self, state: &State, varied: &[f64]) -> Result<(), StartError> {
        for (quantity, numeric) in &mut self.finite {
            let value = match numeric.at(state, varied) {
                Ok(values) => values[0],
                Err(symbolic::CompileError::NotFinite { .. }) => f64::NAN,
                Err(error) => return Err(error.into()),
            };
            if !value.is_finite() {
                return Err(StartError::NotFinite { quantity: quantity.clone(), value });
            }
        }
        let scaled = self.scaled(state, varied)?;
        scaled.check_constraints(DEPENDENT)?;
        scaled.check_mass()
    }

    /// Checks the constraint Jacobian alone.
    pub(super) fn check_constraints(&mut self, state: &State, varied: &[f64]) -> Result<(), StartError> {
        self.scaled(state, varied)?.check_constraints(DEPENDENT).map(|_| ())
    }

    fn scaled(&mut self, state: &State, varied: &[f64]) -> Result<ScaledMatrices, StartError> {
        ScaledMatrices::new(self.entries.at(state, varied)?, self.shape)
    }
}

/// `A` and `M` in units in which their entries are of order 1.
pub(super) struct ScaledMatrices {
    pub(super) constraint_jacobian: DMatrix<f64>,
    mass: DMatrix<f64>,
    /// Factors of the rows of `A`.
    pub(super) rows: DVector<f64>,
}

impl ScaledMatrices {
    fn new(entries: &[Bounded], (h, n): (usize, usize)) -> Result<Self, StartError> {
        if let Some(place) = entries.iter().position(|x| !x.value.is_finite()) {
            let quantity = if place < h * n { Quantity::ConstraintJacobian } else { Quantity::MassMatrix };
            return Err(StartError::NotFinite { quantity, value: entries[place].value });
        }
        let known = |x: &Bounded| if x.value.abs() <= OF_TERMS * x.magnitude { 0.0 } else { x.value };
        let a = DMatrix::from_row_iterator(h, n, entries[..h * n].iter().map(known));
        let m = DMatrix::from_row_iterator(n, n, entries[h * n..].iter().map(known));
        let columns = column_scale(&a, &m);
        let scaled_a = DMatrix::from_fn(h, n, |i, j| a[(i, j)].abs() * columns[j]);
        let rows = DVector::from_fn(h, |i, _| inverse_or_one(scaled_a.row(i).amax()));
        Ok(ScaledMatrices {
            constraint_jacobian: DMatrix::from_fn(h, n, |i, j| rows[i] * a[(i, j)] * columns[j]),
            mass: DMatrix::from_fn(n, n, |i, j| columns[i] * m[(i, j)] * columns[j]),
            rows,
        })
    }

    /// The ratio of the singular values of `A`, 1 where there is no constraint; where it is over `enough`,
    /// any such number.
    fn check_constraints(&self, enough: f64) -> Result<f64, StartError> {
        if self.constraint_jacobian.nrows() == 0 {
            return Ok(1.0);
        }
        let at_least = SingularValues::least_at_least(&self.constraint_jacobian);
        let at_least = at_least / self.constraint_jacobian.norm().max(1.0);
        if at_least > enough {
            return Ok(at_least);
        }
        let values = match self.constraint_jacobian.nrows() {
            1 => DVector::from_element(1, self.constraint_jacobian.norm()),
            _ => decompose(&self.constraint_jacobian)?.values,
        };
        let (ratio, singular_values) = ratio(&values);
        if ratio > DEPENDENT {
            return Ok(ratio);
        }
        let combination = self.redundant()?;
        Err(StartError::DependentConstraints { combination, singular_values, ratio, limit: DEPENDENT })
    }

    /// The combination of constraints that is nearest to zero, the largest factor 1; small ones left out.
    fn redundant(&self) -> Result<Vec<(usize, f64)>, StartError> {
        let product = &self.constraint_jacobian * self.constraint_jacobian.transpose();
        let right = decompose(&product)?.right;
        let last = right.row(right.nrows() - 1);
        let of_rows: Vec<f64> = last.iter().zip(self.rows.iter()).map(|(x, row)| x * row).collect();
        let largest = of_rows.iter().copied().fold(0.0_f64, |a, x| if x.abs() > a.abs() { x } else { a });
        let factors = of_rows.iter().map(|x| x / largest).enumerate();
        Ok(factors.filter(|(_, x)| x.abs() > SAME).map(|(i, x)| (i + 1, x)).collect())
    }

    /// Whether the circles of Gershgorin tell that `M`, and with it `NᵀMN`, is far from singular.
    fn is_dominant(&self) -> bool {
        let circles = self.mass.row_iter().enumerate().map(|(i, row)| {
            let sizes: f64 = row.iter().map(|x| x.abs()).sum();
            (row[i] + row[i].abs() - sizes, sizes)
        });
        let (least, largest) = circles.fold((f64::INFINITY, 1.0_f64), |(a, b), (c, d)| (a.min(c), b.max(d)));
        least > DEPENDENT * largest
    }

    /// A basis of ker `A`, in columns.
    fn kernel(&self) -> Result<DMatrix<f64>, StartError> {
        let (h, n) = self.constraint_jacobian.shape();
        let padded = self.constraint_jacobian.clone().resize(n, n, 0.0);
        Ok(decompose(&padded)?.right.rows_range(h..).transpose())
    }

    fn check_mass(&self) -> Result<(), StartError> {
        if self.is_dominant() {
            return Ok(());
        }
        let kernel = self.kernel()?;
        let (ratio, singular_values) = ratio(&decompose(&kernel.tr_mul(&(&self.mass * &kernel)))?.values);
        if ratio > DEPENDENT {
            return Ok(());
        }
        Err(StartError::SingularMassMatrix { singular_values, ratio, limit: DEPENDENT })
    }
}

/// Smallest over largest singular value, and all of them in falling order.
///
/// The largest counts as at least 1, the size of scaled entries: one singular value has no ratio of its own.
fn ratio(values: &DVector<f64>) -> (f64, Vec<f64>) {
    let least = values.iter().next_back().map_or(0.0, |s| s / values.amax().max(1.0));
    (least, values.as_slice().to_vec())
}

fn inverse_or_one(x: f64) -> f64 {
    if x > 0.0 && (1.0 / x).is_finite() { 1.0 / x } else { 1.0 }
}

/// A unit for each velocity: where `M` knows the coordinate, the one that makes the largest entry of its row
/// 1; else the one that makes its part in a constraint as large as that of the others.
fn column_scale(a: &DMatrix<f64>, m: &DMatrix<f64>) -> DVector<f64> {
    let has_mass: Vec<bool> = m.row_iter().map(|row| row.amax() > 0.0).collect();
    let mut scale = DVector::from_fn(m.nrows(), |j, _| if has_mass[j] { 1.0 } else { 0.0 });
    for _ in 0..ITERATIONS {
        let largest = |i: usize| m.row(i).transpose().component_mul(&scale).amax() * scale[i];
        let largest: Vec<f64> = (0..m.nrows()).map(largest).collect();
        scale.iter_mut().zip(&largest).for_each(|(s, size)| *s *= inverse_or_one(size.sqrt()));
        if (0..m.nrows()).all(|i| !has_mass[i] || (largest[i] - 1.0).abs() < BALANCED) {
            break;
        }
    }
    let rows: Vec<f64> = a.row_iter().map(|row| row.transpose().component_mul(&scale).amax()).collect();
    for j in (0..m.nrows()).filter(|&j| !has_mass[j]) {
        let part = |(i, &row): (usize, &f64)| if row > 0.0 { a[(i, j)].abs() / row } else { 0.0 };
        scale[j] = inverse_or_one(rows.iter().enumerate().map(part).fold(0.0, f64::max));
    }
    scale
}
