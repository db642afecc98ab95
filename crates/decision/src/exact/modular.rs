//! The field of `p` elements, and the images in it of the numbers of which jets are made.
//!
//! Rational numbers, `i`, `e^{i a}`, `e^a` for rational `a`, and roots of rational numbers: products of the
//! primes up to 47, and of every second larger one. `e^{i a} ↦ h^a` where `h` has the prime order `r`: the
//! exponent is modulo `r`, so every fraction has its image, whatever its denominator. `e^{i/N}` is
//! transcendental for every `N`, independent of `e^{1/N}` (Lindemann, Weierstrass); so
//! `T = e^{i/N} ↦ τ = h^{1/N}` is a ring homomorphism wherever nothing divided by has the image 0.

use std::collections::BTreeMap;
use std::ops::{Add, Mul, Neg, Sub};
use std::sync::LazyLock;

use super::Flaw;
use super::rational::Exact;

/// The prime `p`, 1 modulo 8: all primes up to 47 have roots, and `p − 1 = 8 · 294 r`.
pub(crate) const PRIME: u64 = 1_324_058_290_480_152_529;
/// The prime order `r` of the images of `e^{i a}` and `e^a`.
pub(crate) const ORDER: u64 = 562_949_953_435_439;
/// Image of `e^i`: a power of 53, which is no square.
const CIRCLE: u64 = 500_365_693_788_483_288;
/// Image of `e`.
const NEPER: u64 = 871_121_100_965_325_420;
/// `√−1`.
const IMAGINARY: u64 = 304_924_282_205_937_375;
/// A number without a square root.
const NO_SQUARE: u64 = 53;
/// `p − 1 = 2^4 · odd`.
const TWOS: u32 = 4;
/// Prime factors under this are looked for under roots.
const TRIED: i128 = 4096;
/// Numerators and denominators of small fractions are at most this.
const SMALL: i128 = 1_000_000;

/// An element of the field, as `x 2^64` modulo `p` (Montgomery).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Modular(u64);

/// `−1/p` modulo 2^64, and `2^128` modulo `p`.
const INVERSE: u64 = 13_095_723_922_020_124_367;
const SQUARE: u64 = 1_316_047_116_639_614_661;

/// `x / 2^64` modulo `p`, for `x < p 2^64`.
fn reduce(x: u128) -> u64 {
    let m = (x as u64).wrapping_mul(INVERSE);
    let t = ((x + u128::from(m) * u128::from(PRIME)) >> 64) as u64;
    if t >= PRIME { t - PRIME } else { t }
}

/// Inverses of small numbers, by which series divide at every order.
static OVER: LazyLock<[Modular; 32]> =
    LazyLock::new(|| std::array::from_fn(|d| Modular::new(d as u64).inverse().unwrap_or(Modular::ZERO)));

impl Modular {
    pub(crate) const ZERO: Modular = Modular(0);

    pub(crate) fn new(x: u64) -> Self {
        Modular(reduce(u128::from(x % PRIME) * u128::from(SQUARE)))
    }

    /// The representative in `0..p`.
    pub(crate) fn value(self) -> u64 {
        reduce(u128::from(self.0))
    }

    pub(crate) fn one() -> Self {
        Self::new(1)
    }

    pub(crate) fn imaginary() -> Self {
        Self::new(IMAGINARY)
    }

    /// `r` and the images of `e^i` and `e`.
    pub(crate) fn exponents() -> (u64, u64, u64) {
        (ORDER, CIRCLE, NEPER)
    }

    /// The primes of which a root is taken in [`Self::root`] of any of these, with the image of that.
    pub(crate) fn roots(radicands: impl Iterator<Item = Exact>) -> BTreeMap<i128, u64> {
        let mut roots = BTreeMap::new();
        for x in radicands.filter(|x| x.is_rational()) {
            let mut rest = x.numerator.saturating_mul(x.denominator).abs();
            let tried = (2..TRIED).filter(|prime| {
                let before = rest;
                while rest > 1 && rest % prime == 0 {
                    rest /= prime;
                }
                rest < before
            });
            let mut primes: Vec<i128> = tried.collect();
            primes.push(rest);
            let found = primes.into_iter().filter(|&prime| 1 < prime && prime < TRIED * TRIED);
            roots.extend(found.filter_map(|prime| Some((prime, Self::integer(prime).square_root()?.value()))));
        }
        roots
    }

