//! Machines of bodies drawn at random, against Newton's and Euler's equations in numbers: bodies and contacts
//! as `docs/bodies.md` describes them.

mod frame;
mod kinds;
mod machine;
mod newton;
mod rider;

use std::cmp::Ordering;

use equations::Compiled;
use motion::CHETAEV;
use nalgebra::DVector;
use scene::Scene;

use self::kinds::{closed, inside, robot, rolling, tree};
use self::machine::Machine;
use self::rider::rider;
use super::support::{equations, must, numbers, values};

/// Whether a fault says rightly that a drawn machine is none.
fn is_no_machine(fault: &str) -> bool {
    [
        "nothing to move",
        "is empty",
        "no start of",
        "configurations",
        "configuration",
        "a heading only",
        "singular",
        "no solution",
    ]
    .iter()
    .any(|words| fault.contains(words))
}

/// Whether formulas do not mean the same system and start as the bodies that they follow from.
fn unlike(bodies: &Scene, formulas: &str) -> Option<String> {
    let again = match Scene::parse("formulas", formulas) {
        Ok(again) => again,
        Err(fault) => return Some(fault.to_string()),
    };
    let numbers = |s: &Scene| {
        let all = [&[s.system.lagrangian], &s.system.constraints[..], &s.system.forces].concat();
        numbers(&s.system.graph, &all, &values(&s.system, &bodies.start))
    };
    let state = |s: &Scene| [&s.start.q[..], &s.start.v].concat();
    let all = [numbers(bodies), state(bodies)].concat().into_iter().zip([numbers(&again), state(&again)].concat());
    let off = all.map(|(a, b)| (a - b).abs() / a.abs().max(1.0)).fold(0.0, f64::max);
    (again.meant.is_some() || off.partial_cmp(&1e-11) != Some(Ordering::Less)).then(|| format!("{off:.1e} off"))
}

/// Of each kind a number of machines, and `MACHINES` times as many where that is set (`docs/long-checks.md`).
#[test]
fn drawn_machines_move_as_newton_and_euler_have_it() {
    let times: u64 = std::env::var("MACHINES").map_or(1, |times| times.parse().expect("a number"));
    let (mut compared, mut faults, mut worst) = (0, Vec::new(), 0.0_f64);
    for (kind, make, count) in [
        ("tree", tree as fn(u64) -> Machine, 25_u64),
        ("rolling", rolling, 30),
        ("robot", robot, 20),
        ("loop", closed, 15),
        ("inside", inside, 25),
        ("bicycle with a leaning rider", rider, 3),
    ] {
        let (count, mut of_kind, mut largest) = (count * times, 0, 0.0_f64);
        for seed in 0..count {
            let machine = make(1000 * seed + 76);
            let text = machine.scene_text();
            let scene = match Scene::parse("drawn", &text) {
                Ok(scene) => scene,
                Err(fault) if is_no_machine(&fault.to_string()) => {
                    println!("{kind} {seed}: {}", fault.to_string().lines().next().unwrap_or_default());
                    continue;
                }
                Err(fault) => {
                    faults.push(format!("{kind} {seed}: {fault}\n{text}"));
                    continue;
                }
            };
            let formulas = scene.meant.as_ref().map(|meant| meant.formulas.clone()).unwrap_or_default();
            if let Some(fault) = unlike(&scene, &formulas) {
                faults.push(format!("{kind} {seed}: the scene of formulas: {fault}\n{text}\n{formulas}"));
                continue;
            }
            let (t, q, v) = (scene.start.t, &scene.start.q, &scene.start.v);
            let (expected, off) = machine.accelerations(t, q, v);
            if expected.len() < q.len() {
                println!("{kind} {seed}: something without mass");
                continue;
            }
            if machine.leans_past_flat(t, q) {
                println!("{kind} {seed}: leans past flat");
                continue;
            }
            let mut rates = vec![0.0; 2 * q.len()];
            let equations = equations(&scene.system, CHETAEV, None);
            let mut compiled = Compiled::new(&equations).unwrap_or_else(|e| panic!("{e}"));
            if let Err(fault) = compiled.rates(t, &[&q[..], v].concat(), &mut rates) {
                faults.push(format!("{kind} {seed}: {fault}\n{text}"));
                continue;
            }
            let found = DVector::from_row_slice(&rates[q.len()..]);
            let apart = (&found - &expected).amax() / expected.amax().max(1.0);
            of_kind += 1;
            if apart.max(off).partial_cmp(&1e-10) != Some(Ordering::Less) {
                faults
                    .push(format!("{kind} {seed}: {apart:.1e} apart, start {off:.1e} off\n{text}\n{found}{expected}"));
            } else {
                largest = largest.max(apart);
            }
        }
        println!("{kind}: {of_kind} of {count} compared, largest difference {largest:.1e}");
        compared += of_kind;
        worst = worst.max(largest);
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n\n"));
    assert!(compared >= 100 * times, "{compared} machines");
    must("drawn machines: accelerations", worst, 1e-10);
}
