//! The plan of evaluation: linear blocks eliminated beforehand, in expressions, where cheap and safe.
//!
//! A block `J(t, y) z = b(t, y)` whose pivots are known beforehand needs no factorization at run time:
//! elimination in expressions leaves a list of definitions, one after the other, in which structural zeros
//! cost nothing, numbers are folded and `sin² + cos²` is 1. Pivots are chosen by numbers at the start, so
//! that none is small there (as partial pivoting would choose them); along the motion they may become small.
//! So the squares of all multipliers, and of what cancelled in a pivot over that pivot, are watched in every
//! evaluation: where they exceed [`Plan::LIMIT`], or a rate is not finite, the same instant is solved by LU
//! factorization with pivoting, and counted. What is known to stay small ([`Graph::range`]) is not watched.

mod chosen;
mod common_factors;
mod elimination;
mod linear_block;
mod pivots;
mod search;

pub use chosen::{Collected, Plan};
pub use pivots::{Entry, Order, POINTS, Pattern, Strategy};
