//! Systems that nobody chose.

use random::{Case, Kind, draw};
use referees::discrete::Discrete;

use super::support::{Tally, agrees, measure, removed, short};
use proptest::strategy::ValueTree;

/// The seed of the systems; none of the other suites has it.
const SEED: u64 = 1788;

/// Systems, as many of each kind.
const SYSTEMS: u64 = 40;

/// What the extrapolated motion may differ by, besides what the case knows its own round-off to be.
const LIMIT: f64 = 1e-10;

#[test]
fn discrete_motions_tend_to_continuous_ones_on_random_systems() {
    let (mut chetaev, mut vakonomic, mut removals) = (Tally::default(), Tally::default(), Tally::default());
    for index in 0..SYSTEMS {
        let recipe = draw(SEED, index, &Kind::ALL).current();
        let name = format!("random {index}, {}", recipe.kind);
        let mut case = Case::new(recipe, &name).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (system, start) = (case.scene.system.clone(), case.scene.start.clone());
        let limit = LIMIT.max(100.0 * case.floor);
        let found = measure(&name, Discrete::chetaev(&system, &start, short(&case.chetaev)), &mut case.chetaev);
        agrees(&format!("{name}, Chetaev"), &found, limit, &mut chetaev);
        let discrete = Discrete::vakonomic(&system, &start, &case.scene.multipliers, short(&case.vakonomic));
        let found = measure(&name, discrete, &mut case.vakonomic);
        agrees(&format!("{name}, vakonomic"), &found, limit, &mut vakonomic);
        for r in &mut case.removed {
            let what = format!("{name}, {}", r.removal.name);
            let discrete = removed(&system, &r.removal, &start, &r.costates, short(&r.motion));
            let discrete = discrete.unwrap_or_else(|| panic!("{what}: not of first order"));
            agrees(&what, &measure(&what, discrete, &mut r.motion), limit, &mut removals);
        }
    }
    chetaev.say("Chetaev, random systems");
    vakonomic.say("vakonomic, random systems");
    removals.say("removed constraint, random systems");
    assert!(chetaev.measured() >= 36 && vakonomic.measured() >= 36 && removals.measured() >= 60);
}
