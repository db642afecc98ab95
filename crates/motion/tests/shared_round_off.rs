//! What both runs of a motion share: where it is looked at, and which run takes the place of the looser one.

use mechanics::{ConstantsRule, Removal};
use motion::parts::{LOOKED_AT, looked_at, replace_looser, sizes_of, stop_at, terms_of_coordinates_along};
use motion::{Choice, Motion, REMOVED_CONSTRAINT, Settings, choices, setting, solve_choice};
use scene::Scene;

/// A particle from the origin at this speed, on a spring.
fn particle(speed: f64, spring: f64, duration: f64) -> Motion {
    let text = format!(
        "title = \"free\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2 - {spring:?}*x^2\"\n\
         [start.velocities]\n\"x'\" = {speed:?}\n[run]\nduration = {duration:?}\n"
    );
    let scene = Scene::parse("free", &text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(setting(&scene).end, duration);
    solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion")
}

/// `x = v t`, to whose rate `v` is added up: together `v t + |x|`.
#[test]
fn what_is_added_up_to_a_coordinate_is_a_sum_over_time() {
    for speed in [3.0, -0.25] {
        let found = terms_of_coordinates_along(&mut particle(speed, 0.0, 2.0));
        assert!(found.len() > LOOKED_AT[0], "{found:?}");
        for (t, terms) in found {
            let known = 2.0 * (speed * t).abs();
            assert!((terms[0] - known).abs() <= 1e-12 * known, "{speed}, at {t}: {terms:?}, {known}");
        }
    }
}

/// A sledge that turns past 90°, where its removal by coordinates goes on in another chart.
#[test]
fn only_the_first_chart_is_looked_at() {
    let text = "title = \"sledge\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nphi = { start = 0.3 }\n\
                [system]\nlagrangian = \"(x'^2 + y'^2 + phi'^2)/2\"\nconstraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n\
                [start]\nvelocities = { \"x'\" = 0.6, \"phi'\" = 1.1 }\n[run]\nduration = 2.4\n";
    let scene = Scene::parse("sledge", text).unwrap_or_else(|e| panic!("{e}"));
    let removal = Removal::by_coordinates(&scene.system, &scene.start).expect("linear");
    let own = choices(&scene).into_iter().find(|choice| choice.formulation == REMOVED_CONSTRAINT);
    let own = own.expect("a choice");
    let choice = Choice { removal: Some(removal), constants: ConstantsRule::Zero, ..own };
    let mut motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
    let [change] = &motion.charts[..] else { panic!("{} changes", motion.charts.len()) };
    let (change, stretch) = (change.t, 2.4 / LOOKED_AT[1] as f64);
    let (looked, looser, _) = looked_at(&mut motion, LOOKED_AT[1]);
    assert!(looked.iter().all(|(t, ..)| *t < change) && looked.len() == looser.len(), "{change}: {looked:?}");
    assert!(looked.iter().any(|(t, ..)| *t > change - 2.0 * stretch), "{change}: {looked:?}");
}

#[test]
fn states_are_as_large_as_the_scene_or_the_motion_makes_them() {
    // a velocity of 10⁹ is integrated by 10⁻⁵ of it
    for (speed, known) in [(1e-9, 1e-9), (1.0, 1.0), (1e9, 1e4)] {
        let motion = particle(speed, 0.1, 2.0);
        let sizes = sizes_of(&motion, &[(0.0, vec![0.0; 2], vec![0.0; 2])]);
        assert!(sizes.iter().all(|size| (0.1 * known..=10.0 * known).contains(size)), "{speed:e}: {sizes:?}");
        let sizes = sizes_of(&motion, &[(0.0, vec![-5.0 * speed, speed], vec![0.0; 2])]);
        assert_eq!(sizes[0].max(5.0 * speed), sizes[0], "{speed:e}");
    }
}

#[test]
fn a_looser_run_is_replaced_by_one_that_comes_as_far() {
    let mut motion = particle(1.0, 0.7, 2.0);
    let apart = motion.difference_of_runs(2.0).expect("the end")[0];
    assert!(apart != 0.0);
    let short = particle(1.0, 0.7, 1.9);
    replace_looser(&mut motion, &short);
    assert_eq!(motion.difference_of_runs(2.0).expect("the end")[0], apart);
    let own = motion.clone();
    replace_looser(&mut motion, &own);
    assert_eq!(motion.difference_of_runs(2.0).expect("the end")[0], 0.0);
}

/// Of a motion that stops at 2, one to 1.9 is nearly all, and no other reading comes farther.
#[test]
fn where_a_motion_stops_a_looser_run_may_stop_a_little_earlier() {
    for (reached, end) in [(1.9, 1.9), (1.7, 2.0)] {
        let mut motion = particle(1.0, 0.7, 2.0);
        stop_at(&mut motion, 2.0, "a stop");
        let apart = motion.difference_of_runs(1.0).expect("in range")[0];
        replace_looser(&mut motion, &particle(1.0, 0.7, reached));
        assert_eq!(motion.end(), end);
        assert_eq!(motion.difference_of_runs(1.0).expect("in range")[0] == apart, reached == 1.7);
    }
}
