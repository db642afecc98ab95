//! The search for the least minimum: where a shorter one fails, and what intervals and rows owe to it.

use fit::{Film, Problem, Question, Row, Unknown, Verdict, fit_formulations};
use mechanics::ConstantsRule;
use motion::{CHETAEV, Choice, Settings, VAKONOMIC, choices, solve_choice};
use scene::Scene;

use crate::films::{film, fitted_by};

const TABLE: [&str; 6] = ["x", "y", "x'", "y'", "Omega", "psi'"];
/// Start, table and μ₀ of a ball of 2 cm: over the first third of a second other values fit as well.
const TRUTH: [f64; 8] = [0.0634, -0.0011, 0.0108, 0.0491, 3.03, 0.7763, -0.0013, 0.0435];

fn small_ball() -> Scene {
    let at = |name: &str, x: f64| (name.to_string(), x.into());
    let numbers = [at("a", 0.02), at("Omega", 3.0), at("c", 0.0667), at("x", 0.0667), at("psi'", 0.0)];
    scene::catalogue::find("turntable", &numbers).unwrap_or_else(|error| panic!("{error}"))
}

fn small_ball_film(seed: u64) -> (Scene, Film) {
    let names = TABLE.iter().zip(TRUTH).map(|(name, x)| (name.to_string(), x.into()));
    // the motion is violent: nothing behind the film is integrated
    let known = [("a".to_string(), 0.02.into()), ("duration".to_string(), 2.0.into())];
    let numbers: Vec<_> = known.into_iter().chain(names).collect();
    let scene = scene::catalogue::find("turntable", &numbers).unwrap_or_else(|error| panic!("{error}"));
    let vakonomic = choices(&scene).into_iter().find(|c| c.formulation == VAKONOMIC).unwrap();
    let constants = ConstantsRule::Given(TRUTH[6..].to_vec());
    let mut motion = solve_choice(&scene, &Choice { constants, ..vakonomic }, &Settings::default()).unwrap();
    let times: Vec<f64> = (1..=120).map(|k| f64::from(k) / 60.0).collect();
    let path: Vec<Vec<f64>> = times.iter().map(|t| motion.at(*t).unwrap().coordinates[..2].to_vec()).collect();
    let scene = small_ball();
    let film = film(&scene, "x,y", 5e-4, seed, &times, |t| path[(t * 60.0).round() as usize - 1].clone());
    (scene, film)
}

/// The row of the vakonomic formulation, without the others.
fn vakonomic(scene: &Scene, film: &Film) -> Row {
    fitted_by(&[VAKONOMIC], scene, std::slice::from_ref(film), &TABLE, &[]).remove(0)
}

/// Where the four of least χ² are followed from the first beginning none leads there, for this film. What is
/// found has the intervals that it should have.
#[test]
fn starts_that_a_beginning_cannot_tell_apart_are_followed() {
    let (scene, film) = small_ball_film(5);
    let row = vakonomic(&scene, &film);
    assert_eq!(row.verdict, Verdict::Supported);
    let fit = row.fit.as_ref().unwrap();
    assert!(fit.chi_squared < fit.freedom as f64 + 4.0 * (2.0 * fit.freedom as f64).sqrt());
    assert!((1..=fit.starts).contains(&fit.reached) && fit.minima[0] == fit.chi_squared);
    for (estimate, truth) in fit.estimates.iter().zip(TRUTH) {
        assert!((estimate.value - truth).abs() < 4.5 * estimate.error, "{truth} in {estimate:?}");
    }
    intervals_end_where_searches_with_that_number_held_say(&scene, &film, &row);
}

/// At the ends of intervals of 95 % the least χ² of the others is higher by 3.84: by searches with that
/// number held, each from where the one before came to, which was a fifth nearer to the minimum.
fn intervals_end_where_searches_with_that_number_held_say(scene: &Scene, film: &Film, row: &Row) {
    let found = row.fit.as_ref().unwrap();
    let settings = Settings { tolerance: 1e-9, ..Settings::default() };
    let (place, name) = (3, TABLE[3]);
    let estimate = &found.estimates[place];
    assert!(estimate.profiled, "{estimate:?}");
    for end in estimate.interval {
        let mut fit = found.clone();
        for part in (1..=5).map(|k| 0.2 * f64::from(k)) {
            let known = (name.to_string(), estimate.value + part * (end - estimate.value));
            let film = Film { known: vec![known], ..film.clone() };
            let others = fit.estimates.iter().filter(|e| e.name != name);
            let others: Vec<Unknown> = others.map(|e| format!("{}~{:e}", e.name, e.value).parse().unwrap()).collect();
            let problem = Problem::new(scene, &row.choice, &[film], &others, &settings).unwrap();
            fit = fit::fit(&problem, &|_| false, 1, true).unwrap();
        }
        let rise = fit.chi_squared - found.chi_squared;
        assert!((rise - 3.84).abs() < 0.06 * 3.84, "{rise} at {end} of {estimate:?}");
    }
}

/// Rows are fitted over threads: each is what it is alone.
#[test]
fn rows_do_not_depend_on_those_beside_them() {
    let (scene, film) = small_ball_film(2);
    let unknowns: Vec<Unknown> = TABLE.iter().map(|name| name.parse().unwrap()).collect();
    let settings = Settings { tolerance: 1e-9, ..Settings::default() };
    let question = Question { unknowns: &unknowns, law: &[], starts: 4, robust: None, settings, threads: 0 };
    let rows = |wanted: &[&'static equations::Formulation]| -> Vec<Row> {
        fit_formulations(&scene, &mut [film.clone()], &question, wanted).unwrap()
    };
    let both = rows(&[CHETAEV, VAKONOMIC]);
    for (row, formulation) in both.iter().zip([CHETAEV, VAKONOMIC]) {
        let alone = rows(&[formulation]);
        assert_eq!(row.fit.as_ref().unwrap(), alone[0].fit.as_ref().unwrap());
        // Chetaev's has no number that a start could move
        let fit = row.fit.as_ref().unwrap();
        assert!(formulation != CHETAEV || fit.starts == 2, "{}", fit.starts);
    }
}
