//! # The error of a motion
//!
//! A motion is integrated twice, at a tolerance and at a hundredth of it, from starts that differ in their
//! last digits. The tighter run is kept. A [`Band`] is what both say together, at every instant at which they
//! are read, of every quantity `x` of the motion (coordinates, velocities, multipliers, invariants, and the
//! length of all coordinates in the kinetic metric):
//!
//! ```text
//! value  x_kept(t)
//! error  e(t) = max_{s ≤ t} |x_kept(s) − x_looser(s)|
//! size   s(t) = max_{s ≤ t} |x_kept(s)|          (of coordinates also the way from the start)
//! bound  e(t) + ρ S(t) ,    ρ = 256 ε ,          S: what round-off of x is a part of, ≥ s
//! ```
//!
//! **Round-off.** What both runs share does not show in their difference. Rates that lose more than `ρ` of a
//! state are found by summing terms (`accumulated_round_off`), and put into the rates of the looser
//! run (`perturbed_rates`). What is left is less than `ρ S`.
//!
//! **Questions.** Every verdict is one of three answers to a difference `d` of two quantities, whose bounds
//! are `b₁` and `b₂` ([`ask()`]; a constant is a quantity with `b = 0`):
//!
//! ```text
//! apart      |d| > 10 (b₁ + b₂)
//! within     |d| ≤ 10 (b₁ + b₂)
//! undecided  where nothing is known, with the reason: [`NoInformation`]
//! ```
//!
//! Two motions, a motion and what should be constant along it ([`Breach`]), and a motion and its own size
//! ([`ErrorEstimate::complaint`]) are asked in this way. There is no division by a size that may be zero: a
//! relative error is a [`Known::part`], or no information.
//!
//! **When a difference of runs is no error.** Where the tolerance did not decide the steps
//! (`estimate_failure`), where round-off is no small part of a state, or where a constraint is broken, a
//! [`Doubt`] begins, from which on nothing is known.
//!
//! One function adds an instant, [`Band::add`]; single motions, charts, equal steps, members of ensembles and
//! derivatives come to it as two runs (`runs`). All limits stand in one table (`limits`).

pub(crate) mod accumulated_round_off;
mod estimate;
pub(crate) mod estimate_failure;
pub(crate) mod invariant_monitor;
mod known;
pub(crate) mod limits;
pub(crate) mod perturbed_rates;
pub(crate) mod round_off;
mod runs;
mod single;
pub(crate) mod ulp_perturbation;

use equations::Outputs;

pub use estimate::{ErrorEstimate, error_estimate, error_estimates};
pub use estimate_failure::Doubt;
pub use invariant_monitor::Breach;
pub use known::{Answer, Known, NoInformation, ask, ask_alone};
pub use limits::{
    BEFORE_THE_END, CERTAINTY, CHUNK, INSTANTS, LOOKS, NEARLY_ZERO, RESIDUAL, SAME_ESTIMATE, SAMPLES, SEARCH_STEPS,
    SOME, TRUSTED,
};
pub(crate) use runs::TwoRuns;

use self::limits::ROUND_OFF;
use crate::metric::{larger, subtract};
use crate::{Metric, SolveError};

/// Where a length is measured: time, coordinates, velocities.
pub type Place<'a> = (f64, &'a [f64], &'a [f64]);

/// What the two runs of a motion say, up to the last instant that was added.
#[derive(Clone, Default)]
pub struct Band {
    /// Coordinates at the start, and its time.
    start: Vec<f64>,
    begin: f64,
    /// Time and coordinates at the last instant.
    last: (f64, Vec<f64>),
    pub(crate) errors: Errors,
    /// Of coordinates also how far they came or may have come since the instant before.
    sizes: Outputs,
    /// The sum of terms behind each multiplier, as far as it was computed.
    terms: Vec<f64>,
    /// Round-off of each multiplier as it is computed from states.
    round_off: Vec<f64>,
    /// The way from the start in the kinetic metric.
    way: Known,
    /// Of the unit of each coordinate, at the first instant, the length.
    inertia: Vec<f64>,
}

/// Largest differences of two runs so far; NaN stays.
#[derive(Clone, Default)]
pub(crate) struct Errors(pub(crate) Outputs);

impl Errors {
    /// Adds what two runs say at an instant.
    pub(crate) fn add(&mut self, [kept, looser]: [&Outputs; 2]) {
        let add = |most: &mut Vec<f64>, kept: &[f64], looser: &[f64]| {
            raise(most, kept.iter().zip(looser).map(|(a, b)| a - b));
        };
        let Errors(most) = self;
        add(&mut most.coordinates, &kept.coordinates, &looser.coordinates);
        add(&mut most.velocities, &kept.velocities, &looser.velocities);
        add(&mut most.multipliers, &kept.multipliers, &looser.multipliers);
        add(&mut most.invariants, &kept.invariants, &looser.invariants);
    }
}

/// The larger ones of magnitudes, place by place.
fn raise(most: &mut Vec<f64>, now: impl Iterator<Item = f64>) {
    for (i, x) in now.enumerate() {
        if i == most.len() {
            most.push(0.0);
        }
        most[i] = larger(most[i], x.abs());
    }
}

impl Band {
    /// Of a motion that starts at this time from these coordinates.
    pub fn from(t: f64, start: &[f64]) -> Band {
        Band { start: start.to_vec(), begin: t, last: (t, start.to_vec()), ..Band::default() }
    }

