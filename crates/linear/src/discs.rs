//! Error bounds of computed eigenvalues, and whether some of them are defective.
//!
//! While `|(z − A)⁻¹| E` has a spectral radius under 1, no matrix within `E` of `A`, entry by entry, has the
//! eigenvalue `z`. Where that holds all round a circle, as many eigenvalues are within it whatever the error.
//! For one eigenvalue such a circle has a radius of about `κ‖E‖`, for a chain of `k` one of `(κ‖E‖)^(1/k)`.

use nalgebra::DMatrix;
use num_complex::Complex;

use crate::matrix::part;

/// Points on a circle round an eigenvalue, and of a contour.
const ROUND: usize = 8;
const CONTOUR: usize = 64;
/// Largest spectral radius on a circle that counts: circles are looked at in points.
const CLEAR: f64 = 0.5;
/// A matrix is raised to the power of two to this for its spectral radius.
const SQUARINGS: usize = 7;
/// Factor by which the next circle to be tried is smaller.
const SHRUNK: f64 = 1.5;
/// Circles tried.
const TRIALS: usize = 200;

/// A matrix, balanced or not, the largest errors of its entries, and all its eigenvalues as computed.
pub(crate) struct Discs {
    matrix: DMatrix<Complex<f64>>,
    error: DMatrix<f64>,
    values: Vec<Complex<f64>>,
    /// Places that depend on one another, each set behind those on which it depends.
    blocks: Vec<Vec<usize>>,
    /// No eigenvalue is further from 0.
    largest: f64,
}

impl Discs {
    pub(crate) fn new(
        matrix: &DMatrix<f64>,
        error: DMatrix<f64>,
        values: Vec<Complex<f64>>,
        blocks: Vec<Vec<usize>>,
    ) -> Discs {
        let largest = matrix.norm() + error.norm();
        Discs { matrix: matrix.map(Complex::from), error, values, blocks, largest }
    }

    /// Radius of a circle round `centre`, not under `least`, that no eigenvalue can cross.
    pub(crate) fn radius(&self, centre: Complex<f64>, least: f64) -> f64 {
        if self.error.amax() == 0.0 {
            return least;
        }
        let least = least.max(f64::MIN_POSITIVE);
        let mut radius = self.apart(centre, least);
        for _ in 0..TRIALS {
            let here = self.tightness(centre, radius);
            if radius > self.largest {
                break;
            }
            if here <= CLEAR {
                let smaller = self.apart(centre, (radius / SHRUNK).max(least));
                if smaller < radius && self.tightness(centre, smaller) <= CLEAR {
                    radius = smaller;
                    continue;
                }
                break;
            }
            // as 1/radius^k from here on
            let k = (here / self.tightness(centre, 2.0 * radius)).log2().max(1.0);
            let factor = (1.1 * here / CLEAR).powf(1.0 / k);
            radius *= if factor.is_finite() { factor.max(1.2) } else { 2.0 };
            radius = self.apart(centre, radius);
        }
        radius
    }

    /// This radius, or the next one with no computed eigenvalue at half to twice of it.
    fn apart(&self, centre: Complex<f64>, mut radius: f64) -> f64 {
        let near = |radius: f64| {
            let away = self.values.iter().map(|z| (z - centre).norm());
            away.filter(|d| (0.5 * radius..2.0 * radius).contains(d)).reduce(f64::max)
        };
        while let Some(away) = near(radius) {
            radius = 2.001 * away;
        }
        radius
    }

    /// The largest spectral radius of `|(z − A)⁻¹| E` at points of a circle.
    fn tightness(&self, centre: Complex<f64>, radius: f64) -> f64 {
        let at = |z: &Complex<f64>| match self.resolvent(*z) {
            Some(resolvent) => spectral_radius(resolvent.map(|x| x.norm()) * &self.error),
            None => f64::INFINITY,
        };
        circle(centre, radius, ROUND).iter().map(at).fold(0.0, f64::max)
    }

