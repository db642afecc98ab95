//! What a method of another crate is made of: it attempts steps ([`Stepper`]) of a problem in which every
//! call is counted and every value checked ([`System`]), and the time loop does the rest ([`drive`]):
//! events, projection, dense output, limits.

pub use crate::dense::Basis;
pub use crate::stepper::{Attempt, Stepper, shortest_step};
pub use crate::system::{Failure, System, check_finite};
pub use crate::time_loop::{drive, run};
