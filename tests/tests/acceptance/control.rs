//! The control is wrong on purpose: caught wherever it is wrong, called right where it is right (T12).

use deltaq::{Metric, Motion, Settings, Verdict, compare_motions};
use random::substitution;
use referees::maggi::Maggi;
use scene::Scene;

use super::support::{at, chetaev, complete, scenes};

/// Parts of the run after which accelerations are compared.
const TIMES: [f64; 4] = [0.1, 0.21, 0.33, 0.52];

/// Largest difference of the control's accelerations from Maggi's at the same state, relative to the largest
/// of these. The control only says where it is: accelerations are differences of velocities.
fn defect(scene: &Scene, control: &mut Motion) -> f64 {
    const STEP: f64 = 1e-4;
    let mut maggi = Maggi::new(&scene.system).expect("differentiates");
    let mut worst = 0.0_f64;
    for part in TIMES {
        let t = control.start() + part * (control.end() - control.start());
        let [before, now, after] = [-STEP, 0.0, STEP].map(|s| at(control, t + s));
        let right = maggi.accelerations(t, &now.coordinates, &now.velocities).expect("regular");
        let size = right.iter().fold(1.0_f64, |m, a| m.max(a.abs()));
        let pairs = after.velocities.iter().zip(&before.velocities).zip(&right);
        worst = pairs.map(|((b, a), right)| ((b - a) / (2.0 * STEP) - right).abs() / size).fold(worst, f64::max);
    }
    worst
}

#[test]
fn control_is_flagged_wherever_it_is_wrong() {
    let mut right = Vec::new();
    for scene in scenes() {
        let run = substitution::run(&scene, &deltaq::choices(&scene), &Settings::default());
        let run = run.unwrap_or_else(|| panic!("{}: the control did not run", scene.name));
        let mut reference = chetaev(&scene);
        let mut control = run.outcome.unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        let defect = defect(&scene, &mut control);
        assert!(!(1e-6..1e-4).contains(&defect), "{}: cannot tell whether {defect:e} is zero", scene.name);
        let wrong = defect > 1e-4;
        let mut metric = Metric::new(&scene.system).expect("compiles");
        let gap = compare_motions(&mut control, &mut reference, &mut metric).expect("readable");
        println!(
            "{:<26} off Maggi's accelerations {defect:8.1e}, gap {:8.1e}: {:?} from {:?}",
            scene.name, gap.largest, gap.verdict, gap.certain_from
        );
        if wrong {
            assert_eq!(gap.verdict, Verdict::Different, "{}: wrong, and not noticed", scene.name);
        } else {
            right.push(scene.name.clone());
            complete(&scene, control);
            assert_eq!(gap.verdict, Verdict::Same, "{}: right, and not called so", scene.name);
        }
    }
    assert!(right.iter().any(|name| name == "bowl"), "bowl is not among {right:?}");
    assert!(right.len() < 5, "wrong on too few scenes: right on {right:?}");
}
