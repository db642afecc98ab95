//! Referees: other roads to the same motion. A referee shares no derivation code with what it judges; it
//! starts from [`mechanics::System`], that is from `L`, `f` and `Q`, and uses nothing of ours but
//! differentiation, tapes and the time loop.

pub mod closed_forms;
pub mod maggi;
