//! The error estimate of a whole motion, of its coordinates and of its multipliers.

use equations::{Compiled, Outputs};

use crate::lost_digits::{NUMBERS, ROUNDED};
use crate::metric::{larger, subtract};
use crate::wanted::scattered;
use crate::{Metric, Motion, Setting, SolveError};

/// Instants at which it is taken.
const SAMPLES: usize = 200;
/// Number of instants at which the terms of multipliers are summed.
const LOOKED: usize = 16;

/// Relative error estimate over which a motion is not trusted, nor a single coordinate.
pub const TRUSTED: f64 = 1e-3;

/// Differences of a coordinate under this part of [`Metric::round_off_sizes`] are round-off.
const ROUND_OFF: f64 = 1e-12;

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
    /// For each multiplier, in its unit, with the round-off of the sum of terms behind it, where this exceeds
    /// its last digits.
    pub multipliers: Vec<f64>,
    /// The coordinate with the largest difference over its own size, which is the largest value that it has
    /// or has moved by, and that quotient; `None` where all differences are round-off.
    pub worst: Option<(String, f64)>,
    /// The multiplier with the largest difference over its own size, likewise.
    pub worst_multiplier: Option<(String, f64)>,
}

impl ErrorEstimate {
    /// Why a motion with this estimate is not to be trusted: in the kinetic metric, in one coordinate or in
    /// one multiplier it is over [`TRUSTED`], or no number.
    pub fn complaint(&self) -> Option<String> {
        let whole = (String::new(), self.relative);
        let one =
            self.worst.iter().chain(&self.worst_multiplier).map(|(name, relative)| (format!(" of {name}"), *relative));
        let (of, relative) = std::iter::once(whole).chain(one).find(|(_, relative)| !is_trusted(*relative))?;
        Some(format!("not to be trusted: relative error estimate{of} {relative:.1e}, limit {TRUSTED:.0e}"))
    }

    /// [`crate::Ending::status`] of the motion that this estimates, untrusted also where it is doubted.
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

fn is_trusted(relative: f64) -> bool {
    relative <= TRUSTED
}

/// A difference relative to `scale`, the motion's largest distance from its start.
pub fn relative_to(scale: f64, absolute: f64) -> f64 {
    if scale > 0.0 { absolute / scale } else { absolute }
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
    let names: Vec<String> = setting.system.coordinates.iter().map(|c| c.name.clone()).collect();
    let multipliers: Vec<String> = motion.equations.multipliers.iter().map(|m| m.name.clone()).collect();
    let mut differences = Differences::from(&names, &multipliers, &setting.start.q);
    let direction = (motion.end() - motion.start()).signum();
    let asked = times.iter().zip(0..).map(|(&t, i)| (t, Some(i)));
    let mut instants: Vec<(f64, Option<usize>)> = motion.grid(SAMPLES).into_iter().map(|t| (t, None)).collect();
    instants.extend(asked);
    instants.sort_by(|a, b| (direction * a.0).total_cmp(&(direction * b.0)));
    let every = (instants.len() / LOOKED).max(1);
    let mut so_far = vec![ErrorEstimate::default(); times.len()];
    let mut read = None;
    for (place, (t, asked)) in instants.into_iter().enumerate() {
        let (kept, looser) = match (motion.at_in_both_runs(t), read) {
            (Ok(outputs), _) => outputs,
            (Err(error), None) => return Err(error),
            (Err(error), Some(before)) => {
                motion.end_at(before, &error);
                break;
            }
        };
        read = Some(t);
        differences.add(&mut metric, t, &kept, &looser, 0.0);
        if differences.has_doubtful_multipliers() {
            differences.add_terms(motion.terms_of_multipliers(motion.start(), t));
        }
        if place % every == 0
            && !multipliers.is_empty()
            && motion.charts.is_empty()
            && let Ok(y) = motion.states_at(t)
        {
            differences.add_round_off(&mut motion.compiled, t, &y);
        }
        if let Some(i) = asked {
            so_far[i] = differences.estimate(&metric);
        }
    }
    let mut estimate = differences.estimate(&metric);
    if estimate.complaint().is_some() {
        // all of these times may be whole periods
        let times: Vec<f64> = scattered([motion.start(), motion.end()]).map(|t| motion.kept_before(t)).collect();
        for t in times {
            let Ok(now) = motion.at(t) else { break };
            differences.add(&mut metric, t, &now, &now, 0.0);
        }
        estimate = differences.estimate(&metric);
    }
    Ok((so_far, estimate))
}

/// Differences of two runs, gathered over time.
pub(crate) struct Differences<'a> {
    names: &'a [String],
    start: &'a [f64],
    absolute: f64,
    scale: f64,
    coordinates: Vec<f64>,
    sizes: Vec<f64>,
    names_of_multipliers: &'a [String],
    multipliers: Vec<f64>,
    sizes_of_multipliers: Vec<f64>,
    /// The sum of terms behind each multiplier, as far as it was computed.
    terms: Vec<f64>,
    /// Round-off of each multiplier as it was computed from states.
    round_off: Vec<f64>,
    /// Largest kinetic length of the coordinates themselves, and of the unit of each at the first instant.
    length: f64,
    inertia: Vec<f64>,
}