    pub(crate) fn is_zero(self) -> bool {
        self.0 == 0
    }

    fn integer(x: i128) -> Self {
        let rest = x.rem_euclid(i128::from(PRIME));
        Self::new(rest as u64)
    }

    /// The image of a fraction; `None` where its denominator is a multiple of `p`.
    pub(crate) fn fraction(x: Exact) -> Option<Self> {
        let numerator = Self::integer(x.numerator);
        let over = match usize::try_from(x.denominator).ok().and_then(|d| OVER.get(d)) {
            Some(&over) => over,
            None => Self::integer(x.denominator).inverse()?,
        };
        Some(numerator * over)
    }

    /// The fraction with this image and a numerator and denominator of at most a million.
    pub(crate) fn small_fraction(self) -> Option<Exact> {
        let (mut r, mut s) = ((i128::from(PRIME), i128::from(self.value())), (0_i128, 1_i128));
        while r.1 > SMALL {
            let quotient = r.0 / r.1;
            r = (r.1, r.0 - quotient * r.1);
            s = (s.1, s.0 - quotient * s.1);
        }
        let found = Exact::ratio(r.1, s.1).filter(|_| s.1.abs() <= SMALL)?;
        (Self::fraction(found) == Some(self)).then_some(found)
    }

    pub(crate) fn power(self, mut exponent: u64) -> Self {
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
    pub(crate) fn inverse(self) -> Option<Self> {
        (!self.is_zero()).then(|| self.power(PRIME - 2))
    }

    /// `Σ a_i b_{m−1−i}` of two slices of the length m.
    pub(crate) fn convolution(a: &[Self], b: &[Self]) -> Self {
        let mut total = Self::ZERO;
        // eight products stay below p 2^64
        for (a, b) in a.chunks(8).zip(b.rchunks(8)) {
            let sum: u128 = a.iter().zip(b.iter().rev()).map(|(a, b)| u128::from(a.0) * u128::from(b.0)).sum();
            total = total + Modular(reduce(sum));
        }
        total
    }

    /// The image of `base^x`, for a base of order `r`.
    fn rational_power(base: u64, x: Exact) -> Result<Self, Flaw> {
        let order = i128::from(ORDER);
        let (n, d) = (x.numerator.rem_euclid(order), x.denominator.rem_euclid(order));
        if d == 0 {
            return Err(Flaw::Angle);
        }
        let mut inverse = 1_i128;
        let (mut square, mut exponent) = (d, order - 2);
        while exponent > 0 {
            if exponent & 1 == 1 {
                inverse = inverse * square % order;
            }
            square = square * square % order;
            exponent >>= 1;
        }
        Ok(Self::new(base).power((n * inverse % order) as u64))
    }

    /// `e^x`.
    pub(crate) fn exponential(x: Exact) -> Result<Self, Flaw> {
        if x.is_rational() { Self::rational_power(NEPER, x) } else { Err(Flaw::Pi) }
    }

    /// `(sin x, cos x)`.
    pub(crate) fn sine_and_cosine(x: Exact) -> Result<(Self, Self), Flaw> {
        let i = Self::imaginary();
        let forward = Self::rational_power(CIRCLE, x)? * i.power(x.quarters.rem_euclid(4) as u64);
        let flaw = Err(Flaw::Zero);
        let (Some(backward), Some(half)) = (forward.inverse(), Self::new(2).inverse()) else { return flaw };
        let Some(over_i) = i.inverse() else { return flaw };
        Ok(((forward - backward) * half * over_i, (forward + backward) * half))
    }

    /// A square root, the same in every call; `None` for what is no square.
    pub(crate) fn square_root(self) -> Option<Self> {
        if self.is_zero() {
            return Some(self);
        }
        let odd = (PRIME - 1) >> TWOS;
        let mut c = Self::new(NO_SQUARE).power(odd);
        let mut root = self.power(odd.div_ceil(2));
        let mut t = self.power(odd);
        let mut m = TWOS;
        while t != Self::one() {
            let mut i = 0;
            let mut s = t;
            while s != Self::one() {
                s = s * s;
                i += 1;
            }
            if i >= m {
                return None;
            }
            let b = c.power(1 << (m - i - 1));
            (root, c, m) = (root * b, b * b, i);
            t = t * c;
        }
        Some(root)
    }

    /// `√x`, `x > 0` a fraction of squares and primes with roots here; roots of several are independent.
    pub(crate) fn root(x: Exact) -> Result<(Self, Option<Exact>), Flaw> {
        if !x.is_rational() || x.numerator < 0 {
            return Err(Flaw::Root);
        }
        let mut square_free = x.numerator.checked_mul(x.denominator).ok_or(Flaw::Root)?;
        let mut outside = Exact::ratio(1, x.denominator).ok_or(Flaw::Root)?;
        let mut roots = Self::one();
        if square_free == 0 {
            return Ok((Self::ZERO, Some(Exact::ZERO)));
        }
        let of_prime = |prime: i128| Self::integer(prime).square_root().ok_or(Flaw::Root);
        // what is no prime does not divide what is left
        for prime in 2..TRIED {
            if prime * prime > square_free {
                break;
            }
            while square_free % (prime * prime) == 0 {
                square_free /= prime * prime;
                outside = Exact::ratio(prime, 1).and_then(|p| outside.mul(p)).ok_or(Flaw::Root)?;
            }
            if square_free % prime == 0 {
                square_free /= prime;
                roots = roots * of_prime(prime)?;
            }
        }
        let whole = (square_free as f64).sqrt().round() as i128;
        if whole.checked_mul(whole) == Some(square_free) {
            outside = Exact::ratio(whole, 1).and_then(|w| outside.mul(w)).ok_or(Flaw::Root)?;
        } else if square_free < TRIED * TRIED {
            roots = roots * of_prime(square_free)?;
        } else {
            return Err(Flaw::Root);
        }
        let value = Self::fraction(outside).ok_or(Flaw::Root)? * roots;
        Ok((value, (roots == Self::one()).then_some(outside)))
    }
}

impl Add for Modular {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        Modular(if sum >= PRIME { sum - PRIME } else { sum })
    }
}

