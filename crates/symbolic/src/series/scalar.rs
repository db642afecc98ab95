//! The number types of power series, and where coefficients are kept.
//!
//! Numbers of 64 bits are multiplied in packs: eight products of series at a time, one per lane, each summed as
//! if it were alone. `pulp` picks the processor's instructions; sums have one order on all, and so one result.
//! The loops are bound by their number of instructions: one product at a time, in groups of eight coefficients,
//! took two to three times as many.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::thread::LocalKey;

use super::lanes::{LANES, Lanes};
use crate::Scalar;

/// Number of products in a pack.
pub(crate) const GROUP: usize = 8;

/// A place of a coefficient, from the beginning of a [`Window`].
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

/// Coefficients of the factors of packs of products, order by order: of those on the left, then on the right.
#[derive(Clone, Debug, Default)]
pub struct Packs(Vec<Lanes>);

/// Coefficients from some place on.
pub trait Window<T> {
    /// The coefficient at a place.
    fn get(&self, place: u32) -> T;

    /// Puts a coefficient at a place.
    fn set(&mut self, place: u32, x: T);
}

/// Coefficients, one series after the other.
pub trait Store<T> {
    /// What [`Store::window`] gives.
    type Window: Window<T> + ?Sized;

    /// The coefficients from a place on: order `k` of all series is order 0 in the window from `k` on.
    fn window(&mut self, first: usize) -> &mut Self::Window;

    /// Order `k ≥ 1` of products, orders 0 left out: for each
    ///
    /// ```text
    /// target[k] = (1 or share) Σ_{i+j=k; i,j≥1} left[i] right[j].
    /// ```
    ///
    /// It is called for every order in turn; order `k + 1` of targets may be written as well.
    fn multiply(&mut self, products: &Products, k: usize, share: Option<T>);
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

impl<T: Scalar> Window<T> for [T] {
    #[inline(always)]
    fn get(&self, place: u32) -> T {
        self[place as usize]
    }

    #[inline(always)]
    fn set(&mut self, place: u32, x: T) {
        self[place as usize] = x;
    }
}

impl<T: Scalar> Store<T> for [T] {
    type Window = [T];

    #[inline(always)]
    fn window(&mut self, first: usize) -> &mut [T] {
        &mut self[first..]
    }

    #[inline(always)]
    fn multiply(&mut self, products: &Products, k: usize, share: Option<T>) {
        for Product { target, left, right } in &products.list {
            let [target, left, right] = [target, left, right].map(|p| *p as usize);
            let sum = convolved(&self[left + 1..left + k], &self[right + 1..right + k]);
            self[target + k] = share.map_or(sum, |share| sum * share);
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
/// The methods serve every type. For `f64` they take the processor's vector instructions, found at run time;
/// sums keep their order, so that results do not depend on the processor.
pub trait SeriesScalar: Scalar + 'static {
    /// Products come in groups of this many; as many places follow a series.
    const GROUP: usize = 1;

    /// Number of places to allocate for this many, `stride` for a series.
    fn room(places: usize, _stride: usize) -> usize {
        places
    }

    /// Room that was given back, zero throughout, for types with much of it.
    fn spare() -> Option<&'static LocalKey<RefCell<Vec<Vec<Self>>>>> {
        None
    }

    /// Runs `task` on coefficients, at places below `places`, with packs and an order that no factor in them
    /// reaches, and with the best instructions for this type.
    fn dispatch<F: Task<Self>>(rows: &mut [Self], _places: usize, _packs: (&mut Packs, usize), task: F) {
        task.run(rows);
    }
}

/// The places of a 16-bit number: unchecked in a window of this size, whose last place a group follows.
const PLACES: usize = 1 << 16;
const WINDOW: usize = PLACES + GROUP;

thread_local! {
    static SPARE: RefCell<Vec<Vec<f64>>> = const { RefCell::new(Vec::new()) };
}

impl SeriesScalar for f64 {
    const GROUP: usize = GROUP;

    fn room(places: usize, stride: usize) -> usize {
        // one room for all orders
        if places <= PLACES { WINDOW + stride.next_multiple_of(GROUP * GROUP) } else { places + GROUP }
    }

    fn spare() -> Option<&'static LocalKey<RefCell<Vec<Vec<f64>>>>> {
        Some(&SPARE)
    }

