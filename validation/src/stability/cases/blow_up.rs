//! Infinite speed within a finite time.

use scene::Scene;

use super::FORMULATIONS;
use crate::stability::question::{Case, Question};
use crate::stability::reference::Reference;

pub(super) const CASE: Case = Case {
    name: "blow-up",
    about: "The particle with L = ½(ẋ² + ẏ² + ż² + y⁴), ẏ = y² and ẋ = 0 at the start: y = y₀/(1 − y₀t) in every formulation, asked for up to twice \
            the time 1/y₀. A method that steps over the pole comes back with a motion on its other side.",
    reference: "closed form; from the pole on, a place at distance y₀/ε, which no motion is near",
    variable: "y₀",
    questions: at_rest,
};

pub(super) const MOVING: Case = Case {
    name: "blow-up-across",
    about: "The same with ẋ = 1 at the start.",
    reference: "closed form of Chetaev's motion: ẋ√(1 + y²) is constant",
    variable: "y₀",
    questions: moving,
};

const STARTS: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 100.0];

fn scene(y: f64, speed: f64) -> Result<Scene, scene::SceneError> {
    let text = format!(
        r#"
title = "Particle that runs away"
[coordinates]
x = {{ start = 0 }}
y = {{ start = {y:?} }}
z = {{ start = 0 }}
[system]
lagrangian = "(x'^2 + y'^2 + z'^2 + y^4)/2"
constraints = ["z' - y*x'"]
[start.velocities]
"x'" = {speed:?}
"y'" = "y^2"
[removal.along-x]
parameters = ["x", "y"]
rates = {{ z = "y*x'" }}
[run]
duration = {:?}
"#,
        2.0 / y
    );
    Scene::parse("blow-up", &text)
}

fn at_rest() -> Vec<Question> {
    STARTS
        .into_iter()
        .flat_map(|y| super::questions(y, move || scene(y, 0.0), &FORMULATIONS, |_| closed(y, 0.0)))
        .collect()
}

fn moving() -> Vec<Question> {
    STARTS
        .into_iter()
        .flat_map(|y| super::questions(y, move || scene(y, 1.0), &["chetaev"], |_| closed(y, 1.0)))
        .collect()
}

/// With `C = ẋ₀√(1 + y₀²)` and `dt = dy/y²`: `x = C ∫ dy/(y²√(1 + y²))`, `z = C ∫ dy/(y√(1 + y²))`.
fn closed(start: f64, speed: f64) -> Reference {
    let c = speed * start.hypot(1.0);
    Reference::Closed(Box::new(move |t| {
        // at and after the pole, a place so far away that nothing which goes on is near it
        let y = start / (1.0 - start * t).max(f64::EPSILON);
        let across = |y: f64| (1.0 / y).hypot(1.0);
        vec![c * (across(start) - across(y)), y, c * ((1.0 / start).asinh() - (1.0 / y).asinh())]
    }))
}
