//! A car with trailers.

use mechanics::State;
use scene::Scene;
use scene::catalogue::trailer::{Coordinates, scene, text};
use symbolic::Expr;

/// One body at the start: `x`, `y`, `θ` and their rates.
struct Body<'a> {
    place: &'a [f64],
    velocity: &'a [f64],
}

/// Axles are `d` before and behind, and each rolls along its own heading.
#[test]
fn bodies_hang_on_one_another_and_roll() {
    let train = scene(4, Coordinates::Maximal).expect("parses");
    let d = train.system.parameters[2].value;
    assert_eq!(train.system.graph.name(train.system.parameters[2].symbol), "d");
    let State { q, v, .. } = &train.start;
    let bodies: Vec<Body> = q.chunks(3).zip(v.chunks(3)).map(|(place, velocity)| Body { place, velocity }).collect();
    assert_eq!(bodies.len(), 5);
    for (i, body) in bodies.iter().enumerate() {
        let (sine, cosine) = body.place[2].sin_cos();
        assert!((body.place[2] - (0.3 - 0.1 * i as f64)).abs() < 1e-15, "{i}: {:?}", body.place);
        let slip = body.velocity[1] * cosine - body.velocity[0] * sine;
        assert!(slip.abs() < 1e-15, "{i}: {slip:e}");
        let Some(front) = i.checked_sub(1).map(|i| &bodies[i]) else { continue };
        for (k, along) in [cosine, sine].into_iter().enumerate() {
            let hitch = body.place[k] + d * along - front.place[k];
            assert!(hitch.abs() < 1e-15, "{i}: {hitch:e}");
        }
        // d/dt of the hitch
        let hitch = [body.velocity[0] - d * body.velocity[2] * sine, body.velocity[1] + d * body.velocity[2] * cosine];
        assert!((0..2).all(|k| (hitch[k] - front.velocity[k]).abs() < 1e-15), "{i}: {hitch:?}");
    }
    let speed = bodies[0].velocity[0].hypot(bodies[0].velocity[1]);
    assert!((speed - 1.2).abs() < 1e-15 && bodies[0].velocity[2] == 0.5, "{speed}");
}

/// The text has the start of the first two velocities only; the constraints supply the others.
#[test]
fn the_text_and_the_scene_are_one_system_with_one_start() {
    for coordinates in [Coordinates::Maximal, Coordinates::Minimal] {
        let (made, text) = (scene(3, coordinates).expect("parses"), text(3, coordinates));
        let read = Scene::parse("train", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!((made.start.t, &made.start.q, made.duration), (0.0, &read.start.q, read.duration));
        let off = made.start.v.iter().zip(&read.start.v).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{coordinates:?}: {off:e}");
        // somewhere else: L and the constraints, whatever the order of their terms
        let spread = |from: f64, by: f64| (0..made.start.q.len()).map(|i| from + by * i as f64).collect();
        let there = State { t: 0.0, q: spread(0.3, 0.7), v: spread(1.0, -0.4) };
        let values = |Scene { system, .. }: &Scene| -> Vec<f64> {
            let mut at = system.parameter_values();
            at.extend(system.values_at(&there));
            let value = |e: &Expr| system.graph.evaluate(*e, &at).expect("a value");
            [system.lagrangian].iter().chain(&system.constraints).map(value).collect()
        };
        let (made_there, read_there) = (values(&made), values(&read));
        assert_eq!(made_there.len(), read_there.len());
        for (a, b) in made_there.iter().zip(&read_there) {
            assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0), "{coordinates:?}: {a} {b}");
        }
        assert_eq!(made.multipliers, vec![0.0; made.system.constraints.len()]);
    }
}
