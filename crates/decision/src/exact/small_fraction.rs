//! Fractions of few digits from their images.

use symbolic::Fraction;

use super::modular::Modular;
use super::rational::Exact;

/// Numerators and denominators of small fractions are at most this.
const SMALL: i64 = 1_000_000;
/// And powers of ten beside them.
const MOST_TENS: i32 = 60;

impl Modular {
    /// The fraction with this image and a numerator and denominator of at most a million, or else the least
    /// power of ten times one: units are such powers.
    pub(crate) fn small_fraction(self) -> Option<Exact> {
        let ten = Self::new(10);
        let tens = [ten, ten.inverse()?];
        let mut scaled = [self, self];
        for k in 0..=MOST_TENS {
            for (sign, scaled) in [1, -1].into_iter().zip(scaled) {
                if let Some(found) = scaled.fraction_of_few_digits() {
                    let unit = Fraction::with_powers(1, 1, -sign * k, -sign * k)?;
                    return Exact::rational(unit).mul(found);
                }
            }
            scaled = [scaled[0] * tens[0], scaled[1] * tens[1]];
        }
        None
    }

    fn fraction_of_few_digits(self) -> Option<Exact> {
        let (mut r, mut s) = ((Self::prime() as i64, self.value() as i64), (0_i64, 1_i64));
        while r.1 > SMALL {
            let quotient = r.0 / r.1;
            r = (r.1, r.0 - quotient * r.1);
            s = (s.1, s.0 - quotient * s.1);
        }
        let found = (s.1.abs() <= SMALL).then(|| Exact::ratio(r.1.into(), s.1.into()))??;
        (Self::fraction(found) == Some(self)).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_size_have_their_images() {
        let decimal = |text: &str| Exact::rational(Fraction::decimal(text).unwrap());
        let image = |text: &str| Modular::fraction(decimal(text)).unwrap();
        assert_eq!(image("3e-45") * image("7e30") * image("1e15"), Modular::new(21));
        assert_eq!(Modular::root(decimal("4e-54")).unwrap().1, Some(decimal("2e-27")));
        let (root, none) = Modular::root(decimal("3e-45")).unwrap();
        assert_eq!((root * root, none), (image("3e-45"), None));
        let small = |text: &str| Modular::exponential(decimal(text)).unwrap();
        assert_eq!(small("1e-40").power(10), small("1e-39"));
        assert_eq!(image("-2.5e-27").small_fraction(), Some(decimal("-2.5e-27")));
    }
}
