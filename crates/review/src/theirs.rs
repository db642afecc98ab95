//! The scene in somebody else's coordinates: mistakes are made in the terms that these give.

use mechanics::{Completion, Parameter, State, System};
use scene::Scene;
use symbolic::limits::TOO_LONG;

use crate::reading::Reading;

/// The scene in their coordinates and parameters; none where these are not as many, or the same.
pub(crate) fn in_theirs(scene: &Scene, reading: &Reading) -> Option<Scene> {
    let (own, n) = (&reading.system, reading.system.dimension());
    if reading.map.is_empty() || reading.coordinates.len() != n || !own.virtual_conditions.is_empty() {
        return None;
    }
    let g = &own.graph;
    let q: Vec<_> = reading.coordinates.iter().map(|c| c[0]).collect();
    let places = reading.of_scene(g, &g.variables(&own.positions()));
    // squares of sines and cosines add up
    let lagrangian = g.expand_if_shorter(reading.of_scene(g, &[own.lagrangian])[0], TOO_LONG);
    let constraints = reading.of_scene(g, &own.constraints);
    let forces = g.transpose_vec(&g.jacobian(&places, &q), &reading.of_scene(g, &own.forces));
    let names: Vec<String> = q.iter().map(|&s| g.name(s)).collect();
    let named: Vec<(&str, &str)> = names.iter().map(|name| (&name[..], "")).collect();
    let of = |&(symbol, value): &(symbolic::Symbol, f64)| Parameter { symbol, value, formula: None };
    let parameters = reading.parameters.iter().map(of).collect();
    let system = System { lagrangian, constraints, forces, parameters, ..System::new(g.clone(), &named) };
    let start = State { t: scene.start.t, q: vec![0.7; n], v: vec![0.7; n] };
    Some(Scene { system, start, completion: Completion::default(), removals: Vec::new(), ..scene.clone() })
}
