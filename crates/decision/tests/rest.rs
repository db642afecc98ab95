//! Curves at rest: algebra with constant coefficients. Answers by hand and by
//! `validation/casadi/decision.py`.

use decision::{Decision, Finding, Proof, Verdict};
use scene::Scene;

use crate::closed_forms::COIN;
use crate::questions::{
    as_written, built_in, chetaev, chetaev_equations, decided, exact_start, is_vakonomic, proved, proved_in, removed,
    written,
};

/// How many dimensions of constants are left; floating point and proof have to say the same.
fn left(decision: &Decision, proof: &Proof) -> Option<usize> {
    println!("{:?} rho {:.1e} noise {:.1e}; {proof:?}", decision.verdict, decision.least, decision.noise);
    let proved = match proof.this_start {
        Finding::None(_) => None,
        Finding::Contained { rank, .. } => Some(decision.constants.len() - rank),
        ref other => panic!("{other:?}"),
    };
    assert_ne!(decision.verdict, Verdict::Undecided, "rho {:.1e}, noise {:.1e}", decision.least, decision.noise);
    assert_eq!((decision.verdict == Verdict::Contained).then(|| decision.set.dimension()), proved);
    proved
}

fn multipliers(scene: &Scene) -> Option<usize> {
    left(&is_vakonomic(scene), &proved(scene).0)
}

#[test]
fn constraints_without_a_curvature_there_bind_nothing() {
    assert_eq!(multipliers(&built_in("disc", &[("psi'", 0.0), ("phi'", 0.0)])), Some(2));
    // held by the constraint; in floating point pi/2 leaves 6e-17 of the force
    let across = COIN.replace("phi = { start = 0.4 }", "phi = { start = \"pi/2\" }");
    assert_eq!(multipliers(&written(&across, &[("psi'", 0.0), ("phi'", 0.0)])), Some(2));
    let sledge = as_written("sledge", &[("x'", "0"), ("phi'", "0"), ("phi", "pi/2")]);
    assert_eq!(multipliers(&sledge), Some(1));
    let family = removed(&sledge, &sledge.removals[0]);
    let proof = proved_in(&sledge, &chetaev_equations(&sledge), &[], &family).0;
    assert_eq!(left(&decided(&family, &chetaev(&sledge)), &proof), Some(1));
}

/// Held by the reaction across the blade, or by nothing at all; along the slope it is not.
#[test]
fn rest_is_known_exactly() {
    let rests = |name: &str, overrides: &[(&str, &str)]| exact_start(&as_written(name, overrides)).is_at_rest();
    assert!(rests("sledge", &[("x'", "0"), ("phi'", "0"), ("phi", "pi/2")]));
    assert!(rests("disc", &[("psi'", "0"), ("phi'", "0")]));
    assert!(!rests("sledge", &[("x'", "0"), ("phi'", "0"), ("phi", "1.57")]));
    assert!(!rests("sledge", &[("x'", "0"), ("phi'", "1e-9"), ("phi", "pi/2")]));
    assert!(!rests("turntable", &[]));
}

#[test]
fn at_rest_for_an_instant_only() {
    assert_eq!(multipliers(&written(COIN, &[("psi'", 0.0), ("phi'", 0.0)])), None);
    assert_eq!(multipliers(&built_in("sledge", &[("x'", 0.0), ("phi'", 0.0)])), None);
    // straight down the blade does not react
    let down = is_vakonomic(&built_in("sledge", &[("x'", 0.0), ("phi'", 0.0), ("phi", 0.0)]));
    assert_eq!((down.verdict, down.set.dimension()), (Verdict::Contained, 0));
}

/// A particle at rest at `(x, 0, 0)`, with this potential and one constraint; `more` are further lines of the
/// system.
fn particle(x: &str, potential: &str, constraint: &str, more: &str) -> String {
    format!(
        r#"
title = "A particle at rest"
[parameters]
weight = 0
push = 2
[coordinates]
x = {{ start = {x} }}
y = {{ start = 0 }}
z = {{ start = 0 }}
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2 - ({potential})"
constraints = ["{constraint}"]
{more}
[start.velocities]
"x'" = 0
"y'" = 0
[run]
duration = 2
"#
    )
}

#[test]
fn constraints_with_a_curvature_there_do() {
    // a drift that is zero where the particle rests: C = (-0.3, 0, 0)': mu = 0;
    // with a weight lambda = 1 drives mu away from there
    let drift = particle("0", "x^2 + weight*z", "z' - 0.3*x - 0.5*x*y'", "");
    assert_eq!(multipliers(&written(&drift, &[])), Some(0));
    assert_eq!(multipliers(&written(&drift, &[("weight", 1.0)])), None);
}

#[test]
fn held_by_a_force_or_not() {
    let held = particle("0", "5*z - 2*x", "z' - x*y'", r#"forces = { x = "-push" }"#);
    assert_eq!(multipliers(&written(&held, &[])), Some(1));
    // without it the particle runs along x; there λ = 5
    assert_eq!(multipliers(&written(&held, &[("push", 1.9)])), None);
}

#[test]
fn round_off_of_what_balances_is_no_motion() {
    // at the logarithm of 2, which no decimal is
    let scene = written(&particle("\"log(2)\"", "100*(exp(x) - 2*x)", "z' - x*y'", ""), &[]);
    let decision = is_vakonomic(&scene);
    println!(
        "{:?} rho {:.1e} noise {:.1e} {:.1e}",
        decision.verdict, decision.least, decision.noise, decision.acceleration
    );
    assert!(matches!(proved(&scene).0.this_start, Finding::NotApplicable(_)));
    assert_eq!((decision.verdict, decision.set.dimension()), (Verdict::Contained, 1));
}

/// In the unit of z a constant of size 1 would add terms of 1e23 to motions of 1e9: no round-off of these.
#[test]
fn constants_in_another_unit_hide_no_motion() {
    let text = r#"
title = "In small units"
coordinates = { x = { start = 1.1 }, y = { start = 0.4 }, z = { start = 0.7 }, phi = { start = 0.4 } }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2 + phi'^2)/2"
constraints = ["x' - x*phi*y'", "y + 1e7*z - 7000000.4"]
forces = { z = "phi'" }
[start]
project = true
velocities = { "z'" = 1, "phi'" = 0 }
[run]
duration = 0.5
"#;
    let scene = written(text, &[]);
    assert!(is_vakonomic(&scene).moves());
    assert_eq!(multipliers(&scene), None);
}
