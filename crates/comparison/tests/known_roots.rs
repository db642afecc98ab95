//! Members whose equations of the instant have several roots: `p = v³ − v`, from v = 1.05 to about 3.

use motion::{Settings, VAKONOMIC_COSTATE, error_estimate, setting, solve_choice};
use scene::Scene;

use crate::support::{choice, member, read};

/// `p' = 12`, where `2 half` is added up to it.
fn scene(half: f64) -> Scene {
    let text = format!(
        "title = \"roots\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"x'^4/4 - x'^2/2 + y'^2/2\"\nconstraints = [\"y'\"]\n\
         forces = {{ x = \"12 + {half:?} - {half:?}*cos(1e-14*x)\" }}\n[start.velocities]\n\"x'\" = 1.05\n\
         [run]\nduration = 2\n"
    );
    read("roots", &text)
}

#[test]
fn members_are_read_off_on_the_root_of_their_motion() {
    let times = [0.5, 1.0, 1.5, 2.0];
    let scene = scene(0.0);
    let member = member(&scene, &choice(&scene, VAKONOMIC_COSTATE), &times);
    for (t, outputs) in times.into_iter().zip(member.outputs) {
        let (v, p) = (outputs.velocities[0], 1.05_f64.powi(3) - 1.05 + 12.0 * t);
        assert!(v > 1.0 && (v.powi(3) - v - p).abs() < 1e-9 * p, "{t}: {v}");
    }
}

/// Half a last digit of `2·10⁵` is put into the rate of `p`, and as much as a part of it: within a time of 2
/// both come to `4·10⁵ ε`, single and as a member, whichever instant was read off before. The velocity `v` is
/// off by that over `3v² − 1`.
#[test]
fn round_off_is_told_on_the_root_of_the_motion() {
    let scene = scene(1e5);
    let known = 4e5 * f64::EPSILON;
    let choice = choice(&scene, VAKONOMIC_COSTATE);
    let member = member(&scene, &choice, &[0.5, 1.0, 1.5, 2.0]);
    let apart = member.run.differences.last().expect("the end");
    let largest = apart.iter().fold(0.0_f64, |a, d| a.max(d.abs()));
    assert!((0.6 * known..1.1 * known).contains(&largest), "{apart:?}, {known:e}");
    let mut motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
    let (kept, looser) = motion.at_in_both_runs(2.0).expect("the end");
    let v = kept.velocities[0];
    let found = (v - looser.velocities[0]).abs() * (3.0 * v * v - 1.0);
    assert!((0.6 * known..1.1 * known).contains(&found), "{found:e}, {known:e}");
}

/// A factor of the constraint is another unit of its multiplier: between the ends of its one step the motion
/// is read off all the same.
#[test]
fn a_factor_of_the_constraint_ends_no_motion() {
    let f = "z'^2 - a^2*(x'^2 + y'^2)";
    for factor in ["1", "3", "-7", "0.1"] {
        let text = include_str!("../../scene/scenes/appell-hamel.toml");
        let scene = read("appell-hamel", &text.replace(f, &format!("{factor}*({f})")));
        let mut motion =
            solve_choice(&scene, &choice(&scene, VAKONOMIC_COSTATE), &Settings::default()).expect("a motion");
        error_estimate(&mut motion, setting(&scene)).expect("the start");
        assert!(motion.is_complete(), "{factor}: {:?}", motion.ending);
    }
}
