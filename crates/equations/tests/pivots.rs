//! Order of elimination of a sparse linear block.

use equations::pivots::{Entry, POINTS, Pattern, Strategy};

fn pattern(rows: &[&[f64]]) -> Option<Pattern> {
    let entry = |&x: &f64| Entry { values: [x; POINTS], constant: true };
    let row = |row: &&[f64]| row.iter().enumerate().filter(|(_, x)| **x != 0.0).map(|(j, x)| (j, entry(x))).collect();
    Pattern::new(rows.iter().map(row).collect())
}

#[test]
fn a_band_is_eliminated_in_so_many_operations_as_it_has_rows() {
    let operations = |n: usize| {
        let row = |i: usize| (0..n).map(move |j| [2.1, -1.0][i.abs_diff(j).min(1)] * f64::from(i.abs_diff(j) < 2));
        let rows: Vec<Vec<f64>> = (0..n).map(|i| row(i).collect()).collect();
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        pattern(&rows).unwrap().order(Strategy::Symmetric, &vec![false; n], usize::MAX).unwrap().operations
    };
    assert_eq!(operations(40) - operations(30), operations(30) - operations(20));
}

#[test]
fn small_pivots_are_left_alone() {
    let light = pattern(&[&[1e-9, 0.0, 1.0], &[0.0, 1.0, 1.0], &[1.0, 1.0, 0.0]]).unwrap();
    for strategy in [Strategy::Symmetric, Strategy::Sparse] {
        let found = light.order(strategy, &[false; 3], 1000).unwrap();
        assert_ne!(found.pivots[0], (0, 0), "{strategy:?}");
    }
    let dependent = pattern(&[&[1.0, 2.0], &[0.5, 1.0]]).unwrap();
    assert!(dependent.order(Strategy::Sparse, &[false; 2], 1000).is_none());
    assert!(
        pattern(&[&[1.0, 0.0], &[1.0, 0.0]]).is_some_and(|p| p.order(Strategy::Sparse, &[false; 2], 1000).is_none())
    );
}

#[test]
fn an_elimination_that_takes_too_long_is_given_up() {
    let rows = [[3.0, 1.0, 1.0], [1.0, 3.0, 1.0], [1.0, 1.0, 3.0]];
    let rows: Vec<&[f64]> = rows.iter().map(|r| &r[..]).collect();
    let full = pattern(&rows).unwrap();
    assert!(full.order(Strategy::Sparse, &[false; 3], 1000).is_some());
    assert!(full.order(Strategy::Sparse, &[false; 3], 5).is_none());
}
