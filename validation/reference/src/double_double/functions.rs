//! Roots and elementary functions in double-double arithmetic: argument reduction with constants of three
//! `f64`, Taylor series, and one Newton step from the value in `f64` for the inverse functions.

use symbolic::Scalar;

use super::DoubleDouble;

const ONE: DoubleDouble = DoubleDouble::ONE;
const ZERO: DoubleDouble = DoubleDouble::ZERO;

/// π/2 and ln 2 as sums of three `f64`, to 2⁻¹⁵⁹.
const HALF_PI: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591698e-33];
const LN_2: [f64; 3] = [std::f64::consts::LN_2, 2.3190468138462996e-17, 5.707708438416212e-34];

/// Quarter turns beyond which the angle cannot be reduced to full accuracy: the sine is "not a number" there.
const TURNS: f64 = (1_u64 << 50) as f64;

fn number(x: f64) -> DoubleDouble {
    DoubleDouble::from_f64(x)
}

/// `x − n c` for the constant `c` in three parts.
fn reduced(x: DoubleDouble, n: f64, parts: [f64; 3]) -> DoubleDouble {
    parts.iter().fold(x, |rest, &part| rest - number(part).times(n))
}

/// `1 + x/d₁ (1 + x/d₂ (1 + …))`
fn series(x: DoubleDouble, terms: u32, divisor: impl Fn(u32) -> f64) -> DoubleDouble {
    (1..=terms).rev().fold(ONE, |sum, k| ONE + sum * x / number(divisor(k)))
}

pub(super) fn sqrt(x: DoubleDouble) -> DoubleDouble {
    match x.hi() {
        0.0 => ZERO,
        high if high < 0.0 || !high.is_finite() => number(high.sqrt()),
        high => {
            let root = number(high.sqrt());
            root + (x - root * root) / root.times(2.0)
        }
    }
}

pub(super) fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let quarters = (x.hi() / HALF_PI[0]).round();
    if quarters.is_nan() || quarters.abs() >= TURNS {
        return (number(f64::NAN), number(f64::NAN));
    }
    let r = reduced(x, quarters, HALF_PI);
    let (sine, cosine) = near_zero(r);
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Sine and cosine by their series for |r| ≤ π/4: the first term left out is under 1e-34.
fn near_zero(r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let minus_square = -(r * r);
    let odd = INVERSE_FACTORIALS.iter().skip(1).step_by(2);
    let even = INVERSE_FACTORIALS.iter().step_by(2);
    let horner = |sum: DoubleDouble, &(high, low): &(f64, f64)| sum * minus_square + DoubleDouble::sum(high, low);
    let sine = r * odd.rev().fold(ZERO, horner);
    let cosine = even.rev().fold(ZERO, horner);
    (sine, cosine)
}

pub(super) fn exp(x: DoubleDouble) -> DoubleDouble {
    let high = x.hi();
    if high.is_nan() || high.abs() >= 745.0 {
        return number(high.exp());
    }
    let doublings = (high / LN_2[0]).round();
    let r = reduced(x, doublings, LN_2);
    let sum = INVERSE_FACTORIALS.iter().rev().fold(ZERO, |sum, &(high, low)| sum * r + DoubleDouble::sum(high, low));
    sum.scaled(doublings as i32)
}

pub(super) fn log(x: DoubleDouble) -> DoubleDouble {
    let high = x.hi();
    if !(high > 0.0 && high.is_finite()) {
        return number(high.ln());
    }
    if (0.9..1.1).contains(&high) {
        return log_of_one_plus(x - ONE);
    }
    // Newton's step for eʸ = x, whose error is the square of that of ln in f64
    let y = number(high.ln());
    y + (x * exp(-y) - ONE)
}

/// `log(1 + d) = 2 artanh(d/(2 + d))`, for |d| < 1/4 by its series.
fn log_of_one_plus(d: DoubleDouble) -> DoubleDouble {
    if d.hi().is_nan() || d.hi().abs() >= 0.25 {
        return log(ONE + d);
    }
    let s = d / (number(2.0) + d);
    let square = s * s;
    let sum = (0..20).rev().fold(ZERO, |sum, k| sum * square + DoubleDouble::from_ratio(2, 2 * k + 1));
    s * sum
}

pub(super) fn sinh(x: DoubleDouble) -> DoubleDouble {
    if x.hi().abs() < 0.35 {
        let square = x * x;
        return x * series(square, 12, |k| f64::from(2 * k * (2 * k + 1)));
    }
    let e = exp(x);
    (e - ONE / e).times(0.5)
}

