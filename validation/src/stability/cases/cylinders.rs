//! Three rough cylinders near the singularities of their constraints.

use equations::Formulation;
use mechanics::{State, System};
use motion::{CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE};
use scene::{Scene, SceneError};

use crate::stability::question::Question;
use crate::stability::reference::Reference;

const TEXT: &str = include_str!("../../../../crates/scene/scenes/three-cylinders.toml");

/// The scene's rate of W, which has no value where sin θ sin(θ − α) = 0, and a rate that always has one.
const START: [&str; 2] = ["\"W'\"     = 0.6", "\"phi'\" = 0.5"];

/// Constraint (15) of the scene, and the same times sin θ.
const CONSTRAINT: [&str; 2] = [
    "y' + R*phi'*cos(theta) + theta'*(r*phi1 - y)*cos(theta)/sin(theta) - 2*a*phi1'",
    "(y' + R*phi'*cos(theta) - 2*a*phi1')*sin(theta) + theta'*(r*phi1 - y)*cos(theta)",
];

/// Constraint (17) of the scene, and (16) cos θ + (17) sin θ over sin(θ − α).
const LAST: [&str; 2] = [
    "(y' + R*phi'*cos(theta) - 2*a*phi2'*cos(alpha))*sin(theta - alpha) + theta'*(r*phi2 + x*sin(alpha) - y*cos(alpha))*cos(theta)",
    "x'*cos(theta) + y'*sin(theta) - 2*a*phi2'*sin(theta - alpha)",
];

pub(super) fn questions(point: f64, name: &str, start: f64) -> Vec<Question> {
    let overrides = [(name.to_string(), start)];
    let scene = move |second: &str, last: &str| -> Result<Scene, SceneError> {
        let system = TEXT.split("[removal").next().unwrap_or_default();
        let run = TEXT.find("[run]").map_or("", |place| &TEXT[place..]);
        let text = (system.to_string() + run).replace(START[0], START[1]).replace(CONSTRAINT[0], second);
        Scene::parse_with("three-cylinders", &text.replace(LAST[0], last), &overrides)
    };
    let judged = scene.clone();
    let reference = |formulation: &Formulation| {
        let (scene, last) = (scene.clone(), if formulation == CHETAEV { LAST[0] } else { LAST[1] });
        let posed = move || -> Result<(System, State), String> {
            let start = scene(CONSTRAINT[0], LAST[0]).map_err(|error| error.to_string())?.start;
            Ok((scene(CONSTRAINT[1], last).map_err(|error| error.to_string())?.system, start))
        };
        if formulation == CHETAEV {
            Reference::Maggi(Box::new(posed))
        } else {
            Reference::Equivalent { posed: Box::new(posed), formulation: VAKONOMIC_COSTATE }
        }
    };
    super::questions(point, move || judged(CONSTRAINT[0], LAST[0]), &[CHETAEV, VAKONOMIC], reference)
}