impl<'a> Differences<'a> {
    /// Of motions from these coordinates, with the names of coordinates and multipliers.
    pub(crate) fn from(names: &'a [String], names_of_multipliers: &'a [String], start: &'a [f64]) -> Self {
        let (zeros, none) = (vec![0.0; start.len()], vec![0.0; names_of_multipliers.len()]);
        Differences {
            names,
            start,
            absolute: 0.0,
            scale: 0.0,
            coordinates: zeros.clone(),
            sizes: zeros,
            names_of_multipliers,
            multipliers: none.clone(),
            sizes_of_multipliers: none.clone(),
            terms: none.clone(),
            round_off: none,
            length: 0.0,
            inertia: Vec::new(),
        }
    }

    /// Adds the outputs of the two runs at `t`. If instants are few, velocities times `reach` also count as
    /// sizes of coordinates.
    pub(crate) fn add(&mut self, metric: &mut Metric, t: f64, kept: &Outputs, looser: &Outputs, reach: f64) {
        let (q, v) = (&kept.coordinates, &kept.velocities);
        let difference = subtract(q, &looser.coordinates);
        self.absolute = larger(self.absolute, metric.length(t, q, v, &difference));
        self.scale = larger(self.scale, metric.distance(t, q, v, self.start));
        self.length = larger(self.length, metric.length(t, q, v, q));
        if self.inertia.is_empty() {
            self.inertia = metric.inertia(t, q, v).0;
        }
        for (i, size) in self.sizes.iter_mut().enumerate() {
            let now = q[i].abs().max((q[i] - self.start[i]).abs()).max((v[i] * reach).abs());
            *size = larger(*size, now);
            self.coordinates[i] = larger(self.coordinates[i], difference[i].abs());
        }
        for (m, d) in self.multipliers.iter_mut().zip(subtract(&kept.multipliers, &looser.multipliers)) {
            *m = larger(*m, d.abs());
        }
        for (size, m) in self.sizes_of_multipliers.iter_mut().zip(&kept.multipliers) {
            *size = size.max(m.abs());
        }
    }

    /// Whether a multiplier differs by more than is trusted, and by more than the round-off known so far.
    pub(crate) fn has_doubtful_multipliers(&self) -> bool {
        (0..self.multipliers.len()).any(|i| {
            let d = self.multipliers[i];
            d > (TRUSTED * self.sizes_of_multipliers[i]).max(ROUND_OFF * self.terms[i])
        })
    }

    /// The sum of terms behind each multiplier at an instant.
    pub(crate) fn add_terms(&mut self, terms: Option<Vec<f64>>) {
        self.terms.iter_mut().zip(terms.into_iter().flatten()).for_each(|(most, term)| *most = most.max(term));
    }

    /// The round-off of each multiplier at an instant, which both runs have: by adjoints where magnitudes
    /// along paths are more than its last digits.
    pub(crate) fn add_round_off(&mut self, compiled: &mut Compiled, t: f64, y: &[f64]) {
        let mut terms = compiled.terms_of_multipliers(t, t, y).ok();
        let mut each = terms.iter().flatten().zip(&self.sizes_of_multipliers);
        if each.any(|(term, size)| ROUNDED * term > NUMBERS * size) {
            terms = compiled.adjoint_terms_of_multipliers(t, y).ok();
        }
        let round_off = terms.into_iter().flatten().map(|term| ROUNDED * term);
        self.round_off.iter_mut().zip(round_off).for_each(|(most, now)| *most = larger(*most, now));
    }

    /// The estimate so far.
    pub(crate) fn estimate(&self, metric: &Metric) -> ErrorEstimate {
        let round_off = metric.round_off_sizes(&self.inertia, &self.sizes, self.length.max(self.scale));
        ErrorEstimate {
            absolute: self.absolute,
            relative: relative_to(self.scale, self.absolute),
            coordinates: self.coordinates.clone(),
            multipliers: self.with_round_off(),
            worst: worst(self.names, &self.coordinates, &self.sizes, &round_off),
            worst_multiplier: worst(
                self.names_of_multipliers,
                &self.multipliers,
                &self.sizes_of_multipliers,
                &self.terms.iter().zip(&self.sizes_of_multipliers).map(|(a, b)| a.max(*b)).collect::<Vec<f64>>(),
            ),
        }
    }
}

impl Differences<'_> {
    /// Differences of multipliers, with their round-off.
    fn with_round_off(&self) -> Vec<f64> {
        let all = self.multipliers.iter().zip(&self.round_off).zip(&self.sizes_of_multipliers);
        all.map(|((d, round_off), size)| if *round_off > NUMBERS * size { d + round_off } else { *d }).collect()
    }
}

/// The name with the largest difference over its size, of those whose difference is more than round-off.
fn worst(names: &[String], d: &[f64], sizes: &[f64], round_off: &[f64]) -> Option<(String, f64)> {
    let counts = |i: &usize| d[*i] > ROUND_OFF * round_off[*i] || d[*i].is_nan();
    let each = (0..d.len()).filter(counts).map(|i| (&names[i], d[i] / sizes[i]));
    // NaN of either sign is the worst
    let worst = each.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    worst.map(|(name, relative)| (name.clone(), relative))
}
