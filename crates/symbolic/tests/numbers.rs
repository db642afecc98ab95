//! Numbers of the graph: exact rationals while they fit, floats beyond.

use symbolic::{Expr, Graph, ParseErrorKind};

/// A literal as a number of `g`; `None` where it is out of range.
fn decimal(g: &Graph, literal: &str) -> Option<Expr> {
    match g.parse(literal, &|_: &str| None) {
        Ok(number) => Some(number),
        Err(error) if matches!(error.kind, ParseErrorKind::NumberOutOfRange { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn decimals_are_exact_where_they_fit() {
    let g = Graph::new();
    assert_eq!(decimal(&g, "9.81"), Some(g.ratio(981, 100)));
    assert_eq!(decimal(&g, "1e-3"), Some(g.ratio(1, 1000)));
    assert_eq!(decimal(&g, ".5"), Some(g.ratio(1, 2)));
    assert_eq!(decimal(&g, "5."), Some(g.integer(5)));
    assert_eq!(decimal(&g, "1e400"), None);
    assert_eq!(decimal(&g, "1e-400"), None);
    assert_eq!(g.number(9.81), g.ratio(981, 100));
    let rounded = g.number(0.1 + 0.2);
    assert_eq!((g.as_fraction(rounded), g.as_number(rounded)), (None, Some(0.1 + 0.2)));
    let [small, large] = ["1e-27", "2e45"].map(|text| decimal(&g, text).unwrap());
    assert_eq!(g.mul(small, large), g.number(2e18));
    assert_eq!(g.product(&[small, small, g.number(1e54)]), g.one());
}

#[test]
fn overflow_falls_back_to_floats() {
    let g = Graph::new();
    let value = |e: Expr| g.as_number(e).unwrap();
    let big = g.integer(i64::MAX);
    assert_eq!(value(g.mul(big, big)), (i64::MAX as f64).powi(2));
    assert_eq!(value(g.neg(g.integer(i64::MIN))), -(i64::MIN as f64));
    let tiny = g.powi(g.integer(2), -2000);
    assert!(!g.is_zero(tiny));
    assert_eq!(value(tiny), 0.0);
    assert!(!value(g.powi(g.zero(), -1)).is_finite());
    assert_eq!(g.powi(g.zero(), 0), g.one());
}

#[test]
fn rational_roots_are_found() {
    let g = Graph::new();
    let half = g.ratio(1, 2);
    assert_eq!(g.pow(g.ratio(49, 100), half), g.ratio(7, 10));
    assert_eq!(g.as_fraction(g.pow(g.integer(2), half)), None);
    let fine = g.ratio(1, 1 << 40);
    assert_eq!(g.pow(g.one(), fine), g.one());
    assert_eq!(g.as_fraction(g.pow(g.integer(-4), half)), None);
}