impl Sub for Modular {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Modular(if self.0 >= other.0 { self.0 - other.0 } else { self.0 + PRIME - other.0 })
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

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(n: i128, d: i128) -> Exact {
        Exact::ratio(n, d).unwrap()
    }

    #[test]
    fn images_obey_the_laws_of_their_numbers() {
        assert_eq!(Modular::imaginary().power(2), -Modular::one());
        let (sine, cosine) = Modular::sine_and_cosine(ratio(3, 10)).unwrap();
        assert_eq!(sine * sine + cosine * cosine, Modular::one());
        let (double, _) = Modular::sine_and_cosine(ratio(3, 5)).unwrap();
        assert_eq!(double, Modular::new(2) * sine * cosine);
        let quarter = Exact { quarters: 1, ..ratio(3, 10) };
        assert_eq!(Modular::sine_and_cosine(quarter).unwrap().0, cosine);
        let root = |n, d| Modular::root(ratio(n, d)).unwrap().0;
        assert_eq!(root(2, 1) * root(3, 1), root(6, 1));
        assert_eq!(root(50, 9) * root(50, 9), Modular::fraction(ratio(50, 9)).unwrap());
        assert_eq!(Modular::root(ratio(16, 25)).unwrap().1, Some(ratio(4, 5)));
        assert_eq!(root(202, 1), root(2, 1) * root(101, 1));
        assert_eq!(Modular::root(ratio(53, 1)), Err(Flaw::Root));
        let exponential = |n, d| Modular::exponential(ratio(n, d)).unwrap();
        assert_eq!(exponential(1, 2) * exponential(1, 3), exponential(5, 6));
    }

    #[test]
    fn convolutions_are_sums_of_products() {
        let a: Vec<Modular> = (0..19).map(|i| Modular::new(PRIME - 1 - i)).collect();
        let b: Vec<Modular> = (0..19).map(|i| Modular::new(PRIME - 7 - i * i)).collect();
        let plain = (0..19).fold(Modular::ZERO, |sum, i| sum + a[i] * b[18 - i]);
        assert_eq!(Modular::convolution(&a, &b), plain);
    }
}
