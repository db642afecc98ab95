//! Proofs over the finite field.

use decision::{Finding, Proof};

use crate::questions::{
    built_in, chetaev_equations, leading, proved, proved_in, removed, vakonomic, vakonomic_equations, written,
};

fn order(finding: &Finding) -> Option<usize> {
    match finding {
        Finding::None(proof) => Some(proof.order),
        _ => None,
    }
}

fn refuted(proof: &Proof, expected: usize) {
    println!("{:?}", proof.this_start);
    assert_eq!(order(&proof.this_start), Some(expected), "{proof:?}");
    assert!(order(&proof.almost_every_start).is_some(), "{proof:?}");
    let Finding::None(found) = &proof.this_start else { return };
    assert!(found.full_rank);
}

#[test]
fn no_multipliers_proved_at_the_order_given() {
    for (name, expected) in [
        ("sledge", 1),
        ("sleigh", 1),
        ("particle", 1),
        ("turntable", 1),
        ("ball-in-cone", 1),
        ("ball-in-cone-as-printed", 1),
        ("three-cylinders", 4),
        ("trailer", 4),
    ] {
        println!("{name}");
        let (proof, section) = proved(&built_in(name, &[]));
        refuted(&proof, expected);
        assert_eq!(section, None, "{name}");
    }
}

#[test]
fn the_ball_that_turns_with_its_table() {
    let (proof, _) = proved(&built_in("turntable", &[("x", 0.6), ("psi'", 0.7)]));
    println!("{proof:?}");
    assert!(matches!(proof.this_start, Finding::ThroughOrder { rank: 2, order: 10.. }), "{proof:?}");
    assert!(order(&proof.almost_every_start).is_some());
    // a circle beside the axis, and a spin that is not quite that of the table
    refuted(&proved(&built_in("turntable", &[("psi'", 0.7)])).0, 3);
    let (proof, _) = proved(&built_in("turntable", &[("x", 0.6), ("psi'", 0.700001)]));
    assert!(order(&proof.this_start).is_some(), "{proof:?}");
}

#[test]
fn identities_over_all_starts() {
    let (proof, section) = proved(&built_in("disc", &[]));
    println!("{proof:?} {section:?}");
    let section = section.expect("a section");
    assert_eq!(section.expressions, ["-m*x'", "-m*y'"]);
    assert!(matches!(proof.this_start, Finding::Contained { rank: 2, .. }), "{proof:?}");
    assert!(matches!(proof.almost_every_start, Finding::Contained { rank: 2, .. }));
    // straight ahead the rank is less; the identity holds there, too
    let (proof, section) = proved(&built_in("disc", &[("phi'", 0.0)]));
    assert!(matches!(proof.this_start, Finding::ThroughOrder { rank: 1, .. }), "{proof:?}");
    assert!(section.is_some());
    let (proof, section) = proved(&built_in("heisenberg", &[]));
    assert_eq!(section.expect("a section").expressions, ["0"]);
    assert!(matches!(proof.this_start, Finding::Contained { rank: 1, .. }), "{proof:?}");
    let (proof, section) = proved(&built_in("bowl", &[]));
    assert!(section.is_some());
    assert!(matches!(proof.this_start, Finding::Contained { rank: 0, .. }), "{proof:?}");
    // a random start on a cone has a root of its own
    let (proof, _) = proved(&built_in("appell-hamel", &[]));
    assert!(matches!(proof.this_start, Finding::Contained { rank: 0, .. }), "{proof:?}");
}

#[test]
fn other_curves_and_other_families() {
    // a vakonomic sledge is one, with the constant that it has
    let sledge = built_in("sledge", &[]);
    let (proof, _) = proved_in(&sledge, &vakonomic_equations(&sledge), &[0.3], &vakonomic(&sledge));
    assert!(matches!(proof.this_start, Finding::Contained { rank: 1, .. }), "{proof:?}");
    // Chetaev's sledge is no removed-constraint one, whatever the constants
    for removal in &sledge.removals {
        let family = removed(&sledge, removal);
        let (proof, _) = proved_in(&sledge, &chetaev_equations(&sledge), &[], &family);
        println!("{}: {:?}", removal.name, proof.this_start);
        assert!(order(&proof.this_start).is_some() && order(&proof.almost_every_start).is_some(), "{proof:?}");
    }
    // Newton's motion in a turning frame is one
    let body = built_in("planar-body", &[]);
    let family = removed(&body, &body.removals[0]);
    let (proof, _) = proved_in(&body, &chetaev_equations(&body), &[], &family);
    assert!(matches!(proof.this_start, Finding::Contained { rank: 2, .. }), "{proof:?}");
}

