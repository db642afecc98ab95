//! What is done twice is seen: operations on expressions, counted by the room that asks for them. Nobody
//! waits for one motion that is derived twice; who compares, sweeps, or draws a thousand systems, does.

use comparison::{Comparison, Extent};
use motion::{
    Aim, CHETAEV, Ensemble, EnsembleOptions, Prepared, Settings, VAKONOMIC, choices, connect, derive_in_form,
    error_estimate, setting, solve_choice,
};
use scene::Scene;
use symbolic::faults::chances;

const DERIVE: usize = 0;
const PLAN: usize = 1;
/// Folders of what is counted together.
const ROOMS: [&[&str]; 2] = [
    &["crates/chetaev/", "crates/vakonomic/", "crates/removed-constraint/", "crates/reduction/"],
    &["equations/src/plan"],
];

/// What work says, and the operations of each of [`ROOMS`] in it.
fn counted<T>(work: impl FnOnce() -> T) -> (T, [usize; ROOMS.len()]) {
    let (result, asked) = chances(work);
    let files: Vec<String> = asked.iter().map(|chance| chance.at.file().replace('\\', "/")).collect();
    (result, ROOMS.map(|room| files.iter().filter(|file| room.iter().any(|folder| file.contains(folder))).count()))
}

fn scene(name: &str) -> Scene {
    scene::catalogue::find(name, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Choices of a scene by place, each with a scene of its own: a graph remembers what was asked of it.
fn each<T>(name: &str, work: impl Fn(&Scene, &motion::Choice) -> T) -> Vec<T> {
    let all = 0..choices(&scene(name)).len();
    all.map(|i| {
        let scene = scene(name);
        work(&scene, &choices(&scene)[i])
    })
    .collect()
}

const SCENES: [&str; 4] = ["sledge", "disc", "trailer", "ball-in-cone"];

#[test]
fn a_motion_is_derived_and_planned_once() {
    let settings = Settings::default();
    for name in SCENES {
        let parts = each(name, |scene, choice| {
            let (derived, [derive, none]) =
                counted(|| derive_in_form(&scene.system, &scene.start, choice, settings.form));
            let (equations, _) = derived.unwrap_or_else(|error| panic!("{name}: {error}"));
            let (prepared, [_, plan]) = counted(|| Prepared::new(setting(scene), equations, &settings));
            assert!(prepared.is_ok() && none == 0 && derive > 0, "{name}, {}", choice.label);
            [derive, plan]
        });
        let whole = each(name, |scene, choice| {
            let (motion, count) = counted(|| solve_choice(scene, choice, &settings));
            (motion.is_ok_and(|motion| motion.charts.is_empty()), count)
        });
        println!("{name}: {parts:?}");
        // in another chart on the way, a motion is derived anew; where round-off is more than the difference
        // of its runs, its equations are planned once more, with round-off in them
        let one_chart: Vec<_> = whole.into_iter().zip(&parts).filter(|((one, _), _)| *one).collect();
        let (once, others): (Vec<_>, Vec<_>) = one_chart.iter().partition(|((_, count), parts)| count == *parts);
        let twice = |[derive, plan]: [usize; 2]| [derive, 2 * plan];
        assert!(
            once.len() > 2 && others.iter().all(|((_, count), parts)| *count == twice(**parts)),
            "{name}: {one_chart:?}"
        );
        assert!(parts.iter().any(|count| count[PLAN] > 0), "{name}: nothing is planned");
    }
}

#[test]
fn a_comparison_derives_and_plans_each_motion_once() {
    let settings = Settings::default();
    for name in SCENES {
        let alone = each(name, |scene, choice| counted(|| solve_choice(scene, choice, &settings)).1);
        let scene = scene(name);
        let all = choices(&scene);
        let mut comparison = Comparison::new(scene, Extent::Gaps, &settings).expect("compared");
        let (_, together) = counted(|| {
            for choice in all {
                comparison.solve(choice, &settings).expect("compared");
            }
        });
        let sum: [usize; 2] = [DERIVE, PLAN].map(|room| alone.iter().map(|count| count[room]).sum());
        assert_eq!(together, sum, "{name}");
    }
}

#[test]
fn members_are_neither_derived_nor_planned() {
    for name in ["sledge", "disc", "trailer"] {
        let scene = scene(name);
        let ensemble = Ensemble::new(&scene, &choices(&scene)[0], &[], &Settings::default());
        let mut ensemble = ensemble.unwrap_or_else(|error| panic!("{name}: {error}"));
        let members: Vec<_> = (0..20).filter_map(|_| ensemble.member(&[]).ok()).collect();
        let options = EnsembleOptions { threads: 1, estimate: true };
        let (motions, count) = counted(|| ensemble.motions(&members, &[0.5 * scene.duration], &options));
        assert_eq!((motions.len(), count), (20, [0, 0]), "{name}");
    }
}

#[test]
fn what_is_asked_of_a_motion_derives_and_plans_nothing() {
    let settings = Settings::default();
    for name in SCENES {
        let asked = each(name, |scene, choice| {
            let mut motion = solve_choice(scene, choice, &settings).unwrap_or_else(|error| panic!("{name}: {error}"));
            let end = motion.end();
            counted(|| {
                assert!(error_estimate(&mut motion, setting(scene)).is_ok(), "{name}");
                (0..50).filter(|i| motion.at(end * f64::from(*i) / 50.0).is_ok()).count()
            })
        });
        assert!(asked.iter().all(|asked| *asked == (50, [0, 0])), "{name}: {asked:?}");
    }
}

/// A start more costs runs, and neither derivations nor plans.
#[test]
fn a_search_between_points_derives_and_plans_once_for_all_starts() {
    // a quarter of a circle of radius 1
    let z = 0.25 + 0.5 * (std::f64::consts::FRAC_PI_4 - 0.5);
    let to = [("x", 0.5), ("y", 1.0), ("z", z)].map(|(name, q)| (name.to_owned(), q)).to_vec();
    let searched = [8, 16].map(|starts| {
        let scene = scene("heisenberg");
        let choice = choices(&scene).into_iter().find(|choice| choice.formulation == VAKONOMIC).expect("it is there");
        let aim = Aim { t: 1.0, to: to.clone(), starts, threads: 1 };
        let (found, count) = counted(|| connect(&scene, &choice, &aim, &Settings::default()).expect("a search"));
        (found.found.len(), found.runs, count)
    });
    let [(one, few, count), (same, many, again)] = searched;
    assert!(one > 0 && one == same && count == again && count[DERIVE] > 0, "{searched:?}");
    assert!(many[0] > few[0] && many[0] < 3 * few[0] && many[1] < 3 * few[1], "{searched:?}");
}

#[test]
fn steady_motions_of_a_sweep_are_derived_once() {
    let bicycle = scene("bicycle");
    let choice = choices(&bicycle).into_iter().find(|choice| choice.formulation == CHETAEV).expect("it is there");
    let count = |values: &[f64]| {
        let swept = counted(|| linear::sweep(&scene("bicycle"), &choice, &["lean", "steer"], ("v", values), false));
        assert!(swept.0.is_ok_and(|sweep| sweep.points.len() == values.len() && sweep.changes.is_empty()));
        swept.1
    };
    let [one, several] = [count(&[5.0]), count(&[4.6, 5.0, 5.4, 5.8])];
    assert!(one[DERIVE] > 0 && one == several, "{one:?}, {several:?}");
}
