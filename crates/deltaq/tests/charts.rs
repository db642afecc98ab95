//! Changes of charts, with invariants of the user's own.

use deltaq::{Choice, Motion, Settings, solve_choice};
use mechanics::{ConstantsRule, Removal};
use scene::Scene;

/// A sleigh that turns past heading 90°, where its pivot vanishes, with these invariants.
fn sleigh(invariants: &str) -> Motion {
    let text = format!(
        "title = \"sleigh\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n\
         phi = {{ start = 0.3 }}\n[system]\n\
         lagrangian = \"((x' - 0.2*phi'*sin(phi))^2 + (y' + 0.2*phi'*cos(phi))^2 + phi'^2)/2 + 0.3*x\"\n\
         constraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n{invariants}\n\
         [start]\nvelocities = {{ \"x'\" = 0.6, \"phi'\" = 1.1 }}\n[run]\nduration = 4\n"
    );
    let scene = Scene::parse("sleigh", &text).unwrap_or_else(|error| panic!("{error}"));
    let removal = Some(Removal::by_coordinates(&scene.system, &scene.start).expect("linear"));
    let constants = ConstantsRule::Given(vec![0.02]);
    let choice = Choice { label: "removed".into(), formulation: "removed-constraint", removal, constants };
    solve_choice(&scene, &choice, &Settings::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn invariants_of_the_users_own_neither_move_nor_stop_a_motion() {
    let mut plain = sleigh("");
    assert!(plain.is_complete() && plain.charts.len() == 1, "{:?}", plain.ending);
    let end = plain.at(4.0).expect("it is there").coordinates;
    for invariants in
        ["turning = \"phi'\"", "\"momentum x\" = \"phi'\"", "\"momentum phi\" = \"x'\"", "energy = \"x'\""]
    {
        let mut motion = sleigh(&format!("[invariants]\n{invariants}"));
        assert!(motion.is_complete() && motion.charts.len() == 1, "{invariants}: {:?}", motion.ending);
        let here = motion.at(4.0).expect("it is there");
        let apart = here.coordinates.iter().zip(&end).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
        assert!(apart < 1e-9, "{invariants}: {apart:e}");
        // what it lists is what was asked for, in either chart
        let expected = if invariants.ends_with("\"x'\"") { here.velocities[0] } else { here.velocities[2] };
        let last = here.invariants.last().expect("the user's own");
        assert!((last - expected).abs() < 1e-9, "{invariants}: {last} instead of {expected}");
    }
}
