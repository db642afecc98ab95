//! The times at which outputs of a motion are wanted, known before the run: a long run is stored around these
//! only.

use std::sync::Arc;

/// Stretches of the whole run at whose ends everything that looks along a motion may look.
const STRETCHES: [usize; 3] = [200, 32, 4];
/// Number of times at unequal distances, which no period fits.
const SCATTERED: usize = 200;
/// A run may end early: number of stretches in its second half, in the second half of the rest, and so on,
/// `HALVES` times.
const OF_A_HALF: usize = 64;
const HALVES: i32 = 20;

/// `stretches + 1` equidistant times from `start` to `end`.
pub(crate) fn equidistant([start, end]: [f64; 2], stretches: usize) -> impl Iterator<Item = f64> {
    (0..=stretches).map(move |i| start + (end - start) * i as f64 / stretches as f64)
}

/// Times from `start` to `end` that no period fits: parts of the golden section.
pub(crate) fn scattered([start, end]: [f64; 2]) -> impl Iterator<Item = f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    (1..=SCATTERED).map(move |i| start + (end - start) * (i as f64 * GOLDEN).fract())
}

/// The wanted times of a run between these ends, if outputs are asked for at `times`, ascending.
pub(crate) fn wanted(ends: [f64; 2], times: &[f64]) -> Arc<[f64]> {
    let [start, end] = [ends[0], ends[0] + (ends[1] - ends[0])];
    let ends = [start, end];
    let mut all: Vec<f64> = times.iter().copied().chain(scattered(ends)).collect();
    all.extend(STRETCHES.iter().flat_map(|&stretches| equidistant(ends, stretches)));
    let halves = (0..HALVES).map(|k| start + (end - start) * 0.5_f64.powi(k));
    all.extend(halves.flat_map(|end| equidistant([start + 0.5 * (end - start), end], OF_A_HALF)));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all.into()
}

/// The last of `wanted` that is not after `t`.
pub(crate) fn kept_before(wanted: &[f64], forwards: bool, t: f64) -> f64 {
    let before = wanted.partition_point(|&w| if forwards { w <= t } else { w < t });
    let place = if forwards { before.checked_sub(1) } else { Some(before) };
    place.and_then(|i| wanted.get(i)).copied().unwrap_or(t)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for (forwards, t, known) in [
            (true, 2.5, 2.0),
            (true, 2.0, 2.0),
            (false, 2.5, 3.0),
            (false, 2.0, 2.0),
            (true, 0.5, 0.5),
            (false, 3.5, 3.5),
        ] {
            assert_eq!(kept_before(&wanted, forwards, t), known, "{forwards}, {t}");
        }
    }
}
