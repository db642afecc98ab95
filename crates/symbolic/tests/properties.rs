//! Random expressions: the graph against a tree that is evaluated as it was written.

use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use std::collections::HashMap;
use symbolic::{Expr, Function, Graph, Symbol};

const NAMES: [&str; 3] = ["x", "y'", "phi_1"];

/// Where the seeds of failures are kept.
const SEEDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/properties.seeds");

/// An expression as it was written.
#[derive(Clone, Debug)]
enum Tree {
    Variable(usize),
    Number(i64, i64),
    Float(f64),
    Add(Box<Tree>, Box<Tree>),
    Sub(Box<Tree>, Box<Tree>),
    Mul(Box<Tree>, Box<Tree>),
    Div(Box<Tree>, Box<Tree>),
    Power(Box<Tree>, i32),
    Root(Box<Tree>, i64),
    General(Box<Tree>, Box<Tree>),
    Call(Function, Box<Tree>),
    Atan2(Box<Tree>, Box<Tree>),
}

fn trees() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        4 => (0..NAMES.len()).prop_map(Tree::Variable),
        2 => (-6_i64..7, 1_i64..5).prop_map(|(n, d)| Tree::Number(n, d)),
        1 => (-2.0..2.0).prop_map(Tree::Float),
    ];
    leaf.prop_recursive(5, 24, 2, |inner| {
        let pair = (inner.clone(), inner.clone()).prop_map(|(a, b)| (Box::new(a), Box::new(b)));
        let one = inner.prop_map(Box::new);
        prop_oneof![
            3 => pair.clone().prop_map(|(a, b)| Tree::Add(a, b)),
            3 => pair.clone().prop_map(|(a, b)| Tree::Sub(a, b)),
            4 => pair.clone().prop_map(|(a, b)| Tree::Mul(a, b)),
            2 => pair.clone().prop_map(|(a, b)| Tree::Div(a, b)),
            2 => (one.clone(), -3..4).prop_map(|(a, n)| Tree::Power(a, n)),
            1 => (one.clone(), 2_i64..4).prop_map(|(a, n)| Tree::Root(a, n)),
            1 => pair.clone().prop_map(|(a, b)| Tree::General(a, b)),
            4 => (one, 0..Function::ALL.len()).prop_map(|(a, f)| Tree::Call(Function::ALL[f], a)),
            1 => pair.prop_map(|(a, b)| Tree::Atan2(a, b)),
        ]
    })
}

fn build(g: &Graph, tree: &Tree) -> Expr {
    let of = |tree: &Tree| build(g, tree);
    match tree {
        Tree::Variable(i) => g.variable(g.symbol(NAMES[*i])),
        Tree::Number(n, d) => g.ratio(*n, *d),
        Tree::Float(x) => g.number(*x),
        Tree::Add(a, b) => g.add(of(a), of(b)),
        Tree::Sub(a, b) => g.sub(of(a), of(b)),
        Tree::Mul(a, b) => g.mul(of(a), of(b)),
        Tree::Div(a, b) => g.div(of(a), of(b)),
        Tree::Power(a, n) => g.powi(of(a), *n),
        Tree::Root(a, n) => g.pow(of(a), g.ratio(1, *n)),
        Tree::General(a, b) => g.pow(of(a), of(b)),
        Tree::Call(f, a) => g.call(*f, of(a)),
        Tree::Atan2(a, b) => g.atan2(of(a), of(b)),
    }
}

/// Several times what one operation in `f64` rounds off.
const NEARBY: f64 = 1e-12;

/// A value and a bound of the round-off in it, in units of the relative round-off.
#[derive(Clone, Copy, Debug)]
struct Value {
    value: f64,
    error: f64,
}

impl Value {
    fn mapped(self, f: impl Fn(f64) -> f64) -> Value {
        if self.value.is_nan() {
            return self;
        }
        // What round-off in x does, not f'(x): near x = 1 arcsin turns 1e-12 into 1e-6.
        let h = NEARBY * self.error;
        let value = f(self.value);
        let change = (f(self.value + h) - value).abs().max((f(self.value - h) - value).abs());
        Value { value, error: value.abs() + change / NEARBY }
    }
}

/// The value as written; not a number if anything on the way is not finite.
fn value(tree: &Tree, at: &[f64; 3]) -> Value {
    let found = unchecked_value(tree, at);
    if found.value.is_finite() && found.error.is_finite() {
        return found;
    }
    Value { value: f64::NAN, error: f64::NAN }
}

