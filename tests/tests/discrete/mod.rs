//! Discrete variational principles against the motions of deltaq: no equation of motion stands between `L`, `f` and the referee.

mod agreement;
mod orders;
