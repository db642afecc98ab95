//! Fractions of any decimal exponent: `1e-45` and its products are as exact as `1/3`.

use std::fmt;

/// `numerator/denominator · 2^twos · 5^fives`. The exponents are zero where the reduced fraction fits;
/// otherwise numerator and denominator have no factors 2 and 5. So equal numbers have equal parts.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Fraction {
    numerator: i128,
    denominator: i128,
    twos: i32,
    fives: i32,
}

/// Exponents of more are not followed.
const LARGEST: u32 = 30_000;

/// The greatest common divisor.
pub(crate) fn divisor(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        // a long division takes ten times as long
        (a, b) = match (u64::try_from(a), u64::try_from(b)) {
            (Ok(short), Ok(by)) => (b, i128::from(short % by)),
            _ => (b, a % b),
        };
    }
    a
}

/// `n 2^twos 5^fives` for exponents that are not negative.
fn raised(n: i128, twos: i32, fives: i32) -> Option<i128> {
    if n == 0 {
        return Some(0);
    }
    let power = |base: i128, exponent: i32| base.checked_pow(u32::try_from(exponent).ok()?);
    n.checked_mul(power(2, twos)?)?.checked_mul(power(5, fives)?)
}

/// `n` without its factors `prime`, and how many they are.
fn without(mut n: i128, prime: i128) -> (i128, i32) {
    let mut count = 0;
    while n != 0 && n % prime == 0 {
        n /= prime;
        count += 1;
    }
    (n, count)
}

impl Fraction {
    /// 0
    pub const ZERO: Fraction = Fraction { numerator: 0, denominator: 1, twos: 0, fives: 0 };
    /// 1
    pub const ONE: Fraction = Fraction { numerator: 1, ..Fraction::ZERO };

    /// `numerator/denominator`; `None` where the denominator is zero.
    pub fn new(numerator: i128, denominator: i128) -> Option<Self> {
        Self::with_powers(numerator, denominator, 0, 0)
    }

    /// `numerator/denominator · 2^twos · 5^fives`; `None` where the denominator is zero, or the exponents are
    /// beyond some ten thousand.
    pub fn with_powers(numerator: i128, denominator: i128, twos: i32, fives: i32) -> Option<Self> {
        if denominator == 0 || numerator == i128::MIN || denominator == i128::MIN {
            return None;
        }
        if numerator == 0 {
            return Some(Self::ZERO);
        }
        // those of a quotient of i128 change them by less than LARGEST
        if twos.unsigned_abs().max(fives.unsigned_abs()) > 2 * LARGEST {
            return None;
        }
        let shared = divisor(numerator, denominator) * denominator.signum();
        let reduced = Fraction { numerator: numerator / shared, denominator: denominator / shared, twos, fives };
        if twos == 0 && fives == 0 {
            return Some(reduced);
        }
        let bare = reduced.bare();
        let above = raised(bare.numerator, bare.twos.max(0), bare.fives.max(0));
        let below = raised(bare.denominator, (-bare.twos).max(0), (-bare.fives).max(0));
        if let (Some(numerator), Some(denominator)) = (above, below) {
            return Some(Fraction { numerator, denominator, twos: 0, fives: 0 });
        }
        (bare.twos.unsigned_abs().max(bare.fives.unsigned_abs()) <= LARGEST).then_some(bare)
    }

    /// The same with numerator and denominator free of factors 2 and 5.
    fn bare(self) -> Self {
        let ((n, twos), (d, less_twos)) = (without(self.numerator, 2), without(self.denominator, 2));
        let ((n, fives), (d, less_fives)) = (without(n, 5), without(d, 5));
        let (twos, fives) = (self.twos + twos - less_twos, self.fives + fives - less_fives);
        Fraction { numerator: n, denominator: d, twos, fives }
    }

    /// Parts without factors 2 and 5, numerator first, and the exponents of these.
    pub fn parts(self) -> (i128, i128, i32, i32) {
        let bare = self.bare();
        (bare.numerator, bare.denominator, bare.twos, bare.fives)
    }

    /// Numerator and denominator where these fit.
    pub fn plain(self) -> Option<(i128, i128)> {
        (self.twos == 0 && self.fives == 0).then_some((self.numerator, self.denominator))
    }