    fn dispatch<F: Task<f64>>(rows: &mut [f64], places: usize, (packs, order): (&mut Packs, usize), task: F) {
        let packs = &mut packs.0;
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || match places <= PLACES {
                true => task.run(&mut Packed::<[f64; WINDOW]> { rows, packs, order, windows: PhantomData }),
                false => task.run(&mut Packed::<[f64]> { rows, packs, order, windows: PhantomData }),
            },
        );
    }
}

/// Coefficients that are looked at through windows `W`: those of [`WINDOW`] places need no checks.
struct Packed<'a, W: ?Sized> {
    rows: &'a mut [f64],
    packs: &'a mut Vec<Lanes>,
    order: usize,
    windows: PhantomData<W>,
}

trait Groups: Window<f64> {
    fn within(rows: &mut [f64]) -> &mut Self;

    fn group(&mut self, place: u32) -> &mut [f64; GROUP];
}

impl Groups for [f64] {
    #[inline(always)]
    fn within(rows: &mut [f64]) -> &mut [f64] {
        rows
    }

    #[inline(always)]
    fn group(&mut self, place: u32) -> &mut [f64; GROUP] {
        self[place as usize..].first_chunk_mut().expect("rows end with a group to spare")
    }
}

impl Window<f64> for [f64; WINDOW] {
    #[inline(always)]
    fn get(&self, place: u32) -> f64 {
        self[usize::from(place as u16)]
    }

    #[inline(always)]
    fn set(&mut self, place: u32, x: f64) {
        self[usize::from(place as u16)] = x;
    }
}

impl Groups for [f64; WINDOW] {
    #[inline(always)]
    fn within(rows: &mut [f64]) -> &mut [f64; WINDOW] {
        rows.first_chunk_mut().expect("room for windows up to the highest order and a group")
    }

    #[inline(always)]
    fn group(&mut self, place: u32) -> &mut [f64; GROUP] {
        self[usize::from(place as u16)..].first_chunk_mut().expect("the window has a group to spare")
    }
}

impl<W: Groups + ?Sized> Store<f64> for Packed<'_, W> {
    type Window = W;

    #[inline(always)]
    fn window(&mut self, first: usize) -> &mut W {
        W::within(&mut self.rows[first..])
    }

    #[inline(always)]
    fn multiply(&mut self, products: &Products, k: usize, share: Option<f64>) {
        let (packs, room) = (products.list.as_chunks::<GROUP>().0, self.order);
        let (begin, end) = (2 * room * products.from, 2 * room * (products.from + packs.len()));
        if self.packs.len() < end {
            self.packs.resize(end, Lanes([0.0; GROUP]));
        }
        for (pack, factors) in packs.iter().zip(self.packs[begin..end].chunks_exact_mut(2 * room)) {
            let newest = W::within(&mut self.rows[k - 1..]);
            let (left, right) = factors.split_at_mut(room);
            let (mut x, mut y) = (Lanes([0.0; GROUP]), Lanes([0.0; GROUP]));
            for (l, product) in pack.iter().enumerate() {
                (x.0[l], y.0[l]) = (newest.get(product.left), newest.get(product.right));
            }
            (left[k - 1], right[k - 1]) = (x, y);
            let sum = convolved(&left[1..k], &right[1..k]);
            let sum = share.map_or(sum, |share| sum.map(|x| x * share));
            *W::within(&mut self.rows[k..]).group(pack[0].target) = sum.0;
        }
    }
}

impl SeriesScalar for Lanes {
    fn dispatch<F: Task<Lanes>>(rows: &mut [Lanes], _: usize, _: (&mut Packs, usize), task: F) {
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

    /// Two orders at once from an even `k` on: coefficients are read once for both. What the second still waits
    /// for then, the two terms with the newest coefficients, is added when it is due.
    #[inline(always)]
    fn multiply(&mut self, products: &Products, k: usize, share: Option<Lanes>) {
        let newest = k - 1;
        for Product { target, left, right } in &products.list {
            let [target, left, right] = [target, left, right].map(|p| *p as usize);
            let (x, y) = (&self.0[left + 1..][..newest], &self.0[right + 1..][..newest]);
            let mut sum = match newest {
                0 => Lanes([0.0; LANES]),
                _ => x[0] * y[newest - 1],
            };
            if newest.is_multiple_of(2) {
                if newest > 0 {
                    sum = self.0[target + k] + (sum + x[newest - 1] * y[0]);
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
                self.0[target + k + 1] = sums[1] + sums[2];
            }
            self.0[target + k] = share.map_or(sum, |share| sum * share);
        }
    }
}
