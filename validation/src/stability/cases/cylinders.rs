//! Three rough cylinders near the singularities of their constraints.

use mechanics::{State, System};
use scene::{Scene, SceneError};

use super::powers;
use crate::stability::question::{Case, Question};
use crate::stability::reference::Reference;

const REFERENCE: &str = "Chetaev: Maggi's equations, which have no multipliers, on the constraints times sin θ. Vakonomic: the costate form, derived by the same code, from equivalent \
     constraints that are regular here: (15) times sin θ, and (17) as ẋ cos θ + ẏ sin θ = 2a φ̇₂ sin(θ − α). Both by double run of DOP853. The \
     removed-constraint motion is not judged: the parameter W of its removal has no value in these limits, and no other road to it is known here";

pub(super) const TURN: Case = Case {
    name: "cylinders-turn",
    about: "The three cylinders over 1 s from a slow turn θ̇ of the upper one: a parametrization by u' = θ̇ W breaks where θ̇ = 0, the \
            constraints do not.",
    reference: REFERENCE,
    variable: "θ̇ (rad/s)",
    questions: || powers(-8, 0, 2).flat_map(|rate| questions(rate, vec![("theta'".into(), rate)])).collect(),
};

pub(super) const HEADING: Case = Case {
    name: "cylinders-heading",
    about: "The three cylinders over 1 s from a heading θ near 0, where constraint (15) divides by sin θ. The singularity is one of \
            the system: below θ = 0.1 the motion runs into it, and the reference stops there too.",
    reference: REFERENCE,
    variable: "θ (rad)",
    questions: || powers(-2, 0, 1).flat_map(|theta| questions(theta, vec![("theta".into(), theta)])).collect(),
};

pub(super) const ANGLE: Case = Case {
    name: "cylinders-angle",
    about: "The three cylinders over 1 s from a heading near that of a lower cylinder, sin(θ − α) → 0, where constraints (16) and (17) become one.",
    reference: REFERENCE,
    variable: "θ − α (rad)",
    questions: || powers(-8, 0, 2).flat_map(|gap| questions(gap, vec![("theta".into(), 0.9 + gap)])).collect(),
};

const TEXT: &str = include_str!("../../../scenes/three-cylinders.toml");

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

fn questions(point: f64, overrides: Vec<(String, f64)>) -> Vec<Question> {
    let scene = move |second: &str, last: &str| -> Result<Scene, SceneError> {
        let system = TEXT.split("[removal").next().unwrap_or_default();
        let run = TEXT.find("[run]").map_or("", |place| &TEXT[place..]);
        let text = (system.to_string() + run).replace(START[0], START[1]).replace(CONSTRAINT[0], second);
        Scene::parse_with("three-cylinders", &text.replace(LAST[0], last), &overrides)
    };
    let judged = scene.clone();
    let reference = |name: &'static str| {
        let (scene, last) = (scene.clone(), if name == "chetaev" { LAST[0] } else { LAST[1] });
        let posed = move || -> Result<(System, State), String> {
            let start = scene(CONSTRAINT[0], LAST[0]).map_err(|error| error.to_string())?.start;
            Ok((scene(CONSTRAINT[1], last).map_err(|error| error.to_string())?.system, start))
        };
        match name {
            "chetaev" => Reference::Maggi(Box::new(posed)),
            _ => Reference::Equivalent { posed: Box::new(posed), formulation: "vakonomic-costate" },
        }
    };
    super::questions(point, move || judged(CONSTRAINT[0], LAST[0]), &["chetaev", "vakonomic"], reference)
}
