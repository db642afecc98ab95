//! How large the states of a motion are, in whatever units they come.

use equations::{Compiled, Outputs};

use crate::Metric;
use crate::metric::subtract;

/// A state under this part of the size that the energy tells is round-off.
const NO_SIZE: f64 = 1e-14;
/// Euler's step is tried from the length of the run over `LONGER^TRIES` on, each `LONGER` times the one before.
const TRIES: i32 = 9;
const LONGER: f64 = 8.0;
/// States are moved by this part of their size to see what depends on them; those that tell none, by
/// `LEAST` and so much more each time until something does.
const MOVE: f64 = 1.0 / (1 << 20) as f64;
const LEAST: f64 = 1e-30;
const MOVES: usize = 11;
/// What changes by less than this part of it does not depend on what was moved.
const SEEN: f64 = 1.0 / (1 << 30) as f64;

/// The size of each state at `(t, y)`, by which an absolute tolerance is multiplied: how large it is there,
/// or becomes by its rate within the time `τ ≤ length` for which Euler's step is right. So it is in the
/// state's own unit, and a motion of 10⁻¹² m is resolved as well as one of 1 m.
///
/// What is zero or round-off has the size that changes the velocities, or the coordinates within `τ`, by what
/// the energy allows: `Δvᵀ|M|Δv = E`, `Δqᵀ|M|Δq = E τ²`, with `E = max(vᵀ|M|v, τ² v̇ᵀ|M|v̇)`; a state that
/// neither depends on, what changes those that have a size by it within `τ`. It is 1 where nothing does.
pub(crate) fn sizes(compiled: &mut Compiled, metric: &mut Metric, t: f64, y: &[f64], length: f64) -> Vec<f64> {
    let mut rates = vec![0.0; y.len()];
    let found = compiled.rates(t, y, &mut rates).and_then(|()| compiled.outputs(t, y));
    let Ok(here) = found else { return vec![1.0; y.len()] };
    let mut probe = Probe { compiled, metric, t, y, rates, here };
    let of_energy = probe.of_energy(length);
    let is_own = |probe: &Probe, i: usize, time: f64, size: f64| {
        let reach = probe.reach(i, time);
        reach > 0.0 && reach > NO_SIZE * size
    };
    let own: Vec<bool> = of_energy.iter().enumerate().map(|(i, size)| is_own(&probe, i, length, *size)).collect();
    let time = probe.time(length, &own);
    let of_energy = if own.iter().all(|own| *own) { vec![0.0; y.len()] } else { probe.of_energy(time) };
    let size = |(i, of_energy): (usize, f64)| {
        let size = if is_own(&probe, i, time, of_energy) { probe.reach(i, time) } else { of_energy };
        if size > 0.0 && size.is_finite() { size } else { 1.0 }
    };
    of_energy.into_iter().enumerate().map(size).collect()
}

/// A start, and what is near it.
struct Probe<'a> {
    compiled: &'a mut Compiled,
    metric: &'a mut Metric,
    t: f64,
    y: &'a [f64],
    rates: Vec<f64>,
    here: Outputs,
}

