//! Canonical form, derivatives, substitution, expansion: what the graph itself guarantees.

use crate::read;
use std::collections::HashMap;
use symbolic::{Expr, Function, Graph, Matrix};

/// Both sides are the same node.
#[track_caller]
fn same(left: &str, right: &str) {
    let g = Graph::new();
    let (left, right) = (read(&g, left), read(&g, right));
    assert_eq!(left, right, "{} is not {}", g.plain(left), g.plain(right));
}

#[track_caller]
fn different(left: &str, right: &str) {
    let g = Graph::new();
    assert_ne!(read(&g, left), read(&g, right));
}

#[test]
fn like_terms_and_factors_merge() {
    same("x + y + x", "2*x + y");
    same("x*y*x", "x^2*y");
    same("x - x", "0");
    same("x^(-1)*x", "1");
    same("0*x", "0");
    same("x^0", "1");
    same("0^0", "1");
    same("2*(x + y)", "2*x + 2*y");
    same("x/2 + x/3", "5*x/6");
    same("(2*x + 2*y)*z", "2*(x + y)*z");
    same("(x - y)*z", "-(y - x)*z");
    same("(x - y)^2", "(y - x)^2");
    same("1/(2*x)", "0.5*x^-1");
    same("(x*y)^3", "x^3*y^3");
    different("(x + y)^2", "x^2 + 2*x*y + y^2");
}

#[test]
fn powers_merge_only_where_that_is_an_identity() {
    different("sqrt(x^2)", "x");
    same("sqrt(x)^2", "x");
    same("sqrt(x + y)*sqrt(x + y)", "x + y");
    same("(x^y)^2/(x^y)", "x^y");
    same("sqrt(4*x)", "2*sqrt(x)");
    same("sqrt(4*x^2 + 4)", "2*sqrt(x^2 + 1)");
    same("sqrt(2)*sqrt(2)", "2");
    same("1/sqrt(2)", "sqrt(2)/2");
    same("sqrt(0.49)", "0.7");
    same("8^(1/3)", "2");
}

#[test]
fn signs_come_out_of_odd_and_even_functions() {
    for f in ["sin", "tan", "sinh", "tanh", "asin", "atan", "asinh", "atanh"] {
        same(&format!("{f}(-x)"), &format!("-{f}(x)"));
        same(&format!("{f}(y - x)"), &format!("-{f}(x - y)"));
        same(&format!("{f}(0)"), "0");
    }
    for f in ["cos", "cosh"] {
        same(&format!("{f}(-x)"), &format!("{f}(x)"));
        same(&format!("{f}(y - x)"), &format!("{f}(x - y)"));
        same(&format!("{f}(0)"), "1");
    }
    different("acos(-x)", "acos(x)");
    same("exp(0) + log(1)", "1");
    same("atan2(0, 2)", "0");
}

#[test]
fn squares_of_sine_and_cosine_add_up() {
    same("sin(x)^2 + cos(x)^2", "1");
    same("m*r^2*sin(x)^2 + z + m*r^2*cos(x)^2", "m*r^2 + z");
    same("sin(x)^3*y + sin(x)*cos(x)^2*y", "sin(x)*y");
    same("2*cosh(x)^2 - 2*sinh(x)^2", "2");
    same("a*sin(x)^2*sin(y)^2 + a*sin(x)^2*cos(y)^2 + a*cos(x)^2", "a");
    same("(x + y)*sin(z)^2 + (x + y)*cos(z)^2 - x", "y");
    different("sin(x)^2 - cos(x)^2", "1");
    different("sin(x)^2 + cos(y)^2", "1");
    different("sin(x)^2 + 2*cos(x)^2", "1");
    different("cosh(x)^2 + sinh(x)^2", "1");
}

#[test]
fn exponents_with_large_numerators_and_denominators_are_split_without_overflow() {
    let g = Graph::new();
    for exponent in ["-9000000000000000001/4611686018427387905", "9000000000000000001/4611686018427387905"] {
        let power = read(&g, &format!("2^({exponent})"));
        let value = g.evaluate(power, &HashMap::new()).expect("a value");
        let (above, below) = exponent.split_once('/').expect("a fraction");
        let expected = (2f64.ln() * above.parse::<f64>().unwrap() / below.parse::<f64>().unwrap()).exp();
        assert!((value / expected - 1.0).abs() < 1e-14, "{value} instead of {expected}");
    }
}

