//! Taylor coefficients against repeated symbolic differentiation, identities and closed forms.

use proptest::prelude::*;
use std::collections::HashMap;
use symbolic::{Expr, Graph, Scalar, SeriesInput, SeriesScalar, Symbol};

/// Coefficients of `e` in time, to `order`, at `t = 0.3` with `k = 0.7`.
fn coefficients(g: &Graph, t: Symbol, k: Symbol, e: Expr, order: usize) -> Vec<f64> {
    let inputs = [(t, SeriesInput::Time), (k, SeriesInput::Steady)];
    let tape = g.compile_series(&inputs, &[], &[e], &[], &HashMap::new()).unwrap();
    let mut workspace = tape.workspace::<f64>(order + 1);
    tape.expand(&[0.3, 0.7], 1.0, &mut workspace, 1, &mut |_, _| {});
    (0..=order).map(|i| tape.output(0, i, &workspace)).collect()
}

/// The same by differentiating: `e⁽ⁱ⁾/i!`.
fn derivatives(g: &Graph, t: Symbol, k: Symbol, e: Expr, order: usize) -> Vec<f64> {
    let values = HashMap::from([(t, 0.3), (k, 0.7)]);
    let (mut e, mut factorial) = (e, 1.0);
    (0..=order)
        .map(|i| {
            if i > 0 {
                e = g.derivative(e, t);
                factorial *= i as f64;
            }
            g.evaluate(e, &values).unwrap() / factorial
        })
        .collect()
}

fn agree(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
    for (i, (x, y)) in found.iter().zip(expected).enumerate() {
        assert!((x - y).abs() <= tolerance * size, "{what}, order {i}: {x} and {y}\n{found:?}\n{expected:?}");
    }
}

#[test]
fn every_operation_agrees_with_repeated_differentiation() {
    let g = Graph::new();
    let (t, k) = (g.symbol("t"), g.symbol("k"));
    let scope = |name: &str| g.find_symbol(name).map(|s| g.variable(s));
    let inner = "(0.3 + 0.5*t + 0.2*t^2)";
    let mut formulas: Vec<String> = symbolic::Function::ALL
        .iter()
        .map(|f| {
            let shift = if f.name() == "acosh" { " + 1.2" } else { "" };
            format!("{}({inner}{shift})", f.name())
        })
        .collect();
    for formula in [
        "t",
        "7",
        "k",
        "k*t",
        "t*t",
        "t^3",
        "t^7",
        "sin(t)*cos(t)*exp(t)",
        "1/(1 + t^2)",
        "k/(1 + t)",
        "exp(t)/cos(t)",
        "exp(t)/k",
        "sqrt(1 + t)*3",
        "(1 + t)^1.3",
        "(2 + sin(t))^k",
        "k^sin(t)",
        "(2 + t)^cos(t)",
        "(1 + t)^(5/3)",
        "(1 + t)^(3/2)",
        "(1 + t)^(-3/2)",
        "atan2(sin(t), 1 + t)",
        "atan2(k, 1 + t)",
        "atan2(cos(t), k)",
        "cos(k*t) - t*sin(t)",
        "sin(t)^2 - k*cos(t)^2*t + 4",
        "-(sin(t) + t)*(cos(t) - t)",
        "(-t)*(k*exp(t))*(cos(t)/k)",
        "asin(k*sin(t)) + acos(k*sin(t)) + asin(-t)",
        "tan(t)*(1 + tan(t)^2) - tanh(t)/(1 - tanh(t)^2)",
        "exp(sin(exp(-t))) + exp(-t)*sin(exp(-t))",
        "(exp(t) - sin(t))/(2 - t)/(3 - cos(t)) - exp(t)/(2 - t)",
        "log(2 + t)*log(2 + t) - log(1 + sin(t))",
        "sqrt(sin(t) + 1)/sqrt(t + 2)",
    ] {
        formulas.push(formula.to_owned());
    }
    for formula in formulas {
        let e = g.parse(&formula, &scope, &[]).unwrap();
        let order = if g.size(&[e]) > 12 { 7 } else { 10 };
        agree(&formula, &coefficients(&g, t, k, e, order), &derivatives(&g, t, k, e, order), 1e-9);
    }
}
