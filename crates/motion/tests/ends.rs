//! Scenes of the catalogue, and ends of motions by every way of integration.

use integrate::Method;
use motion::{Choice, Settings, error_estimate, setting, solve_choice};
use scene::Scene;

use crate::support::{member, read};

/// The text of a scene of the catalogue.
pub(crate) fn text_of(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scene/");
    let read = |kind: &str| std::fs::read_to_string(format!("{folder}{kind}/{name}.toml"));
    read("scenes").or_else(|_| read("classics")).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub(crate) fn built_in(name: &str) -> Scene {
    read(name, &text_of(name))
}

/// The coordinates at the end with their estimates, or why they are not to be trusted.
pub(crate) type End = Result<(Vec<f64>, Vec<f64>), String>;

pub(crate) fn alone(scene: &Scene, choice: &Choice, method: Option<Method>) -> End {
    let mut motion = solve_choice(scene, choice, &Settings { method, ..Settings::default() }).expect("a motion");
    let estimate = error_estimate(&mut motion, setting(scene)).expect("in range");
    match estimate.status(&motion) {
        ("completed", _) => Ok((motion.at(motion.end()).expect("the end").coordinates, estimate.coordinates)),
        (_, cause) => Err(cause.unwrap_or_default()),
    }
}

/// By each method, and in an ensemble.
pub(crate) fn ends(scene: &Scene, choice: &Choice) -> Vec<(&'static str, End)> {
    let methods = [None, Some(Method::Taylor), Some(Method::Dop853), Some(Method::Radau5)];
    let by = |method: Option<Method>| (method.map_or("default", Method::name), alone(scene, choice, method));
    let times = [0.5, 1.0].map(|part| scene.start.t + part * scene.duration);
    let member = member(scene, choice, &times);
    let in_lanes = match member.status() {
        ("completed", _) => {
            Ok((member.outputs[1].coordinates.clone(), member.estimate.expect("asked for").coordinates))
        }
        (_, cause) => Err(cause.unwrap_or_default()),
    };
    methods.into_iter().map(by).chain([("in lanes", in_lanes)]).collect()
}
