//! What is known from the literature, and what the program says: `LITERATURE=all` for all of it.

use std::collections::BTreeSet;

use integrals::{Integrals, Measure};
use mechanics::Watched;
use motion::{CHETAEV, Choice, VAKONOMIC, default_constants};
use validation::integrals::literature;

/// Entries whose answer takes a second or less.
const QUICK: [&str; 12] = [
    "sleigh",
    "suslov",
    "suslov-principal",
    "veselova",
    "suslov-kharlamova",
    "suslov-klebsh-tisserand",
    "heisenberg-skew",
    "roller-racer",
    "turntable",
    "ball-with-gyrostat",
    "two-wheeled-carriage-balanced",
    "ellipsoid-three-axes",
];

#[test]
fn nothing_contradicts_the_literature() {
    let all = std::env::var("LITERATURE").is_ok_and(|word| word == "all");
    let entries = literature().unwrap_or_else(|e| panic!("{e:#}"));
    let names: BTreeSet<&str> = entries.iter().map(|entry| &entry.name[..]).collect();
    assert!(names.len() == entries.len() && QUICK.iter().all(|name| names.contains(name)));
    let (mut agree, mut open) = (0, 0);
    for entry in entries.iter().filter(|entry| all || QUICK.contains(&&entry.name[..])) {
        let (found, agrees) = entry.compared().unwrap_or_else(|e| panic!("{}: {e:#}", entry.name));
        println!("{}: {:?} {agrees:?}", entry.name, found.measure);
        assert_ne!(agrees, Some(false), "{}: {found:?}", entry.name);
        // what the table calls open is open, and nothing else
        assert_eq!(agrees.is_none(), entry.measure == "open", "{}: {found:?}", entry.name);
        assert_eq!(matches!(found.measure, Measure::Open(_)), agrees.is_none());
        agree += usize::from(agrees == Some(true));
        open += usize::from(agrees.is_none());
    }
    println!("{agree} agree, {open} open");
    assert!(agree > 8 && open > 1);
}

/// T6 and T7 on random systems, and what the ansatz writes down about both formulations, along their motions.
/// `INTEGRALS=200` takes as many systems.
#[test]
fn integrals_of_random_systems_are_constant_along_motions() {
    let count = std::env::var("INTEGRALS").map_or(6, |count| count.parse().expect("a number of systems"));
    let (mut tried, mut energies, mut momenta) = (0, 0, 0);
    for index in 0..count {
        let recipe = random::draw_recipe(71, index, &random::Kind::ALL);
        let scene = recipe.scene(&format!("random-{index}"));
        let is_closed = scene.system.is_autonomous() && !scene.system.has_forces();
        for formulation in [CHETAEV, VAKONOMIC] {
            let has_energy = is_closed && (recipe.is_homogeneous() || formulation.name == VAKONOMIC.name);
            let mut scene = scene.clone();
            if has_energy && formulation.name == CHETAEV.name {
                let expression = scene.system.energy();
                scene.system.watched.push(Watched {
                    name: "energy".into(),
                    expression,
                    constancy: mechanics::Constancy::Certain,
                });
            }
            let system = &scene.system;
            let constants = default_constants(formulation, &scene);
            let choice = Choice { label: formulation.title.into(), formulation, removal: None, constants };
            let found = Integrals::find(&scene, &choice, 2, &[]).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
            let (Ok(ansatz), Ok(drifts)) = (&found.ansatz, &found.drifts) else {
                println!("{} {}: {:?} {:?}", scene.name, formulation.name, found.ansatz.as_ref().err(), found.drifts);
                continue;
            };
            for (integral, drift) in ansatz.printed.iter().zip(drifts) {
                let drift = drift.of_terms();
                assert!(drift < 1e-9, "{} {}: {} drifts by {drift:.1e}", scene.name, formulation.name, integral.text);
                tried += 1;
            }
            let words = || format!("{} {}: {found}", scene.name, formulation.name);
            if has_energy {
                // Chetaev's of L by its rates, the vakonomic one by what is printed
                let by_rates = matches!(&found.invariants, Ok(own) if own.iter().all(|(_, held)| *held));
                assert!(by_rates && (ansatz.dimension > 0 || ansatz.unprinted > 0), "{}", words());
                energies += 1;
            }
            let written = system.written();
            let is_cyclic = |q: &symbolic::Symbol| written.iter().all(|&e| !system.graph.depends_on(e, *q));
            let cyclic = system.positions().iter().filter(|q| is_cyclic(q)).count();
            if formulation.name == VAKONOMIC.name && !system.has_forces() {
                assert!(ansatz.dimension >= cyclic, "{}", words());
                momenta += cyclic;
            }
        }
    }
    println!("{tried} integrals, {energies} energies, {momenta} momenta");
    assert!(tried > count as usize && energies > 0 && momenta > 0);
}
