//! What is built on what: crates on crates, and the modules of a crate on one another.

mod arrows;
mod circles;
mod harnesses;
mod locks;
mod modules;
