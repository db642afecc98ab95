//! What a hand takes hold of at the start: the place of a body, where it points, and its velocity.
//!
//! The body is the first that moves, its place the one whose path is drawn, and it points along its x axis.
//! Of each number of the start that a slider sets, the derivatives of all three are given, by differences of
//! scenes that are read with a little more of it: so a hand moves a start as a typed number does, and stays
//! on the constraint.

use mechanics::Poses;
use motion::SolveError;
use scene::Scene;
use serde_json::{Value, json};

use crate::arrows::step_by;
use crate::bodies::shown;
use crate::controls::start_numbers;
use crate::question::Question;

/// Place, direction and velocity at the start, each with its derivatives by name; `None` without a body that
/// moves. A number that cannot be moved alone has none.
pub(crate) fn of(scene: &Scene, question: &Question) -> Result<Option<Value>, SolveError> {
    let Some(here) = held(scene)? else { return Ok(None) };
    let mut numbers = Vec::new();
    for (name, value) in start_numbers(scene) {
        let step = step_by(value);
        let mut set: Vec<(String, f64)> = question.set.iter().map(|(name, x)| (name.clone(), *x)).collect();
        set.retain(|(known, _)| *known != name && !motion::is_costate(known));
        set.push((name.clone(), value + step));
        let Ok(moved) = Scene::parse_with(&question.name, &question.text, &set) else { continue };
        let Some(there) = held(&moved)? else { continue };
        let by: Vec<f64> = there.iter().zip(here).map(|(there, here)| (there - here) / step).collect();
        numbers.push(json!({ "name": name, "value": value, "by": by }));
    }
    Ok(Some(json!({ "here": here, "numbers": numbers })))
}

/// The place (3), the x axis (3) and the velocity of the place (3).
fn held(scene: &Scene) -> Result<Option<[f64; 9]>, SolveError> {
    let (view, start) = (shown(scene), &scene.start);
    let Some(body) = view.bodies.iter().position(|body| view.is_moved(&scene.system, body)) else { return Ok(None) };
    let mut poses = view.poses(&scene.system)?;
    let pose = poses.at(start.t, &start.q).swap_remove(body);
    let h = step_by(start.t);
    let marked = |poses: &mut Poses, h: f64| {
        let q: Vec<f64> = start.q.iter().zip(&start.v).map(|(q, v)| q + h * v).collect();
        poses.at(start.t + h, &q)[body].marked()
    };
    let (before, after) = (marked(&mut poses, -h), marked(&mut poses, h));
    Ok(Some(std::array::from_fn(|i| match i / 3 {
        0 => pose.marked()[i],
        1 => pose.rotation[i - 3][0],
        _ => (after[i - 6] - before[i - 6]) / (2.0 * h),
    })))
}
