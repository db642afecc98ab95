//! The number types of power series, and how each multiplies series.
//!
//! Numbers of 64 bits are multiplied in packs: eight products of series at a time, one per lane, each summed
//! as if it were alone. `pulp` picks the processor's instructions; sums have one order on all, and so one
//! result. The loops are bound by their number of instructions: one product at a time, in groups of eight
//! coefficients, took two to three times as many.

use super::lanes::{LANES, Lanes};
use crate::Scalar;

/// A place of a coefficient: order `k` of a series is `k` behind its order 0.
pub(crate) type Place = u32;

/// A product of two series: places of the first coefficients of the three.
#[derive(Clone, Copy, Debug, Default)]
pub struct Product {
    pub(crate) target: Place,
    pub(crate) left: Place,
    pub(crate) right: Place,
}

/// Products in whole groups, with the number of groups before them.
#[derive(Clone, Debug)]
pub struct Products {
    pub(crate) list: Vec<Product>,
    pub(crate) from: usize,
}

impl Products {
    /// Target, left and right.
    #[inline(always)]
    pub(crate) fn places(&self) -> impl Iterator<Item = [usize; 3]> {
        self.list.iter().map(|p| [p.target, p.left, p.right].map(|place| place as usize))
    }
}

/// Coefficients of the factors of packs of products, order by order: of those on the left, then on the right.
#[derive(Clone, Debug)]
pub struct Packs {
    pub(crate) factors: Vec<Lanes>,
    /// Number of orders.
    pub(crate) room: usize,
}

/// A number type of power series.
pub trait SeriesScalar: Scalar + 'static {
    /// Products come in groups of this many; as many places follow a series.
    const GROUP: usize = 1;

    /// Order `k ≥ 1` of products, orders 0 left out: for each
    ///
    /// ```text
    /// target[k] = (1 or share) Σ_{i+j=k; i,j≥1} left[i] right[j].
    /// ```
    ///
    /// It is called for every order in turn; order `k + 1` of targets may be written as well.
    #[inline(always)]
    fn multiply(rows: &mut [Self], products: &Products, _packs: &mut Packs, k: usize, share: Option<Self>) {
        for [target, left, right] in products.places() {
            let sum = convolved(&rows[left + 1..left + k], &rows[right + 1..right + k]);
            rows[target + k] = share.map_or(sum, |share| sum * share);
        }
    }
}

/// `Σ_i left[i] right[n - 1 - i]` of n numbers each: the newest, which are waited for, last.
#[inline(always)]
fn convolved<T: Scalar>(left: &[T], right: &[T]) -> T {
    let ([x, older @ .., last], [y, older_of_right @ .., last_of_right]) = (left, right) else {
        return if left.is_empty() { T::from_f64(0.0) } else { left[0] * right[0] };
    };
    let (fours, rest) = older.as_chunks::<4>();
    let (rest_of_right, fours_of_right) = older_of_right.as_rchunks::<4>();
    let mut sums = [T::from_f64(0.0); 4];
    for (x, y) in fours.iter().zip(fours_of_right.iter().rev()) {
        for l in 0..4 {
            sums[l] = sums[l] + x[l] * y[3 - l];
        }
    }
    for (x, y) in rest.iter().zip(rest_of_right.iter().rev()) {
        sums[0] = sums[0] + *x * *y;
    }
    ((sums[0] + sums[1]) + (sums[2] + sums[3])) + (*x * *last_of_right + *last * *y)
}

impl SeriesScalar for f64 {
    const GROUP: usize = LANES;

    #[inline(always)]
    fn multiply(rows: &mut [f64], products: &Products, packs: &mut Packs, k: usize, share: Option<f64>) {
        let places = products.list.as_chunks::<LANES>().0;
        let factors = packs.factors[2 * packs.room * products.from..].chunks_exact_mut(2 * packs.room);
        for (pack, factors) in places.iter().zip(factors) {
            let (left, right) = factors.split_at_mut(packs.room);
            let (mut x, mut y) = (Lanes([0.0; LANES]), Lanes([0.0; LANES]));
            for (l, product) in pack.iter().enumerate() {
                (x.0[l], y.0[l]) = (rows[product.left as usize + k - 1], rows[product.right as usize + k - 1]);
            }
            (left[k - 1], right[k - 1]) = (x, y);
            let sum = convolved(&left[1..k], &right[1..k]);
            let sum = share.map_or(sum, |share| sum.map(|x| x * share));
            rows[pack[0].target as usize + k..][..LANES].copy_from_slice(&sum.0);
        }
    }
}

impl SeriesScalar for Lanes {
    /// Two orders at once from an even `k` on: coefficients are read once for both. What the second still
    /// waits for then, the two terms with the newest coefficients, is added when it is due.
    #[inline(always)]
    fn multiply(rows: &mut [Lanes], products: &Products, _: &mut Packs, k: usize, share: Option<Lanes>) {
        let newest = k - 1;
        for [target, left, right] in products.places() {
            let (x, y) = (&rows[left + 1..][..newest], &rows[right + 1..][..newest]);
            let mut sum = match newest {
                0 => Lanes([0.0; LANES]),
                _ => x[0] * y[newest - 1],
            };
            if newest.is_multiple_of(2) {
                if newest > 0 {
                    sum = rows[target + k] + (sum + x[newest - 1] * y[0]);
                }
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
                rows[target + k + 1] = sums[1] + sums[2];
            }
            rows[target + k] = share.map_or(sum, |share| sum * share);
        }
    }
}
