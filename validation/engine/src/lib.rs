//! draft
mod error;
mod pose;
mod setup;
mod world;

pub use error::EngineError;
pub use pose::{EulerAngles, Pose};
pub use setup::{Ball, Mapping, Setup, Surface};
pub use world::{Contacts, Run, Trajectory};
