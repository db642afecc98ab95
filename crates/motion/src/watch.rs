//! Checks along a motion that do not depend on its derivation: the scene's own constraints, and quantities
//! listed as constant. `f` is compiled from the scene alone, so a term that a derivation lost shows here.

use std::fmt::{self, Display, Formatter};

use equations::{Compiled, Equations, Named, Outputs};
use mechanics::{Constancy, System};
use symbolic::{Bounded, CompileError, Evaluator, Scalar, Symbol};

use crate::Doubt;
use crate::last_digits::terms_of_invariants;
use crate::metric::{larger, subtract};
use crate::settings::CERTAINTY;
use crate::trajectory::Trajectory;

/// A drift under this part of the terms of an invariant is round-off.
const ROUND_OFF: f64 = 1e-11;

/// Round-off of a coordinate or velocity that should be zero, over the largest one in its unit.
const DIGITS: f64 = 1e-15;

/// Returns the sum of terms behind each invariant.
pub(crate) type Terms<'a> = &'a mut dyn FnMut() -> Option<Vec<f64>>;

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

impl Display for Breach {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Breach { name, t, change, estimate, .. } = self;
        write!(
            f,
            "{name} is not constant: it has changed by {change:.1e} at t = {t:.6}, with an error estimate of {estimate:.1e}"
        )
    }
}

/// Holds `f = 0` and the invariants against the error estimate.
#[derive(Clone)]
pub(crate) struct Watch {
    /// `f(t, q, v)` and parameters that vary; nothing where constraints creep.
    constraints: Evaluator<Bounded>,
    inputs: Vec<Bounded>,
    /// Units of the coordinates.
    units: Vec<String>,
    /// Names of what the user expects to be constant, and what was found to change since the motion began.
    expected: Vec<String>,
    pub(crate) breaches: Vec<Breach>,
    /// `|f|` and the invariants at the start.
    start: (Vec<f64>, Vec<f64>),
    /// The sum of terms behind each invariant, where it is known to exceed its value.
    sizes: Vec<f64>,
    /// Largest differences of the two runs so far: of `(q, v)`, and of the invariants.
    differences: (Vec<f64>, Vec<f64>),
}

impl Watch {
    /// For a motion by `equations` of a system with these varying parameters.
    pub(crate) fn new(system: &System, equations: &Equations, parameters: &[Symbol]) -> Result<Watch, CompileError> {
        let mut inputs = vec![system.time];
        inputs.extend(system.positions().into_iter().chain(system.velocities()).chain(parameters.iter().copied()));
        let mut values = system.parameter_values();
        values.retain(|symbol, _| !parameters.contains(symbol));
        let kept = if equations.creeps { &[][..] } else { &system.constraints };
        let constraints = Evaluator::new(system.graph.compile(&inputs, kept, &values)?);
        let inputs = vec![Bounded::from_f64(0.0); inputs.len()];
        let (start, sizes, differences) = Default::default();
        let units = system.coordinates.iter().map(|c| c.unit.clone()).collect();
        let expected = system.watched.iter().filter(|watched| watched.constancy == Constancy::Expected);
        let expected = expected.map(|watched| watched.name.clone()).collect();
        Ok(Watch { constraints, inputs, units, expected, breaches: Vec::new(), start, sizes, differences })
    }

    /// A motion begins, with these values of the parameters that vary.
    pub(crate) fn begin(&mut self, t: f64, start: &Outputs, parameters: &[f64]) {
        let first = self.inputs.len() - parameters.len();
        self.inputs[first..].iter_mut().zip(parameters).for_each(|(x, &value)| *x = Bounded::from_f64(value));
        self.put(t, start);
        let residuals = self.constraints.evaluate(&self.inputs).iter().map(|f| f.value.abs()).collect();
        self.start = (residuals, start.invariants.clone());
        self.breaches.clear();
        self.sizes = start.invariants.iter().map(|x| x.abs()).collect();
        self.differences = (vec![0.0; 2 * start.coordinates.len()], vec![0.0; start.invariants.len()]);
    }

    /// Whether nothing is off by more than round-off: no error estimate is needed.
    pub(crate) fn is_clear(&mut self, t: f64, kept: &Outputs, terms: Terms) -> bool {
        self.put(t, kept);
        let hold = self.constraints.evaluate(&self.inputs).iter().all(|f| f.may_be_zero() || !f.is_finite());
        hold && self.are_constant(kept, terms)
    }

