//! The built-in scenes, and how a scene is found.

use std::path::Path;

use mechanics::{Scene, SceneError};

/// Name and text of every built-in scene, in the order of reports: the paper's examples, then the classics.
pub const SCENES: &[(&str, &str)] = &[
    ("sledge", include_str!("../scenes/sledge.toml")),
    ("ball-in-cone", include_str!("../scenes/ball-in-cone.toml")),
    ("ball-in-cone-as-printed", include_str!("../scenes/ball-in-cone-as-printed.toml")),
    ("three-cylinders", include_str!("../scenes/three-cylinders.toml")),
    ("particle", include_str!("../scenes/particle.toml")),
    ("heisenberg", include_str!("../scenes/heisenberg.toml")),
    ("sleigh", include_str!("../scenes/sleigh.toml")),
    ("disc", include_str!("../scenes/disc.toml")),
    ("turntable", include_str!("../scenes/turntable.toml")),
    ("appell-hamel", include_str!("../scenes/appell-hamel.toml")),
    ("velocity-pendulum", include_str!("../scenes/velocity-pendulum.toml")),
    ("bowl", include_str!("../scenes/bowl.toml")),
    ("trailer", include_str!("../scenes/trailer.toml")),
];

/// The built-in scene of that name, or else the scene file at that path; `overrides` replace parameters and start values.
///
/// # Errors
/// [`SceneError`] with the place in the file.
pub fn find(name_or_path: &str, overrides: &[(String, f64)]) -> Result<Scene, SceneError> {
    match SCENES.iter().find(|(name, _)| *name == name_or_path) {
        Some((name, text)) => Scene::parse_with(name, text, overrides),
        None => Scene::load_with(Path::new(name_or_path), overrides),
    }
}
