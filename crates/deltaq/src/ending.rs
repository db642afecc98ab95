//! How a motion ended, in the words of its equations.

use equations::{Compiled, Equations};
use integrate::{DenseOutput, Solution, Status, StopCause};

/// How a motion ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At the time asked for.
    Completed,
    /// Earlier, with the time and the cause in words.
    Stopped {
        /// Time reached.
        t: f64,
        /// Cause.
        cause: String,
    },
}

impl Ending {
    /// `completed`, `untrusted` (where there is a complaint) or `stopped`, and why it is not completed.
    pub fn status(&self, complaint: Option<String>) -> (&'static str, Option<String>) {
        match (self, complaint) {
            (Ending::Stopped { t, cause }, _) => ("stopped", Some(format!("stopped at t = {t}: {cause}"))),
            (Ending::Completed, Some(words)) => ("untrusted", Some(words)),
            (Ending::Completed, None) => ("completed", None),
        }
    }

    /// Of one run.
    pub(crate) fn of(equations: &Equations, compiled: &mut Compiled, run: &Solution) -> Ending {
        let Status::Stopped { t, cause } = &run.status else { return Ending::Completed };
        let cause = match cause {
            StopCause::Event { index } => {
                let guard = equations.graph.plain(equations.guards[*index]);
                return Ending::Stopped { t: *t, cause: format!("{guard} vanishes, by which the equations divide") };
            }
            StopCause::NotFinite { component } => {
                let symbol = equations.states.get(*component).map(|y| equations.graph.name(y.symbol));
                format!("{} is no longer finite", symbol.unwrap_or_default())
            }
            StopCause::StepTooSmall { step, .. } => {
                format!("the error asks for steps of {step:.1e}, which no longer move time: a singularity is near")
            }
            other => other.to_string(),
        };
        let near = nearly_zero_guard(equations, compiled, &run.dense);
        Ending::Stopped { t: *t, cause: cause + &near.map_or(String::new(), |words| format!("; {words}")) }
    }

    /// How the kept run ended, unless the looser one stopped while that went on, in a run over this time.
    pub(crate) fn joint(kept: Ending, looser: Ending, [start, end]: [f64; 2]) -> Ending {
        // both stop near the same singularity, or for different causes
        const NEAR: f64 = 1e-3;
        let much_before = |t: f64, later: f64| (later - t) * (end - start).signum() > NEAR * (later - start).abs();
        match (kept, looser) {
            (Ending::Completed, Ending::Stopped { t, cause }) => Ending::unconfirmed(t, &cause),
            (Ending::Stopped { t: later, .. }, Ending::Stopped { t, cause }) if much_before(t, later) => {
                Ending::unconfirmed(t, &cause)
            }
            (ending, _) => ending,
        }
    }

    /// Where only the tighter run goes on, there is no error estimate, and so no motion.
    pub(crate) fn unconfirmed(t: f64, cause: &str) -> Ending {
        Ending::Stopped { t, cause: format!("the run that estimates the error stops here: {cause}") }
    }
}

/// A guard is nearly zero when it is under this fraction of its value at the start.
const NEARLY_ZERO: f64 = 1e-2;

/// The guard that has shrunk most over the run, if it is nearly zero at its end.
fn nearly_zero_guard(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> Option<String> {
    let count = compiled.guards();
    let (mut start, mut end) = (vec![0.0; count], vec![0.0; count]);
    compiled.guard_values(dense.start(), dense.start_state(), &mut start);
    compiled.guard_values(dense.end(), dense.end_state(), &mut end);
    let ratios = start.iter().zip(&end).map(|(a, b)| (b / a).abs());
    let (index, ratio) = ratios.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let guard = equations.graph.plain(equations.guards[index]);
    (ratio < NEARLY_ZERO).then(|| format!("{guard}, by which the equations divide, is down to {:.1e}", end[index]))
}
