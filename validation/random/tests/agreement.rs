//! Solutions of linear equations with round-off.

use nalgebra::{DMatrix, DVector};
use random::judged::solution;

/// `x = 2` and `0 = off`, whose terms have the size 2.
#[test]
fn equations_have_a_solution_up_to_a_thousand_millionth_of_their_terms() {
    for (part, is_solvable) in [(0.3, true), (3.0, false)] {
        let right = DVector::from_row_slice(&[2.0, part * 2e-9]);
        let found = solution(&DMatrix::from_row_slice(2, 1, &[1.0, 0.0]), &right, 2.0);
        assert_eq!(found.is_some(), is_solvable, "{part}: {found:?}");
        assert!(found.is_none_or(|x| (x[0] - 2.0).abs() < 1e-15));
        let none = solution(&DMatrix::zeros(2, 0), &DVector::from_row_slice(&[0.0, part * 2e-9]), 2.0);
        assert_eq!(none.map(|x| x.len()), is_solvable.then_some(0), "{part}");
    }
}

/// `x = 1` and `s y = s`: that is an equation for y from `s` = 10⁻¹² on.
#[test]
fn directions_under_a_million_millionth_are_none() {
    for (part, counts) in [(0.3, false), (3.0, true)] {
        let found = solution(
            &DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, part * 1e-12]),
            &DVector::from_row_slice(&[1.0, part * 1e-12]),
            1.0,
        );
        let y = found.map(|x| x[1]).unwrap_or_else(|| panic!("{part}"));
        assert!((y - if counts { 1.0 } else { 0.0 }).abs() < 1e-9, "{part}: {y}");
    }
}
