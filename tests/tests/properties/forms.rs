//! The chosen form of the equations has the rates of the plain one.

use deltaq::{Motion, REMOVED_CONSTRAINT, VAKONOMIC};
use equations::{Compiled, Equations, Plan};
use nalgebra::DMatrix;
use proptest::test_runner::TestCaseError;
use random::{Case, Kind, Recipe, Which, recipes_of};
use symbolic::{Bounded, Scalar};

use super::support::for_all;

/// Instants of a motion at which rates are compared.
const INSTANTS: usize = 8;

/// Round-off over the condition of the block, relative to the largest unknown.
const ROUND_OFF: f64 = 2e-14;

/// Largest condition number of blocks at `inputs = (t, y, constants)`, rows and columns scaled, times what
/// added up to an entry: forms add in different orders, and cancelling entries differ by that round-off.
fn condition(equations: &Equations, inputs: &[f64]) -> f64 {
    let g = &equations.graph;
    let mut largest = 1.0_f64;
    for block in &equations.blocks {
        let n = block.unknowns.len();
        let jacobian = g.jacobian(&block.residuals, &block.unknowns);
        let tape = g.compile(&equations.known_symbols(), jacobian.entries(), &equations.parameters).expect("linear");
        let inputs: Vec<Bounded> = inputs.iter().map(|&x| Bounded::from_f64(x)).collect();
        let mut values = vec![Bounded::from_f64(0.0); n * n];
        tape.evaluate(&inputs, &mut tape.workspace(), &mut values);
        let mut matrix = DMatrix::from_fn(n, n, |i, j| values[i * n + j].value);
        let mut added_up = DMatrix::from_fn(n, n, |i, j| values[i * n + j].magnitude);
        for (mut c, mut a) in matrix.column_iter_mut().zip(added_up.column_iter_mut()) {
            a /= c.amax();
            c /= c.amax();
        }
        for (mut r, mut a) in matrix.row_iter_mut().zip(added_up.row_iter_mut()) {
            a /= r.amax();
            r /= r.amax();
        }
        let singular = matrix.singular_values();
        largest = largest.max(added_up.amax().max(1.0) * singular[0] / singular[n - 1]);
    }
    largest
}

/// What the comparison along a motion found.
struct Found {
    /// Largest difference over what round-off allows.
    worst: f64,
    /// Blocks that are solved numerically all the same.
    left: usize,
}

/// Compares rates and outputs of the form chosen at the start and the plain one; `None` if not linear.
fn compare(motion: &mut Motion) -> Option<Found> {
    let equations = motion.equations.clone();
    let constants = motion.constants.clone();
    let mut plain = Compiled::plain(&equations).expect("compiles");
    if plain.needs_guess() {
        return None;
    }
    let inputs = |t: f64, y: &[f64]| [&[t], y, &constants].concat();
    let start = motion.start();
    let form =
        Plan::choose(&equations, Some(&inputs(start, &motion.states_at(start).expect("readable")))).expect("compiles");
    let mut chosen = Compiled::with_plan(&equations, &form).expect("compiles");
    plain.set_constants(&constants);
    chosen.set_constants(&constants);
    let mut worst = 0.0_f64;
    for t in motion.grid(INSTANTS) {
        let y = motion.states_at(t).expect("readable");
        let mut rates = [vec![0.0; y.len()], vec![0.0; y.len()]];
        chosen.rates(t, &y, &mut rates[0]).expect("regular");
        plain.rates(t, &y, &mut rates[1]).expect("regular");
        let outputs = [&mut chosen, &mut plain].map(|c| c.outputs(t, &y).expect("regular"));
        let unknowns = plain.settle(t, &y).expect("regular");
        let largest = |list: &[f64]| list.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let size = 1.0 + largest(unknowns) + largest(&rates[1]);
        let [mut one, mut two] = rates;
        one.extend(&outputs[0].multipliers);
        two.extend(&outputs[1].multipliers);
        assert_eq!(outputs[0].coordinates, outputs[1].coordinates);
        let difference = one.iter().zip(&two).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
        worst = worst.max(difference / (ROUND_OFF * condition(&equations, &inputs(t, &y)) * size));
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
fn as_derived() -> deltaq::Settings {
    deltaq::Settings { form: deltaq::Form::Named, ..deltaq::Settings::default() }
}

#[test]
fn scenes_need_no_factorization_and_have_the_rates_of_the_plain_form() {
    let mut count = 0;
    for (name, text) in catalogue::SCENES {
        let scene = scene::Scene::parse(name, text).expect("a scene");
        for choice in deltaq::choices(&scene) {
            let Ok(mut motion) = deltaq::solve_choice(&scene, &choice, &as_derived()) else { continue };
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
        let scene = catalogue::find(name, &[]).expect("a scene");
        let choices = deltaq::choices(&scene);
        let choice = choices.iter().find(|c| c.formulation == formulation).expect("a choice");
        let many_steps = deltaq::Settings { method: Some(integrate::Method::Dop853), ..as_derived() };
        let mut motion = deltaq::solve_choice(&scene, choice, &many_steps).expect("a motion");
        let (evaluations, fallbacks) = (motion.work.evaluations, motion.form.fallbacks);
        assert!(fallbacks > 0 && 20 * fallbacks < evaluations, "{name}: {fallbacks} of {evaluations}");
        let plain = deltaq::Settings { tolerance: 1e-11, plain: true, ..as_derived() };
        let mut plain = deltaq::solve_choice(&scene, choice, &plain).expect("a motion");
        for t in motion.grid(20) {
            let other = plain.at(t).expect("readable").coordinates;
            let allowed = motion.difference_of_runs(t).expect("readable").iter().fold(1e-11_f64, |a, d| a.max(d.abs()));
            let ours = motion.at(t).expect("readable").coordinates;
            let gap = ours.iter().zip(&other).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
            assert!(gap <= allowed, "{name} at {t}: {gap:.1e}, allowed {allowed:.1e}");
        }
    }
}
