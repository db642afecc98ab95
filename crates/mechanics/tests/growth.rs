//! Growth vectors at starts and at almost every place: published ones, and leaves and branches of starts.

use std::f64::consts::FRAC_PI_2;

use mechanics::{Domain, Growth, Integrability, integrability};

use crate::systems;

#[track_caller]
fn verdict(coordinates: &[&str], constraints: &[&str], q: &[f64]) -> Integrability {
    let (system, mut state) = systems::kinetic(coordinates, &[], constraints);
    state.q = q.to_vec();
    integrability(&system, &state, 3.0).unwrap_or_else(|e| panic!("{constraints:?}: {e}"))
}

#[track_caller]
fn has_growth(coordinates: &[&str], constraints: &[&str], q: &[f64], generic: &[usize], start: &[usize]) {
    let found = verdict(coordinates, constraints, q);
    let (generic, start) = (generic.to_vec(), start.to_vec());
    let exact = start == generic;
    let growth = Growth { domain: Domain::default(), generic, start, exact };
    let depth = growth.generic.len() - 1;
    assert_eq!(found, Integrability::Nonintegrable { depth, growth: Some(growth) }, "{found}");
}

/// Cartan 1910; Engel's and Goursat's normal forms; Kumpera & Ruiz 1982: of dimension five, at `x5 = 0`.
#[test]
fn normal_forms_have_their_published_growth_vectors() {
    let five = ["x1", "x2", "x3", "x4", "x5"];
    let goursat = ["x3' - x2*x1'", "x4' - x3*x1'", "x5' - x4*x1'"];
    has_growth(&five, &goursat, &[0.0; 5], &[2, 3, 4, 5], &[2, 3, 4, 5]);
    let kumpera_ruiz = ["x2' - x3*x1'", "x3' - x4*x1'", "x1' - x5*x4'"];
    has_growth(&five, &kumpera_ruiz, &[0.0; 5], &[2, 3, 4, 5], &[2, 3, 4, 4, 5]);
    has_growth(&five, &kumpera_ruiz, &[0.0, 0.0, 0.0, 0.0, 0.5], &[2, 3, 4, 5], &[2, 3, 4, 5]);
    let cartan = ["x3' - (x1*x2' - x2*x1')/2", "x4' - x1*(x1*x2' - x2*x1')/2", "x5' - x2*(x1*x2' - x2*x1')/2"];
    has_growth(&five, &cartan, &[0.0; 5], &[2, 3, 5], &[2, 3, 5]);
    has_growth(&["x", "y", "z", "w"], &["y' - z*x'", "z' - w*x'"], &[0.0; 4], &[2, 3, 4], &[2, 3, 4]);
}

/// Martinet 1970: singular where `x = 0`. Laumond 1993, Jean 1996: two trailers, the first at a right angle
/// to the tractor.
#[test]
fn singular_starts_need_more_brackets_than_almost_every_place() {
    let space = ["x", "y", "z"];
    has_growth(&space, &["z' - x^2*y'"], &[0.0; 3], &[2, 3], &[2, 2, 3]);
    has_growth(&space, &["z' - x^2*y'"], &[1.0, 0.0, 0.0], &[2, 3], &[2, 3]);
    has_growth(&space, &["z' - x^5*y'"], &[0.0; 3], &[2, 3], &[2, 2, 2, 2, 2, 3]);
    let trailers =
        ["y'*cos(a) - x'*sin(a)", "y'*cos(b) - x'*sin(b) - b'", "y'*cos(c) - x'*sin(c) - b'*cos(b - c) - c'"];
    let coordinates = ["x", "y", "a", "b", "c"];
    has_growth(&coordinates, &trailers, &[0.0, 0.0, 0.3, 0.1, 0.0], &[2, 3, 4, 5], &[2, 3, 4, 5]);
    has_growth(&coordinates, &trailers, &[0.0, 0.0, FRAC_PI_2, 0.0, 0.0], &[2, 3, 4, 5], &[2, 3, 4, 4, 5]);
    let words = verdict(&coordinates, &trailers, &[0.0, 0.0, FRAC_PI_2, 0.0, 0.0]).to_string();
    let end = "at almost every place, growth vector (2, 3, 4, 5); step 5 at this start, as far as round-off tells, (2, 3, 4, 4, 5)";
    assert!(words.ends_with(end), "{words}");
}

#[test]
fn brackets_are_those_on_the_branch_of_the_start() {
    // z is constant up to x = π/2, and x − asin(sin x) = 2 x − π from there on
    let turned = ["z' - (x - asin(sin(x)))*y'"];
    let found = verdict(&["x", "y", "z"], &turned, &[0.5, 0.2, 0.0]);
    assert!(matches!(found, Integrability::Undecided { .. }), "{found}");
    let found = verdict(&["x", "y", "z"], &turned, &[2.5, 0.2, 0.0]);
    assert!(matches!(found, Integrability::Nonintegrable { .. }), "{found}");
    let one_side = ["z' - (sqrt(x^2) - x)*y'"];
    let found = verdict(&["x", "y", "z"], &one_side, &[0.5, 0.2, 0.0]);
    assert!(!matches!(found, Integrability::Nonintegrable { .. }), "{found}");
    let found = verdict(&["x", "y", "z"], &one_side, &[-0.5, 0.2, 0.0]);
    assert!(found.to_string().contains("almost every place of the branch of this start"), "{found}");
}

/// On `w = 0`, and on `w = x y − 1/10`, what is left is `d/dt(z − x y) = 0`; on other leaves it is not.
#[test]
fn constraints_are_integrable_on_the_leaf_of_the_start() {
    for (g, rate) in [("w", "w'"), ("(w - x*y + 1/10)", "(w' - x'*y - x*y')")] {
        let q = [0.5, 0.2, 0.0, 0.0];
        let constraints = [rate.to_owned(), format!("z' - y*x' - x*y' + 3*{g}*y*x'")];
        let texts: Vec<&str> = constraints.iter().map(|text| &text[..]).collect();
        let (mut system, mut state) = systems::kinetic(&["x", "y", "z", "w"], &[], &texts);
        state.q = q.to_vec();
        let on_all = integrability(&system, &state, 3.0).expect("linear");
        assert!(matches!(on_all, Integrability::PartlyIntegrable { integrals: 1, .. }), "{on_all}");
        system.on_positions = vec![(0, system.expression(g).expect("a formula"))];
        let on_its_own = integrability(&system, &state, 3.0).expect("linear");
        assert_eq!(on_its_own, Integrability::Integrable { exact: true }, "{g}");
    }
}

/// A heading as a unit vector: the branch of the root is that of the start.
#[test]
fn a_unit_vector_is_an_angle() {
    for (c, s) in [(0.6, 0.8), (-0.6, 0.8), (0.8, -0.6), (0.0, 1.0)] {
        let (mut system, mut state) = systems::kinetic(&["x", "y", "c", "s"], &[], &["2*c*c' + 2*s*s'", "y'*c - x'*s"]);
        state.q = vec![0.0, 0.0, c, s];
        system.on_positions = vec![(0, system.expression("c^2 + s^2 - 1").expect("a formula"))];
        let found = integrability(&system, &state, 3.0).expect("linear");
        let partly = Integrability::PartlyIntegrable { integrals: 1, constraints: 2, exact: true };
        assert_eq!(found, partly, "{c}, {s}");
    }
}
