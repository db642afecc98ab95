//! Parts of the library that are tested by themselves: for `tests/` of this crate, and for nobody else.

pub use crate::fit::search::Found;
pub use crate::fit::{Differences, INSTANTS, Power};
pub use crate::fits::{Start, fit_run, unknown};

use crate::Comparison;

/// The constants that a run has stand in the place of fitted ones that leave a larger gap.
pub fn keep_closer(comparison: &mut Comparison) {
    comparison.keep_closer();
}
