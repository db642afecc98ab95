//! The built-in scenes, classic holonomic and nonholonomic systems, and how a scene is found by name.

pub mod trailer;

use std::path::Path;
use std::sync::OnceLock;

use crate::{Number, Scene, SceneError};

/// Name and text of every built-in scene, in the order of reports: the paper's examples, then the classics.
pub const SCENES: &[(&str, &str)] = &[
    ("sledge", include_str!("../../scenes/sledge.toml")),
    ("ball-in-cone", include_str!("../../scenes/ball-in-cone.toml")),
    ("three-cylinders", include_str!("../../scenes/three-cylinders.toml")),
    ("ball-in-cone-as-printed", include_str!("../../scenes/ball-in-cone-as-printed.toml")),
    ("particle", include_str!("../../scenes/particle.toml")),
    ("heisenberg", include_str!("../../scenes/heisenberg.toml")),
    ("sleigh", include_str!("../../scenes/sleigh.toml")),
    ("disc", include_str!("../../scenes/disc.toml")),
    ("turntable", include_str!("../../scenes/turntable.toml")),
    ("appell-hamel", include_str!("../../scenes/appell-hamel.toml")),
    ("velocity-pendulum", include_str!("../../scenes/velocity-pendulum.toml")),
    ("bowl", include_str!("../../scenes/bowl.toml")),
    ("planar-body", include_str!("../../scenes/planar-body.toml")),
    ("trailer", include_str!("../../scenes/trailer.toml")),
];

macro_rules! beside {
    ($($name:literal)*) => { &[$(($name, include_str!(concat!("../../classics/", $name, ".toml")))),*] };
}

/// Further systems of the literature, asked one question: which of their motions are vakonomic.
pub const CLASSICS: &[(&str, &str)] = beside!(
    "coin-on-incline" "mobile-robot" "falling-disc" "two-wheeled-carriage" "unicycle-in-potential" "turning-knife-edge"
    "nonholonomic-oscillator" "martinet" "engel" "generalized-heisenberg" "suslov" "veselova" "chaplygin-sphere"
    "rubber-ball" "rubber-chaplygin-sphere" "routh-sphere" "ball-on-incline" "ball-in-cylinder" "rattleback"
    "snakeboard" "roller-racer" "pursuit" "isokinetic" "parallel-velocities" "sledge-with-friction"
);

/// Systems whose steady motions are looked at: in no comparison.
pub const STEADY: &[(&str, &str)] = &[("bicycle", include_str!("../../scenes/bicycle.toml"))];

/// Systems whose constraints are kept by reactions of their own kind: in no report.
pub const PRESCRIBED: &[(&str, &str)] = &[
    ("servo-pendulum", include_str!("../../scenes/servo-pendulum.toml")),
    ("one-motor-robot", include_str!("../../scenes/one-motor-robot.toml")),
    ("rudder-skate", include_str!("../../scenes/rudder-skate.toml")),
];

/// Names and texts of scenes.
type Group = &'static [(&'static str, &'static str)];

/// The scenes that are found by their names and not made for them, and what each list of them is called.
pub const GROUPS: [(&str, Group); 4] = [
    ("compared in the reports", SCENES),
    ("more from the literature", CLASSICS),
    ("steady motions", STEADY),
    ("reactions of their own", PRESCRIBED),
];

/// Name and text of all of them.
pub fn built_in() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    GROUPS.into_iter().flat_map(|(_, group)| group)
}

/// The built-in scene `name`, `-` for standard input, or the file at that path; `overrides` replace numbers.
///
/// # Errors
/// [`NotFound`], with the place in the file where there is one.
pub fn find(name_or_path: &str, overrides: &[(String, Number)]) -> Result<Scene, NotFound> {
    Ok(read(name_or_path, &source(name_or_path)?, overrides)?)
}

/// [`find`] for who has its [`source`].
///
/// # Errors
/// As [`Scene::parse_with`].
pub fn read(name_or_path: &str, text: &str, overrides: &[(String, Number)]) -> Result<Scene, SceneError> {
    match name_or_path {
        "-" => Scene::parse_with("stdin", text, overrides),
        name if text_of(name).is_some() => Scene::parse_with(name, text, overrides),
        path => Scene::parse_file(Path::new(path), text, overrides),
    }
}

/// The text of the built-in scene of that name, or of a train of trailers (`n-trailer-5`), or `None`.
#[must_use]
pub fn text_of(name: &str) -> Option<String> {
    let known = built_in().find(|(known, _)| *known == name).map(|(_, text)| text.to_string());
    known.or_else(|| trailer::named(name).map(|(trailers, coordinates)| trailer::text(trailers, coordinates)))
}

/// The text behind [`find`].
///
/// # Errors
/// [`NotFound`].
pub fn source(name_or_path: &str) -> Result<String, NotFound> {
    if let Some(text) = text_of(name_or_path) {
        return Ok(text);
    }
    if name_or_path == "-" {
        // it can be read once only, and its scene may be asked for again
        static TEXT: OnceLock<Result<String, SceneError>> = OnceLock::new();
        return Ok(TEXT.get_or_init(|| Scene::read_from("stdin", std::io::stdin())).clone()?);
    }
    let path = Path::new(name_or_path);
    if !path.exists() {
        let known: Vec<&str> = built_in().map(|(name, _)| *name).chain(["n-trailer-N"]).collect();
        return Err(NotFound::Nothing(name_or_path.into(), known.join(", ")));
    }
    Ok(Scene::read(path)?)
}

/// There is no such scene, or there is something wrong with it.
#[derive(Debug, thiserror::Error)]
pub enum NotFound {
    /// What was asked for is neither a file nor a built-in name, which are these.
    #[error("`{0}` is neither a file nor one of the built-in scenes: {1}")]
    Nothing(String, String),
    /// The scene has a fault.
    #[error(transparent)]
    Fault(#[from] SceneError),
}
