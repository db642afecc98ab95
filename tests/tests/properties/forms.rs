//! The chosen form of the equations has the rates of the plain one.

use equations::{Compiled, Dynamics, Plan};
use motion::band::BEFORE_THE_END;
use motion::{Motion, REMOVED_CONSTRAINT, VAKONOMIC};
use proptest::test_runner::TestCaseError;
use random::{Case, Kind, Recipe, Which, recipes_of};
use reference::{DoubleDouble, Entry};
use symbolic::Scalar;

use super::support::for_all;

/// Instants of a motion at which rates are compared.
const INSTANTS: usize = 8;

/// Rounding errors on the way to a number, as a multiple of ε times what is added up to it.
const OF_TERMS: f64 = 4.0;

/// That of the judge, as a part of the largest of what is added up.
const ROUND_OFF_OF_JUDGE: f64 = 1e-30;

/// What the comparison along a motion found.
struct Found {
    /// Largest error of a rate or multiplier, in either form, over what round-off allows.
    worst: f64,
    /// Blocks that are solved numerically all the same.
    left: usize,
}

/// Compares rates and outputs of the form chosen at the start and of the plain one with those in
/// double-double arithmetic; `None` if not linear.
///
/// What is allowed is what [`Compiled::terms_of_evaluation`] says: of block, rates and outputs.
fn compare(motion: &mut Motion) -> Option<Found> {
    let equations = motion.equations.clone();
    let constants = motion.constants.clone();
    let mut plain = Compiled::plain(&equations).expect("compiles");
    if plain.needs_guess() {
        return None;
    }
    let inputs = |t: f64, y: &[f64]| [&[t], y, &constants].concat();
    let start = motion.start();
    let form = Plan::eliminated(&equations, Some(&inputs(start, &motion.states_at(start).expect("readable"))))
        .expect("compiles");
    let mut chosen = Compiled::with_plan(&equations, &form).expect("compiles");
    plain.set_constants(&constants);
    chosen.set_constants(&constants);
    let (free, parameters) = equations.free_parameters();
    let mut exact = Dynamics::new(&free).expect("compiles");
    let wide = |x: &f64| DoubleDouble::from_f64(*x);
    exact.set_constants(&constants.iter().chain(&parameters).map(wide).collect::<Vec<_>>());
    let (first, count) = (2 * free.coordinates.len(), free.multipliers.len());
    let mut worst = 0.0_f64;
    // where a motion stops before a singularity, the plain form may be singular to round-off
    let part = if motion.is_complete() { 1.0 } else { BEFORE_THE_END };
    let until = start + part * (motion.end() - start);
    for t in motion.grid(INSTANTS).into_iter().filter(|t| *t <= until) {
        let y = motion.states_at(t).expect("readable");
        exact.solve(wide(&t), &y.iter().map(wide).collect::<Vec<_>>()).expect("regular");
        let mut rates = exact.rates().to_vec();
        rates.extend(&exact.outputs()[first..first + count]);
        let outputs = [&mut chosen, &mut plain].map(|form| {
            let terms = form.terms_of_evaluation(t, &y).expect("regular");
            let largest = terms.iter().fold(0.0_f64, |a, x| a.max(*x));
            let mut found = vec![0.0; y.len()];
            form.rates(t, &y, &mut found).expect("regular");
            let outputs = form.outputs(t, &y).expect("regular");
            found.extend(&outputs.multipliers);
            for ((x, exact), terms) in found.iter().zip(&rates).zip(&terms) {
                let error = (DoubleDouble::from_f64(*x) - *exact).to_f64().abs();
                let allowed = OF_TERMS * f64::EPSILON * terms + ROUND_OFF_OF_JUDGE * largest;
                worst = worst.max(if error == 0.0 { 0.0 } else { error / allowed });
                assert!(!error.is_nan(), "at {t}");
            }
            outputs
        });
        assert_eq!(outputs[0].coordinates, outputs[1].coordinates);
    }
    Some(Found { worst, left: form.left.len() })
}

#[test]
fn rates_of_the_chosen_form_are_those_of_the_plain_one_on_random_systems() {
    for_all(96, &recipes_of(&Kind::ALL), |recipe: Recipe| {
        let mut case = Case::new(recipe, "random").map_err(|e| TestCaseError::fail(e.to_string()))?;
        let removed: Vec<Which> = (0..case.removed.len()).map(Which::Removed).collect();
        for which in [Which::Chetaev, Which::Vakonomic].into_iter().chain(removed) {
            let Some(found) = compare(case.motion(which)) else { continue };
            if found.worst.is_nan() || found.worst > 1.0 {
                let words = format!("{which:?}: {:.1e} times round-off\n{}", found.worst, case.scene.to_toml());
                return Err(TestCaseError::fail(words));
            }
        }
        Ok(())
    });
}

/// Blocks as the formulation derives them: those in quasi-velocities are of intermediate quantities.
fn as_derived() -> motion::Settings {
    motion::Settings { form: motion::Form::Named, ..motion::Settings::default() }
}

#[test]
fn scenes_need_no_factorization_and_have_the_rates_of_the_plain_form() {
    let mut count = 0;
    for (name, text) in scene::catalogue::SCENES {
        let scene = scene::Scene::parse(name, text).expect("a scene");
        for choice in motion::choices(&scene) {
            let Ok(mut motion) = motion::solve_choice(&scene, &choice, &as_derived()) else { continue };
            let Some(found) = compare(&mut motion) else { continue };
            assert!(found.worst <= 1.0, "{name}, {}: {:.1e}", choice.label, found.worst);
            assert_eq!(found.left, 0, "{name}, {}: a block is left", choice.label);
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

#[test]
fn motions_on_which_pivots_go_through_zero_are_those_of_the_plain_form() {
    for (name, formulation) in [("trailer", VAKONOMIC), ("ball-in-cone", REMOVED_CONSTRAINT)] {
        let scene = scene::catalogue::find(name, &[]).expect("a scene");
        let choices = motion::choices(&scene);
        let choice = choices.iter().find(|c| c.formulation == formulation).expect("a choice");
        let many_steps = motion::Settings { method: Some(integrate::Method::Dop853), ..as_derived() };
        let mut motion = motion::solve_choice(&scene, choice, &many_steps).expect("a motion");
        let (evaluations, fallbacks) = (motion.work.evaluations, motion.form.fallbacks);
        assert!(fallbacks > 0 && 20 * fallbacks < evaluations, "{name}: {fallbacks} of {evaluations}");
        let plain = motion::Settings { tolerance: 1e-11, plain: true, ..as_derived() };
        let mut plain = motion::solve_choice(&scene, choice, &plain).expect("a motion");
        for t in motion.grid(20) {
            let other = plain.at(t).expect("readable").coordinates;
            let allowed = motion.difference_of_runs(t).expect("readable").iter().fold(1e-11_f64, |a, d| a.max(d.abs()));
            let ours = motion.at(t).expect("readable").coordinates;
            let gap = ours.iter().zip(&other).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
            assert!(gap <= allowed, "{name} at {t}: {gap:.1e}, allowed {allowed:.1e}");
        }
    }
}
