//! The same system in other words has the same answers: other units, numbers as formulas, other
//! combinations of the constraints.

use equations::Derivation;
use integrals::{Ansatz, Reversed, ansatz, reversible};
use mechanics::System;
use scene::Scene;
use symbolic::{Expr, Function, Symbol};

use crate::questions::{built_in, start};

type Numbers = &'static [(&'static str, &'static str)];

/// Scenes with numbers, and the same numbers as formulas.
const SCENES: [(&str, Numbers, Numbers); 8] = [
    ("sleigh", &[], &[("a", "2/5"), ("m", "2/2")]),
    ("sledge", &[("g", "9.81")], &[("g", "981/100")]),
    ("suslov", &[("K", "0")], &[("K", "1/3 - 2/6")]),
    ("suslov", &[], &[]),
    ("veselova", &[], &[]),
    ("chaplygin-sphere", &[("I2", "0.1")], &[("I2", "1/10")]),
    ("rubber-chaplygin-sphere", &[], &[]),
    ("snakeboard", &[], &[]),
];

/// How many of these are taken, unless `INTEGRALS` is set.
const QUICK: usize = 5;

/// `q = ℓ Q` for lengths, `t = τ T`, `L` times `κ`: with τ = 1/7, all by fractions.
fn in_other_units(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    let (system, g) = (&scene.system, scene.system.graph.clone());
    let (length, rate) = (g.ratio(1000, 3), g.integer(7));
    let mut map = std::collections::HashMap::new();
    for c in &system.coordinates {
        let scale = if c.unit == "m" { length } else { g.one() };
        map.insert(c.position, g.mul(scale, g.variable(c.position)));
        map.insert(c.velocity, g.product(&[scale, rate, g.variable(c.velocity)]));
    }
    other.system.lagrangian = g.mul(g.ratio(11, 4), g.substitute(system.lagrangian, &map));
    other.system.constraints = g.substitute_all(&system.constraints, &map);
    other.system.graph = g;
    other
}

/// Each constraint times `2 + sin q` and with a multiple of the one before; `L` times `sin² q + cos² q`;
/// `q` is one that they contain, as the ansatz is made of these.
fn in_other_words(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    let (g, written) = (scene.system.graph.clone(), scene.system.written());
    let is_contained = |q: &Symbol| written.iter().any(|&e| g.depends_on(e, *q));
    let q = g.variable(scene.system.positions().into_iter().rfind(is_contained).expect("a coordinate"));
    let call = |function| g.powi(g.call(function, q), 2);
    let one = g.add(call(Function::Sin), call(Function::Cos));
    let factor = g.add(g.integer(2), g.call(Function::Sin, q));
    other.system.lagrangian = g.mul(one, scene.system.lagrangian);
    let mut before: Option<Expr> = None;
    for f in &mut other.system.constraints {
        *f = g.add(g.mul(factor, *f), before.map_or(g.zero(), |before| g.mul(q, before)));
        before = Some(*f);
    }
    other.system.graph = g;
    other
}

fn answers(scene: &Scene, system: &System) -> (Reversed, Ansatz) {
    let start = start(scene);
    let equations = chetaev::derive(system, &Derivation::default()).expect("equations");
    let found = ansatz(system, &equations, &start, 1, &[]).unwrap_or_else(|open| panic!("{}: {open}", scene.name));
    (reversible(system, &start, 1), found)
}

#[test]
fn the_same_system_in_other_words_has_the_same_answers() {
    // those after QUICK take seconds each
    let count = if std::env::var("INTEGRALS").is_ok() { SCENES.len() } else { QUICK };
    for (name, numbers, formulas) in SCENES.into_iter().take(count) {
        let scene = built_in(name, numbers);
        let (reversed, ansatz) = answers(&scene, &scene.system);
        for (what, other) in [
            ("numbers as formulas", built_in(name, formulas)),
            ("other units", in_other_units(&scene)),
            ("other words", in_other_words(&scene)),
        ] {
            // the start is asked for its branch only
            let (same, in_ansatz) = answers(&scene, &other.system);
            assert_eq!(same, reversed, "{name}: {what}");
            assert_eq!(in_ansatz.dimension, ansatz.dimension, "{name}: {what}");
            assert_eq!(in_ansatz.printed.len(), ansatz.printed.len(), "{name}: {what}");
        }
    }
}
