//! A body without any constraint, its velocities written along a turning frame: removal itself put to the test (T14).

use std::collections::BTreeMap;

use mechanics::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal, State, System};
use scene::Scene;
use symbolic::{Expr, Graph};

use super::support::{at, complete, error, must, must_exceed, removed, scene};

const START: [f64; 6] = [1.0, -0.4, 0.2, 0.3, 0.9, 0.8];

/// `L = ½(ẋ² + ẏ² + φ̇²) − ½(x² + 2y²)`, `h = 0`.
fn body() -> Scene {
    let graph = Graph::new();
    let mut system = System::new(graph, &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    let g = system.graph.clone();
    let scope = |name: &str| g.find_symbol(name).map(|s| g.variable(s));
    let lagrangian = g.parse("(x'^2 + y'^2 + phi'^2)/2 - (x^2 + 2*y^2)/2", &scope, &[]).expect("parses");
    system.lagrangian = lagrangian;
    system.graph = g;
    let [x, y, phi, vx, vy, turn] = START;
    let start = State { t: 0.0, q: vec![x, y, phi], v: vec![vx, vy, turn] };
    Scene {
        name: "planar-body".into(),
        system,
        start,
        removals: Vec::new(),
        multipliers: Vec::new(),
        duration: 3.0,
        ..scene("bowl", &[])
    }
}

/// `ẋ = u̇ cos φ − ṡ sin φ`, `ẏ = u̇ sin φ + ṡ cos φ`.
fn turning_frame(system: &System) -> Removal {
    let g = &system.graph;
    let parameter = |name: &str, coordinate| DisplacementParameter {
        symbol: g.symbol(name),
        rate: g.symbol(&format!("{name}'")),
        second_rate: g.symbol(&format!("{name}''")),
        coordinate,
    };
    let parameters = vec![parameter("u", None), parameter("s", None), parameter("phi", Some(2))];
    let scope = |name: &str| g.find_symbol(name).map(|s| g.variable(s));
    let rate = |text: &str| -> Expr { g.parse(text, &scope, &[]).expect("parses") };
    let memory = vec![
        MemoryVariable {
            symbol: system.coordinates[0].position,
            rate: rate("u'*cos(phi) - s'*sin(phi)"),
            coordinate: Some(0),
        },
        MemoryVariable {
            symbol: system.coordinates[1].position,
            rate: rate("u'*sin(phi) + s'*cos(phi)"),
            coordinate: Some(1),
        },
    ];
    let zero = BTreeMap::from([(parameters[0].symbol, g.zero()), (parameters[1].symbol, g.zero())]);
    Removal {
        name: "turning-frame".into(),
        parameters,
        memory,
        coordinates: g.variables(&system.positions()),
        start: zero,
        constants: ConstantsRule::Zero,
    }
}

#[test]
fn removal_of_nothing_is_newtons_motion_only_for_the_right_constants() {
    let scene = body();
    let frame = turning_frame(&scene.system);
    frame.verify(&scene.system).expect("there is nothing to satisfy");
    let [x, y, phi, vx, vy, turn] = START;
    let w = 2.0_f64.sqrt();
    let newton = |t: f64| vec![x * t.cos() + vx * t.sin(), y * (w * t).cos() + vy / w * (w * t).sin(), phi + turn * t];

    must(
        "planar body, Chetaev without constraint: Newton",
        error(&mut super::support::chetaev(&scene), &newton),
        1e-11,
    );
    let mut right = complete(&scene, removed(&scene, &frame, &[-vx, -vy]));
    let start = at(&mut right, 0.0);
    let names: Vec<&str> = right.equations.multipliers.iter().map(|m| m.name.as_str()).collect();
    let p_u = start.multipliers[names.iter().position(|n| *n == "p_u").expect("p_u")];
    must("planar body, P(t₀) = −(ẋ₀, ẏ₀): |p_u|", p_u.abs(), 1e-14);
    must("planar body, P(t₀) = −(ẋ₀, ẏ₀): Newton's motion over 3 s", error(&mut right, &newton), 1e-8);

    let mut wrong = complete(&scene, removed(&scene, &frame, &[0.0, 0.0]));
    let rotation = at(&mut wrong, 3.0).coordinates[2] - newton(3.0)[2];
    println!("planar body, P(t₀) = 0: rotation off by {rotation:.3} rad after 3 s");
    must_exceed("planar body, P(t₀) = 0: rotation off after 3 s, rad", rotation.abs(), 1.0);
}
