//! One operation of a derivation goes wrong: answers about integrals notice, and the command ends with 4.

use std::panic::{AssertUnwindSafe, catch_unwind};

use integrals::{Integrals, NoAnswer};
use motion::choices;
use program::exit_code;
use scene::Scene;
use symbolic::faults::{chances, spoiled};

const SLEIGH: &str = r#"
title = "Sleigh on an incline"
[coordinates]
x = { start = 0 }
y = { start = 0 }
phi = { start = 0.3 }
[system]
lagrangian = "(x'^2 + y'^2)/2 + phi'^2/8 + x/2"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[invariants]
energy = "(x'^2 + y'^2)/2 + phi'^2/8 - x/2"
spin = "phi'"
[start.velocities]
"x'" = 0.6
"phi'" = 0.5
[run]
duration = 1
"#;

/// One chance of so many is tried.
const EACH: usize = 13;

#[test]
fn a_fault_in_a_derivation_ends_with_4() {
    let scene = Scene::parse("sleigh", SLEIGH).unwrap_or_else(|fault| panic!("{fault}"));
    let choice = choices(&scene).swap_remove(0);
    let find = || Integrals::find(&scene, &choice, 1, &[]);
    let (sound, all) = chances(find);
    let sound = sound.unwrap_or_else(|fault| panic!("{fault}")).to_string();
    assert!(sound.contains("`energy` of the scene: constant") && sound.contains("`spin` of the scene: constant"));
    let (mut noticed, mut tried) = (0, 0);
    for which in (0..all.len()).step_by(EACH) {
        tried += 1;
        // a fault may break off the work
        let Ok(found) = catch_unwind(AssertUnwindSafe(|| spoiled(which, all.len(), find))) else { continue };
        if let Err(fault @ NoAnswer::Contradicted(_)) = found {
            let NoAnswer::Contradicted(contradicted) = fault else { continue };
            assert_eq!(exit_code(&contradicted.into()), 4);
            noticed += 1;
        }
    }
    println!("{noticed} of {tried} faults of {} are contradictions", all.len());
    assert!(noticed > 0, "none of {tried}");
}
