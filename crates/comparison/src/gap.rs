//! Two motions of one system: are they the same, from when not, by how much.

use std::cmp::Ordering;

use integrate::find_root;

use motion::relative_to;
use motion::{CERTAINTY, Ending, Motion, SolveError};
use motion::{Metric, larger, subtract};

/// The difference of one coordinate has to be this many times the limit that *same* asks for to count as a
/// difference by itself: the errors of single coordinates are estimated less well than the length of all.
const ALONE: f64 = 10.0;

/// Relative error estimate that both motions have to stay under to be called the same.
pub const SAME_ESTIMATE: f64 = 1e-8;

/// Round-off of a run relative to its size: what no error estimate goes under, as both runs of a motion share
/// it.
const ROUND_OFF: f64 = 1e-14;

/// Gaps whose first times are reported.
pub const THRESHOLDS: [f64; 3] = [1e-6, 1e-3, 1e-1];

/// How the gap between two motions is sampled.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Number of instants, half of them equidistant, half dense near the start.
    pub instants: usize,
    /// The first motion at `t` is compared with the second at `rate · t + offset`.
    pub rate: f64,
    /// See [`Sampling::rate`].
    pub offset: f64,
}

impl Default for Sampling {
    /// 600 instants, the same clock for both motions.
    fn default() -> Self {
        Sampling { instants: 600, rate: 1.0, offset: 0.0 }
    }
}

impl Sampling {
    /// Time of the second motion at time `t` of the first.
    fn clock(&self, t: f64) -> f64 {
        self.rate * t + self.offset
    }

    /// The times of the first motion at which both can be read off.
    fn range(&self, first: &Motion, second: &Motion) -> (f64, f64) {
        let [a, b] = [second.start(), second.end()].map(|s| (s - self.offset) / self.rate);
        (first.start().max(a.min(b)), first.end().min(a.max(b)))
    }
}

/// The word on two motions.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Neither the gap nor the difference of a coordinate passes its certainty limit over the whole horizon,
    /// and the estimates are small. This was measured; it proves nothing.
    Same,
    /// The gap or the difference of a coordinate passes its certainty limit, or it is proved
    /// ([`Gap::proved`]).
    Different,
    /// Neither can be said.
    Undecided {
        /// Why.
        because: String,
    },
}

impl Verdict {
    /// `same`, `different` or `undecided`.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Different => "different",
            Verdict::Undecided { .. } => "undecided",
        }
    }
}

/// The gap at one instant.
#[derive(Clone, Copy, Debug)]
pub struct GapPoint {
    /// Time.
    pub t: f64,
    /// `sqrt(Δqᵀ |M| Δq)`.
    pub gap: f64,
    /// Limit above which the gap is certain: [`CERTAINTY`] times the sum of both error estimates up to `t`,
    /// infinite in doubt.
    pub limit: f64,
    /// Whether the gap or the difference of a coordinate passes its limit.
    pub certain: bool,
}

/// The comparison of two motions.
#[derive(Clone, Debug)]
pub struct Gap {
    /// The word.
    pub verdict: Verdict,
    /// Time of the start.
    pub start: f64,
    /// Time up to which both motions exist.
    pub end: f64,
    /// First time at which the gap or the difference of a coordinate passes its certainty limit.
    pub certain_from: Option<f64>,
    /// First time at which the difference of each coordinate passes a hundred times its own estimates: the
    /// kinetic metric hides those of little inertia.
    pub certain_by_coordinate: Vec<Option<f64>>,
    /// Whether the motions are proved to differ, by whatever little.
    pub proved: bool,
    /// Whether `M` has a negative eigenvalue at some instant, so that gaps are lengths by `|M|`.
    pub indefinite: bool,
    /// First times at which the gap passes [`THRESHOLDS`].
    pub passes: [Option<f64>; 3],
    /// Largest gap, among the certain ones where there are any.
    pub largest: f64,
    /// Largest difference of each coordinate, at the same instants.
    pub largest_by_coordinate: Vec<f64>,
    /// Largest error estimate of each of the two motions, kinetic metric.
    pub estimates: [f64; 2],
    /// Length of the first motion's way, by which estimates are made relative.
    pub scale: f64,
    /// Gap over time.
    pub points: Vec<GapPoint>,
}

