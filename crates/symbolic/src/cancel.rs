//! Long derivations end when they are no longer wanted.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;

/// Says whether the work under way is still wanted.
type Asked = Rc<dyn Fn() -> bool>;

thread_local! {
    static UNWANTED: RefCell<Option<Asked>> = const { RefCell::new(None) };
}

/// What the stack is unwound with.
pub(crate) struct Cancelled;

/// Does `work` on this thread until `is_unwanted` says so: `None` then. It is asked at every 256th new
/// expression. The graphs that the work has built on are whole, with more expressions than before.
///
/// ```
/// let graph = symbolic::Graph::new();
/// let x = graph.variable(graph.symbol("x"));
/// let grow = || (1..10_000).fold(x, |e, i| graph.add(graph.mul(e, e), graph.integer(i)));
/// assert!(symbolic::cancellable(|| true, grow).is_none());
/// assert!(symbolic::cancellable(|| false, grow).is_some());
/// ```
pub fn cancellable<T>(is_unwanted: impl Fn() -> bool + 'static, work: impl FnOnce() -> T) -> Option<T> {
    let before = UNWANTED.replace(Some(Rc::new(is_unwanted)));
    let done = catch_unwind(AssertUnwindSafe(work));
    UNWANTED.set(before);
    let is_cancelled = |cause: Box<dyn Any + Send>| match cause.downcast::<Cancelled>() {
        Ok(_) => None,
        Err(panic) => resume_unwind(panic),
    };
    done.map_or_else(is_cancelled, Some)
}

/// Number of new expressions between two checks for cancellation.
pub(crate) const EVERY: usize = 256;

/// Leaves the work of this thread if it is no longer wanted.
pub(crate) fn check() {
    let asked = UNWANTED.with_borrow(Clone::clone);
    if asked.is_some_and(|is_unwanted| is_unwanted()) {
        resume_unwind(Box::new(Cancelled));
    }
}
