//! Exclusions that can be trusted: right formulations, nested ones, what is not modelled, estimated
//! deviations, units, and the smallest films.

use fit::{Deviations, Film, Identifiability, Question, Unknown, Verdict, fit_formulations, significance, threshold};
use scene::Scene;

use crate::films::{SLEDGE, built_in, film, fitted, fitted_by, sledge, sledge_from, times};

const DISC: &str = r#"
title = "Upright disc"
[parameters]
m = 1.0
R = 0.1
[coordinates]
x   = { unit = "m", start = 0 }
y   = { unit = "m", start = 0 }
psi = { unit = "rad", start = 0 }
phi = { unit = "rad", start = 0.5 }
[system]
lagrangian  = "m*(x'^2 + y'^2)/2 + m*R^2*psi'^2/4 + m*R^2*phi'^2/8"
constraints = ["x' - R*psi'*cos(phi)", "y' - R*psi'*sin(phi)"]
[start.velocities]
"psi'" = 10
"phi'" = 0.8
[run]
duration = 3
"#;

/// A disc rolls on a circle; the vakonomic family has this motion for μ₀ = −m(x', y').
#[test]
fn a_family_that_contains_the_motion_is_not_excluded() {
    let scene = Scene::parse("disc", DISC).unwrap();
    for (seed, end, rate) in [(1, 2.0, 10.0), (2, 4.0, 6.0), (3, 3.0, 20.0)] {
        let t: Vec<f64> = (1..=(end * rate) as usize).map(|k| k as f64 / rate).collect();
        let at = |t: f64| {
            let turn = 0.5 + 0.8 * t;
            vec![1.25 * (turn.sin() - 0.5_f64.sin()), 1.25 * (0.5_f64.cos() - turn.cos())]
        };
        let rows = fitted(&scene, &[film(&scene, "x,y", 1e-3, seed, &t, at)], &["start"], &[]);
        let fits: Vec<_> = rows.iter().map(|row| row.fit.as_ref().unwrap()).collect();
        assert!(rows.iter().all(|row| matches!(row.verdict, Verdict::CannotTell { .. })), "{:?}", rows[1].verdict);
        // it contains Chetaev's: its least χ² is not above
        assert!(fits[1].chi_squared <= fits[0].chi_squared + 0.5, "{} {}", fits[1].chi_squared, fits[0].chi_squared);
        assert!(rows[0].notes.iter().any(|note| note.starts_with("nested")), "{:?}", rows[0].notes);
    }
}

/// A ball on a turning table runs on a circle. The vakonomic ball does on a table at rest, for
/// `μ₀ = −m(x', y')` and the spin 2/5 Ω: no start near the true Ω leads there. Where a search misses that, it
/// is not settled, and Chetaev's formulation is not supported.
#[test]
fn what_holds_without_a_parameter_is_found() {
    let (rate, v) = (2.0 / 7.0 * 0.6837, [-0.0052, 0.1210]);
    let at = |t: f64| {
        let (s, c) = ((rate * t).sin() / rate, (1.0 - (rate * t).cos()) / rate);
        vec![0.6626 + v[0] * s - v[1] * c, -0.0407 + v[1] * s + v[0] * c]
    };
    let unknowns = ["x", "y", "x'", "y'", "psi'", "Omega"].map(|name| name.parse::<Unknown>().unwrap());
    for (radius, starts) in [(0.1, 1), (0.1, 16), (0.08, 16)] {
        let scene = scene::catalogue::find("turntable", &[("a".to_string(), radius.into())]).unwrap();
        let film = film(&scene, "x,y", 5e-4, 5, &times(6.0), at);
        let question = Question { starts, ..crate::films::question(&unknowns) };
        let rows = fit_formulations(&scene, &mut [film], &question, &[motion::CHETAEV, motion::VAKONOMIC]).unwrap();
        let [chetaev, vakonomic] = [0, 1].map(|i| rows[i].fit.as_ref().unwrap().chi_squared);
        assert_ne!(rows[0].verdict, Verdict::Supported, "{vakonomic} from {starts} starts");
        assert!(!matches!(rows[1].verdict, Verdict::Excluded { .. }), "{vakonomic} from {starts} starts");
        assert!(starts == 1 || vakonomic < chetaev + 0.5, "{vakonomic} for {chetaev}");
    }
}

/// Quantiles of the χ² distribution at the level of 15 with one degree of freedom, from tables.
#[test]
fn thresholds_go_with_the_unknowns_more() {
    assert_eq!(threshold(1), 15.0);
    for (more, expected) in [(2, 18.28), (16, 45.9)] {
        assert!((threshold(more) - expected).abs() < 0.3, "{more}: {}", threshold(more));
    }
    assert_eq!([3.96, 12.3, 763.0].map(significance), ["over 3 σ", "over 10 σ", "over 100 σ"]);
}