/// Compares two motions of one system from one start, over the time that both exist. One that cannot be read
/// off at an instant is stopped at the one before.
///
/// # Errors
/// [`SolveError`] where the first motion cannot be read off at its start.
pub fn compare_motions(first: &mut Motion, second: &mut Motion, metric: &mut Metric) -> Result<Gap, SolveError> {
    compare_motions_by(first, second, metric, &Sampling::default())
}

/// [`compare_motions`] with other samples and clocks: for motions backwards, or in other units of time.
///
/// # Errors
/// As [`compare_motions`].
pub fn compare_motions_by(
    first: &mut Motion,
    second: &mut Motion,
    metric: &mut Metric,
    sampling: &Sampling,
) -> Result<Gap, SolveError> {
    let (t0, end) = sampling.range(first, second);
    let mut points = Vec::new();
    let mut coordinates: Vec<Vec<Difference>> = Vec::new();
    let (mut estimates, mut scale) = ([0.0_f64; 2], 0.0_f64);
    let origin = first.at(t0)?;
    let n = origin.coordinates.len();
    let mut largest_length = 0.0_f64;
    let (mut own, mut sizes, mut imprecise, mut indefinite) = (vec![0.0_f64; n], vec![0.0_f64; n], None, false);
    let mut read = t0;
    let shared = [first.terms_of_coordinates_along(), second.terms_of_coordinates_along()];
    for t in sample_times(t0, end, sampling.instants) {
        let readings = (first.at_with_difference(t), second.at_with_difference(sampling.clock(t)));
        let ((one, first_error), (two, second_error)) = match readings {
            (Ok(one), Ok(two)) => (one, two),
            (one, two) => {
                one.err().iter().for_each(|error| first.end_at(read, error));
                two.err().iter().for_each(|error| second.end_at(sampling.clock(read), error));
                break;
            }
        };
        read = t;
        let (q, v) = (&one.coordinates, &one.velocities);
        let difference = subtract(q, &two.coordinates);
        for (estimate, error) in estimates.iter_mut().zip([&first_error, &second_error]) {
            *estimate = larger(*estimate, metric.length(t, q, v, error));
        }
        scale = larger(scale, metric.distance(t, q, v, &origin.coordinates));
        largest_length = largest_length.max(metric.length(t, q, v, q)).max(metric.length(t, q, v, v) * (t - t0).abs());
        let doubted = [(&*first, t), (&*second, sampling.clock(t))].into_iter().any(|(motion, t)| motion.is_doubted(t));
        let limit = |estimate: f64, size: f64, added: f64| {
            let round_off = (ROUND_OFF * size).max(f64::EPSILON * added);
            if doubted { f64::INFINITY } else { CERTAINTY * (estimate + round_off) }
        };
        for i in 0..n {
            own[i] = larger(own[i], first_error[i].abs() + second_error[i].abs());
            sizes[i] = sizes[i].max(q[i].abs()).max((v[i] * (t - t0)).abs());
        }
        let added = |i: usize| up_to(&shared[0], i, t).max(up_to(&shared[1], i, sampling.clock(t)));
        let added: Vec<f64> = (0..n).map(added).collect();
        let (inertia, negative) = metric.inertia(t, q, v);
        indefinite |= negative;
        let round_off_sizes = metric.round_off_sizes(&inertia, &sizes, largest_length);
        let size = |i: usize| round_off_sizes[i];
        imprecise = (0..n)
            // what neither moves nor has an error is known as it is
            .map(|i| (if own[i] == 0.0 { 0.0 } else { own[i] / size(i) }, i))
            .filter(|(part, _)| part.is_nan() || *part >= SAME_ESTIMATE)
            .max_by(by_part);
        let of_coordinate = |i: usize| Difference { by: difference[i].abs(), limit: limit(own[i], size(i), added[i]) };
        coordinates.push((0..n).map(of_coordinate).collect());
        let limit = limit(estimates[0] + estimates[1], largest_length, metric.length(t, q, v, &added));
        points.push(GapPoint { t, gap: metric.length(t, q, v, &difference), limit, certain: false });
    }
    if sampling.rate < 0.0 {
        // the second motion started where the first one ended, with the error it had there
        let largest = points.iter().fold(0.0_f64, |a, p| larger(a, p.limit));
        points.iter_mut().for_each(|p| p.limit = largest);
        for i in 0..n {
            let largest = coordinates.iter().fold(0.0_f64, |a, d| larger(a, d[i].limit));
            coordinates.iter_mut().for_each(|d| d[i].limit = largest);
        }
    }
    for (p, differences) in points.iter_mut().zip(&coordinates) {
        p.certain = p.gap > p.limit || differences.iter().any(Difference::is_certain);
    }
    let first_of = |i: usize| points.iter().zip(&coordinates).find(|(_, d)| d[i].is_certain()).map(|(p, _)| p.t);
    let certain_by_coordinate: Vec<Option<f64>> = (0..n).map(first_of).collect();
    // where a difference is certain, only certain gaps count; otherwise all of them
    let certain = points.iter().any(|p| p.certain);
    let mut largest = 0.0_f64;
    let mut largest_by_coordinate = vec![0.0_f64; n];
    for (p, differences) in points.iter().zip(&coordinates).filter(|(p, _)| !certain || p.certain) {
        largest = larger(largest, p.gap);
        for (l, d) in largest_by_coordinate.iter_mut().zip(differences) {
            *l = larger(*l, d.by);
        }
    }
    let mut gap_at = |t: f64| -> f64 {
        match (first.at(t), second.at(sampling.clock(t))) {
            (Ok(one), Ok(two)) => metric.distance(t, &one.coordinates, &one.velocities, &two.coordinates),
            _ => f64::NAN,
        }
    };
    let passes = THRESHOLDS.map(|threshold| first_passing(&points, &mut gap_at, threshold));
    let doubtful =
        coordinates.iter().flat_map(|all| all.iter().enumerate()).find(|(_, d)| d.by > d.limit || d.by.is_nan());
    let certain_from = points.iter().find(|p| p.certain).map(|p| p.t);
    let estimate = larger(estimates[0], estimates[1]);
    let relative = relative_to(scale, estimate);
    let doubt = first.doubt.as_ref().or(second.doubt.as_ref());
    let verdict = if certain_from.is_some() {
        Verdict::Different
    } else if let Some(doubt) = doubt {
        Verdict::Undecided { because: doubt.because.clone() }
    } else if let Some((t, cause)) = earlier_stop(first, second) {
        Verdict::Undecided { because: format!("no difference up to t = {t:.6}, where one stops: {cause}") }
    } else if let (true, Some((part, i))) = (relative < SAME_ESTIMATE, imprecise) {
        let name = &metric.names[i];
        let because =
            format!("relative error estimate of {name} {part:.1e} is over {SAME_ESTIMATE:.0e}, and no gap is certain");
        Verdict::Undecided { because }
    } else if let Some((i, d)) = doubtful {
        let [by, limit] = [d.by, d.limit];
        let name = &metric.names[i];
        let because =
            format!("{name} differs by {by:.1e}, over {limit:.1e}, which is {CERTAINTY} times its own estimates");
        Verdict::Undecided { because }
    } else if relative < SAME_ESTIMATE {
        Verdict::Same
    } else if scale <= CERTAINTY * estimate {
        let because = if scale > SAME_ESTIMATE * largest_length {
            format!("the error estimate {estimate:.1e} has grown to the size of the motion, {scale:.1e}")
        } else {
            // nothing that an error could be relative to
            format!(
                "at rest, as far as can be told: no way is over {CERTAINTY} times the error estimate {estimate:.1e}"
            )
        };
        Verdict::Undecided { because }
    } else {
        let because =
            format!("relative error estimate {relative:.1e} is over {SAME_ESTIMATE:.0e}, and no gap is certain");
        Verdict::Undecided { because }
    };
    Ok(Gap {
        verdict,
        start: t0,
        end: read,
        certain_from,
        certain_by_coordinate,
        proved: false,
        indefinite,
        passes,
        largest,
        largest_by_coordinate,
        estimates,
        scale,
        points,
    })
}