const NONLINEAR: &str = r#"
title = "A constraint of second degree"
[coordinates]
x = { start = 0.3 }
y = { start = 0.4 }
z = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2"
constraints = ["z' - x'^2/2 - y*x'*y'"]
[start.velocities]
"x'" = 0.7
"y'" = 0.5
[run]
duration = 2
"#;

#[test]
fn a_constraint_of_second_degree() {
    refuted(&proved(&written(NONLINEAR, &[])).0, 1);
}

const TWO_ROOTS: &str = r#"
title = "Two wheels driven by one speed"
[coordinates]
a = { start = 0 }
b = { start = 0.375 }
c = { start = 0.5 }
d = { start = 0 }
[system]
lagrangian = "(a'^2 + b'^2 + c'^2 + d'^2)/2 + (2 + sin(b))*(3*a' + 4*d')^2/8"
constraints = ["a'^2 - (b'^2 + c'^2)/4", "d'^2 - 9*(b'^2 + c'^2)/64"]
[start.velocities]
"a'" = 0.5
"b'" = 0.6
"c'" = 0.8
"d'" = 0.375
[run]
duration = 2
"#;

#[test]
fn random_starts_are_on_the_surface_of_the_start() {
    // 3 a' = ±4 d': with the lower sign the motion is straight, with the upper one it is not
    let (proof, _) = proved(&written(TWO_ROOTS, &[]));
    assert!(order(&proof.this_start).is_some() && order(&proof.almost_every_start).is_some(), "{proof:?}");
    let (proof, _) = proved(&written(&TWO_ROOTS.replace("\"d'\" = 0.375", "\"d'\" = -0.375"), &[]));
    assert!(matches!(proof.almost_every_start, Finding::Contained { .. }), "{proof:?}");
    // a square in every constraint: which factor is zero does not show in the field
    let product = NONLINEAR.replace("z' - x'^2/2 - y*x'*y'", "4*x'^2 - y^2*y'^2").replace("= 0.7", "= 0.1\n\"z'\" = 0");
    let (proof, _) = proved(&written(&product, &[]));
    assert!(matches!(&proof.almost_every_start, Finding::NotApplicable(why) if why.contains("products")), "{proof:?}");
}

#[test]
fn what_cannot_be_proved_says_why() {
    let logarithm = NONLINEAR.replace("(x'^2 + y'^2 + z'^2)/2", "(x'^2 + y'^2 + z'^2)/2 - x*log(2 + x)");
    let (proof, _) = proved(&written(&logarithm, &[]));
    assert_eq!(proof.this_start, Finding::NotApplicable("a logarithm is taken at the start".into()));
    let pi = NONLINEAR.replace("(x'^2 + y'^2 + z'^2)/2", "(x'^2 + y'^2 + z'^2)/2 - pi*x^2");
    let (proof, _) = proved(&written(&pi, &[]));
    assert_eq!(proof.this_start, Finding::NotApplicable("the number pi stands outside of sines and cosines".into()));
}

#[test]
fn leading_differences_for_any_multipliers() {
    // disc, mu_0 = +m v_0: 0.9428 t³
    let disc = built_in("disc", &[]);
    for exact in [false, true] {
        let (exponent, coefficient, proved) = leading(&disc, &disc.start.v[..2], exact).expect("a difference");
        let length = coefficient.iter().zip([1.0, 1.0, 0.125, 0.0625]).map(|(c, m)| m * c * c).sum::<f64>().sqrt();
        println!("{exponent} {coefficient:?} {length} {proved}");
        // the decimals of v_0 are not quite on the constraint: exactly, there is a term of 1e-17 t² besides
        assert_eq!((exponent, proved), (3, false));
        assert!((length - 0.9428).abs() < 1e-4, "{length}");
    }
    // sledge, mu_0 = 0: -(1/6) Π C λ_0 t³
    let sledge = built_in("sledge", &[]);
    assert_eq!(leading(&sledge, &[0.0], true).map(|found| (found.0, found.2)), Some((3, true)));
    assert_eq!(leading(&sledge, &[0.5], true).map(|found| (found.0, found.2)), Some((2, true)));
    // and none for the multipliers of the disc
    let right: Vec<f64> = disc.start.v[..2].iter().map(|v| -v).collect();
    assert_eq!(leading(&disc, &right, false), None);
}
