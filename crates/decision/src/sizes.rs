//! Noise of a mismatch, and the sizes that it is compared with.

use nalgebra::{DMatrix, DVector};
use symbolic::limits::LAST_DIGITS;

use crate::scales::power;

/// A difference has to be this many times the sum of both errors to count: differences of two runs
/// underestimate an error by a factor of 9 at most, on 2,352 runs with known errors.
pub const CERTAINTY: f64 = 10.0;

/// Sizes of one constant in the triangular matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Column {
    /// Value of the constant that has size 1 in the triangular matrix.
    pub(crate) scale: f64,
    /// Noise of its column, and its size: where it is within noise, that of the sum of terms behind it.
    pub(crate) noise: f64,
    pub(crate) size: f64,
}

/// Sizes that a mismatch is compared with.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sizes {
    /// Noise of `y₀`, and of `O` times a constant of size 1.
    pub(crate) noise: f64,
    /// The curve's own acceleration, and its speed over the time.
    pub(crate) acceleration: f64,
    pub(crate) speed: f64,
    /// The sum of magnitudes of terms.
    pub(crate) terms: f64,
    /// Whether the curve moves at any node, by more than round-off of that.
    pub(crate) moves: bool,
}

impl Sizes {
    /// What a mismatch is compared with, for constants of this size: the motion, or where nothing moves what
    /// balances.
    pub(crate) fn scale(&self, reach: f64) -> f64 {
        if self.moves { self.acceleration.hypot(self.speed) } else { self.terms * reach }
    }
}

/// Squares of lengths, added up; of the columns of `[O | y₀]` where there are several.
pub(crate) struct Sums {
    pub(crate) noise: DVector<f64>,
    pub(crate) terms: DVector<f64>,
    pub(crate) acceleration: f64,
    pub(crate) speed: f64,
    pub(crate) moves: bool,
}

impl Sums {
    /// The sizes over a run of length `time`, and for each constant the size at which its column is known as
    /// well as `y₀`: whatever its unit, it has an effect if that stands out from its own noise. Where nothing
    /// moves but by round-off, so do the columns, and all have the noise of what balances.
    pub(crate) fn lengths(&self, time: f64, triangle: &DMatrix<f64>) -> (Sizes, Vec<Column>) {
        let [acceleration, speed] = [self.acceleration, self.speed / time.powi(2)].map(f64::sqrt);
        let last = triangle.ncols() - 1;
        let finite = |square: f64| Some(square.sqrt()).filter(|x| x.is_finite()).unwrap_or(0.0);
        let known = |noise: f64, size: f64, terms: f64| noise.sqrt().max(LAST_DIGITS * size.max(finite(terms)));
        let terms = finite(self.terms.sum());
        let motion = acceleration.hypot(speed);
        let column = |k: usize, size: f64| known(self.noise[k], size.max(triangle.column(k).norm()), self.terms[k]);
        let sizes = |noise| Sizes { noise, acceleration, speed, terms, moves: self.moves };
        if !self.moves {
            let noise = known(self.noise.sum(), triangle.norm().max(motion), self.terms.sum());
            return (sizes(noise), vec![Column { scale: 1.0, noise, size: terms }; last]);
        }
        let own = column(last, motion);
        let columns = (0..last).map(|k| {
            let noise = column(k, 0.0);
            let scale = if noise > 0.0 { power(own / noise) } else { 1.0 };
            let norm = triangle.column(k).norm();
            let size = if norm > CERTAINTY * noise { norm } else { norm.max(finite(self.terms[k])) };
            // an effect that is round-off of the motion hides none
            let size = if size > LAST_DIGITS * terms { size * scale } else { f64::INFINITY };
            Column { scale, noise: noise * scale, size }
        });
        (sizes(own), columns.collect())
    }
}
