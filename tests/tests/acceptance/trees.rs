//! What trees of n bodies cost beside the same systems in formulas by hand: operations of a right-hand side,
//! and derivation.

use std::fmt::Write;
use std::time::Instant;

use equations::Derivation;
use mechanics::ConstantsRule;
use motion::{REDUCED_CHETAEV, Settings, prepare, setting};
use scene::Scene;

use super::machines::same_system;
use super::support::must;

const SIZES: [usize; 4] = [5, 10, 20, 40];

fn parsed(coordinates: &[String], velocities: &str, rest: &str) -> Scene {
    let rest = format!("\n{rest}");
    let (top, rest) = rest.split_at(rest.find("\n[").unwrap_or_default() + 1);
    let q: String = coordinates
        .iter()
        .enumerate()
        .map(|(i, q)| format!("{q} = {{ start = {:?} }}\n", 0.1 * (i % 7) as f64))
        .collect();
    let text =
        format!("title = \"tree\"\n{top}[coordinates]\n{q}{rest}[start.velocities]\n{velocities}[run]\nduration = 1\n");
    Scene::parse("tree", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// Points of mass 1/n that hang one on another by links of length 1/n from a cart with a wheel: of bodies,
/// and by hand.
fn chain(n: usize) -> [Scene; 2] {
    let l = 1.0 / n as f64;
    let mut bodies = "gravity = [0, 0, -9.81]\n[body.cart]\njoint = { slider = \"x\", shift = \"x\", at = [0, 0, 0.25] }\nmass = 2\n[body.wheel]\non = \"cart\"\njoint = { hinge = \"y\", angle = \"psi\" }\nshape = \"wheel\"\nsize = [0.25]\ninertia = [0, 0.5, 0]\n[contact.wheel]\nof = \"wheel\"\nlaw = \"rolls\"\n".to_string();
    let (mut definitions, mut lagrangian) = ("[definitions]\n".to_string(), "x'^2 + psi'^2/4".to_string());
    let (mut on, mut at, mut angle) = ("cart".to_string(), String::new(), String::new());
    let (mut x, mut z) = ("x".to_string(), "0".to_string());
    for i in 1..=n {
        write!(bodies, "[body.b{i}]\non = \"{on}\"\njoint = {{ hinge = [0, -1, 0], angle = \"a{i}{angle}\"{at} }}\nmass = {l}\nmass-centre = [0, 0, {}]\n", -l).unwrap_or_default();
        (on, at, angle) = (format!("b{i}"), format!(", at = [0, 0, {}]", -l), format!(" - a{i}"));
        write!(definitions, "x{i} = \"{x} + {l}*sin(a{i})\"\nz{i} = \"{z} - {l}*cos(a{i})\"\n").unwrap_or_default();
        (x, z) = (format!("x{i}"), format!("z{i}"));
        write!(lagrangian, " + {l}/2*({x}'^2 + {z}'^2) - 9.81*{l}*{z}").unwrap_or_default();
    }
    let by_hand = format!("{definitions}[system]\nlagrangian = \"{lagrangian}\"\nconstraints = [\"x' - psi'/4\"]\n");
    let q: Vec<String> = ["x".into(), "psi".into()].into_iter().chain((1..=n).map(|i| format!("a{i}"))).collect();
    let v: String = q.iter().skip(1).map(|q| format!("\"{q}'\" = 0.2\n")).collect();
    [bodies, by_hand].map(|text| parsed(&q, &v, &text))
}

/// Links in the plane on blades, each hitched `at` behind the middle of the one before, `own` before its own:
/// trailers, or with a motor at each joint a snake.
fn planar(n: usize, [at, own]: [f64; 2], is_driven: bool) -> [Scene; 2] {
    let (mut bodies, mut contacts, mut motors) = (String::new(), "[contact]\n".to_string(), "[motor]\n".to_string());
    let (mut definitions, mut lagrangian) = ("[definitions]\n".to_string(), String::new());
    let mut rows = String::new();
    let mut forces = vec![String::new(); n];
    let (mut x, mut y) = ("x".to_string(), "y".to_string());
    for i in 0..n {
        let joint = match i.checked_sub(1) {
            None => "joint = { plane = [\"x\", \"y\", \"a0\"] }".to_string(),
            Some(h) => {
                write!(definitions, "x{i} = \"{x} - {at}*cos(a{h}) - {own}*cos(a{i})\"\ny{i} = \"{y} - {at}*sin(a{h}) - {own}*sin(a{i})\"\n").unwrap_or_default();
                (x, y) = (format!("x{i}"), format!("y{i}"));
                writeln!(motors, "m{i} = {{ joint = \"l{i}\", force = \"{i}*cos(t)\" }}").unwrap_or_default();
                forces[i] += &format!(" + {i}*cos(t)");
                forces[h] += &format!(" - {i}*cos(t)");
                format!(
                    "on = \"l{h}\"\njoint = {{ hinge = \"z\", angle = \"a{i} - a{h}\", at = [{}, 0], own = [{own}, 0] }}",
                    -at
                )
            }
        };
        write!(bodies, "[body.l{i}]\n{joint}\nmass = 2\ninertia = [0, 0, 0.1]\n").unwrap_or_default();
        writeln!(contacts, "c{i} = {{ of = \"l{i}\", law = \"blade\" }}").unwrap_or_default();
        write!(lagrangian, " + {x}'^2 + {y}'^2 + 0.05*a{i}'^2").unwrap_or_default();
        writeln!(rows, "\"{y}'*cos(a{i}) - {x}'*sin(a{i})\", ").unwrap_or_default();
    }
    let mut driven = String::new();
    if is_driven {
        driven += "[system.forces]\n";
        forces.iter().enumerate().for_each(|(i, force)| driven += &format!("a{i} = \"{force}\"\n"));
    } else {
        motors.clear();
    }
    let by_hand =
        format!("{definitions}[system]\nlagrangian = \"{}\"\nconstraints = [\n{rows}]\n{driven}", &lagrangian[3..]);
    let q: Vec<String> = ["x".into(), "y".into()].into_iter().chain((0..n).map(|i| format!("a{i}"))).collect();
    [format!("{bodies}{contacts}{motors}"), by_hand].map(|text| parsed(&q, "\"x'\" = 1\n\"a0'\" = 0.2\n", &text))
}

/// Seconds of derivation and compilation, and operations of a right-hand side, of Chetaev's equations.
fn cost(scene: &Scene) -> [f64; 2] {
    let clock = Instant::now();
    let derivation = Derivation { start: Some(&scene.start), ..Derivation::default() };
    let derived = (REDUCED_CHETAEV.derive)(&scene.system, &derivation).unwrap_or_else(|e| panic!("{e}"));
    let ready = prepare(setting(scene), derived.leave_out_unneeded(), &ConstantsRule::Zero, &Settings::default());
    let ready = ready.unwrap_or_else(|e| panic!("{e}"));
    [clock.elapsed().as_secs_f64(), ready.compiled.cost()[1].operations() as f64]
}

#[test]
fn trees_of_bodies_cost_no_more_than_formulas_by_hand() {
    type Tree = fn(usize) -> [Scene; 2];
    let trees: [(&str, Tree); 3] = [
        ("chain on a cart", chain),
        ("snake", |n| planar(n, [0.5, 0.5], true)),
        ("trailers", |n| planar(n, [0.3, 1.1], false)),
    ];
    for (name, tree) in trees {
        let [bodies, by_hand] = tree(6);
        same_system(name, &by_hand, &bodies);
        let costs = SIZES.map(|n| tree(n).each_ref().map(cost));
        for (n, cost) in SIZES.iter().zip(&costs) {
            println!("{name}, n = {n}: seconds of derivation, operations, of bodies and by hand: {cost:.3?}");
        }
        let exponent = |of: usize, what: usize| {
            let points: Vec<(f64, f64)> = SIZES.iter().zip(&costs).map(|(&n, c)| (n as f64, c[of][what])).collect();
            bench::exponent(&points[1..]).map_or(f64::INFINITY, |exponent| exponent.value)
        };
        let all = [0, 1].map(|of| [exponent(of, 0), exponent(of, 1)]);
        println!("{name}: exponents of the same: {all:.2?}");
        must(&format!("{name}: exponent of operations over that by hand"), all[0][1] - all[1][1], 0.1);
        for (n, cost) in SIZES.iter().zip(&costs) {
            must(&format!("{name}, n = {n}: operations over those by hand"), cost[0][1] / cost[1][1], 1.05);
        }
    }
}
