//! How vakonomic and Chetaev motions part: the predicted coefficient, seen without the fit of claim T5.

use comparison::{LeadingTerm, Pairing};
use motion::{choices, removals};
use scene::Scene;
use symbolic::Expr;

use super::support::{at, chetaev, falling_bicycle, must, scene, vakonomic};

fn leading_term(scene: &Scene, mu0: &[f64]) -> LeadingTerm {
    let choices = choices(scene);
    let pairing = Pairing::new(scene, &choices[0], &choices[1]).expect("affine in the multipliers");
    let predicted = pairing.leading_term(mu0).expect("compiles");
    predicted.unwrap_or_else(|| panic!("{}: nothing predicted", scene.name))
}

/// From three points of the motion only.
#[test]
fn leading_term_shows_without_a_fit() {
    let scene = scene("sledge", &[("duration", 0.1)]);
    for (mu0, exponent) in [(0.0, 3), (0.05, 2)] {
        let (mut one, mut two) = (chetaev(&scene), vakonomic(&scene, &[mu0]));
        let predicted = leading_term(&scene, &[mu0]);
        let mut ratio = |t: f64| -> Vec<f64> {
            let (a, b) = (at(&mut one, t).coordinates, at(&mut two, t).coordinates);
            b.iter().zip(&a).map(|(b, a)| (b - a) / t.powi(exponent)).collect()
        };
        // c + c₁ t + c₂ t² from t, 2t and 4t
        let (near, middle, far) = (ratio(0.005), ratio(0.01), ratio(0.02));
        let size = predicted.coefficient.iter().fold(0.0_f64, |a, c| a.max(c.abs()));
        for (i, c) in predicted.coefficient.iter().enumerate() {
            must(
                &format!("sledge, μ₀ = {mu0}: coefficient {i} of t^{exponent}, three points"),
                ((8.0 * near[i] - 6.0 * middle[i] + far[i]) / 3.0 - c).abs() / size,
                0.01,
            );
        }
    }
}

/// Supplied velocities are zero up to round-off only, and so is what would be the coefficient of t².
#[test]
fn round_off_predicts_nothing() {
    let bicycle = falling_bicycle();
    assert_eq!(leading_term(&bicycle, &[0.0; 5]).exponent, 3);
}

/// Denominators are cleared where that is short: of all of a bicycle's it made fourteen thousand operations.
#[test]
fn removals_of_a_bicycle_are_short() {
    let bicycle = falling_bicycle();
    for removal in removals(&bicycle).expect("linear constraints") {
        let rates: Vec<Expr> = removal.memory.iter().map(|w| w.rate).collect();
        let size = bicycle.system.graph.size(&rates);
        assert!(size < 1000, "{}: {size}", removal.name);
    }
}
