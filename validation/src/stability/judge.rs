//! The word for a motion, given what it should have been.

use equations::Outputs;
use motion::band::SAMPLES;
use motion::{CERTAINTY, Ending, Metric, Motion, SolveError, TRUSTED};
use serde::Serialize;
use symbolic::limits::LAST_DIGITS;

use super::Known;

/// Relative error that is passed over whatever the estimate says.
pub const FLOOR: f64 = 1e-7;

/// What became of a cell. Errors and estimates are relative to the distance from the start.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "verdict", rename_all = "lowercase")]
pub enum Verdict {
    /// Complete, right, and known to be.
    Accurate {
        /// True error.
        error: f64,
        /// The motion's own estimate.
        estimate: f64,
    },
    /// Complete, with an estimate that is over the limit of trust and not too small.
    Admitted {
        /// True error.
        error: f64,
        /// The motion's own estimate.
        estimate: f64,
    },
    /// No motion, or one that stopped, right as far as it goes.
    Refused {
        /// Where it stopped; `None` where it was not started.
        t: Option<f64>,
        /// Why.
        cause: String,
    },
    /// An error without a warning.
    Wrong {
        /// True error.
        error: f64,
        /// The motion's own estimate at the same time.
        estimate: f64,
        /// Where this was first seen.
        t: f64,
    },
}

impl Verdict {
    /// One word.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Accurate { .. } => "accurate",
            Verdict::Admitted { .. } => "admitted",
            Verdict::Refused { .. } => "refused",
            Verdict::Wrong { .. } => "wrong",
        }
    }

    /// Which is worse; of two that are as bad, the one with the larger error.
    fn badness(&self) -> (u8, f64) {
        match *self {
            Verdict::Accurate { error, .. } => (0, error),
            Verdict::Refused { .. } => (0, 0.0),
            Verdict::Admitted { error, .. } => (1, error),
            Verdict::Wrong { error, .. } => (2, error),
        }
    }
}

/// Part of the run for the first errors: a step of length 10⁻⁶ has no distance of its own worth the name.
const FIRST_PART: f64 = 0.1;

/// The reference at one time; lengths in the kinetic metric, or of one coordinate or multiplier.
struct Sample {
    t: f64,
    error: f64,
    uncertainty: f64,
    difference: f64,
    doubted: bool,
    distance: f64,
}

/// The requirements on a motion.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// Relative errors under this are passed over.
    pub floor: f64,
    /// So are errors under this part of the whole way, the tolerance asked for: of a motion that hardly
    /// begins nobody asks for more.
    pub asked: f64,
    /// Time up to which the motion was asked for. One that stops before goes as far as its way up to there
    /// in proportion, but for [`TRUSTED`] of its own way at most: tolerances are parts of sizes that states
    /// have within the whole run.
    pub end: f64,
    /// Number of coordinates that are compared, from the first on.
    pub compared: usize,
    /// Each coordinate and multiplier is judged by its own estimate, and the worst of them is the verdict;
    /// else all coordinates at once in the kinetic metric.
    pub each: bool,
}

/// Judges a motion by what is known, which has to reach as far.
///
/// # Errors
/// [`SolveError`] where the motion cannot be read off before its end: refused, for `Question::judged`.
pub fn judge(
    motion: &mut Motion,
    metric: &mut Metric,
    known: &mut Known,
    allowance: Allowance,
) -> Result<Verdict, SolveError> {
    let values = |outputs: &Outputs| [&outputs.coordinates[..], &outputs.multipliers].concat();
    let start = values(&motion.at(motion.start())?);
    let mut samples = vec![Vec::with_capacity(SAMPLES + 1)];
    for t in motion.grid(SAMPLES) {
        let (kept, looser) = motion.at_in_both_runs(t)?;
        let Some((truth, second)) = known(t) else { continue };
        let (q, now, other) = (&kept.coordinates, values(&kept), values(&looser));
        samples.resize_with(if allowance.each { truth.len() } else { 1 }, Vec::new);
        for (i, samples) in samples.iter_mut().enumerate() {
            let mut length = |a: &[f64], b: &[f64]| {
                if allowance.each {
                    return (a[i] - b[i]).abs();
                }
                let compared = allowance.compared.min(q.len());
                let mut difference: Vec<f64> = a.iter().zip(b).take(compared).map(|(a, b)| a - b).collect();
                difference.resize(q.len(), 0.0);
                metric.length(t, q, &kept.velocities, &difference)
            };
            samples.push(Sample {
                t,
                error: length(&now, &truth),
                uncertainty: length(&truth, &second) + LAST_DIGITS * length(&truth, &vec![0.0; truth.len()]),
                difference: length(&now, &other),
                doubted: motion.is_doubted(t),
                distance: length(&now, &start),
            });
        }
    }
    let doubt = motion.doubt.as_ref().map(|doubt| &doubt.because[..]);
    let reached = (motion.end() - motion.start()) / (allowance.end - motion.start());
    let asked = allowance.asked / reached.clamp(f64::MIN_POSITIVE, 1.0);
    let allowance = Allowance { asked: asked.min(TRUSTED.max(allowance.asked)), ..allowance };
    let word = |samples: &Vec<Sample>| verdict(samples, &motion.ending, doubt, allowance);
    let worse = |a: Verdict, b: Verdict| if b.badness() > a.badness() { b } else { a };
    Ok(samples[1..].iter().map(word).fold(word(&samples[0]), worse))
}

fn verdict(samples: &[Sample], ending: &Ending, doubt: Option<&str>, allowance: Allowance) -> Verdict {
    let Allowance { floor, asked, .. } = allowance;
    let whole = samples.iter().fold(0.0, |whole, sample| worst(whole, sample.distance));
    let first = (samples.len() as f64 * FIRST_PART) as usize;
    let mut scale = samples[..first].iter().fold(0.0, |scale, sample| worst(scale, sample.distance));
    let (mut largest, mut estimate) = (0.0_f64, 0.0_f64);
    for sample in samples {
        estimate = worst(estimate, sample.difference);
        scale = worst(scale, sample.distance);
        let claimed = CERTAINTY * estimate;
        // an estimate as large as the motion itself claims nothing, nor does one that says so
        let bounded = !sample.doubted && (claimed < scale || scale == 0.0);
        let allowed = claimed.max(floor * scale).max(asked * whole) + sample.uncertainty;
        let relative = |x: f64| if scale > 0.0 { x / scale } else { x };
        let off = sample.error > allowed || sample.error.is_nan() || allowed.is_nan();
        if (bounded && off) || scale.is_nan() || estimate.is_nan() {
            return Verdict::Wrong { error: relative(sample.error), estimate: relative(estimate), t: sample.t };
        }
        largest = largest.max(relative(sample.error));
    }
    let estimate = if scale > 0.0 { estimate / scale } else { estimate };
    match ending {
        Ending::Stopped { t, cause } => {
            let cause = doubt.map_or(cause.clone(), |doubt| format!("{cause}; {doubt}"));
            Verdict::Refused { t: Some(*t), cause }
        }
        Ending::Completed if estimate <= TRUSTED && doubt.is_none() => Verdict::Accurate { error: largest, estimate },
        Ending::Completed => Verdict::Admitted { error: largest, estimate },
    }
}

/// The larger of the two, NaN if one is.
fn worst(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
