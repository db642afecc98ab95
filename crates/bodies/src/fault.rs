//! What is wrong with bodies.

use std::ops::Range;

/// A fault and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The bytes of the file.
    pub place: Range<usize>,
    /// What is wrong.
    pub kind: FaultKind,
}

/// A fault of bodies.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what variants and fields are")]
pub enum FaultKind {
    #[error("there is no body `{name}`{}", meant(.suggestion))]
    NoBody { name: String, suggestion: Option<String> },
    #[error("these bodies stand on one another in a circle: {}", .names.join(" → "))]
    Circle { names: Vec<String> },
    #[error(
        "expected a rotation that bodies can be built on: rotation(xyz, angles), rotation(axis, angle), a product of these, or the name of one; found `{found}`"
    )]
    Rotation { found: String },
    #[error("a {shape} {cannot}")]
    Shape { shape: String, cannot: &'static str },
    #[error("`{name}` has no joint with one angle or shift; a joint is a hinge, a slider or a plane")]
    NoJoint { name: String },
    #[error("`{body}` touches `{on}`, which is turned: give its place against it, with on = \"{on}\"")]
    Apart { body: String, on: String },
    #[error("nothing can stand on `{on}`: {why}")]
    Support { on: String, why: &'static str },
    #[error("a joint is one of hinge, slider, plane, ball, surface and fixed; found {found}")]
    Joint { found: String },
    #[error("`{key}` goes with `{kind}`")]
    GoesWith { key: &'static str, kind: &'static str },
    #[error("`{name}` has a joint `surface`: it is a ball or a point, on a cone or a cylinder with its sizes")]
    Surface { name: String },
    #[error("`{key}` places a body that has no `joint`; with one, it stands in the joint")]
    Twice { key: String },
    #[error(
        "expected `joint = \"BODY\"` or `between` with two bodies and a point of each, as in between = {{ arm = [1, 0, 0], space = [0, 0, 0] }}"
    )]
    Between,
    #[error("{what} is {value:.3e} off, wherever the bodies are")]
    Off { what: String, value: f64 },
}

fn meant(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map_or_else(String::new, |s| format!(", did you mean `{s}`?"))
}