/// Straight lines, sixteen films: both formulations are right, and one has sixteen numbers more.
#[test]
fn sixteen_straight_lines_exclude_nobody() {
    let scene = built_in("heisenberg");
    let t: Vec<f64> = (1..=20).map(|k| k as f64 / 20.0).collect();
    let films: Vec<Film> = (0..16)
        .map(|k| {
            let (s, c) = (0.4 * k as f64).sin_cos();
            film(&scene, "x,y", 1e-3, 70 + k, &t, |t| vec![0.5 + c * t, s * t])
        })
        .collect();
    let rows = fitted(&scene, &films, &["x", "y", "x'", "y'"], &[]);
    assert!(rows.iter().all(|row| matches!(row.verdict, Verdict::CannotTell { .. })), "{:?}", rows[0].verdict);
}

/// Short films of a sledge, each with a start of its own: among 25 unknowns no two starts lead to one
/// minimum, and one film alone excludes what is wrong.
#[test]
fn one_of_many_films_excludes() {
    let scene = built_in("sledge");
    let t: Vec<f64> = (1..=20).map(|k| k as f64 / 10.0).collect();
    let film = |k: u64| film(&scene, "x,y,phi", 1e-3, 90 + k, &t, |t| sledge_from(0.1 * k as f64, t));
    let films: Vec<Film> = (0..4).map(film).collect();
    let rows = fitted(&scene, &films, &SLEDGE, &[]);
    assert_eq!(rows[0].verdict, Verdict::Supported);
    assert!(matches!(rows[1].verdict, Verdict::Excluded { sigmas } if sigmas > 100.0), "{:?}", rows[1].verdict);
    assert!(rows[1].notes.iter().any(|note| note.contains("alone; of the whole films")), "{:?}", rows[1].notes);
}

/// A straight line on a table that is tilted by 0.07°, which no scene says: an arc is as good as a parabola.
#[test]
fn a_tilt_is_named_before_anything_is_supported() {
    let scene = built_in("heisenberg");
    let push = 9.81 * 0.07_f64.to_radians().sin();
    let (mut explained, t) = (0, times(2.0));
    for seed in 0..6 {
        let film = film(&scene, "x,y", 1e-3, 100 + seed, &t, |t| vec![0.5 + t, 0.5 * push * t * t]);
        let rows = fitted(&scene, &[film], &["x", "y", "x'", "y'"], &[]);
        assert_ne!(rows[1].verdict, Verdict::Supported, "{seed}");
        assert!(!matches!(rows[0].verdict, Verdict::Excluded { .. }), "{:?}", rows[0].verdict);
        if rows[0].verdict == Verdict::None {
            explained += 1;
            assert!(rows[0].notes.iter().any(|note| note.contains("as of a tilt")), "{:?}", rows[0].notes);
        }
        if let Verdict::Explained { with: Some(with), from } = &rows[0].verdict {
            explained += 1;
            assert!(from == &["vakonomic"] && !with.is_empty(), "{with}");
            assert!(rows[0].notes.iter().any(|note| note.contains("as of a tilt")), "{:?}", rows[0].notes);
        }
    }
    assert!(explained >= 4, "{explained}");
}

/// Deviations that are too large make an exclusion weaker, not unsafe; estimated ones are those of the noise.
#[test]
fn deviations_may_be_too_large_or_unknown() {
    let scene = built_in("sledge");
    let table = |sigma: f64| {
        let mut film = film(&scene, "x,y,phi", 1e-3, 5, &times(2.0), sledge);
        film.columns.iter_mut().for_each(|column| column.sigma = sigma);
        film
    };
    let rows = fitted(&scene, &[table(1.4e-3)], &SLEDGE, &[]);
    assert_eq!(rows[0].verdict, Verdict::Supported);
    assert!(matches!(rows[1].verdict, Verdict::Excluded { .. }), "{:?}", rows[1].verdict);
    assert!(rows[0].fit.as_ref().unwrap().objections().all(|test| test.is_too_small()));

    let deviations = Deviations::written(&["free".into()]).unwrap();
    let seen = table(1e-3);
    let mut text = "t,x,y,phi\n".to_string();
    for (t, row) in seen.t.iter().zip(&seen.rows) {
        let cells: Vec<String> = row.iter().flatten().map(f64::to_string).collect();
        text += &format!("{t},{}\n", cells.join(","));
    }
    let mut films = [Film::read(&scene, "film", &text, &deviations).unwrap()];
    let unknowns: Vec<Unknown> = SLEDGE.iter().map(|text| text.parse().unwrap()).collect();
    let question = crate::films::question(&unknowns);
    let rows = fit_formulations(&scene, &mut films, &question, &[motion::CHETAEV, motion::VAKONOMIC]).unwrap();
    assert_eq!(rows[0].verdict, Verdict::Supported);
    for column in &films[0].columns {
        assert!((column.sigma / 1e-3 - 1.0).abs() < 0.2, "{column:?}");
    }
    assert!(rows[0].fit.as_ref().unwrap().tests.iter().all(|test| test.name != "chi squared"));
}

