//! Elements of the field of the current computation, and their arithmetic.

use std::ops::{Add, Mul, Neg, Sub};

use super::field::field;

/// An element of the field, as `x 2^64` modulo `p` (Montgomery).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Modular(u64);

/// `x / 2^64` modulo `p`, for `x < p 2^64`.
fn reduce(x: u128) -> u64 {
    let field = field();
    let m = (x as u64).wrapping_mul(field.inverse);
    let t = ((x + u128::from(m) * u128::from(field.prime)) >> 64) as u64;
    if t >= field.prime { t - field.prime } else { t }
}

/// So many products of elements add up to less than `p 2^64`.
const PRODUCTS: usize = 8;

impl Modular {
    /// 0.
    pub const ZERO: Modular = Modular(0);

    /// The image of an integer.
    pub fn new(x: u64) -> Self {
        Modular(reduce(u128::from(x % field().prime) * u128::from(field().square)))
    }

    /// The representative in `0..p`.
    pub fn value(self) -> u64 {
        reduce(u128::from(self.0))
    }

    /// 1.
    pub fn one() -> Self {
        Modular(field().one)
    }

    /// The number `p` of elements of the field.
    pub fn prime() -> u64 {
        field().prime
    }

    /// Whether it is 0.
    pub fn is_zero(self) -> bool {
        self.0 == 0
    }

    /// `self^exponent`.
    pub fn power(self, mut exponent: u64) -> Self {
        let (mut base, mut result) = (self, Self::one());
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            exponent >>= 1;
        }
        result
    }

    /// `None` for 0.
    pub fn inverse(self) -> Option<Self> {
        (!self.is_zero()).then(|| self.power(field().prime - 2))
    }

    /// `Σ a_i b_{m−1−i}` of two slices of the length m.
    pub(crate) fn convolution(a: &[Self], b: &[Self]) -> Self {
        let mut total = Self::ZERO;
        for (a, b) in a.chunks(PRODUCTS).zip(b.rchunks(PRODUCTS)) {
            let sum: u128 = a.iter().zip(b.iter().rev()).map(|(a, b)| u128::from(a.0) * u128::from(b.0)).sum();
            total = total + Modular(reduce(sum));
        }
        total
    }

    /// Subtracts each factor times its row, rows as long as `into`.
    pub(crate) fn subtract_multiples(into: &mut [Self], factors: &[Self], rows: &[Self]) {
        let mut multiples = factors.iter().zip(rows.chunks_exact(into.len())).filter(|(factor, _)| !factor.is_zero());
        loop {
            let few: [Option<(&Self, &[Self])>; PRODUCTS] = std::array::from_fn(|_| multiples.next());
            if few[0].is_none() {
                return;
            }
            for (j, x) in into.iter_mut().enumerate() {
                let products = few.iter().flatten().map(|(factor, row)| u128::from(factor.0) * u128::from(row[j].0));
                *x = *x - Modular(reduce(products.sum()));
            }
        }
    }
}

impl Add for Modular {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        Modular(if sum >= field().prime { sum - field().prime } else { sum })
    }
}

impl Sub for Modular {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Modular(if self.0 >= other.0 { self.0 - other.0 } else { self.0 + field().prime - other.0 })
    }
}

impl Neg for Modular {
    type Output = Self;
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}

impl Mul for Modular {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Modular(reduce(u128::from(self.0) * u128::from(other.0)))
    }
}
