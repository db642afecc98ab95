//! Velocities, reactions, virtual displacements and the direction of gravity, on systems where they are
//! known.

use serde_json::{Value, json};

use crate::{SLEDGE, ask, place};

const DISC: &str = include_str!("../../scene/scenes/disc.toml");
const PENDULUM: &str = include_str!("../../scene/scenes/velocity-pendulum.toml");
/// Places and directions by differences, relative to the largest.
const NEAR: f64 = 3e-5;

/// What a row of a motion with `n` coordinates says beside them.
struct Row {
    q: Vec<f64>,
    v: Vec<f64>,
    multipliers: Vec<f64>,
    velocity: [f64; 3],
    rest: f64,
    directions: [[f64; 3]; 2],
    contact: [f64; 3],
    force: [f64; 3],
}

fn rows(name: &str, text: &str, motion: &str, n: usize) -> (Value, Vec<Row>) {
    let (answer, numbers) =
        ask(json!({ "ask": "motions", "name": name, "text": text, "motions": [motion], "steps": 8, "forces": true }));
    let told = &answer["motions"][0];
    assert_eq!(place(&answer, "contacts"), 1, "{name}");
    let count = |name: &str| told[name].as_array().unwrap().len();
    let width = place(told, "width");
    let arrows = 1 + 2 * n + count("multipliers") + count("invariants") + count("observables");
    let row = |row: &[f64]| {
        let three = |i: usize| [row[arrows + i], row[arrows + i + 1], row[arrows + i + 2]];
        Row {
            q: row[1..=n].to_vec(),
            v: row[n + 1..=2 * n].to_vec(),
            multipliers: row[2 * n + 1..2 * n + 1 + count("multipliers")].to_vec(),
            velocity: three(0),
            rest: row[arrows + 3],
            directions: [three(4), three(7)],
            contact: three(10),
            force: three(13),
        }
    };
    let from = place(told, "from");
    let rows = numbers[from..from + place(told, "rows") * width].chunks_exact(width).map(row).collect();
    (answer.clone(), rows)
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    let size = b.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < NEAR * size)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn on_slope(x: f64, y: f64) -> [f64; 3] {
    let (sin, cos) = 0.4_f64.sin_cos();
    [cos * x, y, -sin * x]
}

#[test]
fn the_reaction_of_a_blade_is_its_multiplier_across_it() {
    let (answer, rows) = rows("sledge", SLEDGE, "Chetaev", 3);
    assert_eq!(answer["down"], json!([0.0, 0.0, -1.0]));
    for row in rows {
        let (sin, cos) = row.q[2].sin_cos();
        let across = on_slope(-sin, cos).map(|x| x * row.multipliers[0]);
        assert!(near(row.force, across), "{:?}, not {across:?}", row.force);
        assert!(near(row.velocity, on_slope(row.v[0], row.v[1])), "{:?}", row.velocity);
        assert!(near(row.contact, on_slope(row.q[0], row.q[1])), "{:?}", row.contact);
        assert!(row.rest < 1e-3, "{}", row.rest);
        assert!((dot(row.directions[0], on_slope(cos, sin)).abs() - 1.0).abs() < NEAR, "{:?}", row.directions);
        assert_eq!(row.directions[1], [0.0; 3]);
    }
}

/// In level rolling at a constant rate the contact pulls the disc along its axle: `m v ω`, inwards.
#[test]
fn a_rolling_disc_is_held_on_its_circle() {
    let (answer, rows) = rows("disc", DISC, "Chetaev", 4);
    assert!(answer["down"].is_null(), "{}", answer["down"]);
    for row in rows {
        let (sin, cos) = row.q[3].sin_cos();
        // R psi' = 1 m/s, phi' = 0.7 rad/s, unit mass
        assert!(near(row.force, [-0.7 * sin, 0.7 * cos, 0.0]), "{:?}", row.force);
        assert!((dot(row.directions[0], [cos, sin, 0.0]).abs() - 1.0).abs() < NEAR, "{:?}", row.directions);
    }
}

/// No blade pushes along itself or turns what it carries: the vakonomic motion asks for that.
#[test]
fn the_vakonomic_reaction_is_not_that_of_a_blade() {
    let (_, rows) = rows("sledge", SLEDGE, "vakonomic", 3);
    let along = |row: &Row| dot(row.force, on_slope(row.q[2].cos(), row.q[2].sin())).abs();
    assert!(rows.iter().any(|row| along(row) > 0.5 || row.rest > 0.5));
}

#[test]
fn down_is_where_a_pendulum_hangs() {
    let (answer, _) =
        ask(json!({ "ask": "motions", "name": "p", "text": PENDULUM, "motions": ["Chetaev"], "steps": 8 }));
    assert_eq!(answer["down"], json!([0.0, -1.0, 0.0]));
    assert!(answer["contacts"].is_null());
}

/// The bob draws the rod outwards with `m v²/l + m g cos`, here `−y` is `l cos`.
#[test]
fn a_rod_is_drawn_by_its_bob() {
    for row in rows("pendulum", PENDULUM, "Chetaev", 2).1 {
        let (speed, cos) = (row.v[0].hypot(row.v[1]), -row.q[1]);
        let tension = speed * speed + 9.81 * cos;
        assert!(near(row.force, [tension * row.q[0], tension * row.q[1], 0.0]), "{:?}, not {tension}", row.force);
        assert!(row.rest < 1e-3, "{}", row.rest);
    }
}
