//! Fault injection: one operation of a derivation is made wrong, to test whether a judge notices.
//!
//! Constructors, derivatives, substitutions and questions of a [`Graph`] ask here whether and how to go
//! wrong: each such *chance* has a number, counted from the beginning of the work. [`chances`] counts them,
//! [`spoiled`] lets one happen. What a graph remembers (derivatives) stays right.
//!
//! Outside of a test this is one look at a flag of the thread. A cargo feature would cost more: the programs
//! and the tests would no longer share their crates. The flag belongs to the thread, not to the graph,
//! because a derivation works on several clones of a graph.

use crate::store::arena::Arena;
use crate::store::number::{Number, Rational};
use crate::{Expr, Graph};
use std::cell::{Cell, RefCell};
use std::panic::Location;

/// Something that can go wrong with one operation.
#[derive(Clone, Copy, Debug)]
pub struct Chance {
    /// Where the operation is asked for.
    pub at: &'static Location<'static>,
    /// What goes wrong, in words.
    pub what: &'static str,
}

/// Work is stopped that takes this factor times the chances of sound work, and this number more.
const PATIENCE: (usize, usize) = (20, 10_000);

struct Watch {
    /// The chance that happens; none while chances are counted.
    wanted: Option<usize>,
    met: usize,
    limit: usize,
    chances: Vec<Chance>,
}

thread_local! {
    static WATCHED: Cell<bool> = const { Cell::new(false) };
    static WATCH: RefCell<Option<Watch>> = const { RefCell::new(None) };
}

/// Does sound work; what can go wrong in it, in the order in which it is met.
///
/// ```
/// let g = symbolic::Graph::new();
/// let [x, y] = ["x", "y"].map(|name| g.variable(g.symbol(name)));
/// let (sum, chances) = symbolic::faults::chances(|| g.add(x, y));
/// assert_eq!(chances.len(), 4);
/// assert_eq!(chances[3].what, "sign of a term turned");
/// let spoiled = symbolic::faults::spoiled(3, chances.len(), || g.add(x, y));
/// assert_eq!((spoiled, sum), (g.sub(x, y), g.add(x, y)));
/// ```
pub fn chances<T>(work: impl FnOnce() -> T) -> (T, Vec<Chance>) {
    watched(Watch { wanted: None, met: 0, limit: usize::MAX, chances: Vec::new() }, work)
}

/// Does work in which the chance with number `which` of `count` happens.
///
/// # Panics
/// Where the work no longer ends: with many times as many chances as sound work has.
pub fn spoiled<T>(which: usize, count: usize, work: impl FnOnce() -> T) -> T {
    watched(Watch { wanted: Some(which), met: 0, limit: count * PATIENCE.0 + PATIENCE.1, chances: Vec::new() }, work).0
}

fn watched<T>(watch: Watch, work: impl FnOnce() -> T) -> (T, Vec<Chance>) {
    /// Ends the watch, also where the work panics.
    struct End;
    impl Drop for End {
        fn drop(&mut self) {
            WATCHED.set(false);
        }
    }
    WATCH.set(Some(watch));
    WATCHED.set(true);
    let end = End;
    let result = work();
    drop(end);
    (result, WATCH.take().map_or_else(Vec::new, |watch| watch.chances))
}

/// The change that happens here and now, by its place in the list; none nearly always.
#[track_caller]
fn strikes(changes: &[&'static str]) -> Option<usize> {
    let at = Location::caller();
    let (change, runs_away) = WATCH.with_borrow_mut(|watch| {
        let Some(watch) = watch else { return (None, false) };
        let first = watch.met;
        watch.met += changes.len();
        let change = match watch.wanted {
            None => {
                watch.chances.extend(changes.iter().map(|&what| Chance { at, what }));
                None
            }
            Some(wanted) => wanted.checked_sub(first).filter(|&change| change < changes.len()),
        };
        (change, watch.met > watch.limit)
    });
    assert!(!runs_away, "with this fault the work does not end");
    change
}

/// Drops a term of a sum, or turns its sign.
#[inline]
#[track_caller]
pub(crate) fn spoil_terms(terms: &mut Vec<(Expr, Number)>) {
    if !WATCHED.get() {
        return;
    }
    for i in 0..terms.len() {
        if terms[i].0 == Arena::ZERO {
            continue;
        }
        match strikes(&["term dropped", "sign of a term turned"]) {
            None => continue,
            Some(0) => _ = terms.remove(i),
            Some(_) => terms[i].1 = Number::MINUS_ONE.mul(terms[i].1),
        }
        return;
    }
}

/// Drops a factor of a product; where it divides, it may also become one that does not.
#[inline]
#[track_caller]
pub(crate) fn spoil_factors(factors: &mut Vec<(Expr, Rational)>) {
    if !WATCHED.get() || factors.iter().any(|(e, _)| *e == Arena::ZERO) {
        return;
    }
    for i in 0..factors.len() {
        let (e, exponent) = factors[i];
        let changes: &[&str] = match exponent {
            _ if e == Arena::ONE => continue,
            r if r == Rational::ONE => &["factor dropped"],
            r if r.is_negative() => &["divisor dropped", "divisor made a factor"],
            _ => &["power dropped"],
        };
        match (strikes(changes), changes) {
            (None, _) => continue,
            (Some(0), ["power dropped"]) => factors[i].1 = Rational::ONE,
            (Some(0), _) => _ = factors.remove(i),
            (Some(_), _) => factors[i].1 = exponent.neg(),
        }
        return;
    }
}

/// Whether a question is answered wrongly, or something else is left out.
#[inline]
#[track_caller]
pub(crate) fn goes_wrong(what: &'static str) -> bool {
    WATCHED.get() && strikes(&[what]).is_some()
}

impl Graph {
    /// A variable or a number, or its negative.
    #[inline]
    #[track_caller]
    pub(crate) fn perhaps_negative(&self, e: Expr) -> Expr {
        if e != Arena::ZERO && goes_wrong("sign turned") {
            return self.arena.borrow_mut().scale(Number::MINUS_ONE, e);
        }
        e
    }

    /// A derivative, or what becomes of it.
    #[inline]
    #[track_caller]
    pub(crate) fn perhaps_spoiled(&self, derivative: Expr) -> Expr {
        if !WATCHED.get() || derivative == Arena::ZERO {
            return derivative;
        }
        match strikes(&["sign of a derivative turned", "derivative left out"]) {
            None => derivative,
            Some(0) => self.arena.borrow_mut().scale(Number::MINUS_ONE, derivative),
            Some(_) => Arena::ZERO,
        }
    }
}
