//! Sizes of the states of a motion, independent of units.

use equations::{Compiled, Outputs};

use crate::Metric;
use crate::band::limits::{CERTAINTY, ROUND_OFF, UNITS};
use crate::band::ulp_perturbation::signs;
use crate::metric::subtract;
use symbolic::limits::NOTHING;

/// Sizes are limited to 1, or to this fraction of the size from the energy if that is larger: runs may be
/// long. This fraction of the speed that a constant acceleration gives within the run counts as speed.
const LARGE: f64 = 1e-5;
/// States are displaced by this fraction of their size to see what depends on them; states without a size, by
/// `LEAST` and then by larger and larger amounts, to its inverse, until something does.
const MOVE: f64 = 1.0 / (1 << 20) as f64;
const LEAST: f64 = 1e-30;

/// The size of each state at `(t, y)`, by which an absolute tolerance is multiplied: how large it is there,
/// or becomes by its rate within the length of the run; at most 1, or where numbers are large at most 10⁻⁵
/// of what follows. So a motion of 10⁻¹² m is resolved as well as one of 1 m.
///
/// What is zero or round-off has the size that changes a coordinate by as much as the energy allows it within
/// the length `T`, `|M_ii| Δqᵢ² = E T²` with `E = max(vᵀ|M|v, (10⁻⁵ T)² v̇ᵀ|M|v̇)`, or as the largest one
/// in its unit moves, if that is less; or else a velocity, `Δqᵢ/T`. A state that neither depends on has the
/// size that the others give it within `T`; or else the one that changes theirs by as much; 1 where nothing
/// does.
pub fn sizes(compiled: &mut Compiled, metric: &mut Metric, t: f64, y: &[f64], length: f64) -> Vec<f64> {
    let size = |(whole, of_energy): (f64, f64)| or_one(whole.min((LARGE * of_energy).max(1.0)));
    whole_sizes(compiled, metric, t, y, length).into_iter().map(size).collect()
}

/// The same of states that may be large as well.
pub fn unbounded_sizes(compiled: &mut Compiled, metric: &mut Metric, t: f64, y: &[f64], length: f64) -> Vec<f64> {
    whole_sizes(compiled, metric, t, y, length).into_iter().map(|(whole, _)| or_one(whole)).collect()
}

fn or_one(size: f64) -> f64 {
    if size > 0.0 && size.is_finite() { size } else { 1.0 }
}

/// The size of each state, 0 where nothing tells one, and what the energy says of it.
fn whole_sizes(compiled: &mut Compiled, metric: &mut Metric, t: f64, y: &[f64], length: f64) -> Vec<(f64, f64)> {
    let mut rates = vec![0.0; y.len()];
    let found = compiled.rates(t, y, &mut rates).and_then(|()| compiled.outputs(t, y));
    let Ok(here) = found else { return vec![(1.0, 1.0); y.len()] };
    let noise = Noise::of(compiled, t, y, &rates, &here);
    rates.iter_mut().zip(&noise.rates).filter(|(rate, noise)| rate.abs() <= **noise).for_each(|(rate, _)| *rate = 0.0);
    let mut probe = Probe { compiled, metric, t, y, rates, here, noise };
    // less than round-off of the size from the energy is none
    let size =
        |(reach, of_energy): (f64, f64)| (if reach > ROUND_OFF * of_energy { reach } else { of_energy }, of_energy);
    let of_energy = probe.of_energy(length);
    (0..y.len()).map(|i| probe.reach(i, length)).zip(of_energy).map(size).collect()
}

/// A start, and what is near it.
struct Probe<'a> {
    compiled: &'a mut Compiled,
    metric: &'a mut Metric,
    t: f64,
    y: &'a [f64],
    rates: Vec<f64>,
    here: Outputs,
    noise: Noise,
}

/// What round-off of the states makes of what is computed from them: a difference under it says nothing.
struct Noise {
    rates: Vec<f64>,
    coordinates: Vec<f64>,
    velocities: Vec<f64>,
}

