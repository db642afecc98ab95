//! Motions, decisions, proofs and Frobenius' test on random systems, side by side as `compare` has them.

use comparison::compare_unfitted;
use motion::{Settings, choices};
use proptest::test_runner::TestCaseError;
use random::{Kind, Recipe, recipes_of};

use super::support::for_all;

/// Steps after which a run is given up.
const MAX_STEPS: usize = 3_000;

#[test]
fn no_result_contradicts_another() {
    for_all(64, &recipes_of(&Kind::ALL), |recipe: Recipe| {
        let scene = recipe.scene("contradiction");
        let text = scene.to_toml();
        let (choices, settings) = (choices(&scene), Settings { max_steps: MAX_STEPS, ..Settings::default() });
        let fail = |reason: String| TestCaseError::fail(format!("{reason}\n{text}"));
        let comparison = compare_unfitted(scene, choices, Vec::new(), &settings).map_err(|e| fail(e.to_string()))?;
        comparison.is_sound().map_err(|contradicted| fail(contradicted.to_string()))
    });
}
