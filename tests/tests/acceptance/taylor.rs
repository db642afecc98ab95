//! Taylor series of motions: their slope against the rates, and whole motions against DOP853.

use equations::Equations;
use integrate::{Method, Projection};
use mechanics::ConstantsRule;
use motion::{CHETAEV, Settings, VAKONOMIC};
use scene::Scene;

use super::support::{all_equations, equations, known_gap, motion_of, must, scenes, some_multipliers};

const ORDER: usize = 24;

/// The series at the start to order 24, and how far its slope is from the rates at `h = 0.1 ‖y‖/‖y'‖` (less
/// where it converges less fast), over the size of the rates: what is left out there is smaller than 1e-10.
fn defect(scene: &Scene, equations: Equations, constants: &[f64]) -> f64 {
    let settings = Settings { method: Some(Method::Taylor), ..Settings::default() };
    let rule = ConstantsRule::Given(constants.to_vec());
    let name = equations.formulation;
    let ready = motion::prepare(motion::setting(scene), equations, &rule, &settings);
    let mut ready = ready.unwrap_or_else(|e| panic!("{}, {name}: {e}", scene.name));
    let (t, n) = (scene.start.t, ready.start.len());
    let mut c = vec![0.0; (ORDER + 1) * n];
    ready.compiled.taylor(t, &ready.start, 1.0, &mut c).unwrap_or_else(|e| panic!("{}, {name}: {e}", scene.name));
    let size = |k: usize| c.iter().skip(k).step_by(ORDER + 1).fold(0.0_f64, |a, x| a.max(x.abs()));
    let mut h = 0.1 * size(0) / size(1).max(1e-3);
    for k in ORDER - 3..=ORDER {
        h = h.min((1e-12 * size(0) / size(k).max(1e-300)).powf(1.0 / k as f64));
    }
    let mut worst = 0.0_f64;
    for h in [h, -h] {
        let y: Vec<f64> = c.chunks_exact(ORDER + 1).map(|row| row.iter().rev().fold(0.0, |s, c| c + h * s)).collect();
        let mut rates = vec![0.0; n];
        ready.compiled.rates(t + h, &y, &mut rates).unwrap_or_else(|e| panic!("{}, {name}: {e}", scene.name));
        let size = rates.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
        for (row, rate) in c.chunks_exact(ORDER + 1).zip(&rates) {
            let slope = (1..=ORDER).rev().fold(0.0, |s, k| k as f64 * row[k] + h * s);
            worst = worst.max((slope - rate).abs() / size);
        }
    }
    worst
}

#[test]
fn the_series_of_every_formulation_satisfies_its_equations_on_every_scene() {
    let mut count = 0;
    for scene in scenes() {
        for (name, equations, constants) in all_equations(&scene) {
            let defect = defect(&scene, equations, &constants);
            must(&format!("{}, {name}: slope of the series", scene.name), defect, 1e-10);
            count += 1;
        }
    }
    assert!(count > 3 * scenes().len(), "{count}");
}

#[test]
fn motions_are_those_of_dop853() {
    for scene in scenes() {
        let mu0 = some_multipliers(&scene);
        for (name, constants) in [(CHETAEV, &[][..]), (VAKONOMIC, &mu0)] {
            for projection in [Projection::EveryStep, Projection::Off] {
                let run = |method| {
                    let settings =
                        Settings { method: Some(method), projection, tolerance: 1e-10, ..Settings::default() };
                    motion_of(&scene, equations(&scene.system, name, None), constants, &settings)
                };
                let (mut taylor, mut reference) = (run(Method::Taylor), run(Method::Dop853));
                assert_eq!(
                    taylor.is_complete(),
                    reference.is_complete(),
                    "{}, {name:?}: {:?}",
                    scene.name,
                    taylor.ending
                );
                let (gap, end) = known_gap(&mut taylor, &mut reference);
                println!("{}, {name:?}: {} and {} steps to {end}", scene.name, taylor.work.steps, reference.work.steps);
                must(&format!("{}, {name:?}, {projection:?}: Taylor against DOP853", scene.name), gap, 1e-9);
            }
        }
    }
}