impl Noise {
    /// The largest change under states moved by some units of their last digit, up or down.
    fn of(compiled: &mut Compiled, t: f64, y: &[f64], rates: &[f64], here: &Outputs) -> Noise {
        let none = |x: &[f64]| vec![0.0; x.len()];
        let (coordinates, velocities) = (none(&here.coordinates), none(&here.velocities));
        let mut noise = Noise { rates: none(rates), coordinates, velocities };
        let join = |noise: &mut [f64], there: &[f64], here: &[f64]| {
            let changes = there.iter().zip(here).map(|(there, here)| UNITS * (there - here).abs());
            noise.iter_mut().zip(changes).for_each(|(noise, change)| *noise = noise.max(change));
        };
        for pattern in 0..3 {
            let signs = signs().skip(pattern * y.len());
            let moved: Vec<f64> = y.iter().zip(signs).map(|(y, sign)| y + sign * 2.0 * f64::EPSILON * y).collect();
            let mut there = none(rates);
            if compiled.rates(t, &moved, &mut there).is_ok() {
                join(&mut noise.rates, &there, rates);
            }
            if let Ok(there) = compiled.outputs(t, &moved) {
                join(&mut noise.coordinates, &there.coordinates, &here.coordinates);
                join(&mut noise.velocities, &there.velocities, &here.velocities);
            }
        }
        noise
    }
}

