//! The number types of power series, and where coefficients are kept.

use crate::Scalar;

/// Coefficients of a series are looked at in groups of so many.
pub(crate) const GROUP: usize = 8;

/// A product of two series that goes, scaled, into a third: places of their first coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Product<T> {
    pub(crate) scale: T,
    pub(crate) target: usize,
    pub(crate) left: usize,
    pub(crate) right: usize,
}

/// Weights of the terms of products by the order of the older coefficient.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a, T> {
    /// `of[j]` for the older coefficient of order `j`: a half at `j = newest` (that term is there once only), zero beyond.
    pub(crate) of: &'a [T],
    /// Are they 1 as long as `j < newest`?
    pub(crate) plain: bool,
    /// The weight of all terms of order `newest + 1`, each taken once.
    pub(crate) next: T,
}

/// Coefficients, one series after the other.
pub trait Store<T> {
    /// The coefficient at a place.
    fn get(&self, place: usize) -> T;

    /// Puts a coefficient at a place.
    fn set(&mut self, place: usize, x: T);

    /// The products of the newest coefficients, of order `newest`, with all those from order 1 on: for each product and `1 ≤ j ≤ newest`
    ///
    /// ```text
    /// target[newest + j] += scale (left[newest] right[j] + right[newest] left[j]) weight[j],    newest + j ≤ last
    /// ```
    ///
    /// What is beyond `last` is left undefined. Orders over `newest + 1` may be left for later: called for every `newest` in turn, this has
    /// added all terms of order `newest + 1` when that order is due.
    fn multiply(&mut self, products: &[Product<T>], weights: Weights<T>, newest: usize, last: usize);
}

impl<T: Scalar> Store<T> for [T] {
    #[inline(always)]
    fn get(&self, place: usize) -> T {
        self[place]
    }

    #[inline(always)]
    fn set(&mut self, place: usize, x: T) {
        self[place] = x;
    }

    #[inline(always)]
    fn multiply(&mut self, products: &[Product<T>], weights: Weights<T>, newest: usize, last: usize) {
        let count = newest.min(last - newest);
        for Product { scale, target, left, right } in products {
            let (a, b) = (self[left + newest] * *scale, self[right + newest] * *scale);
            for j in 1..=count {
                let sum = a * self[right + j] + b * self[left + j];
                let sum = if weights.plain && j < newest { sum } else { sum * weights.of[j] };
                self[target + newest + j] = self[target + newest + j] + sum;
            }
        }
    }
}

/// Something to be done with coefficients by [`SeriesScalar::dispatch`].
pub trait Task<T> {
    /// Does it.
    fn run<S: Store<T> + ?Sized>(self, rows: &mut S);
}

/// A number type of power series.
///
/// The bodies of the methods serve every type. For `f64` they take the processor's vector instructions, found when
/// the program runs; sums are added up in the same order with and without them, so that results do not depend on the processor.
///
/// ```
/// use symbolic::{Scalar, SeriesScalar};
/// #[derive(Clone, Copy)]
/// struct Own(f64);
/// # use std::ops::*;
/// # impl Add for Own { type Output = Own; fn add(self, o: Own) -> Own { Own(self.0 + o.0) } }
/// # impl Sub for Own { type Output = Own; fn sub(self, o: Own) -> Own { Own(self.0 - o.0) } }
/// # impl Mul for Own { type Output = Own; fn mul(self, o: Own) -> Own { Own(self.0 * o.0) } }
/// # impl Div for Own { type Output = Own; fn div(self, o: Own) -> Own { Own(self.0 / o.0) } }
/// # impl Neg for Own { type Output = Own; fn neg(self) -> Own { Own(-self.0) } }
/// # impl Scalar for Own {
/// #     fn from_f64(x: f64) -> Own { Own(x) }
/// #     fn from_ratio(a: i64, b: i64) -> Own { Own(a as f64 / b as f64) }
/// #     fn sqrt(self) -> Own { Own(self.0.sqrt()) }
/// #     fn sin(self) -> Own { Own(self.0.sin()) }
/// #     fn cos(self) -> Own { Own(self.0.cos()) }
/// #     fn tan(self) -> Own { Own(self.0.tan()) }
/// #     fn sinh(self) -> Own { Own(self.0.sinh()) }
/// #     fn cosh(self) -> Own { Own(self.0.cosh()) }
/// #     fn tanh(self) -> Own { Own(self.0.tanh()) }
/// #     fn asin(self) -> Own { Own(self.0.asin()) }
/// #     fn acos(self) -> Own { Own(self.0.acos()) }
/// #     fn atan(self) -> Own { Own(self.0.atan()) }
/// #     fn asinh(self) -> Own { Own(self.0.asinh()) }
/// #     fn acosh(self) -> Own { Own(self.0.acosh()) }
/// #     fn atanh(self) -> Own { Own(self.0.atanh()) }
/// #     fn exp(self) -> Own { Own(self.0.exp()) }
/// #     fn log(self) -> Own { Own(self.0.ln()) }
/// #     fn powf(self, e: Own) -> Own { Own(self.0.powf(e.0)) }
/// #     fn atan2(self, x: Own) -> Own { Own(self.0.atan2(x.0)) }
/// # }
/// impl SeriesScalar for Own {}
/// ```
pub trait SeriesScalar: Scalar {
    /// Coefficients of a series are looked at in groups of so many; a series is followed by as many places that may be read.
    const GROUP: usize = 1;

