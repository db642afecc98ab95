//! Quotients whose parts overflow where they themselves are moderate: values, derivatives, series, number
//! types.

use crate::read;
use std::collections::HashMap;
use symbolic::{Bounded, Expr, Graph, LANES, Lanes, Range, Scalar, SeriesInput, Symbol};

/// Formulas in `u`, each with its limits for u → −∞ and u → ∞.
const SATURATING: [(&str, f64, f64); 30] = [
    ("1/(1 + exp(u))", 1.0, 0.0),
    ("1/(1 + exp(-u))", 0.0, 1.0),
    ("3/(2 + 5*exp(u))", 1.5, 0.0),
    ("-7/(2*exp(u) + 4)", -1.75, 0.0),
    ("exp(u)/(1 + exp(u))", 0.0, 1.0),
    ("exp(u)/(1 + exp(u))^2", 0.0, 0.0),
    ("exp(2*u)/(1 + exp(u))^2", 0.0, 1.0),
    ("(exp(u) - 1)/(exp(u) + 1)", -1.0, 1.0),
    ("(2 + 3*exp(u))/(1 + exp(u))", 2.0, 3.0),
    ("1/(exp(u) + exp(-u))", 0.0, 0.0),
    ("(exp(u) - exp(-u))/(exp(u) + exp(-u))", -1.0, 1.0),
    ("1/(1 + exp(2*u) + exp(3*u))", 1.0, 0.0),
    ("1/(1 + 2*exp(u) + exp(2*u))", 1.0, 0.0),
    ("1/(1 + exp(-(u - 7)/0.009))", 0.0, 1.0),
    ("1/(1 + exp((u - 2)/k))", 1.0, 0.0),
    ("k/(k + k^2*exp(u))", 1.0, 0.0),
    ("1/(2 + sin(u)*0 + exp(u))/(1 + exp(-u))", 0.0, 0.0),
    ("1/cosh(u)", 0.0, 0.0),
    ("1/cosh((u - 7)/0.01)^2", 0.0, 0.0),
    ("1/cosh(u)^5", 0.0, 0.0),
    ("sinh(u)/cosh(u)", -1.0, 1.0),
    ("sinh(u)^3/cosh(u)^3", -1.0, 1.0),
    ("sinh(u)/cosh(u)^2", 0.0, 0.0),
    ("sinh(u)^2/(1 + sinh(u)^2)", 1.0, 1.0),
    ("1/(2 + 3*cosh(u))", 0.0, 0.0),
    ("(1 + cosh(u))/(2 + cosh(u))", 1.0, 1.0),
    ("exp(u)/cosh(u)", 0.0, 2.0),
    ("exp(-u)/(3*cosh(u) + sinh(u))", 1.0, 0.0),
    ("1/(exp(u)/3 + 2)^(1/2)", std::f64::consts::FRAC_1_SQRT_2, 0.0),
    ("(cosh(u) - 2)*(1 + sinh(u))/(cosh(u)^2 + 1)", -1.0, 1.0),
];

fn names(g: &Graph) -> [Symbol; 3] {
    ["u", "k", "t"].map(|name| g.symbol(name))
}

#[test]
fn values_and_derivatives_are_finite_and_right_far_beyond_where_parts_overflow() {
    for (text, low, high) in SATURATING {
        let g = Graph::new();
        let [u, k, _] = names(&g);
        let e = read(&g, text);
        let (d, mut all) = (g.derivative(e, u), vec![e]);
        all.extend([d, g.derivative(d, u)]);
        let tape = g.compile(&[u], &all, &HashMap::from([(k, 0.5)])).unwrap();
        let (mut registers, mut y) = (tape.workspace::<f64>(), [0.0; 3]);
        for far in [50.0, 400.0, 720.0, 2e3, 1e5, 1e9] {
            for (at, limit) in [(-far, low), (far, high)] {
                tape.evaluate(&[at], &mut registers, &mut y);
                assert!((y[0] - limit).abs() < 1e-7, "{text} at {at}: {} for {limit}", y[0]);
                assert!(y[1].abs() < 1e-7 && y[2].abs() < 1e-4, "{text} at {at}: {y:?}");
                let near = [Bounded::from_f64(at)];
                let mut found = [Bounded::from_f64(0.0); 3];
                tape.evaluate(&near, &mut tape.workspace(), &mut found);
                assert!(found.iter().all(|b| b.is_finite() && b.round_off() < 1e-4), "{text} at {at}: {found:?}");
                let mut lanes = [Lanes::from_f64(0.0); 3];
                tape.evaluate(&[Lanes([at; LANES])], &mut tape.workspace(), &mut lanes);
                assert!((0..3).all(|i| lanes[i].0 == [y[i]; LANES]), "{text} at {at}");
                let value = g.evaluate(e, &HashMap::from([(u, at), (k, 0.5)])).unwrap();
                assert!((value - limit).abs() < 1e-7, "{text} at {at}: {value}");
            }
        }
    }
}

