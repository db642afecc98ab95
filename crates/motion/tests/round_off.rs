//! Round-off that both runs share is in no difference of theirs.

use integrate::Method;
use motion::{Ensemble, EnsembleOptions, Motion, Settings, choices, error_estimate, setting, solve_choice};
use scene::Scene;

/// A particle under this force from x = 0 at this speed, up to this time.
fn particle(force: &str, speed: f64, duration: f64) -> Scene {
    let text = format!(
        "title = \"Pushed\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2\"\n\
         forces = {{ x = \"{force}\" }}\n[start]\n\
         velocities = {{ \"x'\" = {speed:?} }}\n[run]\nduration = {duration:?}\n"
    );
    Scene::parse("pushed", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// Status of its motion as the member of an ensemble, with the cause.
fn as_member(force: &str, speed: f64, duration: f64) -> (&'static str, Option<String>) {
    let scene = particle(force, speed, duration);
    let settings = Settings { max_steps: 100_000, ..Settings::default() };
    let mut ensemble = Ensemble::new(&scene, &choices(&scene)[0], &[], &settings).unwrap_or_else(|e| panic!("{e}"));
    let member = ensemble.member(&[]).unwrap_or_else(|e| panic!("{e}"));
    let times = [0.5 * duration, duration];
    let motions = ensemble.motions(&[member.clone(), member], &times, &EnsembleOptions::default());
    let mut statuses = motions.into_iter().map(|motion| motion.expect("a motion").status());
    let (first, second) = (statuses.next().expect("one"), statuses.next().expect("another"));
    assert_eq!(first, second);
    first
}

/// The motion, and its status.
fn pushed(force: &str, speed: f64, duration: f64, method: Option<Method>) -> (Motion, &'static str, Option<String>) {
    let scene = particle(force, speed, duration);
    let settings = Settings { method, ..Settings::default() };
    let mut motion = solve_choice(&scene, &choices(&scene)[0], &settings).expect("a motion");
    let estimate = error_estimate(&mut motion, setting(&scene)).expect("in range");
    let (status, cause) = estimate.status(&motion);
    (motion, status, cause)
}

/// 1 − cos u and eᵘ − 1 of small u lose their digits, and the motions with them.
#[test]
fn a_force_of_round_off_is_not_trusted() {
    // x'' = −x² to 1e-16, and x'' = −x to 1e-13
    for (force, truth) in [("-(1 - cos(1e-8*x))*2e16", 0.9204757107), ("-(exp(1e-13*x) - 1)*1e13", 1_f64.sin())] {
        for method in [None, Some(Method::Dop853), Some(Method::Radau5)] {
            let (mut motion, status, cause) = pushed(force, 1.0, 1.0, method);
            let Ok(end) = motion.at(motion.end()) else { panic!("{force}") };
            let cause = cause.unwrap_or_else(|| panic!("{force}: {status}, {} instead of {truth}", end.coordinates[0]));
            // and they are wrong, indeed
            assert!((end.coordinates[0] - truth).abs() > 1e-7, "{force}: {}", end.coordinates[0]);
            let is_told = status == "untrusted" || motion.end() < 1.0;
            assert!(is_told, "{force}: {status}, {cause}");
        }
        // a twentieth of the time takes a twentieth of a million steps, and loses its digits as well
        let (status, cause) = as_member(force, 1.0, 0.05);
        assert!(["untrusted", "stopped"].contains(&status), "{force}: {status}, {cause:?}");
    }
}

/// The same forces written otherwise, and what is large, fast or long without a loss of digits.
#[test]
fn a_force_that_keeps_its_digits_is_trusted() {
    for (force, speed, duration) in [
        ("-4e16*sin(0.5e-8*x)^2", 1.0, 1.0),
        ("-x", 1.0, 1000.0),
        ("-1e6*x", 1.0, 10.0),
        ("-9.81*sin(x)", 1.0, 100.0),
        ("9.81 - 9.81", 0.0, 100.0),
        ("cos(x) - 1", 1e-3, 10.0),
        ("cos(1000*t)", 0.0, 10.0),
        ("1e-12*cos(x) - 1e-12", 1e-6, 1.0),
        ("0", 0.0, 1.0),
        ("-1e9*(x' - cos(t))", 1.0, 3.0),
    ] {
        let (motion, status, cause) = pushed(force, speed, duration, None);
        assert!(motion.is_complete() && cause.is_none(), "{force}: {status}, {cause:?}");
        if motion.method.as_ref().is_some_and(|chosen| chosen.method != Method::Taylor) {
            continue;
        }
        let (status, cause) = as_member(force, speed, duration);
        assert!(status == "completed", "{force}, in an ensemble: {status}, {cause:?}");
    }
}

/// A pendulum 1e-12 rad from its top: the last digits of its angle are a part 1e-4 of its rate.
#[test]
fn a_pendulum_leaves_its_top() {
    let text = "title = \"Pendulum\"\n[coordinates]\ntheta = { start = 3.141592653588793 }\n[system]\n\
        lagrangian = \"theta'^2/2 + 9.81*cos(theta)\"\n[start]\nvelocities = { \"theta'\" = 0 }\n\
        [run]\nduration = 6\n";
    let scene = Scene::parse("pendulum", text).unwrap_or_else(|e| panic!("{e}"));
    let mut motion = solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion");
    let estimate = error_estimate(&mut motion, setting(&scene)).expect("in range");
    assert_eq!(motion.end(), 6.0, "{:?}", estimate.status(&motion));
    // the start is a double; what is left of pi behind it is 1.2e-16
    let away = (std::f64::consts::PI - 3.141592653588793) + 1.2246467991473532e-16;
    let end = motion.at(6.0).expect("in range").coordinates[0];
    let truth = -away * (6.0 * 9.81_f64.sqrt()).cosh();
    let error = ((end - std::f64::consts::PI) - truth).abs();
    let estimated = estimate.coordinates[0];
    assert!(error < 1e-2 * truth.abs() && error < estimated && estimated < 0.1 * truth.abs(), "{error}, {estimated}");
}

/// A force that is a difference of large terms for a short time, wherever that is: an estimate knows it, or
/// there is none. The judge is the same force without the difference, `2/ε² (1 − cos(ε x)) = x²` up to 1e-16
/// of it.
#[test]
fn a_brief_cancellation_is_seen_wherever_it_is() {
    let mut doubted = 0;
    for width in [16.0, 64.0, 256.0] {
        for place in 0..8 {
            let middle = (f64::from(place) + 0.4375) / 8.0;
            for duration in [1.0, 3.0] {
                let scene = |force: &str| {
                    let text = format!(
                        "title = \"brief\"\n[coordinates]\nx = {{ start = 0.5 }}\ny = {{ start = 0.25 }}\nz = {{ start = 0 }}\n\
                         [system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"z' - y*x'\"]\n\
                         forces = {{ x = \"-{force}*exp(-({width:?}*(t - {middle:?}))^2)\" }}\n[start.velocities]\n\
                         \"x'\" = 0.25\n\"y'\" = 0.5\n[run]\nduration = {duration:?}\n"
                    );
                    scene::Scene::parse("brief", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
                };
                let solved = |scene: &scene::Scene| {
                    let choice = motion::choices(scene).into_iter().find(|c| c.formulation == motion::CHETAEV);
                    let mut motion =
                        motion::solve_choice(scene, &choice.expect("there is one"), &motion::Settings::default())
                            .expect("a motion");
                    let estimate = motion::error_estimate(&mut motion, motion::setting(scene)).expect("an estimate");
                    let end = motion.at(motion.end()).expect("its end").coordinates;
                    (end, estimate.coordinates.clone(), estimate.status(&motion).0)
                };
                let (end, estimate, status) = solved(&scene("20000000000000000*(1 - cos(x/100000000))"));
                let (truth, _, judge) = solved(&scene("x^2"));
                assert_eq!(judge, "completed");
                doubted += usize::from(status != "completed");
                let known = (0..3).all(|i| (end[i] - truth[i]).abs() <= 10.0 * estimate[i] + 1e-12);
                assert!(
                    known || status != "completed",
                    "{width}, {middle}, {duration}: {end:?} {truth:?} {estimate:?}"
                );
            }
        }
    }
    println!("{doubted} of 48 are doubted");
    assert!(doubted > 24, "{doubted}");
}
