//! How a motion ended, in the words of its equations.

use std::collections::HashMap;

use equations::{Compiled, Equations};
use integrate::{DenseOutput, Solution, Status, StopCause};
use mechanics::SingularValues;
use nalgebra::{DMatrix, DVector};
use symbolic::Expr;
use symbolic::limits::LINE;

use crate::TRUSTED;
use crate::band::limits::NEARLY_ZERO;
use crate::lost_rank;

/// What helps where steps became too short and no divisor of the equations vanishes.
const HELP: &str = "where something is switched, its times as `breakpoints` help, else a larger --max-steps";

/// How a motion ended.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Ending {
    /// At the time asked for.
    #[default]
    Completed,
    /// Earlier, with the time and the cause in words.
    Stopped {
        /// Time reached.
        t: f64,
        /// Cause.
        cause: String,
    },
}

impl Ending {
    /// `completed`, `untrusted` (where there is a complaint) or `stopped`, and why it is not completed.
    pub fn status(&self, complaint: Option<String>) -> (&'static str, Option<String>) {
        match (self, complaint) {
            (Ending::Stopped { t, cause }, _) => ("stopped", Some(format!("stopped at t = {t:?}: {cause}"))),
            (Ending::Completed, Some(words)) => ("untrusted", Some(words)),
            (Ending::Completed, None) => ("completed", None),
        }
    }

    /// The ending of one run of a motion that passed through the points `before`. Leaving a chart counts as
    /// completed.
    pub(crate) fn of(
        equations: &Equations,
        compiled: &mut Compiled,
        run: &Solution,
        before: &[(f64, Vec<f64>)],
    ) -> Ending {
        let Status::Stopped { t, cause } = &run.status else { return Ending::Completed };
        let is_short = matches!(cause, StopCause::Creeping { .. } | StopCause::StepTooSmall { .. });
        let cause = match cause {
            StopCause::Event { index } if *index == equations.guards.len() => return Ending::Completed,
            StopCause::Event { index } => {
                let cause = vanishing_guard(equations, *index);
                return Ending::Stopped { t: *t, cause };
            }
            StopCause::LosesRank => {
                let cause = lost_rank::words(equations, compiled, &run.dense);
                return Ending::Stopped { t: *t, cause };
            }
            StopCause::NotFinite { component } => {
                let symbol = equations.states.get(*component).map(|y| equations.graph.name(y.symbol));
                format!("{} is no longer finite", symbol.unwrap_or_default())
            }
            StopCause::StepTooSmall { step, .. } => {
                format!("the error asks for steps of {step:.1e}, which no longer move time")
            }
            other => other.to_string(),
        };
        let before = [before, &[(run.dense.start(), run.dense.start_state().to_vec())]].concat();
        let near = nearly_zero_guard(equations, compiled, &before, &run.dense);
        let near = near.or_else(|| lost_root(equations, &before, &run.dense));
        let near = near.or_else(|| nearly_dependent(equations, compiled, &before, &run.dense));
        let near = match near {
            Some(words) if is_short => format!(": a singularity is near; {words}"),
            Some(words) => format!("; {words}"),
            None if is_short => {
                let fastest = fastest(equations, compiled, &run.dense).map_or(String::new(), |words| words + "; ");
                format!("; {fastest}{HELP}")
            }
            None => String::new(),
        };
        Ending::Stopped { t: *t, cause: cause + &near }
    }

    /// How the kept run ended, unless the looser one stopped while that went on, in a run over this time.
    pub fn joint(kept: Ending, looser: Ending, [start, end]: [f64; 2]) -> Ending {
        // both stop near the same singularity, or for different causes
        let much_before = |t: f64, later: f64| (later - t) * (end - start).signum() > TRUSTED * (later - start).abs();
        match (kept, looser) {
            (Ending::Completed, Ending::Stopped { t, cause }) => Ending::unconfirmed(t, &cause),
            (Ending::Stopped { t: later, .. }, Ending::Stopped { t, cause }) if much_before(t, later) => {
                Ending::unconfirmed(t, &cause)
            }
            (ending, _) => ending,
        }
    }

