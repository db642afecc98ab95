//! Checks along a motion that do not depend on its derivation: the scene's own constraints, and quantities
//! listed as constant. `f` is compiled from the scene alone, so a term that a derivation lost shows here.

use equations::{Equations, Named, Outputs};
use mechanics::System;
use symbolic::{Bounded, CompileError, Evaluator, Scalar, Symbol};

use crate::metric::{larger, subtract};
use crate::settings::CERTAINTY;

/// A drift under this part of the terms of an invariant is round-off.
const ROUND_OFF: f64 = 1e-11;

/// Round-off of a coordinate or velocity that should be zero, over the largest one in its unit.
const DIGITS: f64 = 1e-15;

/// Returns the sum of terms behind each invariant.
pub(crate) type Terms<'a> = &'a mut dyn FnMut() -> Option<Vec<f64>>;

/// Holds `f = 0` and the invariants against the error estimate.
#[derive(Clone)]
pub(crate) struct Watch {
    /// `f(t, q, v)` and parameters that vary; nothing where constraints creep.
    constraints: Evaluator<Bounded>,
    inputs: Vec<Bounded>,
    /// Units of the coordinates.
    units: Vec<String>,
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
        Ok(Watch { constraints, inputs, units, start, sizes, differences })
    }

    /// A motion begins, with these values of the parameters that vary.
    pub(crate) fn begin(&mut self, t: f64, start: &Outputs, parameters: &[f64]) {
        let first = self.inputs.len() - parameters.len();
        self.inputs[first..].iter_mut().zip(parameters).for_each(|(x, &value)| *x = Bounded::from_f64(value));
        self.put(t, start);
        let residuals = self.constraints.evaluate(&self.inputs).iter().map(|f| f.value.abs()).collect();
        self.start = (residuals, start.invariants.clone());
        self.sizes = start.invariants.iter().map(|x| x.abs()).collect();
        self.differences = (vec![0.0; 2 * start.coordinates.len()], vec![0.0; start.invariants.len()]);
    }

    /// Whether nothing is off by more than round-off: no error estimate is needed.
    pub(crate) fn is_clear(&mut self, t: f64, kept: &Outputs, terms: Terms) -> bool {
        self.put(t, kept);
        let hold = self.constraints.evaluate(&self.inputs).iter().all(|f| f.may_be_zero() || !f.is_finite());
        hold && self.are_constant(kept, terms)
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
        let broken = self.broken(t);
        broken.or_else(|| if self.are_constant(kept, terms) { None } else { self.drifting(t, kept, invariants) })
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

    fn drifting(&self, t: f64, kept: &Outputs, invariants: &[Named]) -> Option<String> {
        let drifts = subtract(&kept.invariants, &self.start.1);
        drifts.iter().enumerate().find_map(|(i, drift)| {
            let estimate = self.differences.1[i] + ROUND_OFF * self.sizes[i];
            let (drift, name) = (drift.abs(), &invariants[i].name);
            (drift > CERTAINTY * estimate).then(|| {
                format!("{name} is not constant: it has changed by {drift:.1e} at t = {t:.6}, with an error estimate of {estimate:.1e}")
            })
        })
    }

    fn put(&mut self, t: f64, at: &Outputs) {
        let values = std::iter::once(&t).chain(&at.coordinates).chain(&at.velocities);
        self.inputs.iter_mut().zip(values).for_each(|(x, &value)| *x = Bounded::from_f64(value));
    }
}
