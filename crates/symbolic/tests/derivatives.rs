//! Series of time derivatives, taken from series one order ahead, against those of their own formulas.

use crate::read;
use std::collections::HashMap;
use symbolic::{Dual, Expr, Graph, LANES, Lanes, Scalar, SeriesInput, SeriesScalar, SeriesTape, Symbol};

const ORDER: usize = 14;

/// `a' = w cos b, b' = v + a/5 + t/9`, `w' = d w + z`, `v' = a d − v`, `2 z + d z/9 − b = 0`.
struct Motion {
    g: Graph,
    inputs: Vec<(Symbol, SeriesInput)>,
    d: Symbol,
    rates: Vec<Expr>,
    residual: Expr,
}

impl Motion {
    fn new() -> Motion {
        let g = Graph::new();
        let [t, k, a, b, w, v, z, d] = ["t", "k", "a", "b", "w", "v", "z", "d"].map(|name| g.symbol(name));
        let rates = ["w*cos(b)", "v + a/5 + t/9", "d*w + z", "a*d - v"].map(|e| read(&g, e)).to_vec();
        let states = [a, b, w, v].into_iter().enumerate().map(|(i, s)| (s, SeriesInput::State(i)));
        let mut inputs = vec![(t, SeriesInput::Time), (k, SeriesInput::Steady)];
        inputs.extend(states);
        inputs.push((z, SeriesInput::Unknown(0)));
        let residual = read(&g, "2*z + d*z/9 - b");
        Motion { g, inputs, d, rates, residual }
    }

    /// `d` is the derivative of `of` along `flow`; declared or not.
    fn tape(&self, of: Expr, declared: bool) -> SeriesTape {
        let g = &self.g;
        let symbol = |i: usize| self.inputs[i].0;
        let mut flow: Vec<(Symbol, Expr)> = (0..3).map(|i| (symbol(2 + i), self.rates[i])).collect();
        flow.push((symbol(5), self.rates[3]));
        flow.push((symbol(0), g.one()));
        let definitions = [(self.d, g.total_derivative(of, &flow))];
        let derivatives = [(self.d, of)];
        let derivatives = &derivatives[..usize::from(declared)];
        let blocks = [vec![self.residual]];
        g.compile_series(&self.inputs, &definitions, &self.rates, &blocks, derivatives, &HashMap::new()).unwrap()
    }
}

/// Coefficients of `a, b, w, v, z`.
fn expand<T: SeriesScalar>(tape: &SeriesTape, start: [T; 7], slope: T) -> Vec<Vec<T>> {
    let mut workspace = tape.workspace::<T>(ORDER);
    tape.expand(&start, T::from_f64(0.3), &mut workspace, 1, &mut |_, r| {
        r[0] = -(r[0] / (T::from_f64(2.0) + slope / T::from_f64(9.0)));
    });
    (2..7).map(|i| tape.input(i, &workspace).unwrap().to_vec()).collect()
}

/// Start values with the unknown solved, and `d` there.
fn start(motion: &Motion, of: Expr) -> ([f64; 7], f64) {
    let mut start = [0.4, 0.7, 0.3, 0.5, 0.8, -0.6, 0.0];
    let g = &motion.g;
    let values: HashMap<Symbol, f64> = motion.inputs.iter().map(|i| i.0).zip(start).collect();
    let flow: Vec<(Symbol, Expr)> = (0..2).map(|i| (motion.inputs[2 + i].0, motion.rates[i])).collect();
    let flow = [flow, vec![(motion.inputs[0].0, g.one())]].concat();
    let slope = g.evaluate(g.total_derivative(of, &flow), &values).unwrap();
    start[6] = start[3] / (2.0 + slope / 9.0);
    (start, slope)
}

fn agree(what: &str, found: &[Vec<f64>], expected: &[Vec<f64>]) {
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let last = if i == 4 { ORDER - 1 } else { ORDER };
        for (k, (x, y)) in found.iter().zip(expected).enumerate().take(last + 1) {
            assert!((x - y).abs() <= 1e-12 * (1.0 + y.abs()), "{what}, series {i}, order {k}: {x} and {y}");
        }
    }
}

