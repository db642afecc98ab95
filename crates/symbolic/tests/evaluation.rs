//! Tapes, vanishing, abbreviation, and expressions of great depth.

use crate::read;
use std::collections::HashMap;
use symbolic::{CompileError, Expr, Function, Graph, Symbol, Vanishing};

fn run(g: &Graph, inputs: &[(&str, f64)], outputs: &[&str]) -> Vec<f64> {
    let symbols: Vec<Symbol> = inputs.iter().map(|(n, _)| g.symbol(n)).collect();
    let values: Vec<f64> = inputs.iter().map(|(_, x)| *x).collect();
    let outputs: Vec<Expr> = outputs.iter().map(|text| read(g, text)).collect();
    let tape = g.compile(&symbols, &outputs, &HashMap::new()).unwrap();
    assert_eq!((tape.inputs(), tape.outputs()), (symbols.len(), outputs.len()));
    let mut results = vec![f64::NAN; outputs.len()];
    let mut workspace = tape.workspace();
    for _ in 0..2 {
        tape.evaluate(&values, &mut workspace, &mut results);
    }
    results
}

#[test]
fn a_tape_has_outputs_of_every_kind() {
    let g = Graph::new();
    let results = run(
        &g,
        &[("x", 2.0), ("y", 3.0)],
        &["x", "x", "7", "sqrt(2)", "x + y", "x + y", "-x - y", "y^-1", "x^5", "x^-3", "x^1.5", "0", "y"],
    );
    let two = 2.0_f64;
    assert_eq!(
        results,
        [2.0, 2.0, 7.0, two.sqrt(), 5.0, 5.0, -5.0, 1.0 / 3.0, 32.0, 0.125, 2.0 * two.sqrt(), 0.0, 3.0]
    );
}

#[test]
fn sine_and_cosine_of_one_angle_are_one_instruction() {
    let g = Graph::new();
    let x = g.symbol("x");
    let outputs = [read(&g, "sin(x)"), read(&g, "cos(x)")];
    let tape = g.compile(&[x], &outputs, &HashMap::new()).unwrap();
    assert_eq!(tape.len(), 1);
    assert_eq!(
        run(&g, &[("x", 0.7)], &["sin(x)", "cos(x)", "sin(x)*cos(x) + cos(x)"])[..2],
        [0.7_f64.sin(), 0.7_f64.cos()]
    );
}

#[test]
fn constants_are_folded_before_the_first_evaluation() {
    let g = Graph::new();
    let (x, k) = (g.symbol("x"), g.symbol("k"));
    let e = read(&g, "sin(k)*sqrt(k)*3 + k^2");
    let tape = g.compile(&[x], &[e], &HashMap::from([(k, 0.3)])).unwrap();
    assert!(tape.is_empty());
    let mut y = [0.0];
    tape.evaluate(&[1.0], &mut tape.workspace(), &mut y);
    assert!((y[0] - (3.0 * 0.3_f64.sin() * 0.3_f64.sqrt() + 0.09)).abs() < 1e-15);
    let product = read(&g, "g*sin(alpha)*x/sqrt(k)");
    let constants = ["g", "alpha", "k"].map(|n| (g.symbol(n), 0.4)).into();
    assert_eq!(g.compile(&[x], &[product], &constants).unwrap().len(), 1);
}

#[test]
fn a_power_too_large_has_a_reciprocal() {
    let g = Graph::new();
    assert_eq!(run(&g, &[("x", 2.0)], &["x + cosh(3)^(-850.5)"]), [2.0]);
    let error = g.compile(&[], &[read(&g, "cosh(3)^850.5")], &HashMap::new()).unwrap_err();
    assert!(matches!(error, CompileError::NotFinite { .. }));
}

#[test]
fn what_cannot_be_compiled_is_named() {
    let g = Graph::new();
    let (x, k) = (g.symbol("x"), g.symbol("k"));
    let unbound = g.compile(&[x], &[read(&g, "x*y")], &HashMap::new()).unwrap_err();
    assert_eq!(unbound, CompileError::Unbound { name: "y".into() });
    let zero = HashMap::from([(k, 0.0)]);
    let singular = g.compile(&[x], &[read(&g, "x/k")], &zero).unwrap_err();
    assert_eq!(singular, CompileError::NotFinite { expression: "x/k".into() });
    let negative = HashMap::from([(k, -2.0)]);
    let root = g.compile(&[x], &[read(&g, "x*log(k)")], &negative).unwrap_err();
    assert_eq!(root, CompileError::NotFinite { expression: "log(-2)".into() });
    let nothing = HashMap::new();
    assert!(matches!(g.evaluate(read(&g, "x"), &nothing), Err(CompileError::Unbound { .. })));
    let at_zero = HashMap::from([(x, 0.0)]);
    assert!(matches!(g.evaluate(read(&g, "1/x"), &at_zero), Err(CompileError::NotFinite { .. })));
    for error in [unbound, singular] {
        assert!(error.to_string().contains('`'));
    }
}

