//! A work queue with priorities: which piece may run next, where several jobs share a few threads.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Pieces of work that are under way, and how many wait, by rank.
struct Desk {
    working: usize,
    waiting: BTreeMap<usize, usize>,
}

static DESK: Mutex<Desk> = Mutex::new(Desk { working: 0, waiting: BTreeMap::new() });
static CHANGED: Condvar = Condvar::new();

thread_local! {
    /// The rank of the job whose own thread this is, while it works itself.
    static JOB: Cell<Option<(usize, usize)>> = const { Cell::new(None) };
}

fn desk() -> MutexGuard<'static, Desk> {
    DESK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How many pieces are under way, and how many ranks have one that waits.
pub fn at_the_desk() -> (usize, usize) {
    let desk = desk();
    (desk.working, desk.waiting.len())
}

/// Leave to work, given back when it is dropped.
pub struct Turn;

impl Drop for Turn {
    fn drop(&mut self) {
        desk().working -= 1;
        CHANGED.notify_all();
    }
}

/// Waits until fewer than `threads` pieces are under way and nobody of a lesser rank waits.
pub fn take(rank: usize, threads: usize) -> Turn {
    let mut desk = desk();
    *desk.waiting.entry(rank).or_default() += 1;
    let is_next = |desk: &Desk| desk.working < threads && desk.waiting.keys().next().is_none_or(|&first| rank <= first);
    while !is_next(&desk) {
        desk = CHANGED.wait(desk).unwrap_or_else(PoisonError::into_inner);
    }
    if let Some(count) = desk.waiting.get_mut(&rank) {
        *count -= 1;
    }
    desk.waiting.retain(|_, count| *count > 0);
    desk.working += 1;
    // who waits behind this one may be next
    CHANGED.notify_all();
    Turn
}

/// A job on this thread, in its turn.
pub fn job<T>(rank: usize, threads: usize, job: impl FnOnce() -> T) -> T {
    let _turn = take(rank, threads);
    let _own = Own::set(Some((rank, threads)));
    job()
}

/// Pieces of a job, which take turns themselves: they get its rank, and meanwhile its own thread has none.
/// Outside of a job, and in a piece of one, pieces go as they come.
pub fn shared<T>(pieces: impl FnOnce(Option<usize>) -> T) -> T {
    let Some((rank, threads)) = JOB.get() else { return pieces(None) };
    let _own = Own::set(None);
    let _between = Between { rank, threads };
    desk().working -= 1;
    CHANGED.notify_all();
    pieces(Some(rank))
}

/// What [`JOB`] was, set again when this is dropped.
struct Own(Option<(usize, usize)>);

impl Own {
    fn set(now: Option<(usize, usize)>) -> Own {
        Own(JOB.replace(now))
    }
}

impl Drop for Own {
    fn drop(&mut self) {
        JOB.set(self.0);
    }
}

/// The time in which a job's own thread has no turn; it takes one again at the end.
struct Between {
    rank: usize,
    threads: usize,
}

impl Drop for Between {
    fn drop(&mut self) {
        std::mem::forget(take(self.rank, self.threads));
    }
}
