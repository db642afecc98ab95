//! Long work ends when it is no longer wanted, or has had its time.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Says whether the work under way is still wanted.
type Asked = Rc<dyn Fn() -> bool>;

thread_local! {
    /// Of the work of this thread, that which is within the others last.
    static UNWANTED: RefCell<Vec<Asked>> = const { RefCell::new(Vec::new()) };
}

/// What the stack is unwound with: which of the pieces of work within each other is not wanted.
pub(crate) struct Cancelled(usize);

/// Does `work` on this thread until `is_unwanted` says so: `None` then. It is asked at every 256th
/// expression that is made, or found to be there, and wherever [`go_on`] is called. The graphs that the work
/// has built on are whole, with more expressions than before. Such work may be part of other such work, which
/// may end it as well.
///
/// ```
/// let graph = symbolic::Graph::new();
/// let x = graph.variable(graph.symbol("x"));
/// let grow = || (1..10_000).fold(x, |e, i| graph.add(graph.mul(e, e), graph.integer(i)));
/// assert!(symbolic::cancellable(|| true, grow).is_none());
/// assert!(symbolic::cancellable(|| false, grow).is_some());
/// assert!(symbolic::cancellable(|| true, || symbolic::cancellable(|| false, grow).is_some()).is_none());
/// ```
pub fn cancellable<T>(is_unwanted: impl Fn() -> bool + 'static, work: impl FnOnce() -> T) -> Option<T> {
    let depth = UNWANTED.with_borrow_mut(|all| {
        all.push(Rc::new(is_unwanted));
        all.len() - 1
    });
    let done = catch_unwind(AssertUnwindSafe(work));
    UNWANTED.with_borrow_mut(|all| all.truncate(depth));
    let is_own = |cause: Box<dyn Any + Send>| match cause.downcast::<Cancelled>() {
        Ok(cancelled) if cancelled.0 == depth => None,
        Ok(of_others) => resume_unwind(of_others),
        Err(panic) => resume_unwind(panic),
    };
    done.map_or_else(is_own, Some)
}

/// Milliseconds that a question may take; 0 where there is no bound.
static PATIENCE: AtomicU64 = AtomicU64::new(0);

/// A question was left after this time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
#[error("stopped after {} s; --patience gives it more", .0.as_secs_f64())]
pub struct Stopped(pub Duration);

/// Bounds the time of every [`question`] of this process from now on; at first there is no bound.
pub fn be_patient(bound: Option<Duration>) {
    let milliseconds = bound.map_or(0, |bound| u64::try_from(bound.as_millis()).unwrap_or(u64::MAX).max(1));
    PATIENCE.store(milliseconds, Ordering::Relaxed);
}

/// Answers a question of algebra, which may take more time than there is.
///
/// # Errors
/// [`Stopped`] where it takes longer than [`be_patient`] allows.
pub fn question<T>(work: impl FnOnce() -> T) -> Result<T, Stopped> {
    match PATIENCE.load(Ordering::Relaxed) {
        0 => Ok(work()),
        milliseconds => {
            let (began, bound) = (Instant::now(), Duration::from_millis(milliseconds));
            cancellable(move || began.elapsed() > bound, work).ok_or(Stopped(bound))
        }
    }
}

/// Number of expressions between two checks for cancellation.
pub(crate) const EVERY: u32 = 256;

/// Leaves the work of this thread if it is no longer wanted; to be called now and then by work that makes no
/// expressions. Costs some 50 ns.
pub fn go_on() {
    let count = UNWANTED.with_borrow(Vec::len);
    for depth in 0..count {
        let asked = UNWANTED.with_borrow(|all| all[depth].clone());
        if asked() {
            resume_unwind(Box::new(Cancelled(depth)));
        }
    }
}
