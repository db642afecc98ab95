//! Equations that are right and wrong, and what is said of them.

mod drawn;
mod named;
mod right;
mod support;
mod textbook;
