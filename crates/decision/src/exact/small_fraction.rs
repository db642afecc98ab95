//! Reconstruction of short fractions from their images in a field.

use symbolic::Fraction;
use symbolic::limits::FRACTION;

use super::element::Modular;
use super::rational::Exact;

/// And powers of ten beside them.
const MOST_TENS: i32 = 60;

impl Modular {
    /// The fraction with this image and a numerator and denominator of at most a million, or else the least
    /// power of ten times one: units are such powers.
    pub fn small_fraction(self) -> Option<Exact> {
        self.fraction_about(0, MOST_TENS)
    }

    /// The same of a fraction that is about `size`.
    pub fn small_fraction_near(self, size: f64) -> Option<Exact> {
        let tens = size.abs().log10().round();
        // a fraction of few digits is at most this many powers of ten from 1
        if tens.abs() <= f64::from(MOST_TENS) {
            self.fraction_about(tens as i32, FRACTION.ilog10() as i32)
        } else {
            None
        }
    }

    /// A fraction of few digits times `10^k`, `|k − tens| ≤ most`, the nearest `k` first.
    fn fraction_about(self, tens: i32, most: i32) -> Option<Exact> {
        let ten = Self::new(10);
        let [up, down] = [ten, ten.inverse()?];
        let about = if tens > 0 { down } else { up }.power(tens.unsigned_abs().into());
        let mut scaled = [self * about; 2];
        for k in 0..=most {
            for (sign, scaled) in [1, -1].into_iter().zip(scaled) {
                if let Some(found) = scaled.fraction_of_few_digits() {
                    let power = tens - sign * k;
                    return Exact::rational(Fraction::with_powers(1, 1, power, power)?).checked_mul(found);
                }
            }
            scaled = [scaled[0] * up, scaled[1] * down];
        }
        None
    }

    fn fraction_of_few_digits(self) -> Option<Exact> {
        let (mut r, mut s) = ((Self::prime() as i64, self.value() as i64), (0_i64, 1_i64));
        while r.1 > FRACTION {
            let quotient = r.0 / r.1;
            r = (r.1, r.0 - quotient * r.1);
            s = (s.1, s.0 - quotient * s.1);
        }
        let found = (s.1.abs() <= FRACTION).then(|| Exact::ratio(r.1.into(), s.1.into()))??;
        (Self::fraction(found) == Some(self)).then_some(found)
    }
}
