//! Two motions of one system: are they the same, from when not, by how much.

use integrate::find_root;

use motion::band::{Answer, Band, CERTAINTY, Known, NoInformation, SAME_ESTIMATE, ask, ask_alone};
use motion::numbers::precise;
use motion::{Ending, Metric, Motion, SolveError, larger, subtract};

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
    let origin = first.at(t0)?.coordinates;
    let n = origin.len();
    let mut bands = [t0, sampling.clock(t0)].map(|t| Band::from(t, &origin));
    let (mut samples, mut read, mut indefinite): (Vec<Sample>, _, _) = (Vec::new(), t0, false);
    for t in sample_times(t0, end, sampling.instants) {
        let other = sampling.clock(t);
        let ((one, looser), (two, other_looser)) = match (first.at_in_both_runs(t), second.at_in_both_runs(other)) {
            (Ok(one), Ok(two)) => (one, two),
            (one, two) => {
                one.err().iter().for_each(|error| first.end_at(read, error));
                two.err().iter().for_each(|error| second.end_at(sampling.clock(read), error));
                break;
            }
        };
        read = t;
        let place = (t, &one.coordinates[..], &one.velocities[..]);
        bands[0].add(metric, place, t, [&one, &looser]);
        bands[1].add(metric, place, other, [&two, &other_looser]);
        indefinite |= metric.inertia(t, place.1, place.2).1;
        let doubted = first.is_doubted(t) || second.is_doubted(other);
        let difference = subtract(&one.coordinates, &two.coordinates);
        let length = metric.length(t, place.1, place.2, &difference);
        let gap = Difference::of(length, sum(bands.each_ref().map(Band::way)), doubted);
        let [one, two] = bands.each_ref().map(|band| band.coordinates(metric));
        let each = one.into_iter().zip(two).zip(&difference);
        let coordinates = each.map(|((one, two), by)| Difference::of(by.abs(), sum([one, two]), doubted)).collect();
        samples.push(Sample { t, gap, coordinates });
    }
    if sampling.rate < 0.0 {
        // the second motion started where the first one ended, with the error it had there
        for i in 0..=n {
            let of = |sample: &mut Sample| sample.difference(i).bound;
            let largest = samples.iter_mut().try_fold(0.0, |most, sample| Some(larger(most, of(sample)?)));
            samples.iter_mut().for_each(|sample| sample.difference(i).bound = largest);
        }
    }
    let certain_from = samples.iter().find(|sample| sample.is_certain()).map(|sample| sample.t);
    let first_of = |i: usize| samples.iter().find(|sample| sample.coordinates[i].is_certain_alone()).map(|s| s.t);
    // where a difference is certain, only certain gaps count; otherwise all of them
    let mut largest = 0.0_f64;
    let mut largest_by_coordinate = vec![0.0_f64; n];
    for sample in samples.iter().filter(|sample| certain_from.is_none() || sample.is_certain()) {
        largest = larger(largest, sample.gap.by);
        for (largest, difference) in largest_by_coordinate.iter_mut().zip(&sample.coordinates) {
            *largest = larger(*largest, difference.by);
        }
    }
    let points: Vec<GapPoint> = samples.iter().map(Sample::point).collect();
    let mut gap_at = |t: f64| -> f64 {
        match (first.at(t), second.at(sampling.clock(t))) {
            (Ok(one), Ok(two)) => metric.distance(t, &one.coordinates, &one.velocities, &two.coordinates),
            _ => f64::NAN,
        }
    };
    let passes = THRESHOLDS.map(|threshold| first_passing(&points, &mut gap_at, threshold));
    let verdict = match (certain_from, unknown([first, second], &bands, &samples, metric)) {
        (Some(_), _) => Verdict::Different,
        (None, Some(because)) => Verdict::Undecided { because },
        (None, None) => Verdict::Same,
    };
    Ok(Gap {
        verdict,
        start: t0,
        end: read,
        certain_from,
        certain_by_coordinate: (0..n).map(first_of).collect(),
        proved: false,
        indefinite,
        passes,
        largest,
        largest_by_coordinate,
        estimates: bands.each_ref().map(|band| band.way().error),
        scale: bands[0].way().size,
        points,
    })
}

/// What two bands say of each coordinate and of their gap, at an instant.
struct Sample {
    t: f64,
    gap: Difference,
    coordinates: Vec<Difference>,
}

/// A difference, and the bound of what the errors make of it; `None` in doubt.
#[derive(Clone, Copy)]
struct Difference {
    by: f64,
    bound: Option<f64>,
}

