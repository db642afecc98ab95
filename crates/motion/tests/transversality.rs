//! Constants that are natural at a horizon: searches with derivatives that are carried, and with differences.

use std::time::Instant;

use mechanics::ConstantsRule;
use motion::{Choice, REMOVED_CONSTRAINT, Settings, choices, derive_in_form, parts, prepare, setting};
use scene::Scene;

/// Runs that a search takes, those with derivatives among them, the constants, and seconds.
fn searched(scene: &Scene, choice: &Choice, horizon: f64, carries: bool) -> Option<([usize; 2], Vec<f64>, f64)> {
    let settings = Settings::default();
    let equations = derive_in_form(&scene.system, &scene.start, choice, settings.form).ok()?.0;
    let mut prepared = prepare(setting(scene), equations, &ConstantsRule::Zero, &settings).ok()?;
    if prepared.constants.is_empty() {
        return None;
    }
    let clock = Instant::now();
    let (shot, constants) = parts::searched(&mut prepared, horizon, &settings, setting(scene), carries).ok()?;
    assert_eq!(shot.exact, if carries { shot.iterations } else { 0 }, "{} {}", scene.name, choice.label);
    Some(([shot.evaluations, shot.exact], constants, clock.elapsed().as_secs_f64()))
}

/// `cargo test --release -p deltaq-motion --test motion-tests natural:: -- --nocapture` prints the table.
#[test]
fn derivatives_that_are_carried_lead_to_the_same_constants_in_fewer_runs() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scene/scenes/");
    println!("{:<55}{:>12}{:>22}{:>8}{:>6}", "runs", "differences", "carried (with them)", "ms", "ms");
    let mut compared = 0;
    for name in ["sledge", "bowl", "three-cylinders"] {
        let text = std::fs::read_to_string(format!("{folder}{name}.toml")).expect("a scene");
        let scene = Scene::parse(name, &text).unwrap_or_else(|error| panic!("{error}"));
        let horizon = scene.start.t + scene.duration;
        for choice in choices(&scene).into_iter().filter(|c| c.formulation == REMOVED_CONSTRAINT) {
            let choice = Choice { constants: ConstantsRule::Natural { horizon }, ..choice };
            let found = [false, true].map(|carries| searched(&scene, &choice, horizon, carries));
            let [Some((before, old, slow)), Some((after, new, fast))] = found else { continue };
            let label = format!("{name}, {}", choice.label);
            let [slow, fast] = [slow, fast].map(|seconds| 1e3 * seconds);
            let carried = format!("{} ({})", after[0] + after[1], after[1]);
            println!("{label:<55}{:>12}{carried:>22}{slow:>8.1}{fast:>6.1}", before[0]);
            for (a, b) in old.iter().zip(&new) {
                assert!((a - b).abs() < 1e-8 * (1.0 + a.abs()), "{label}: {old:?}, {new:?}");
            }
            assert!(after[0] + after[1] <= before[0], "{label}: {after:?} runs for {before:?}");
            compared += 1;
        }
    }
    assert!(compared >= 3);
}
