//! Discrete variational principles against deltaq's motions: from `L`, `f` without equations of motion.

mod orders;
mod random;
mod scenes;
mod support;
