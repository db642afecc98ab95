//! Scenes as questions.

use decision::ExactStart;
use scene::{Number, Scene};

/// A built-in scene with other numbers, as they are written.
pub(crate) fn built_in(name: &str, overrides: &[(&str, &str)]) -> Scene {
    let number = |text: &str| text.parse::<Number>().expect("a number");
    let overrides: Vec<(String, Number)> = overrides.iter().map(|&(name, text)| (name.into(), number(text))).collect();
    scene::catalogue::find(name, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn start(scene: &Scene) -> ExactStart {
    ExactStart::new(&scene.system, &scene.start, &scene.completion, None).expect("a start")
}