    /// `digits[.digits][e±digits]`; `None` for other text, or has more digits than fit.
    pub fn decimal(text: &str) -> Option<Self> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let fraction = fraction.trim_end_matches('0');
        let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
        let scale = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        Self::with_powers(digits, 1, scale, scale)
    }

    /// Whether it is 0.
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// Whether it is less than 0.
    pub fn is_negative(self) -> bool {
        self.numerator < 0
    }

    /// The sum, where it fits.
    pub fn checked_add(self, other: Self) -> Option<Self> {
        if let (Some((a, b)), Some((c, d))) = (self.plain(), other.plain()) {
            let cross = a.checked_mul(d).zip(c.checked_mul(b)).and_then(|(x, y)| x.checked_add(y));
            if let Some((n, d)) = cross.zip(b.checked_mul(d)) {
                return Self::new(n, d);
            }
        }
        if self.is_zero() || other.is_zero() {
            return Some(if self.is_zero() { other } else { self });
        }
        let (a, b) = (self.bare(), other.bare());
        let (twos, fives) = (a.twos.min(b.twos), a.fives.min(b.fives));
        let part = |x: Fraction, by: i128| raised(x.numerator, x.twos - twos, x.fives - fives)?.checked_mul(by);
        let sum = part(a, b.denominator)?.checked_add(part(b, a.denominator)?)?;
        Self::with_powers(sum, a.denominator.checked_mul(b.denominator)?, twos, fives)
    }

    /// The product, where it fits.
    pub fn checked_mul(self, other: Self) -> Option<Self> {
        if let (Some((a, b)), Some((c, d))) = (self.plain(), other.plain())
            && let Some((n, d)) = a.checked_mul(c).zip(b.checked_mul(d))
        {
            return Self::new(n, d);
        }
        let (a, b) = (self.bare(), other.bare());
        let (across, back) = (divisor(a.numerator, b.denominator), divisor(b.numerator, a.denominator));
        let numerator = (a.numerator / across).checked_mul(b.numerator / back)?;
        let denominator = (a.denominator / back).checked_mul(b.denominator / across)?;
        Self::with_powers(numerator, denominator, a.twos + b.twos, a.fives + b.fives)
    }

    /// The negative.
    #[must_use]
    pub fn minus(self) -> Self {
        Fraction { numerator: -self.numerator, ..self }
    }

    /// `None` for 0.
    pub fn recip(self) -> Option<Self> {
        Self::with_powers(self.denominator, self.numerator, -self.twos, -self.fives)
    }

    /// `self^exponent`, where it fits; `None` for a negative power of 0.
    pub fn powi(self, exponent: i64) -> Option<Self> {
        let bare = if exponent < 0 { self.recip()? } else { self }.bare();
        let times = |n: i32| i32::try_from(i64::from(n).checked_mul(exponent.checked_abs()?)?).ok();
        let power = |n: i128| match n {
            1 => Some(1),
            -1 => Some(if exponent % 2 == 0 { 1 } else { -1 }),
            n => n.checked_pow(u32::try_from(exponent.unsigned_abs()).ok()?),
        };
        Self::with_powers(power(bare.numerator)?, power(bare.denominator)?, times(bare.twos)?, times(bare.fives)?)
    }

    /// The nearest float of a decimal, and of any fraction except for the last digit; 0 and ∞ beyond the
    /// range.
    pub fn to_f64(self) -> f64 {
        let exact = |n: i128| n.unsigned_abs() <= 1 << 53;
        if let Some((n, d)) = self.plain().filter(|&(n, d)| exact(n) && exact(d)) {
            return n as f64 / d as f64;
        }
        let (n, d, twos, fives) = self.parts();
        let tens = twos.min(fives);
        let digits = raised(n, twos - tens, fives - tens).filter(|_| d == 1);
        match (digits.and_then(|digits| format!("{digits}e{tens}").parse().ok()), self.plain()) {
            (Some(x), _) => x,
            (None, Some((n, d))) => n as f64 / d as f64,
            (None, None) => {
                let twos = twos + 2 * fives;
                let quotient = n as f64 / d as f64 * 1.25_f64.powi(fives);
                quotient * 2_f64.powi(twos / 2) * 2_f64.powi(twos - twos / 2)
            }
        }
    }
}

/// Text that is read as the same number: a fraction, times or over powers of 2, 5 and 10.
impl fmt::Display for Fraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let same = self.twos.signum() == self.fives.signum();
        let tens = if same { self.twos.abs().min(self.fives.abs()) * self.twos.signum() } else { 0 };
        let powers = [(2, self.twos - tens), (5, self.fives - tens), (10, tens)];
        let side = |n: i128, sign: i32| {
            let mut own = n;
            let mut factors = Vec::new();
            for (base, exponent) in powers.into_iter().filter(|(_, exponent)| exponent * sign > 0) {
                match raised(
                    own,
                    if base == 2 { exponent.abs() } else { 0 },
                    if base == 5 { exponent.abs() } else { 0 },
                ) {
                    Some(product) if base != 10 => own = product,
                    _ => factors.push(format!("{base}^{}", exponent.abs())),
                }
            }
            if own != 1 || factors.is_empty() {
                factors.insert(0, own.to_string());
            }
            factors
        };
        write!(f, "{}", side(self.numerator, 1).join("*"))?;
        match &side(self.denominator, -1)[..] {
            [one] if one == "1" => Ok(()),
            [one] => write!(f, "/{one}"),
            several => write!(f, "/({})", several.join("*")),
        }
    }
}