#[test]
#[should_panic(expected = "inputs of a tape")]
fn a_tape_counts_its_inputs() {
    let g = Graph::new();
    let tape = g.compile(&[g.symbol("x")], &[read(&g, "x")], &HashMap::new()).unwrap();
    tape.evaluate(&[], &mut tape.workspace::<f64>(), &mut [0.0]);
}

#[test]
fn tapes_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>(_: &T) {}
    let g = Graph::new();
    shared(&g.compile(&[], &[g.one()], &HashMap::new()).unwrap());
}

#[track_caller]
fn vanishing(text: &str) -> Vanishing {
    let g = Graph::new();
    let e = g.substitute(read(&g, text), &HashMap::from([(g.symbol("pi"), g.pi())]));
    g.vanishes(e, &HashMap::from([(g.symbol("k"), 0.7)]))
}

#[test]
fn identities_vanish_exactly_where_a_normal_form_shows_it() {
    for text in [
        "x - x",
        "(x + y)^2 - x^2 - 2*x*y - y^2",
        "sin(x)^4 - cos(x)^4 - sin(x)^2 + cos(x)^2",
        "sin(2*x) - 2*sin(x)*cos(x)",
        "cos(x - y) - cos(x)*cos(y) - sin(x)*sin(y)",
        "sin(x + k)*cos(k) - cos(x + k)*sin(k) - sin(x)",
        "tan(x)*cos(x) - sin(x)",
        "1 + tan(x)^2 - 1/cos(x)^2",
        "1/(x + y) - (x - y)/(x^2 - y^2)",
        "cosh(2*x) - 1 - 2*sinh(x)^2",
        "(x^2 + y^2)^(3/2)/sqrt(x^2 + y^2) - x^2 - y^2",
        "sin(3*x/2) - 3*sin(x/2) + 4*sin(x/2)^3",
        "sqrt(8) - 2*sqrt(2)",
        "sqrt(2)*sqrt(3)*x - sqrt(6)*x",
        "x/sqrt(6) - sqrt(6)*x/6",
        "2*cos(pi/3)*x - x",
        "sin(x) + sin(x + 2*pi/3) + sin(x + 4*pi/3)",
        "16*sin(pi/12)*cos(pi/12)*x - 4*x",
        "2*cos(7*pi/4) - sqrt(2)",
    ] {
        assert_eq!(vanishing(text), Vanishing::Exactly, "{text}");
    }
}

#[test]
fn other_identities_vanish_numerically() {
    for text in [
        "exp(x)*exp(y) - exp(x + y)",
        "atan(x) + atan(1/x) - atan2(x, 1) - atan2(1/x, 1)",
        "log(x^2*y^2) - log(x^2) - log(y^2)",
        "4*cos(pi/5)*cos(2*pi/5) - 1",
        "asinh(x) - log(x + sqrt(x^2 + 1))",
        "sqrt(x)*sqrt(y)*sqrt(z)*sqrt(u)*sqrt(v) - sqrt(x*y*z*u*v)",
    ] {
        let found = vanishing(text);
        assert!(matches!(found, Vanishing::Numerically { points: 32 }), "{text}: {found:?}");
        assert!(found.is_zero());
    }
}

#[test]
fn what_is_not_zero_is_found_out() {
    for text in ["x", "1e-9", "1e-9*x", "sin(x)^2 + cos(x)^2 - 1 - 1e-9", "sqrt(x^2) - x", "exp(x) - 1 - x"] {
        let found = vanishing(text);
        let Vanishing::No { value, bound } = found else { panic!("{text}: {found:?}") };
        assert!(value.abs() > bound, "{text}");
        assert!(!found.is_zero());
    }
}

#[test]
fn underflow_and_the_cut_of_the_angle_are_not_taken_for_values() {
    let g = Graph::new();
    for text in ["(-4*x)^(477 + 1/3)", "atan2((x + y)*atan2(0, x), x - 1)", "atan2((x - 1)^27, y)"] {
        let e = read(&g, text);
        let found = g.vanishes(g.sub(g.expand(e), e), &HashMap::new());
        assert!(!matches!(found, Vanishing::No { .. }), "{text}: {found:?}");
    }
    // x^477 underflows where (4 x)^477 does not.
    let power = read(&g, "(4*x)^(477 + 1/3) - 4^477*x^477*(4*x)^(1/3)");
    let found = g.vanishes(power, &HashMap::new());
    assert!(!matches!(found, Vanishing::No { .. }), "{found:?}");
    let turned = read(&g, "atan2(-x, -y) - atan2(x, y)");
    assert!(matches!(g.vanishes(turned, &HashMap::new()), Vanishing::No { .. }));
}

#[test]
fn without_a_finite_value_nothing_is_decided() {
    assert!(matches!(vanishing("log(-1 - x^2)"), Vanishing::Undecided { .. }));
}

