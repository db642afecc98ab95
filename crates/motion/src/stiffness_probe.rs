//! Detects from a run that its method does not suit the motion.

use integrate::stall_detector::STRETCH;
use integrate::{Method, Options, Status, StopCause};

use crate::{Prepared, SingleRun};

/// Upper bound on the cost of a step of [`Method::Radau5`] over that of others.
pub(crate) const FARTHER: f64 = 10.0;

/// Why a method does not suit a motion.
pub(crate) enum NotSuited {
    /// It is not smooth.
    NotSmooth,
    /// The rest needs too many steps; `stiff` if an implicit method needs far fewer.
    Slow { stiff: bool },
}

/// Whether the method of `kept` does not suit the motion, as the [`Options::patience`] of the run has it.
pub(crate) fn not_suited(here: &Prepared, kept: &SingleRun, end: f64, options: &Options) -> Option<NotSuited> {
    let Status::Stopped { t, cause } = &kept.solution.status else { return None };
    match cause {
        StopCause::NotSmooth { .. } if options.method == Method::Taylor => Some(NotSuited::NotSmooth),
        StopCause::Slow { moved, .. } => {
            let (max_steps, patience) = (options.max_steps.min(STRETCH), f64::INFINITY);
            let implicit = Options { method: Method::Radau5, max_steps, patience, before: None, ..options.clone() };
            let mut there = here.clone();
            there.go_on([kept, kept]);
            let trial = there.integrate(end, &implicit);
            Some(NotSuited::Slow { stiff: trial.is_ok_and(|trial| (trial.end() - t).abs() >= FARTHER * moved) })
        }
        _ => None,
    }
}