    /// Block by block: elimination in all of the matrix would let round-off couple what is not coupled.
    fn resolvent(&self, z: Complex<f64>) -> Option<DMatrix<Complex<f64>>> {
        symbolic::go_on();
        let n = self.matrix.nrows();
        let mut found = DMatrix::<Complex<f64>>::zeros(n, n);
        for places in &self.blocks {
            let m = places.len();
            let own = DMatrix::from_diagonal_element(m, m, z) - part(&self.matrix, places);
            // rows of this block are zero as yet
            let mut rows = DMatrix::from_fn(m, n, |i, j| self.matrix.row(places[i]).transpose().dot(&found.column(j)));
            places.iter().enumerate().for_each(|(i, &place)| rows[(i, place)] += 1.0);
            // up to four rows the library inverts by formulas, in which digits cancel
            let rows = own.lu().solve(&rows)?;
            places.iter().enumerate().for_each(|(i, &place)| found.set_row(place, &rows.row(i)));
        }
        found.iter().all(|x| x.is_finite()).then_some(found)
    }

    /// The largest `j` with `N^j` not zero, by more than errors explain, where `N` is `A − centre` on the
    /// space of the eigenvalues within `within` of `centre`, `size` in number: `N^j` is the contour integral
    /// of `(z − centre)^j (z − A)⁻¹` over 2πi. `None` where others are too close for a contour.
    pub(crate) fn power(&self, centre: Complex<f64>, within: f64, size: usize) -> Option<usize> {
        if self.largest == 0.0 {
            return Some(0);
        }
        let others = self.values.iter().map(|z| (z - centre).norm()).filter(|d| *d > within);
        let radius = others.fold(3.0 * self.largest.max(3.0 * within), f64::min) / 3.0;
        if within > radius / 3.0 {
            return None;
        }
        let n = self.matrix.nrows();
        let arithmetic = self.matrix.map(|x| 4.0 * f64::EPSILON * x.norm());
        let error = &self.error + arithmetic;
        let mut powers = vec![DMatrix::<Complex<f64>>::zeros(n, n); size];
        let mut moved = DMatrix::<f64>::zeros(n, n);
        for z in circle(centre, radius, CONTOUR) {
            let resolvent = self.resolvent(z)?;
            for (j, power) in powers.iter_mut().enumerate() {
                *power += &resolvent * ((z - centre).powi(j as i32 + 1) / CONTOUR as f64);
            }
            let size = resolvent.map(|x| x.norm());
            moved = moved.sup(&(&size * &error * &size));
        }
        let projector = powers[0].map(|x| x.norm()).max();
        let shown = |j: &usize| {
            let spread = (8.0 * within).powi(*j as i32) * projector;
            let noise = 4.0 * radius.powi(*j as i32 + 1);
            powers[*j].zip_map(&moved, |x, moved| x.norm() > noise * moved + spread).iter().any(|&over| over)
        };
        Some((1..size).take_while(shown).count())
    }
}

fn circle(centre: Complex<f64>, radius: f64, count: usize) -> Vec<Complex<f64>> {
    let angle = |i: usize| std::f64::consts::TAU * (i as f64 + 0.5) / count as f64;
    (0..count).map(|i| centre + Complex::from_polar(radius, angle(i))).collect()
}

/// A bound from above of the spectral radius of a matrix whose entries are ≥ 0: the norm of a high power.
fn spectral_radius(mut matrix: DMatrix<f64>) -> f64 {
    // the bound, as a logarithm: `matrix` is the power over its scale
    let (mut scale, mut exponent) = (0.0, 1.0);
    for step in 0..=SQUARINGS {
        let norm = matrix.row_iter().map(|row| row.sum()).fold(0.0, f64::max);
        if norm == 0.0 || !norm.is_finite() {
            return norm;
        }
        scale += norm.ln() / exponent;
        if step < SQUARINGS {
            matrix /= norm;
            matrix = &matrix * &matrix;
            exponent *= 2.0;
        }
    }
    scale.exp()
}