#[test]
fn numbers_are_exact_and_overflow_to_floats() {
    same("0.1 + 0.2", "0.3");
    same("1/3 + 1/3 + 1/3", "1");
    let g = Graph::new();
    assert_eq!(g.as_number(read(&g, "10^30")), Some(1e30));
    assert_eq!(g.as_number(g.integer(i64::MIN)), Some(i64::MIN as f64));
    assert_eq!(g.as_number(read(&g, "2^-1")), Some(0.5));
    assert_eq!(g.as_number(read(&g, "-2^2")), Some(-4.0));
    assert_eq!(g.as_number(read(&g, "2^3^2")), Some(512.0));
    assert_eq!(g.as_number(read(&g, "x")), None);
}

#[test]
fn high_powers_of_measured_numbers_do_not_vanish() {
    let g = Graph::new();
    let at = HashMap::from([(g.symbol("x"), 0.2)]);
    for (text, expected) in [
        ("(x + 0.7842157614637822)^27", 0.9842157614637822_f64.powi(27)),
        ("(x + 0.0012345678)^60", 0.2012345678_f64.powi(60)),
        ("(1e-16*x)^27/(1e-16*x)^26", 2e-17),
        ("0.8917040938762298^23.5", 0.8917040938762298_f64.powf(23.5)),
    ] {
        let found = g.evaluate(read(&g, text), &at).unwrap();
        assert!((found - expected).abs() < 1e-13 * expected, "{text}: {found}");
    }
}

#[test]
fn division_by_the_number_zero_is_not_finite_and_spreads() {
    let g = Graph::new();
    let x = read(&g, "x");
    let infinite = g.div(g.one(), g.zero());
    assert!(!g.as_number(infinite).unwrap().is_finite());
    assert!(!g.as_number(g.powi(g.zero(), -1)).unwrap().is_finite());
    assert!(g.as_number(g.ratio(0, 0)).unwrap().is_nan());
    for spread in [g.mul(infinite, x), g.add(infinite, x), g.div(x, g.zero()), g.pow(infinite, x)] {
        assert!(!g.as_number(spread).unwrap().is_finite());
    }
    assert!(!g.as_number(g.call(Function::Sin, infinite)).unwrap().is_finite());
}

#[test]
fn derivatives_are_the_textbook_ones() {
    let g = Graph::new();
    let x = g.symbol("x");
    for (e, d) in [
        ("x^3*y", "3*x^2*y"),
        ("sin(x)", "cos(x)"),
        ("cos(2*x)", "-2*sin(2*x)"),
        ("tan(x)", "1 + tan(x)^2"),
        ("sinh(x)*cosh(x)", "sinh(x)^2 + cosh(x)^2"),
        ("tanh(x)", "1 - tanh(x)^2"),
        ("asin(x)", "1/sqrt(1 - x^2)"),
        ("acos(x)", "-1/sqrt(1 - x^2)"),
        ("atan(x)", "1/(1 + x^2)"),
        ("asinh(x)", "1/sqrt(1 + x^2)"),
        ("acosh(x)", "1/sqrt(x^2 - 1)"),
        ("atanh(x)", "1/(1 - x^2)"),
        ("exp(x*y)", "y*exp(x*y)"),
        ("log(x)", "1/x"),
        ("sqrt(x)", "1/(2*sqrt(x))"),
        ("x^y", "y*x^(y - 1)"),
        ("y^x", "y^x*log(y)"),
        ("atan2(y, x)", "-y/(x^2 + y^2)"),
        ("atan2(x, y)", "y/(x^2 + y^2)"),
        ("y*sin(z)", "0"),
    ] {
        let found = g.derivative(read(&g, e), x);
        assert_eq!(found, read(&g, d), "d/dx {e} gave {}", g.plain(found));
    }
}

