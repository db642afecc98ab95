//! Constraints on positions: random starts are on the leaf of the scene's, and what is known exactly of
//! leaves makes proofs.

use decision::{Finding, Proof};

use crate::questions::{as_written, beside, proved, written};

/// The ice sledge with its heading as a unit vector `(c, s)`: L has no part along it.
fn sledge_by_vectors(c: &str, s: &str, rates: &str) -> String {
    format!(
        r#"
title = "Ice sledge, its heading a unit vector"
[coordinates]
x = {{ start = 0 }}
y = {{ start = 0 }}
c = {{ start = {c} }}
s = {{ start = {s} }}
[system]
lagrangian = "(x'^2 + y'^2 + (c*s' - s*c')^2 + (c*c' + s*s')^2)/2 + x"
constraints = ["c^2 + s^2 - 1", "y'*c - x'*s"]
[start.velocities]
{rates}
[run]
duration = 2
"#
    )
}

fn none(finding: &Finding) -> (usize, bool) {
    match finding {
        Finding::None(none) => (none.order, none.full_rank),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_unit_vector_gets_the_answers_of_an_angle() {
    let text = sledge_by_vectors("0.6", "0.8", "\"x'\" = 0.6\n\"c'\" = -0.8");
    let (proof, section) = proved(&written(&text, &[]));
    assert_eq!((none(&proof.this_start), none(&proof.almost_every_start)), ((1, true), (1, true)), "{proof:?}");
    assert_eq!((section, proof.domain.leaf), (None, true));
    assert!(!proved(&as_written("sledge", &[])).0.domain.leaf);
}

/// `C μ` vanishes on `w = 0` for the second constraint; on other leaves it does not.
#[test]
fn what_is_integrable_on_the_leaf_has_every_multiplier() {
    let text = r#"
title = "A saddle, and a term that is zero on the leaf"
[coordinates]
x = { start = "1/2" }
y = { start = "1/5" }
z = { start = 0 }
w = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2 + w'^2)/2 + x*z"
constraints = ["w", "z' - y*x' - x*y' + 3*w*y*x'"]
[start.velocities]
"x'" = 1
"y'" = 0.3
[run]
duration = 1
"#;
    let held = |text: &str| -> Proof { proved(&written(text, &[])).0 };
    let found = held(text).almost_every_start;
    assert!(matches!(found, Finding::Contained { rank: 0, .. }), "{found:?}");
    // as a constraint on velocities it has all leaves
    let found = held(&text.replace("\"w\",", "\"w'\",")).almost_every_start;
    assert!(none(&found).1, "{found:?}");
}

/// A sphere, a rod between two points, a paraboloid; and what no random point is found on.
#[test]
fn surfaces_have_random_points() {
    let text = |coordinates: &str, constraints: &str| {
        format!(
            "title = \"Surface\"\n[coordinates]\n{coordinates}\n[system]\nlagrangian = \"LAGRANGIAN\"\nconstraints = \
             [{constraints}]\n[start.velocities]\nRATES\n[run]\nduration = 1\n"
        )
    };
    let of = |starts: &[(&str, &str)], constraints: &str| {
        let lines: Vec<String> = starts.iter().map(|(name, x)| format!("{name} = {{ start = {x} }}")).collect();
        let squares: Vec<String> = starts.iter().map(|(name, _)| format!("{name}'^2/2")).collect();
        let rates: Vec<String> = starts.iter().map(|(name, _)| format!("\"{name}'\" = 0")).collect();
        let lagrangian = format!("{} + {}", squares.join(" + "), starts[0].0);
        let text = text(&lines.join("\n"), constraints);
        proved(&written(&text.replace("LAGRANGIAN", &lagrangian).replace("RATES", &rates.join("\n")), &[])).0
    };
    let every = |proof: &Proof| matches!(proof.almost_every_start, Finding::Contained { rank: 0, .. });
    for (starts, constraints) in [
        (&[("x", "0.6"), ("y", "0.8"), ("z", "0")][..], "\"x^2 + y^2 + z^2 - 1\""),
        (&[("x", "1"), ("y", "0"), ("u", "1"), ("v", "1")], "\"x^2 + y^2 - 1\", \"(u - x)^2 + (v - y)^2 - 1\""),
        (&[("x", "1"), ("y", "2"), ("z", "5")], "\"z - x^2 - y^2\""),
        (&[("x", "1"), ("y", "0"), ("z", "3")], "\"x^3 + y + z - 4\""),
    ] {
        let proof = of(starts, constraints);
        assert!(every(&proof), "{constraints}: {proof:?}");
    }
    // two planes: the other one is not that of the start; a quartic curve has no formula
    for (starts, constraints, why) in [
        (&[("x", "1"), ("y", "1"), ("z", "0")][..], "\"x^2 - y^2\"", "products"),
        (&[("x", "1"), ("y", "1"), ("z", "0")], "\"x^4 + y^4 - 2\"", "on positions"),
    ] {
        let found = of(starts, constraints).almost_every_start;
        assert!(matches!(&found, Finding::NotApplicable(reason) if reason.contains(why)), "{constraints}: {found:?}");
    }
}

/// One of two constraints is integrable: `O` has rank 1 at most, and a minor of size 2 proves that there is
/// none.
#[test]
fn known_integrals_make_proofs_of_smaller_minors() {
    let text = r#"
title = "Partly integrable"
[coordinates]
x = { start = 0.5 }
y = { start = 0.3 }
z = { start = 0 }
w = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2 + w'^2)/2 + x - w*z"
constraints = ["z' - x*y' - y*x'", "w' - y*x'"]
[start.velocities]
"x'" = 0.4
"y'" = 0.2
[run]
duration = 1.5
"#;
    let (proof, _) = proved(&written(text, &[]));
    assert!(matches!(&proof.this_start, Finding::None(none) if none.full_rank && none.size == 2), "{proof:?}");
    for name in ["two-wheeled-carriage", "rattleback"] {
        let (proof, _) = proved(&beside(name));
        assert!(matches!(&proof.this_start, Finding::None(none) if none.full_rank), "{name}: {proof:?}");
    }
}
