//! Is the control flagged where it is wrong, and only there? Judged by Maggi's equations: their residual on
//! the control's motion, and their own motion beside it. They share nothing with what flags it.

use comparison::Gap;
use motion::{CERTAINTY, Metric, Motion, Setting, SolveError};
use referees::maggi::{self, Maggi, MaggiError};
use symbolic::limits::SAME;

use crate::Word;

/// Fractions of the run at which the control's equations are put to the test.
const PLACES: [f64; 5] = [0.05, 0.2, 0.45, 0.7, 0.95];

/// Distances of the differences, in parts of the run: the lesser error counts, round-off of near ones or, in
/// a switch, that of far ones.
const DISTANCES: [f64; 2] = [1e-3, 1e-4];

/// Over `SAME` of Maggi's residual the control's motion is wrong, under `RIGHT` right. Between them, and of
/// what is flagged, Maggi's own motion decides.
const RIGHT: f64 = 1e-12;

/// Tolerances of the two runs of Maggi's equations.
const TOLERANCES: [f64; 2] = [1e-10, 1e-12];

/// Why nothing could be judged.
#[derive(Debug, thiserror::Error)]
pub enum Unjudged {
    /// A motion could not be read off.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Maggi's equations have no motion.
    #[error("Maggi's equations: {0}")]
    Maggi(#[from] MaggiError),
}

/// What Maggi's equations say of the control's motion, and of whether it was flagged.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundOut {
    /// Their largest relative residual on the control's motion.
    pub residual: f64,
    /// Whether it was flagged: certainly another motion than Chetaev's.
    pub flagged: bool,
    /// Whether it is flagged if it is wrong, and not if it is right; `None` where neither is certain.
    pub word: Option<Word>,
    /// The figures.
    pub note: String,
}

impl FoundOut {
    /// Whether the control is right by its residual, which is round-off.
    pub fn is_right(&self) -> bool {
        self.residual < RIGHT
    }

    /// Whether the control is wrong by its residual.
    pub fn is_wrong(&self) -> bool {
        self.residual > SAME
    }
}

/// Chetaev's motion by Maggi's equations, at two tolerances, the sharper one last.
///
/// # Errors
/// [`MaggiError`] where it cannot be started.
pub fn referee(setting: Setting) -> Result<[maggi::Motion; 2], MaggiError> {
    Maggi::new(setting.system)?.solve_twice(setting.start, setting.end, TOLERANCES)
}

/// Judges the `control`'s motion, whose `gap` to Chetaev's was found, by the motions of the [`referee`]; gaps
/// under `floor` are none.
///
/// # Errors
/// [`Unjudged`].
pub fn found_out(
    setting: Setting,
    control: &mut Motion,
    gap: &Gap,
    referee: &mut [maggi::Motion; 2],
    metric: &mut Metric,
    floor: f64,
) -> Result<FoundOut, Unjudged> {
    let residual = residual(setting, control)?;
    let flagged = gap.certain_from.is_some();
    let [looser, kept] = referee;
    let last = kept.end().min(looser.end());
    // Maggi's motion is another one than the control's; by enough that it had to be flagged; and it is not
    // another one where it is flagged, though that would be seen
    let (mut apart, mut missed, mut unfounded) = (false, false, false);
    let mut error = 0.0_f64;
    for p in gap.points.iter().filter(|p| p.t <= last) {
        let (own, differs) = (control.at(p.t)?, control.difference_of_runs(p.t)?);
        let (one, two) = (kept.state(p.t)?, looser.state(p.t)?);
        let errors = metric.length(p.t, &own.coordinates, &own.velocities, &differs)
            + metric.distance(p.t, &one.q, &one.v, &two.q);
        error = error.max(errors);
        let limit = CERTAINTY * error + floor;
        let distance = metric.distance(p.t, &own.coordinates, &own.velocities, &one.q);
        apart |= distance > limit;
        missed |= distance - limit > p.limit;
        unfounded |= distance <= limit && p.gap - p.limit > limit;
    }
    let found = FoundOut { residual, flagged, word: None, note: String::new() };
    let word = match (flagged, apart) {
        (flagged, _) if found.is_right() => Some(if flagged { Word::Fails } else { Word::Holds }),
        (true, true) => Some(Word::Holds),
        (true, false) if unfounded => Some(Word::Fails),
        (true, false) if found.is_wrong() => Some(Word::Holds),
        (false, _) if missed => Some(Word::Fails),
        _ if flagged || apart || found.is_wrong() => Some(Word::Undecided),
        _ => None,
    };
    let note = format!("residual {residual:.1e}, gap {:.1e}", gap.largest);
    Ok(FoundOut { word, note, ..found })
}

/// Largest relative residual of Maggi's equations on a motion, accelerations by differences.
fn residual(setting: Setting, motion: &mut Motion) -> Result<f64, Unjudged> {
    let mut maggi = Maggi::new(setting.system)?;
    let (start, duration) = (motion.start(), motion.end() - motion.start());
    let mut worst = 0.0_f64;
    for place in PLACES {
        let mut least = f64::INFINITY;
        for h in DISTANCES.map(|h| h * duration) {
            let t = start + place * duration;
            let mut velocity = |t: f64| motion.at(t).map(|o| o.velocities);
            let (a, b, c, d) = (velocity(t - 2.0 * h)?, velocity(t - h)?, velocity(t + h)?, velocity(t + 2.0 * h)?);
            let derivative = |i: usize| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
            let acceleration: Vec<f64> = (0..a.len()).map(derivative).collect();
            let now = motion.at(t)?;
            least = least.min(maggi.residual(t, &now.coordinates, &now.velocities, &acceleration)?.largest());
        }
        worst = worst.max(least);
    }
    Ok(worst)
}
