//! Equations and how they are evaluated: one program, one module per subject.

mod by_hand;
mod pivots;
