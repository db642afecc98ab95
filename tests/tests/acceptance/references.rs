//! Every formulation against reference states from code that shares nothing with the solvers.

use crate::references::{Motion, REFERENCES, Reference};
use mechanics::ConstantsRule;
use motion::{CHETAEV, REMOVED_CONSTRAINT, SolveError, VAKONOMIC, setting, solve};

use super::support::{at, equations, largest_difference, must, scene, tight};

/// The constants of a removed-constraint reference, in the order of the removal's memory variables.
fn costates(scene: &scene::Scene, named: &[(&str, f64)]) -> Vec<f64> {
    let value = |w: &mechanics::MemoryVariable| {
        let name = scene.system.graph.name(w.symbol);
        named.iter().find(|(n, _)| *n == name).map_or(0.0, |(_, x)| *x)
    };
    scene.removals[0].memory.iter().map(value).collect()
}

/// The names of the formulation and of the constants, and the motion itself.
fn motion(reference: &Reference, scene: &scene::Scene, natural: bool) -> Result<motion::Motion, SolveError> {
    let (name, removal, rule) = match &reference.motion {
        Motion::Chetaev => (CHETAEV, None, ConstantsRule::Zero),
        Motion::Vakonomic { multipliers } => (VAKONOMIC, None, ConstantsRule::Given(multipliers.to_vec())),
        Motion::Removed { horizon: Some(horizon), .. } if natural => {
            (REMOVED_CONSTRAINT, scene.removals.first(), ConstantsRule::Natural { horizon: *horizon })
        }
        Motion::Removed { costates: named, .. } => {
            (REMOVED_CONSTRAINT, scene.removals.first(), ConstantsRule::Given(costates(scene, named)))
        }
    };
    solve(setting(scene), equations(&scene.system, name, removal), &rule, &tight())
}

/// Largest relative error over coordinates, velocities and, where they have the same meaning, multipliers.
fn error(reference: &Reference, motion: &mut motion::Motion) -> f64 {
    let now = at(motion, reference.t);
    let size = reference.q.iter().chain(&reference.v).fold(1.0_f64, |a, x| a.max(x.abs()));
    let state =
        largest_difference(&now.coordinates, &reference.q).max(largest_difference(&now.velocities, &reference.v));
    let multipliers = match reference.motion {
        Motion::Removed { .. } => 0.0,
        _ => largest_difference(&now.multipliers, &reference.multipliers),
    };
    let largest = reference.multipliers.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
    (state / size).max(multipliers / largest)
}

fn is_quadrature(scene: &scene::Scene, reference: &Reference) -> bool {
    // a constant for gamma, which neither L nor a rate contains
    let Motion::Removed { costates, .. } = &reference.motion else { return false };
    scene.name == "ball-in-cone" && costates.iter().any(|(name, x)| *name == "gamma" && *x != 0.0)
}

#[test]
fn every_reference_state_is_met() {
    let mut met = 0;
    for reference in REFERENCES.iter() {
        let mut scene = scene(reference.scene, &[]);
        scene.duration = reference.t;
        let what = format!("{}, {:?}, t = {}", reference.scene, reference.motion, reference.t);
        let outcome = motion(reference, &scene, false);
        if is_quadrature(&scene, reference) {
            let refusal = outcome.err().map(|e| e.to_string());
            println!("{what}: refused: {refusal:?}");
            assert!(refusal.is_some_and(|e| e.contains("free constants")), "{what}");
            continue;
        }
        let mut motion = outcome.unwrap_or_else(|e| panic!("{what}: {e}"));
        // a hundredfold of what rounding the start does, but no less than 1e-11
        must(&what, error(reference, &mut motion), (100.0 * reference.rounding).max(1e-11));
        met += 1;
    }
    assert!(met >= 24, "only {met} reference states were met");
}

#[test]
fn natural_constants_are_found_from_the_horizon() {
    let mut found = 0;
    for reference in REFERENCES.iter() {
        let Motion::Removed { costates: named, horizon: Some(horizon) } = &reference.motion else { continue };
        let mut scene = scene(reference.scene, &[]);
        scene.duration = reference.t;
        let what = format!("{}, P = 0 at {horizon} s, t = {}", reference.scene, reference.t);
        let mut motion = motion(reference, &scene, true).unwrap_or_else(|e| panic!("{what}: {e}"));
        let expected: Vec<f64> = costates(&scene, named).into_iter().filter(|c| *c != 0.0).collect();
        must(&format!("{what}: P(t₀)"), largest_difference(&motion.constants, &expected) / expected[0].abs(), 1e-8);
        must(&format!("{what}: state"), error(reference, &mut motion), 1e-8);
        found += 1;
    }
    assert!(found >= 4, "only {found} references with a horizon");
}
