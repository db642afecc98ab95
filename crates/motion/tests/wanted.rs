//! Times at which outputs of a motion are wanted.

use motion::parts::{HALVES, STRETCHES, kept_before, wanted};

/// From 2 to 6, or back: nothing outside, what is asked for, and of each half 65 times.
#[test]
fn what_is_wanted_lies_within_the_run_and_within_what_may_be_left_of_it() {
    for [start, end] in [[2.0, 6.0], [6.0, 2.0]] {
        let all = wanted([start, end], &[2.123, 5.9]);
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!((all[0], all[all.len() - 1]), (2.0, 6.0));
        let has = |t: f64| all.iter().any(|&w| (w - t).abs() < 1e-12);
        assert!(has(2.123) && has(5.9));
        for part in (0..HALVES).map(|k| 0.5_f64.powi(k)) {
            let (half, whole) = (start + 0.5 * part * (end - start), start + part * (end - start));
            assert!((0..=64).all(|i| has(half + (whole - half) * f64::from(i) / 64.0)), "{start}, {part}");
        }
        for stretches in STRETCHES {
            assert!((0..=stretches).all(|i| has(start + (end - start) * i as f64 / stretches as f64)));
        }
    }
}

#[test]
fn the_last_before_a_time_is_that_in_the_direction_of_time() {
    let wanted = [1.0, 2.0, 3.0];
    for (forwards, t, known) in
        [(true, 2.5, 2.0), (true, 2.0, 2.0), (false, 2.5, 3.0), (false, 2.0, 2.0), (true, 0.5, 0.5), (false, 3.5, 3.5)]
    {
        assert_eq!(kept_before(&wanted, forwards, t), known, "{forwards}, {t}");
    }
}