fn unchecked_value(tree: &Tree, at: &[f64; 3]) -> Value {
    let of = |tree: &Tree| value(tree, at);
    let exact = |value: f64| Value { value, error: value.abs() };
    match tree {
        Tree::Variable(i) => exact(at[*i]),
        Tree::Number(n, d) => exact(*n as f64 / *d as f64),
        Tree::Float(x) => exact(*x),
        Tree::Add(a, b) | Tree::Sub(a, b) => {
            let (a, b) = (of(a), of(b));
            let sign = if matches!(tree, Tree::Add(..)) { 1.0 } else { -1.0 };
            Value { value: a.value + sign * b.value, error: a.error + b.error }
        }
        Tree::Mul(a, b) => {
            let (a, b) = (of(a), of(b));
            let error = a.error * b.value.abs() + a.value.abs() * b.error;
            Value { value: a.value * b.value, error }
        }
        Tree::Div(a, b) => {
            let (a, b) = (of(a), of(b));
            let value = a.value / b.value;
            Value { value, error: (a.error + value.abs() * b.error) / b.value.abs() }
        }
        Tree::Power(a, n) => of(a).mapped(|x| x.powi(*n)),
        Tree::Root(a, n) => of(a).mapped(|x| x.powf(1.0 / *n as f64)),
        Tree::General(a, b) => {
            let (a, b) = (of(a), of(b));
            if a.value.is_nan() || b.value.is_nan() {
                return exact(f64::NAN);
            }
            let by_base = a.mapped(|x| x.powf(b.value));
            let by_exponent = b.mapped(|y| a.value.powf(y));
            Value { value: by_base.value, error: by_base.error + by_exponent.error }
        }
        Tree::Call(f, a) => of(a).mapped(function(*f)),
        Tree::Atan2(a, b) => {
            let (a, b) = (of(a), of(b));
            // At y = 0 the sign of a zero would decide on which side of the cut it is.
            if a.value == 0.0 || a.value.is_nan() || b.value.is_nan() {
                return exact(f64::NAN);
            }
            let by_y = a.mapped(|y| y.atan2(b.value));
            let by_x = b.mapped(|x| a.value.atan2(x));
            Value { value: by_y.value, error: by_y.error + by_x.error }
        }
    }
}

fn function(f: Function) -> fn(f64) -> f64 {
    match f {
        Function::Sin => f64::sin,
        Function::Cos => f64::cos,
        Function::Tan => f64::tan,
        Function::Sinh => f64::sinh,
        Function::Cosh => f64::cosh,
        Function::Tanh => f64::tanh,
        Function::Asin => f64::asin,
        Function::Acos => f64::acos,
        Function::Atan => f64::atan,
        Function::Asinh => f64::asinh,
        Function::Acosh => f64::acosh,
        Function::Atanh => f64::atanh,
        Function::Exp => f64::exp,
        Function::Log => f64::ln,
    }
}

fn symbols(g: &Graph) -> [Symbol; 3] {
    NAMES.map(|name| g.symbol(name))
}

fn by_tape(g: &Graph, e: Expr, at: &[f64; 3]) -> Option<f64> {
    let tape = g.compile(&symbols(g), &[e], &HashMap::new()).ok()?;
    let mut output = [0.0];
    tape.evaluate(at, &mut tape.workspace(), &mut output);
    Some(output[0])
}

/// The values agree to round-off, unless the tree as written is singular or very ill conditioned.
fn check(g: &Graph, e: Expr, expected: Value, at: &[f64; 3]) -> Result<(), TestCaseError> {
    let bound = NEARBY * expected.error + f64::MIN_POSITIVE;
    prop_assume!(expected.value.is_finite() && expected.error.is_finite());
    prop_assume!(bound < 1e-3 * (1.0 + expected.value.abs()));
    let found = by_tape(g, e, at);
    prop_assert!(
        found.is_some_and(|found| (found - expected.value).abs() <= bound),
        "{found:?} instead of {expected:?} for {}",
        g.plain(e)
    );
    let values: HashMap<Symbol, f64> = symbols(g).into_iter().zip(*at).collect();
    let slowly = g.evaluate(e, &values);
    prop_assert!(slowly.is_ok_and(|found| (found - expected.value).abs() <= bound));
    Ok(())
}

