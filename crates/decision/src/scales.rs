//! Scaling: sizes of equations, unknowns and constants from the start, the time and `M`.

use nalgebra::DMatrix;
use symbolic::limits::{LAST_DIGITS, NOTHING};

use crate::family::{CostateRate, Instant, Shape};

/// Scales of curve, costates and constants, powers of two: scaled by them, results do not depend on units,
/// and scaling rounds nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scales {
    /// Scales of the coordinates: distances that the energy allows; divided by the time, those of the
    /// velocities.
    pub(crate) coordinates: Vec<f64>,
    /// Factors of the residuals.
    pub(crate) residuals: Vec<f64>,
    /// Scales of the unknowns of one instant, of the costates, of the constants.
    pub(crate) unknowns: Vec<f64>,
    pub(crate) costates: Vec<f64>,
    pub(crate) constants: Vec<f64>,
}

/// Data at the start from which scales are computed.
pub(crate) struct Start<'a> {
    /// One instant, and the terms that add up in it without regard to signs.
    pub(crate) instant: Instant<'a, f64>,
    pub(crate) terms: Instant<'a, f64>,
    pub(crate) velocities: &'a [f64],
    pub(crate) accelerations: &'a [f64],
    /// `η(t₀)`, row by row: one coefficient for each constant, and the rest.
    pub(crate) costates: &'a [f64],
    pub(crate) time: f64,
}

/// The power of two next to `x`; 1 where that says no size.
pub(crate) fn power(x: f64) -> f64 {
    let power = x.log2().round().exp2();
    if power > 0.0 && power.is_finite() { power } else { 1.0 }
}

/// The least of what says a size.
fn least(sizes: impl Iterator<Item = f64>) -> Option<f64> {
    sizes.filter(|x| *x > 0.0 && x.is_finite()).reduce(f64::min)
}

impl Scales {
    pub(crate) fn new(shape: &Shape, start: &Start) -> Scales {
        let (n, size, k, time) = (shape.coordinates, shape.unknowns, shape.costates, start.time);
        let mass = DMatrix::from_row_slice(n, n, start.instant.mass);
        let matrix = DMatrix::from_row_slice(size, size, start.instant.matrix);
        let moving = &shape.accelerations;
        let to_acceleration = DMatrix::from_row_slice(n, moving.len(), start.instant.to_acceleration);
        let of_unknowns = to_acceleration.transpose() * &mass * &to_acceleration;
        // what each equation would do alone: force or curvature over its length in the metric `M⁻¹`
        let masses = of_unknowns.diagonal().abs();
        let work = |r: usize| {
            let square = |(&z, mass): (&usize, &f64)| if *mass > 0.0 { matrix[(r, z)].powi(2) / mass } else { 0.0 };
            let length: f64 = moving.iter().zip(masses.iter()).map(square).sum();
            if length > 0.0 { (start.terms.rest[r] * time).powi(2) / length } else { 0.0 }
        };
        let kinetic = |i: usize| {
            let [v, a] = [start.velocities[i], start.accelerations[i] * time];
            mass[(i, i)].abs() * (v * v + a * a)
        };
        let mut energy: f64 = (0..n).map(kinetic).sum();
        let works: f64 = (0..size).map(work).sum();
        // what round-off leaves of accelerations where forces balance is no motion
        if energy <= LAST_DIGITS.powi(2) * works {
            energy = works;
        }
        let energy = if energy > 0.0 && energy.is_finite() { energy } else { 1.0 };
        let speed = |mass: f64| if mass != 0.0 { (energy / mass.abs()).sqrt() } else { 0.0 };
        let mut speeds: Vec<f64> = (0..n).map(|i| speed(mass[(i, i)])).collect();
        fill(&mut speeds, &DMatrix::from_row_slice(shape.constraints, n, start.instant.jacobian));
        let mut rates: Vec<f64> = (0..moving.len()).map(|i| speed(of_unknowns[(i, i)])).collect();
        fill(&mut rates, &matrix.select_columns(moving));
        let mut unknowns = vec![0.0; size];
        moving.iter().zip(&rates).for_each(|(&z, rate)| unknowns[z] = power(rate / time));
        let row =
            |unknowns: &[f64], r: usize| (0..size).map(|z| matrix[(r, z)].abs() * unknowns[z]).fold(0.0, f64::max);
        let rows: Vec<f64> = (0..size).map(|r| row(&unknowns, r)).collect();
        let balance = |column: &dyn Fn(usize) -> f64| least((0..size).map(|r| rows[r] / column(r).abs()));
        let costates = (0..k).map(|i| match shape.rates[i] {
            CostateRate::Unknown(z) => balance(&|r| matrix[(r, z)]).map(|rate| rate * time),
            CostateRate::Explicit(place) => {
                let own = start.terms.explicit[place * (k + 1) + k] * time;
                let other = balance(&|r| start.instant.by_costate[r * k + i]);
                // a rate that is round-off at the start says no size
                let own = least([own].into_iter()).filter(|own| other.is_none_or(|other| *own > NOTHING * other));
                own.or(other)
            }
        });
        let costates: Vec<f64> = costates.map(|size| power(size.unwrap_or(1.0))).collect();
        for (rate, costate) in shape.rates.iter().zip(&costates) {
            if let CostateRate::Unknown(z) = *rate {
                unknowns[z] = power(costate / time);
            }
        }
        let width = shape.constants + 1;
        let constant = |c: usize| least((0..k).map(|i| costates[i] / start.costates[i * width + c].abs()));
        Scales {
            residuals: (0..size).map(|r| power(1.0 / row(&unknowns, r))).collect(),
            constants: (0..shape.constants).map(|c| power(constant(c).unwrap_or(1.0))).collect(),
            coordinates: speeds.iter().map(|speed| power(speed * time)).collect(),
            unknowns,
            costates,
        }
    }
}

/// Where there is no mass, what is as large as the others in one of the equations; else 1.
fn fill(sizes: &mut [f64], rows: &DMatrix<f64>) {
    let known = sizes.to_vec();
    for (j, size) in sizes.iter_mut().enumerate().filter(|(_, size)| **size == 0.0) {
        let largest = |r: usize| known.iter().enumerate().map(|(k, s)| rows[(r, k)].abs() * s).fold(0.0, f64::max);
        *size = least((0..rows.nrows()).map(|r| largest(r) / rows[(r, j)].abs())).unwrap_or(1.0);
    }
}
