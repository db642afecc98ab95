//! Round-off of known size in motions that stop, begin late, or have constants; single and as members.

use motion::{Choice, Motion, Settings, VAKONOMIC, choices, solve_choice};
use scene::Scene;

use crate::support::{member, read};

const EPS: f64 = f64::EPSILON;

fn motion(scene: &Scene, choice: &Choice) -> Motion {
    solve_choice(scene, choice, &Settings::default()).expect("a motion")
}

/// `x' = 1/(1 − t)` stops at 1; `6·10⁷ (t/b)²⁰⁰` is added up to the rate of `z'`, which is 0 and rises at b.
#[test]
fn round_off_of_the_last_tenth_before_a_stop_does_not_count() {
    for (rise, doubted) in [(0.8, true), (0.95, false)] {
        let scene = read(
            "known",
            &format!(
                "title = \"stops\"\n[coordinates]\nx = {{ start = 0 }}\nz = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(x'^2 + z'^2)/2\"\n\
             forces = {{ x = \"x'^2\", z = \"6e7*(1 - cos(1e-14*z))*(t/{rise})^200\" }}\n[start.velocities]\n\
             \"x'\" = 1\n\"z'\" = 1\n[run]\nduration = 2\n"
            ),
        );
        let choice = &choices(&scene)[0];
        let single = motion(&scene, choice);
        assert!(!single.is_complete() && (single.end() - 1.0).abs() < 1e-3, "{:?}", single.ending);
        assert_eq!(single.doubt.is_some(), doubted, "{rise}: {:?}", single.doubt);
        let times: Vec<f64> = (1..=200).map(|i| 0.01 * f64::from(i)).collect();
        let member = member(&scene, choice, &times);
        assert_eq!(member.doubt.is_some(), doubted, "{rise}, as a member: {:?}", member.doubt);
    }
}

/// Heisenberg's vakonomic motion, and beside it `s' = 1`, to whose rate 1500 is added up.
#[test]
fn a_run_with_round_off_in_its_rates_has_the_start_and_the_constants_of_the_other() {
    let scene = read(
        "known",
        "title = \"turns\"\n[coordinates]\nx = { start = 0.5 }\ny = { start = 0 }\nz = { start = 0 }\ns = { start = 1 }\n\
         [system]\nlagrangian = \"(x'^2 + y'^2 + s'^2)/2\"\nconstraints = [\"z' - (x*y' - y*x')/2\"]\n\
         forces = { s = \"750 - 750*cos(1e-14*s)\" }\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 0\n\"s'\" = 1\n\
         [vakonomic]\nmultipliers = [0.75]\n[run]\nduration = 2\n",
    );
    let choice = choices(&scene).into_iter().find(|choice| choice.formulation == VAKONOMIC).expect("a choice");
    let mut motion = motion(&scene, &choice);
    let (kept, looser) = motion.at_in_both_runs(2.0).expect("the end");
    let apart = |i: usize| (kept.velocities[i] - looser.velocities[i]).abs();
    assert!((900.0..1516.0).contains(&(apart(3) / EPS)), "{} last digits", apart(3) / EPS);
    assert!(apart(0).max(apart(1)) < 1e-10, "{} {}", apart(0), apart(1));
    let digits = motion.difference_of_runs(0.0).expect("the start")[3].abs() / EPS;
    assert!((3.0..=5.0).contains(&digits), "{digits} last digits of 1 at the start");
}

/// A speed becomes 10⁻³ within the run, and is known to 10⁻⁹ of that, whenever the run begins.
#[test]
fn a_state_of_a_member_is_as_large_as_it_becomes_within_the_run() {
    for time in [0.0, 1000.0] {
        let scene = read(
            "known",
            &format!(
                "title = \"late\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2\"\n\
             forces = {{ x = \"1e10 + 1 - 1e10*cos(1e-14*x)\" }}\n[start]\ntime = {time:?}\n[start.velocities]\n\
             \"x'\" = 0\n[run]\nduration = 1e-3\n"
            ),
        );
        let member = member(&scene, &choices(&scene)[0], &[time + 0.5e-3, time + 1e-3]);
        assert!(member.doubt.is_some(), "{time}");
    }
}

/// `λ = 1 − x'`, which is 0, of an `x'` to which 200 was added up within the run: too little to be put in.
#[test]
fn round_off_of_a_multiplier_is_that_of_its_instant() {
    let scene = read(
        "known",
        "title = \"held\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
         lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\n\
         forces = { x = \"50 - 50*cos(1e-14*x)\", y = \"x' - 1\" }\n[start.velocities]\n\"x'\" = 1\n\
         [run]\nduration = 2\n",
    );
    let member = member(&scene, &choices(&scene)[0], &[0.5, 1.0, 1.5, 2.0]);
    let found = member.estimate.expect("asked for").multipliers[0] / EPS;
    assert!((1.0..20.0).contains(&found), "{found} last digits of 1");
}