#[test]
fn abbreviations_put_back_give_the_same_nodes() {
    let g = Graph::new();
    let shared = "(a*x + b*y + sin(z))";
    let long = (0..100).map(|i| format!("a{i}*sin(x + {i})")).collect::<Vec<_>>().join(" + ");
    let es = [
        read(&g, &format!("{shared}^2/(1 + {shared}^2) + cos(z*({long}))")),
        read(&g, &format!("sqrt({shared})*x")),
        read(&g, shared),
        read(&g, &long),
        read(&g, "x"),
    ];
    g.symbol("s2");
    let (definitions, mut rest) = g.abbreviate(&es, "s");
    assert!(definitions.len() >= 3, "{}", definitions.len());
    let names: Vec<String> = definitions.iter().map(|(s, _)| g.name(*s)).collect();
    assert!(names[0] == "s1" && !names.contains(&"s2".to_owned()), "{names:?}");
    for (i, (_, definition)) in definitions.iter().enumerate() {
        let later = definitions[i..].iter().map(|(s, _)| *s);
        assert!(later.into_iter().all(|s| !g.depends_on(*definition, s)), "order of use");
    }
    for e in definitions.iter().map(|(_, e)| *e).chain(rest.iter().copied()) {
        assert!(g.plain(e).len() < 900, "{}", g.plain(e));
    }
    for (symbol, definition) in definitions.into_iter().rev() {
        let back = HashMap::from([(symbol, definition)]);
        rest = rest.into_iter().map(|e| g.substitute(e, &back)).collect();
    }
    assert_eq!(rest, es);
}

#[test]
fn depth_is_no_danger() {
    let g = Graph::new();
    let x = g.symbol("x");
    let mut e = g.variable(x);
    for _ in 0..10_000 {
        e = g.add(g.variable(x), g.call(Function::Sin, e));
    }
    let derivative = g.derivative(e, x);
    let values = HashMap::from([(x, 0.1)]);
    let slope = g.evaluate(derivative, &values).unwrap();
    assert!(slope.is_finite());
    let moved = g.substitute(e, &HashMap::from([(x, g.variable(g.symbol("y")))]));
    assert_eq!(g.symbols_of(moved), [g.symbol("y")].into());
    assert_eq!(g.plain(e).len(), g.plain(moved).len());
    assert!(g.latex(e).len() > 100_000);
    assert_eq!(g.expand(e), e);
    let tape = g.compile(&[x], &[e, derivative], &HashMap::new()).unwrap();
    let mut y = [0.0; 2];
    tape.evaluate(&[0.1], &mut tape.workspace(), &mut y);
    assert!((y[1] - slope).abs() <= 1e-9 * slope.abs());
    let (definitions, _) = g.abbreviate(&[e], "d");
    assert!(!definitions.is_empty());
    assert!(matches!(g.vanishes(e, &HashMap::new()), Vanishing::No { .. }));
    let nested = (0..10_000).fold(g.zero(), |sum, _| g.powi(g.add(sum, g.variable(x)), 2));
    assert!(g.size(&[nested]) > 10_000);
}

#[test]
fn what_switches_on_far_away_does_not_vanish_exactly() {
    let g = Graph::new();
    for text in [
        "1 + tanh(4*(x - 300))",
        "1 + tanh(50*(x - 5))",
        "exp(-(x - 300)^2)",
        "exp(x - 900)",
        "step(x, 500, 900, 0.05)",
        "(sqrt(x) + sqrt(y) + sqrt(z))*y",
        "x - sqrt(x^2)",
        "sin(x) - sinh(x)",
        "x - sin(x)",
        "x^(1/4) - x^(1/2)",
    ] {
        assert!(!g.vanishes_exactly(read(&g, text)), "{text}");
    }
    for text in [
        "tanh(x - 3)*cosh(x - 3) - sinh(x - 3)",
        "1/(x - y) + 1/(y - x)",
        "sin(x - y) - sin(x)*cos(y) + cos(x)*sin(y)",
        "(sin(x)*cos(y)/(cos(x)*sin(y) - sin(x)*cos(y)) + 1)*sin(x - y) + cos(x)*sin(y)",
        "sqrt(x)*(sqrt(x) + 1) - x - sqrt(x)",
        "pi*(x + 1) - pi*x - pi",
    ] {
        assert!(g.vanishes_exactly(read(&g, text)), "{text}");
    }
}

/// Its normal form has more terms than are written; and a value at random points, less than its round-off.
#[test]
fn what_is_too_long_to_multiply_out_is_decided_as_a_rational_function() {
    let g = Graph::new();
    let sum = |i: usize| format!("(a{i}*cos(x{i}) + b{i}*sin(y) + c{i} - d{i}/z)");
    let product = (0..6).map(sum).collect::<Vec<_>>().join("*");
    let zero = format!("({product})*(sin(x0 + y) + w) - ({product})*(sin(x0)*cos(y) + cos(x0)*sin(y)) - ({product})*w");
    let none = HashMap::new();
    assert_eq!(g.vanishes(read(&g, &zero), &none), Vanishing::Exactly);
    assert!(g.vanishes_exactly(read(&g, &zero)));
    let small = read(&g, &format!("{zero} + w*z/10^30"));
    assert!(matches!(g.vanishes(small, &none), Vanishing::Numerically { .. }));
    assert!(!g.vanishes_exactly(small));
    // roots that are no independent numbers
    let roots = read(&g, "(1 + sqrt(x))*(1 - sqrt(x)) - 1 + x");
    assert_eq!(g.vanishes(roots, &none), Vanishing::Exactly);
}
