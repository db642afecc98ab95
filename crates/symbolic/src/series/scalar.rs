//! The number types of power series, and where coefficients are kept.
//!
//! Products go forwards: a new coefficient meets all older ones, in groups of 8 at fixed places, because that
//! needs no sum across a vector. `pulp` picks the processor's instructions; sums have one order on all, and
//! so one result. The loops are bound by their number of instructions: linear terms put into one another, so
//! that none waits for another, made the series of sledge and cone 9 to 26 % slower.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::thread::LocalKey;

use crate::Scalar;

/// Size of the groups in which coefficients of a series are examined.
pub(crate) const GROUP: usize = 8;

/// A place of a coefficient, from the beginning of a [`Window`].
pub(crate) type Place = u32;

/// A product of two series that goes, scaled, into a third: places of their first coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Product<T> {
    pub(crate) scale: T,
    pub(crate) target: Place,
    pub(crate) left: Place,
    pub(crate) right: Place,
}

/// Weights of the terms of products by the order of the older coefficient.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a, T> {
    /// `of[j]` for the older coefficient of order `j`: half at `j = newest` (there once only), zero beyond.
    pub(crate) of: &'a [T],
    /// Are they 1 as long as `j < newest`?
    pub(crate) plain: bool,
    /// The weights of all terms of orders `newest + 1` and `newest + 2`, each taken once.
    pub(crate) next: [T; 2],
}

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

    /// Products of the newest coefficients with all from order 1 on: for each product and `1 ≤ j ≤ newest`
    ///
    /// ```text
    /// target[n + j] += scale (left[n] right[j] + right[n] left[j]) weight[j],   n = newest,   n + j ≤ last
    /// ```
    ///
    /// What is beyond `last` is left undefined. Orders over `newest + 1` may be left for later: called for
    /// every `newest` in turn, this has added all terms of order `newest + 1` when that order is due.
    fn multiply(&mut self, products: &[Product<T>], weights: Weights<T>, newest: usize, last: usize);
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
    fn multiply(&mut self, products: &[Product<T>], weights: Weights<T>, newest: usize, last: usize) {
        let count = newest.min(last - newest);
        for Product { scale, target, left, right } in products {
            let [target, left, right] = [target, left, right].map(|p| *p as usize);
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
/// The methods serve every type. For `f64` they take the processor's vector instructions, found at run time;
/// sums keep their order, so that results do not depend on the processor.
pub trait SeriesScalar: Scalar + 'static {
    /// Coefficients are looked at in groups of this many; as many readable places follow a series.
    const GROUP: usize = 1;

    /// Number of places to allocate for this number of series, `stride` places each.
    fn room(series: usize, stride: usize) -> usize {
        series * stride
    }

    /// Room that was given back, zero throughout, for types with much of it.
    fn spare() -> Option<&'static LocalKey<RefCell<Vec<Vec<Self>>>>> {
        None
    }

    /// Runs `task` on coefficients, at places below `places`, with the best instructions for this type.
    fn dispatch<F: Task<Self>>(rows: &mut [Self], _places: usize, task: F) {
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

    fn room(series: usize, stride: usize) -> usize {
        let places = series * stride;
        // one room for all orders
        if places <= PLACES { WINDOW + stride.next_multiple_of(GROUP * GROUP) } else { places + GROUP }
    }

    fn spare() -> Option<&'static LocalKey<RefCell<Vec<Vec<f64>>>>> {
        Some(&SPARE)
    }

    fn dispatch<F: Task<f64>>(rows: &mut [f64], places: usize, task: F) {
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || match places <= PLACES {
                true => task.run(&mut Grouped::<[f64; WINDOW]>(rows, PhantomData)),
                false => task.run(&mut Grouped::<[f64]>(rows, PhantomData)),
            },
        );
    }
}

/// Coefficients that are looked at in groups, through windows `W`: those of [`WINDOW`] places need no checks.
struct Grouped<'a, W: ?Sized>(&'a mut [f64], PhantomData<W>);

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

impl<W: Groups + ?Sized> Grouped<'_, W> {
    /// Terms `first ≤ j < first + GROUP` of all products.
    #[inline(always)]
    fn add(&mut self, products: &[Product<f64>], newest: usize, first: usize, weigh: impl Fn(f64, usize) -> f64) {
        for Product { scale, target, left, right } in products {
            let window = self.window(newest);
            let (a, b) = (window.get(*left) * scale, window.get(*right) * scale);
            let window = self.window(first);
            let (x, y) = (*window.group(*left), *window.group(*right));
            let target = self.window(newest + first).group(*target);
            for l in 0..GROUP {
                target[l] += weigh(a * y[l] + b * x[l], l);
            }
        }
    }
}

impl<W: Groups + ?Sized> Store<f64> for Grouped<'_, W> {
    type Window = W;

    #[inline(always)]
    fn window(&mut self, first: usize) -> &mut W {
        W::within(&mut self.0[first..])
    }

    #[inline(always)]
    fn multiply(&mut self, products: &[Product<f64>], weights: Weights<f64>, newest: usize, last: usize) {
        let count = newest.min(last - newest);
        let mut first = 1;
        while first <= count {
            let mut weight = [0.0; GROUP];
            weight.copy_from_slice(&weights.of[first..first + GROUP]);
            if weights.plain && first + GROUP <= newest {
                self.add(products, newest, first, |x, _| x);
            } else {
                self.add(products, newest, first, |x, l| x * weight[l]);
            }
            first += GROUP;
        }
    }
}
