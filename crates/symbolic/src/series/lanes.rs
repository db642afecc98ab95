//! Several numbers at once: the same expressions at several points, one per lane.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::{Product, SeriesScalar, Store, Task, Weights};
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

impl SeriesScalar for Lanes {
    fn dispatch<F: Task<Lanes>>(rows: &mut [Lanes], _: usize, task: F) {
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || task.run(&mut Rows(rows)),
        );
    }
}

/// Rows of lanes. A vector is filled already, so that an order is added up at once, in a register.
struct Rows<'a>(&'a mut [Lanes]);

impl Store<Lanes> for Rows<'_> {
    type Window = [Lanes];

    #[inline(always)]
    fn window(&mut self, first: usize) -> &mut [Lanes] {
        &mut self.0[first..]
    }

    /// Two orders at once from an odd `newest` on: coefficients are read once for both. What the second still
    /// waits for then, the two terms with the newest coefficients, is added when it is due.
    #[inline(always)]
    fn multiply(&mut self, products: &[Product<Lanes>], weights: Weights<Lanes>, newest: usize, _: usize) {
        let weigh = |sum: Lanes, weight: Lanes| if weights.plain { sum } else { sum * weight };
        for Product { scale, target, left, right } in products {
            let [target, left, right] = [target, left, right].map(|p| *p as usize);
            let (x, y) = (&self.0[left + 1..][..newest], &self.0[right + 1..][..newest]);
            let mut sum = x[0] * y[newest - 1];
            if newest.is_multiple_of(2) {
                sum = sum + x[newest - 1] * y[0];
            } else {
                let (mut sums, mut before) = ([Lanes([0.0; LANES]); 3], y[newest - 1]);
                for (x, y) in x[1..].chunks_exact(2).zip(y[..newest - 1].rchunks_exact(2)) {
                    sum = sum + x[0] * y[1];
                    sums[0] = sums[0] + x[1] * y[0];
                    sums[1] = sums[1] + x[0] * before;
                    sums[2] = sums[2] + x[1] * y[1];
                    before = y[0];
                }
                sum = sum + sums[0];
                let second = &mut self.0[target + newest + 2];
                *second = *second + weigh((sums[1] + sums[2]) * *scale, weights.next[1]);
            }
            let first = &mut self.0[target + newest + 1];
            *first = *first + weigh(sum * *scale, weights.next[0]);
        }
    }
}
