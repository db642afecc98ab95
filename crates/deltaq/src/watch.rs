//! What has to hold along a motion whatever was derived: the scene's own constraints, and what is listed as
//! constant. `f` is compiled from the scene alone, so a term that a derivation lost shows here.

use equations::{Named, Outputs};
use mechanics::System;
use symbolic::{Bounded, CompileError, Evaluator, Scalar, Symbol};

use crate::gap::CERTAINTY;
use crate::metric::subtract;
use crate::single_run::UNITS;

/// A drift under this part of the terms of an invariant is round-off.
const ROUND_OFF: f64 = 1e-11;

/// Holds `f = 0` and the invariants against the error estimate.
#[derive(Clone)]
pub(crate) struct Watch {
    /// `f(t, q, v)` and parameters that vary.
    constraints: Evaluator<Bounded>,
    inputs: Vec<Bounded>,
    /// `|f|` and the invariants at the start.
    start: (Vec<f64>, Vec<f64>),
    /// Largest differences of the two runs so far: of `(q, v)`, and of the invariants.
    differences: (Vec<f64>, Vec<f64>),
}

impl Watch {
    /// Of a system of which these parameters vary.
    pub(crate) fn new(system: &System, parameters: &[Symbol]) -> Result<Watch, CompileError> {
        let mut inputs = vec![system.time];
        inputs.extend(system.positions().into_iter().chain(system.velocities()).chain(parameters.iter().copied()));
        let mut values = system.parameter_values();
        values.retain(|symbol, _| !parameters.contains(symbol));
        let constraints = Evaluator::new(system.graph.compile(&inputs, &system.constraints, &values)?);
        let inputs = vec![Bounded::from_f64(0.0); inputs.len()];
        Ok(Watch { constraints, inputs, start: Default::default(), differences: Default::default() })
    }

    /// A motion begins, with these values of the parameters that vary.
    pub(crate) fn begin(&mut self, t: f64, start: &Outputs, parameters: &[f64]) {
        let first = self.inputs.len() - parameters.len();
        self.inputs[first..].iter_mut().zip(parameters).for_each(|(x, &value)| *x = Bounded::from_f64(value));
        self.put(t, start);
        let residuals = self.constraints.evaluate(&self.inputs).iter().map(|f| f.value.abs()).collect();
        self.start = (residuals, start.invariants.clone());
        self.differences = (vec![0.0; 2 * start.coordinates.len()], vec![0.0; start.invariants.len()]);
    }

    /// Whether nothing is off by more than round-off: no error estimate is needed.
    pub(crate) fn is_clear(&mut self, t: f64, kept: &Outputs) -> bool {
        self.put(t, kept);
        let holds = |f: &Bounded| f.may_be_zero() || !f.is_finite();
        let constant = |(now, then): (&f64, &f64)| (now - then).abs() <= ROUND_OFF * then.abs();
        self.constraints.evaluate(&self.inputs).iter().all(holds)
            && kept.invariants.iter().zip(&self.start.1).all(constant)
    }

    /// What is off by more than the two runs, at `t` and before, leave open. `moved` gives the invariants with
    /// the last digits of the state changed.
    pub(crate) fn complaint(
        &mut self,
        t: f64,
        [kept, looser]: [&Outputs; 2],
        invariants: &[Named],
        moved: &mut dyn FnMut() -> Option<Vec<f64>>,
    ) -> Option<String> {
        let place = subtract(&kept.coordinates, &looser.coordinates);
        let differences = place.into_iter().chain(subtract(&kept.velocities, &looser.velocities));
        self.differences.0.iter_mut().zip(differences).for_each(|(d, now)| *d = d.max(now.abs()));
        let differences = subtract(&kept.invariants, &looser.invariants);
        self.differences.1.iter_mut().zip(differences).for_each(|(d, now)| *d = d.max(now.abs()));
        if self.is_clear(t, kept) {
            return None;
        }
        self.broken(t).or_else(|| self.drifting(t, kept, invariants, moved))
    }

    fn broken(&mut self, t: f64) -> Option<String> {
        let residuals = self.constraints.evaluate(&self.inputs).to_vec();
        let mut estimates = vec![0.0_f64; residuals.len()];
        for (i, d) in self.differences.0.iter().enumerate() {
            let here = self.inputs[1 + i];
            self.inputs[1 + i] = Bounded::from_f64(here.value + d);
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

    fn drifting(
        &self,
        t: f64,
        kept: &Outputs,
        invariants: &[Named],
        moved: &mut dyn FnMut() -> Option<Vec<f64>>,
    ) -> Option<String> {
        let drifts = subtract(&kept.invariants, &self.start.1);
        let large = |i: usize| drifts[i].abs() > CERTAINTY * self.differences.1[i] + ROUND_OFF * self.start.1[i].abs();
        if !(0..drifts.len()).any(large) {
            return None;
        }
        let digits = moved()?;
        (0..drifts.len()).filter(|&i| large(i)).find_map(|i| {
            let terms = (digits[i] - kept.invariants[i]).abs() / (UNITS * f64::EPSILON);
            let estimate = self.differences.1[i] + ROUND_OFF * (terms + kept.invariants[i].abs());
            let (drift, name) = (drifts[i].abs(), &invariants[i].name);
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