    /// Adds an instant at which a motion is read off; returns its kept outputs.
    pub(crate) fn look(
        &mut self,
        runs: &mut dyn TwoRuns,
        metric: &mut Metric,
        t: f64,
        closely: bool,
    ) -> Result<Outputs, SolveError> {
        let (kept, looser) = (runs.kept(t)?, runs.looser(t)?);
        self.add(metric, (t, &kept.coordinates, &kept.velocities), t, [&kept, &looser]);
        let doubtful = self.has_doubtful_multipliers();
        if (doubtful || closely && !kept.multipliers.is_empty())
            && let Some(y) = runs.states(t)
        {
            self.add_sums(runs, t, &y, [doubtful, closely]);
        }
        Ok(kept)
    }

    /// Adds what two runs say at their time `t`; lengths are measured at `place`.
    pub fn add(&mut self, metric: &mut Metric, place: Place, t: f64, [kept, looser]: [&Outputs; 2]) {
        let (time, q, v) = place;
        let length = |metric: &mut Metric, x: &[f64]| metric.length(time, q, v, x);
        if self.inertia.is_empty() {
            self.inertia = metric.inertia(time, q, v).0;
        }
        self.errors.add([kept, looser]);
        let reach = (t - self.last.0).abs();
        let own = &kept.coordinates;
        let by_rate: Vec<f64> = kept.velocities.iter().map(|v| v * reach).collect();
        let from_start = subtract(own, &self.start);
        let Known { error, size, reach: most, .. } = &mut self.way;
        *error = larger(*error, length(metric, &subtract(own, &looser.coordinates)));
        *size = larger(*size, length(metric, &from_start));
        *most = larger(larger(*most, length(metric, own)), length(metric, &by_rate));
        raise(&mut self.sizes.coordinates, own.iter().copied());
        raise(&mut self.sizes.coordinates, from_start.into_iter());
        raise(&mut self.sizes.coordinates, by_rate.into_iter());
        raise(&mut self.sizes.velocities, kept.velocities.iter().copied());
        raise(&mut self.sizes.multipliers, kept.multipliers.iter().copied().map(|m| if m.is_nan() { 0.0 } else { m }));
        raise(&mut self.sizes.invariants, kept.invariants.iter().copied());
        self.last = (t, own.clone());
    }

    /// The way from the start, in the kinetic metric.
    pub fn way(&self) -> Known {
        Known { reach: self.way.reach.max(self.way.size), ..self.way }
    }

    /// The coordinates.
    pub fn coordinates(&self, metric: &Metric) -> Vec<Known> {
        let reaches = metric.round_off_sizes(&self.inertia, &self.sizes.coordinates, self.way().reach);
        self.known(&self.last.1, &self.errors.0.coordinates, &self.sizes.coordinates, &reaches)
    }

    /// The multipliers, with their round-off where it exceeds their last digits.
    pub(crate) fn multipliers(&self) -> Vec<Known> {
        let sizes = &self.sizes.multipliers;
        let reach = |i: usize| self.terms.get(i).copied().unwrap_or(0.0).max(sizes[i]);
        let reaches: Vec<f64> = (0..sizes.len()).map(reach).collect();
        self.known(sizes, &self.errors.0.multipliers, sizes, &reaches)
    }

    fn known(&self, values: &[f64], errors: &[f64], sizes: &[f64], reaches: &[f64]) -> Vec<Known> {
        let known = |i: usize| Known { value: values[i], error: errors[i], size: sizes[i], reach: reaches[i] };
        (0..sizes.len()).map(known).collect()
    }

    /// Whether a multiplier differs by more than is trusted, and by more than the round-off known so far.
    fn has_doubtful_multipliers(&self) -> bool {
        let is_doubtful = |known: Known| !known.part().is_ok_and(|part| part <= TRUSTED);
        self.multipliers().into_iter().any(is_doubtful)
    }

    /// What is added up behind each multiplier: along the way, or in its evaluation at an instant, by
    /// adjoints where magnitudes along paths are more than its last digits. Sums are rounded to the nearest
    /// number, so they are off by `ε/2` of that.
    fn add_sums(&mut self, runs: &mut dyn TwoRuns, t: f64, y: &[f64], [along, here]: [bool; 2]) {
        let compiled = runs.compiled();
        if along && let Ok(terms) = compiled.terms_of_multipliers(self.begin, t, y) {
            raise(&mut self.terms, terms.into_iter());
        }
        if here {
            let mut terms = compiled.terms_of_multipliers(t, t, y).ok();
            let mut each = terms.iter().flatten().zip(&self.sizes.multipliers);
            if each.any(|(term, size)| f64::EPSILON * term > 2.0 * ROUND_OFF * size) {
                terms = compiled.adjoint_terms_of_multipliers(t, y).ok();
            }
            raise(&mut self.round_off, terms.into_iter().flatten().map(|term| 0.5 * f64::EPSILON * term));
        }
    }

    /// The errors of multipliers, with round-off.
    pub(crate) fn errors_of_multipliers(&self) -> Vec<f64> {
        let with_round_off = |(i, error): (usize, &f64)| match self.round_off.get(i) {
            Some(round_off) if *round_off > ROUND_OFF * self.sizes.multipliers[i] => error + round_off,
            _ => *error,
        };
        self.errors.0.multipliers.iter().enumerate().map(with_round_off).collect()
    }
}