/// A scene in millimetres: what is said to be in millimetres is in its units, what is in metres is a thousand
/// times.
#[test]
fn units_are_those_of_the_scene() {
    let text = DISC.replace("unit = \"m\"", "unit = \"mm\"").replace("R = 0.1", "R = 100");
    let scene = Scene::parse("disc", &text).unwrap();
    let read = |header: &str, sigma: &str| {
        let deviations = Deviations::written(&[sigma.to_string()]).unwrap();
        Film::read(&scene, "film", &format!("t,{header}\n0.1,2\n0.2,3\n"), &deviations)
    };
    let of = |header: &str, sigma: &str| {
        let film = read(header, sigma).unwrap_or_else(|error| panic!("{error}"));
        (film.rows[0][0], film.columns[0].sigma)
    };
    assert_eq!(of("x [mm]", "1mm"), (Some(2.0), 1.0));
    assert_eq!(of("x", "0.5"), (Some(2.0), 0.5));
    let (value, sigma) = of("x [m]", "1cm");
    assert!((value.unwrap() - 2000.0).abs() < 1e-9 && (sigma - 10.0).abs() < 1e-9);
    for (header, sigma) in [("x [rad]", "1mm"), ("R*psi [m]", "1"), ("phi [mm]", "1"), ("phi", "1mm")] {
        let error = read(header, sigma).unwrap_err().to_string();
        assert!(error.contains("give the numbers in the units of the scene"), "{header}: {error}");
    }
}

/// The smallest films: one unknown, one sample, a column at rest, a gap, a film that begins late.
#[test]
fn the_smallest_films_are_answered() {
    let scene = built_in("sledge");
    let all = film(&scene, "x,y,phi", 1e-3, 6, &times(1.0), sledge);
    let part = |from: usize, to: usize| {
        let (t, rows, lines) = (all.t[from..to].to_vec(), all.rows[from..to].to_vec(), all.lines[from..to].to_vec());
        Film { t, rows, lines, ..all.clone() }
    };
    for film in [part(0, 1), part(0, 2), part(59, 60), part(40, 60), all.clone()] {
        let rows = fitted(&scene, std::slice::from_ref(&film), &["g~9"], &[]);
        for row in rows {
            let fit = row.fit.unwrap_or_else(|error| panic!("{} samples: {error}", film.t.len()));
            assert!(fit.chi_squared.is_finite() && fit.estimates.iter().all(|e| e.value.is_finite()));
        }
    }
    let mut rest = all.clone();
    rest.rows.iter_mut().for_each(|row| *row = vec![Some(0.0), None, None]);
    let rows = fitted(&scene, &[rest], &["g~9"], &[]);
    assert!(rows[0].fit.is_ok() && rows[0].verdict != Verdict::Supported, "{:?}", rows[0].verdict);
}

/// A chain of 25 masses: series are cut before they reach the last spring, and that says nothing of it.
#[test]
fn what_is_cut_is_open() {
    let n = 30;
    let names = |s: &str| (1..=n).map(|i| s.replace('#', &i.to_string())).collect::<Vec<_>>();
    let coordinates = names("x# = { start = 0 }").join("\n");
    let kinetic = names("x#'^2/2").join(" + ");
    let springs: Vec<String> =
        (1..n).map(|i| format!("{}*(x{} - x{i})^2/2", if i == n - 1 { "k" } else { "2" }, i + 1)).collect();
    let starts = (1..n).map(|i| format!("\"x{i}'\" = {}", if i == 1 { 1 } else { 0 })).collect::<Vec<_>>().join("\n");
    let text = format!(
        "title = \"chain\"\n[parameters]\nk = 3.5\n[coordinates]\n{coordinates}\n[system]\nlagrangian = \"{kinetic} - {}\"\n\
         constraints = [\"x{n}' - 0.3*x{n}\"]\n[start.velocities]\n{starts}\n[run]\nduration = 1\n",
        springs.join(" - ")
    );
    let scene = Scene::parse("chain", &text).unwrap_or_else(|error| panic!("{error}"));
    let film = film(&scene, "x1", 1e-3, 8, &times(1.0), |t| vec![t]);
    let unknowns = ["k".parse().unwrap()];
    let choice = motion::choices(&scene).into_iter().find(|c| *c.formulation == *motion::CHETAEV).unwrap();
    let problem = fit::Problem::new(&scene, &choice, &[film], &unknowns, &motion::Settings::default()).unwrap();
    let shown = problem.identifiability(&scene, &choice);
    assert!(matches!(&shown, Identifiability::Open(why) if why.contains("cut")), "{shown:?}");
}

