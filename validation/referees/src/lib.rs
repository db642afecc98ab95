//! Referees: other roads to the same motion. They share no derivation with what they judge: from `L`, `f`,
//! `Q` of [`mechanics::System`], by nothing of ours but differentiation, tapes and the time loop.

pub mod closed_forms;
pub mod maggi;
