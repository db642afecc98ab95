//! The leading term of the difference between a motion of the family and the curve.

use mechanics::{State, System};
use nalgebra::{DMatrix, DVector};
use symbolic::{Bounded, Scalar};

use crate::decide::{NODES, least, legendre};
use crate::exact::{FIELDS, Jet, Modular, in_field};
use crate::order_by_order::order as at_order;
use crate::proof::Question;
use crate::series::{MismatchSeries, SeriesStart};
use crate::start::ExactStart;
use crate::transport::root_of_mass;

/// Highest order that is tried.
const HIGHEST: usize = 12;
/// The same for the least mismatch.
const TAYLOR: usize = 24;
/// Fraction of the time within which coefficients do not grow, and number of slices of that part.
const FAST: f64 = 0.5;
const SLICES: usize = 24;

/// The leading term of `q_family − q_curve`: `coefficient · (t − t₀)^exponent`.
#[derive(Clone, Debug, PartialEq)]
pub struct LeadingDifference {
    /// `k + 2`, where the mismatch of accelerations starts with `y_k (t − t₀)^k`.
    pub exponent: usize,
    /// `y_k / ((k + 1)(k + 2))`, length n.
    pub coefficient: Vec<f64>,
    /// The time after which a later term of `y` may be longer than this one, by `M`; 0 where that tells no
    /// length.
    pub reach: f64,
    /// The time up to which a lower term, lost in its round-off, may be longer; 0 where all are zero.
    pub from: f64,
    /// Whether the exponent is that of the numbers as written: the image of its coefficient is not zero, and
    /// those of all lower ones are zero in two fields.
    pub exact: bool,
}

