//! Rates at which realizations come near, as the page tells them.

use picture::Style;
use validation::report::law_rows::{Row, exponents, table};
use validation::report::{ADDED_MASS, Approach, BOTH, FRICTION, RealizationReport};

#[test]
fn rates_are_counted_where_they_can_be_told_and_by_how_near_they_are_to_1() {
    // distances at N = 10³ and 10⁴
    let approach = |name, [first, second]: [f64; 2]| Approach {
        name,
        style: Style::Chetaev,
        distances: vec![10.0 * first, first, second, 0.1 * second],
    };
    let scenes = vec![("sledge".to_string(), vec![approach(FRICTION, [1e-3, 1e-4]), approach(BOTH, [1e-3, 1e-5])])];
    let random = vec![
        vec![approach(FRICTION, [1e-3, 1.1e-4]), approach(ADDED_MASS, [1e-7, 1e-8])],
        vec![approach(FRICTION, [1e-3, 2e-4]), approach(ADDED_MASS, [1e-3, f64::NAN])],
        vec![approach(ADDED_MASS, [f64::NAN, 1e-4]), approach(FRICTION, [1e-3, f64::NAN])],
    ];
    let report = RealizationReport { scenes, random, law: Vec::new() };
    let headline = report.headline();
    assert!(
        headline.ends_with(" In 2 of 4 cases the distance falls as 1/N (fitted exponents 0.699 to 2)."),
        "{headline}"
    );
    assert_eq!(report.random_rates(ADDED_MASS), (Vec::new(), [1, 2]));
    let words: Vec<&str> = report.random.iter().flatten().map(Approach::word).collect();
    assert_eq!(words, ["rate 1", "too close to tell", "other rate", "stops", "stops", "stops"]);
    let verdicts = report.verdicts();
    let of = &verdicts["scenes"]["sledge"];
    assert_eq!((of[FRICTION].as_str(), of[BOTH].as_str()), (Some("rate 1"), Some("other rate")));
    assert_eq!(verdicts["random systems off rate 1"], 1);
    let files = report.files().expect("files");
    let all: String = files.into_iter().map(|file| file.text).collect();
    assert!(all.contains("sledge,\"friction, to Chetaev\",0.01,0.001,1.0e-4,1.0e-5,1\n"), "{all}");
    assert!(all.contains("| friction, to Chetaev | 0.699 | 0.959 | 0.959 | 2 | 0 | 1 |"), "{all}");
}

#[test]
fn exponents_are_of_distance_over_kappa_within_one_scene() {
    let row = |scene, kappa, distances| Row { scene, kappa, distances };
    let rows = [row("a", 20.0, [4e-2, 1.6e-1, 1.0]), row("a", 80.0, [1e-2, 1e-2, f64::NAN]), row("b", 20.0, [1.0; 3])];
    assert_eq!(exponents(Some(&rows[0]), &rows[1]), ["1.00", "2.00", ""]);
    assert_eq!(exponents(Some(&rows[1]), &rows[2]), ["", "", ""]);
    assert!(table(&rows).to_string().contains("| a | 80 | 0.01 | 1.00 | 0.01 | 2.00 |"));
}
