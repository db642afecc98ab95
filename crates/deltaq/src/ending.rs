//! How a motion ended, in the words of its equations.

use std::collections::HashMap;

use equations::{Block, Compiled, Equations};
use integrate::{DenseOutput, Solution, Status, StopCause};
use mechanics::SingularValues;
use nalgebra::{DMatrix, DVector};
use symbolic::Expr;

/// How a motion ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At the time asked for.
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
            (Ending::Stopped { t, cause }, _) => ("stopped", Some(format!("stopped at t = {t}: {cause}"))),
            (Ending::Completed, Some(words)) => ("untrusted", Some(words)),
            (Ending::Completed, None) => ("completed", None),
        }
    }

    /// Of one run.
    pub(crate) fn of(equations: &Equations, compiled: &mut Compiled, run: &Solution) -> Ending {
        let Status::Stopped { t, cause } = &run.status else { return Ending::Completed };
        let cause = match cause {
            StopCause::Event { index } => {
                let guard = guard_words(equations, *index);
                return Ending::Stopped { t: *t, cause: format!("{guard} vanishes, by which the equations divide") };
            }
            StopCause::NotFinite { component } => {
                let symbol = equations.states.get(*component).map(|y| equations.graph.name(y.symbol));
                format!("{} is no longer finite", symbol.unwrap_or_default())
            }
            StopCause::StepTooSmall { step, .. } => {
                format!("the error asks for steps of {step:.1e}, which no longer move time: a singularity is near")
            }
            other => other.to_string(),
        };
        let near = nearly_zero_guard(equations, compiled, &run.dense);
        let near = near.or_else(|| nearly_dependent(equations, compiled, &run.dense));
        Ending::Stopped { t: *t, cause: cause + &near.map_or(String::new(), |words| format!("; {words}")) }
    }

    /// How the kept run ended, unless the looser one stopped while that went on, in a run over this time.
    pub(crate) fn joint(kept: Ending, looser: Ending, [start, end]: [f64; 2]) -> Ending {
        // both stop near the same singularity, or for different causes
        const NEAR: f64 = 1e-3;
        let much_before = |t: f64, later: f64| (later - t) * (end - start).signum() > NEAR * (later - start).abs();
        match (kept, looser) {
            (Ending::Completed, Ending::Stopped { t, cause }) => Ending::unconfirmed(t, &cause),
            (Ending::Stopped { t: later, .. }, Ending::Stopped { t, cause }) if much_before(t, later) => {
                Ending::unconfirmed(t, &cause)
            }
            (ending, _) => ending,
        }
    }

    /// Where only the tighter run goes on, there is no error estimate, and so no motion.
    pub(crate) fn unconfirmed(t: f64, cause: &str) -> Ending {
        Ending::Stopped { t, cause: format!("the run that estimates the error stops here: {cause}") }
    }
}

fn guard_words(equations: &Equations, index: usize) -> String {
    in_own_names(equations, equations.guards[index])
}

/// A quantity in the user's own names: written out where that is short, else by the states behind it.
pub(crate) fn in_own_names(equations: &Equations, mut quantity: Expr) -> String {
    /// Nodes of an expression that can be read.
    const SHORT: usize = 30;
    let g = &equations.graph;
    for &(symbol, definition) in equations.definitions.iter().rev() {
        if g.size(&[quantity]) <= SHORT && g.depends_on(quantity, symbol) {
            quantity = g.substitute(quantity, &HashMap::from([(symbol, definition)]));
        }
    }
    if g.size(&[quantity]) <= SHORT {
        return g.plain(quantity);
    }
    let behind = equations.symbols_behind([quantity]);
    let states = equations.states.iter().filter(|y| behind.contains(&y.symbol));
    let names: Vec<String> = states.map(|y| g.name(y.symbol)).collect();
    format!("a quantity of {}", names.join(", "))
}

/// A guard is nearly zero when it is under this fraction of its value at the start.
const NEARLY_ZERO: f64 = 1e-2;

/// The guard that has shrunk most over the run, if it is nearly zero at its end.
fn nearly_zero_guard(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> Option<String> {
    let count = compiled.guards();
    let (mut start, mut end) = (vec![0.0; count], vec![0.0; count]);
    compiled.guard_values(dense.start(), dense.start_state(), &mut start);
    compiled.guard_values(dense.end(), dense.end_state(), &mut end);
    let ratios = start.iter().zip(&end).map(|(a, b)| (b / a).abs());
    let (index, ratio) = ratios.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let guard = guard_words(equations, index);
    (ratio < NEARLY_ZERO).then(|| format!("{guard}, by which the equations divide, is down to {:.1e}", end[index]))
}

/// The unknowns of an instant that its equations have nearly ceased to determine over the run, if any.
fn nearly_dependent(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> Option<String> {
    /// Parts of the largest component of the direction that is not determined which are told.
    const TOLD: f64 = 0.3;
    let [start, end] = [(dense.start(), dense.start_state()), (dense.end(), dense.end_state())]
        .map(|(t, y)| compiled.block_matrices(t, y));
    let size = |block: &Block| block.unknowns.len();
    let found = equations.blocks.iter().zip(start.iter().zip(&end)).filter_map(|(block, (start, end))| {
        let (before, _) = least_determined(size(block), start)?;
        let (now, direction) = least_determined(size(block), end)?;
        (now < NEARLY_ZERO * before).then_some((block, now / before, direction))
    });
    let (block, ratio, direction) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let largest = direction.amax();
    let told = block.unknowns.iter().zip(&direction).filter(|(_, x)| x.abs() >= TOLD * largest);
    let names: Vec<String> = told.map(|(&z, _)| equations.graph.name(z)).collect();
    Some(format!("the equations for {} are nearly dependent, {ratio:.1e} of what they were", names.join(", ")))
}

/// The ratio of the least to the largest singular value of a matrix with rows and columns of one size, and
/// the direction that goes with the least.
fn least_determined(size: usize, matrix: &[f64]) -> Option<(f64, DVector<f64>)> {
    let mut matrix = DMatrix::from_row_slice(size, size, matrix);
    if size == 0 || matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let scaled = |largest: f64| if largest > 0.0 { largest.recip() } else { 1.0 };
    matrix.row_iter_mut().for_each(|mut row| row *= scaled(row.amax()));
    matrix.column_iter_mut().for_each(|mut column| column *= scaled(column.amax()));
    let found = SingularValues::of(&matrix);
    Some((found.values[size - 1] / found.values[0], found.right.row(size - 1).transpose()))
}