impl Probe<'_> {
    /// Size of a state now, or by its rate within a time.
    fn reach(&self, i: usize, time: f64) -> f64 {
        self.y[i].abs().max((self.rates[i] * time).abs())
    }

    /// The sizes that follow from the energy; 0 where none does.
    fn of_energy(&mut self, time: f64) -> Vec<f64> {
        let (place, velocity) = self.likely(time.abs());
        let mut share = |probe: &mut Self, y: &[f64]| {
            let there = probe.compiled.outputs(probe.t, y).ok()?;
            let places =
                largest_part(&seen(&there.coordinates, &probe.here.coordinates, &probe.noise.coordinates), &place);
            places.or_else(|| {
                largest_part(&seen(&there.velocities, &probe.here.velocities, &probe.noise.velocities), &velocity)
            })
        };
        let moved = (0..self.y.len()).map(|j| self.moved(j, time, &mut share).unwrap_or(0.0));
        let mut sizes: Vec<f64> = moved.collect();
        let driven = self.driven(&sizes, time);
        sizes.iter_mut().zip(driven).filter(|(size, _)| **size == 0.0).for_each(|(size, driven)| *size = driven);
        // what neither depends on the others nor moves, by what it does to them
        while let Some(found) = self.behind(&sizes, time) {
            sizes = found;
        }
        sizes
    }

    /// What the states that have a size make of each within a time, all moved by a part of it, up or down.
    fn driven(&mut self, sizes: &[f64], time: f64) -> Vec<f64> {
        let mut driven = vec![0.0_f64; sizes.len()];
        for pattern in 1..=2 {
            let by = |(i, (y, size)): (usize, (&f64, &f64))| {
                let part = if (i + 1) * (pattern + 1) % 5 % 2 == 0 { MOVE } else { -MOVE };
                y + part * size.max(if *size > 0.0 { self.reach(i, time) } else { 0.0 })
            };
            let moved: Vec<f64> = self.y.iter().zip(sizes).enumerate().map(by).collect();
            let Some(there) = self.rates_at(self.t, &moved) else { continue };
            for (largest, change) in driven.iter_mut().zip(seen(&there, &self.rates, &self.noise.rates)) {
                *largest = largest.max((change * time / MOVE).abs());
            }
        }
        driven
    }

    /// What coordinates and velocities may come to within a time; 0 where nothing tells.
    fn likely(&mut self, time: f64) -> (Vec<f64>, Vec<f64>) {
        let step = MOVE * time;
        let later = self.later(step);
        let (q, v) = (self.here.coordinates.clone(), self.here.velocities.clone());
        let there = self.compiled.outputs(self.t + step, &later).map_or(v.clone(), |there| there.velocities);
        let change: Vec<f64> = subtract(&there, &v).iter().map(|d| d / MOVE).collect();
        let n = self.metric.names.len();
        // outputs may be fewer than the coordinates of the system
        let full = |x: &[f64]| -> Vec<f64> { x.iter().copied().chain(std::iter::repeat(0.0)).take(n).collect() };
        let (point, [speed, change]) = ((full(&q), full(&v)), [full(&v), full(&change)]);
        let inertia = self.metric.inertia(self.t, &point.0, &point.1).0;
        let of = |metric: &mut Metric, x: &[f64]| metric.length(self.t, &point.0, &point.1, x);
        let energy = of(self.metric, &speed).max(LARGE * of(self.metric, &change));
        let speeds: Vec<f64> = speed.iter().zip(&change).map(|(v, d)| v.abs().max(LARGE * d.abs())).collect();
        let places: Vec<f64> = point.0.iter().zip(&speeds).map(|(q, v)| q.abs().max(v * time)).collect();
        let likely = |sizes: &[f64], length: f64| -> Vec<f64> {
            (0..q.len()).map(|i| self.metric.likely_size(i, &inertia, sizes, length).unwrap_or(0.0)).collect()
        };
        (likely(&places, energy * time), likely(&speeds, energy))
    }

    /// The sizes with those that rates of sized states tell; `None` if there are no more.
    fn behind(&mut self, sizes: &[f64], time: f64) -> Option<Vec<f64>> {
        let mut found = sizes.to_vec();
        for j in (0..sizes.len()).filter(|&j| sizes[j] == 0.0 && self.reach(j, time) == 0.0).collect::<Vec<_>>() {
            let mut share = |probe: &mut Self, y: &[f64]| {
                let there = probe.rates_at(probe.t, y)?;
                let changes: Vec<f64> =
                    seen(&there, &probe.rates, &probe.noise.rates).iter().map(|change| change * time).collect();
                largest_part(&changes, sizes)
            };
            found[j] = self.moved(j, time, &mut share).unwrap_or(0.0);
        }
        (found != sizes).then_some(found)
    }

    /// The displacement of a state that gives a share of 1.
    fn moved(&mut self, j: usize, time: f64, share: &mut dyn FnMut(&mut Self, &[f64]) -> Option<f64>) -> Option<f64> {
        let reach = self.reach(j, time);
        let mut step = if reach > 0.0 && reach.is_finite() { (MOVE * reach).max(f64::MIN_POSITIVE) } else { LEAST };
        while step < LEAST.recip() {
            let mut y = self.y.to_vec();
            y[j] += step;
            if let Some(part) = share(self, &y) {
                let size = (y[j] - self.y[j]) / part;
                // a share is known to a part 1/CERTAINTY; what the last digits of a displacement out of all
                // proportion change by more is round-off
                y[j] *= 1.0 + UNITS * f64::EPSILON;
                let is_told = step <= reach / MOVE
                    || share(self, &y).is_some_and(|there| (there / part - 1.0).abs() < 1.0 / CERTAINTY);
                return is_told.then_some(size);
            }
            step /= MOVE;
        }
        None
    }

    fn later(&self, step: f64) -> Vec<f64> {
        self.y.iter().zip(&self.rates).map(|(y, f)| y + step * f).collect()
    }

    fn rates_at(&mut self, t: f64, y: &[f64]) -> Option<Vec<f64>> {
        let mut rates = vec![0.0; y.len()];
        self.compiled.rates(t, y, &mut rates).ok()?;
        rates.iter().all(|x| x.is_finite()).then_some(rates)
    }
}

/// The differences that are more than round-off.
fn seen(there: &[f64], here: &[f64], noise: &[f64]) -> Vec<f64> {
    let difference = |((there, here), noise): ((&f64, &f64), &f64)| {
        let difference = there - here;
        if difference.abs() > noise.max(NOTHING * here.abs()) { difference } else { 0.0 }
    };
    there.iter().zip(here).zip(noise).map(difference).collect()
}

/// The largest part that differences are of sizes; `None` where it is none.
fn largest_part(differences: &[f64], sizes: &[f64]) -> Option<f64> {
    let known = differences.iter().zip(sizes).filter(|(_, size)| **size > 0.0);
    known.map(|(d, size)| (d / size).abs()).filter(|part| *part > 0.0 && part.is_finite()).reduce(f64::max)
}
