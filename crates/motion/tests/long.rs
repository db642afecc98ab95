//! Long runs: of a motion whose times are known before, nothing else is kept.

use integrate::Method;
use motion::{Choice, Motion, Settings, SolveError, choices, error_estimates, setting, solve_choice};
use scene::Scene;

/// An oscillator of frequency 1 and one of `sqrt 2`, with a number that stays constant.
fn scene(duration: f64, force: &str) -> Scene {
    let text = format!(
        "title = \"Two oscillators\"\ncoordinates = {{ x = {{ start = 1 }}, y = {{ start = 0 }} }}\n\
         [system]\nlagrangian = \"(x'^2 + y'^2)/2 - x^2/2 - y^2\"\nforces = {{ x = \"{force}\" }}\n\
         [start.velocities]\n\"x'\" = 0\n\"y'\" = 0.5\n[run]\nduration = {duration:?}\n"
    );
    Scene::parse("long", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn solve(scene: &Scene, method: Option<Method>, times: Option<&[f64]>) -> Motion {
    let choice: Choice = choices(scene).swap_remove(0);
    let settings = Settings { tolerance: 1e-10, method, times: times.map(<[f64]>::to_vec), ..Settings::default() };
    solve_choice(scene, &choice, &settings).expect("starts")
}

const TIMES: [f64; 4] = [0.1, 777.7, 1234.5, 3000.0];

#[test]
fn what_is_asked_for_is_the_same_to_the_bit() {
    for (method, duration) in [(Method::Taylor, 30_000.0), (Method::Dop853, 3000.0), (Method::Radau5, 3000.0)] {
        let scene = scene(duration, "0");
        let mut whole = solve(&scene, Some(method), None);
        let mut asked = solve(&scene, Some(method), Some(&TIMES));
        assert_eq!((whole.end(), &whole.doubt), (asked.end(), &asked.doubt), "{method:?}");
        for t in TIMES {
            assert_eq!(whole.at_in_both_runs(t).unwrap(), asked.at_in_both_runs(t).unwrap(), "{method:?} at {t}");
        }
        let [one, two] = [&mut whole, &mut asked].map(|m| error_estimates(m, setting(&scene), &TIMES).unwrap());
        assert_eq!(one, two, "{method:?}");
        // what was not asked for is not made up
        let refused = asked.at(1000.1).unwrap_err();
        assert!(matches!(refused, SolveError::Dense(_)), "{method:?}: {refused}");
        assert!(refused.to_string().contains("1000.1 is not stored"), "{refused}");
    }
}

#[test]
fn a_run_that_stops_early_is_known_well_enough() {
    // the force has no value from 15,000 s on
    let scene = scene(30_000.0, "sqrt(15000 - t)*1e-3");
    let [mut whole, mut asked] = [None, Some(&TIMES[..])].map(|times| solve(&scene, None, times));
    assert!(!whole.is_complete() && !asked.is_complete());
    assert!((asked.end() - whole.end()).abs() <= 200.0, "{} {}", asked.end(), whole.end());
    let [one, two] = [&mut whole, &mut asked].map(|m| error_estimates(m, setting(&scene), &TIMES[..3]).unwrap());
    // round-off that is put into the looser run is looked for at other instants
    for t in &TIMES[..3] {
        assert_eq!(whole.at(*t).unwrap(), asked.at(*t).unwrap());
    }
    let (one, two) = (one.1.absolute, two.1.absolute);
    assert!(0.3 * one <= two && two <= 3.0 * one, "{two} beside {one}");
    assert!((100..201).contains(&asked.grid(200).len()), "{}", asked.grid(200).len());
}

#[test]
fn short_runs_keep_everything() {
    let scene = scene(10.0, "0");
    let mut motion = solve(&scene, None, Some(&[10.0]));
    let x = motion.at(4.321).expect("kept").coordinates[0];
    assert!((x - 4.321_f64.cos()).abs() < 1e-11);
}
