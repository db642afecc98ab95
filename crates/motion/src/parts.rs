//! Parts of the library that are tested by themselves: for `tests/` of this crate, and for nobody else.

pub use crate::connect::{merge, samples, spread, times};
pub use crate::constants::searched;
pub use crate::ensemble::{WATCHED, instants};
pub use crate::last_digits::{move_digits, signs};
pub use crate::lost_digits::{Looked, RoundOff, is_small, largest, look, round_off};
pub use crate::sizes::{sizes, unbounded_sizes};
pub use crate::wanted::{HALVES, STRETCHES, kept_before, wanted};

use crate::{Motion, round_off};

/// In how many stretches a motion is looked at: in a first check, and closely.
pub const LOOKED_AT: [usize; 2] = [round_off::FEW, round_off::STRETCHES];

/// Instants of a motion in its first chart, the states of its looser run there, and sizes of states.
pub fn looked_at(motion: &mut Motion, stretches: usize) -> (Vec<Looked>, Vec<Vec<f64>>, Vec<f64>) {
    motion.looked_at(stretches)
}

/// The largest value of each state, or the size by which it was integrated, if that is more.
pub fn sizes_of(motion: &Motion, looked: &[Looked]) -> Vec<f64> {
    motion.sizes_of(looked)
}

/// The sum of terms behind each coordinate since the start, at a few times.
pub fn terms_of_coordinates_along(motion: &mut Motion) -> Vec<(f64, Vec<f64>)> {
    motion.terms_of_coordinates_along()
}

/// The kept run of `other` in the place of the looser run of a motion, where it comes as far.
pub fn replace_looser(motion: &mut Motion, other: &Motion) {
    motion.replace_looser(other.kept.clone());
}

/// The motion stops there, for this cause.
pub fn stop_at(motion: &mut Motion, t: f64, cause: &str) {
    motion.stop_at(t, cause.into());
}
