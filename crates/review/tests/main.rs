//! Equations that are right and wrong, and what is said of them.

mod drawn;
mod right;
mod support;
