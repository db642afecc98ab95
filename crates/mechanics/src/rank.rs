//! Ranks of matrices of expressions.

use std::collections::{BTreeSet, HashMap};

use nalgebra::DMatrix;
use symbolic::{Bounded, Evaluator, Graph, Matrix, Scalar, SplitMix, Symbol};

use crate::SingularValues;

/// Singular values under this fraction of the largest count as zero.
pub(crate) const RANK_LIMIT: f64 = 1e-9;

/// Points at which a generic rank is taken.
const POINTS: u64 = 6;

/// Least numerical rank of `matrix` with entries off by `errors`: how many singular values are over
/// [`RANK_LIMIT`] times the largest, rows scaled to their largest entry, and over the norm of the errors.
fn certain_rank(mut matrix: DMatrix<f64>, mut errors: DMatrix<f64>) -> usize {
    for (mut row, mut errors) in matrix.row_iter_mut().zip(errors.row_iter_mut()) {
        let scale = row.amax();
        if scale > 0.0 {
            row /= scale;
            errors /= scale;
        }
    }
    let singular = SingularValues::of(&matrix).values;
    let largest = singular.max();
    let limit = errors.norm().max(RANK_LIMIT * largest);
    singular.iter().filter(|&&s| largest > 0.0 && s > limit).count()
}

/// The rank of `matrix` almost everywhere: the largest at a few pseudo-random points where all entries are
/// finite. `constants` keep their values. An entry that is round-off of larger terms counts as zero.
pub fn generic_rank(graph: &Graph, matrix: &Matrix, constants: &HashMap<Symbol, f64>) -> usize {
    if matrix.rows() == 0 || matrix.columns() == 0 {
        return 0;
    }
    let symbols: BTreeSet<Symbol> = matrix.entries().iter().flat_map(|&e| graph.symbols_of(e)).collect();
    let symbols: Vec<Symbol> = symbols.into_iter().collect();
    let Ok(tape) = graph.compile(&symbols, matrix.entries(), &HashMap::new()) else { return 0 };
    let mut evaluator = Evaluator::new(tape);
    let mut at = |point| {
        let entries = evaluator.evaluate(&random_values(&symbols, constants, point));
        let number = |e: &Bounded| if e.may_be_zero() { 0.0 } else { e.value };
        let of = |part: &dyn Fn(&Bounded) -> f64| {
            DMatrix::from_row_iterator(matrix.rows(), matrix.columns(), entries.iter().map(part))
        };
        entries.iter().all(|e| e.is_finite()).then(|| certain_rank(of(&number), of(&|e| e.round_off())))
    };
    (0..POINTS).filter_map(&mut at).max().unwrap_or(0)
}

/// Values in ±[0.3, 1.3] for every symbol that is not a constant, a pure function of its place and `point`.
fn random_values(symbols: &[Symbol], constants: &HashMap<Symbol, f64>, point: u64) -> Vec<Bounded> {
    let value = |(i, symbol): (usize, &Symbol)| {
        let x = SplitMix::new(point << 32 | i as u64).bits();
        let magnitude = 0.3 + (x >> 11) as f64 / (1u64 << 53) as f64;
        let random = if x & 1 == 0 { magnitude } else { -magnitude };
        Bounded::from_f64(constants.get(symbol).copied().unwrap_or(random))
    };
    symbols.iter().enumerate().map(value).collect()
}
