//! Work on many items over threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use symbolic::{caught, work_on, worked_on};

/// Gives the next item that no thread has taken yet.
pub(super) type Take<'a> = &'a dyn Fn() -> Option<usize>;

/// That many threads; 0: as many as there are processors.
pub fn number_of_threads(threads: usize) -> usize {
    match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    }
}

/// Work queue: `work` on this thread and, for more items than a `group`, on others, `threads` in all (0: one
/// per processor). Results keep the order of the items `0..count`, `None` where an item gave none.
pub(super) fn shared<T: Send>(
    threads: usize,
    count: usize,
    group: usize,
    work: impl Fn(Take) -> Vec<(usize, T)> + Sync,
) -> Vec<Option<T>> {
    let threads = number_of_threads(threads);
    let next = AtomicUsize::new(0);
    let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&index| index < count);
    let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
    let mut put = |done: Vec<(usize, T)>| done.into_iter().for_each(|(index, value)| results[index] = Some(value));
    let about = worked_on();
    let other = || {
        work_on(about.clone());
        caught("thread", || work(&take))
    };
    std::thread::scope(|scope| {
        let others = threads.min(count.div_ceil(group)).saturating_sub(1);
        let others: Vec<_> = (0..others).map(|_| scope.spawn(other)).collect();
        put(work(&take));
        for other in others {
            let done = other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            put(done.unwrap_or_else(|broken| broken.hand_on()));
        }
    });
    results
}

/// `work` of each of `0..count`, over this many threads (0: as many as there are processors), in their order.
///
/// ```
/// assert_eq!(motion::over_threads(2, 5, |i| i * i), [0, 1, 4, 9, 16]);
/// ```
pub fn over_threads<T: Send>(threads: usize, count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let all = shared(threads, count, 1, |take| std::iter::from_fn(take).map(|index| (index, work(index))).collect());
    all.into_iter().flatten().collect()
}
