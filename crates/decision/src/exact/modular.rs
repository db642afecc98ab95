//! Fields of `p` elements, and the images in them of the numbers in jets.
//!
//! Rational numbers, `e^{iπ/720720}`, `e^{i a}`, `e^a` for rational `a`, and roots of rational numbers.
//! `e^{i a} ↦ h^a` where `h` has the prime order `r`: the exponent is modulo `r`, so every fraction has its
//! image, whatever its denominator. `e^{i/N}` is transcendental for every `N`, independent of `e^{1/N}`
//! (Lindemann, Weierstrass); so `T = e^{i/N} ↦ τ = h^{1/N}` is a ring homomorphism wherever nothing divided
//! by has the image 0. Roots of unity are algebraic, as are roots of primes: those of 2 … 13 lie among them
//! (Gauss), and have their images from there; those of other primes are independent of all these.
//!
//! Coefficients may be multiples of a prime, or alike modulo it: what is not zero in one field is not zero,
//! and what is zero is looked at in a second one. [`in_field`] says in which field a computation is.

use std::sync::LazyLock;

use symbolic::Fraction;
use symbolic::limits::PRIMES;

use super::Flaw;
use super::element::Modular;
use super::field::{FIELDS, field, in_field};
use super::rational::{Exact, PARTS, inverse};

/// `p − 1 = 2^5 · odd`.
const TWOS: u32 = 5;
/// Primes whose roots are sums of roots of unity.
const CYCLOTOMIC: [i128; 6] = [2, 3, 5, 7, 11, 13];

/// The image of `e` is this power of that of `e^i`.
const NEPER: u64 = 271_828_182_845;
/// Small numbers whose images and inverses are kept.
const KEPT: usize = 64;

/// Images that are asked for again and again, of one field.
struct Kept {
    whole: [Modular; KEPT],
    over: [Modular; KEPT],
    half_over_i: Modular,
    circle: Powers,
    neper: Powers,
    root: Powers,
}

static KEPT_IMAGES: LazyLock<[Kept; FIELDS.len()]> = LazyLock::new(|| {
    FIELDS.each_ref().map(|field| {
        in_field(field, || {
            let whole: [Modular; KEPT] = std::array::from_fn(|x| Modular::new(x as u64));
            let over = whole.map(|x| x.inverse().unwrap_or(Modular::ZERO));
            let (circle, root) = (Modular::new(field.circle), Modular::new(field.root));
            // 1/i = −i
            let half_over_i = -(over[2] * root.power(PARTS as u64 / 2));
            let powers = Powers::new;
            Kept {
                whole,
                over,
                half_over_i,
                circle: powers(circle),
                neper: powers(circle.power(NEPER)),
                root: powers(root),
            }
        })
    })
});

fn kept() -> &'static Kept {
    &KEPT_IMAGES[field().number]
}

/// `b^{j 256^i}`, by which a power of `b` takes one product per byte of its exponent.
struct Powers(Vec<[Modular; 256]>);

impl Powers {
    /// For exponents under `2^48`.
    fn new(base: Modular) -> Self {
        let mut base = base;
        let table = |_| {
            let mut table = [Modular::one(); 256];
            (1..256).for_each(|j| table[j] = table[j - 1] * base);
            base = table[255] * base;
            table
        };
        Powers((0..6).map(table).collect())
    }

    fn power(&self, exponent: u64) -> Modular {
        let bytes = exponent.to_le_bytes();
        let factors = self.0.iter().zip(bytes).filter(|(_, byte)| *byte != 0);
        factors.fold(Modular::one(), |product, (table, byte)| product * table[usize::from(byte)])
    }
}

impl Modular {
    /// The image of `e^{iπ turns/720720}`.
    pub fn root_of_unity(turns: i64) -> Self {
        kept().root.power(turns.rem_euclid(2 * PARTS) as u64)
    }

    /// `r` and the images of `e^i` and `e`.
    pub fn exponents() -> (u64, u64, u64) {
        let circle = Self::new(field().circle);
        (field().order, circle.value(), circle.power(NEPER).value())
    }

    /// The image of an integer.
    pub fn integer(x: i128) -> Self {
        match i64::try_from(x) {
            Ok(x) if (0..KEPT as i64).contains(&x) => kept().whole[x as usize],
            Ok(x) if x < 0 => -Self::new(x.unsigned_abs()),
            Ok(x) => Self::new(x as u64),
            Err(_) => Self::new(x.rem_euclid(i128::from(field().prime)) as u64),
        }
    }

    /// The image of a fraction; `None` where its denominator is a multiple of `p`.
    pub fn fraction(x: Exact) -> Option<Self> {
        let over = |d: i128| match usize::try_from(d).ok().and_then(|d| kept().over.get(d)) {
            Some(&over) => Some(over),
            None => Self::integer(d).inverse(),
        };
        if let Some((n, d)) = x.fraction.plain() {
            return Some(Self::integer(n) * over(d)?);
        }
        let (n, d, twos, fives) = x.fraction.parts();
        let power = |base: i128, exponent: i32| {
            let base = if exponent < 0 { over(base)? } else { Self::integer(base) };
            Some(base.power(exponent.unsigned_abs().into()))
        };
        Some(Self::integer(n) * over(d)? * power(2, twos)? * power(5, fives)?)
    }

