//! Tails of distributions by tables, and tests on residuals by hand.

use fit::{Deviations, Film, Residual, chi_squared_tail, normal_tails, residual_tests, runs, whiteness};

use crate::films::built_in;
use crate::noise::Noise;

/// SciPy 1.17: `chi2.sf`, `2*norm.sf`.
#[test]
fn tails_are_those_of_tables() {
    for (x, k, known) in TAILS {
        let found = chi_squared_tail(x, k);
        assert!((found / known - 1.0).abs() < 1e-11, "{x}, {k}: {found} for {known}");
    }
    assert!((normal_tails(1.959_963_984_540_054) - 0.05).abs() < 1e-13);
    assert_eq!((chi_squared_tail(0.0, 3.0), chi_squared_tail(-1.0, 3.0)), (1.0, 1.0));
}

const TAILS: [(f64, f64, f64); 7] = [
    (0.5, 1.0, 0.47950012218695337),
    (30.0, 1.0, 4.3204630578274955e-08),
    (7.0, 4.0, 0.13588822540043327),
    (100.0, 10.0, 5.4497019829205215e-17),
    (590.0, 600.0, 0.6068126559479526),
    (750.0, 600.0, 2.7525003741109153e-05),
    (1200.0, 1190.0, 0.41368923983072176),
];

/// By hand: + + − − + − has 4 runs; 3 above of 6: 4 expected.
#[test]
fn runs_and_correlations_by_hand() {
    let (found, expected, probability) = runs(&[1.0, 2.0, -1.0, -1.0, 3.0, -2.0]);
    assert_eq!((found, expected), (4.0, 4.0));
    assert!((probability - 1.0).abs() < 1e-12);
    // one sign only
    assert_eq!(runs(&[1.0; 12]), (1.0, 1.0, 2.0 * 0.5_f64.powi(12)));
    // ρ₁ of 1, −1, 1, −1 is −3/4: Q = 4·6·(9/16)/3
    let (found, lags, _) = whiteness(&[1.0, -1.0, 1.0, -1.0]);
    assert!((found - 4.5).abs() < 1e-12 && lags == 1.0);
}

/// Tests on noise object to one film in a thousand, among twenty and thirty samples too, where Q is not χ².
#[test]
fn tests_on_few_residuals_object_as_rarely_as_they_say() {
    let (scene, films) = (built_in("heisenberg"), 6000);
    for samples in [20, 30] {
        let table: String = (1..=samples).map(|k| format!("{k},0\n")).collect();
        let deviations = Deviations { others: Some(1.0), ..Deviations::default() };
        let film = Film::read(&scene, "film", &format!("t,x\n{table}"), &deviations).unwrap();
        let mut noise = Noise(samples);
        let mut objects = || {
            let residual = |(line, &t): (usize, &f64)| Residual { film: 0, column: 0, line, t, value: noise.normal() };
            let residuals: Vec<Residual> = film.t.iter().enumerate().map(residual).collect();
            residual_tests(&[&film], &residuals, 0, false).iter().any(|test| test.objects)
        };
        let found = (0..films).filter(|_| objects()).count();
        // six are expected; more than fifteen in one of two thousand
        assert!(found <= 15, "{samples}: {found}");
    }
}