pub(super) fn cosh(x: DoubleDouble) -> DoubleDouble {
    let e = exp(x);
    (e + ONE / e).times(0.5)
}

pub(super) fn tanh(x: DoubleDouble) -> DoubleDouble {
    if x.hi().abs() > 40.0 {
        return number(x.hi().tanh());
    }
    sinh(x) / cosh(x)
}

/// `√(1 − x²)`
pub(super) fn leg(x: DoubleDouble) -> DoubleDouble {
    sqrt((ONE - x) * (ONE + x))
}

/// The angle of the point `(x, y)`: that in `f64`, turned by what it misses.
pub(super) fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let rough = y.hi().atan2(x.hi());
    if (y.hi() == 0.0 && x.hi() == 0.0) || !rough.is_finite() {
        return number(rough);
    }
    let angle = number(rough);
    let (sine, cosine) = sin_cos(angle);
    // the tangent of the missing angle, which is its own sine to 1e-48
    angle + (y * cosine - x * sine) / (x * cosine + y * sine)
}

pub(super) fn asinh(x: DoubleDouble) -> DoubleDouble {
    let size = if x.hi() < 0.0 { -x } else { x };
    let square = size * size;
    let root = sqrt(ONE + square);
    let value = log_of_one_plus(size + square / (ONE + root));
    if x.hi() < 0.0 { -value } else { value }
}

pub(super) fn acosh(x: DoubleDouble) -> DoubleDouble {
    let over = x - ONE;
    log_of_one_plus(over + sqrt(over * (x + ONE)))
}

pub(super) fn atanh(x: DoubleDouble) -> DoubleDouble {
    log_of_one_plus(x.times(2.0) / (ONE - x)).times(0.5)
}

pub(super) fn powf(x: DoubleDouble, exponent: DoubleDouble) -> DoubleDouble {
    let n = exponent.hi();
    if exponent.parts().1 == 0.0 && n == n.trunc() && n.abs() <= 64.0 {
        let power = power(x, n.abs() as u32);
        return if n < 0.0 { ONE / power } else { power };
    }
    if x.hi() == 0.0 {
        return number(0.0_f64.powf(n));
    }
    let value = exp(exponent * log(x));
    if value.high.is_finite() && value.low.is_finite() { value } else { number(x.hi().powf(n)) }
}

fn power(x: DoubleDouble, n: u32) -> DoubleDouble {
    let (mut result, mut square) = (ONE, x);
    for bit in 0..u32::BITS - n.leading_zeros() {
        if n >> bit & 1 == 1 {
            result = result * square;
        }
        square = square * square;
    }
    result
}

/// 1/k! for k = 0 … 29, each as the sum of two `f64`.
const INVERSE_FACTORIALS: [(f64, f64); 30] = [
    (1.0, 0.0),
    (1.0, 0.0),
    (0.5, 0.0),
    (0.16666666666666666, 9.25185853854297e-18),
    (0.041666666666666664, 2.3129646346357427e-18),
    (0.008333333333333333, 1.1564823173178714e-19),
    (0.001388888888888889, -5.300543954373577e-20),
    (0.0001984126984126984, 1.7209558293420705e-22),
    (2.48015873015873e-05, 2.1511947866775882e-23),
    (2.7557319223985893e-06, -1.858393274046472e-22),
    (2.755731922398589e-07, 2.3767714622250297e-23),
    (2.505210838544172e-08, -1.448814070935912e-24),
    (2.08767569878681e-09, -1.20734505911326e-25),
    (1.6059043836821613e-10, 1.2585294588752098e-26),
    (1.1470745597729725e-11, 2.0655512752830745e-28),
    (7.647163731819816e-13, 7.03872877733453e-30),
    (4.779477332387385e-14, 4.399205485834081e-31),
    (2.8114572543455206e-15, 1.6508842730861433e-31),
    (1.5619206968586225e-16, 1.1910679660273754e-32),
    (8.22063524662433e-18, 2.2141894119604265e-34),
    (4.110317623312165e-19, 1.4412973378659527e-36),
    (1.9572941063391263e-20, -1.3643503830087908e-36),
    (8.896791392450574e-22, -7.911402614872376e-38),
    (3.868170170630684e-23, -8.843177655482344e-40),
    (1.6117375710961184e-24, -3.6846573564509766e-41),
    (6.446950284384474e-26, -1.9330404233703465e-42),
    (2.4795962632247976e-27, -1.2953730964765229e-43),
    (9.183689863795546e-29, 1.4303150396787322e-45),
    (3.279889237069838e-30, 1.5117542744029879e-46),
    (1.1309962886447716e-31, 1.0498015412959506e-47),
];
