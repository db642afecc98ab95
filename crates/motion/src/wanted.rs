//! The times at which outputs of a motion are wanted, known before the run: a long run is stored around these
//! only.

use std::f64::consts::GOLDEN_RATIO;
use std::sync::Arc;

use crate::band::limits::{INSTANTS, SAMPLES, STRETCHES};
use crate::equidistant::equidistant;

/// How often the rest of a run is halved.
pub const HALVES: i32 = 20;

/// Times from `start` to `end` that no period fits: parts of the golden section.
pub(crate) fn scattered([start, end]: [f64; 2]) -> impl Iterator<Item = f64> {
    (1..=SAMPLES).map(move |i| start + (end - start) * (i as f64 * GOLDEN_RATIO).fract())
}

/// The wanted times of a run between these ends, if outputs are asked for at `times`, ascending.
pub fn wanted(ends: [f64; 2], times: &[f64]) -> Arc<[f64]> {
    let [start, end] = [ends[0], ends[0] + (ends[1] - ends[0])];
    let ends = [start, end];
    let mut all: Vec<f64> = times.iter().copied().chain(scattered(ends)).collect();
    all.extend(STRETCHES.iter().flat_map(|&stretches| equidistant(start, end, stretches + 1)));
    let halves = (0..HALVES).map(|k| start + (end - start) * 0.5_f64.powi(k));
    all.extend(halves.flat_map(|end| equidistant(start + 0.5 * (end - start), end, INSTANTS + 1)));
    all.sort_unstable_by(f64::total_cmp);
    all.dedup();
    all.into()
}

/// The last of `wanted` that is not after `t`.
pub fn kept_before(wanted: &[f64], forwards: bool, t: f64) -> f64 {
    let before = wanted.partition_point(|&w| if forwards { w <= t } else { w < t });
    let place = if forwards { before.checked_sub(1) } else { Some(before) };
    place.and_then(|i| wanted.get(i)).copied().unwrap_or(t)
}