impl Probe<'_> {
    /// How large a state is or becomes within a time.
    fn reach(&self, i: usize, time: f64) -> f64 {
        self.y[i].abs().max((self.rates[i] * time).abs())
    }

    /// For how long Euler's step is right to the sizes that it has itself, in the states that have `own` ones.
    fn time(&mut self, length: f64, own: &[bool]) -> f64 {
        let mut step = length * LONGER.powi(-TRIES);
        for _ in 0..TRIES {
            let longer = step * LONGER;
            let there = self.later(longer);
            let Some(there) = self.rates_at(self.t + longer, &there) else { break };
            let is_right = |i: usize| ((there[i] - self.rates[i]) * longer).abs() <= self.reach(i, longer);
            if !(0..self.y.len()).filter(|&i| own[i]).all(is_right) {
                break;
            }
            step = longer;
        }
        step
    }

    /// The sizes that the energy tells; 0 where it tells none.
    fn of_energy(&mut self, time: f64) -> Vec<f64> {
        let speed = self.speed(time);
        let mut sizes = vec![0.0; self.y.len()];
        if !(speed > 0.0 && speed.is_finite()) {
            return sizes;
        }
        for j in 0..sizes.len() {
            sizes[j] = self.moved(j, time, &mut |probe, y| probe.share(y, speed, time)).unwrap_or(0.0);
        }
        // what velocities and coordinates do not depend on, by those rates that do
        while let Some(found) = self.behind(&sizes, time) {
            sizes = found;
        }
        sizes
    }

    /// The larger of the speed and of what the forces make of it.
    fn speed(&mut self, time: f64) -> f64 {
        let step = MOVE * time;
        let later = self.later(step);
        let there = self.compiled.outputs(self.t + step, &later);
        let change = there.map_or(0.0, |there| self.length(&subtract(&there.velocities, &self.here.velocities)));
        let speed = self.length(&self.here.velocities.clone());
        speed.max(Some(change / MOVE).filter(|x| x.is_finite()).unwrap_or(0.0))
    }

    /// Which part of the energy it takes to come to `y`: 1 for all of it; `None` if nothing is seen to move.
    fn share(&mut self, y: &[f64], speed: f64, time: f64) -> Option<f64> {
        let there = self.compiled.outputs(self.t, y).ok()?;
        let place = seen(&there.coordinates, &self.here.coordinates);
        let velocity = seen(&there.velocities, &self.here.velocities);
        let place = self.length(&place) / (speed * time.abs());
        let part = if place > 0.0 { place } else { self.length(&velocity) / speed };
        (part > 0.0 && part.is_finite()).then_some(part)
    }

    /// The sizes with those that rates of sized states tell; `None` if there are no more.
    fn behind(&mut self, sizes: &[f64], time: f64) -> Option<Vec<f64>> {
        let mut found = sizes.to_vec();
        for j in (0..sizes.len()).filter(|&j| sizes[j] == 0.0) {
            let mut share = |probe: &mut Self, y: &[f64]| {
                let there = probe.rates_at(probe.t, y)?;
                let changes = seen(&there, &probe.rates);
                let parts = changes.iter().zip(sizes).filter(|(_, size)| **size > 0.0);
                let part = parts.map(|(change, size)| (change * time / size).abs()).fold(0.0, f64::max);
                (part > 0.0 && part.is_finite()).then_some(part)
            };
            found[j] = self.moved(j, time, &mut share).unwrap_or(0.0);
        }
        (found != sizes).then_some(found)
    }

    /// By how much a state would have to move for a share of 1.
    fn moved(&mut self, j: usize, time: f64, share: &mut dyn FnMut(&mut Self, &[f64]) -> Option<f64>) -> Option<f64> {
        let reach = self.reach(j, time);
        let mut step = if reach > 0.0 && reach.is_finite() { MOVE * reach } else { LEAST };
        for _ in 0..MOVES {
            let mut y = self.y.to_vec();
            y[j] += step;
            if let Some(part) = share(self, &y) {
                return Some((y[j] - self.y[j]) / part);
            }
            step /= MOVE;
        }
        None
    }

    fn later(&self, step: f64) -> Vec<f64> {
        self.y.iter().zip(&self.rates).map(|(y, f)| y + step * f).collect()
    }

    fn length(&mut self, difference: &[f64]) -> f64 {
        let (q, v) = (self.here.coordinates.clone(), self.here.velocities.clone());
        self.metric.length(self.t, &q, &v, difference)
    }

    fn rates_at(&mut self, t: f64, y: &[f64]) -> Option<Vec<f64>> {
        let mut rates = vec![0.0; y.len()];
        self.compiled.rates(t, y, &mut rates).ok()?;
        rates.iter().all(|x| x.is_finite()).then_some(rates)
    }
}

/// The differences that are more than round-off.
fn seen(there: &[f64], here: &[f64]) -> Vec<f64> {
    let is_seen = |(there, here): (&f64, &f64)| Some(there - here).filter(|d| d.abs() > SEEN * here.abs());
    there.iter().zip(here).map(|pair| is_seen(pair).unwrap_or(0.0)).collect()
}