    /// The exponent of the image of `b^x`, for `b` of order `r`.
    fn exponent(x: Exact) -> Result<u64, Flaw> {
        let order = i128::from(field().order);
        let (n, d, twos, fives) = x.fraction.parts();
        let (n, d) = (n.rem_euclid(order), d.rem_euclid(order));
        let n = match d {
            0 => return Err(Flaw::Angle),
            1 => n,
            // both are under 2^41
            _ => n * inverse(d, order) % order,
        };
        let power = |base: i128, exponent: i32| {
            let base = if exponent < 0 { inverse(base, order) } else { base };
            (0..exponent.abs()).fold(1, |power, _| power * base % order)
        };
        Ok((n * power(2, twos) % order * power(5, fives) % order) as u64)
    }

    /// `e^x`.
    ///
    /// # Errors
    /// [`Flaw::Pi`] for what is not rational; [`Flaw::Angle`] where the denominator is a multiple of `r`.
    pub fn exponential(x: Exact) -> Result<Self, Flaw> {
        if x.is_rational() { Ok(kept().neper.power(Self::exponent(x)?)) } else { Err(Flaw::Pi) }
    }

    /// `(sin x, cos x)`.
    ///
    /// # Errors
    /// [`Flaw::Angle`] where the denominator is a multiple of `r`.
    pub fn sine_and_cosine(x: Exact) -> Result<(Self, Self), Flaw> {
        let (kept, exponent) = (kept(), Self::exponent(x)?);
        let forward = kept.circle.power(exponent) * Self::root_of_unity(x.turns);
        let backward = kept.circle.power(field().order - exponent) * Self::root_of_unity(-x.turns);
        Ok(((forward - backward) * kept.half_over_i, (forward + backward) * kept.over[2]))
    }

    /// A square root, the same in every call; `None` for what is not a square.
    pub(crate) fn square_root(self) -> Option<Self> {
        if self.is_zero() {
            return Some(self);
        }
        let odd = (field().prime - 1) >> TWOS;
        let mut c = Self::new(field().no_square).power(odd);
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

    /// The root of a prime: a Gauss sum where that lies among the roots of unity that have images.
    pub(crate) fn root_of_prime(prime: i128) -> Option<Self> {
        if !CYCLOTOMIC.contains(&prime) {
            return Self::integer(prime).square_root();
        }
        if prime == 2 {
            return Some(Self::root_of_unity(PARTS / 4) + Self::root_of_unity(-PARTS / 4));
        }
        // Σ e^{2πi k²/q} = √q, or i√q where q is 3 modulo 4
        let prime = prime as i64;
        let turn = |k: i64| Self::root_of_unity(2 * PARTS / prime * (k * k % prime));
        let sum = (0..prime).fold(Self::ZERO, |sum, k| sum + turn(k));
        Some(if prime % 4 == 1 { sum } else { sum * Self::root_of_unity(-PARTS / 2) })
    }

    /// `√x`, `x > 0` a fraction of squares and primes with roots here; roots of several are independent.
    ///
    /// # Errors
    /// [`Flaw::Root`] for anything else.
    pub fn root(x: Exact) -> Result<(Self, Option<Exact>), Flaw> {
        if !x.is_rational() || x.fraction.is_negative() {
            return Err(Flaw::Root);
        }
        let (n, d, twos, fives) = x.fraction.parts();
        let odd = [(2, twos), (5, fives)].into_iter().filter(|(_, exponent)| exponent % 2 != 0);
        let mut square_free =
            odd.map(|(prime, _)| prime).chain([d]).try_fold(n, i128::checked_mul).ok_or(Flaw::Root)?;
        let outside = Fraction::with_powers(1, d, twos.div_euclid(2), fives.div_euclid(2));
        let mut outside = Exact::rational(outside.ok_or(Flaw::Root)?);
        let mut roots = Self::one();
        if square_free == 0 {
            return Ok((Self::ZERO, Some(Exact::ZERO)));
        }
        let of_prime = |prime: i128| Self::root_of_prime(prime).ok_or(Flaw::Root);
        // what is no prime does not divide what is left
        for prime in 2..i128::from(PRIMES) {
            if prime * prime > square_free {
                break;
            }
            while square_free % (prime * prime) == 0 {
                square_free /= prime * prime;
                outside = Exact::ratio(prime, 1).and_then(|p| outside.checked_mul(p)).ok_or(Flaw::Root)?;
            }
            if square_free % prime == 0 {
                square_free /= prime;
                roots = roots * of_prime(prime)?;
            }
        }
        let whole = (square_free as f64).sqrt().round() as i128;
        if whole.checked_mul(whole) == Some(square_free) {
            outside = Exact::ratio(whole, 1).and_then(|w| outside.checked_mul(w)).ok_or(Flaw::Root)?;
        } else if square_free < i128::from(PRIMES * PRIMES) {
            roots = roots * of_prime(square_free)?;
        } else {
            return Err(Flaw::Root);
        }
        let value = Self::fraction(outside).ok_or(Flaw::Root)? * roots;
        Ok((value, (roots == Self::one()).then_some(outside)))
    }
}
