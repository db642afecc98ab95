//! A sign that is turned in one of the terms changes a checked answer.

use std::collections::HashMap;

use decision::{Decision, Family, Verdict};
use equations::{Equations, Role};
use scene::Scene;
use symbolic::Expr;

use crate::questions::{built_in, chetaev, decided, flow, removed_equations, vakonomic_equations, written};

/// The family with its balances `R(μ̇, μ)` changed.
fn changed(scene: &Scene, change: impl Fn(&Equations, Expr) -> Expr) -> Decision {
    let mut equations = vakonomic_equations(scene);
    let n = scene.system.dimension();
    let residuals: Vec<Expr> = equations.blocks[0].residuals[..n].iter().map(|&r| change(&equations, r)).collect();
    equations.blocks[0].residuals[..n].copy_from_slice(&residuals);
    decided(&Family::new(&scene.system, &equations).expect("a family"), &chetaev(scene))
}

/// `R` with `±` in front of some symbols.
fn turned(equations: &Equations, residual: Expr, names: &[&str]) -> Expr {
    let g = &equations.graph;
    let symbols = names.iter().filter_map(|name| g.find_symbol(name));
    let map: HashMap<_, _> = symbols.map(|s| (s, g.neg(g.variable(s)))).collect();
    g.substitute(residual, &map)
}

#[test]
fn of_the_rate_and_of_the_reaction() {
    let disc = built_in("disc", &[]);
    let right: Vec<f64> = disc.start.v[..2].iter().map(|v| -v).collect();
    let plain = changed(&disc, |_, r| r);
    assert!(plain.verdict == Verdict::Contained && plain.set.distance(&right) < 1e-6);
    let is_other = |other: &Decision| other.verdict != Verdict::Contained || other.set.distance(&right) > 0.1;
    // the rate of mu alone
    assert!(is_other(&changed(&disc, |e, r| turned(e, r, &["mu_1'", "mu_2'"]))));
    // lambda: the terms with neither, which are the reaction along Chetaev's motion
    assert!(is_other(&changed(&disc, |e, r| turned(e, r, &["mu_1", "mu_2", "mu_1'", "mu_2'"]))));
}

#[test]
fn of_the_curvature() {
    // the disc does not tell: C mu = 0 for its multipliers
    let ball = built_in("turntable", &[("x", 0.6), ("psi'", 0.7), ("duration", 3.0)]);
    let plain = changed(&ball, |_, r| r);
    assert!(plain.verdict == Verdict::Contained && plain.set.distance(&[0.0, 0.048]) < 1e-6);
    let other = changed(&ball, |e, r| turned(e, r, &["mu_1", "mu_2"]));
    assert!(other.verdict != Verdict::Contained || other.set.distance(&[0.0, 0.048]) > 0.01, "{:?}", other.set);
}

#[test]
fn of_the_costate_equations() {
    // T3: this vakonomic sledge is a removed-constraint one
    let scene = built_in("sledge", &[("duration", 3.0)]);
    let pull = 9.81 * 0.4_f64.sin();
    let horizon = -0.5 / (pull * 0.3_f64.cos());
    let curve = flow(&scene, &vakonomic_equations(&scene), &[pull * horizon * 0.3_f64.sin()]);
    let verdict = |change: &dyn Fn(&mut Equations)| {
        let mut equations = removed_equations(&scene, &scene.removals[0]);
        change(&mut equations);
        decided(&Family::new(&scene.system, &equations).expect("a family"), &curve).verdict
    };
    assert_eq!(verdict(&|_| ()), Verdict::Contained);
    let rate = |equations: &mut Equations| {
        for y in equations.states.iter_mut().filter(|y| y.role == Role::MemoryCostate) {
            y.rate = equations.graph.neg(y.rate);
        }
    };
    assert_eq!(verdict(&rate), Verdict::NotContained);
    let balance = |equations: &mut Equations| {
        let turned = equations.blocks[0].residuals.iter().map(|&r| turned(equations, r, &["P_x"])).collect();
        equations.blocks[0].residuals = turned;
    };
    assert_eq!(verdict(&balance), Verdict::NotContained);
}

const PULLED: &str = r#"
title = "Particle in a bowl that is pulled and braked"
[coordinates]
x = { start = 0.7 }
y = { start = -0.2 }
z = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2 - 5*z"
constraints = ["z' - 0.8*x*x' - 1.3*y*y'"]
forces = { x = "-0.4*x'", y = "0.3*x", z = "0.1*x*y'" }
[start.velocities]
"x'" = 0.3
"y'" = 1.1
[run]
duration = 3
"#;

#[test]
fn of_the_force() {
    // an integrable constraint: with the same force in both formulations every multiplier is right
    let scene = written(PULLED, &[]);
    let plain = changed(&scene, |_, r| r);
    assert_eq!((plain.verdict, plain.set.dimension()), (Verdict::Contained, 1));
    for factor in [1, 2] {
        // added once more: no force at all; twice: the opposite one
        let system = &scene.system;
        let mut equations = vakonomic_equations(&scene);
        let g = &equations.graph;
        for (i, &force) in system.forces.iter().enumerate() {
            let residual = &mut equations.blocks[0].residuals[i];
            *residual = g.add(*residual, g.mul(g.integer(factor), force));
        }
        let other = decided(&Family::new(system, &equations).expect("a family"), &chetaev(&scene));
        assert_eq!(other.verdict, Verdict::NotContained, "{factor}");
    }
}
