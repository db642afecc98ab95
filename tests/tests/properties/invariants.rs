//! Invariants that equations list: all of them are constant, and none is missing.

use motion::{CERTAINTY, Motion, Setting};
use proptest::test_runner::TestCaseError;
use random::realization::{Realization, realize};
use random::{Case, Kind, Recipe, Which, recipes_of};

use super::support::for_all;

/// Instants at which invariants are looked at.
const INSTANTS: usize = 12;

/// Round-off relative to the size of an invariant and its terms.
const ROUND_OFF: f64 = 1e-12;

/// The first listed invariant that changes by more than the errors explain.
fn drifting(motion: &mut Motion) -> Option<String> {
    let names: Vec<String> = motion.equations.invariants.iter().map(|i| i.name.clone()).collect();
    let start = motion.at(motion.start()).expect("readable").invariants;
    let (mut change, mut error, mut size) = (vec![0.0_f64; names.len()], vec![0.0_f64; names.len()], 1.0_f64);
    for t in motion.grid(INSTANTS) {
        let (kept, looser) = motion.at_in_both_runs(t).expect("readable");
        size = size.max(kept.velocities.iter().map(|v| v * v).sum());
        for i in 0..names.len() {
            change[i] = change[i].max((kept.invariants[i] - start[i]).abs());
            error[i] = error[i].max((kept.invariants[i] - looser.invariants[i]).abs());
        }
    }
    (0..names.len())
        .find(|&i| change[i] > CERTAINTY * error[i] + ROUND_OFF * (size + start[i].abs()))
        .map(|i| format!("{}: {} changes by {:.2e}", motion.equations.formulation, names[i], change[i]))
}

fn listed(motion: &Motion) -> Vec<&str> {
    motion.equations.invariants.iter().map(|i| i.name.as_str()).collect()
}

#[test]
fn listed_invariants_are_constant_and_none_is_missing() {
    for_all(96, &recipes_of(&Kind::ALL), |recipe: Recipe| {
        let mut case = Case::new(recipe, "random").map_err(|e| TestCaseError::fail(e.to_string()))?;
        let removed: Vec<Which> = (0..case.removed.len()).map(Which::Removed).collect();
        for which in [Which::Chetaev, Which::Vakonomic].into_iter().chain(removed) {
            if let Some(words) = drifting(case.motion(which)) {
                return Err(TestCaseError::fail(format!("{words}\n{}", case.scene.to_toml())));
            }
        }
        let system = &case.scene.system;
        let g = &system.graph;
        let missing = |motion: &Motion, name: &str| {
            let found = listed(motion).contains(&name);
            if found {
                Ok(())
            } else {
                Err(TestCaseError::fail(format!("{name} is not listed\n{}", case.scene.to_toml())))
            }
        };
        if system.is_autonomous() && !system.has_forces() {
            missing(&case.vakonomic, "energy")?;
            for r in &case.removed {
                missing(&r.motion, "energy")?;
            }
            if case.recipe.is_homogeneous() {
                missing(&case.chetaev, "energy")?;
            }
        }
        for (c, &force) in system.coordinates.iter().zip(&system.forces) {
            if !g.is_zero(force) {
                continue;
            }
            let occurs = |e| g.depends_on(e, c.position);
            let acted_on = system.constraints.iter().any(|&f| g.depends_on(f, c.velocity));
            if !occurs(system.lagrangian) && !system.constraints.iter().any(|&f| occurs(f)) {
                missing(&case.vakonomic, &format!("momentum {}", c.name))?;
            }
            if !occurs(system.lagrangian) && !acted_on {
                missing(&case.chetaev, &format!("momentum {}", c.name))?;
            }
        }
        // a parameter that is no coordinate of the system is in neither L nor B, but forces act along it
        for r in case.removed.iter().filter(|_| !system.has_forces()) {
            for u in r.removal.parameters.iter().filter(|u| u.coordinate.is_none()) {
                missing(&r.motion, &format!("momentum {}", g.name(u.symbol)))?;
            }
        }
        Ok(())
    });
}

#[test]
fn nothing_is_called_constant_that_friction_eats() {
    let mut acted_on = 0;
    for_all(24, &recipes_of(&[Kind::Linear, Kind::Integrable, Kind::Affine]), |recipe: Recipe| {
        let case = Case::new(recipe, "random").map_err(|e| TestCaseError::fail(e.to_string()))?;
        let setting = Setting { system: &case.scene.system, start: &case.scene.start, end: case.end() };
        let mut motion =
            realize(Realization::Friction, 10.0, setting, &[]).map_err(|e| TestCaseError::fail(e.to_string()))?;
        match drifting(&mut motion) {
            Some(words) => Err(TestCaseError::fail(format!("with friction, {words}\n{}", case.scene.to_toml()))),
            None => Ok(()),
        }
    });
    // and the friction is not nothing: energy would drift
    for index in 0..10 {
        let case = Case::new(random::draw_recipe(5, index, &[Kind::Affine]), "random").expect("a case");
        let setting = Setting { system: &case.scene.system, start: &case.scene.start, end: case.end() };
        let mut motion = realize(Realization::Friction, 10.0, setting, &[]).expect("a motion");
        let mut free = realize(Realization::Friction, 0.0, setting, &[]).expect("a motion");
        let end = case.end();
        let ways = [&mut motion, &mut free].map(|m| m.at(end).expect("readable").coordinates);
        acted_on += usize::from(ways[0].iter().zip(&ways[1]).any(|(a, b)| (a - b).abs() > 1e-3));
    }
    assert!(acted_on >= 8, "friction acts on {acted_on} of 10 systems only");
}
