//! Is an expression identically zero?

use crate::arena::Arena;
use crate::{Bounded, Evaluator, Expr, Graph, Scalar, SplitMix, Symbol, faults};
use std::collections::HashMap;

/// Terms beyond which the exact test gives up.
const TERM_LIMIT: usize = 400;
/// Random points of the numerical test.
const POINTS: usize = 32;
/// Points that may be tried to find so many where the value is finite.
const TRIES: usize = 20 * POINTS;
/// The answer to the question whether an expression is identically zero.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Vanishing {
    /// It simplifies to the number zero.
    Exactly,
    /// Zero within round-off at `points` random points.
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
    /// The value was finite at none of `tried` random points.
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
    /// Is `e` identically zero? Exact by expansion where that succeeds, else by evaluation at random
    /// points (fixed seed) against the round-off bound of the evaluation itself. `constants` are
    /// numbers to put in first; where they do not stay exact, what they cancel to is round-off as well.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// use symbolic::{Graph, Vanishing};
    /// let g = Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let square = g.powi(g.add(x, g.one()), 2);
    /// let rest = g.sum(&[square, g.neg(g.powi(x, 2)), g.mul(g.integer(-2), x), g.integer(-1)]);
    /// assert_eq!(g.vanishes(rest, &HashMap::new()), Vanishing::Exactly);
    /// ```
    #[track_caller]
    pub fn vanishes(&self, e: Expr, constants: &HashMap<Symbol, f64>) -> Vanishing {
        self.answer(e, constants, true)
    }

    /// [`Graph::vanishes`] without the expansion, which takes most of the time, where points decide.
    #[track_caller]
    pub fn vanishes_at_points(&self, e: Expr, constants: &HashMap<Symbol, f64>) -> Vanishing {
        self.answer(e, constants, false)
    }

    #[track_caller]
    fn answer(&self, e: Expr, constants: &HashMap<Symbol, f64>, exactly: bool) -> Vanishing {
        match self.vanishes_in_truth(e, constants, exactly) {
            answer if !faults::goes_wrong("answer turned") => answer,
            answer if answer.is_zero() => Vanishing::No { value: 1.0, bound: 0.0 },
            _ => Vanishing::Exactly,
        }
    }

    fn vanishes_in_truth(&self, open: Expr, constants: &HashMap<Symbol, f64>, exactly: bool) -> Vanishing {
        let e = self.substituted(&[open], &self.as_numbers(constants))[0];
        if e == Arena::ZERO {
            return Vanishing::Exactly;
        }
        let mut sampled = self.sample(e, &HashMap::new());
        if matches!(sampled, Vanishing::No { .. }) && e != open && self.arena.borrow().contains_float(e) {
            // what cancelled floats leave does not tell their size; constants as inputs keep it
            let again = self.sample(open, constants);
            if again.is_zero() {
                sampled = again;
            }
        }
        if matches!(sampled, Vanishing::No { .. }) || !exactly && sampled.is_zero() {
            return sampled;
        }
        let normal = self.arena.borrow_mut().normal_numerator(e, TERM_LIMIT);
        if normal == Some(Arena::ZERO) { Vanishing::Exactly } else { sampled }
    }

    /// The numerical test, at these values of the constants.
    fn sample(&self, e: Expr, constants: &HashMap<Symbol, f64>) -> Vanishing {
        let symbols: Vec<Symbol> = self.symbols_of(e).into_iter().collect();
        let Ok(tape) = self.compile(&symbols, &[e], &HashMap::new()) else {
            return Vanishing::Undecided { tried: 0 };
        };
        let mut evaluator = Evaluator::new(tape);
        let mut random = SplitMix::new(0x5eed);
        let mut inputs = vec![Bounded::from_f64(0.0); symbols.len()];
        let mut points = 0;
        let mut tried = 0;
        while points < POINTS && tried < TRIES {
            tried += 1;
            // Where a root or logarithm needs positive values, random signs may never give them all.
            let signed = tried % 2 == 1;
            for (x, symbol) in inputs.iter_mut().zip(&symbols) {
                *x = Bounded::from_f64(
                    constants.get(symbol).copied().unwrap_or_else(|| coordinate(&mut random, signed)),
                );
            }
            let output = evaluator.evaluate(&inputs)[0];
            if !output.is_finite() {
                continue;
            }
            if !output.may_be_zero() {
                return Vanishing::No { value: output.value, bound: output.round_off() };
            }
            points += 1;
        }
        if points == 0 { Vanishing::Undecided { tried } } else { Vanishing::Numerically { points } }
    }
}

/// In [0.2, 1.3], with a random sign if `signed`.
fn coordinate(random: &mut SplitMix, signed: bool) -> f64 {
    let bits = random.bits();
    let x = 0.2 + 1.1 * (bits >> 11) as f64 / (1_u64 << 53) as f64;
    if signed && bits & 1 == 1 { -x } else { x }
}
