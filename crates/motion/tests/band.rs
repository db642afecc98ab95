//! The error of a motion: what is known of a number, what two of them say, and what an estimate tells.

use motion::band::{Answer, CERTAINTY, Known, NoInformation, ask};
use motion::{CHETAEV, Settings, Steps, choices, error_estimates, setting, solve_by_steps, solve_choice};

use crate::support;

#[test]
fn an_error_is_a_part_of_a_size_or_nothing_is_known_of_it() {
    let known = |error: f64, size: f64, reach: f64| Known { value: 0.0, error, size, reach };
    assert_eq!(known(1e-3, 2.0, 2.0).part(), Ok(5e-4));
    // less than the round-off of another number of its unit
    assert_eq!(known(1e-15, 0.0, 1.0).part(), Ok(0.0));
    assert_eq!(known(1e-3, 0.0, 1.0).part(), Err(NoInformation::ZeroSize));
    assert_eq!(known(f64::NAN, 1.0, 1.0).part(), Err(NoInformation::NotFinite));
    assert_eq!(known(0.0, 0.0, 0.0).part(), Ok(0.0));
}

#[test]
fn a_difference_is_apart_from_ten_times_both_bounds_on() {
    assert_eq!(ask(1.01 * CERTAINTY * 3e-9, Some(3e-9)), Answer::Apart);
    assert_eq!(ask(-0.99 * CERTAINTY * 3e-9, Some(3e-9)), Answer::Within);
    // two motions at rest have no errors and no difference
    assert_eq!(ask(0.0, Some(0.0)), Answer::Within);
    assert_eq!(ask(1.0, None), Answer::Undecided(NoInformation::Doubted));
    assert_eq!(ask(f64::NAN, Some(1.0)), Answer::Undecided(NoInformation::NotFinite));
}

/// A quantity of terms 2 that is 1 at the start, in both runs of a motion.
#[test]
fn a_quantity_has_changed_where_neither_error_nor_round_off_explain_it() {
    let change = |by: f64, error: f64| Known::change(&[[1.0, 1.0], [1.0 + by, 1.0 + by + error]], 2.0);
    assert!(change(1.2e-11, 0.0).is_certain() && !change(1e-11, 0.0).is_certain());
    assert!(change(1.1e-7, 1e-9).is_certain() && !change(0.9e-7, 1e-9).is_certain());
    assert_eq!(change(0.5, 0.0).of_terms(), 0.25);
    // a change under round-off has the digits of that
    assert_eq!(change(0.0, 0.0).of_terms(), 0.0);
    assert_eq!(change(0.0, 0.0).with_digits(), 256.0 * f64::EPSILON);
    // nothing at all
    assert_eq!(Known::change(&[[0.0, 0.0]], 0.0).of_terms(), 0.0);
}

/// `x = sin 3t`, by a loose method: the error of `x'` is seen, and is about three times that of `x`.
#[test]
fn velocities_have_estimates_of_their_own() {
    let text = "title = \"spring\"\n[coordinates]\nx = { start = 0 }\n[system]\nlagrangian = \"(x'^2 - 9*x^2)/2\"\n\
                [start.velocities]\n\"x'\" = 3\n[run]\nduration = 5\n";
    let scene = support::read("spring", text);
    let settings = Settings { tolerance: 1e-5, ..Settings::default() };
    let mut motion = solve_choice(&scene, &choices(&scene)[0], &settings).expect("a motion");
    let times = [1.0, 2.5, 5.0];
    let (so_far, whole) = error_estimates(&mut motion, setting(&scene), &times).expect("in range");
    for (t, estimate) in times.iter().zip(&so_far) {
        let error = (motion.at(*t).expect("in range").velocities[0] - 3.0 * (3.0 * t).cos()).abs();
        assert!(error <= estimate.velocities[0], "at {t}: {error:.1e}, {estimate:?}");
    }
    let ratio = whole.velocities[0] / whole.coordinates[0];
    assert!((1.0..9.0).contains(&ratio), "{ratio}, {whole:?}");
}

/// A bead on a lemniscate, whose branches cross at the origin, at 64 phases and three steps.
#[test]
fn equal_steps_do_not_pass_a_place_where_rank_is_lost() {
    for step in [0.02, 0.01, 0.003] {
        for k in 0..64 {
            let text = format!(
                "title = \"bead\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 0 }}\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"(x^2 + y^2)^2 - x^2 + y^2\"]\n\
                 [start.velocities]\n\"x'\" = 0\n\"y'\" = {:?}\n[run]\nduration = 1.2\n",
                1.7 + 0.002 * f64::from(k)
            );
            let scene = support::read("bead", &text);
            let steps = Steps { step, composition: discrete::Composition::Second };
            let chetaev = support::choice(&scene, CHETAEV);
            let motion = solve_by_steps(&scene, &chetaev, steps, &Settings::default()).expect("a motion");
            let before = motion.end();
            assert!(!motion.is_complete() && before < 0.8, "{step}, {k}: {before}, {:?}", motion.ending);
        }
    }
}

/// An ellipse has no such place.
#[test]
fn equal_steps_go_where_rank_is_kept() {
    let text = "title = \"bead\"\n[coordinates]\nx = { start = 1 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"x^2 + 2*y^2 - 1\"]\n[start.velocities]\n\"x'\" = 0\n\
                \"y'\" = 1\n[run]\nduration = 20\n";
    let scene = support::read("bead", text);
    let steps = Steps { step: 0.01, composition: discrete::Composition::Second };
    let motion = solve_by_steps(&scene, &support::choice(&scene, CHETAEV), steps, &Settings::default());
    let motion = motion.expect("a motion");
    assert!(motion.is_complete(), "{:?}", motion.ending);
}
