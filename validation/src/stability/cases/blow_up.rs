//! Infinite speed within a finite time.

use equations::Formulation;
use scene::Scene;

use crate::stability::question::Question;
use crate::stability::reference::Reference;

/// The particle from height `y` at speed `ẋ`, up to twice the time of the pole.
pub(super) fn questions(y: f64, speed: f64, formulations: &[&'static Formulation]) -> Vec<Question> {
    let scene = move || {
        let numbers = [("y", y), ("x'", speed), ("duration", 2.0 / y)].map(|(name, x)| (name.to_string(), x));
        Scene::parse_with("blow-up", include_str!("blow-up.toml"), &numbers)
    };
    super::questions(y, scene, formulations, |_| closed(y, speed))
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
