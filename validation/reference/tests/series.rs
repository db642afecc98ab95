//! Series of all operations in double-double arithmetic: their sums are the values there.

use std::collections::HashMap;

use reference::{DoubleDouble, Entry};
use symbolic::{Graph, Scalar, SeriesInput, Symbol};

const ORDER: usize = 25;

/// For `a = a₀ + t − t²/2`, `b = 3/4 + t/3`: the series of `formula` at `t = 1/100` minus its value there.
fn misses(formula: &str, a0: &str) -> f64 {
    let g = Graph::new();
    let [t, a, b] = ["t", "a", "b"].map(|name| g.symbol(name));
    let parse = |formula: &str| g.parse(formula, &g).unwrap();
    let definitions: [(Symbol, _); 2] = [(a, parse(&format!("{a0} + t - t^2/2"))), (b, parse("3/4 + t/3"))];
    let (none, outputs) = (HashMap::new(), [parse(formula)]);
    let series = g.compile_series(&[(t, SeriesInput::Time)], &definitions, &outputs, &[], &[], &none).unwrap();
    let tape = g.compile_with(&[t], &definitions, &outputs, &none).unwrap();

    let (h, mut value) = (DoubleDouble::from_ratio(1, 100), [DoubleDouble::ZERO]);
    tape.evaluate(&[h], &mut tape.workspace(), &mut value);
    let mut workspace = series.workspace(ORDER + 1);
    series.expand(&[DoubleDouble::ZERO], DoubleDouble::ONE, &mut workspace, 0, &mut |_, _| {});
    let sum = (0..=ORDER).rev().fold(DoubleDouble::ZERO, |sum, k| sum * h + series.output(0, k, &workspace));
    (sum - value[0]).size()
}

#[test]
fn series_of_all_operations_are_those_of_their_values() {
    let near =
        ["a*b - b/a - a", "sqrt(a*b)", "sin(a)*cos(b)", "cos(a)", "tan(a) + tanh(b)", "sinh(a)*cosh(b)", "asin(a)"];
    let near = near.into_iter().chain(["acos(a)", "atan(a)", "asinh(a)", "atanh(a)", "exp(a*b)", "log(a/b)", "a^b"]);
    let cases = near.map(|f| (f, "2/5")).chain([("acosh(a)", "5/2"), ("a^3 + b", "-2/5"), ("atan2(a, b)", "-2/5")]);
    for (formula, a0) in cases {
        let error = misses(formula, a0);
        assert!(error < 1e-29, "{formula}: {error:.1e}");
    }
}
