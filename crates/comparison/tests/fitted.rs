//! Fits of free constants: how well these are known, which of them stay, and what the search takes.

use std::time::Instant;

use comparison::parts::{Differences, Found, INSTANTS, Power, Start, fit_run, keep_closer, unknown};
use comparison::{Fit, Fits, FittedMotion, Gap, Run, Verdict, compare_motions, compare_unfitted};
use integrate::{ShootOptions, fit};
use mechanics::ConstantsRule;
use motion::{Choice, Metric, Settings, VAKONOMIC, choices, derive_in_form, setting, solve_choice};
use scene::Scene;

const HEISENBERG: &str = include_str!("../../scene/scenes/heisenberg.toml");

fn settings() -> Settings {
    Settings { tolerance: 1e-12, ..Settings::default() }
}

/// The vakonomic motion with this multiplier at the start.
fn run(scene: &Scene, mu: f64) -> Run {
    let choice = choices(scene).into_iter().find(|c| c.formulation == VAKONOMIC).expect("vakonomic");
    let choice = Choice { constants: ConstantsRule::Given(vec![mu]), ..choice };
    let outcome = solve_choice(scene, &choice, &settings());
    Run { choice, outcome }
}

/// The gap between these two.
fn apart(scene: &Scene, metric: &mut Metric, [one, other]: [f64; 2]) -> Gap {
    let [mut one, mut other] = [one, other].map(|mu| run(scene, mu).outcome.expect("a motion"));
    compare_motions(&mut one, &mut other, metric).expect("a gap")
}

#[test]
fn the_constants_of_a_search_are_known_to_ten_digits_and_those_of_an_identity_to_all() {
    let scene = Scene::parse("heisenberg", HEISENBERG).unwrap_or_else(|e| panic!("{e}"));
    let mut metric = Metric::new(&scene.system).expect("a metric");
    // what a change of the constant makes of the motion, by one that is large
    let slope = apart(&scene, &mut metric, [2.0, 2.0 + 1e-5]).largest / 1e-5;
    let mut motion = run(&scene, 2.0).outcome.expect("a motion");
    let found = unknown(&scene, &mut motion, &[2.0 * 1e-10], &mut metric, &settings()).expect("a gap");
    let known = 2.0 * 1e-10 * slope;
    assert!((found - known).abs() < 0.05 * known, "{found:e}, {known:e}");
    let cases = [
        (0.3, 7, 0.0, "undecided"),
        (0.3, 0, 0.0, "different"),
        (4.0, 7, 0.0, "different"),
        (4.0, 0, 1e-9, "undecided"),
    ];
    for (off, starts, open, word) in cases {
        let mut runs = [run(&scene, 1.5), run(&scene, 2.0)];
        let start = Start::Known(Found { starts, open: vec![open], ..Found::given(vec![2.0 * (1.0 + off * 1e-10)]) });
        let fitted = fit_run(&scene, &mut runs, 0, 1, start, &mut metric, &settings()).expect("no error");
        let fitted = fitted.expect("a constant").expect("a motion");
        assert_eq!(fitted.gap.verdict.word(), word, "{off}, {starts}: {:?}", fitted.gap.verdict);
        assert_eq!((fitted.starts, fitted.constants.len()), (starts, 1));
    }
}

#[test]
fn constants_that_a_search_has_found_stay_only_where_they_come_closer() {
    let scene = Scene::parse("sledge", include_str!("../../scene/sledge.toml")).expect("a scene");
    let all = choices(&scene);
    let mut comparison = compare_unfitted(scene, all, Vec::new(), &Settings::default()).expect("a comparison");
    let (target, run) = (0, comparison.run(VAKONOMIC).expect("a run"));
    let own = comparison.pair(target, run).expect("a pair").gap.clone();
    let fit = |largest: f64| {
        let gap = Gap { largest, ..own.clone() };
        let fitted = FittedMotion { constants: vec![("mu0_1".into(), 0.625)], by_half: gap.largest, gap, starts: 3 };
        Fit { run, target, fitted: Some(fitted), by_identity: false }
    };
    comparison.fits = (0..4).map(|i| fit([0.5, 2.0, 2.0, 2.0][i] * own.largest)).collect();
    // another time, and a gap of errors, say nothing of which comes closer
    comparison.fits[2].fitted.as_mut().expect("a motion").gap.end *= 0.5;
    comparison.fits[3].fitted.as_mut().expect("a motion").gap.verdict = Verdict::Same;
    keep_closer(&mut comparison);
    let found = |i: usize| comparison.fits[i].fitted.as_ref().map(|f| (f.constants[0].1, f.gap.largest));
    assert_eq!((found(0), found(1)), (Some((0.625, 0.5 * own.largest)), Some((0.0, own.largest))));
    assert_eq!((found(2), found(3)), (Some((0.625, 2.0 * own.largest)), Some((0.625, 2.0 * own.largest))));
}

