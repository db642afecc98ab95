//! Which runs are found to stall.

use integrate::stall_detector::StallDetector;

/// Number of steps after which a run is found to stall, within a million; `step(n, t)` is the length of
/// step n.
fn creeps(end: f64, step: impl Fn(f64, f64) -> f64) -> Option<usize> {
    let (mut pace, mut t) = (StallDetector::new(0.0, end), 0.0);
    (1..1_000_000).find(|&n| {
        t += step(n as f64, t);
        // one attempt in four is rejected
        t.abs() < end.abs() && pace.look(t, [n - n / 4, n, 1_000_000], || false).is_some()
    })
}

#[test]
fn near_a_loss_of_rank_refusals_are_enough() {
    // the falling bicycle: 300 steps to 4 s, then 1e-8 per attempt; one of so many is taken
    let found = |one: usize, near: bool, step: f64| {
        let (mut pace, mut t) = (StallDetector::new(0.0, 20.0), 0.0);
        (1..1_000).find(|&n: &usize| {
            t += if n < 300 { 4.0 / 300.0 } else { step };
            let steps = n.min(300) + n.saturating_sub(300) / one;
            pace.look(t, [steps, n, 1_000_000], || near).is_some()
        })
    };
    assert!(found(8, true, 1e-8).is_some_and(|n| n > 300 && n <= 450), "{:?}", found(8, true, 1e-8));
    assert_eq!([found(8, false, 1e-8), found(2, true, 1e-8), found(8, true, 1e-5)], [None; 3]);
}

#[test]
fn steps_that_shrink_without_end_creep() {
    for direction in [1.0, -1.0] {
        // the falling bicycle: 3e-8 after 2,000 steps, then as 1/n
        let found = creeps(direction * 20.0, |n, _| direction * if n < 1700.0 { 2.4e-3 } else { 6e-5 / n });
        assert!(found.is_some_and(|n| n > 3_000 && n < 6_000), "{found:?}");
        // fast, then at a steady pace that would take 3e8 steps
        let found = creeps(direction * 20.0, |n, _| direction * if n < 700.0 { 2e-3 } else { 6e-8 });
        assert!(found.is_some_and(|n| n > 8_000 && n <= 16_000), "{found:?}");
        // all at once
        let found = creeps(direction * 20.0, |n, _| direction * if n < 100.0 { 0.1 } else { 1e-12 });
        assert!(found.is_some_and(|n| n > 2_000 && n <= 8_000), "{found:?}");
    }
}

#[test]
fn short_steps_and_steps_that_shrink_on_the_way_do_not() {
    // equal steps, even too many; ever faster turns, as g t/k; a layer of 1e-9 that is passed
    assert_eq!(creeps(1.0, |_, _| 1e-6), None);
    assert_eq!(creeps(1.0, |n, _| 1e-8 * (1.0 + 0.1 * n.sin())), None);
    assert_eq!(creeps(1000.0, |_, t| 0.05 / (1.0 + t)), None);
    assert_eq!(creeps(2.0, |_, t| 1e-10 + 1e-2 * (t - 1.0_f64).abs()), None);
}
