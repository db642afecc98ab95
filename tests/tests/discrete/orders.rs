//! Orders of discrete principles and compositions: error against step, above the plateau of round-off.

use bench::exponent;
use discrete::Composition;
use equations::Formulation;
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Choice, Motion, REMOVED_CONSTRAINT, Settings, Steps, VAKONOMIC, choices, solve_by_steps, solve_choice,
};
use scene::Scene;
use scene::catalogue::find;

/// Errors under this times the size of the motion are round-off; over [`COARSE`] they tell no order yet.
const PLATEAU: f64 = 2e-13;
const COARSE: f64 = 1e-4;

/// Steps of the longest grid.
const STEPS: f64 = 4.0;

/// Grids; each step is 2^(1/4) times shorter than the one before.
const GRIDS: u32 = 48;

/// Number of grids that give the slope: the finest above the plateau.
const POINTS: usize = 3;

fn choice(scene: &Scene, formulation: &Formulation, constants: Option<Vec<f64>>) -> Choice {
    let found = choices(scene).into_iter().find(|c| c.formulation == formulation).expect("a formulation");
    let constants = constants.map_or(found.constants.clone(), ConstantsRule::Given);
    Choice { constants, ..found }
}

fn end_of(mut motion: Motion, t: f64) -> Vec<f64> {
    assert!(motion.is_complete(), "{:?}", motion.ending);
    let now = motion.at(t).unwrap();
    [now.coordinates, now.velocities].concat()
}

fn measure(scene: &Scene, choice: &Choice, composition: Composition) {
    let end = scene.start.t + scene.duration;
    let settings = Settings { tolerance: 1e-13, ..Settings::default() };
    let reference = end_of(solve_choice(scene, choice, &settings).unwrap(), end);
    let size = reference.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
    let mut points = Vec::new();
    for k in 0..GRIDS {
        let count = (STEPS * f64::from(k).mul_add(0.25, 0.0).exp2()).round();
        let step = scene.duration / count;
        // a step that is too long is refused
        let Ok(motion) = solve_by_steps(scene, choice, Steps { step, composition }, &settings) else { continue };
        if !motion.is_complete() {
            continue;
        }
        let found = end_of(motion, end);
        let error = found.iter().zip(&reference).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size;
        if error < PLATEAU {
            break;
        }
        if error < COARSE {
            points.push((step, error));
        }
        if count > 3000.0 {
            break;
        }
    }
    let what = format!("{}, {}, order {}", scene.name, choice.label, composition.order());
    let last = &points[points.len().saturating_sub(POINTS)..];
    assert!(last.len() == POINTS, "{what}: {points:?}");
    let (order, nominal) = (exponent(last).expect("three points").value, f64::from(composition.order()));
    let (first, end) = (last[0], last[POINTS - 1]);
    println!("{what}: {order:.3}, from {:.1e} at h = {:.4} to {:.1e} at h = {:.4}", first.1, first.0, end.1, end.0);
    let limit = if nominal < 8.0 { 0.1 } else { 0.3 };
    assert!((order - nominal).abs() < limit, "{what}: {order}; {points:?}");
}

fn measure_all(name: &str, duration: f64, formulation: &Formulation, constants: Option<Vec<f64>>) {
    let mut scene = find(name, &[]).unwrap();
    scene.duration = duration;
    let choice = choice(&scene, formulation, constants);
    for composition in Composition::ALL {
        measure(&scene, &choice, composition);
    }
}

#[test]
fn chetaev_has_its_orders() {
    measure_all("sledge", 2.0, CHETAEV, None);
    measure_all("ball-in-cone", 0.2, CHETAEV, None);
    measure_all("particle", 4.0, CHETAEV, None);
    // a nonlinear constraint, in the potential −x y, so that the run bends
    let mut hamel = find("appell-hamel", &[("duration".into(), 0.5.into())]).unwrap();
    let bend = hamel.system.expression("x*y").unwrap();
    hamel.system.lagrangian = hamel.system.graph.add(hamel.system.lagrangian, bend);
    let choice = choice(&hamel, CHETAEV, None);
    // of higher orders four steps leave round-off only
    [Composition::Second, Composition::Fourth]
        .into_iter()
        .for_each(|composition| measure(&hamel, &choice, composition));
}

#[test]
fn vakonomic_has_its_orders() {
    measure_all("sledge", 2.0, VAKONOMIC, Some(vec![0.5]));
    measure_all("ball-in-cone", 0.2, VAKONOMIC, Some(vec![0.2, -0.1]));
    measure_all("particle", 4.0, VAKONOMIC, Some(vec![0.7]));
}

#[test]
fn removed_constraint_has_its_orders() {
    measure_all("sledge", 2.0, REMOVED_CONSTRAINT, Some(vec![2.0]));
    measure_all("ball-in-cone", 0.2, REMOVED_CONSTRAINT, Some(vec![0.3]));
}