    /// Where only the tighter run goes on, there is no error estimate, and so no motion.
    pub fn unconfirmed(t: f64, cause: &str) -> Ending {
        Ending::Stopped { t, cause: format!("the run that estimates the error stops here: {cause}") }
    }
}

/// That a motion ends at this guard, and why.
pub(crate) fn vanishing_guard(equations: &Equations, index: usize) -> String {
    let (guard, e) = (guard_words(equations, index), equations.guards[index]);
    if equations.domains.contains(&e) {
        format!("{guard} vanishes: a root or logarithm of it, as written, has no value beyond")
    } else if equations.cuts.contains(&e) {
        format!(
            "{guard} vanishes: an angle jumps there, and momenta or constraints with it, which velocities cannot follow"
        )
    } else {
        format!("{guard} vanishes, by which the equations divide")
    }
}

fn guard_words(equations: &Equations, index: usize) -> String {
    in_own_names(equations, equations.guards[index])
}

/// A quantity in the user's own names: written out where that is short, else by the states behind it.
pub(crate) fn in_own_names(equations: &Equations, mut quantity: Expr) -> String {
    let g = &equations.graph;
    for &(symbol, definition) in equations.definitions.iter().rev() {
        if g.size(&[quantity]) <= LINE && g.depends_on(quantity, symbol) {
            quantity = g.substitute(quantity, &HashMap::from([(symbol, definition)]));
        }
    }
    if g.size(&[quantity]) <= LINE {
        return g.plain(quantity);
    }
    let behind = equations.symbols_behind([quantity]);
    let states = equations.states.iter().filter(|y| behind.contains(&y.symbol));
    let names: Vec<String> = states.map(|y| g.name(y.symbol)).collect();
    format!("a quantity of {}", names.join(", "))
}

/// The guard that has shrunk most since these points, if it is nearly zero at the end of the run.
fn nearly_zero_guard(
    equations: &Equations,
    compiled: &mut Compiled,
    before: &[(f64, Vec<f64>)],
    dense: &DenseOutput,
) -> Option<String> {
    let (mut values, mut largest) = (vec![0.0; compiled.guards()], vec![0.0_f64; compiled.guards()]);
    for (t, y) in before {
        compiled.guard_values(*t, y, &mut values);
        largest.iter_mut().zip(&values).for_each(|(most, x)| *most = most.max(x.abs()));
    }
    let mut end = values;
    compiled.guard_values(dense.end(), dense.end_state(), &mut end);
    let ratios = largest.iter().zip(&end).map(|(a, b)| (b / a).abs());
    let (index, ratio) = ratios.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let guard = guard_words(equations, index);
    (ratio < NEARLY_ZERO).then(|| format!("{guard}, by which the equations divide, is down to {:.1e}", end[index]))
}

/// The root in the equations whose radicand has shrunk most since these points, if it is nearly zero at the
/// end of the run.
fn lost_root(equations: &Equations, before: &[(f64, Vec<f64>)], dense: &DenseOutput) -> Option<String> {
    let g = &equations.graph;
    let residuals = equations.blocks.iter().flat_map(|block| block.residuals.iter().copied());
    let rates = equations.states.iter().map(|y| y.rate).chain(equations.definitions.iter().map(|d| d.1));
    let symbols: Vec<_> = [equations.time].into_iter().chain(equations.state_symbols()).collect();
    let found = g.roots(&rates.chain(residuals).collect::<Vec<_>>()).into_iter().filter_map(|(base, root)| {
        let tape = equations.tape(&symbols, &[base]).ok()?;
        let value = |t: f64, y: &[f64]| {
            let mut found = [f64::NAN];
            tape.evaluate(&[&[t], y].concat(), &mut tape.workspace(), &mut found);
            found[0]
        };
        let points = before.iter().map(|(t, y)| (*t, &y[..])).chain([(dense.start(), dense.start_state())]);
        let largest = points.fold(0.0_f64, |most, (t, y)| most.max(value(t, y)));
        let end = value(dense.end(), dense.end_state());
        (end < NEARLY_ZERO * largest).then_some((end / largest, base, root, end))
    });
    let (_, base, root, end) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let [base, root] = [base, root].map(|e| in_own_names(equations, e));
    Some(format!("{root} has no value where {base} is negative, and that is down to {end:.1e}"))
}

