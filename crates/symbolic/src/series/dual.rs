//! A number with its derivatives along eight directions, which are carried in [`Lanes`].

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::lanes::{LANES, Lanes};
use super::scalar::{Packs, Products, SeriesScalar};
use crate::{Fraction, Scalar};

/// `x + Σ_l ẋ_l ε_l` with `ε_l ε_m = 0`: what is computed from such numbers has its exact derivatives.
///
/// The value is computed as if it were alone. A derivative that is zero stays zero where that of a function
/// is infinite, as that of `√x` at 0.
///
/// ```
/// use symbolic::{Dual, Scalar};
/// let x = Dual::along(3.0, 1);
/// let y = x * x + x.sqrt();
/// assert_eq!(y.value, 9.0 + 3_f64.sqrt());
/// assert_eq!((y.tangents.0[0], y.tangents.0[1]), (0.0, 6.0 + 0.5 / 3_f64.sqrt()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Dual {
    /// `ẋ`, one per direction.
    pub tangents: Lanes,
    /// `x`
    pub value: f64,
}

impl Dual {
    /// `x + ε_l`: the derivatives of what follows along direction `l` are those by this number.
    pub fn along(value: f64, direction: usize) -> Dual {
        Dual { value, tangents: Lanes(from_fn(|l| if l == direction { 1.0 } else { 0.0 })) }
    }

    /// A function with this value and this derivative here.
    #[inline(always)]
    fn of(self, value: f64, derivative: f64) -> Dual {
        Dual { value, tangents: self.tangents.map(|x| if x == 0.0 { 0.0 } else { derivative * x }) }
    }

    /// `a ẋ + b ẏ`
    #[inline(always)]
    fn combined(a: f64, x: &Lanes, b: f64, y: &Lanes) -> Lanes {
        x.zip(*y, |x, y| a * x + b * y)
    }
}

impl Add for Dual {
    type Output = Dual;
    #[inline(always)]
    fn add(self, other: Dual) -> Dual {
        Dual { value: self.value + other.value, tangents: self.tangents + other.tangents }
    }
}

impl Sub for Dual {
    type Output = Dual;
    #[inline(always)]
    fn sub(self, other: Dual) -> Dual {
        Dual { value: self.value - other.value, tangents: self.tangents - other.tangents }
    }
}

impl Mul for Dual {
    type Output = Dual;
    #[inline(always)]
    fn mul(self, other: Dual) -> Dual {
        let tangents = Dual::combined(self.value, &other.tangents, other.value, &self.tangents);
        Dual { value: self.value * other.value, tangents }
    }
}

impl Div for Dual {
    type Output = Dual;
    #[inline(always)]
    fn div(self, other: Dual) -> Dual {
        let (value, share) = (self.value / other.value, 1.0 / other.value);
        Dual { value, tangents: Dual::combined(share, &self.tangents, -(value * share), &other.tangents) }
    }
}

impl Neg for Dual {
    type Output = Dual;
    #[inline(always)]
    fn neg(self) -> Dual {
        Dual { value: -self.value, tangents: -self.tangents }
    }
}

macro_rules! functions {
    ($($name:ident |$x:ident, $y:ident| $derivative:expr;)*) => { $(
        fn $name(self) -> Dual {
            let $x = self.value;
            let $y = <f64 as Scalar>::$name($x);
            self.of($y, $derivative)
        }
    )* };
}

impl Scalar for Dual {
    #[inline(always)]
    fn from_f64(x: f64) -> Dual {
        Dual { value: x, tangents: Lanes([0.0; LANES]) }
    }

    fn from_ratio(numerator: i64, denominator: i64) -> Dual {
        Dual::from_f64(f64::from_ratio(numerator, denominator))
    }

    fn from_fraction(x: Fraction) -> Dual {
        Dual::from_f64(f64::from_fraction(x))
    }

    fn sin_cos(self) -> (Dual, Dual) {
        let (sin, cos) = self.value.sin_cos();
        (self.of(sin, cos), self.of(cos, -sin))
    }

    functions! {
        sqrt |_x, y| 0.5 / y;
        sin |x, _y| x.cos();
        cos |x, _y| -x.sin();
        tan |_x, y| 1.0 + y * y;
        sinh |x, _y| x.cosh();
        cosh |x, _y| x.sinh();
        tanh |x, _y| <f64 as Scalar>::sech(x).powi(2);
        asin |x, _y| 1.0 / ((1.0 - x) * (1.0 + x)).sqrt();
        acos |x, _y| -1.0 / ((1.0 - x) * (1.0 + x)).sqrt();
        atan |x, _y| 1.0 / (1.0 + x * x);
        asinh |x, _y| 1.0 / x.hypot(1.0);
        acosh |x, _y| 1.0 / ((x - 1.0) * (x + 1.0)).sqrt();
        atanh |x, _y| 1.0 / ((1.0 - x) * (1.0 + x));
        exp |_x, y| y;
        logistic |x, y| y * <f64 as Scalar>::logistic(-x);
        sech |x, y| -y * x.tanh();
        log |x, _y| 1.0 / x;
    }

    fn powf(self, exponent: Dual) -> Dual {
        let (x, e) = (self.value, exponent.value);
        let value = x.powf(e);
        self.of(value, e * x.powf(e - 1.0)) + exponent.of(0.0, value * x.ln())
    }

    fn atan2(self, x: Dual) -> Dual {
        let square = self.value * self.value + x.value * x.value;
        self.of(self.value.atan2(x.value), x.value / square) + x.of(0.0, -self.value / square)
    }

    fn vectorize<F: FnOnce()>(task: F) {
        pulp::Arch::new().dispatch(task);
    }
}

/// An order is added up at once, in registers.
impl SeriesScalar for Dual {
    #[inline(always)]
    fn multiply(rows: &mut [Dual], products: &Products, _: &mut Packs, k: usize, share: Option<Dual>) {
        for [target, left, right] in products.places() {
            let square = left == right;
            let (x, y) = (&rows[left + 1..left + k], &rows[right + 1..right + k]);
            let (mut value, mut sums) = (0.0, [Lanes([0.0; LANES]); 2]);
            for (a, b) in x.iter().zip(y.iter().rev()) {
                value += a.value * b.value;
                sums[0] = sums[0] + a.tangents.map(|t| t * b.value);
                if !square {
                    sums[1] = sums[1] + b.tangents.map(|t| t * a.value);
                }
            }
            let tangents = sums[0] + if square { sums[0] } else { sums[1] };
            let sum = Dual { value, tangents };
            rows[target + k] = share.map_or(sum, |share| sum * share);
        }
    }
}
