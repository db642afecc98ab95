//! What the reports rest on: one program, one module a subject.

mod audit;
mod batches;
mod bench;
mod casadi;
mod changed_pages;
mod control;
mod headlines;
mod pages;
mod pictures;
mod scaling;
