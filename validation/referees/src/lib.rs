//! Referees: independent derivations of the same motion, from `L`, `f`, `Q` of [`mechanics::System`], by
//! nothing of ours but differentiation, tapes and the time loop.

pub mod closed_forms;
pub mod maggi;