/// The sum of terms behind coordinate `i` at `t`, by linear interpolation between known times.
fn up_to(terms: &[(f64, Vec<f64>)], i: usize, t: f64) -> f64 {
    let has_begun = |ends: &&[(f64, Vec<f64>)]| (t - ends[0].0) * (ends[1].0 - ends[0].0) >= 0.0;
    let Some([(a, first), (b, last)]) = terms.windows(2).take_while(has_begun).last() else { return 0.0 };
    first[i] + ((t - a) / (b - a)).min(1.0) * (last[i] - first[i])
}

/// The difference of a coordinate at an instant, and what it has to pass.
struct Difference {
    by: f64,
    limit: f64,
}

impl Difference {
    fn is_certain(&self) -> bool {
        self.by > ALONE * self.limit
    }
}

fn by_part(a: &(f64, usize), b: &(f64, usize)) -> Ordering {
    a.0.abs().total_cmp(&b.0.abs())
}

/// When and why the first of the two stops that does, if one does.
fn earlier_stop<'a>(first: &'a Motion, second: &'a Motion) -> Option<(f64, &'a str)> {
    let stop = |motion: &'a Motion| match &motion.ending {
        Ending::Stopped { t, cause } => Some(((t - motion.start()).abs(), *t, &cause[..])),
        Ending::Completed => None,
    };
    let stops = [first, second].into_iter().filter_map(stop);
    stops.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, t, cause)| (t, cause))
}

