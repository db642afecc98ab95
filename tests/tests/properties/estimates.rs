//! The error estimate of a motion is near its error, and over it.

use integrate::Method;
use motion::{Choice, Form, Motion, Settings, choices, error_estimate, setting, solve_choice};
use random::{Batch, Kind};
use scene::Scene;

/// What a user asks for: the error of the run that is kept is far over round-off.
const TOLERANCE: f64 = 1e-7;

/// Systems; `ESTIMATES=N` for others.
const COUNT: u64 = 150;

/// Errors under this part of how far the motion goes are not measured: the judge has them too.
const FLOOR: f64 = 1e-12;

fn motion(scene: &Scene, choice: &Choice, settings: &Settings) -> Option<Motion> {
    solve_choice(scene, choice, settings).ok().filter(Motion::is_complete)
}

/// Estimate and true error, in the kinetic metric; none where a motion stops, or where the judge is not known
/// well enough. The judge is DOP853 on the equations as derived.
fn measured(scene: &Scene, choice: &Choice) -> Option<(f64, f64)> {
    let mut given = motion(scene, choice, &Settings { tolerance: TOLERANCE, ..Settings::default() })?;
    let sharp = Settings { tolerance: 1e-11, form: Form::Named, method: Some(Method::Dop853), ..Settings::default() };
    let mut judge = motion(scene, choice, &sharp)?;
    let estimate = error_estimate(&mut given, setting(scene)).expect("readable");
    let doubt = error_estimate(&mut judge, setting(scene)).expect("readable").absolute;
    let mut metric = motion::Metric::new(&scene.system).expect("compiles");
    let error = given.grid(200).into_iter().fold(0.0_f64, |error, t| {
        let (here, there) = (given.at(t).expect("readable"), judge.at(t).expect("readable"));
        error.max(metric.distance(t, &there.coordinates, &there.velocities, &here.coordinates))
    });
    let size = estimate.absolute / estimate.relative;
    (doubt < 0.1 * estimate.absolute && error > FLOOR * size).then_some((estimate.absolute, error))
}

#[test]
fn estimates_are_between_the_error_and_a_thousand_times_the_error() {
    let count = std::env::var("ESTIMATES").ok().and_then(|n| n.parse().ok()).unwrap_or(COUNT);
    let batch = Batch { seed: 31_001, kinds: Kind::ALL.to_vec() };
    let mut ratios = Vec::new();
    for index in 0..count {
        let scene = batch.scene(index);
        let measured = choices(&scene).iter().filter_map(|choice| measured(&scene, choice)).collect::<Vec<_>>();
        ratios.extend(measured.into_iter().map(|(estimate, error)| (estimate / error, index)));
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let honest = ratios.iter().filter(|(ratio, _)| (1.0..=1e3).contains(ratio)).count();
    let share = honest as f64 / ratios.len() as f64;
    let at = |part: f64| ratios[((ratios.len() - 1) as f64 * part) as usize];
    println!(
        "{} motions of {count} systems: {:.2} % between 1 and 1000; least {:?}, 1 % {:?}, median {:?}, 99 % {:?}, most {:?}",
        ratios.len(),
        100.0 * share,
        at(0.0),
        at(0.01),
        at(0.5),
        at(0.99),
        at(1.0)
    );
    assert!(ratios.len() as u64 > count, "few motions were measured");
    assert!(share >= 0.95, "{share}");
}