/// The unknowns of an instant that its equations have nearly ceased to determine since these points, if any.
fn nearly_dependent(
    equations: &Equations,
    compiled: &mut Compiled,
    before: &[(f64, Vec<f64>)],
    dense: &DenseOutput,
) -> Option<String> {
    let [before, end] = [before, &[(dense.end(), dense.end_state().to_vec())]]
        .map(|points| points.iter().map(|(t, y)| compiled.block_matrices(*t, y)).collect::<Vec<_>>());
    let found = equations.blocks.iter().enumerate().filter_map(|(i, block)| {
        let size = block.unknowns.len();
        let matrix = |of: &Vec<Vec<f64>>| {
            let finite = size > 0 && of[i].iter().all(|x| x.is_finite());
            finite.then(|| DMatrix::from_row_slice(size, size, &of[i]))
        };
        let scaled = before.iter().filter_map(matrix).map(|matrix| {
            let factors = equilibration(&matrix);
            (least_determined(matrix, &factors).0, factors)
        });
        let (before, factors) = scaled.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let (now, direction) = least_determined(matrix(&end[0])?, &factors);
        (now < NEARLY_ZERO * before).then_some((block, now / before, direction))
    });
    let (block, ratio, direction) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let largest = direction.amax();
    let told = block.unknowns.iter().zip(&direction).filter(|(_, x)| x.abs() >= NEARLY_ZERO * largest);
    let names: Vec<String> = told.map(|(&z, _)| equations.graph.name(z)).collect();
    Some(format!("the equations for {} are nearly dependent, {ratio:.1e} of what they were", names.join(", ")))
}

/// The state that changes fastest at the end of the run, for its size, which counts as 1 if it is less.
fn fastest(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> Option<String> {
    let y = dense.end_state();
    let mut rates = vec![0.0; y.len()];
    compiled.rates(dense.end(), y, &mut rates).ok()?;
    let parts = rates.iter().zip(y).map(|(rate, y)| (rate / y.abs().max(1.0)).abs()).enumerate();
    let (i, part) = parts.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let name = equations.graph.name(equations.states[i].symbol);
    Some(format!("{name} changes fastest, in a unit of time by {part:.1e} times its size"))
}

/// Factors by which the largest entry of each row, then of each column, is 1.
fn equilibration(matrix: &DMatrix<f64>) -> [DVector<f64>; 2] {
    let factor = |largest: f64| if largest > 0.0 { largest.recip() } else { 1.0 };
    let rows = DVector::from_iterator(matrix.nrows(), matrix.row_iter().map(|row| factor(row.amax())));
    let scaled = DMatrix::from_diagonal(&rows) * matrix;
    let columns = scaled.column_iter().map(|column| factor(column.amax()));
    [DVector::from_iterator(matrix.ncols(), columns), rows]
}

/// The least singular value of a matrix with columns and rows times these factors, and its direction.
fn least_determined(matrix: DMatrix<f64>, [columns, rows]: &[DVector<f64>; 2]) -> (f64, DVector<f64>) {
    let found = SingularValues::of(&(DMatrix::from_diagonal(rows) * matrix * DMatrix::from_diagonal(columns)));
    let last = found.values.len() - 1;
    (found.values[last], found.right.row(last).transpose())
}
