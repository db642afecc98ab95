//! Search for steady motions.

use mechanics::{ConstantsRule, SingularValues, State};
use motion::{CHETAEV, Choice, Setting};
use nalgebra::{DMatrix, DVector};
use symbolic::limits::{ITERATIONS, NOTHING};

use crate::LinearError;
use crate::limits::ROUNDINGS;
use crate::linearization::{Moving, moving};
use crate::matrix::part;
use crate::point::{COORDINATES, Point, VELOCITIES, at};

/// Steps of Runge and Kutta along one displacement.
const PARTS: usize = 100;

/// A steady motion of Chetaev's equations near the start of `setting`, by the shortest Newton steps.
///
/// Unknowns are displacements along the quasi-velocities, and these themselves. A displacement `d` follows
/// `dq/ds = S(q) d` for `s` from 0 to 1: it is admissible all along, so that position constraints which `f`
/// keeps hold as they do at the start.
///
/// # Errors
/// [`LinearError::NotFound`]; [`LinearError::NotLinear`]; [`LinearError::Solve`].
pub fn find_steady(setting: Setting) -> Result<State, LinearError> {
    if !setting.system.constraints_linear_in_velocity() {
        return Err(LinearError::NotLinear);
    }
    Point::start(setting, &chetaev())?.settle()
}

/// Chetaev's formulation, which takes no constants.
pub(crate) fn chetaev() -> Choice {
    Choice { label: "Chetaev".into(), formulation: CHETAEV, removal: None, constants: ConstantsRule::Zero }
}

/// The power of 1000 nearest to `scale`; 1 where there is none.
fn round(scale: f64) -> f64 {
    if scale > 0.0 && scale.is_finite() { 1000_f64.powf(scale.log(1000.0).round()) } else { 1.0 }
}

impl Point {
    /// Moves to a steady motion near by.
    pub(crate) fn settle(&mut self) -> Result<State, LinearError> {
        let (places, speeds) = (self.places(&COORDINATES), self.places(&VELOCITIES));
        let carried = self.carried()?;
        let kept: Vec<usize> = (0..self.y.len()).filter(|i| !carried.contains(i)).collect();
        let m = speeds.len();
        let mut last = f64::INFINITY;
        let mut iterations = 0;
        let mut first: Option<Vec<f64>> = None;
        let begun = self.y.clone();
        loop {
            let y = self.y.clone();
            let (rates, jacobian) = (self.rates(&y)?, self.jacobian(&y)?);
            let matrix = part(&jacobian, &kept);
            let residual = DVector::from_iterator(kept.len(), kept.iter().map(|&i| rates[i]));
            let (scales, moving) = moving(self, &kept, &matrix)?;
            let terms = |row: usize| matrix.row(row).iter().zip(&scales).map(|(a, s)| a.abs() * s).sum::<f64>();
            let sizes: Vec<f64> = (0..kept.len()).map(terms).collect();
            let first = first.get_or_insert_with(|| sizes.clone());
            match moving {
                // by steps that only halve what is left: nothing is left of what there was at first
                Some(Moving { place, rate, .. })
                    if iterations == ITERATIONS && rate.abs() <= f64::EPSILON * first[place] =>
                {
                    return self.state();
                }
                // on, as long as it becomes better
                None if residual.norm() > 0.5 * last || residual.norm() == 0.0 => return self.state(),
                Some(Moving { place, rate, limit }) if iterations == ITERATIONS => {
                    let state = self.equations.graph.name(self.equations.states[kept[place]].symbol);
                    return Err(LinearError::NotFound { iterations, state, rate, limit });
                }
                _ => {}
            }
            (last, iterations) = (residual.norm(), iterations + 1);
            let along = |i: usize, k: usize| places.iter().map(|&p| jacobian[(i, p)] * jacobian[(p, speeds[k])]).sum();
            let columns = DMatrix::from_fn(kept.len(), 2 * m, |i, k| match k.checked_sub(m) {
                None => along(kept[i], k),
                Some(k) => jacobian[(kept[i], speeds[k])],
            });
            // rows by their size, columns in round units, lest those of small units look flat; what is
            // carried has no size
            let scale = |i: usize| kept.iter().position(|&k| k == i).map(|k| scales[k]);
            let units = DVector::from_fn(2 * m, |k, _| match k.checked_sub(m) {
                None => {
                    let reach = |&p: &usize| Some(scale(p)? / jacobian[(p, speeds[k])].abs());
                    round(places.iter().filter_map(reach).fold(f64::INFINITY, f64::min))
                }
                Some(k) => scale(speeds[k]).map_or(1.0, round),
            });
            let sizes = DVector::from_fn(kept.len(), |i, _| if sizes[i] > 0.0 { sizes[i] } else { 1.0 });
            let scaled = DMatrix::from_fn(kept.len(), 2 * m, |i, k| columns[(i, k)] * units[k] / sizes[i]);
            let svd = SingularValues::of(&scaled);
            let step = svd.solve(&-residual.component_div(&sizes), NOTHING * svd.values.max()).component_mul(&units);
            self.displace(&places, &speeds, &step.as_slice()[..m])?;
            for (&w, change) in speeds.iter().zip(&step.as_slice()[m..]) {
                self.y[w] += change;
            }
            // less than the digits that it began with
            let vanishing =
                self.y.iter_mut().zip(&begun).filter(|(y, begun)| y.abs() <= ROUNDINGS * f64::EPSILON * begun.abs());
            vanishing.for_each(|(y, _)| *y = 0.0);
        }
    }

    /// Moves the coordinates by an admissible displacement.
    fn displace(&mut self, places: &[usize], speeds: &[usize], by: &[f64]) -> Result<(), LinearError> {
        let mut y = self.y.clone();
        let mut q: Vec<f64> = places.iter().map(|&i| self.y[i]).collect();
        let mut slope = |q: &[f64]| -> Result<Vec<f64>, LinearError> {
            let mut at = |scale: f64| {
                places.iter().zip(q).for_each(|(&i, &x)| y[i] = x);
                speeds.iter().zip(by).for_each(|(&i, &x)| y[i] = scale * x);
                self.rates(&y)
            };
            // without what moves at rest
            let (moved, rest) = (at(1.0)?, at(0.0)?);
            Ok(places.iter().map(|&i| moved[i] - rest[i]).collect())
        };
        let h = 1.0 / PARTS as f64;
        let ahead = |q: &[f64], k: &[f64], h: f64| q.iter().zip(k).map(|(q, k)| q + h * k).collect::<Vec<f64>>();
        for _ in 0..PARTS {
            let k1 = slope(&q)?;
            let k2 = slope(&ahead(&q, &k1, h / 2.0))?;
            let k3 = slope(&ahead(&q, &k2, h / 2.0))?;
            let k4 = slope(&ahead(&q, &k3, h))?;
            for (i, q) in q.iter_mut().enumerate() {
                *q += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
            }
        }
        places.iter().zip(q).for_each(|(&i, x)| self.y[i] = x);
        Ok(())
    }

    fn state(&mut self) -> Result<State, LinearError> {
        let found = self.compiled.outputs(self.t, &self.y).map_err(at(self.t))?;
        Ok(State { t: self.t, q: found.coordinates, v: found.velocities })
    }
}
