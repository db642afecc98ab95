//! Common parts of the tests: scenes, choices, members, and ends of motions by every way of integration.

use deltaq::{
    Choice, Comparison, Ensemble, EnsembleOptions, MemberMotion, Settings, choices, compare_unfitted, error_estimate,
    setting, solve_choice,
};
use equations::Formulation;
use integrate::Method;
use scene::Scene;

pub(crate) fn read(name: &str, text: &str) -> Scene {
    Scene::parse(name, text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The text of a scene of the catalogue.
pub(crate) fn text_of(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../catalogue/");
    let read = |kind: &str| std::fs::read_to_string(format!("{folder}{kind}/{name}.toml"));
    read("scenes").or_else(|_| read("classics")).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub(crate) fn built_in(name: &str) -> Scene {
    read(name, &text_of(name))
}

pub(crate) fn choice(scene: &Scene, formulation: &Formulation) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation == formulation).expect("it is there")
}

/// In all formulations, without fits.
pub(crate) fn compared(name: &str, text: &str) -> Comparison {
    let scene = read(name, text);
    let choices = choices(&scene);
    compare_unfitted(scene, choices, Vec::new(), &Settings::default()).expect("a comparison")
}

/// The motion as two members of an ensemble, which are to be the same, looked at at these times.
pub(crate) fn member(scene: &Scene, choice: &Choice, times: &[f64]) -> MemberMotion {
    let mut ensemble = Ensemble::new(scene, choice, &[], &Settings::default()).expect("an ensemble");
    let members = vec![ensemble.member(&[]).expect("a member"); 2];
    let options = EnsembleOptions { threads: 1, estimate: true };
    let mut motions = ensemble.motions(&members, times, &options).into_iter().map(|motion| motion.expect("a motion"));
    let (first, second) = (motions.next().expect("one"), motions.next().expect("another"));
    assert_eq!((&first.run.states, first.status()), (&second.run.states, second.status()));
    first
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
