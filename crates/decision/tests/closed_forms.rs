//! Sets known in closed form for all starts.

use decision::{Decision, Verdict};

use crate::questions::{built_in, is_vakonomic, written};

fn is_contained(decision: &Decision) -> bool {
    assert_ne!(decision.verdict, Verdict::Undecided, "{} noise {}", decision.least, decision.noise);
    decision.verdict == Verdict::Contained
}

#[test]
fn a_contact_constraint_has_multipliers_only_where_it_does_not_react() {
    for (name, overrides, contained) in [
        // sledge: omega = 0 and sin(phi) = 0
        ("sledge", vec![("phi", 0.0), ("phi'", 0.0)], true),
        ("sledge", vec![("phi", 0.0)], false),
        ("sledge", vec![("phi'", 0.0)], false),
        // sleigh: omega = 0
        ("sleigh", vec![("phi'", 0.0)], true),
        ("sleigh", vec![("phi'", 0.01)], false),
        // particle: x' y' = 0
        ("particle", vec![("x'", 0.0)], true),
        ("particle", vec![("y'", 0.0)], true),
    ] {
        let mut all = overrides.clone();
        all.push(("duration", 2.0));
        let decision = is_vakonomic(&built_in(name, &all));
        println!("{name} {overrides:?}: {:?} {:.2e} {:.1e}", decision.verdict, decision.least, decision.noise);
        assert_eq!(is_contained(&decision), contained, "{name} {overrides:?}");
        if contained {
            assert!(decision.set.distance(&[0.0]) < 1e-6, "{:?}", decision.set);
        }
    }
}

#[test]
fn a_ball_on_a_turning_table() {
    // at rest in space, or turning with the table about its axis
    for (overrides, contained) in [
        (vec![("x", 0.6), ("psi'", 0.7)], true),
        (vec![("x", 0.6), ("psi'", 0.701)], false),
        (vec![("c", 0.0), ("psi'", 0.2)], true),
        (vec![("c", 0.3), ("x", 0.3), ("psi'", 0.7)], true),
    ] {
        let scene = built_in("turntable", &[&overrides[..], &[("duration", 3.0)]].concat());
        let decision = is_vakonomic(&scene);
        println!(
            "{overrides:?}: {:?} {:.2e} {:.1e} {:?}",
            decision.verdict, decision.least, decision.noise, decision.set
        );
        assert_eq!(is_contained(&decision), contained, "{overrides:?}");
        if contained && scene.start.v[1] != 0.0 {
            // mu_0 = (2m/5) v_0
            let expected: Vec<f64> = scene.start.v[..2].iter().map(|v| 0.4 * v).collect();
            assert!(decision.set.distance(&expected) < 1e-6, "{:?}", decision.set);
        }
    }
}

pub(crate) const COIN: &str = r#"
title = "Coin on an incline"
[parameters]
R = 0.5
slope = 4
[coordinates]
x = { start = 0 }
y = { start = 0 }
psi = { start = 0 }
phi = { start = 0.4 }
[system]
lagrangian = "(x'^2 + y'^2)/2 + psi'^2/16 + phi'^2/32 + slope*x"
constraints = ["x' - R*psi'*cos(phi)", "y' - R*psi'*sin(phi)"]
[start.velocities]
"psi'" = 2
"phi'" = 0
[run]
duration = 3
"#;

#[test]
fn a_coin_on_an_incline() {
    for (overrides, contained) in [
        (vec![("phi", 0.0)], true),
        (vec![("phi", 0.0), ("psi'", -1.0)], true),
        (vec![], false),
        (vec![("phi", 0.0), ("phi'", 0.1)], false),
        (vec![("phi'", 0.7)], false),
    ] {
        let decision = is_vakonomic(&written(COIN, &overrides));
        println!(
            "{overrides:?}: {:?} {:.2e} {:.1e} {:?}",
            decision.verdict, decision.least, decision.noise, decision.set
        );
        assert_eq!(is_contained(&decision), contained, "{overrides:?}");
        assert!(!contained || decision.set.dimension() == 1);
    }
}
