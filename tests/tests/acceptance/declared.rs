//! Declared time derivatives: series taken from those one order ahead are those of their own formulas.

use equations::{Compiled, Equations, Plan};
use motion::REDUCED_CHETAEV;
use proptest::{prop_assert, test_runner::TestCaseError};
use scene::Scene;
use scene::catalogue::trailer::Coordinates;

use super::chains::{hanging, train};
use super::reduced_form;
use super::support::{derived, for_all_linear, linear_scenes, must};

const ORDER: usize = 16;
/// Of time, in seconds.
const UNIT: f64 = 0.1;

/// Coefficients at the start, component after component, and products of series per order.
fn series(equations: &Equations, t: f64, y: &[f64]) -> Option<(Vec<f64>, usize)> {
    let plan = Plan::choose(equations, None).expect("a plan");
    let compiled = Compiled::with_plan(equations, &plan).expect("compiles");
    let mut compiled = compiled.with_series(equations, &plan).expect("compiles");
    let mut coefficients = vec![0.0; y.len() * (ORDER + 1)];
    compiled.taylor(t, y, UNIT, &mut coefficients).ok()?;
    Some((coefficients, compiled.cost_of_series().expect("series").0))
}

/// With declarations and without: of each order the largest difference relative to its largest coefficient,
/// and products; `None` where nothing can be expanded at the start.
fn by_order(scene: &Scene, declared: Equations) -> Option<(Vec<f64>, [usize; 2])> {
    let mut plain = declared.clone();
    plain.derivatives.clear();
    let y = reduced_form::states(scene, &declared);
    let [found, expected] = [declared, plain].map(|equations| series(&equations, scene.start.t, &y));
    let ((found, few), (expected, many)) = (found?, expected?);
    let of_order = |k: usize| found.iter().zip(&expected).skip(k).step_by(ORDER + 1);
    let size = |k: usize| of_order(k).fold(0.0_f64, |size, (_, x)| size.max(x.abs()));
    let differences = (1..=ORDER).map(|k| {
        // coefficients of a motion that is straight are round-off, of whatever order
        let size = size(k).max(1e-6 * size(1) * UNIT.powi(k as i32 - 1));
        let apart = of_order(k).map(|(a, b)| if a == b { 0.0 } else { ((a - b) / size).abs() });
        apart.max_by(f64::total_cmp).expect("states")
    });
    Some((differences.collect(), [few, many]))
}

/// The largest of all orders.
fn compare(scene: &Scene, declared: Equations) -> Option<(f64, [usize; 2])> {
    let (differences, products) = by_order(scene, declared)?;
    // what is not a number is the largest
    Some((differences.into_iter().max_by(f64::total_cmp).expect("orders"), products))
}

#[test]
fn trains_take_few_products() {
    // of 3 trailers, L is shorter as a chain, but not half as long
    for (scene, expected, undeclared) in [
        (train(3, Coordinates::Minimal), 10 * 3 + 4, 68),
        (train(7, Coordinates::Minimal), 10 * 7 + 4, 149),
        (train(20, Coordinates::Maximal), 12 * 20 + 4, 482),
    ] {
        let (apart, [few, many]) = compare(&scene, reduced_form::reduced(&scene)).expect("regular");
        assert!(few == expected && many >= undeclared, "{}: {few} of {many} products", scene.name);
        must(&format!("{}: with declarations", scene.name), apart, 1e-12);
    }
}

#[test]
fn series_of_every_scene_are_the_same() {
    let scenes = linear_scenes().into_iter().chain([hanging(8)]);
    let fewer = scenes.filter(|scene| {
        let (apart, [few, many]) = compare(scene, reduced_form::reduced(scene)).expect("regular");
        must(&format!("{}: {few} products of {many}", scene.name), apart, 1e-11);
        few < many
    });
    assert!(fewer.count() > 2, "declarations were used");
}

#[test]
fn series_of_random_systems_are_the_same() {
    let worst = std::cell::Cell::new((0.0_f64, 0, 0));
    for_all_linear(1909, |scene| {
        let equations = derived(scene, REDUCED_CHETAEV, None, Some(&scene.start));
        let equations = equations.map_err(|e| TestCaseError::fail(e.to_string()))?.leave_out_unneeded();
        let Some((apart, [few, many])) = by_order(scene, equations) else { return Ok(()) };
        // round-off of the recurrence is up to four times as large with each order
        let round_off = |(k, apart): (usize, &f64)| apart / (16.0 * f64::EPSILON * 4_f64.powi(k as i32 + 1));
        let most_here = apart.iter().enumerate().map(round_off).max_by(f64::total_cmp).expect("orders");
        let (most, used, all) = worst.get();
        worst.set((most.max(most_here), used + usize::from(few < many), all + 1));
        prop_assert!(most_here <= 1.0, "{apart:?}, {few} products of {many}\n{}", scene.to_toml());
        Ok(())
    });
    let (most, used, all) = worst.get();
    println!(
        "largest difference {most:.1e} of the round-off allowed on {all} systems, {used} of them with fewer products"
    );
    assert!(used > 10 && all > 200);
}
