//! A rigid-body engine as a referee: which formulation do contact and friction obey?
//!
//! The engine is [rapier](https://rapier.rs) in double precision. It moves bodies by impulses at contacts: in each step a normal impulse
//! that keeps `v · n ≥ 0`, and a friction impulse that takes the sliding velocity of the contact point to zero, within a cone that is
//! made so wide that it never binds. It shares no code and no idea with the derivations of this workspace: it is given a ball, a
//! surface, gravity and a start, and never a constraint.
//!
//! - [`Mapping`]: from a scene to a [`Setup`] for the engine, and from the scene's coordinates to a [`Pose`] of the ball. Signs stand there.
//! - [`Run`]: one run of the engine.
//! - [`Study`]: runs at a ladder of time steps, their distance to the motion of each formulation, and the [`Finding`].
//! - [`files`]: the page `reports/engine.md`, which `cargo xtask engine` writes.
//!
//! An impulse that takes the sliding velocity to zero does no work on motions that do not slide: that is d'Alembert's principle with
//! Chetaev's virtual displacements, step by step. So the expectation is Chetaev's motion at the order of the engine's
//! time stepping, which is the first (Neimark & Fufaev 1972 on rolling balls; Kozlov 1983 on realizing constraints by friction).

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
pub use study::{FAR, Finding, Ladder, Level, NEAR, ORDER, SAMPLES, Study, Target};
pub use world::{Contacts, Run, Trajectory};
