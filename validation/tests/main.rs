//! What the reports rest on: one program, one module a subject.

mod audit;
mod bench;
mod casadi;
mod headlines;
mod pictures;
mod scaling;