impl Gap {
    /// The motions are proved to differ, whatever the gap shows.
    pub(crate) fn prove(&mut self) {
        (self.proved, self.verdict) = (true, Verdict::Different);
    }

    /// The time from the start to `t`.
    pub fn after(&self, t: f64) -> f64 {
        t - self.start
    }

    /// Whether the gap itself passes its limit: of motions that differ in coordinates of hardly any inertia,
    /// or only by proof, it does not.
    pub fn shows(&self) -> bool {
        self.points.iter().any(|p| p.gap > p.limit)
    }

    /// Upper bound of the gap at every instant, by measurement; infinite in doubt.
    pub fn bound(&self) -> f64 {
        self.points.iter().fold(0.0, |a, p| larger(a, p.gap + p.limit))
    }

    /// The certainty limit at `t`: that of the first sample from `t` on, infinite after the last.
    pub fn limit_at(&self, t: f64) -> f64 {
        self.points.iter().find(|p| p.t >= t).map_or(f64::INFINITY, |p| p.limit)
    }
}

/// Times dense near the start (geometric) and everywhere (equidistant), start left out.
fn sample_times(start: f64, end: f64, instants: usize) -> Vec<f64> {
    let length = end - start;
    let half = instants / 2;
    let mut times: Vec<f64> = (1..=half).map(|i| start + length * i as f64 / half as f64).collect();
    times.extend((0..half).map(|i| start + length * 10f64.powf(-5.0 + 5.0 * i as f64 / half as f64)));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// First time at which `gap` reaches `threshold`: bracketed by the samples, refined on the dense output.
fn first_passing(points: &[GapPoint], gap: &mut dyn FnMut(f64) -> f64, threshold: f64) -> Option<f64> {
    let index = points.iter().position(|p| p.gap >= threshold && p.gap > p.limit)?;
    let right = points[index].t;
    let Some(left) = index.checked_sub(1).map(|i| points[i].t) else { return Some(right) };
    if points[index - 1].gap >= threshold {
        return Some(right);
    }
    find_root(&mut |t| gap(t) - threshold, left, right, 1e-12 * right.abs().max(f64::MIN_POSITIVE)).or(Some(right))
}
