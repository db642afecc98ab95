//! A work queue with priorities.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use program::priority_queue::{Turn, at_the_desk, job, shared, take};

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
        thread::sleep(Duration::from_millis(10));
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
        while at_the_desk().1 < 4 {
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
    assert_eq!(at_the_desk(), (0, 0), "a panic gives its turn back");
}
