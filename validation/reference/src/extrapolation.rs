//! Gragg–Bulirsch–Stoer extrapolation: the modified midpoint rule with 2, 4, 6, … substeps, taken to none.
//!
//! Uses values of `F` only: no derivative, no series. Order and step follow the work per unit of time, as in
//! Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, II.9.

use equations::{Dynamics, Real};

use crate::ReferenceError;
use crate::limits::SHORTEST;

/// Rows of the table; order 2 · ROWS. More rows magnify round-off: by 1e3 with these, by 1e5 with 18.
const ROWS: usize = 12;

pub(crate) const NAME: &str = "extrapolation";

/// Integrates to each of `times`, in order; calls `reached` there with the state.
pub(crate) fn integrate<T: Real>(
    instant: &mut Dynamics<T>,
    start: (f64, &[T]),
    times: &[f64],
    tolerance: f64,
    mut reached: impl FnMut(&mut Dynamics<T>, f64, &[T]) -> Result<(), ReferenceError>,
) -> Result<(), ReferenceError> {
    let (t0, y0) = start;
    let mut extrapolation = Extrapolation { y: y0.to_vec(), table: Vec::new(), tolerance };
    let mut t = T::from_f64(t0);
    let mut proposed = (times.last().copied().unwrap_or(t0) - t0).abs() * 1e-2;
    for &target in times {
        let goal = T::from_f64(target);
        loop {
            let left = (goal - t).to_f64();
            if left == 0.0 {
                break;
            }
            let whole = proposed >= left.abs();
            let step = if whole { goal - t } else { T::from_f64(proposed.copysign(left)) };
            let unknowns = instant.guess().to_vec();
            let (next, outcome) = match extrapolation.step(instant, t, step) {
                Ok(outcome) => outcome,
                // a point on the way at which nothing can be solved: the step was too long
                Err(ReferenceError::Instant { .. }) => (0.25, None),
                Err(error) => return Err(error),
            };
            let size = step.size();
            match outcome {
                Some(y) => {
                    extrapolation.y = y;
                    t = if whole { goal } else { t + step };
                    // a step that was cut short says little about the next one
                    proposed = if whole { proposed.max(size * next) } else { size * next };
                }
                None => {
                    instant.set_guess(&unknowns);
                    proposed = size * next;
                    if proposed < SHORTEST * t.size().max((target - t0).abs()) {
                        return Err(ReferenceError::Stopped { method: NAME, time: t.to_f64(), step: proposed });
                    }
                }
            }
        }
        reached(instant, target, &extrapolation.y)?;
    }
    Ok(())
}

struct Extrapolation<T> {
    y: Vec<T>,
    /// The table's last row of changes; entry `j` is extrapolated from the last `j + 1` substep numbers.
    table: Vec<Vec<T>>,
    tolerance: f64,
}

/// The row with the least work per unit of time, and the factor for a step with it.
struct Best {
    work_per_time: f64,
    factor: f64,
    row: usize,
}

impl<T: Real> Extrapolation<T> {
    /// Tries a step; returns the factor for the next one and the state, if it is accepted.
    fn step(&mut self, instant: &mut Dynamics<T>, t: T, step: T) -> Result<(f64, Option<Vec<T>>), ReferenceError> {
        let mut rates = vec![T::from_f64(0.0); self.y.len()];
        evaluate(instant, t, &self.y, &mut rates)?;
        self.table.clear();
        let (mut work, mut best) = (1.0, Best { work_per_time: f64::INFINITY, factor: 0.1, row: ROWS });
        for row in 0..ROWS {
            let count = 2 * (row + 1);
            work += count as f64;
            let value = midpoint(instant, t, step, &self.y, &rates, count)?;
            self.extrapolate(value);
            if row < 2 {
                continue;
            }
            let error = self.error(row);
            let factor = 0.9 * (0.3 / error).powf(1.0 / (2 * row + 1) as f64);
            if factor.is_finite() && work / factor < best.work_per_time {
                best = Best { work_per_time: work / factor, factor, row };
            }
            if error <= 1.0 {
                // the last row was best: try one more, with a step as much longer as it costs more
                let longer = if best.row == row { 1.0 + 2.0 * (row + 2) as f64 / work } else { 1.0 };
                return Ok((
                    (best.factor * longer).min(4.0),
                    Some(self.y.iter().zip(&self.table[row]).map(|(&y, &change)| y + change).collect()),
                ));
            }
            // round-off, or a step so long that more rows do not help
            if !error.is_finite() {
                break;
            }
        }
        Ok((best.factor.min(0.7), None))
    }

    /// A row from `value`: `T_{k,j} = T_{k,j−1} + (T_{k,j−1} − T_{k−1,j−1})/((n_k/n_{k−j})² − 1)`.
    fn extrapolate(&mut self, value: Vec<T>) {
        let row = self.table.len();
        let mut entry = value;
        for j in 1..=row {
            let (new, old) = ((row + 1) as i64, (row + 1 - j) as i64);
            let weight = T::from_ratio(old * old, new * new - old * old);
            let next = entry.iter().zip(&self.table[j - 1]).map(|(&a, &b)| a + (a - b) * weight).collect();
            self.table[j - 1] = std::mem::replace(&mut entry, next);
        }
        self.table.push(entry);
    }

    /// Difference of the last two entries of the row, over the tolerance.
    fn error(&self, row: usize) -> f64 {
        let (last, before) = (&self.table[row], &self.table[row - 1]);
        let relative = last.iter().zip(before).zip(&self.y).map(|((&a, &b), y)| (a - b).size() / (1.0 + y.size()));
        relative.fold(0.0, |worst: f64, x| if x.is_nan() { f64::NAN } else { worst.max(x) }) / self.tolerance
    }
}

/// What Gragg's midpoint rule, evenly many substeps, adds to `y`; its error has even powers of their length.
///
/// The change, not the state: extrapolation magnifies round-off, and that of the change is smaller.
fn midpoint<T: Real>(
    instant: &mut Dynamics<T>,
    t: T,
    step: T,
    y: &[T],
    rates_at_start: &[T],
    count: usize,
) -> Result<Vec<T>, ReferenceError> {
    let h = step / T::from_f64(count as f64);
    let twice = h + h;
    let mut before = vec![T::from_f64(0.0); y.len()];
    let mut here: Vec<T> = rates_at_start.iter().map(|&f| h * f).collect();
    let mut state = y.to_vec();
    let mut rates = vec![T::from_f64(0.0); y.len()];
    for k in 1..count {
        for (s, (&y, &change)) in state.iter_mut().zip(y.iter().zip(&here)) {
            *s = y + change;
        }
        evaluate(instant, t + h * T::from_f64(k as f64), &state, &mut rates)?;
        for ((b, x), &f) in before.iter_mut().zip(&mut here).zip(&rates) {
            (*b, *x) = (*x, *b + twice * f);
        }
    }
    Ok(here)
}

/// `F(t, y)`, the unknowns from where they were last.
fn evaluate<T: Real>(instant: &mut Dynamics<T>, t: T, y: &[T], rates: &mut [T]) -> Result<(), ReferenceError> {
    instant.settle(t, y).map_err(ReferenceError::at(t))?;
    rates.copy_from_slice(instant.rates());
    Ok(())
}
