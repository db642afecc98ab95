//! What references ask of a number type.

use mechanics::linear::Entry;
use symbolic::SeriesScalar;

/// A number type in which a motion can be computed.
pub trait Wide: SeriesScalar + Entry + PartialOrd + std::fmt::Debug + 'static {
    /// Relative spacing of the numbers.
    const EPSILON: f64;
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
    /// Neither infinite nor "not a number".
    fn is_finite(self) -> bool;
    /// 0
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
}

impl Wide for f64 {
    const EPSILON: f64 = f64::EPSILON;
    fn to_f64(self) -> f64 {
        self
    }
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}
