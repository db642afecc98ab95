//! A stored discrete motion, evaluated at any time.

use crate::step::Node;
use crate::sum::Compensated;
use crate::{Discrete, DiscreteError};

/// A part of a step that is too short to be a step of its own.
const SHORT: f64 = 1.0 / 16.0;

/// A discrete motion at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time.
    pub t: f64,
    /// `q`; for a removal `(u, w)`.
    pub x: Vec<f64>,
    /// `q̇`; for a removal `(u̇, ẇ)`. On the constraint to round-off.
    pub v: Vec<f64>,
    /// `μ`; for a removal `P`; for Chetaev the half `λ⁻` of the last step's reaction, `λ` to order 1 only.
    pub multipliers: Vec<f64>,
    /// `v·p − 𝓛`: the energy where constraints are homogeneous in the velocities.
    pub energy: f64,
}

/// A discrete motion with all its nodes, as far as it came.
#[derive(Clone, Debug)]
pub struct Trajectory {
    discrete: Discrete,
    h: f64,
    times: Vec<f64>,
    /// `x, p, v, ν`, node after node.
    rows: Vec<f64>,
    /// Why it ends before its time.
    pub stop: Option<DiscreteError>,
}

impl Discrete {
    /// The motion over `steps` equal steps; it ends where a step fails, and [`Trajectory::stop`] says why.
    ///
    /// ```
    /// use discrete::{Composition, Discrete};
    /// let scene = scene::Scene::parse("sledge", include_str!("../../scene/scenes/sledge.toml"))?;
    /// let discrete = Discrete::chetaev(&scene.system, &scene.start, 1.0)?.composed(Composition::Sixth);
    /// let mut trajectory = discrete.trajectory(40)?;
    /// let now = trajectory.at(0.777)?;
    /// assert!((now.v[0] * now.x[2].sin() - now.v[1] * now.x[2].cos()).abs() < 1e-15);
    /// assert!((now.x[2] - (0.3 + 1.1 * 0.777)).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`DiscreteError::NoSteps`]; those of a step where the first one cannot even begin.
    pub fn trajectory(&self, steps: usize) -> Result<Trajectory, DiscreteError> {
        self.trajectory_until(steps, |_, _| None)
    }

    /// [`Discrete::trajectory`], that also ends where `halt` of the time and the steps up to a node gives a
    /// reason, with [`DiscreteError::Halted`]; the last node is not asked of.
    ///
    /// # Errors
    /// As [`Discrete::trajectory`].
    pub fn trajectory_until(
        &self,
        steps: usize,
        mut halt: impl FnMut(f64, usize) -> Option<String>,
    ) -> Result<Trajectory, DiscreteError> {
        if steps == 0 {
            return Err(DiscreteError::NoSteps);
        }
        let mut discrete = self.clone();
        let (start, h) = (self.start.clone(), (self.end - self.start.t) / steps as f64);
        let (mut times, mut rows) = (Vec::with_capacity(steps + 1), Vec::new());
        let stop = discrete.march(start, steps, |_, node| {
            times.push(node.t);
            node.write(&mut rows);
            let taken = times.len() - 1;
            let reason = if taken < steps { halt(node.t, taken) } else { None };
            reason.map_or(Ok(()), |reason| Err(DiscreteError::Halted { reason }))
        });
        match stop {
            Err(error) if times.is_empty() => Err(error),
            stop => Ok(Trajectory { discrete, h, times, rows, stop: stop.err() }),
        }
    }
}

impl Trajectory {
    /// Times of the nodes, the start first.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The length of its steps, negative backwards.
    pub fn step(&self) -> f64 {
        self.h
    }

    /// The last time.
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The motion at `t`: at a node what stands there, else one step of the method from the node before, so
    /// of the same order. Just behind a node the step starts one node earlier: reactions over a very short
    /// step are round-off. Behind the start it goes back from the next node, whose error it has a part of:
    /// motions in steps of different lengths differ there as well. Outside, from the nearest node.
    ///
    /// # Errors
    /// Those of a step.
    pub fn at(&mut self, t: f64) -> Result<Sample, DiscreteError> {
        let before = |time: f64| if self.h >= 0.0 { time <= t } else { time >= t };
        let last = self.times.len() - 1;
        let k = self.times.partition_point(|&time| before(time)).saturating_sub(1);
        let near = |k: usize, share: f64| (t - self.times[k]).abs() <= share;
        let round_off = 4.0 * f64::EPSILON * self.times[0].abs().max(self.end().abs());
        if let Some(k) = [k, (k + 1).min(last)].into_iter().find(|&k| near(k, round_off)) {
            let node = self.node(k);
            return self.discrete.sample(node);
        }
        let from = if k == 0 {
            1.min(last)
        } else if near(k, SHORT * self.h.abs()) {
            k - 1
        } else {
            k
        };
        let mut node = self.node(from);
        self.discrete.step.forget();
        let h = t - node.t;
        self.discrete.composed_step(&mut node, h, t)?;
        self.discrete.sample(node)
    }

    fn node(&self, k: usize) -> Node {
        let length = self.rows.len() / self.times.len();
        let n = self.discrete.step.size;
        let row = &self.rows[k * length..(k + 1) * length];
        Node {
            t: self.times[k],
            x: Compensated::new(row[..n].to_vec()),
            p: Compensated::new(row[n..2 * n].to_vec()),
            v: row[2 * n..3 * n].to_vec(),
            multipliers: row[3 * n..].to_vec(),
        }
    }
}

impl Discrete {
    /// Reads a node off.
    pub(crate) fn sample(&mut self, mut node: Node) -> Result<Sample, DiscreteError> {
        let h = (self.end - self.start.t).signum();
        if !self.step.reacts {
            self.step.read(&mut node, h)?;
        }
        let energy = self.step.readings(&node)[0];
        Ok(Sample { t: node.t, x: node.x.value, v: node.v, multipliers: node.multipliers, energy })
    }
}
