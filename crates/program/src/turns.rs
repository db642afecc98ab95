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

/// Leave to work, given back when it is dropped.
pub(crate) struct Turn;

impl Drop for Turn {
    fn drop(&mut self) {
        desk().working -= 1;
        CHANGED.notify_all();
    }
}

/// Waits until fewer than `threads` pieces are under way and nobody of a lesser rank waits.
pub(crate) fn take(rank: usize, threads: usize) -> Turn {
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
pub(crate) fn job<T>(rank: usize, threads: usize, job: impl FnOnce() -> T) -> T {
    let _turn = take(rank, threads);
    let _own = Own::set(Some((rank, threads)));
    job()
}

/// Pieces of a job, which take turns themselves: they get its rank, and meanwhile its own thread has none.
/// Outside of a job, and in a piece of one, pieces go as they come.
pub(crate) fn shared<T>(pieces: impl FnOnce(Option<usize>) -> T) -> T {
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

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread;
    use std::time::{Duration, Instant};

    use super::*;

    const THREADS: usize = 3;
    /// Time limit for the pieces to reach that number.
    const PATIENCE: Duration = Duration::from_secs(1);

    /// One test, because the queue is global: jobs with pieces, one of which panics.
    #[test]
    fn no_more_work_at_once_than_there_are_threads_and_the_least_rank_goes_first() {
        let (now, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let order = Mutex::new(Vec::new());
        let piece = |rank: usize| {
            let _turn = take(rank, THREADS);
            most.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
            order.lock().expect("no panic").push(rank);
            // the first ones wait for each other: on a busy machine they may come one by one
            let begun = Instant::now();
            while most.load(Ordering::SeqCst) < THREADS && begun.elapsed() < PATIENCE {
                thread::yield_now();
            }
            thread::sleep(Duration::from_millis(2));
            now.fetch_sub(1, Ordering::SeqCst);
        };
        let work = |rank: usize| {
            job(rank, THREADS, || {
                shared(|turn| {
                    let turn = turn.expect("a job");
                    thread::scope(|scope| (0..40).for_each(|_| drop(scope.spawn(|| piece(turn)))));
                });
                assert!(shared(|turn| turn.is_some()), "its own thread is at work again");
                rank
            })
        };
        let held: Vec<Turn> = (0..THREADS).map(|_| take(0, THREADS)).collect();
        let work = &work;
        let done: Vec<usize> = thread::scope(|scope| {
            let jobs: Vec<_> = [5, 2, 7].into_iter().map(|rank| scope.spawn(move || work(rank))).collect();
            let failed = scope.spawn(|| job::<()>(9, THREADS, || panic!("on purpose")));
            while desk().waiting.len() < 4 {
                thread::yield_now();
            }
            drop(held);
            assert!(failed.join().is_err());
            jobs.into_iter().map(|own| own.join().expect("no panic")).collect()
        });
        assert_eq!(done, [5, 2, 7]);
        assert_eq!(most.into_inner(), THREADS);
        let order = order.into_inner().expect("no panic");
        let last = |rank: usize| order.iter().rposition(|&r| r == rank).expect("its pieces");
        assert_eq!(order.len(), 120);
        assert!(last(2) < last(5) && last(5) < last(7), "{order:?}");
        assert!(desk().working == 0 && desk().waiting.is_empty(), "a panic gives its turn back");
    }
}
