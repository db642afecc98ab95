//! Taylor coefficients against repeated symbolic differentiation, identities and closed forms.

use crate::read;
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};
use symbolic::{Expr, Graph, Scalar, SeriesInput, SeriesScalar, SeriesTape, Symbol};

/// Coefficients of `e` in time, to `order`, at `t = 0.3` with `k = 0.7`.
fn coefficients(g: &Graph, t: Symbol, k: Symbol, e: Expr, order: usize) -> Vec<f64> {
    let inputs = [(t, SeriesInput::Time), (k, SeriesInput::Steady)];
    let tape = g.compile_series(&inputs, &[], &[e], &[], &[], &HashMap::new()).unwrap();
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
        let e = read(&g, &formula);
        let order = if g.size(&[e]) > 12 { 7 } else { 10 };
        agree(&formula, &coefficients(&g, t, k, e, order), &derivatives(&g, t, k, e, order), 1e-9);
    }
}

/// Where the seeds of failures are kept.
const SEEDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/series.seeds");

const TERMS: usize = 5;

/// What holds identically in `u`, a polynomial in time with values around 0.4: differences that vanish.
const IDENTITIES: [&str; 22] = [
    "sin(u)^2 + cos(2*u)/2 - 1/2",
    "sin(u)/cos(u) - tan(u)",
    "cosh(u)^2 - cosh(2*u)/2 - 1/2",
    "sinh(u)/cosh(u) - tanh(u)",
    "cosh(u) + sinh(u) - exp(u)",
    "exp(log(u)) - u",
    "log(exp(u)) - u",
    "sin(asin(u)) - u",
    "cos(acos(u)) - u",
    "asin(u) + acos(u) - asin(1)",
    "tan(atan(u)) - u",
    "sinh(asinh(u)) - u",
    "cosh(acosh(1 + u)) - 1 - u",
    "tanh(atanh(u)) - u",
    "atan2(u*sin(u), u*cos(u)) - u",
    "atan2(u, 1) - atan(u)",
    "sqrt(u + 1)*sqrt(u + 2) - sqrt(u^2 + 3*u + 2)",
    "u^1.3 - exp(1.3*log(u))",
    "exp(u*log(u)) - u^u",
    "(u + 1)/(u + 2) + 1/(u + 2) - 1",
    "1/(1/(u + 3) + u) - (u + 3)/(1 + u*(u + 3))",
    "(u + sin(u))*(u - sin(u)) - u^2 + sin(u)^2",
];

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(SEEDS))),
        ..ProptestConfig::default()
    })]

    #[test]
    fn identities_hold_to_every_order(c in prop::collection::vec(-0.05..0.05_f64, TERMS), order in 3..40_usize) {
        let g = Graph::new();
        let (t, u) = (g.symbol("t"), g.symbol("u"));
        let symbols: Vec<Symbol> = (0..TERMS).map(|i| g.symbol(&format!("c{i}"))).collect();
        let terms = symbols.iter().enumerate().map(|(i, s)| g.mul(g.variable(*s), g.powi(g.variable(t), i as i32)));
        let polynomial = terms.fold(g.number(0.4), |sum, term| g.add(sum, term));
        let outputs: Vec<Expr> = IDENTITIES.iter().map(|f| read(&g, f)).collect();
        // None of them is seen to vanish while it is built, which would leave nothing to test.
        for (identity, e) in IDENTITIES.iter().zip(&outputs) {
            prop_assert!(!g.symbols_of(*e).is_empty(), "{identity} is {}", g.plain(*e));
        }
        let mut inputs = vec![(t, SeriesInput::Time)];
        inputs.extend(symbols.iter().map(|s| (*s, SeriesInput::Steady)));
        let tape = g.compile_series(&inputs, &[(u, polynomial)], &outputs, &[], &[], &HashMap::new()).unwrap();
        let mut workspace = tape.workspace::<f64>(order + 1);
        tape.expand(&[vec![0.0], c].concat(), 0.5, &mut workspace, 0, &mut |_, _| {});
        for (i, identity) in IDENTITIES.iter().enumerate() {
            for k in 0..=order {
                let found: f64 = tape.output(i, k, &workspace);
                prop_assert!(found.abs() < 2e-14, "{identity}, order {k}: {found:e}");
            }
        }
    }
}

