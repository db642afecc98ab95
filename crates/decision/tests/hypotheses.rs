//! Hypotheses without which a yes is none: open in time, one branch, no accident of one prime.

use decision::{Finding, Proof, Section};

use crate::questions::{as_written, beside, built_in, proved, written};

/// A particle with one constraint, from `x`, `y`, with velocities 1 and 0.5.
fn particle(constraint: &str, [x, y]: [&str; 2]) -> String {
    format!(
        r#"
title = "A particle"
[parameters]
large = 1
[coordinates]
x = {{ start = {x} }}
y = {{ start = {y} }}
z = {{ start = 0 }}
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2"
constraints = ["{constraint}"]
[start.velocities]
"x'" = 1
"y'" = 0.5
[run]
duration = 2
"#
    )
}

fn of(constraint: &str, start: [&str; 2]) -> (Proof, Option<Section>) {
    proved(&written(&particle(constraint, start), &[]))
}

#[test]
fn time_is_drawn_as_well() {
    for (constraint, order) in [
        ("z' - t*y*x'", 1),
        ("z' - t^2*y*x'", 3),
        ("z' - t^6*y*x'", 11),
        ("z' - t^12*y*x'", 23),
        ("z' - t^20*y*x'", 39),
        ("z' - (1 + t^5*x)*x' - t^5*y'", 0),
        ("z' - sin(t)^4*y*x'", 7),
    ] {
        let (proof, section) = of(constraint, ["0", "0.7"]);
        println!("{constraint}: {proof:?} {section:?}");
        assert_eq!(section, None, "{constraint}");
        assert!(matches!(proof.almost_every_start, Finding::None(_)), "{constraint}: {proof:?}");
        let Finding::None(found) = &proof.this_start else { panic!("{constraint}: {proof:?}") };
        assert!(order == 0 || found.order == order, "{constraint}: {proof:?}");
        assert!(found.full_rank);
    }
    // too flat for so few orders: nothing is said beyond them
    let (proof, section) = of("z' - t^40*y*x'", ["0", "0.7"]);
    assert!(matches!(proof.this_start, Finding::ThroughOrder { order: 40.., .. }), "{proof:?}");
    assert!(matches!(proof.almost_every_start, Finding::None(_)) && section.is_none(), "{proof:?}");
}

/// An upright disc on a plane whose tilt is `ramp`.
fn tilting(ramp: &str) -> String {
    format!(
        r#"
title = "An upright disc on a plane that is tilted"
[parameters]
m = 1
R = 0.5
g = 9.81
[definitions]
s = "t/2"
ramp = "{ramp}"
[coordinates]
x = {{ start = 0 }}
y = {{ start = 0 }}
psi = {{ start = 0 }}
phi = {{ start = 0.4 }}
[system]
lagrangian = "m*(x'^2 + y'^2)/2 + psi'^2/16 + phi'^2/32 + m*g*x*sin(0.3*ramp)"
constraints = ["x' - R*psi'*cos(phi)", "y' - R*psi'*sin(phi)"]
[start.velocities]
"psi'" = 2
"phi'" = 0.7
[run]
duration = 2
"#
    )
}

#[test]
fn a_plane_that_begins_to_tilt() {
    let (proof, section) = proved(&written(&tilting("35*s^4 - 84*s^5 + 70*s^6 - 20*s^7"), &[]));
    assert_eq!(section, None);
    assert!(matches!(&proof.almost_every_start, Finding::None(_)), "{proof:?}");
    assert!(matches!(&proof.this_start, Finding::None(none) if none.order == 5), "{proof:?}");
    let (proof, section) = proved(&written(&tilting("0*s"), &[]));
    assert!(matches!(&proof.this_start, Finding::Contained { rank: 2, .. }), "{proof:?}");
    assert!(section.is_some_and(|section| section.proved));
}

#[test]
fn a_root_has_branches() {
    for constraint in ["z' - (x - sqrt(x^2))*y'", "z' - (x - (x^2)^(3/2)/x^2)*y'"] {
        let (proof, section) = of(constraint, ["1", "0"]);
        assert!(
            proof.domain.branch && matches!(proof.this_start, Finding::Contained { .. }),
            "{constraint}: {proof:?}"
        );
        assert!(section.is_none_or(|section| !section.proved), "{constraint}");
        let (proof, section) = of(constraint, ["-1", "0"]);
        assert!(matches!(proof.this_start, Finding::None(_)) && section.is_none(), "{constraint}: {proof:?}");
        assert!(proof.domain.branch && matches!(proof.almost_every_start, Finding::None(_)), "{constraint}: {proof:?}");
    }
    let shifted = "z' - (x - 0.2 - sqrt(x^2 - 0.4*x + 0.04))*y'";
    assert!(matches!(of(shifted, ["0.3", "0"]).0.this_start, Finding::Contained { .. }));
    assert!(matches!(of(shifted, ["0.1", "0"]).0.this_start, Finding::None(_)));
    // an angle has no image at a random start
    let (proof, section) = of("z' - (atan2(y, x) - atan(y/x))*y'", ["-1", "0.3"]);
    assert!(matches!(proof.almost_every_start, Finding::NotApplicable(_)) && section.is_none(), "{proof:?}");
}

#[test]
fn no_prime_of_the_program_makes_a_yes() {
    for prime in ["1564665937272678241", "2001148671957795361", "1338093198693931681", "1600630950478079521"] {
        for constraint in [format!("z' - {prime}*y*x'"), format!("z' - y*x'/{prime}")] {
            let (proof, section) = of(&constraint, ["0.2", "0.7"]);
            assert!(matches!(&proof.this_start, Finding::None(none) if none.full_rank), "{constraint}: {proof:?}");
            assert!(matches!(proof.almost_every_start, Finding::None(_)) && section.is_none(), "{constraint}");
        }
    }
    // numbers that are alike modulo one of them
    let (proof, section) = of("z' - (large - 1564665937272678242)*y*x'", ["0.2", "0.7"]);
    assert!(matches!(proof.this_start, Finding::None(_)) && section.is_none(), "{proof:?}");
}

#[test]
fn flat_constraints_need_high_orders() {
    for (power, order) in [(2, 3), (4, 7), (8, 15), (12, 23)] {
        let text = particle(&format!("z' - y^{power}*x'"), ["0", "0"]);
        let (proof, _) = proved(&written(&text, &[]));
        assert!(matches!(&proof.this_start, Finding::None(none) if none.order == order), "{power}: {proof:?}");
    }
}

#[test]
fn identities_are_proved_symbolically() {
    for (name, set) in [
        ("disc", vec![]),
        ("disc", vec![("phi'", 0.0)]),
        ("heisenberg", vec![]),
        ("bowl", vec![]),
        ("appell-hamel", vec![]),
    ] {
        let (_, section) = proved(&built_in(name, &set));
        println!("{name}: {section:?}");
        assert!(section.expect("a section").proved, "{name}");
    }
    let (_, section) = proved(&beside("generalized-heisenberg"));
    assert!(section.expect("a section").proved);
    let (proof, _) = proved(&as_written("disc", &[("phi", "pi/6")]));
    assert!(matches!(proof.this_start, Finding::Contained { rank: 2, .. }), "{proof:?}");
}
