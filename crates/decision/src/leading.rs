//! How a motion of the family leaves the curve.

use mechanics::{State, System};
use nalgebra::{DMatrix, DVector};

use crate::decide::{NODES, least, legendre};
use crate::exact::{Jet, Modular};
use crate::proof::Question;
use crate::series::{MismatchSeries, SeriesStart, order as at_order};
use crate::start::ExactStart;
use crate::transport::root_of_mass;

/// Orders that are looked at.
const HIGHEST: usize = 12;
/// And for the least mismatch.
const TAYLOR: usize = 24;
/// A coefficient under this part of its terms counts as zero, where no exact numbers decide.
const VANISHES: f64 = 1e-9;
/// So does one under this part of the curve's own accelerations, where terms are small that cancel in them.
const ROUND_OFF: f64 = 1e-13;
/// Of the time in which coefficients get no larger; and slices of that part.
const FAST: f64 = 0.5;
const SLICES: usize = 24;

/// The leading term of `q_family − q_curve`: `coefficient · (t − t₀)^exponent`.
#[derive(Clone, Debug, PartialEq)]
pub struct LeadingDifference {
    /// `k + 2`, where the mismatch of accelerations starts with `y_k (t − t₀)^k`.
    pub exponent: usize,
    /// `y_k / ((k + 1)(k + 2))`, length n.
    pub coefficient: Vec<f64>,
    /// The time after which a later term of `y` makes more of the difference than this one.
    pub reach: f64,
    /// Whether the exponent is proved for the numbers as written: all lower images are zero, this one is not.
    pub exact: bool,
}

