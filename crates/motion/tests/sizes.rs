//! Sizes of states.

use equations::Compiled;
use motion::parts::{sizes, unbounded_sizes};
use motion::{
    Breach, CHETAEV, Metric, REMOVED_CONSTRAINT, Settings, VAKONOMIC_COSTATE, choices, derive_at, solve_choice,
};
use scene::Scene;

/// A free particle goes `v T` far; its size by which it is integrated is at most 1.
#[test]
fn large_states_have_their_size_where_it_is_unbounded() {
    for (speed, bounded) in [(3e-7, 3e-7), (0.25, 0.25), (5e8, 5e3)] {
        let text = format!(
            "title = \"free\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2\"\n\
             [start.velocities]\n\"x'\" = {speed:?}\n[run]\nduration = 2\n"
        );
        let scene = Scene::parse("free", &text).unwrap_or_else(|e| panic!("{e}"));
        let equations = derive_at(&scene.system, &scene.start, &choices(&scene)[0]).expect("equations");
        let mut compiled = Compiled::new(&equations).expect("compiled");
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let whole = unbounded_sizes(&mut compiled, &mut metric, 0.0, &[0.0, speed], 2.0);
        assert_eq!(whole, [2.0 * speed, speed]);
        let least = sizes(&mut compiled, &mut metric, 0.0, &[0.0, speed], 2.0);
        assert!((least[1] / bounded - 1.0).abs() < 1e-9, "{speed:e}: {least:?}");
    }
}

/// `P' = x` with x from 0 to `v T`: a costate that starts at zero has the size `v T²` that x makes of it.
#[test]
fn what_another_state_drives_has_the_size_that_it_makes_of_it() {
    for speed in [1e-4, 0.1] {
        let text = format!(
            "title = \"held\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2)/2 - x*y\"\nconstraints = [\"y'\"]\n[start.velocities]\n\
             \"x'\" = {speed:?}\n[run]\nduration = 2\n"
        );
        let scene = Scene::parse("held", &text).unwrap_or_else(|e| panic!("{e}"));
        let choice = choices(&scene).into_iter().find(|choice| choice.formulation == REMOVED_CONSTRAINT);
        let equations = derive_at(&scene.system, &scene.start, &choice.expect("a choice")).expect("equations");
        let mut compiled = Compiled::new(&equations).expect("compiled");
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let names: Vec<String> = equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect();
        let at = |name: &str| names.iter().position(|own| own == name).unwrap_or_else(|| panic!("{names:?}"));
        let mut y = vec![0.0; names.len()];
        y[at("x'")] = speed;
        let found = sizes(&mut compiled, &mut metric, 0.0, &y, 2.0);
        assert!((found[at("P_y")] / (4.0 * speed) - 1.0).abs() < 1e-3, "{speed}: {names:?} {found:?}");
    }
}

#[test]
fn round_off_of_a_large_displacement_says_no_size() {
    // y' = 0: no velocity depends on p_x, but in the last digits of a displacement by 1e29
    let text = "title = \"test\"\n[coordinates]\nx = { start = 1.1 }\ny = { start = 1 }\nz = { start = 0.7 }\n[definitions]\n\
                W = \"angular_velocity(rotation(zxz, 4 - x, (1 + z^2)^x, 2^(1e-3)))\"\n[system]\n\
                lagrangian = \"(x'^2 + y'^2 + z'^2)/2 + (1 + z^2)^(pi/4)*y'*x' + dot(W, W)/5\"\n\
                constraints = [\"x' - sqrt(1 + y'^2*(0.1*pi)^2)\"]\nforces = { z = \"z'*pi^(x')\" }\n\
                [invariants]\nheld = \"z'\"\n[start.velocities]\n\"y'\" = 0\n\"z'\" = 1\n[run]\nduration = 1\n";
    let scene = Scene::parse("test", text).unwrap();
    let choice = choices(&scene).into_iter().find(|choice| choice.formulation == VAKONOMIC_COSTATE).unwrap();
    let equations = derive_at(&scene.system, &scene.start, &choice).unwrap();
    let (mut compiled, mut metric) = (Compiled::new(&equations).unwrap(), Metric::new(&scene.system).unwrap());
    let start = solve_choice(&scene, &choice, &Settings::default()).unwrap().states_at(0.0).unwrap();
    let sizes = unbounded_sizes(&mut compiled, &mut metric, 0.0, &start, 1.0);
    assert!(sizes.iter().all(|size| *size < 1e3), "{sizes:?}");
}

/// Near the end M is singular, where velocities are differences of large terms: not before.
#[test]
fn terms_at_a_singular_end_hide_no_change_before() {
    let text = "title = \"test\"\ncoordinates = { x = { start = 0.3 }, y = { start = 1.1 } }\n\
                system = { lagrangian = \"(x'^2 + y'^2)/2 + 1.37*(0.1 - x)*x'*y'\" }\n\
                invariants = { held = \"x'\" }\nstart = { velocities = { \"x'\" = 0.3, \"y'\" = 0.2 } }\n\
                run = { duration = 2 }\n";
    let scene = Scene::parse("test", text).unwrap_or_else(|e| panic!("{e}"));
    for formulation in [CHETAEV, VAKONOMIC_COSTATE] {
        let choice = choices(&scene).into_iter().find(|choice| choice.formulation == formulation).expect("a choice");
        let motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
        let [found] = &motion.breaches[..] else { panic!("{:?}", motion.breaches) };
        assert!(!motion.is_complete() && found.t < 0.1 && found.estimate < 1e-9, "{} {found:?}", motion.end());
    }
}

/// A quantity is kept where as large a change would show.
#[test]
fn what_is_kept_would_show_a_change() {
    let motion = |force: &str| {
        let text = format!(
            "title = \"test\"\ncoordinates = {{ x = {{ start = 0 }} }}\nsystem = {{ lagrangian = \"x'^2/2 - {force}\" }}\n\
             invariants = {{ held = \"x'*(1 + t)/(1 + t)\" }}\nstart = {{ velocities = {{ \"x'\" = 0.3 }} }}\n\
             run = {{ duration = 2 }}\n"
        );
        let scene = Scene::parse("test", &text).unwrap_or_else(|e| panic!("{e}"));
        solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion")
    };
    let (free, forced) = (motion("0"), motion("x/10"));
    let [changed] = &forced.breaches[..] else { panic!("{:?}", forced.breaches) };
    let other = |name: &str, largest: f64, t: f64| Breach { name: name.into(), largest, t, ..changed.clone() };
    assert!(free.keeps(changed) && !forced.keeps(changed));
    for hidden in [other("held", 1e-13, 1.0), other("energy", 1.0, 1.0), other("held", 1.0, 3.0)] {
        assert!(!free.keeps(&hidden), "{hidden:?}, {:?}", free.unseen);
    }
}