#[test]
fn jacobians_total_derivatives_and_matrices_fit_together() {
    let g = Graph::new();
    let q = ["x", "y"].map(|n| g.symbol(n));
    let v = ["x'", "y'"].map(|n| g.symbol(n));
    let es = [read(&g, "x*y"), read(&g, "sin(x) + y^2")];
    let jacobian = g.jacobian(&es, &q);
    assert_eq!((jacobian.rows(), jacobian.columns()), (2, 2));
    assert_eq!(jacobian.row(0), [read(&g, "y"), read(&g, "x")]);
    assert_eq!(jacobian.column(1), [read(&g, "x"), read(&g, "2*y")]);
    assert_eq!(jacobian.row(1), g.gradient(es[1], &q));
    let velocities = g.variables(&v);
    let rates: Vec<(_, _)> = q.iter().copied().zip(velocities.iter().copied()).collect();
    let by_chain_rule: Vec<Expr> = es.iter().map(|e| g.total_derivative(*e, &rates)).collect();
    assert_eq!(g.mat_vec(&jacobian, &velocities), by_chain_rule);
    assert_eq!(g.transpose_vec(&jacobian, &velocities), g.mat_vec(&jacobian.transpose(), &velocities));
    assert_eq!(jacobian.entries().len(), 4);
}

#[test]
#[should_panic(expected = "2×2 matrix was given 3 entries")]
fn a_matrix_with_a_hole_is_refused() {
    let g = Graph::new();
    let _ = Matrix::new(2, 2, vec![g.zero(); 3]);
}

#[test]
fn substitution_is_simultaneous_and_simplifies() {
    let g = Graph::new();
    let (x, y) = (g.symbol("x"), g.symbol("y"));
    let map = HashMap::from([(x, read(&g, "y")), (y, read(&g, "-x"))]);
    assert_eq!(g.substitute(read(&g, "x*y + sin(y)"), &map), read(&g, "-x*y - sin(x)"));
    assert_eq!(g.substitute(read(&g, "z^2"), &map), read(&g, "z^2"));
    let zero = HashMap::from([(x, g.zero())]);
    assert_eq!(g.substitute(read(&g, "cos(x)*y + x*z"), &zero), read(&g, "y"));
}

#[test]
fn questions_about_an_expression() {
    let g = Graph::new();
    let e = read(&g, "x/(y + 1) + sin(z)^-2 + 2^x");
    let [x, t] = ["x", "t"].map(|n| g.symbol(n));
    assert!(g.depends_on(e, x) && !g.depends_on(e, t));
    assert_eq!(g.symbols_of(e).len(), 3);
    let mut expected = vec![read(&g, "y + 1"), read(&g, "sin(z)")];
    expected.sort();
    assert_eq!(g.denominators(&[e]), expected);
    assert_eq!(g.size(&[read(&g, "x*y"), read(&g, "x")]), 3);
    assert_eq!(g.name(x), "x");
    assert_eq!(g.find_symbol("nothing"), None);
    assert_eq!(g.as_symbol(g.variable(x)), Some(x));
    assert_eq!(g.as_symbol(e), None);
}

#[test]
fn expansion_multiplies_out_everywhere() {
    let g = Graph::new();
    for (e, expanded) in [
        ("(x + y)^3", "x^3 + 3*x^2*y + 3*x*y^2 + y^3"),
        ("(x + 1)*(x - 1)*sin((x + 1)*y)", "x^2*sin(x*y + y) - sin(x*y + y)"),
        ("(x + y)^(3/2)", "x*sqrt(x + y) + y*sqrt(x + y)"),
        ("(x + 1)/(x + 2)", "x/(x + 2) + 1/(x + 2)"),
        ("(1 + (1 + x)^2)^2", "4 + 8*x + 8*x^2 + 4*x^3 + x^4"),
    ] {
        let found = g.expand(read(&g, e));
        assert_eq!(found, read(&g, expanded), "{e} gave {}", g.plain(found));
    }
    let huge = read(&g, "(a + b + c + d + e + f + h + i)^60");
    assert_eq!(g.expand(huge), huge, "over the limit it stays as it is");
}

#[test]
fn clones_keep_ids_and_graphs_can_be_sent() {
    let g = Graph::new();
    let e = read(&g, "x*sin(y)");
    let copy = g.clone();
    let text = std::thread::spawn(move || copy.plain(e)).join().unwrap();
    assert_eq!(text, g.plain(e));
}
