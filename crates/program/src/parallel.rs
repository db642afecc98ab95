//! Independent pieces of work on all processors, or on the number of threads given by `--threads`.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use crate::priority_queue;

/// Where bars are drawn, each on a line of its own.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// A progress bar over `length` pieces, drawn on a terminal unless `quiet`.
pub fn progress(length: usize, quiet: bool) -> ProgressBar {
    let bar = if quiet { ProgressBar::hidden() } else { BARS.add(ProgressBar::new(length as u64)) };
    let style = ProgressStyle::with_template("{bar:32} {pos}/{len} {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// A spinner with the current task and its time, drawn on a terminal unless `quiet`.
pub fn spinner(quiet: bool) -> ProgressBar {
    let line = if quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed}");
    line.with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
}

/// 0: one per processor.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// How many threads all further work of this program has; 0: one per processor. No result depends on it.
pub fn use_threads(threads: usize) {
    THREADS.store(threads, Ordering::Relaxed);
}

/// How many threads there are for work: never 0.
pub fn threads() -> usize {
    motion::number_of_threads(THREADS.load(Ordering::Relaxed))
}

/// `work` of each item, over all processors, results in the order of the items. Within [`in_turn`] the items
/// of several jobs share the threads.
pub fn map<I: Sync, T: Send>(items: &[I], work: impl Fn(&I) -> T + Sync) -> Vec<T> {
    priority_queue::shared(|turn| {
        motion::over_threads(threads(), items.len(), |index| {
            let _taken = turn.map(|rank| priority_queue::take(rank, threads()));
            work(&items[index])
        })
    })
}

/// A job beside others, each on a thread of its own: no more of them work at once than there are threads,
/// and where several wait for one, the least `rank` goes first. So no thread is idle while a job ends.
pub fn in_turn<T>(rank: usize, job: impl FnOnce() -> T) -> T {
    priority_queue::job(rank, threads(), job)
}

/// `work` of each item as [`map`] does it, with a progress bar for the current ones; the first failure.
///
/// # Errors
/// That of the first item whose work failed.
pub fn try_map<I: Sync, T: Send, E: Send>(
    items: &[I],
    quiet: bool,
    name: impl Fn(&I) -> String + Sync,
    work: impl Fn(&I) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let bar = progress(items.len(), quiet);
    let results = map(items, |item| {
        bar.set_message(name(item));
        let result = work(item);
        bar.inc(1);
        result
    });
    bar.finish_and_clear();
    results.into_iter().collect()
}
