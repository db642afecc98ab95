//! Ranges of expressions.

use std::collections::HashMap;
use std::f64::consts::PI;

use symbolic::{Graph, Range};

/// With `a` between −2 and 3, and nothing known of the others.
fn of(text: &str) -> Range {
    let g = Graph::new();
    let e = super::read(&g, text);
    g.range(e, &HashMap::from([(g.symbol("a"), Range { low: -2.0, high: 3.0 })]))
}

#[test]
fn intervals_are_those_of_pencil_and_paper() {
    let infinite = f64::INFINITY;
    for (text, low, high) in [
        ("a^2", 0.0, 9.0),
        ("a^3", -8.0, 27.0),
        ("1 - 2*a", -5.0, 5.0),
        ("x^2 + 1", 1.0, infinite),
        ("1/(x^2 + 4)", 0.0, 0.25),
        ("1/x^2", 0.0, infinite),
        ("1/x", -infinite, infinite),
        ("x*sin(x)", -infinite, infinite),
        ("3*cos(x)*sin(y) + 1", -2.0, 4.0),
        ("sqrt(a)", 0.0, 3.0_f64.sqrt()),
        ("exp(x)/(2 + tanh(y))", 0.0, infinite),
        ("log(x)", -infinite, infinite),
        ("atan2(x, y)", -PI, PI),
    ] {
        let Range { low: l, high: h } = of(text);
        assert!((l == low || (l - low).abs() < 1e-15) && (h == high || (h - high).abs() < 1e-15), "{text}: {l} {h}");
    }
}
