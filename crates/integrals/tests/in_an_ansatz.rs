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

/// Routh: `ω₃² (I₁ I₃ + m r·I r)` with the spin `ω₃` about the axis and `r` to the contact is constant; what
/// is printed is made of it, of Jellett's integral squared and of the energy.
#[test]
fn the_square_of_rouths_second_integral_is_printed() {
    let found = asked("routh-sphere", &[], 2, &["theta"]);
    assert_eq!((found.printed.len(), found.dimension, found.unprinted), (3, 4, 0));
    let system = built_in("routh-sphere", &[]).system;
    let g = &system.graph;
    let read = |text: &str| system.expression(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    // the contact is a cos(theta) + e from the mass centre along the axis, a sin(theta) across it
    let spin = "phi' + psi'*cos(theta)";
    let routh = format!("({spin})^2*(I1*I3 + m*(I1*(a*sin(theta))^2 + I3*(a*cos(theta) + e)^2))");
    let energy = found.printed.iter().find(|p| p.is_energy).expect("the energy");
    let mut others = found.printed.iter().filter(|p| !p.is_energy);
    let (jellett, last) = (others.next().expect("linear"), others.next().expect("quadratic"));
    let columns = [read(&routh), read(&format!("({})^2", jellett.text)), read(&energy.text), g.one(), read(&last.text)];
    // on random states with the constraints they are dependent
    let mut random = symbolic::SplitMix::new(5);
    let mut rows: Vec<f64> = Vec::new();
    for _ in 0..40 {
        let mut values = system.parameter_values();
        for symbol in system.positions().into_iter().chain(system.velocities()) {
            values.insert(symbol, random.unit());
        }
        // x' - a*wy = 0 and y' + a*wx = 0
        for (&f, v) in system.constraints.iter().zip(system.velocities()) {
            let now = g.evaluate(f, &values).expect("a number");
            *values.get_mut(&v).expect("a velocity") -= now;
        }
        rows.extend(columns.iter().map(|&e| g.evaluate(e, &values).expect("a number")));
    }
    let svd = nalgebra::DMatrix::from_row_slice(40, 5, &rows).svd(false, false).singular_values;
    assert!(svd[4] < 1e-12 * svd[0] && svd[3] > 1e-5 * svd[0], "{svd}");
}

/// The vakonomic motion is Hamiltonian: cyclic coordinates have momenta `∂L/∂v + μ ∂f/∂v`, Chetaev's sleigh
/// none.
#[test]
fn vakonomic_motions_have_momenta_with_multipliers() {
    let scene = built_in("sleigh", &[]);
    let equations = vakonomic::derive(&scene.system, &Derivation::default()).expect("equations");
    let found = ansatz(&scene.system, &equations, &start(&scene), 2, &[]).unwrap_or_else(|open| panic!("{open}"));
    let texts: Vec<&str> = found.printed.iter().map(|p| &p.text[..]).collect();
    assert_eq!(texts[..2], ["y' + 0.4*phi'*cos(phi) + mu_1*cos(phi)", "0.4*phi'*sin(phi) - x' + mu_1*sin(phi)"]);
    assert!(found.printed[2].is_energy && texts.len() == 3, "{texts:?}");
}
