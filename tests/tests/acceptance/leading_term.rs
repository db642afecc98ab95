//! How vakonomic and Chetaev motions part: exponent and leading coefficient, measured and predicted (T5).

use deltaq::{LeadingTerm, Metric, Pairing, choices, compare_motions, growth};
use scene::Scene;

use super::support::{at, chetaev, must, scene, vakonomic};

fn leading_term(scene: &Scene, mu0: &[f64]) -> LeadingTerm {
    let choices = choices(scene);
    let pairing = Pairing::new(scene, &choices[0], &choices[1]).expect("affine in the multipliers");
    let predicted = pairing.leading_term(mu0).expect("compiles");
    predicted.unwrap_or_else(|| panic!("{}: nothing predicted", scene.name))
}

#[test]
fn leading_term_is_the_predicted_one() {
    for name in ["sledge", "disc", "ball-in-cone"] {
        let scene = scene(name, &[]);
        let h = scene.system.constraints.len();
        // 0.05: the terms of second and third order are of one size within the first tenth of a second
        for (mu0, exponent) in [(vec![0.0; h], 3), (vec![1.0; h], 2), (vec![0.05; h], 2)] {
            let mut reference = chetaev(&scene);
            let predicted = leading_term(&scene, &mu0);
            assert_eq!(predicted.exponent, exponent, "{name}, μ₀ = {mu0:?}");
            let mut other = vakonomic(&scene, &mu0);
            let mut metric = Metric::new(&scene.system).expect("compiles");
            let gap = compare_motions(&mut reference, &mut other, &mut metric).expect("readable");
            let limit = |t: f64| gap.limit_at(t);
            let measured = growth(&mut other, &mut reference, &mut metric, &limit).expect("readable");
            let measured = measured.unwrap_or_else(|| panic!("{name}, μ₀ = {mu0:?}: no growth measured"));
            println!(
                "{name}, μ₀ = {mu0:?}: exponent {:.4}, length {:.6e}, predicted {:.6e}, fitted over {:.1e} to {:.1e} s",
                measured.exponent, measured.length, predicted.length, measured.from, measured.to
            );
            must(&format!("{name}, exponent − {exponent}"), (measured.exponent - f64::from(exponent)).abs(), 0.02);
            must(&format!("{name}, leading coefficient of t^{exponent}"), measured.deviation_from(&predicted), 0.01);
        }
    }
}

/// The same coefficient from three points of the motion only, without the fit.
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
