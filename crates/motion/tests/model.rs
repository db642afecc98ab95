//! A motion as a function of numbers: against a closed form and differences, and what is no motion.

use integrate::Method;
use mechanics::ConstantsRule;
use motion::{CHETAEV, Choice, Model, Settings, SolveError, VAKONOMIC};

use crate::ends::built_in;
use crate::support::choice;

/// x of Chetaev's sledge, which turns at the rate ω and runs at u = u₀ + (a/ω)(sin φ − sin φ₀): with
/// c = (sin φ − sin φ₀)/ω it is u₀ c + a c²/2, a = g sin α.
fn x(g: f64, omega: f64, t: f64) -> f64 {
    let (phi, speed) = (0.3_f64, 0.5);
    let c = ((phi + omega * t).sin() - phi.sin()) / omega;
    speed * c + 0.5 * g * 0.4_f64.sin() * c * c
}

#[test]
fn chetaevs_sledge_has_its_closed_form_at_any_numbers() {
    let scene = built_in("sledge");
    let times = [0.0, 1.0, 2.5];
    for method in [None, Some(Method::Dop853)] {
        let settings = Settings { method, ..Settings::default() };
        let mut model =
            Model::new(&scene, &choice(&scene, CHETAEV), &["phi'", "g"], &times, &settings).expect("a model");
        assert_eq!((model.names(), model.times()), (&["phi'".to_string(), "g".to_string()][..], &times[..]));
        for (omega, g) in [(1.1, 9.81), (0.7, 3.0), (-1.5, 1.6)] {
            let (found, plain) = (model.derivatives(&[omega, g]), model.outputs(&[omega, g]));
            assert_eq!((found.ended.as_deref(), plain.derivatives.len()), (None, 0));
            for (i, t) in times.into_iter().enumerate() {
                let (h, outputs) = (1e-4, &found.outputs[i]);
                assert!((outputs.coordinates[0] - x(g, omega, t)).abs() < 1e-9);
                assert!((outputs.coordinates[0] - plain.outputs[i].coordinates[0]).abs() < 1e-9);
                let by_omega = (x(g, omega + h, t) - x(g, omega - h, t)) / (2.0 * h);
                let by_g = (x(g + h, omega, t) - x(g - h, omega, t)) / (2.0 * h);
                for (derivative, expected) in found.derivatives[i].iter().zip([by_omega, by_g]) {
                    assert!((derivative.coordinates[0] - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{t}");
                }
            }
        }
    }
}

#[test]
fn no_numbers_are_an_error() {
    let scene = built_in("sledge");
    let given = Choice { constants: ConstantsRule::Given(vec![0.2]), ..choice(&scene, VAKONOMIC) };
    let settings = Settings { max_steps: 40, ..Settings::default() };
    let mut model = Model::new(&scene, &given, &["g", "mu0_1"], &[0.1, 1.0], &settings).expect("a model");
    for (row, words) in [([f64::NAN, 0.0], "g is NaN; it must be finite"), ([1e12, 1e9], "more than 40 steps")] {
        for found in [model.outputs(&row), model.derivatives(&row)] {
            assert!(found.ended.as_ref().is_some_and(|ended| ended.contains(words)), "{found:?}");
            assert!(found.outputs.len() < 2);
        }
    }
    // and the next ones are as if there had been none before
    let fresh =
        Model::new(&scene, &given, &["g", "mu0_1"], &[0.1, 1.0], &settings).expect("a model").outputs(&[9.0, 0.1]);
    assert_eq!(model.outputs(&[9.0, 0.1]).outputs[1].coordinates, fresh.outputs[1].coordinates);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let scene = built_in("sledge");
    let natural = Choice { constants: ConstantsRule::Natural { horizon: 10.0 }, ..choice(&scene, VAKONOMIC) };
    let refused = |choice: &Choice, times: &[f64], method: Option<Method>| {
        let settings = Settings { method, ..Settings::default() };
        match Model::new(&scene, choice, &["g"], times, &settings) {
            Err(SolveError::Member { reason }) => reason,
            other => panic!("{:?}", other.err()),
        }
    };
    let usual = choice(&scene, CHETAEV);
    assert!(refused(&usual, &[], None).contains("times have to begin at the start 0.0"));
    assert!(refused(&usual, &[0.0], None).contains("and to end after it"));
    assert!(refused(&usual, &[2.0, 1.0], None).contains("2.0 comes before 1.0"));
    assert!(refused(&natural, &[1.0], None).contains("natural at a horizon"));
    assert!(refused(&usual, &[1.0], Some(Method::Radau5)).contains("not by radau5"));
}
