//! What a long run loses.

use crate::newton::largest;
use crate::{Discrete, DiscreteError};

/// What became of the energy and of the constraints over a long run.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Steps taken; fewer than asked for where `stop` says why.
    pub steps: usize,
    /// `E₀ = v·p − 𝓛` at the start.
    pub energy_start: f64,
    /// Largest `|v·p|` on the way: what an energy error is compared with.
    pub energy_size: f64,
    /// `E − E₀` at the nodes, over equally long parts of the run, in their order.
    pub energy: Vec<Spread>,
    /// Largest `|f_i|` at the nodes, over the same parts, in the constraints' own units.
    pub constraint: Vec<f64>,
    /// Largest `|f_i|` on the intervals of the whole run, at midpoints with difference quotients.
    pub discrete_constraint: f64,
    /// Why it ended before its time.
    pub stop: Option<DiscreteError>,
}

/// Least, mean and greatest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Least.
    pub least: f64,
    /// Mean.
    pub mean: f64,
    /// Greatest.
    pub greatest: f64,
}

impl Spread {
    /// The larger of `|least|` and `|greatest|`.
    pub fn largest(&self) -> f64 {
        self.least.abs().max(self.greatest.abs())
    }
}

impl Drift {
    /// Largest `|E − E₀|` over the run, relative to `energy_size`.
    pub fn relative_energy(&self) -> f64 {
        self.energy.iter().map(Spread::largest).fold(0.0, f64::max) / self.energy_size
    }

    /// Spread of the parts' mean energies over `energy_size`: the drift in the energy error, not oscillation.
    pub fn relative_trend(&self) -> f64 {
        let means = self.energy.iter().map(|part| part.mean);
        let (low, high) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), e| (a.min(e), b.max(e)));
        (high - low) / self.energy_size
    }

    /// Largest `|f_i|` at the nodes over the whole run.
    pub fn largest_constraint(&self) -> f64 {
        largest(&self.constraint)
    }
}

impl Discrete {
    /// Marches `steps` equal steps, keeping nothing but the drift over `parts` equal parts of the run.
    ///
    /// # Errors
    /// As [`Discrete::trajectory`], and [`DiscreteError::TooFew`] for fewer steps than parts.
    pub fn drift(&self, steps: usize, parts: usize) -> Result<Drift, DiscreteError> {
        for (what, found, limit) in [("the number of parts", parts, 1), ("the number of steps", steps, parts)] {
            if found < limit {
                return Err(DiscreteError::TooFew { what, found, limit });
            }
        }
        let mut discrete = self.clone();
        let start = discrete.first_node(steps)?;
        let reacts = discrete.step.reacts;
        let mut drift = Drift {
            steps: 0,
            energy_start: discrete.sample(start.clone())?.energy,
            energy_size: 0.0,
            energy: Vec::with_capacity(parts),
            constraint: Vec::with_capacity(parts),
            discrete_constraint: 0.0,
            stop: None,
        };
        let (mut visited, mut part, mut count) = (0_usize, usize::MAX, 0.0);
        let mut read = start.clone();
        let stop = discrete.march(start, steps, |step, node| {
            read.clone_from(node);
            if !reacts {
                step.read(&mut read, 1.0)?;
            }
            let readings = step.readings(&read);
            let (error, constraint) = (readings[0] - drift.energy_start, largest(&readings[1..]));
            let power: f64 = read.v.iter().zip(&read.p.value).map(|(v, p)| v * p).sum();
            let now = (visited.saturating_sub(1) * parts / steps).min(parts - 1);
            if now != part {
                (part, count) = (now, 0.0);
                drift.energy.push(Spread { least: error, mean: 0.0, greatest: error });
                drift.constraint.push(0.0);
            }
            count += 1.0;
            let energy = &mut drift.energy[part];
            energy.least = energy.least.min(error);
            energy.greatest = energy.greatest.max(error);
            energy.mean += (error - energy.mean) / count;
            drift.constraint[part] = drift.constraint[part].max(constraint);
            drift.energy_size = drift.energy_size.max(power.abs());
            if visited > 0 {
                drift.discrete_constraint = drift.discrete_constraint.max(largest(step.discrete_conditions()));
            }
            drift.steps = visited;
            visited += 1;
            Ok(())
        });
        drift.stop = stop.err();
        Ok(drift)
    }
}