/// A gap of nothing, which no search comes under.
#[test]
fn a_fit_ends_with_what_comes_closer() {
    let scene = Scene::parse("sledge", include_str!("../../scene/sledge.toml")).expect("a scene");
    let all = choices(&scene);
    let settings = Settings::default();
    let mut comparison = compare_unfitted(scene, all, Vec::new(), &settings).expect("a comparison");
    comparison.pairs.iter_mut().for_each(|pair| pair.gap.largest = 0.0);
    comparison.fit(Fits::All, &settings).expect("fits");
    let fitted = comparison.fits.iter().filter_map(|fit| fit.fitted.as_ref());
    let fitted = fitted.filter(|found| found.gap.verdict == Verdict::Different);
    let gaps: Vec<f64> = fitted.map(|found| found.gap.largest).collect();
    assert!(!gaps.is_empty() && gaps.iter().all(|gap| *gap == 0.0), "{gaps:?}");
}

/// `cargo test --release -p deltaq-comparison --test comparison-tests fitted:: -- --nocapture` prints the
/// table.
#[test]
fn fits_with_derivatives_that_are_carried_end_at_the_same_constants_in_fewer_runs() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scene/scenes/");
    println!(
        "{:<20}{:>10}{:>14}{:>22}{:>8}{:>8}",
        "fit of mu0", "constants", "differences", "carried (with them)", "ms", "ms"
    );
    for (name, goal) in [("heisenberg", &[0.7][..]), ("disc", &[0.3, -0.2]), ("trailer", &[0.4, 0.1])] {
        let text = std::fs::read_to_string(format!("{folder}{name}.toml")).expect("a scene");
        let mut scene = Scene::parse(name, &text).unwrap_or_else(|error| panic!("{error}"));
        scene.duration = 2.0;
        let vakonomic = choices(&scene).into_iter().find(|c| c.formulation == VAKONOMIC).expect("vakonomic");
        let goal: Vec<f64> = (0..scene.multipliers.len()).map(|i| goal[i % goal.len()]).collect();
        let given = Choice { constants: ConstantsRule::Given(goal.clone()), ..vakonomic.clone() };
        let settings = Settings::default();
        let mut target = solve_choice(&scene, &given, &settings).expect("a motion");
        let equations = derive_in_form(&scene.system, &scene.start, &vakonomic, settings.form).expect("equations").0;
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let guess: Vec<f64> = goal.iter().map(|mu| mu * 0.6 + 0.05).collect();
        let mut searched = |carries: bool| {
            let differences = Differences::new(setting(&scene), &equations, &mut target, &mut metric, &settings);
            let mut differences = differences.expect("differences");
            let clock = Instant::now();
            let count = INSTANTS * differences.dimension();
            let shot = if carries {
                let squares = Power { power: 2.0, scale: 1.0, stride: 1, part: 1.0 };
                differences.least((1e-13, 0.0), &settings, &guess, &squares).expect("a fit")
            } else {
                let full = ShootOptions::with_tolerance(1e-13 * differences.way(1.0, 1));
                let mut plain = |constants: &[f64], residual: &mut [f64]| {
                    residual.copy_from_slice(differences.fill(constants, 1.0, 1, 1e-13, &settings)?.as_slice());
                    Ok(())
                };
                fit(&mut plain, count, &guess, &full).expect("a fit")
            };
            (shot, 1e3 * clock.elapsed().as_secs_f64())
        };
        let ((old, slow), (new, fast)) = (searched(false), searched(true));
        let carried = format!("{} ({})", new.evaluations + new.exact, new.exact);
        println!("{name:<20}{:>10}{:>14}{carried:>22}{slow:>8.1}{fast:>8.1}", goal.len(), old.evaluations);
        assert_eq!((old.exact, new.exact), (0, new.iterations), "{name}");
        assert!(new.evaluations + new.exact < old.evaluations, "{name}: {new:?}, {old:?}");
        for shot in [&old, &new] {
            for (found, mu) in shot.unknowns.iter().zip(&goal) {
                assert!((found - mu).abs() < 1e-8, "{name}: {shot:?} for {goal:?}");
            }
        }
    }
}
