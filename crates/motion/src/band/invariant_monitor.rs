//! Checks along a motion that do not depend on its derivation: the scene's own constraints, and quantities
//! listed as constant. `f` is compiled from the scene alone, so a term that a derivation lost shows here.

use std::fmt::{self, Display, Formatter};

use equations::{Equations, Outputs};
use mechanics::{Constancy, System};
use symbolic::{Bounded, CompileError, Evaluator, Scalar, Symbol};

use super::estimate_failure::Doubt;
use super::limits::{ROUND_OFF, UNITS};
use super::ulp_perturbation::terms_of_invariants;
use super::{Answer, Errors, TwoRuns, ask, ask_alone};
use crate::metric::subtract;
use crate::numbers::precise;

/// A motion changes what the user expects to be constant: a finding about the formulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Breach {
    /// Name of the quantity.
    pub name: String,
    /// First time at which this is certain.
    pub t: f64,
    /// Change since the start, at that time; its error estimate; the largest change of the motion.
    pub change: f64,
    /// See [`Breach::change`].
    pub estimate: f64,
    /// See [`Breach::change`].
    pub largest: f64,
}

impl Breach {
    /// Whether it is certain at its largest, as a single quantity.
    pub fn is_clear(&self) -> bool {
        ask_alone(self.largest, Some(self.estimate)) == Answer::Apart
    }
}

impl Display for Breach {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Breach { name, t, change, estimate, .. } = self;
        write!(
            f,
            "{name} is not constant: it has changed by {change:.1e} at t = {}, with an error estimate of {estimate:.1e}",
            precise(*t)
        )
    }
}

/// Asks whether `f = 0` holds, and whether what should be constant is.
#[derive(Clone)]
pub(crate) struct InvariantMonitor {
    /// `f(t, q, v)` and parameters that vary; nothing where constraints creep.
    constraints: Evaluator<Bounded>,
    inputs: Vec<Bounded>,
    /// Units of the coordinates.
    units: Vec<String>,
    /// Names of the invariants, of those that the user expects to be constant, and of these what was found to
    /// change since the motion began.
    names: Vec<String>,
    expected: Vec<String>,
    pub(crate) breaches: Vec<Breach>,
    /// [`crate::Motion::unseen`].
    pub(crate) unseen: Vec<(String, f64)>,
    /// `|f|` and the invariants at the start.
    start: (Vec<f64>, Vec<f64>),
    /// The sum of terms behind each invariant, where it is known to exceed its value.
    sizes: Vec<f64>,
}

impl InvariantMonitor {
    /// For a motion by `equations` of a system with these varying parameters.
    pub(crate) fn new(system: &System, equations: &Equations, parameters: &[Symbol]) -> Result<Self, CompileError> {
        let mut inputs = vec![system.time];
        inputs.extend(system.positions().into_iter().chain(system.velocities()).chain(parameters.iter().copied()));
        let mut values = system.parameter_values();
        values.retain(|symbol, _| !parameters.contains(symbol));
        let kept = if equations.creeps { &[][..] } else { &system.constraints };
        let constraints = Evaluator::new(system.graph.compile(&inputs, kept, &values)?);
        let inputs = vec![Bounded::from_f64(0.0); inputs.len()];
        let (start, sizes, unseen) = Default::default();
        let names = equations.invariants.iter().map(|invariant| invariant.name.clone()).collect();
        let units = system.coordinates.iter().map(|c| c.unit.clone()).collect();
        let expected = system.watched.iter().filter(|watched| watched.constancy == Constancy::Expected);
        let expected = expected.map(|watched| watched.name.clone()).collect();
        Ok(InvariantMonitor { constraints, inputs, units, names, expected, breaches: Vec::new(), unseen, start, sizes })
    }

    /// A motion begins, with these values of the parameters that vary.
    fn begin(&mut self, t: f64, start: &Outputs, parameters: &[f64]) {
        let first = self.inputs.len() - parameters.len();
        self.inputs[first..].iter_mut().zip(parameters).for_each(|(x, &value)| *x = Bounded::from_f64(value));
        self.put(t, start);
        let residuals = self.constraints.evaluate(&self.inputs).iter().map(|f| f.value.abs()).collect();
        self.start = (residuals, start.invariants.clone());
        self.breaches.clear();
        self.forget_sizes();
    }

    fn forget_sizes(&mut self) {
        self.sizes = self.start.1.iter().map(|x| x.abs()).collect();
    }