impl Question<'_> {
    /// The leading term for the family's motion from `state` with `constants`; `None` if no coefficient up to
    /// the twelfth stands out from its round-off, or leads at any time, or none is there. An exact start
    /// gives an exact exponent, `constants` being decimals as written.
    pub fn leading_difference(
        &self,
        system: &System,
        state: &State,
        exact: Option<&ExactStart>,
        constants: &[f64],
    ) -> Option<LeadingDifference> {
        let (curve, series) = self.series(&rounded(system, state), HIGHEST).ok()?;
        let proved = exact.and_then(|exact| self.agreed_order(exact, constants));
        let mismatch = |k: usize| rows(&series.accelerations[k], series.width, constants);
        // no value stands for nothing: tanh has derivatives 0/0 where it is 1 to the last digit
        let known = |k: usize| mismatch(k).all(|y| y.is_finite());
        let seen = (0..HIGHEST).take_while(|&k| known(k)).find(|&k| mismatch(k).any(|y| !y.may_be_zero()))?;
        // decimals that stand for other numbers leave lower terms, of the size of round-off
        let order = proved.map_or(Some(seen), |order| order.map(|order| order.max(seen)))?;
        if !(seen..=order).all(known) {
            return None;
        }
        let term = |k: usize| -> Vec<f64> {
            let over = ((k + 1) * (k + 2)) as f64;
            mismatch(k).map(|y| if y.may_be_zero() { 0.0 } else { y.value / over }).collect()
        };
        let coefficient = term(order);
        let values = |x: &[Bounded]| x.iter().map(|x| x.value).collect::<Vec<f64>>();
        let root = root_of_mass(coefficient.len(), &values(&series.mass), &values(&series.jacobian));
        let (reach, from) = root.map_or((0.0, f64::INFINITY), |root| {
            let own = (&root * DVector::from_column_slice(&coefficient)).norm();
            // what round-off may hide counts
            let most = |k: usize| {
                let over = ((k + 1) * (k + 2)) as f64;
                let most = mismatch(k).map(|y| (y.value.abs() + y.round_off()) / over);
                (root.abs() * DVector::from_iterator(coefficient.len(), most)).norm()
            };
            let meets = |k: usize| {
                let term = if known(k) { most(k) } else { f64::INFINITY };
                (own / term).powf(1.0 / (k as f64 - order as f64))
            };
            let lower = if proved == Some(Some(order)) { 0..0 } else { 0..order };
            ((order + 1..HIGHEST).map(meets).fold(f64::INFINITY, f64::min), lower.map(meets).fold(0.0, f64::max))
        });
        if from >= reach && from > 0.0 {
            return None;
        }
        // removal parameters have no series among these inputs, and nonlinear constraints no such removal
        let coefficient = match self.family().lift {
            Some(_) => coefficient,
            None => {
                let unknowns: Vec<f64> =
                    rows(&series.orders[order], series.width, constants).map(|z| z.value).collect();
                let inputs: Vec<f64> = values(&at_order(&curve.inputs, 0));
                let accelerations = self.at_costates(&inputs, constants, &unknowns)?;
                accelerations.into_iter().map(|x| x / ((order + 1) * (order + 2)) as f64).collect()
            }
        };
        let exact = proved == Some(Some(order));
        Some(LeadingDifference { exponent: order + 2, coefficient, reach, from, exact })
    }

    /// The least mismatch `(∫ |y|²_M dt)^{1/2}` over all constants by the Taylor series at `state`, over that
    /// part of `time` in which these converge fast: over all of it the least is not less. `None` where there
    /// are not series, and for removals with variables of their own.
    pub fn least_by_series(&self, system: &System, state: &State, time: f64) -> Option<f64> {
        let (_, series): (_, MismatchSeries<Bounded>) = self.series(&rounded(system, state), TAYLOR).ok()?;
        if self.family().lift.is_some() {
            return None;
        }
        let n = self.family().shape.coordinates;
        let values = |x: &[Bounded]| x.iter().map(|x| x.value).collect::<Vec<f64>>();
        let root = root_of_mass(n, &values(&series.mass), &values(&series.jacobian))?;
        let known = |y: &Bounded| if y.may_be_zero() { 0.0 } else { y.value };
        let terms: Vec<_> = series
            .accelerations
            .iter()
            .map(|y| &root * DMatrix::from_row_iterator(n, series.width, y.iter().map(known)))
            .collect();
        // the time at which term k of a column is as long as an earlier one: in any unit
        let radius = |(k, column): (usize, usize)| {
            let size = |k: usize| terms[k].column(column).norm();
            (0..k).map(|j| (size(j) / size(k)).powf(1.0 / (k - j) as f64)).fold(0.0, f64::max)
        };
        let all = (1..TAYLOR).flat_map(|k| (0..series.width).map(move |column| (k, column)));
        let reach = all.map(radius).filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min);
        let width = time.min(FAST * reach) / SLICES as f64;
        let nodes = (0..SLICES).flat_map(|slice| legendre().map(|(x, weight)| (width * (slice as f64 + x), weight)));
        let mut rows = DMatrix::zeros(NODES * SLICES * n, series.width);
        for (i, (t, weight)) in nodes.enumerate() {
            let sum = terms.iter().rev().fold(DMatrix::zeros(n, series.width), |sum, term| sum * t + term);
            rows.rows_mut(i * n, n).copy_from(&(sum * (weight * width).sqrt()));
        }
        Some(least(rows))
    }

    /// Accelerations from the family's unknowns at which the mismatch begins, found with `∂R/∂z` at `η = 0`.
    /// A constraint not linear in `v` brings `η` in: `R_η`, affine in the accelerations, tells how.
    fn at_costates(&self, inputs: &[f64], constants: &[f64], unknowns: &[f64]) -> Option<Vec<f64>> {
        let (family, shape) = (self.family(), &self.family().shape);
        let mut evaluator = family.evaluator::<f64>();
        let first = inputs.len() - shape.coordinates;
        let values = evaluator.evaluate(inputs).to_vec();
        let instant = shape.instant(&values);
        let (n, k, count) = (shape.coordinates, shape.costates, shape.accelerations.len());
        let to_acceleration = DMatrix::from_row_slice(n, count, instant.to_acceleration);
        let start = family.start(inputs);
        let costates: Vec<f64> = start
            .chunks_exact(constants.len() + 1)
            .map(|row| row.iter().zip(constants.iter().chain(&[1.0])).map(|(r, c)| r * c).sum())
            .collect();
        let plain = DMatrix::from_row_slice(shape.unknowns, shape.unknowns, instant.matrix);
        let mut z = DVector::zeros(shape.unknowns);
        let mut bent = plain.clone();
        for (column, &place) in shape.accelerations.iter().enumerate() {
            z[place] = unknowns[column];
            let mut moved = inputs.to_vec();
            moved[first..].iter_mut().zip(to_acceleration.column(column).iter()).for_each(|(a, da)| *a += da);
            let values = evaluator.evaluate(&moved);
            let change = shape.instant(values).by_costate.iter().zip(instant.by_costate).map(|(x, y)| x - y);
            for (i, change) in change.enumerate() {
                bent[(i / k, place)] += change * costates[i % k];
            }
        }
        let z = bent.lu().solve(&(plain * z))?;
        Some((to_acceleration * z.select_rows(&shape.accelerations)).as_slice().to_vec())
    }

    /// The first order that does not vanish, in two fields; `None` where exact numbers do not apply. What is
    /// not zero in one field is not zero; so the first of any field is not lower than that of the numbers.
    fn agreed_order(&self, exact: &ExactStart, constants: &[f64]) -> Option<Option<usize>> {
        let mut found = Vec::new();
        for field in &FIELDS {
            let Some(order) = in_field(field, || self.first_order(exact, constants)) else { continue };
            if found.contains(&order) {
                return Some(order);
            }
            found.push(order);
        }
        None
    }

    /// The first order whose images are not all zero.
    fn first_order(&self, exact: &ExactStart, constants: &[f64]) -> Option<Option<usize>> {
        let (start, _) = exact.series().ok()?;
        let (_, series) = self.series(&start, HIGHEST).ok()?;
        let constants: Vec<Jet<Modular>> = constants.iter().map(|&c| Jet::of(c)).collect();
        if constants.iter().any(|c| c.flaw().is_some()) {
            return None;
        }
        let vanishes = |k: usize| {
            series.accelerations[k].chunks_exact(series.width).all(|row| {
                let terms = row.iter().zip(constants.iter().map(|c| c.coefficient(0)).chain([Modular::one()]));
                terms.fold(Modular::ZERO, |sum, (&r, c)| sum + r * c).is_zero()
            })
        };
        Some((0..HIGHEST).find(|&k| !vanishes(k)))
    }
}

/// A start as it is rounded.
fn rounded(system: &System, state: &State) -> SeriesStart<Bounded> {
    SeriesStart {
        parameters: system.parameters.iter().map(|p| Jet::of(p.value)).collect(),
        time: Jet::of(state.t),
        positions: state.q.iter().map(|&x| Jet::of(x)).collect(),
        velocities: state.v.iter().map(|&x| Jet::of(x)).collect(),
    }
}

/// `O c + y₀`, row by row.
fn rows(entries: &[Bounded], width: usize, constants: &[f64]) -> impl Iterator<Item = Bounded> {
    entries.chunks_exact(width).map(move |row| {
        let factors = constants.iter().chain(&[1.0]).map(|&c| Bounded::from_f64(c));
        row.iter().zip(factors).fold(Bounded::from_f64(0.0), |sum, (&r, c)| sum + r * c)
    })
}
