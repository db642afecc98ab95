//! Three rough cylinders near the singularities of their constraints.

use mechanics::{Scene, SceneError, State, System};

use super::powers;
use crate::stability::question::{Case, Question};
use crate::stability::reference::Reference;

const REFERENCE: &str =
    "Maggi's equations, which have no multipliers, on the constraints times sin θ; double run of DOP853";

pub(super) const TURN: Case = Case {
    name: "cylinders-turn",
    about: "Chetaev's motion of the three cylinders over 1 s from a slow turn θ̇ of the upper one: a parametrization by u' = θ̇ W breaks where θ̇ = 0, the \
            constraints do not.",
    reference: REFERENCE,
    variable: "θ̇ (rad/s)",
    questions: || powers(-8, 0, 2).map(|rate| question(rate, vec![("theta'".into(), rate)])).collect(),
};

pub(super) const HEADING: Case = Case {
    name: "cylinders-heading",
    about: "The three cylinders over 1 s from a heading θ near 0, where constraint (15) divides by sin θ. The singularity is one of \
            the system: below θ = 0.1 the motion runs into it, and the reference stops there too.",
    reference: REFERENCE,
    variable: "θ (rad)",
    questions: || powers(-2, 0, 1).map(|theta| question(theta, vec![("theta".into(), theta)])).collect(),
};

pub(super) const ANGLE: Case = Case {
    name: "cylinders-angle",
    about: "The three cylinders over 1 s from a heading near that of a lower cylinder, sin(θ − α) → 0, where constraints (16) and (17) become one.",
    reference: REFERENCE,
    variable: "θ − α (rad)",
    questions: || powers(-8, 0, 2).map(|gap| question(gap, vec![("theta".into(), 0.9 + gap)])).collect(),
};

const TEXT: &str = include_str!("../../../scenes/three-cylinders.toml");

/// The scene's rate of W, which has no value where sin θ sin(θ − α) = 0, and a rate that always has one.
const START: [&str; 2] = ["\"W'\"     = 0.6", "\"phi'\" = 0.5"];

/// Constraint (15) of the scene, and the same times sin θ.
const CONSTRAINT: [&str; 2] = [
    "y' + R*phi'*cos(theta) + theta'*(r*phi1 - y)*cos(theta)/sin(theta) - 2*a*phi1'",
    "(y' + R*phi'*cos(theta) - 2*a*phi1')*sin(theta) + theta'*(r*phi1 - y)*cos(theta)",
];

fn question(point: f64, overrides: Vec<(String, f64)>) -> Question {
    let scene = move |constraint: &str| -> Result<Scene, SceneError> {
        let system = TEXT.split("[removal").next().unwrap_or_default();
        let run = TEXT.find("[run]").map_or("", |place| &TEXT[place..]);
        let text = (system.to_string() + run).replace(START[0], START[1]).replace(CONSTRAINT[0], constraint);
        Scene::parse_with("three-cylinders", &text, &overrides)
    };
    let (judged, known) = (scene.clone(), scene);
    let posed = move || -> Result<(System, State), String> {
        let start = known(CONSTRAINT[0]).map_err(|error| error.to_string())?.start;
        Ok((known(CONSTRAINT[1]).map_err(|error| error.to_string())?.system, start))
    };
    let nothing = |_: &'static str| Reference::Closed(Box::new(|_| Vec::new()));
    let mut asked = super::questions(point, move || judged(CONSTRAINT[0]), &["chetaev"], nothing);
    let mut question = asked.swap_remove(0);
    question.reference = Reference::Maggi(Box::new(posed));
    question
}