    /// The doubt that begins where the scene's own constraints, or what has to be constant, are off by more
    /// than the error, in a motion with these outputs at these times, the first of them at its start, and
    /// these values of the parameters that vary. Only what exceeds round-off is compared with the looser run;
    /// what cannot be read off is another matter. [`InvariantMonitor::breaches`] are noted.
    pub(crate) fn doubt(
        &mut self,
        runs: &mut dyn TwoRuns,
        kept: &[(f64, Outputs)],
        parameters: &[f64],
    ) -> Option<Doubt> {
        let (t, start) = kept.first()?;
        let mut from = *t;
        self.begin(from, start, parameters);
        let mut clear = true;
        for (t, kept) in kept {
            self.put(*t, kept);
            let holds = self.constraints.evaluate(&self.inputs).iter().all(|f| f.may_be_zero() || !f.is_finite());
            clear &= holds && self.are_constant(runs, *t, kept);
        }
        let mut errors = Errors::default();
        // what terms grow to later is no round-off before
        let largest = self.sizes.clone();
        self.forget_sizes();
        for (t, kept) in kept.iter().filter(|_| !clear) {
            errors.add([kept, &runs.looser(*t).ok()?]);
            if let Some(because) = self.complaint(runs, *t, kept, &errors) {
                return Some(Doubt { from, because });
            }
            from = *t;
        }
        let unseen = largest.iter().enumerate().map(|(i, size)| {
            let error = errors.0.invariants.get(i).copied().unwrap_or(0.0);
            (self.names[i].clone(), error + ROUND_OFF * size)
        });
        self.unseen = unseen.filter(|(name, _)| self.expected.contains(name)).collect();
        None
    }

    fn are_constant(&mut self, runs: &mut dyn TwoRuns, t: f64, kept: &Outputs) -> bool {
        if self.is_constant(kept) {
            return true;
        }
        let sizes = runs.sizes();
        let terms = runs.states(t).and_then(|y| terms_of_invariants(runs.compiled(), t, &y, &sizes));
        let Some(terms) = terms else { return true };
        self.sizes.iter_mut().zip(terms).for_each(|(size, terms)| *size = size.max(terms));
        self.is_constant(kept)
    }

    fn is_constant(&self, kept: &Outputs) -> bool {
        let drifts = subtract(&kept.invariants, &self.start.1);
        drifts.iter().zip(&self.sizes).all(|(drift, size)| drift.abs() <= ROUND_OFF * size)
    }

    /// A message on the first quantity that is off by more than its error.
    fn complaint(&mut self, runs: &mut dyn TwoRuns, t: f64, kept: &Outputs, errors: &Errors) -> Option<String> {
        self.put(t, kept);
        if let Some(broken) = self.broken(t, errors) {
            return Some(broken);
        }
        if self.are_constant(runs, t, kept) {
            return None;
        }
        let changes = self.changes(t, kept, errors).into_iter();
        let (expected, certain): (Vec<_>, Vec<_>) = changes.partition(|change| self.expected.contains(&change.name));
        self.note(expected);
        certain.first().map(ToString::to_string)
    }

    fn broken(&mut self, t: f64, Errors(errors): &Errors) -> Option<String> {
        let residuals = self.constraints.evaluate(&self.inputs).to_vec();
        let mut estimates = vec![0.0_f64; residuals.len()];
        let n = errors.coordinates.len();
        // what should be zero is known to the last digits of the largest one in its unit
        let digits = |i: usize| {
            let alike = (0..n).filter(|&j| self.units[j] == self.units[i % n]);
            let largest = alike.map(|j| self.inputs[1 + i - i % n + j].value.abs()).fold(0.0, f64::max);
            UNITS * f64::EPSILON * largest
        };
        let digits: Vec<f64> = (0..2 * n).map(digits).collect();
        for (i, error) in errors.coordinates.iter().chain(&errors.velocities).enumerate() {
            let here = self.inputs[1 + i];
            self.inputs[1 + i] = Bounded::from_f64(here.value + error.max(digits[i]));
            let there = self.constraints.evaluate(&self.inputs);
            let changes = there.iter().zip(&residuals).map(|(a, b)| (a.value - b.value).abs());
            estimates.iter_mut().zip(changes).for_each(|(estimate, change)| *estimate += change);
            self.inputs[1 + i] = here;
        }
        let over = |(i, f): (usize, &Bounded)| {
            let estimate = estimates[i] + self.start.0[i] + f.round_off();
            let (size, constraint) = (f.value.abs(), i + 1);
            (ask(size, Some(estimate)) == Answer::Apart).then(|| {
                format!("constraint {constraint} does not hold: it is {size:.1e} at t = {}, with an error estimate of {estimate:.1e}", precise(t))
            })
        };
        residuals.iter().enumerate().find_map(over)
    }

    /// Keeps what the user expects to be constant and has changed, once.
    fn note(&mut self, changes: Vec<Breach>) {
        for breach in changes {
            match self.breaches.iter_mut().find(|known| known.name == breach.name) {
                Some(known) => known.largest = known.largest.max(breach.largest),
                None => self.breaches.push(breach),
            }
        }
    }

    /// The changes that are certain at `t`.
    fn changes(&self, t: f64, kept: &Outputs, Errors(errors): &Errors) -> Vec<Breach> {
        let changes = subtract(&kept.invariants, &self.start.1).into_iter().map(f64::abs).enumerate();
        let certain = changes.filter_map(|(i, change)| {
            let estimate = errors.invariants[i] + ROUND_OFF * self.sizes[i];
            let name = self.names[i].clone();
            let found = Breach { name, t, change, estimate, largest: change };
            (ask(change, Some(estimate)) == Answer::Apart).then_some(found)
        });
        certain.collect()
    }

    fn put(&mut self, t: f64, at: &Outputs) {
        let values = std::iter::once(&t).chain(&at.coordinates).chain(&at.velocities);
        self.inputs.iter_mut().zip(values).for_each(|(x, &value)| *x = Bounded::from_f64(value));
    }
}
