//! Why a picture cannot be drawn.

/// Why a picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
#[non_exhaustive]
pub enum PictureError {
    /// No panel, or no point that is left to set the range of an axis that has none of its own.
    #[error(
        "nothing to draw in \"{title}\": no point sets the range of axis \"{axis}\" \
         ({not_finite} points are not finite, {not_positive} not positive on a logarithmic axis)"
    )]
    NothingToDraw { title: String, axis: String, not_finite: usize, not_positive: usize },
    /// A range not finite, not rising, narrower than 1e-9 of its magnitude, or with 0 on a logarithmic axis.
    #[error(
        "axis \"{axis}\" cannot run from {low:e} to {high:e}: the ends must be finite, at most 1e300 in magnitude, rising, \
         at least 1e-9 of their magnitude apart, and positive on a logarithmic axis"
    )]
    Range { axis: String, low: f64, high: f64 },
}
