//! Several numbers at once: the same expressions at several points, one per lane.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Scalar;

/// Number of [`Lanes`].
pub const LANES: usize = 8;

/// Eight numbers, each computed as if it were alone from those of its own place: no lane depends on another.
///
/// ```
/// use symbolic::{Lanes, Scalar};
/// let x = Lanes([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
/// assert_eq!((x * x + Lanes::from_f64(1.0)).0[3], 10.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// By a loop: closures of array functions are not always inlined, and then take no vector instructions.
    #[inline(always)]
    pub(crate) fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for x in &mut self.0 {
            *x = f(*x);
        }
        self
    }

    #[inline(always)]
    pub(crate) fn zip(mut self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        for l in 0..LANES {
            self.0[l] = f(self.0[l], other.0[l]);
        }
        self
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident $sign:tt)*) => { $(
        impl $trait for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                self.zip(other, |a, b| a $sign b)
            }
        }
    )* };
}

operator!(Add add + Sub sub - Mul mul * Div div /);

impl Neg for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn neg(self) -> Lanes {
        self.map(|x| -x)
    }
}

macro_rules! functions {
    ($($name:ident)*) => { $(
        fn $name(self) -> Lanes {
            self.map(<f64 as Scalar>::$name)
        }
    )* };
}

impl Scalar for Lanes {
    #[inline(always)]
    fn from_f64(x: f64) -> Lanes {
        Lanes([x; LANES])
    }

    fn from_ratio(numerator: i64, denominator: i64) -> Lanes {
        Lanes([f64::from_ratio(numerator, denominator); LANES])
    }

    #[inline(always)]
    fn sqrt(self) -> Lanes {
        self.map(f64::sqrt)
    }

    fn sin_cos(self) -> (Lanes, Lanes) {
        let both = self.0.map(f64::sin_cos);
        (Lanes(both.map(|x| x.0)), Lanes(both.map(|x| x.1)))
    }

    functions!(sin cos tan sinh cosh tanh asin acos atan asinh acosh atanh exp logistic sech log);

    fn powf(self, exponent: Lanes) -> Lanes {
        self.zip(exponent, f64::powf)
    }

    fn atan2(self, x: Lanes) -> Lanes {
        self.zip(x, f64::atan2)
    }

    fn vectorize<F: FnOnce()>(task: F) {
        pulp::Arch::new().dispatch(task);
    }
}
