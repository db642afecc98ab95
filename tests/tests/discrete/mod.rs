//! Discrete variational principles against deltaq's motions: from `L`, `f` without equations of motion.

mod agreement;
mod orders;