impl Question<'_> {
    /// The leading term for the family's motion from `state` with `constants`; `None` if no coefficient up to
    /// the twelfth stands out. An exact start gives an exact exponent, `constants` being decimals as written.
    pub fn leading_difference(
        &self,
        system: &System,
        state: &State,
        exact: Option<&ExactStart>,
        constants: &[f64],
    ) -> Option<LeadingDifference> {
        let (curve, series) = self.series(&rounded(system, state), HIGHEST).ok()?;
        let proved = exact.and_then(|exact| self.proved_order(exact, constants));
        let coordinates = self.family().shape.coordinates;
        let accelerations = &curve.inputs[curve.inputs.len() - coordinates..];
        let own = |k: usize| at_order(accelerations, k).into_iter().fold(0.0, |size: f64, a| size.max(a.abs()));
        let floor = |k: usize| (0..=k).map(own).fold(0.0, f64::max) * ROUND_OFF;
        let seen = (0..HIGHEST).find(|&k| stands_out(&series, k, constants, floor(k)))?;
        // decimals that stand for other numbers leave lower terms, of the size of round-off
        let order = proved.flatten().map_or(seen, |order| order.max(seen));
        let term = |k: usize| -> Vec<f64> {
            let over = ((k + 1) * (k + 2)) as f64;
            rows(&series, k).map(|row| value(row, constants).0 / over).collect()
        };
        let coefficient = term(order);
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let meets = |k: usize| (size(&coefficient) / size(&term(k))).powf(1.0 / (k - order) as f64);
        let reach = (order + 1..HIGHEST).map(meets).fold(f64::INFINITY, f64::min);
        // removal parameters have no series among these inputs, and nonlinear constraints no such removal
        let coefficient = match self.family().lift {
            Some(_) => coefficient,
            None => {
                let unknowns = unknowns(&series, order, constants);
                let accelerations = self.at_costates(&at_order(&curve.inputs, 0), constants, &unknowns)?;
                accelerations.into_iter().map(|x| x / ((order + 1) * (order + 2)) as f64).collect()
            }
        };
        Some(LeadingDifference { exponent: order + 2, coefficient, reach, exact: proved == Some(Some(order)) })
    }

    /// The least mismatch `(∫ |y|²_M dt)^{1/2}` over all constants by the Taylor series at `state`, over that
    /// part of `time` in which these converge fast: over all of it the least is no less. `None` where there
    /// are no series, and for removals with variables of their own.
    pub fn least_by_series(&self, system: &System, state: &State, time: f64) -> Option<f64> {
        let family = self.family();
        let (curve, series) = self.series(&rounded(system, state), TAYLOR).ok()?;
        if family.lift.is_some() {
            return None;
        }
        let values = family.evaluator::<f64>().run(&at_order(&curve.inputs, 0)).to_vec();
        let root = root_of_mass(&family.shape, &family.shape.instant(&values))?;
        let n = family.shape.coordinates;
        let terms: Vec<_> =
            series.accelerations.iter().map(|y| &root * DMatrix::from_row_slice(n, series.width, y)).collect();
        let size = |k: usize| terms[..k].iter().map(|term| term.norm()).fold(0.0, f64::max);
        let radius = |k: usize| (size(k) / terms[k].norm()).powf(1.0 / k as f64);
        let reach = (1..TAYLOR).map(radius).filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min);
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
        let values = evaluator.run(inputs).to_vec();
        let instant = shape.instant(&values);
        let (n, k, count) = (shape.coordinates, shape.costates, shape.accelerations.len());
        let to_acceleration = DMatrix::from_row_slice(n, count, instant.to_acceleration);
        let start = family.start(inputs);
        let costates: Vec<f64> = start.chunks_exact(constants.len() + 1).map(|row| value(row, constants).0).collect();
        let plain = DMatrix::from_row_slice(shape.unknowns, shape.unknowns, instant.matrix);
        let mut z = DVector::zeros(shape.unknowns);
        let mut bent = plain.clone();
        for (column, &place) in shape.accelerations.iter().enumerate() {
            z[place] = unknowns[column];
            let mut moved = inputs.to_vec();
            moved[first..].iter_mut().zip(to_acceleration.column(column).iter()).for_each(|(a, da)| *a += da);
            let values = evaluator.run(&moved);
            let change = shape.instant(values).by_costate.iter().zip(instant.by_costate).map(|(x, y)| x - y);
            for (i, change) in change.enumerate() {
                bent[(i / k, place)] += change * costates[i % k];
            }
        }
        let z = bent.lu().solve(&(plain * z))?;
        Some((to_acceleration * z.select_rows(&shape.accelerations)).as_slice().to_vec())
    }

    /// The first order that does not vanish, in exact numbers; `None` where these do not apply.
    fn proved_order(&self, exact: &ExactStart, constants: &[f64]) -> Option<Option<usize>> {
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
fn rounded(system: &System, state: &State) -> SeriesStart<f64> {
    SeriesStart {
        parameters: system.parameters.iter().map(|p| Jet::of(p.value)).collect(),
        time: Jet::of(state.t),
        positions: state.q.iter().map(|&x| Jet::of(x)).collect(),
        velocities: state.v.iter().map(|&x| Jet::of(x)).collect(),
    }
}

/// Unknowns that are accelerations, at one order.
fn unknowns(series: &MismatchSeries<f64>, order: usize, constants: &[f64]) -> Vec<f64> {
    series.orders[order].chunks_exact(series.width).map(|row| value(row, constants).0).collect()
}

fn rows(series: &MismatchSeries<f64>, order: usize) -> impl Iterator<Item = &[f64]> {
    series.accelerations[order].chunks_exact(series.width)
}

/// `O c + y₀` of one row, and the size of its terms.
fn value(row: &[f64], constants: &[f64]) -> (f64, f64) {
    let terms = row.iter().zip(constants.iter().chain(&[1.0])).map(|(r, c)| r * c);
    terms.fold((0.0, 0.0), |(sum, size), x| (sum + x, size + x.abs()))
}

fn stands_out(series: &MismatchSeries<f64>, order: usize, constants: &[f64], floor: f64) -> bool {
    // terms that cancelled at earlier orders left round-off that is as large as they were
    let size = (0..=order).flat_map(|k| rows(series, k)).map(|row| value(row, constants).1).fold(0.0_f64, f64::max);
    rows(series, order).any(|row| value(row, constants).0.abs() > (VANISHES * size).max(floor))
}
