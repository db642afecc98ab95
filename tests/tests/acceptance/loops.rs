//! Starts of closed loops against intersections of circles.

use super::support::must;
use super::textbook_machines::{HEAD, as_by_hand};

#[test]
fn loops_are_constraints_on_positions() {
    let bodies = r#"
gravity = [0, "-g", 0]
[parameters]
g = 9.81
[body.crank]
joint = { hinge = [0, 0, 1], angle = "a" }
mass = 2
mass-centre = [0.15, 0, 0]
inertia = [0, 0, 0.02]
[body.rod]
on = "crank"
joint = { hinge = [0, 0, 1], angle = "b - a", at = [0.3, 0, 0] }
mass = 1
mass-centre = [0.4, 0, 0]
inertia = [0, 0, 0.05]
[body.piston]
joint = { slider = [1, 0, 0], shift = "s" }
mass = 0.7
[loop.pin]
between = { rod = [0.8, 0, 0], piston = [0, 0, 0] }
"#;
    let by_hand = r#"
[system]
lagrangian = "0.0225*a'^2 + 0.01*a'^2 + 0.5*(0.09*a'^2 + 0.16*b'^2 + 0.24*a'*b'*cos(a - b)) + 0.025*b'^2 + 0.35*s'^2 - 9.81*(0.3*sin(a) + 0.3*sin(a) + 0.4*sin(b))"
constraints = ["0.3*cos(a) + 0.8*cos(b) - s", "0.3*sin(a) + 0.8*sin(b)"]
"#;
    let (a, b) = (0.7_f64, -f64::asin(0.3 * f64::sin(0.7) / 0.8));
    let s = 0.3 * a.cos() + 0.8 * b.cos();
    as_by_hand("slider-crank", &[("a", a), ("b", b), ("s", s)], bodies, by_hand);
}

/// Intersections of the circles about `p` and `q` with radii `r` and `s`.
fn circles(p: [f64; 2], r: f64, q: [f64; 2], s: f64) -> [[f64; 2]; 2] {
    let d = [q[0] - p[0], q[1] - p[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let along = (square + r * r - s * s) / (2.0 * square);
    let across = (r * r / square - along * along).sqrt();
    [1.0, -1.0].map(|k| [p[0] + along * d[0] - k * across * d[1], p[1] + along * d[1] + k * across * d[0]])
}

/// A loop leaves two configurations; both are named, and a guess chooses one.
#[track_caller]
fn configurations(title: &str, given: &str, names: [&str; 2], bodies: &str, expected: [[f64; 2]; 2]) {
    let with = |guess: &dyn Fn(usize) -> String| {
        let free: String = names.iter().enumerate().map(|(k, q)| format!("{q} = {{ {} }}\n", guess(k))).collect();
        scene::Scene::parse(
            title,
            &format!("{HEAD}[coordinates]\n{given}{free}{bodies}[start.velocities]\n\"a'\" = 1\n"),
        )
    };
    let error = match with(&|_| String::new()) {
        Ok(_) => panic!("{title}: no choice"),
        Err(error) => error.to_string(),
    };
    assert!(error.contains("constraints on positions leave 2 configurations"), "{error}");
    for x in expected {
        let named = format!("{} = {:.6}, {} = {:.6}", names[0], x[0], names[1], x[1]);
        assert!(error.contains(&named), "{named}: {error}");
        let scene = with(&|k| format!("guess = {}", x[k] + 0.1)).unwrap_or_else(|e| panic!("{e}"));
        let off = scene.start.q[1..].iter().zip(x).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        must(&format!("{title}: configuration"), off, 1e-13);
    }
}

#[test]
fn closed_loops_find_their_start_and_name_all_configurations() {
    let a = 0.7_f64;
    let crank = [a.cos(), a.sin()];
    let driven = r#"
[body.crank]
joint = { hinge = "z", angle = "a" }
mass = 1
inertia = [0, 0, 0.1]
[body.coupler]
on = "crank"
joint = { hinge = "z", angle = "b - a", at = [1, 0] }
mass = 1
inertia = [0, 0, 0.1]
"#;
    // crank 1, coupler 2.2, rocker 1.6, frame 2
    let four_bars = r#"
[body.rocker]
joint = { hinge = "z", angle = "c", at = [2, 0] }
inertia = [0, 0, 0.2]
[loop.pin]
between = { coupler = [2.2, 0], rocker = [1.6, 0] }
"#;
    let pins = circles(crank, 2.2, [2.0, 0.0], 1.6);
    let angles = pins.map(|[x, y]| [(y - crank[1]).atan2(x - crank[0]), y.atan2(x - 2.0)]);
    configurations("four bars", "a = { start = 0.7 }\n", ["b", "c"], &[driven, four_bars].concat(), angles);
    let slider = r#"
[body.piston]
joint = { slider = "x", shift = "s" }
mass = 0.5
[loop.pin]
between = { coupler = [2.5, 0], piston = [0, 0] }
"#;
    let (b, reach) = (-(crank[1] / 2.5).asin(), (2.5_f64 * 2.5 - crank[1] * crank[1]).sqrt());
    let places = [[b, crank[0] + reach], [-std::f64::consts::PI - b, crank[0] - reach]];
    configurations("slider-crank", "a = { start = 0.7 }\n", ["b", "s"], &[driven, slider].concat(), places);
    // two arms of 0.15 behind kingpins 1.2 apart, 0.3 inwards, and a tie rod; the left one is steered by 0.2
    let rod = 1.2 - 2.0 * 0.15 * 0.3_f64.sin();
    let ackermann = format!(
        r#"
[body.left]
joint = {{ hinge = "z", angle = "a", at = [0, 0.6] }}
inertia = [0, 0, 0.2]
[body.right]
joint = {{ hinge = "z", angle = "c", at = [0, -0.6] }}
inertia = [0, 0, 0.2]
[body.rod]
on = "left"
joint = {{ hinge = "z", angle = "b - a", at = ["-0.15*cos(0.3)", "-0.15*sin(0.3)"] }}
mass = 0.1
[loop.pin]
between = {{ rod = [0, {}], right = ["-0.15*cos(0.3)", "0.15*sin(0.3)"] }}
"#,
        -rod
    );
    let end = [0.15 * -(0.5_f64.cos()), 0.6 + 0.15 * -(0.5_f64.sin())];
    let pins = circles(end, rod, [0.0, -0.6], 0.15);
    let angles = pins.map(|[x, y]| {
        let turn = |angle: f64| angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round();
        // at 0 the rod points along -y, and the right arm at pi - 0.3
        [
            turn((y - end[1]).atan2(x - end[0]) + 0.5 * std::f64::consts::PI),
            turn((y + 0.6).atan2(x) - (std::f64::consts::PI - 0.3)),
        ]
    });
    configurations("Ackermann linkage", "a = { start = 0.2 }\n", ["b", "c"], &ackermann, angles);
}
