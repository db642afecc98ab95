//! A rigid-body engine as a referee: which formulation do contact and friction obey?
//!
//! The engine is [rapier](https://rapier.rs) in double precision. It moves bodies by impulses at contacts:
//! per step a normal impulse that keeps `v · n ≥ 0`, and a friction impulse that takes the contact point's
//! sliding velocity to zero, within a cone so wide that it never binds. It shares no code and no idea with
//! our derivations: it gets a ball, a surface, gravity and a start, and never a constraint.
//!
//! - [`Mapping`]: from a scene to the engine's [`Setup`], from coordinates to a ball's [`Pose`], with signs.
//! - [`Run`]: one run of the engine.
//! - [`Study`]: runs at a ladder of steps, their distance to each formulation's motion, the [`Finding`].
//! - [`files`]: the page `reports/evidence/engine.md`, which `cargo xtask engine` writes.
//!
//! An impulse that takes the sliding velocity to zero does no work on motions that do not slide: d'Alembert's
//! principle with Chetaev's virtual displacements, step by step. So we expect Chetaev's motion at the
//! engine's order, one (Neimark & Fufaev 1972 on rolling balls; Kozlov 1983 on constraints by friction).

mod error;
mod page;
mod pose;
mod setup;
mod study;
mod world;

pub use error::EngineError;
pub use page::files;
pub use pose::{EulerAngles, Pose};
pub use setup::{Ball, Mapping, Setup, Surface};
pub use study::{FAR, Finding, Ladder, Level, NEAR, ORDER, SAMPLES, Study, Target, order};
pub use world::{Contacts, Run, Trajectory};