/// A point on a line with the potential `e² x²/2`: at e = 0 the film is stationary in e, and shows it all the
/// same.
#[test]
fn a_stationary_unknown_is_shown() {
    let text = "title = \"Spring\"\n[parameters]\ne = 0\n[coordinates]\nx = { start = 1 }\ny = { start = 0 }\n[system]\n\
        lagrangian = \"(x'^2 + y'^2)/2 - e^2*x^2/2\"\nconstraints = [\"y' - 0.5*y\"]\n[start.velocities]\n\"x'\" = 0\n[run]\n\
        duration = 2\n";
    let scene = Scene::parse("spring", text).unwrap_or_else(|error| panic!("{error}"));
    let estimate = |truth: f64| {
        let film = film(&scene, "x", 1e-2, 11, &times(2.0), |t| vec![(truth * t).cos()]);
        let row = crate::films::fitted_by(&[motion::CHETAEV], &scene, &[film], &["e"], &[]).remove(0);
        let fit = row.fit.unwrap_or_else(|error| panic!("{error}"));
        assert!(fit.hidden.is_empty(), "{:?}", fit.hidden);
        fit.estimates[0].clone()
    };
    // of cos(e t) the film sees e² to 2e-2/√(Σ t⁴/4)
    let zero = estimate(0.0);
    let squares = times(2.0).iter().map(|t| t.powi(4) / 4.0).sum::<f64>();
    let end = (1.96 * 1e-2 / squares.sqrt()).sqrt();
    assert!(zero.interval[0] < 0.0 && zero.interval[1] > 0.0, "{zero:?}");
    assert!(zero.interval[1] > 0.3 * end && zero.interval[1] < 2.0 * end, "{zero:?} {end}");
    let other = estimate(0.3);
    assert!((other.value.abs() - 0.3).abs() < 4.0 * other.error && other.error < 0.01, "{other:?}");
}

/// Coarse films of a sledge that starts 20 mrad from across, where `y'` is fifty times `x'`, are fitted.
#[test]
fn films_that_begin_near_a_heading_of_ninety_degrees_are_fitted() {
    let at = |name: &str, x: f64| (name.to_string(), x.into());
    let scene = scene::catalogue::find("sledge", &[at("phi", 1.55), at("x'", 0.5 * 1.55_f64.cos())]).unwrap();
    let t: Vec<f64> = (1..=12).map(|k| f64::from(k) / 6.0).collect();
    for seed in 0..10 {
        let film = film(&scene, "x,y,phi", 1e-3, 300 + seed, &t, |t| sledge_from(1.55, t));
        let row = fitted_by(&[motion::CHETAEV], &scene, &[film], &SLEDGE, &[]).remove(0);
        let fit = row.fit.unwrap_or_else(|error| panic!("{seed}: {error}"));
        let g = fit.estimates.iter().find(|e| e.name.starts_with('g')).unwrap();
        assert!((g.value - 9.81).abs() < 4.5 * g.error && g.error < 0.05, "{seed}: {g:?}");
    }
}

/// Up to 6 µrad beside the pole of `y' = x' tan φ`, derivatives of the start are those of the formula.
#[test]
fn a_start_near_a_heading_of_ninety_degrees_has_derivatives() {
    let scene = built_in("sledge");
    let choice = motion::choices(&scene).into_iter().find(|c| *c.formulation == *motion::CHETAEV).unwrap();
    let settings = motion::Settings::default();
    let mut model = motion::Model::new(&scene, &choice, &["phi", "x'"], &[0.0, 0.1], &settings).unwrap();
    for beside in [1.27, 0.02, 8e-4, 1e-4, 6e-6, std::f64::consts::PI - 1e-4] {
        let phi = std::f64::consts::FRAC_PI_2 - beside;
        let found = model.derivatives(&[phi, 1e-4]);
        assert_eq!(found.ended, None, "{phi}");
        for (i, known) in [1e-4 / phi.cos().powi(2), phi.tan()].into_iter().enumerate() {
            let by = found.derivatives[0][i].velocities[1];
            assert!((by / known - 1.0).abs() < 1e-9, "{phi}, {i}: {by} for {known}");
        }
    }
}
