//! Work on many items over threads.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Gives the next item that no thread has taken yet.
pub(super) type Take<'a> = &'a dyn Fn() -> Option<usize>;

/// `work` on this thread and, where there are more items than a `group`, on others beside it, `threads` in all (0: as many as there are processors). Each takes
/// items `0..count` as it gets to them; what came of them is in their order, `None` of those that came to nothing.
pub(super) fn over_threads<T: Send>(
    threads: usize,
    count: usize,
    group: usize,
    work: impl Fn(Take) -> Vec<(usize, T)> + Sync,
) -> Vec<Option<T>> {
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    };
    let next = AtomicUsize::new(0);
    let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&index| index < count);
    let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
    let mut put = |done: Vec<(usize, T)>| done.into_iter().for_each(|(index, value)| results[index] = Some(value));
    std::thread::scope(|scope| {
        let others = threads.min(count.div_ceil(group)).saturating_sub(1);
        let others: Vec<_> = (0..others).map(|_| scope.spawn(|| work(&take))).collect();
        put(work(&take));
        for other in others {
            put(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
    });
    results
}
