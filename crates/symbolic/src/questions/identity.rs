//! Is an expression identically zero?

use crate::limits::{POINTS, TERMS};
use crate::store::arena::Arena;
use crate::{Bounded, Evaluator, Expr, Graph, Scalar, SplitMix, Symbol, faults};
use std::collections::HashMap;

/// Points tried, at most, to find those where the value is finite.
const TRIES: usize = 20 * POINTS;
/// The answer to the question whether an expression is identically zero.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Vanishing {
    /// Zero for all values of its symbols: its normal form is the number zero, or it is zero as a rational
    /// function of symbols, sines, roots and other functions. Only this allows to take it out of an equation.
    Exactly,
    /// Zero within round-off at `points` random points; it may differ from zero elsewhere.
    Numerically {
        /// How many points.
        points: usize,
    },
    /// Not zero: `value` was found where round-off is at most `bound`.
    No {
        /// The value at one point.
        value: f64,
        /// What round-off can amount to there.
        bound: f64,
    },
    /// Of `tried` random points, too few had a finite value.
    Undecided {
        /// How many points.
        tried: usize,
    },
}

impl Vanishing {
    /// Is it zero, exactly or numerically?
    ///
    /// ```
    /// assert!(symbolic::Vanishing::Numerically { points: 32 }.is_zero());
    /// ```
    pub fn is_zero(self) -> bool {
        matches!(self, Vanishing::Exactly | Vanishing::Numerically { .. })
    }
}

impl Graph {
    /// Is `e` identically zero? Exact in a finite field or by expansion where that succeeds, else at random
    /// points (fixed seed; both signs, sizes from 0.01 to 100) against the round-off bound of the evaluation.
    /// `values` of symbols are those at the points; what is exact is so for all values, since a float is none
    /// that is known exactly.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// use symbolic::{Graph, Vanishing};
    /// let g = Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let square = g.powi(g.add(x, g.one()), 2);
    /// let rest = g.sum(&[square, g.neg(g.powi(x, 2)), g.mul(g.integer(-2), x), g.integer(-1)]);
    /// assert_eq!(g.vanishes(rest, &HashMap::new()), Vanishing::Exactly);
    /// let k = g.symbol("k");
    /// let rest = g.sub(g.mul(g.variable(k), x), g.mul(g.ratio(1, 2), x));
    /// assert!(matches!(g.vanishes(rest, &HashMap::from([(k, 0.5)])), Vanishing::Numerically { .. }));
    /// ```
    #[track_caller]
    pub fn vanishes(&self, e: Expr, values: &HashMap<Symbol, f64>) -> Vanishing {
        match self.vanishes_in_truth(e, values) {
            answer if !faults::goes_wrong("answer turned") => answer,
            answer if answer.is_zero() => Vanishing::No { value: 1.0, bound: 0.0 },
            _ => Vanishing::Exactly,
        }
    }

    /// Whether `e` is identically zero, for all values of its symbols: as a rational function of its symbols,
    /// sines, roots and other functions, or by its normal form. Such an `e` may be removed from equations.
    /// `false` where this is undecided.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// // 1 + tanh(4 (x − 30)) is zero to the last digit for all x under 20, and 2 beyond 40
    /// let far = g.mul(g.integer(4), g.sub(x, g.integer(30)));
    /// assert!(!g.vanishes_exactly(g.add(g.one(), g.call(symbolic::Function::Tanh, far))));
    /// ```
    #[track_caller]
    pub fn vanishes_exactly(&self, e: Expr) -> bool {
        let zero =
            self.arena.borrow().is_zero_rational(e) || self.vanishes_in_truth(e, &HashMap::new()) == Vanishing::Exactly;
        zero != faults::goes_wrong("answer turned")
    }

    /// Whether the value of `e` at these values of its symbols is zero up to round-off, so that it must not
    /// divide.
    pub fn is_round_off(&self, e: Expr, values: &HashMap<Symbol, f64>) -> bool {
        self.bounded(e, values).is_some_and(Bounded::may_be_zero)
    }

    /// The value of `e` at these values of its symbols, with the size of what is added up to it: NaN where a
    /// symbol has no value; `None` where `e` cannot be compiled.
    pub fn bounded(&self, e: Expr, values: &HashMap<Symbol, f64>) -> Option<Bounded> {
        let symbols: Vec<Symbol> = self.symbols_of(e).into_iter().collect();
        let tape = self.compile(&symbols, &[e], &HashMap::new()).ok()?;
        let number = |s: &Symbol| Bounded::from_f64(values.get(s).copied().unwrap_or(f64::NAN));
        let inputs: Vec<Bounded> = symbols.iter().map(number).collect();
        Some(Evaluator::new(tape).evaluate(&inputs)[0])
    }

    fn vanishes_in_truth(&self, e: Expr, values: &HashMap<Symbol, f64>) -> Vanishing {
        if e == Arena::ZERO {
            return Vanishing::Exactly;
        }
        let sampled = self.sample(e, values);
        if matches!(sampled, Vanishing::No { .. }) {
            return sampled;
        }
        let mut arena = self.arena.borrow_mut();
        let by_normal_form = |arena: &mut Arena| arena.normal_numerator(e, TERMS) == Some(Arena::ZERO);
        let zero = arena.is_zero_split(e).unwrap_or_else(|| by_normal_form(&mut arena));
        if zero { Vanishing::Exactly } else { sampled }
    }

    /// The numerical test, at these values of symbols.
    fn sample(&self, e: Expr, values: &HashMap<Symbol, f64>) -> Vanishing {
        let symbols: Vec<Symbol> = self.symbols_of(e).into_iter().collect();
        let Ok(tape) = self.compile(&symbols, &[e], &HashMap::new()) else {
            return Vanishing::Undecided { tried: 0 };
        };
        let mut evaluator = Evaluator::new(tape);
        let mut random = SplitMix::new(0x5eed);
        let mut inputs = vec![Bounded::from_f64(0.0); symbols.len()];
        let (mut points, mut tried) = (0, 0);
        while points < POINTS && tried < TRIES {
            for (x, symbol) in inputs.iter_mut().zip(&symbols) {
                let drawn = || coordinate(&mut random, tried);
                *x = Bounded::from_f64(values.get(symbol).copied().unwrap_or_else(drawn));
            }
            tried += 1;
            let output = evaluator.evaluate(&inputs)[0];
            if !output.is_finite() {
                continue;
            }
            if !output.may_be_zero() {
                return Vanishing::No { value: output.value, bound: output.round_off() };
            }
            points += 1;
        }
        if points < POINTS { Vanishing::Undecided { tried } } else { Vanishing::Numerically { points } }
    }
}

/// In turns: in [0.2, 1.3], where roots and logarithms are finite; the same with random signs; of sizes from
/// 0.01 to 100.
fn coordinate(random: &mut SplitMix, tried: usize) -> f64 {
    let bits = random.bits();
    let part = (bits >> 11) as f64 / (1_u64 << 53) as f64;
    let signed = |x: f64| if bits & 1 == 1 { -x } else { x };
    match tried % 4 {
        0 => 0.2 + 1.1 * part,
        1 => signed(0.2 + 1.1 * part),
        _ => signed(100.0_f64.powf(2.0 * part - 1.0)),
    }
}
