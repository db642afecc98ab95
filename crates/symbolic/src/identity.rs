//! Is an expression identically zero?

use crate::{Expr, Graph, Scalar, Symbol};
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Terms beyond which the exact test gives up.
const TERM_LIMIT: usize = 3_000;
/// Random points of the numerical test.
const POINTS: usize = 32;
/// Points that may be tried to find so many where the value is finite.
const TRIES: usize = 20 * POINTS;
/// A value below this part of what was added up to it is round-off.
const RELATIVE_BOUND: f64 = 1e-11;

/// Added in every product, so that what underflows counts as round-off.
const UNDERFLOW: f64 = 1e-300;

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
    /// numbers to put in first.
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
    pub fn vanishes(&self, e: Expr, constants: &HashMap<Symbol, f64>) -> Vanishing {
        let values = self.as_numbers(constants);
        let e = self.substitute(e, &values);
        if self.is_zero(e) {
            return Vanishing::Exactly;
        }
        let sampled = self.sample(e);
        if matches!(sampled, Vanishing::No { .. }) {
            return sampled;
        }
        let normal = self.arena.borrow_mut().normal_numerator(e, TERM_LIMIT);
        if normal.is_some_and(|n| self.is_zero(n)) { Vanishing::Exactly } else { sampled }
    }

    /// The numerical test.
    fn sample(&self, e: Expr) -> Vanishing {
        let symbols: Vec<Symbol> = self.symbols_of(e).into_iter().collect();
        let Ok(tape) = self.compile(&symbols, &[e], &HashMap::new()) else {
            return Vanishing::Undecided { tried: 0 };
        };
        let mut workspace = tape.workspace();
        let mut random = SplitMix { state: 0x5eed };
        let mut inputs = vec![Bounded::from_f64(0.0); symbols.len()];
        let mut output = [Bounded::from_f64(0.0)];
        let mut points = 0;
        let mut tried = 0;
        while points < POINTS && tried < TRIES {
            tried += 1;
            // Where a root or logarithm needs positive values, random signs may never give them all.
            let signed = tried % 2 == 1;
            for x in &mut inputs {
                *x = Bounded::from_f64(random.coordinate(signed));
            }
            tape.evaluate(&inputs, &mut workspace, &mut output);
            let Bounded { value, magnitude } = output[0];
            if !value.is_finite() || !magnitude.is_finite() {
                continue;
            }
            let bound = RELATIVE_BOUND * magnitude;
            if value.abs() > bound {
                return Vanishing::No { value, bound };
            }
            points += 1;
        }
        if points == 0 { Vanishing::Undecided { tried } } else { Vanishing::Numerically { points } }
    }
}

/// Sebastiano Vigna's SplitMix64.
struct SplitMix {
    state: u64,
}

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0.2, 1.3], with a random sign if `signed`.
    fn coordinate(&mut self, signed: bool) -> f64 {
        let bits = self.next();
        let x = 0.2 + 1.1 * (bits >> 11) as f64 / (1_u64 << 53) as f64;
        if signed && bits & 1 == 1 { -x } else { x }
    }
}

/// A value and what round-off in it is measured by: the sum of all that was added up on the way, each
/// times how much the value depends on it.
#[derive(Clone, Copy)]
struct Bounded {
    value: f64,
    magnitude: f64,
}

impl Bounded {
    /// f(x), where `slope` is f'(x)
    fn mapped(self, value: f64, slope: f64) -> Self {
        Self { value, magnitude: value.abs() + slope.abs() * self.magnitude + UNDERFLOW }
    }
}

impl Add for Bounded {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { value: self.value + b.value, magnitude: self.magnitude + b.magnitude }
    }
}

impl Sub for Bounded {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self { value: self.value - b.value, magnitude: self.magnitude + b.magnitude }
    }
}

impl Mul for Bounded {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let magnitude = self.magnitude * b.value.abs() + self.value.abs() * b.magnitude;
        Self { value: self.value * b.value, magnitude: magnitude + UNDERFLOW }
    }
}

impl Div for Bounded {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        let magnitude = (self.magnitude + value.abs() * b.magnitude) / b.value.abs();
        Self { value, magnitude: magnitude + UNDERFLOW }
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, magnitude: self.magnitude }
    }
}

impl Scalar for Bounded {
    fn from_f64(x: f64) -> Self {
        Self { value: x, magnitude: x.abs() }
    }
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        Self::from_f64(numerator as f64 / denominator as f64)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.mapped(root, 0.5 / root)
    }
    fn sin(self) -> Self {
        self.mapped(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.mapped(self.value.cos(), self.value.sin())
    }
    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.mapped(tangent, 1.0 + tangent * tangent)
    }
    fn sinh(self) -> Self {
        self.mapped(self.value.sinh(), self.value.cosh())
    }
    fn cosh(self) -> Self {
        self.mapped(self.value.cosh(), self.value.sinh())
    }
    fn tanh(self) -> Self {
        let tangent = self.value.tanh();
        self.mapped(tangent, 1.0 - tangent * tangent)
    }
    fn asin(self) -> Self {
        self.mapped(self.value.asin(), 1.0 / (1.0 - self.value * self.value).sqrt())
    }
    fn acos(self) -> Self {
        self.mapped(self.value.acos(), 1.0 / (1.0 - self.value * self.value).sqrt())
    }
    fn atan(self) -> Self {
        self.mapped(self.value.atan(), 1.0 / (1.0 + self.value * self.value))
    }
    fn asinh(self) -> Self {
        self.mapped(self.value.asinh(), 1.0 / (1.0 + self.value * self.value).sqrt())
    }
    fn acosh(self) -> Self {
        self.mapped(self.value.acosh(), 1.0 / (self.value * self.value - 1.0).sqrt())
    }
    fn atanh(self) -> Self {
        self.mapped(self.value.atanh(), 1.0 / (1.0 - self.value * self.value))
    }
    fn exp(self) -> Self {
        let power = self.value.exp();
        self.mapped(power, power)
    }
    fn log(self) -> Self {
        self.mapped(self.value.ln(), 1.0 / self.value)
    }
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let by_base = self.magnitude * (exponent.value * value / self.value).abs();
        let by_exponent = exponent.magnitude * (value * self.value.ln()).abs();
        let by_exponent = if by_exponent.is_nan() { 0.0 } else { by_exponent };
        Self { value, magnitude: value.abs() + by_base + by_exponent + UNDERFLOW }
    }
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let uncertain = |b: Bounded| b.value.abs() <= RELATIVE_BOUND * b.magnitude;
        // Round-off decides on which side of the cut the angle is: the point says nothing.
        if uncertain(self) && (x.value < 0.0 || uncertain(x)) {
            return Self { value, magnitude: f64::INFINITY };
        }
        let square = x.value * x.value + self.value * self.value;
        let slopes = x.value.abs() * self.magnitude + self.value.abs() * x.magnitude;
        Self { value, magnitude: value.abs() + slopes / square }
    }
}
