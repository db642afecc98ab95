//! What is known from the literature, of integrals in an ansatz.

use equations::Derivation;
use integrals::{Ansatz, ansatz};

use crate::questions::{built_in, start};

fn asked(name: &str, overrides: &[(&str, &str)], degree: usize, names: &[&str]) -> Ansatz {
    let scene = built_in(name, overrides);
    let equations = chetaev::derive(&scene.system, &Derivation::default()).expect("equations");
    let names: Vec<String> = names.iter().map(|&name| name.into()).collect();
    ansatz(&scene.system, &equations, &start(&scene), degree, &names).unwrap_or_else(|open| panic!("{name}: {open}"))
}

/// Texts of what is printed of a scene, and how many combinations are constant in all.
fn printed(name: &str, degree: usize, names: &[&str]) -> (Vec<String>, usize, Ansatz) {
    let found = asked(name, &[], degree, names);
    assert_eq!(found.unprinted, 0, "{name}");
    (found.printed.iter().map(|p| p.text.clone()).collect(), found.dimension, found)
}

#[test]
fn the_sleigh_has_its_energy_and_nothing_else() {
    let (texts, dimension, found) = printed("sleigh", 2, &[]);
    assert_eq!((texts.len(), dimension), (1, 1), "{texts:?}");
    assert!(found.printed[0].is_energy);
}

/// Neimark & Fufaev 1972: the velocity turns about a centre that stays, `v = (2/7) Ω e_z × (r − c)`. Fassò
/// and Sansonetto 2016: the energy is not constant, but less `Ω` times an angular momentum.
#[test]
fn the_ball_on_a_turning_table_has_its_circle_its_spin_and_a_moving_energy() {
    let (texts, dimension, found) = printed("turntable", 2, &[]);
    assert_eq!(texts[..3], ["x' + 0.2*y", "y' - 0.2*x", "psi' + phi'*cos(theta)"]);
    let moving: Vec<bool> = found.printed.iter().map(|p| p.is_moving_energy).collect();
    assert_eq!((moving, dimension), (vec![false, false, false, true], 5));
    assert!(texts[3].ends_with("- 0.7*x*y' + 0.7*x'*y"), "{}", texts[3]);
}

/// Jellett: `K·r` with the vector `r` from the centre of the sphere to the contact.
#[test]
fn rolling_bodies_have_their_integrals() {
    let (texts, _, _) = printed("routh-sphere", 1, &["theta"]);
    assert_eq!(texts.len(), 1, "{texts:?}");
    assert!(texts[0].starts_with("psi'*cos(theta)^2 + "), "{texts:?}");
    let (texts, _, _) = printed("chaplygin-sphere", 1, &[]);
    let vertical = "I1*(psi'*sin(theta)*sin(phi) + theta'*cos(phi))*sin(theta)*sin(phi) + I2*(psi'*sin(theta)*cos(phi) \
                    - theta'*sin(phi))*sin(theta)*cos(phi) + I3*(psi'*cos(theta) + phi')*cos(theta)";
    assert_eq!(texts, [vertical]);
    let (texts, _, _) = printed("snakeboard", 1, &[]);
    assert_eq!(texts, ["theta' + psi'", "phi'"]);
}
