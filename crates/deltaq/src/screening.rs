//! Many values of the free constants at once: which of them bring a motion closer to another one.

use crate::fit::Differences;
use crate::{Ensemble, EnsembleOptions};

/// Parts of a motion after which a value is given up, if its gap is too large there; then the whole.
const PARTS: [f64; 3] = [0.2, 0.5, 1.0];

/// Values that are looked at together: as many as share vector lanes a few times over.
const TOGETHER: usize = 32;

/// Members of an ensemble take this many times less than motions one by one.
const FASTER: usize = 4;

/// A family of motions as an ensemble over its free constants, one name per constant.
pub(crate) struct Screening {
    ensemble: Ensemble,
}

impl Screening {
    pub(crate) fn new(ensemble: Ensemble) -> Self {
        Screening { ensemble: ensemble.only_complete() }
    }

    /// The values among the first [`TOGETHER`] whose largest gap at every `stride`-th instant is under
    /// `bound`, with that gap; and how many were looked at.
    pub(crate) fn under(
        &self,
        differences: &mut Differences,
        values: &[Vec<f64>],
        bound: f64,
        stride: usize,
    ) -> (Vec<(Vec<f64>, f64)>, usize) {
        let looked_at = values.len().min(TOGETHER);
        let mut left: Vec<(Vec<f64>, f64)> = values[..looked_at].iter().map(|value| (value.clone(), 0.0)).collect();
        let options = EnsembleOptions { threads: 1, estimate: false };
        for part in PARTS {
            let (end, times) = differences.times(part, stride);
            let ensemble = self.ensemble.clone().until(end).at_most(differences.max_steps());
            let rows: Vec<&[f64]> = left.iter().map(|(value, _)| &value[..]).collect();
            let motions = ensemble.answers(ensemble.members(&rows, 1), &times, &options);
            for ((_, gap), motion) in left.iter_mut().zip(motions) {
                *gap = f64::INFINITY;
                if let Ok(motion) = motion
                    && motion.outputs.len() == times.len()
                {
                    let done = motion.run.work;
                    differences.did((done.steps + done.rejected) / FASTER, times.len() / FASTER);
                    *gap = differences.gap_of(motion.outputs.iter().map(|now| &now.coordinates[..]), stride);
                }
            }
            left.retain(|(_, gap)| *gap < bound);
        }
        (left, looked_at)
    }
}
