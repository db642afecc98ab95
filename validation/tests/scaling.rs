//! How cost grows: counts that do not depend on the machine.

use bench::exponent;
use equations::Formulation;
use motion::{CHETAEV, REDUCED_CHETAEV, REDUCED_VAKONOMIC};
use scene::catalogue::trailer::Coordinates;
use validation::scaling::{FROM, Limits, TRAILERS, counts, line};

#[test]
fn a_train_costs_what_its_length_costs() {
    for formulation in [REDUCED_CHETAEV, REDUCED_VAKONOMIC] {
        grows_with_its_length(formulation);
    }
}

fn grows_with_its_length(formulation: &'static Formulation) {
    let name = formulation.name;
    let long: Vec<usize> = TRAILERS.into_iter().filter(|&n| n >= FROM).collect();
    let counts: Vec<(f64, (usize, usize))> = long
        .iter()
        .map(|&n| (n as f64, counts((formulation, Coordinates::Maximal), n).expect("has equations")))
        .collect();
    assert_eq!(counts.len(), 5);
    let fit = |of: fn(&(usize, usize)) -> usize| {
        exponent(&counts.iter().map(|(n, c)| (*n, of(c) as f64)).collect::<Vec<_>>()).expect("five points")
    };
    let (derivation, side) = (fit(|c| c.0), fit(|c| c.1));
    println!("{name}: expressions {derivation:?}, operations {side:?}: {counts:?}");
    assert!(derivation.value < 1.5, "{name}: expressions made: exponent {derivation:?}");
    assert!(side.value < 1.2, "{name}: operations of a right-hand side: exponent {side:?}");
    assert!(derivation.value > 0.9 && side.value > 0.9, "{name}: a longer train costs more: {derivation:?}, {side:?}");
}

#[test]
fn a_line_has_a_point_for_every_length_and_says_where_it_ends() {
    let limits = Limits { trailers: 5, repeats: 1, ..Limits::default() };
    let whole = line((REDUCED_CHETAEV, Coordinates::Maximal), &limits, &mut |_, _| {}).expect("has motions");
    assert_eq!(whole.points.iter().map(|p| p.trailers).collect::<Vec<_>>(), [1, 2, 5]);
    assert!(whole.ended.is_none() && whole.points.iter().all(|p| p.solve.is_some() && p.reached == 10.0));
    let cut = line((CHETAEV, Coordinates::Maximal), &Limits { seconds: 0.0, ..limits }, &mut |_, _| {})
        .expect("has equations");
    assert_eq!(cut.points.len(), 1);
    assert!(cut.ended.is_some(), "its derivation takes longer than no time at all");
}
