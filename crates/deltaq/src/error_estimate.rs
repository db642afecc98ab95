//! The error estimate of a whole motion.

use crate::{Metric, Motion, Setting, SolveError};

/// Instants at which it is taken.
const SAMPLES: usize = 200;

/// Relative error estimate over which a motion is not trusted.
pub const TRUSTED: f64 = 1e-3;

/// Largest difference of the two runs of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// In the kinetic metric.
    pub absolute: f64,
    /// Over the largest distance from the start, where there is one.
    pub relative: f64,
}

impl ErrorEstimate {
    /// This difference in a motion that goes so far from its start.
    pub(crate) fn over(scale: f64, absolute: f64) -> Self {
        ErrorEstimate { absolute, relative: if scale > 0.0 { absolute / scale } else { absolute } }
    }

    /// Why a motion with this estimate is not to be trusted: it is over [`TRUSTED`], or no number.
    pub fn complaint(&self) -> Option<String> {
        let trusted = self.relative <= TRUSTED;
        (!trusted)
            .then(|| format!("not to be trusted: relative error estimate {:.1e}, limit {TRUSTED:.0e}", self.relative))
    }
}

/// The error estimate of `motion`, which started at `setting`, at 200 equidistant times.
///
/// # Errors
/// [`SolveError`] where the motion cannot be read off.
pub fn error_estimate(motion: &mut Motion, setting: Setting) -> Result<ErrorEstimate, SolveError> {
    let mut metric = Metric::new(setting.system)?;
    let (mut absolute, mut scale) = (0.0_f64, 0.0_f64);
    for t in motion.grid(SAMPLES) {
        let (now, difference) = motion.at_with_difference(t)?;
        let (q, v) = (&now.coordinates, &now.velocities);
        absolute = absolute.max(metric.length(t, q, v, &difference));
        scale = scale.max(metric.distance(t, q, v, &setting.start.q));
    }
    Ok(ErrorEstimate::over(scale, absolute))
}
