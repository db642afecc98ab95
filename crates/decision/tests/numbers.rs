//! Numbers as they are written: what enters the field is the number that the reader sees.

use decision::Finding;

use crate::questions::{as_written, leading, proved, written};

/// A sledge straight down the slope, in axes turned by `angle`.
fn turned(angle: &str, phi: &str) -> String {
    format!(
        r#"
title = "Sledge straight down the slope"
[parameters]
m = 1
J = 0.5
g = 4
angle = {angle}
[coordinates]
x = {{ start = 0 }}
y = {{ start = 0 }}
phi = {{ start = {phi} }}
[system]
lagrangian = "m*(x'^2 + y'^2)/2 + J*phi'^2/2 + m*g*(x*cos(angle) - y*sin(angle))"
constraints = ["x'*sin(phi) - y'*cos(phi)"]
[start.velocities]
"x'" = "cos(angle)"
"phi'" = 0
[run]
duration = 3
"#
    )
}

#[test]
fn multiples_of_pi_have_roots_of_unity() {
    for (angle, phi) in [
        ("\"pi/3\"", "\"-pi/3\""),
        ("\"30*pi/180\"", "\"-pi/6\""),
        ("\"pi/7\"", "\"-angle\""),
        ("\"22.5*pi/180 + 0.1\"", "\"-0.1 - pi/8\""),
        ("\"2*pi/13\"", "\"11*pi/13 - pi\""),
        ("0.25", "-0.25"),
    ] {
        let (proof, _) = proved(&written(&turned(angle, phi), &[]));
        assert!(matches!(proof.this_start, Finding::ThroughOrder { rank: 1, .. }), "{angle}, {phi}: {proof:?}");
        let off = format!("\"{} + 1e-6\"", phi.trim_matches('"'));
        let (proof, _) = proved(&written(&turned(angle, &off), &[]));
        assert!(matches!(proof.this_start, Finding::None(_)), "{angle}, {off}: {proof:?}");
    }
}

#[test]
fn a_formula_that_is_zero_is_zero() {
    // a force 1 that the constraint holds, and one that is no number but zero
    let text = turned("\"pi/3\"", "\"-pi/3\"").replace("x*cos(angle)", "(1 + cos(pi/3) - 1/2)*x*cos(angle)");
    let (proof, _) = proved(&written(&text, &[]));
    assert!(matches!(proof.this_start, Finding::ThroughOrder { rank: 1, .. }), "{proof:?}");
    // thirds in the parameters and in the formulas are the same
    for third in ["\"1/3\"", "\"2/6\"", "\"(1/3 + 1)/4\""] {
        let text =
            turned("0", "0").replace("m = 1\n", &format!("m = {third}\n")).replace("*g*(x", "*g*(m - 1/3 + 1)*(x");
        let text = if third.contains(")/4") { text } else { text.replace("y*sin(angle)", "(m - 1/3)*y") };
        let (proof, _) = proved(&written(&text, &[]));
        assert!(matches!(proof.this_start, Finding::ThroughOrder { rank: 1, .. }), "{third}: {proof:?}");
    }
}

#[test]
fn overrides_are_text_too() {
    for phi in ["pi", "0", "-2*pi", "7*pi/6 - pi/6"] {
        let (proof, _) = proved(&as_written("sledge", &[("phi", phi), ("phi'", "0")]));
        assert!(matches!(proof.this_start, Finding::ThroughOrder { .. }), "{phi}: {proof:?}");
    }
    let (proof, _) = proved(&as_written("sledge", &[("phi", "3.14159"), ("phi'", "0")]));
    assert!(matches!(proof.this_start, Finding::None(_)), "{proof:?}");
}

#[test]
fn what_has_no_image_is_refused_by_name() {
    for (angle, why) in [
        ("1.0471975511965976", "rounded to a double"),
        ("\"pi/17\"", "no multiple of pi/720720"),
        ("\"pi^2\"", "no fraction of moderate size"),
        ("\"1/pi\"", "pi stands outside"),
        ("\"1 + 1e-20\"", "no fraction of moderate size"),
        ("0.33333333333333333333333333", "no fraction of moderate size"),
        ("12345678901234567890", "no fraction of moderate size"),
        ("\"sqrt(2)^3.1\"", "a root is taken"),
    ] {
        let (proof, _) = proved(&written(&turned(angle, "0.5"), &[]));
        let Finding::NotApplicable(found) = &proof.this_start else { panic!("{angle}: {proof:?}") };
        assert!(found.contains(why), "{angle}: {found}");
    }
}

#[test]
fn leading_terms_see_the_numbers_too() {
    let scene = written(&turned("\"pi/3\"", "\"-pi/3\""), &[]);
    assert_eq!(leading(&scene, &[0.0], true), None);
}
