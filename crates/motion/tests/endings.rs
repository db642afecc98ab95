//! Why a motion stops: the guard that is nearly zero and the unknowns that are lost are named, and no others.

use motion::{Ending, Settings, choices, solve_choice};
use scene::Scene;

/// Why the motion of a particle ends by this formulation.
fn cause(formulation: &str, system: &str, [x, y, z]: [f64; 3]) -> String {
    let multipliers = if system.contains("constraints") { "[vakonomic]\nmultipliers = [0.1]\n" } else { "" };
    let text = format!(
        "title = \"ending\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 1 }}\nz = {{ start = 0 }}\n[system]\n\
         {system}\n[start]\nvelocities = {{ \"x'\" = {x:?}, \"y'\" = {y:?}, \"z'\" = {z:?} }}\n\
         {multipliers}[run]\nduration = 3\n"
    );
    let scene = Scene::parse("ending", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
    let choice = choices(&scene).into_iter().find(|c| c.formulation.name == formulation).expect("it is there");
    match solve_choice(&scene, &choice, &Settings::default()).expect("a motion").ending {
        Ending::Stopped { cause, .. } => cause,
        Ending::Completed => panic!("{formulation}, {system}: completed"),
    }
}

/// ∂f/∂v vanishes at the tip of a cone, and a divisor of the constraint is far from that.
#[test]
fn of_a_divisor_and_a_rank_the_one_that_is_lost_is_named() {
    let system = "lagrangian = \"(x'^2 + y'^2 + z'^2)/2 - z\"\nconstraints = [\"(x'^2 - z'^2/4)/(5 + y)\"]";
    let cause = cause("vakonomic", system, [0.5, 0.0, 1.0]);
    assert!(cause.starts_with("constraint 1 says nothing of the velocities at x = 1.31, y = 1, z = 0.625"), "{cause}");
}

/// A mass that vanishes with its coordinate, beside one that is coupled to it.
#[test]
fn the_unknown_that_is_lost_is_named() {
    for (lost, kinetic) in [("x", "x*x'^2 + 0.5*x*x'*y' + y'^2"), ("y", "x'^2 + 0.5*y*x'*y' + y*y'^2")] {
        let cause = cause("chetaev", &format!("lagrangian = \"({kinetic} + z'^2)/2 - {lost}\""), [0.0; 3]);
        assert!(cause.contains(&format!("the equations for {lost}'' are nearly dependent")), "{cause}");
    }
}

#[test]
fn a_run_that_stops_much_earlier_is_where_the_motion_stops() {
    let stopped = |t: f64| Ending::Stopped { t, cause: "a wall".into() };
    for [start, end] in [[1.0, 11.0], [1.0, -9.0]] {
        let at = |past: f64| start + past * (end - start);
        let joint = |kept: Ending, looser: Ending| Ending::joint(kept, looser, [start, end]);
        let unconfirmed = Ending::unconfirmed(at(0.4), "a wall");
        assert_eq!(joint(Ending::Completed, stopped(at(0.4))), unconfirmed);
        assert_eq!(joint(stopped(at(0.5)), stopped(at(0.4))), unconfirmed);
        // near the same singularity, or behind it
        assert_eq!(joint(stopped(at(0.5)), stopped(at(0.4999))), stopped(at(0.5)));
        assert_eq!(joint(stopped(at(0.4)), stopped(at(0.5))), stopped(at(0.4)));
        assert_eq!(joint(stopped(at(0.4)), Ending::Completed), stopped(at(0.4)));
    }
}
