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
        ("\"pi/17\"", "not a multiple of pi/720720"),
        ("\"pi^2\"", "not a fraction of moderate size"),
        ("\"1/pi\"", "pi stands outside"),
        ("\"1 + 1e-20\"", "not a fraction of moderate size"),
        ("0.33333333333333333333333333", "not a fraction of moderate size"),
        ("1234567890123456789.12345", "not a fraction of moderate size"),
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

/// A blade that slides and turns on a slope, in units of mass and length of any size.
fn skate(mass: &str, length: &str) -> String {
    format!(
        r#"
title = "skate"
[parameters]
m = {mass}
[coordinates]
x = {{ start = 0 }}
y = {{ start = 0 }}
phi = {{ start = 0.3 }}
[system]
lagrangian = "m*{length}^2*(x'^2/{length}^2 + y'^2/{length}^2 + 0.2*phi'^2)/2 + 4.9*m*{length}*x"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start.velocities]
"phi'" = 1.1
"x'" = "0.5*{length}"
[run]
duration = 3
"#
    )
}

const UNITS: [(&str, &str); 6] =
    [("1", "1"), ("1e-12", "1e-9"), ("1e-45", "1e27"), ("3e60", "1e-30"), ("1e-27", "1e9"), ("7e-24", "2.5e-25")];

#[test]
fn decimals_of_any_exponent_are_exact() {
    for (mass, length) in UNITS {
        let (proof, _) = proved(&written(&skate(mass, length), &[]));
        let Finding::None(none) = &proof.this_start else { panic!("{mass}, {length}: {proof:?}") };
        assert_eq!((none.order, none.full_rank), (1, true), "{mass}, {length}");
    }
    // an identity, with numbers of any size in it
    for (mass, length) in UNITS {
        let text = skate(mass, length)
            .replace("y'*cos(phi) - x'*sin(phi)", "y' - x'*x/2")
            .replace("4.9*m", "0*m")
            .replace("\"phi'\" = 1.1", "\"phi'\" = 0");
        let (proof, section) = proved(&written(&text, &[]));
        assert!(matches!(proof.this_start, Finding::Contained { .. }), "{mass}, {length}: {proof:?}");
        assert!(section.is_some_and(|section| section.proved), "{mass}, {length}");
    }
    // what is rounded has no image, however small it is
    let rounded = skate("1", "1").replace("4.9", "(1e-20 + 1e-45)");
    let (proof, _) = proved(&written(&rounded, &[]));
    let Finding::NotApplicable(why) = &proof.this_start else { panic!("{proof:?}") };
    assert!(why.contains("not a fraction of moderate size"), "{why}");
}

#[test]
fn leading_terms_know_no_units() {
    for exact in [true, false] {
        let (usual, coefficient, _) = leading(&written(&skate("1", "1"), &[]), &[0.0], exact).expect("a difference");
        for (mass, length) in UNITS {
            let scene = written(&skate(mass, length), &[]);
            let (exponent, found, proved) = leading(&scene, &[0.0], exact).expect("a difference");
            assert_eq!((exponent, proved), (usual, exact), "{mass}, {length}");
            let unit: f64 = length.parse().unwrap();
            for (i, unit) in [unit, unit, 1.0].into_iter().enumerate() {
                let off = (found[i] - coefficient[i] * unit).abs();
                assert!(off <= 1e-9 * coefficient[i].abs() * unit + 1e-15 * unit, "{mass}, {length}: {found:?}");
            }
        }
    }
}