impl Difference {
    fn of(by: f64, known: Known, doubted: bool) -> Difference {
        Difference { by, bound: (!doubted).then(|| known.bound()) }
    }

    fn is_certain_alone(&self) -> bool {
        ask_alone(self.by, self.bound) == Answer::Apart
    }

    fn limit(&self) -> f64 {
        self.bound.map_or(f64::INFINITY, |bound| CERTAINTY * bound)
    }
}

impl Sample {
    /// Of a coordinate, or the gap after all of them.
    fn difference(&mut self, i: usize) -> &mut Difference {
        self.coordinates.get_mut(i).unwrap_or(&mut self.gap)
    }

    fn is_certain(&self) -> bool {
        ask(self.gap.by, self.gap.bound) == Answer::Apart || self.coordinates.iter().any(Difference::is_certain_alone)
    }

    fn point(&self) -> GapPoint {
        GapPoint { t: self.t, gap: self.gap.by, limit: self.gap.limit(), certain: self.is_certain() }
    }
}

/// Both errors together, beside the larger size.
fn sum([one, two]: [Known; 2]) -> Known {
    let [size, reach] = [one.size.max(two.size), one.reach.max(two.reach)];
    Known { value: one.value, error: one.error + two.error, size, reach }
}

/// Why two motions that are nowhere apart may not be called the same, if so.
fn unknown(motions: [&Motion; 2], bands: &[Band; 2], samples: &[Sample], metric: &Metric) -> Option<String> {
    if let Some(doubt) = motions.iter().find_map(|motion| motion.doubt.as_ref()) {
        return Some(doubt.because.clone());
    }
    if let Some((t, cause)) = earlier_stop(motions) {
        return Some(format!("no difference up to t = {}, where one stops: {cause}", precise(t)));
    }
    let ways = bands.each_ref().map(Band::way);
    let way = Known { error: larger(ways[0].error, ways[1].error), ..ways[0] };
    let (Known { error, size, reach, .. }, part) = (way, way.part());
    if !part.is_ok_and(|part| part < SAME_ESTIMATE) {
        return Some(match part {
            Ok(relative) if size > CERTAINTY * error => {
                format!("relative error estimate {relative:.1e} is over {SAME_ESTIMATE:.0e}, and no gap is certain")
            }
            Err(why @ NoInformation::NotFinite) => format!("relative error estimate: {why}"),
            _ if size > SAME_ESTIMATE * reach => {
                format!("the error estimate {error:.1e} has grown to the size of the motion, {size:.1e}")
            }
            // nothing that an error could be relative to
            _ => {
                let why = NoInformation::AtRest;
                format!("{why}: no way is over {CERTAINTY} times the error estimate {error:.1e}")
            }
        });
    }
    let [one, two] = bands.each_ref().map(|band| band.coordinates(metric));
    let imprecise = one.into_iter().zip(two).map(|(one, two)| sum([one, two])).zip(&metric.names);
    // what neither moves nor has an error is known as it is
    let imprecise = imprecise.filter(|(known, _)| !(known.error < SAME_ESTIMATE * known.reach || known.error == 0.0));
    if let Some((known, name)) = imprecise.max_by(|a, b| (a.0.error / a.0.reach).total_cmp(&(b.0.error / b.0.reach))) {
        let part = known.error / known.reach;
        return Some(format!(
            "relative error estimate of {name} {part:.1e} is over {SAME_ESTIMATE:.0e}, and no gap is certain"
        ));
    }
    let each = samples.iter().flat_map(|sample| sample.coordinates.iter().zip(&metric.names));
    let (difference, name) = each.into_iter().find(|(d, _)| ask(d.by, d.bound) != Answer::Within)?;
    let (by, limit) = (difference.by, difference.limit());
    Some(format!("{name} differs by {by:.1e}, over {limit:.1e}, which is {CERTAINTY} times its own estimates"))
}

/// When and why the first of the two stops that does, if one does.
fn earlier_stop(motions: [&Motion; 2]) -> Option<(f64, &str)> {
    let stop = |motion: &&'_ Motion| (motion.end() - motion.start()).abs();
    let stopped = motions.into_iter().filter(|motion| !motion.is_complete());
    match &stopped.min_by(|a, b| stop(a).total_cmp(&stop(b)))?.ending {
        Ending::Stopped { t, cause } => Some((*t, cause)),
        Ending::Completed => None,
    }
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
