//! Errors of a run.

use motion::SolveError;
use scene::catalogue::NotFound;

/// Why a scene cannot be put to the engine, or compared with it.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum EngineError {
    /// The scene cannot be read.
    #[error(transparent)]
    Scene(#[from] NotFound),
    /// No mapping from this scene's coordinates to a rigid body is known here.
    #[error("scene `{0}` is not mapped to a rigid body")]
    NotMapped(String),
    /// The scene, and a parameter or a coordinate that the mapping needs.
    #[error("scene `{0}` has no `{1}`, which the mapping to a rigid body needs")]
    Missing(String, String),
    /// At the start the body does not do what the scene says.
    #[error("scene `{scene}`: at the start the {what} of the rigid body is {body:e}, that of the scene {expected:e}")]
    Mapping { scene: String, what: &'static str, body: f64, expected: f64 },
    /// Steps that do not fall onto the sampling times.
    #[error("{0} steps cannot be read off at {1} equidistant times")]
    Steps(usize, usize),
    /// The body is lost, or no longer finite, at this time, s.
    #[error("the engine lost the ball at t = {0} s")]
    Lost(f64),
    /// A motion of deltaq.
    #[error(transparent)]
    Motion(#[from] SolveError),
    /// The scene's metric.
    #[error(transparent)]
    Metric(#[from] symbolic::CompileError),
}
