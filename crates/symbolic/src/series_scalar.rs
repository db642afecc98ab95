//! Products of power series, the inner loop of a [`SeriesTape`](crate::SeriesTape).

use crate::Scalar;

/// Coefficients of a series are looked at in groups of so many.
pub(crate) const LANES: usize = 8;

/// A pair of series whose product goes, scaled, into a third: places of their first coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Product {
    pub(crate) target: usize,
    pub(crate) left: usize,
    pub(crate) right: usize,
}

/// A number type in which series are multiplied.
///
/// The methods have bodies that serve every type. Those for `f64` take the processor's vector instructions, found when
/// the program runs; sums are added up in the same order with and without them, so that results do not depend on the processor.
pub trait SeriesScalar: Scalar {
    /// Runs `f` with the instructions that are best for this type.
    fn dispatch<F: Task>(f: F) -> F::Result {
        f.run()
    }

    /// The products of the newest coefficients, of order `newest`, with all those from order 1 on: for each product and `1 ≤ j ≤ newest`
    ///
    /// ```text
    /// target[newest + j] += scale (left[newest] right[j] + right[newest] left[j]) weight[j],    newest + j ≤ last
    /// ```
    ///
    /// where `weight` is a half at `j = newest` (the term that is there once only) and zero beyond.
    #[inline(always)]
    fn multiply(
        rows: &mut [Self],
        products: &[Product],
        scales: &[Self],
        weights: Weights<Self>,
        newest: usize,
        last: usize,
    ) {
        let count = newest.min(last - newest);
        for (product, scale) in products.iter().zip(scales) {
            let Product { target, left, right } = *product;
            let (a, b) = (rows[left + newest] * *scale, rows[right + newest] * *scale);
            for j in 1..=count {
                let sum = a * rows[right + j] + b * rows[left + j];
                let sum = if weights.plain && j < newest { sum } else { sum * weights.of[j] };
                rows[target + newest + j] = rows[target + newest + j] + sum;
            }
        }
    }
}

/// Something to be run by [`SeriesScalar::dispatch`].
pub trait Task {
    /// What comes of it.
    type Result;
    /// Does it.
    fn run(self) -> Self::Result;
}

/// Weights of the terms by the order of the older coefficient.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a, T> {
    /// `of[j]` for the older coefficient of order `j`.
    pub(crate) of: &'a [T],
    /// Are they 1 as long as `j < newest`?
    pub(crate) plain: bool,
}

struct Vectorized<F>(F);

impl<F: Task> pulp::NullaryFnOnce for Vectorized<F> {
    type Output = F::Result;

    #[inline(always)]
    fn call(self) -> F::Result {
        self.0.run()
    }
}

impl SeriesScalar for f64 {
    fn dispatch<F: Task>(f: F) -> F::Result {
        pulp::Arch::new().dispatch(Vectorized(f))
    }

    #[inline(always)]
    fn multiply(
        rows: &mut [f64],
        products: &[Product],
        scales: &[f64],
        weights: Weights<f64>,
        newest: usize,
        last: usize,
    ) {
        let count = newest.min(last - newest);
        let mut first = 1;
        while first <= count {
            let weight = lanes(weights.of, first);
            if weights.plain && first + LANES <= newest {
                for (product, scale) in products.iter().zip(scales) {
                    add_products(rows, *product, *scale, newest, first, |x, _| x);
                }
            } else {
                for (product, scale) in products.iter().zip(scales) {
                    add_products(rows, *product, *scale, newest, first, |x, l| x * weight[l]);
                }
            }
            first += LANES;
        }
    }
}

#[inline(always)]
fn lanes(row: &[f64], first: usize) -> [f64; LANES] {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&row[first..first + LANES]);
    lanes
}

#[inline(always)]
fn add_products(
    rows: &mut [f64],
    Product { target, left, right }: Product,
    scale: f64,
    newest: usize,
    first: usize,
    weigh: impl Fn(f64, usize) -> f64,
) {
    let (a, b) = (rows[left + newest] * scale, rows[right + newest] * scale);
    let (x, y) = (lanes(rows, left + first), lanes(rows, right + first));
    let target = &mut rows[target + newest + first..][..LANES];
    for l in 0..LANES {
        target[l] += weigh(a * y[l] + b * x[l], l);
    }
}