/// Functions of positions and time, with all kinds of recurrences.
const LEADING: [&str; 16] = [
    "sin(a)*cos(b)",
    "a^2*b + t*a",
    "k*a/(2 + sin(a - b))",
    "sqrt(1 + a^2)",
    "exp(a*b)",
    "tan(a*b)",
    "tanh(b)*a",
    "asin(a*b/3)",
    "log(2 + a^2)",
    "atan2(1 + a, 2 + b*b)",
    "(2 + a*b)^(3/2)",
    "(2 + a)^b",
    "1/(1 + exp(a - b))",
    "sin(t)*cos(2*t + a)",
    "sqrt(1 + t^2)*exp(t/3)",
    "a*b*cos(a)*sin(b)",
];

#[test]
fn a_derivative_is_the_series_of_what_it_is_one_of() {
    let motion = Motion::new();
    let mut saved = 0;
    for formula in LEADING {
        let of = read(&motion.g, formula);
        let (start, slope) = start(&motion, of);
        let (plain, ahead) = (motion.tape(of, false), motion.tape(of, true));
        let expected = expand(&plain, start, slope);
        agree(formula, &expand(&ahead, start, slope), &expected);
        assert!(ahead.work().0 <= plain.work().0, "{formula}: {:?} and {:?}", ahead.work(), plain.work());
        saved += plain.work().0 - ahead.work().0;

        let lanes = expand(&ahead, start.map(Lanes::from_f64), Lanes([slope; LANES]));
        agree(formula, &mapped(&lanes, |x| x.0[3]), &expected);
        let mut along = start.map(Dual::from_f64);
        (along[2], along[5]) = (Dual::along(start[2], 2), Dual::along(start[5], 5));
        let [plain, ahead] = [plain, ahead].map(|tape| expand(&tape, along, Dual::from_f64(slope)));
        for direction in [2, 5] {
            let tangent = |x: &Dual| x.tangents.0[direction];
            agree(formula, &mapped(&ahead, tangent), &mapped(&plain, tangent));
        }
    }
    assert!(saved >= 20, "{saved} products saved");
}

fn mapped<T>(series: &[Vec<T>], f: impl Fn(&T) -> f64) -> Vec<Vec<f64>> {
    series.iter().map(|row| row.iter().map(&f).collect()).collect()
}

#[test]
fn what_cannot_be_known_ahead_is_computed_by_its_formula() {
    let motion = Motion::new();
    let g = &motion.g;
    let start = [0.4, 0.7, 0.3, 0.5, 0.8, -0.6, 0.1];
    let values: HashMap<Symbol, f64> = motion.inputs.iter().map(|i| i.0).zip(start).collect();
    let compare = |formula: &str, of: &str, rates: &[Expr]| {
        let (d, of) = (read(g, formula), read(g, of));
        let tapes = [vec![], vec![(motion.d, of)]].map(|derivatives| {
            let (definitions, blocks) = ([(motion.d, d)], [vec![motion.residual]]);
            g.compile_series(&motion.inputs, &definitions, rates, &blocks, &derivatives, &HashMap::new()).unwrap()
        });
        assert_eq!(tapes[1].work(), tapes[0].work(), "{formula}");
        let slope = g.evaluate(d, &values).unwrap();
        let [plain, declared] = tapes.map(|tape| expand(&tape, start, slope));
        agree(formula, &declared, &plain);
    };
    // These declarations are false: were they used, coefficients would be others. They contain a state whose
    // rate waits for d, for the unknown, or this itself.
    for of in ["w*a", "a*v", "a + z*b"] {
        compare("cos(b)*v + w/7", of, &motion.rates);
    }
    // the rate of a waits for d
    let waiting = [&[read(g, "w*cos(b) + d*a")], &motion.rates[1..]].concat();
    compare("cos(b)*v + w/7", "a*b", &waiting);
    // the rate of the sine is this product already
    let turning = [&[read(g, "w*cos(b)"), read(g, "v")], &motion.rates[2..]].concat();
    compare("v*cos(b)", "sin(b)", &turning);
}
