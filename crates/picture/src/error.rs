//! Why a picture cannot be drawn.

/// Why a picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// No panel, or no point that is left to set the range of an axis that has none of its own.
    #[error(
        "nothing to draw in \"{title}\": no point sets the range of axis \"{axis}\" \
         ({not_finite} points are not finite, {not_positive} not positive on a logarithmic axis)"
    )]
    NothingToDraw {
        /// Title of the picture.
        title: String,
        /// Label of the axis whose range is open.
        axis: String,
        /// Points that are not finite, or over 1e300 in magnitude.
        not_finite: usize,
        /// Points that are not positive on a logarithmic axis.
        not_positive: usize,
    },
    /// A range not finite, not rising, narrower than 1e-9 of its magnitude, or with 0 on a logarithmic axis.
    #[error(
        "axis \"{axis}\" cannot run from {low:e} to {high:e}: the ends must be finite, at most 1e300 in magnitude, rising, \
         at least 1e-9 of their magnitude apart, and positive on a logarithmic axis"
    )]
    Range {
        /// Label of the axis.
        axis: String,
        /// Lowest value asked for.
        low: f64,
        /// Highest value asked for.
        high: f64,
    },
}
