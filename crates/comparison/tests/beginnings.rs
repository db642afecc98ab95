//! How motions begin to part, where that is known.

use comparison::{Growth, LeadingTerm, compare_motions, growth};
use integrate::Method;
use motion::{Metric, Motion, Settings, choices, solve_choice};
use scene::Scene;

fn solved(force: &str, tolerance: f64) -> (Scene, Motion) {
    let text = format!(
        "title = \"pushed\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"2*(x'^2 + y'^2) - 2*x^2\"\nforces = {{ {force} }}\n[start.velocities]\n\"x'\" = 0\n\"y'\" = 1\n\
         [run]\nduration = 2\n"
    );
    let scene = Scene::parse("pushed", &text).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings { tolerance, method: Some(Method::Dop853), ..Settings::default() };
    let motion = solve_choice(&scene, &choices(&scene)[0], &settings).expect("a motion");
    (scene, motion)
}

/// The growth of what this force does.
fn grown(force: &str) -> Growth {
    let tolerance = 1e-11;
    let ((scene, mut still), (_, mut pushed)) = (solved("", tolerance), solved(force, tolerance));
    let mut metric = Metric::new(&scene.system).expect("a metric");
    let gap = compare_motions(&mut pushed, &mut still, &mut metric).expect("a gap");
    let found = growth(&mut pushed, &mut still, &mut metric, &|t| gap.limit_at(t));
    found.expect("read off").expect("a gap that stands out")
}

#[test]
fn a_power_is_found_with_its_coefficient() {
    for (k, force) in [(2, "x = \"0.6\""), (3, "x = \"0.6*t\""), (4, "x = \"0.6*t^2\"")] {
        let found = grown(force);
        // 4 Δx'' = 0.6 t^(k−2) − 4 Δx: then t^(k+2)
        let known = 0.15 / f64::from(k * (k - 1));
        let Growth { exponent, coefficient, length, uncertainty, coefficient_uncertainty, from, to } = found;
        println!("t^{k}: {exponent}, off by about {uncertainty:.1e}; {coefficient:?}, from {from} to {to}");
        assert!((exponent - f64::from(k)).abs() < 1e-4, "{exponent}");
        assert!((coefficient[0] / known - 1.0).abs() < 1e-5 && coefficient[1].abs() < 1e-9, "{coefficient:?}, {known}");
        assert!((length / (2.0 * known) - 1.0).abs() < 1e-5, "{length}");
        // the doubts are those of the next terms, and no less than what is known to be wrong
        assert!(uncertainty > 1e-9 && (exponent - f64::from(k)).abs() < 3.0 * uncertainty + 1e-9, "{uncertainty:e}");
        assert!(uncertainty < 1e-2 && coefficient_uncertainty < 1e-2);
        assert!((0.15 - from / to).abs() < 1e-12 && to <= 0.6);
    }
}

#[test]
fn a_fit_begins_where_the_gap_is_300_times_what_it_has_to_pass() {
    let ((scene, mut still), (_, mut pushed)) = (solved("", 1e-11), solved("y = \"48*t^2\"", 1e-11));
    let mut metric = Metric::new(&scene.system).expect("a metric");
    // 4 y'' = 48 t², and y = t⁴ in the kinetic metric twice as long
    let limit = |t: f64| 2.0 * t.powi(4) / 300.0;
    let mut from = |first: f64| {
        let found = growth(&mut pushed, &mut still, &mut metric, &|_| limit(first)).expect("read off");
        found.map(|Growth { from, exponent, coefficient, .. }| {
            assert!(
                (exponent - 4.0).abs() < 1e-6 && (coefficient[1] - 1.0).abs() < 1e-6,
                "{exponent}, {coefficient:?}"
            );
            from
        })
    };
    for first in [1e-3, 1e-2, 0.05] {
        // ranges are tried that are longer by half each
        let found = from(first).expect("a growth");
        assert!(found > first && found <= 1.5 * first * (1.0 + 1e-9), "{first}: {found}");
    }
    // no range is longer than 0.3 of the time, 2 s, and each begins at 0.15 of its end
    assert_eq!(from(0.0901), None);
}

#[test]
fn a_deviation_is_a_part_of_what_is_predicted() {
    let of = |coefficient: &[f64]| LeadingTerm {
        exponent: 3,
        coefficient: coefficient.to_vec(),
        length: 1.0,
        from: 0.0,
        reach: 1.0,
        proved: false,
    };
    let measured = grown("x = \"0.6\"");
    for (coefficient, predicted, deviation) in [
        ([3.0, 4.0], [3.0, 4.0], 0.0),
        ([3.3, 4.4], [3.0, 4.0], 0.1),
        ([3.0, 4.0], [0.0, 4.0], 0.75),
        ([-3.0, 0.0], [3.0, 0.0], 2.0),
    ] {
        let measured = Growth { coefficient: coefficient.to_vec(), ..measured.clone() };
        assert!((measured.deviation_from(&of(&predicted)) - deviation).abs() < 1e-12, "{coefficient:?}, {predicted:?}");
    }
}