    /// The doubt that begins where the scene's own constraints, or what has to be constant, are off by more
    /// than the error estimate, in a motion with these outputs at these times. What cannot be read off is
    /// another matter. [`Watch::breaches`] are noted.
    pub(crate) fn doubt(
        &mut self,
        (times, kept): (&[f64], &[Outputs]),
        [run, looser]: [&mut Trajectory; 2],
        compiled: &mut Compiled,
        invariants: &[Named],
    ) -> Option<Doubt> {
        self.begin(times[0], kept.first()?, &[]);
        let mut terms = |compiled: &mut Compiled, t: f64| {
            let state = run.state(compiled, t).ok()?;
            terms_of_invariants(compiled, t, &state, run.sizes())
        };
        let mut clear = true;
        for (&t, kept) in times.iter().zip(kept) {
            clear &= self.is_clear(t, kept, &mut || terms(compiled, t));
        }
        let mut from = times[0];
        for (&t, kept) in times.iter().zip(kept).filter(|_| !clear) {
            let looser = looser.outputs(compiled, t).ok()?;
            if let Some(because) = self.complaint(t, [kept, &looser], invariants, &mut || terms(compiled, t)) {
                return Some(Doubt { from, because });
            }
            from = t;
        }
        None
    }

    fn are_constant(&mut self, kept: &Outputs, terms: Terms) -> bool {
        if self.is_constant(kept) {
            return true;
        }
        let Some(terms) = terms() else { return true };
        self.sizes.iter_mut().zip(terms).for_each(|(size, terms)| *size = size.max(terms));
        self.is_constant(kept)
    }

    fn is_constant(&self, kept: &Outputs) -> bool {
        let drifts = subtract(&kept.invariants, &self.start.1);
        drifts.iter().zip(&self.sizes).all(|(drift, size)| drift.abs() <= ROUND_OFF * size)
    }

    /// A message on the first quantity whose drift exceeds the difference of the two runs up to `t`.
    pub(crate) fn complaint(
        &mut self,
        t: f64,
        [kept, looser]: [&Outputs; 2],
        invariants: &[Named],
        terms: Terms,
    ) -> Option<String> {
        let place = subtract(&kept.coordinates, &looser.coordinates);
        let differences = place.into_iter().chain(subtract(&kept.velocities, &looser.velocities));
        self.differences.0.iter_mut().zip(differences).for_each(|(d, now)| *d = larger(*d, now.abs()));
        let differences = subtract(&kept.invariants, &looser.invariants);
        self.differences.1.iter_mut().zip(differences).for_each(|(d, now)| *d = larger(*d, now.abs()));
        self.put(t, kept);
        if let Some(broken) = self.broken(t) {
            return Some(broken);
        }
        if self.are_constant(kept, terms) {
            return None;
        }
        let changes = self.changes(t, kept, invariants).into_iter();
        let (expected, certain): (Vec<_>, Vec<_>) = changes.partition(|change| self.expected.contains(&change.name));
        self.note(expected);
        certain.first().map(ToString::to_string)
    }

    fn broken(&mut self, t: f64) -> Option<String> {
        let residuals = self.constraints.evaluate(&self.inputs).to_vec();
        let mut estimates = vec![0.0_f64; residuals.len()];
        let n = self.differences.0.len() / 2;
        let largest = |i: usize| {
            let alike = (0..n).filter(|&j| self.units[j] == self.units[i % n]);
            alike.map(|j| self.inputs[1 + i - i % n + j].value.abs()).fold(0.0, f64::max)
        };
        let digits: Vec<f64> = (0..2 * n).map(|i| DIGITS * largest(i)).collect();
        for (i, d) in self.differences.0.iter().enumerate() {
            let here = self.inputs[1 + i];
            self.inputs[1 + i] = Bounded::from_f64(here.value + d.max(digits[i]));
            let there = self.constraints.evaluate(&self.inputs);
            let changes = there.iter().zip(&residuals).map(|(a, b)| (a.value - b.value).abs());
            estimates.iter_mut().zip(changes).for_each(|(estimate, change)| *estimate += change);
            self.inputs[1 + i] = here;
        }
        let over = |(i, f): (usize, &Bounded)| {
            let estimate = estimates[i] + self.start.0[i] + f.round_off();
            let (size, constraint) = (f.value.abs(), i + 1);
            (size > CERTAINTY * estimate).then(|| {
                format!("constraint {constraint} does not hold: it is {size:.1e} at t = {t:.6}, with an error estimate of {estimate:.1e}")
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
    fn changes(&self, t: f64, kept: &Outputs, invariants: &[Named]) -> Vec<Breach> {
        let changes = subtract(&kept.invariants, &self.start.1).into_iter().map(f64::abs).enumerate();
        let certain = changes.filter_map(|(i, change)| {
            let estimate = self.differences.1[i] + ROUND_OFF * self.sizes[i];
            let name = invariants[i].name.clone();
            (change > CERTAINTY * estimate).then_some(Breach { name, t, change, estimate, largest: change })
        });
        certain.collect()
    }

    fn put(&mut self, t: f64, at: &Outputs) {
        let values = std::iter::once(&t).chain(&at.coordinates).chain(&at.velocities);
        self.inputs.iter_mut().zip(values).for_each(|(x, &value)| *x = Bounded::from_f64(value));
    }
}
