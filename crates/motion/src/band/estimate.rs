//! The error estimate of a motion up to an instant: what its band says, for its user.

use super::limits::{SAMPLES, SOME, TRUSTED};
use super::{Band, Known, NoInformation};
use crate::wanted::scattered;
use crate::{Metric, Motion, Setting, SolveError};

/// Largest differences of the two runs of a motion up to some instant. Where round-off of the rates, which
/// both runs share, exceeds their difference, the looser run is made with that round-off added to its rates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorEstimate {
    /// In the kinetic metric.
    pub absolute: f64,
    /// The same over the largest distance from the start; as it is where the motion stays at the start.
    pub relative: f64,
    /// For each coordinate, in its unit; length n. The kinetic metric hides coordinates with little inertia.
    pub coordinates: Vec<f64>,
    /// For each velocity, in its unit.
    pub velocities: Vec<f64>,
    /// For each multiplier, in its unit, with the round-off of the sum of terms behind it if this exceeds its
    /// last digits.
    pub multipliers: Vec<f64>,
    /// The coordinate with the largest difference over its own size, which is the largest value that it has
    /// or has moved by, and that quotient; `None` if all differences are round-off.
    pub worst: Option<(String, f64)>,
    /// The same for multipliers.
    pub worst_multiplier: Option<(String, f64)>,
    /// The first coordinate or multiplier whose error cannot be compared with its size, and why.
    pub unknown: Option<(String, NoInformation)>,
}

impl ErrorEstimate {
    /// Why a motion with this estimate is not to be trusted: in the kinetic metric, in one coordinate or in
    /// one multiplier it is over [`TRUSTED`], or nothing is known of it.
    pub fn complaint(&self) -> Option<String> {
        let of = |name: &str| if name.is_empty() { String::new() } else { format!(" of {name}") };
        if let Some((name, why)) = &self.unknown {
            return Some(format!("not to be trusted: relative error estimate{}: {why}", of(name)));
        }
        let one = self.worst.iter().chain(&self.worst_multiplier).map(|(name, part)| (&name[..], *part));
        let (name, part) = std::iter::once(("", self.relative)).chain(one).find(|(_, part)| *part > TRUSTED)?;
        let of = of(name);
        Some(format!("not to be trusted: relative error estimate{of} {part:.1e}, limit {TRUSTED:.0e}"))
    }

    /// [`crate::Ending::status`] of the motion that this estimates, untrusted also if it is doubted.
    pub fn status(&self, motion: &Motion) -> (&'static str, Option<String>) {
        let doubt = motion.doubt.as_ref().map(|doubt| doubt.because.clone());
        match (motion.ending.status(doubt.clone().or_else(|| self.complaint())), doubt) {
            ((status, Some(cause)), Some(doubt)) if !motion.is_complete() => {
                (status, Some(format!("{cause}; {doubt}")))
            }
            (status, _) => status,
        }
    }
}

impl Band {
    /// What is told of it.
    pub(crate) fn estimate(&self, metric: &Metric, multipliers: &[String]) -> ErrorEstimate {
        let (way, errors) = (self.way(), &self.errors.0);
        let [coordinates, others] = [(&metric.names[..], self.coordinates(metric)), (multipliers, self.multipliers())]
            .map(|(names, known)| worst(names, &known));
        let whole = if way.error.is_nan() { Some((String::new(), NoInformation::NotFinite)) } else { None };
        ErrorEstimate {
            absolute: way.error,
            relative: if way.size > 0.0 { way.error / way.size } else { way.error },
            coordinates: errors.coordinates.clone(),
            velocities: errors.velocities.clone(),
            multipliers: self.errors_of_multipliers(),
            worst: coordinates.0,
            worst_multiplier: others.0,
            unknown: whole.or(coordinates.1).or(others.1),
        }
    }
}

type Named<T> = Option<(String, T)>;

/// The name with the largest error over its size, and the first of which nothing is known.
fn worst(names: &[String], known: &[Known]) -> (Named<f64>, Named<NoInformation>) {
    let (mut worst, mut unknown): (Named<f64>, Named<NoInformation>) = (None, None);
    for (name, known) in names.iter().zip(known) {
        match known.part() {
            Ok(part) if part > worst.as_ref().map_or(0.0, |worst| worst.1) => worst = Some((name.clone(), part)),
            Ok(_) => {}
            Err(why) => unknown = unknown.or(Some((name.clone(), why))),
        }
    }
    (worst, unknown)
}

/// The error estimate of `motion`, which started at `setting`, at 200 equidistant times: [`error_estimates`].
///
/// # Errors
/// [`SolveError`] where the motion cannot be read off at its start.
pub fn error_estimate(motion: &mut Motion, setting: Setting) -> Result<ErrorEstimate, SolveError> {
    Ok(error_estimates(motion, setting, &[])?.1)
}

/// The error estimates of `motion` up to each of `times`, and up to its end: at 200 equidistant times
/// ([`Motion::grid`]) and at these. A motion that cannot be read off at one of them ends at the one before.
///
/// # Errors
/// [`SolveError`] where the motion cannot be read off at its start.
pub fn error_estimates(
    motion: &mut Motion,
    setting: Setting,
    times: &[f64],
) -> Result<(Vec<ErrorEstimate>, ErrorEstimate), SolveError> {
    let mut metric = Metric::new(setting.system)?;
    let multipliers: Vec<String> = motion.equations.multipliers.iter().map(|m| m.name.clone()).collect();
    let mut band = Band::from(motion.start(), &setting.start.q);
    let direction = (motion.end() - motion.start()).signum();
    let asked = times.iter().zip(0..).map(|(&t, i)| (t, Some(i)));
    let mut instants: Vec<(f64, Option<usize>)> = motion.grid(SAMPLES).into_iter().map(|t| (t, None)).collect();
    instants.extend(asked);
    instants.sort_by(|a, b| (direction * a.0).total_cmp(&(direction * b.0)));
    let every = (instants.len() / SOME).max(1);
    let mut so_far = vec![ErrorEstimate::default(); times.len()];
    let mut read = None;
    for (place, (t, asked)) in instants.into_iter().enumerate() {
        let closely = place % every == 0 && motion.charts.is_empty();
        match (band.look(motion, &mut metric, t, closely), read) {
            (Ok(_), _) => read = Some(t),
            (Err(error), None) => return Err(error),
            (Err(error), Some(before)) => {
                motion.end_at(before, &error);
                break;
            }
        }
        if let Some(i) = asked {
            so_far[i] = band.estimate(&metric, &multipliers);
        }
    }
    let mut estimate = band.estimate(&metric, &multipliers);
    if estimate.complaint().is_some() {
        // all of these times may be whole periods
        let mut times: Vec<f64> = scattered([motion.start(), motion.end()]).map(|t| motion.kept_before(t)).collect();
        times.sort_by(|a, b| (direction * a).total_cmp(&(direction * b)));
        band.last.0 = motion.start();
        for t in times {
            let Ok(now) = motion.at(t) else { break };
            band.add(&mut metric, (t, &now.coordinates, &now.velocities), t, [&now, &now]);
        }
        estimate = band.estimate(&metric, &multipliers);
    }
    Ok((so_far, estimate))
}
