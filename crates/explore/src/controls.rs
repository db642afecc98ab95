//! What can be varied, and within which bounds a slider does.

use std::f64::consts::PI;

use mechanics::ConstantsRule;
use motion::given_costates;
use scene::Scene;
use serde_json::{Value, json};

use crate::subject::{Subject, costate_of};

/// The parameter of the family between Chetaev's and the vakonomic motion.
const KAPPA: &str = "kappa";
/// A slider for it goes up to this, in 1/s.
const MOST_KAPPA: f64 = 20.0;

/// All numbers that can be set, each an object: parameters, start, multipliers, costates of each removal, κ,
/// duration.
pub(crate) fn of(subject: &Subject) -> Vec<Value> {
    let Subject { scene, choices, .. } = subject;
    let (system, start, g) = (&scene.system, &scene.start, &scene.system.graph);
    let mut controls = Vec::new();
    let mut kappa = 0.0;
    for parameter in &system.parameters {
        let (name, value) = (g.name(parameter.symbol), parameter.value);
        if name == KAPPA {
            kappa = value;
            continue;
        }
        let bounds = if value == 0.0 { [-1.0, 1.0] } else { [value / 10.0, value * 3.0] };
        controls.push(control(&name, "parameter", "", value, bounds));
    }
    for (coordinate, &q) in system.coordinates.iter().zip(&start.q) {
        let reach = if coordinate.unit == "rad" { PI } else { q.abs().max(1.0) };
        controls.push(control(&coordinate.name, "start", &coordinate.unit, q, around(q, reach)));
    }
    for (name, v) in velocities(scene) {
        let coordinate = system.coordinates.iter().find(|c| format!("{}'", c.name) == name);
        let unit = coordinate.filter(|c| !c.unit.is_empty()).map_or(String::new(), |c| format!("{}/s", c.unit));
        controls.push(control(&name, "velocity", &unit, v, around(v, 2.0 * v.abs().max(0.5))));
    }
    for (name, &mu) in scene.multiplier_names().iter().zip(&scene.multipliers) {
        controls.push(control(name, "multiplier", "", mu, around(mu, mu.abs().max(2.0))));
    }
    for choice in choices {
        for (name, p) in given_costates(scene, choice) {
            let mut row = control(&costate_of(choice, &name), "costate", "", p, around(p, p.abs().max(10.0)));
            // what a search finds is known with the motion only
            if matches!(choice.constants, ConstantsRule::Natural { .. }) {
                row["value"] = Value::Null;
            }
            row["motion"] = choice.label.as_str().into();
            controls.push(row);
        }
    }
    if !system.constraints.is_empty() && system.coordinates.iter().all(|c| c.name != KAPPA) {
        controls.push(control(KAPPA, "kappa", "1/s", kappa, [0.0, MOST_KAPPA.max(2.0 * kappa)]));
    }
    let duration = scene.duration;
    controls.push(control("duration", "run", "s", duration, [duration / 10.0, duration * 3.0]));
    controls
}

fn control(name: &str, kind: &str, unit: &str, value: f64, bounds: [f64; 2]) -> Value {
    let [low, high] = if bounds[0] <= bounds[1] { bounds } else { [bounds[1], bounds[0]] };
    json!({ "name": name, "kind": kind, "unit": unit, "value": value, "low": low, "high": high })
}

fn around(value: f64, reach: f64) -> [f64; 2] {
    [value - reach, value + reach]
}

/// Names and values of the coordinates, velocities and rates that are given at the start.
pub(crate) fn start_numbers(scene: &Scene) -> Vec<(String, f64)> {
    let coordinates = scene.system.coordinates.iter().zip(&scene.start.q).map(|(c, &q)| (c.name.clone(), q));
    coordinates.chain(velocities(scene)).collect()
}

/// The velocities and rates that are given at the start; the constraints supply the others.
fn velocities(scene: &Scene) -> Vec<(String, f64)> {
    let g = &scene.system.graph;
    let values = scene.system.values_at(&scene.start);
    let given = |name: &String| {
        let symbol = g.find_symbol(name)?;
        let (_, written) = scene.completion.written.iter().find(|(of, _)| *of == symbol)?;
        Some((name.clone(), g.evaluate(*written, &values).ok()?))
    };
    scene.completion.given.iter().filter_map(given).collect()
}