    /// How many places to allocate where so many are needed.
    fn room(places: usize) -> usize {
        places
    }

    /// Runs `task` on coefficients with the instructions that are best for this type.
    fn dispatch<F: Task<Self>>(rows: &mut [Self], task: F) {
        task.run(rows);
    }
}

/// Sizes for which places are masked instead of checked, and what is read past a place.
const SMALL: usize = 1 << 13;
const LARGE: usize = 1 << 16;

impl SeriesScalar for f64 {
    const GROUP: usize = GROUP;

    fn room(places: usize) -> usize {
        let sizes = [SMALL, LARGE].map(|size| size + GROUP);
        sizes.into_iter().find(|size| places <= *size).unwrap_or(places)
    }

    fn dispatch<F: Task<f64>>(rows: &mut [f64], task: F) {
        pulp::Arch::new().dispatch(Vectorized { rows, task });
    }
}

struct Vectorized<'a, F> {
    rows: &'a mut [f64],
    task: F,
}

impl<F: Task<f64>> pulp::NullaryFnOnce for Vectorized<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        if let Ok(rows) = <&mut [f64; SMALL + GROUP]>::try_from(&mut *self.rows) {
            self.task.run(&mut Grouped(rows));
        } else if let Ok(rows) = <&mut [f64; LARGE + GROUP]>::try_from(&mut *self.rows) {
            self.task.run(&mut Grouped(rows));
        } else {
            self.task.run(&mut Grouped(self.rows));
        }
    }
}

/// Rows of f64 that are looked at in groups.
struct Grouped<'a, R: ?Sized>(&'a mut R);

trait Groups {
    fn at(&self, place: usize) -> f64;
    fn one(&mut self, place: usize) -> &mut f64;
    fn group(&mut self, place: usize) -> &mut [f64; GROUP];
}

impl Groups for [f64] {
    #[inline(always)]
    fn at(&self, place: usize) -> f64 {
        self[place]
    }

    #[inline(always)]
    fn one(&mut self, place: usize) -> &mut f64 {
        &mut self[place]
    }

    #[inline(always)]
    fn group(&mut self, place: usize) -> &mut [f64; GROUP] {
        self[place..].first_chunk_mut().expect("rows end with a group to spare")
    }
}

/// A mask instead of a check at each access: all places are below the size, so that it changes none.
impl<const N: usize> Groups for [f64; N] {
    #[inline(always)]
    fn at(&self, place: usize) -> f64 {
        self[place & (N - GROUP - 1)]
    }

    #[inline(always)]
    fn one(&mut self, place: usize) -> &mut f64 {
        &mut self[place & (N - GROUP - 1)]
    }

    #[inline(always)]
    fn group(&mut self, place: usize) -> &mut [f64; GROUP] {
        self[place & (N - GROUP - 1)..].first_chunk_mut().expect("the array has a group to spare")
    }
}

impl<R: Groups + ?Sized> Grouped<'_, R> {
    #[inline(always)]
    fn add_products(
        &mut self,
        products: &[Product<f64>],
        newest: usize,
        first: usize,
        weigh: impl Fn(f64, usize) -> f64,
    ) {
        for Product { scale, target, left, right } in products {
            let (a, b) = (*self.0.one(left + newest) * scale, *self.0.one(right + newest) * scale);
            let (x, y) = (*self.0.group(left + first), *self.0.group(right + first));
            let target = self.0.group(target + newest + first);
            for l in 0..GROUP {
                target[l] += weigh(a * y[l] + b * x[l], l);
            }
        }
    }
}

impl<R: Groups + ?Sized> Store<f64> for Grouped<'_, R> {
    #[inline(always)]
    fn get(&self, place: usize) -> f64 {
        self.0.at(place)
    }

    #[inline(always)]
    fn set(&mut self, place: usize, x: f64) {
        *self.0.one(place) = x;
    }

    #[inline(always)]
    fn multiply(&mut self, products: &[Product<f64>], weights: Weights<f64>, newest: usize, last: usize) {
        let count = newest.min(last - newest);
        let mut first = 1;
        while first <= count {
            let mut weight = [0.0; GROUP];
            weight.copy_from_slice(&weights.of[first..first + GROUP]);
            if weights.plain && first + GROUP <= newest {
                self.add_products(products, newest, first, |x, _| x);
            } else {
                self.add_products(products, newest, first, |x, l| x * weight[l]);
            }
            first += GROUP;
        }
    }
}