/// What the parts give where none overflows, by differences of five points.
#[test]
fn values_and_slopes_are_those_of_the_formula_where_nothing_overflows() {
    for (text, ..) in SATURATING {
        let g = Graph::new();
        let [u, k, _] = names(&g);
        let e = read(&g, text);
        // each factor by itself: no quotient that could be scaled
        let parts = ["exp", "sinh", "cosh"].map(|f| (f, g.symbol(&format!("{f}_u"))));
        let plain = |at: f64| -> f64 {
            let mut values: HashMap<Expr, Expr> = HashMap::new();
            for f in symbolic::Function::ALL.into_iter().filter(|f| parts.iter().any(|(name, _)| *name == f.name())) {
                for argument in ["u", "-u", "2*u", "3*u", "-(u - 7)/0.009", "(u - 2)/k", "(u - 7)/0.01"] {
                    let x = read(&g, argument);
                    let number = g.evaluate(x, &HashMap::from([(u, at), (k, 0.5)])).unwrap();
                    values.insert(g.call(f, x), g.number(f.apply(number)));
                }
            }
            g.evaluate(g.replace(e, &values), &HashMap::from([(u, at), (k, 0.5)])).unwrap()
        };
        let tape = g.compile(&[u], &[e, g.derivative(e, u)], &HashMap::from([(k, 0.5)])).unwrap();
        for at in [-1.7, -0.31, 0.02, 0.4, 1.9, 6.998, 7.003] {
            let (mut y, h) = ([0.0; 2], 1e-4);
            tape.evaluate(&[at], &mut tape.workspace(), &mut y);
            let expected = plain(at);
            assert!(
                (y[0] - expected).abs() <= 1e-12 * (1.0 + expected.abs()),
                "{text} at {at}: {} for {expected}",
                y[0]
            );
            let slope =
                (8.0 * (plain(at + h) - plain(at - h)) - plain(at + 2.0 * h) + plain(at - 2.0 * h)) / (12.0 * h);
            assert!((y[1] - slope).abs() <= 1e-5 * (1.0 + slope.abs()), "{text} at {at}: {} for {slope}", y[1]);
        }
    }
}

#[test]
fn series_are_finite_everywhere_and_those_of_repeated_differentiation() {
    for (text, low, high) in SATURATING {
        let g = Graph::new();
        let [u, k, t] = names(&g);
        // along a line in time, which is integrated, and along a curve, which is not
        for path in ["t", "t + 0.1*t^2"] {
            let e = g.substitute(read(&g, text), &HashMap::from([(u, read(&g, path))]));
            let inputs = [(t, SeriesInput::Time), (k, SeriesInput::Steady)];
            let tape = g.compile_series(&inputs, &[], &[e], &[], &[], &HashMap::new()).unwrap();
            let mut workspace = tape.workspace::<f64>(9);
            for at in [-1e4, -900.0, -1.3, 0.4, 6.99, 7.004, 900.0, 1e6] {
                tape.expand(&[at, 0.5], 1e-3, &mut workspace, 1, &mut |_, _| {});
                let found: Vec<f64> = (0..=8).map(|i| tape.output(0, i, &workspace)).collect();
                assert!(found.iter().all(|c| c.is_finite()), "{text} along {path} at {at}: {found:?}");
                if at.abs() > 800.0 {
                    let limit = if at < 0.0 && path == "t" { low } else { high };
                    assert!((found[0] - limit).abs() < 1e-7, "{text} along {path} at {at}: {found:?}");
                    continue;
                }
                let (mut derivative, mut factor) = (e, 1.0);
                for (i, c) in found.iter().enumerate().take(5) {
                    let expected = g.evaluate(derivative, &HashMap::from([(t, at), (k, 0.5)])).unwrap() * factor;
                    let size = found.iter().fold(1e-3, |a: f64, x| a.max(x.abs()));
                    assert!(
                        (c - expected).abs() < 1e-9 * size,
                        "{text} along {path} at {at}, order {i}: {c} {expected}"
                    );
                    derivative = g.derivative(derivative, t);
                    factor *= 1e-3 / (i + 1) as f64;
                }
            }
        }
    }
}

#[test]
fn what_saturates_is_steep_near_its_change_only() {
    for (text, ..) in SATURATING {
        let g = Graph::new();
        let [u, k, _] = names(&g);
        let known = HashMap::from([(k, Range::point(0.5))]);
        for steep in g.steep(&[read(&g, text)], &known) {
            let tape = g.compile(&[u, k], &[steep.argument], &HashMap::new()).unwrap();
            let gauge = |at: f64| {
                let mut y = [0.0];
                tape.evaluate(&[at, 0.5], &mut tape.workspace(), &mut y);
                (steep.gauge)(y[0])
            };
            for (from, to) in [(-1e9, -100.0), (100.0, 1e9)] {
                assert!(
                    (gauge(to) - gauge(from)).abs() < 1e-9,
                    "{text}: {} {}",
                    steep.function,
                    g.plain(steep.argument)
                );
            }
        }
        assert!(!g.steep(&[read(&g, text)], &known).is_empty(), "{text}");
    }
}

#[test]
fn a_narrow_change_far_from_the_origin_loses_nothing() {
    // the argument is a small difference of large numbers, exactly
    for (text, at, expected) in [
        ("tanh((t - 1000007)/0.01)", 1_000_007.0 + 1.0 / 1024.0, (100.0_f64 / 1024.0).tanh()),
        ("1/cosh((t - 1700000007)/0.01)^2", 1_700_000_007.0 - 1.0 / 512.0, (100.0_f64 / 512.0).cosh().powi(-2)),
        ("exp(-((t - 1700000007.5)/0.009)^2)", 1_700_000_007.5 + 1.0 / 256.0, (-(1.0_f64 / 2.304).powi(2)).exp()),
        ("1/(1 + exp(-(t - 1000007)/0.009))", 1_000_007.0, 0.5),
        ("sin(3*(t - 1700000000))", 1_700_000_000.125, 0.375_f64.sin()),
    ] {
        let g = Graph::new();
        let t = g.symbol("t");
        let tape = g.compile(&[t], &[read(&g, text)], &HashMap::new()).unwrap();
        let mut y = [0.0];
        tape.evaluate(&[at], &mut tape.workspace(), &mut y);
        assert!((y[0] - expected).abs() < 4e-16, "{text}: {} for {expected}", y[0]);
    }
}