/// f64 without the kernels of f64.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plain(f64);

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Plain {
            type Output = Plain;
            fn $method(self, other: Plain) -> Plain {
                Plain(self.0.$method(other.0))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Plain {
    type Output = Plain;
    fn neg(self) -> Plain {
        Plain(-self.0)
    }
}

macro_rules! functions {
    ($($name:ident)*) => {$(
        fn $name(self) -> Plain {
            Plain(Scalar::$name(self.0))
        }
    )*};
}

impl Scalar for Plain {
    fn from_f64(x: f64) -> Plain {
        Plain(x)
    }
    fn from_ratio(numerator: i64, denominator: i64) -> Plain {
        Plain(f64::from_ratio(numerator, denominator))
    }
    functions!(sqrt sin cos tan sinh cosh tanh asin acos atan asinh acosh atanh exp log);
    fn powf(self, exponent: Plain) -> Plain {
        Plain(self.0.powf(exponent.0))
    }
    fn atan2(self, x: Plain) -> Plain {
        Plain(self.0.atan2(x.0))
    }
}

impl SeriesScalar for Plain {}

/// A ring of `n` states, each driven by its neighbours; n decides how rows are kept.
fn ring(n: usize) -> SeriesTape {
    let g = Graph::new();
    let x: Vec<Symbol> = (0..n).map(|i| g.symbol(&format!("x{i}"))).collect();
    let rates: Vec<Expr> = (0..n)
        .map(|i| {
            let [a, b, c] = [x[i], x[(i + 1) % n], x[(i + 2) % n]].map(|s| g.variable(s));
            let drive = g.sub(g.call(symbolic::Function::Sin, g.mul(a, b)), g.mul(b, c));
            g.div(drive, g.add(g.integer(2), g.powi(c, 2)))
        })
        .collect();
    let inputs: Vec<(Symbol, SeriesInput)> = x.iter().enumerate().map(|(i, s)| (*s, SeriesInput::State(i))).collect();
    g.compile_series(&inputs, &[], &rates, &[], &[], &HashMap::new()).unwrap()
}

#[test]
fn all_number_types_and_sizes_give_the_same_coefficients() {
    for (n, order) in [(3, 1), (3, 2), (3, 9), (3, 10), (3, 18), (3, 33), (40, 20), (400, 12), (900, 12)] {
        let tape = ring(n);
        let start: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
        let plain_start: Vec<Plain> = start.iter().map(|x| Plain(*x)).collect();
        let (mut fast, mut plain) = (tape.workspace::<f64>(order), tape.workspace::<Plain>(order));
        for _ in 0..2 {
            tape.expand(&start, 0.7, &mut fast, 0, &mut |_, _| {});
            tape.expand(&plain_start, Plain(0.7), &mut plain, 0, &mut |_, _| {});
            for i in 0..n {
                let (a, b) = (tape.input(i, &fast).unwrap(), tape.input(i, &plain).unwrap());
                assert!(a.iter().zip(b).all(|(a, b)| *a == b.0), "{n} states, order {order}, x{i}:\n{a:?}\n{b:?}");
                assert_eq!(a.len(), order + 1);
            }
        }
    }
}

#[test]
fn unknowns_of_implicit_equations_are_series() {
    // z² = 1 + t from z = 1, then 2w + v = z, w − v = t: w = (z + t)/3, v = (z − 2t)/3; x' = z w.
    let g = Graph::new();
    let [t, x, z, w, v] = ["t", "x", "z", "w", "v"].map(|name| g.symbol(name));
    let parse = |formula: &str| read(&g, formula);
    let inputs = [
        (t, SeriesInput::Time),
        (x, SeriesInput::State(0)),
        (z, SeriesInput::Unknown(0)),
        (w, SeriesInput::Unknown(1)),
        (v, SeriesInput::Unknown(1)),
    ];
    let blocks = [vec![parse("z^2 - 1 - t")], vec![parse("2*w + v - z"), parse("w - v - t")]];
    let outputs = [parse("z*w"), parse("w + 2*v")];
    let tape = g.compile_series(&inputs, &[], &outputs, &blocks, &[], &HashMap::new()).unwrap();
    let order = 20;
    let mut workspace = tape.workspace::<f64>(order);
    let start = [0.0, 0.5, 1.0, 1.0 / 3.0, 1.0 / 3.0];
    for sweeps in [1, 2] {
        tape.expand(&start, 1.0, &mut workspace, sweeps, &mut |block, r| match block {
            0 => r[0] /= -2.0,
            _ => (r[0], r[1]) = (-(r[0] + r[1]) / 3.0, -(r[0] - 2.0 * r[1]) / 3.0),
        });
        let expected = |formula: &str| {
            let tape = g.compile_series(&inputs[..1], &[], &[parse(formula)], &[], &[], &HashMap::new()).unwrap();
            let mut workspace = tape.workspace::<f64>(order);
            tape.expand(&[0.0], 1.0, &mut workspace, 0, &mut |_, _| {});
            (0..order).map(|k| tape.output(0, k, &workspace)).collect::<Vec<f64>>()
        };
        let rate = expected("sqrt(1 + t)*(sqrt(1 + t) + t)/3");
        let found: Vec<f64> = tape.input(1, &workspace).unwrap().to_vec();
        assert_eq!(found[0], 0.5);
        let slopes: Vec<f64> = (1..=order).map(|k| k as f64 * found[k]).collect();
        agree("x'", &slopes, &rate, 1e-15);
        agree("z", &tape.input(2, &workspace).unwrap()[..order], &expected("sqrt(1 + t)"), 1e-15);
        agree("w", &tape.input(3, &workspace).unwrap()[..order], &expected("(sqrt(1 + t) + t)/3"), 1e-15);
        agree("v", &tape.input(4, &workspace).unwrap()[..order], &expected("(sqrt(1 + t) - 2*t)/3"), 1e-15);
    }
}

#[test]
fn functions_of_states_are_integrated_and_lines_are_no_series() {
    // x = 0.2 + t/2 and y = 0.3 eᵗ; in terms of time alone nothing is a combination of states.
    let g = Graph::new();
    let [t, x, y, k] = ["t", "x", "y", "k"].map(|name| g.symbol(name));
    let parse = |formula: &str| read(&g, formula);
    let of_time = HashMap::from([(x, parse("0.2 + t/2")), (y, parse("0.3*exp(t)"))]);
    let inputs =
        [(t, SeriesInput::Time), (k, SeriesInput::Steady), (x, SeriesInput::State(0)), (y, SeriesInput::State(1))];
    let functions = ["sin", "cos", "tan", "sinh", "cosh", "tanh", "exp"];
    let arguments = ["y", "x", "-y/k", "k*(x - 2*y) - t + 1", "2 - (t - y)"];
    let mut formulas: Vec<String> =
        functions.iter().flat_map(|f| arguments.map(|a| format!("{f}({a}) + y*{f}({a})"))).collect();
    let lines = ["x*y", "x*x - t*x", "(t - k*x)^2*y", "y/(1 + x)", "1/(t - 3)", "(x + t)/(k - t)*(y - x)*(2*t + 1)"];
    formulas.extend(lines.map(str::to_owned));
    for formula in formulas {
        let e = parse(&formula);
        let outputs = [parse("1/2"), g.variable(y), e];
        let tape = g.compile_series(&inputs, &[], &outputs, &[], &[], &HashMap::new()).unwrap();
        let mut workspace = tape.workspace::<f64>(9);
        let start = [0.3, 0.7, 0.2 + 0.3 / 2.0, 0.3 * 0.3_f64.exp()];
        tape.expand(&start, 1.0, &mut workspace, 0, &mut |_, _| {});
        let found: Vec<f64> = (0..=8).map(|i| tape.output(2, i, &workspace)).collect();
        agree(&formula, &found, &coefficients(&g, t, k, g.substitute_all(&[e], &of_time)[0], 8), 1e-12);
    }
    let work = |formula: &str| {
        let outputs = [parse("1/2"), g.variable(y), parse(formula)];
        g.compile_series(&inputs, &[], &outputs, &[], &[], &HashMap::new()).unwrap().work().0
    };
    assert_eq!((work("x*y"), work("sin(x)*cos(x)"), work("sin(y)*y")), (0, 1, 2));
}

#[test]
fn states_that_do_not_move_are_no_series() {
    let g = Graph::new();
    let [x, y, c] = ["x", "y", "c"].map(|name| g.symbol(name));
    let inputs = [(x, SeriesInput::State(0)), (y, SeriesInput::State(1)), (c, SeriesInput::Steady)];
    let rates = [g.zero(), g.mul(g.variable(x), g.variable(c))];
    let tape = g.compile_series(&inputs, &[], &rates, &[], &[], &HashMap::new()).unwrap();
    assert_eq!(tape.work(), (0, 0));
    let mut workspace = tape.workspace::<f64>(3);
    tape.expand(&[2.0, 1.0, 5.0], 1.0, &mut workspace, 0, &mut |_, _| {});
    assert_eq!(tape.input(0, &workspace), None);
    assert_eq!(tape.input(1, &workspace), Some(&[1.0, 10.0, 0.0, 0.0][..]));
}