fn points() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(prop_oneof![0.2..1.3, -1.3..-0.2])
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 600,
        max_global_rejects: 100_000,
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(SEEDS))),
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_tape_computes_what_was_written(tree in trees(), at in points()) {
        let g = Graph::new();
        check(&g, build(&g, &tree), value(&tree, &at), &at)?;
    }

    #[test]
    fn derivatives_are_limits_of_differences(tree in trees(), at in points(), i in 0_usize..3) {
        let g = Graph::new();
        let derivative = g.derivative(build(&g, &tree), symbols(&g)[i]);
        let difference = |h: f64| {
            let shifted = |step: f64| {
                let mut at = at;
                at[i] += step;
                value(&tree, &at)
            };
            let (after, before) = (shifted(h), shifted(-h));
            let error = (after.error + before.error) / h;
            Value { value: (after.value - before.value) / (2.0 * h), error }
        };
        let [coarse, fine, finer] = [4e-4, 2e-4, 1e-4].map(difference);
        let limit = (4.0 * finer.value - fine.value) / 3.0;
        let before = (4.0 * fine.value - coarse.value) / 3.0;
        let bound = 1e-6 * (1.0 + limit.abs()) + 10.0 * (limit - before).abs() + 1e-14 * finer.error;
        prop_assume!(limit.is_finite() && bound < 1e-3 * (1.0 + limit.abs()));
        // Where a function has run into its limit (asin(tanh(100))), its slope is 0/0 in floats.
        let found = by_tape(&g, derivative, &at);
        prop_assume!(found.is_some_and(f64::is_finite));
        prop_assert!(
            found.is_some_and(|found| (found - limit).abs() <= bound),
            "{found:?} instead of {limit} ± {bound}: {}",
            g.plain(derivative)
        );
    }

    #[test]
    fn plain_text_reads_back_to_the_same_node(tree in trees()) {
        let g = Graph::new();
        let e = build(&g, &tree);
        let scope = |name: &str| g.find_symbol(name).map(|s| g.variable(s));
        for e in [e, g.derivative(e, symbols(&g)[0])] {
            prop_assume!(g.as_number(e).is_none_or(f64::is_finite));
            let text = g.plain(e);
            let back = g.parse(&text, &scope);
            prop_assert!(back == Ok(e), "{text} gave {:?}", back.map(|e| g.plain(e)));
        }
    }

    #[test]
    fn latex_has_balanced_braces(tree in trees()) {
        let g = Graph::new();
        let latex = g.latex(build(&g, &tree));
        let mut depth = 0;
        for c in latex.chars() {
            depth += i32::from(c == '{') - i32::from(c == '}');
            prop_assert!(depth >= 0, "{latex}");
        }
        prop_assert_eq!(depth, 0);
        prop_assert_eq!(latex.matches(r"\left(").count(), latex.matches(r"\right)").count());
    }

    #[test]
    fn expansion_keeps_the_value(tree in trees(), at in points()) {
        let g = Graph::new();
        let e = build(&g, &tree);
        let expanded = g.expand(e);
        let mut expected = value(&tree, &at);
        // Powers of sums multiplied out cancel more than the sums themselves.
        prop_assume!(g.size(&[expanded]) < 40);
        expected.error = 1e4 * expected.error + 1e3;
        check(&g, expanded, expected, &at)?;
    }

    #[test]
    fn substitution_is_evaluation_elsewhere(
        outer in trees(),
        inner in trees(),
        at in points(),
    ) {
        let g = Graph::new();
        let [x, ..] = symbols(&g);
        let map = HashMap::from([(x, build(&g, &inner))]);
        let composed = g.substitute(build(&g, &outer), &map);
        let moved = value(&inner, &at);
        prop_assume!(moved.value.is_finite() && moved.value.abs() < 10.0);
        let mut expected = value(&outer, &[moved.value, at[1], at[2]]);
        for h in [NEARBY * moved.error, -NEARBY * moved.error] {
            let nearby = value(&outer, &[moved.value + h, at[1], at[2]]);
            expected.error += (nearby.value - expected.value).abs() / NEARBY;
        }
        check(&g, composed, expected, &at)?;
    }

    #[test]
    fn a_difference_with_itself_rewritten_vanishes(tree in trees()) {
        let g = Graph::new();
        let e = build(&g, &tree);
        prop_assume!(g.as_number(e).is_none_or(f64::is_finite));
        let found = g.vanishes(g.sub(g.expand(e), e), &HashMap::new());
        prop_assert!(!matches!(found, symbolic::Vanishing::No { .. }), "{found:?}: {}", g.plain(e));
    }

    #[test]
    fn abbreviations_put_back_give_the_same_node(tree in trees(), other in trees()) {
        let g = Graph::new();
        let e = build(&g, &tree);
        let es = [g.mul(e, build(&g, &other)), g.derivative(e, symbols(&g)[0]), e];
        let (definitions, mut rest) = g.abbreviate(&es, "s");
        for (symbol, definition) in definitions.into_iter().rev() {
            let back = HashMap::from([(symbol, definition)]);
            rest = g.substitute_all(&rest, &back);
        }
        prop_assert_eq!(rest, es);
    }

    #[test]
    fn any_text_is_read_or_refused_in_its_place(text in "[-+*/^(),.x'0-9e sinq\n=φ]{0,40}") {
        let g = Graph::new();
        let scope = |name: &str| (name == "x").then(|| g.variable(g.symbol(name)));
        if let Err(error) = g.parse(&text, &scope) {
            prop_assert!(error.offset + error.length <= text.len());
            prop_assert!(text.is_char_boundary(error.offset));
            prop_assert!(text.is_char_boundary(error.offset + error.length));
            prop_assert!(error.to_string().contains('^'));
        }
    }
}
