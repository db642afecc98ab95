//! A block that is linear in its unknowns, as a sparse matrix.

use std::collections::BTreeMap;

use mechanics::elimination::LinearForms;
use symbolic::{CompileError, Evaluator, Expr, Graph, Symbol};

use super::pivots::{Entry, POINTS, Pattern};
use crate::equations::{Block, Equations};

/// `J z = b`, row by row.
#[derive(Clone)]
pub(crate) struct LinearBlock {
    pub(crate) unknowns: Vec<Symbol>,
    pub(crate) rows: Vec<BTreeMap<usize, Expr>>,
    pub(crate) right: Vec<Expr>,
}

/// The block as `J z = b`; `None` where it is not linear.
pub(crate) fn linear_block(g: &Graph, block: &Block) -> Option<LinearBlock> {
    let LinearForms { rows, offsets } = LinearForms::new(g, &block.residuals, &block.unknowns).ok()?;
    let right = offsets.into_iter().map(|b| g.neg(b)).collect();
    Some(LinearBlock { unknowns: block.unknowns.clone(), rows, right })
}

/// Changes the signs of rows so that `J` is its own transpose, where that does it.
pub(crate) fn make_symmetric(g: &Graph, block: &mut LinearBlock) -> bool {
    let n = block.rows.len();
    let mut signs = vec![0_i8; n];
    for start in 0..n {
        if signs[start] != 0 {
            continue;
        }
        signs[start] = 1;
        let mut pending = vec![start];
        while let Some(i) = pending.pop() {
            for (&j, &e) in &block.rows[i] {
                let sign = match block.rows[j].get(&i) {
                    Some(&mirrored) if mirrored == e => signs[i],
                    Some(&mirrored) if mirrored == g.neg(e) => -signs[i],
                    _ => return false,
                };
                match signs[j] {
                    0 => {
                        signs[j] = sign;
                        pending.push(j);
                    }
                    found if found != sign => return false,
                    _ => {}
                }
            }
        }
    }
    for (i, _) in signs.iter().enumerate().filter(|(_, s)| **s < 0) {
        block.rows[i].values_mut().for_each(|e| *e = g.neg(*e));
        block.right[i] = g.neg(block.right[i]);
    }
    true
}

/// The matrix in numbers; `None` where it is not finite or has an empty row or column.
pub(crate) fn pattern(
    equations: &Equations,
    block: &LinearBlock,
    known: &[Symbol],
    points: &[Vec<f64>; POINTS],
) -> Result<Option<Pattern>, CompileError> {
    let g = &equations.graph;
    let entries: Vec<Expr> = block.rows.iter().flat_map(|row| row.values().copied()).collect();
    let mut evaluator = Evaluator::new(g.compile(known, &entries, &equations.parameters)?);
    let mut values: Vec<Vec<f64>> = points.iter().map(|point| evaluator.evaluate(point).to_vec()).collect();
    if !values[1].iter().all(|x| x.is_finite()) {
        values[1] = values[0].clone(); // the point beside it is outside of where the equations mean something
    }
    let mut entry = 0;
    let rows = block.rows.iter().map(|row| {
        row.iter()
            .map(|(&j, &e)| {
                let constant = g.symbols_of(e).iter().all(|s| equations.parameters.contains_key(s));
                let values = std::array::from_fn(|point| values[point][entry]);
                entry += 1;
                (j, Entry { values, constant })
            })
            .collect()
    });
    Ok(Pattern::new(rows.collect()))
}
