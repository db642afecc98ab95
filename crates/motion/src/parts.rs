//! Parts of the library that are tested by themselves: for `tests/` of this crate, and for nobody else.

pub use crate::band::accumulated_round_off::{Looked, RoundOff, accumulated as round_off, is_small, largest, look};
pub use crate::band::limits::{STRETCHES, WATCHED};
pub use crate::band::ulp_perturbation::{move_digits, signs};
pub use crate::connect::{each_once, samples, times};
pub use crate::constants::searched;
pub use crate::ensemble::instants;
pub use crate::state_scales::{sizes, unbounded_sizes};
pub use crate::wanted::{HALVES, kept_before, wanted};

use crate::Motion;
use crate::band::limits::{FEW, LOOKS};

/// In how many stretches a motion is looked at: in a first check, and closely.
pub const LOOKED_AT: [usize; 2] = [FEW, LOOKS];

/// Instants of a motion in its first chart, the states of its looser run there, and sizes of states.
pub fn looked_at(motion: &mut Motion, stretches: usize) -> (Vec<Looked>, Vec<Vec<f64>>, Vec<f64>) {
    crate::band::round_off::looked_at(motion, stretches)
}

/// The kept run of `other` instead of the looser run of a motion, where it comes as far.
pub fn replace_looser(motion: &mut Motion, other: &Motion) {
    motion.replace_looser(other.kept.clone());
}

/// The motion stops there, for this cause.
pub fn stop_at(motion: &mut Motion, t: f64, cause: &str) {
    motion.stop_at(t, cause.into());
}
