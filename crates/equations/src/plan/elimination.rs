//! Elimination of a sparse linear block `J z = b` in expressions: what is left is a list of definitions.

use std::collections::{BTreeMap, HashMap};

use mechanics::elimination::{Pivot, SparseMatrix};
use symbolic::{Expr, Graph, Range, Symbol};

use super::linear_block::LinearBlock;
use super::pivots::Order;

/// A part of the condition that is never over this need not be watched.
const HARMLESS: f64 = 1e4;

/// Eliminated of all unknowns, and what has to stay small for them to be accurate.
#[derive(Clone, Default)]
pub(crate) struct Eliminated {
    pub(crate) list: Vec<(Symbol, Expr)>,
    /// Squares of multipliers (entry over pivot, scaled as at the start) and of what cancelled in a pivot.
    pub(crate) watched: Vec<Expr>,
    /// Pivots that are watched.
    pub(crate) moving: usize,
}

/// The row of a pivot: what is left of it when the rows before are taken out.
struct Solved {
    unknown: usize,
    /// One over the pivot.
    reciprocal: Expr,
    /// Entries of unknowns that are eliminated later.
    others: Vec<(usize, Expr)>,
    right: Expr,
}

/// Expressions on their way into definitions.
pub(crate) struct Elimination<'a> {
    pub(crate) graph: &'a Graph,
    /// What is known of symbols: parameters, and definitions so far.
    pub(crate) ranges: HashMap<Symbol, Range>,
    /// Expressions with more nodes get a name of their own.
    pub(crate) inline: usize,
    /// Number of names given so far.
    pub(crate) names: usize,
    named: HashMap<Expr, Expr>,
    found: Eliminated,
}

impl<'a> Elimination<'a> {
    pub(crate) fn new(graph: &'a Graph, parameters: &HashMap<Symbol, f64>, inline: usize, names: usize) -> Self {
        let ranges = parameters.iter().map(|(&s, &x)| (s, Range::point(x))).collect();
        Elimination { graph, ranges, inline, names, named: HashMap::new(), found: Eliminated::default() }
    }

    /// Eliminates in the given order; `symmetric`: diagonal pivots of a symmetric matrix; `scale`: of rows.
    ///
    /// `None` where a pivot is identically zero.
    pub(crate) fn run(
        mut self,
        block: &LinearBlock,
        order: &Order,
        symmetric: bool,
        scale: &[f64],
    ) -> Option<Eliminated> {
        let g = self.graph;
        // entries and right-hand sides as terms that are yet to be added up
        let terms = |row: &BTreeMap<usize, Expr>| row.iter().map(|(&j, &e)| (j, vec![e])).collect();
        let mut matrix: SparseMatrix<Vec<Expr>> = SparseMatrix::new(block.rows.iter().map(terms).collect());
        let mut right: Vec<Vec<Expr>> = block.right.iter().map(|&b| vec![b]).collect();
        let mut solved = Vec::new();
        for &(p, c) in &order.pivots {
            let Pivot { entry: terms, row, column } = matrix.take(p, c)?;
            let pivot = self.total(&terms);
            if g.is_zero(pivot) {
                return None;
            }
            let reciprocal = self.bind(g.powi(pivot, -1));
            let others: Vec<(usize, Expr)> = row.into_iter().map(|(j, t)| (j, self.total(&t))).collect();
            let b = self.total(&right[p]);
            let mut growth = Vec::new();
            for (i, under) in column {
                let factor = g.mul(self.total(&under), reciprocal);
                let factor = self.bind(factor);
                if g.is_zero(factor) {
                    continue;
                }
                growth.push((factor, scale[i] / scale[p]));
                right[i].push(g.neg(g.mul(factor, b)));
                for &(j, other) in others.iter().filter(|(j, e)| !g.is_zero(*e) && (!symmetric || i <= *j)) {
                    let term = g.neg(g.mul(factor, other));
                    matrix.entry(i, j, Vec::new()).push(term);
                    if symmetric && i != j {
                        matrix.entry(j, i, Vec::new()).push(term);
                    }
                }
            }
            self.watch(&terms, pivot, reciprocal, &growth);
            solved.push(Solved { unknown: c, reciprocal, others, right: b });
        }
        self.substitute_back(block, solved);
        Some(self.found)
    }

    /// `z_c = (b − Σ a_cj z_j)/a_cc`, last pivot first.
    fn substitute_back(&mut self, block: &LinearBlock, solved: Vec<Solved>) {
        let g = self.graph;
        let mut values: HashMap<usize, Expr> = HashMap::new();
        for Solved { unknown: c, reciprocal, others, right } in solved.into_iter().rev() {
            let mut terms = vec![right];
            terms.extend(others.into_iter().map(|(j, e)| g.neg(g.mul(e, values[&j]))));
            let value = g.mul(self.total(&terms), reciprocal);
            self.found.list.push((block.unknowns[c], value));
            let short = g.size(&[value]) <= self.inline;
            values.insert(c, if short { value } else { g.variable(block.unknowns[c]) });
        }
    }

    fn total(&mut self, terms: &[Expr]) -> Expr {
        let sum = self.graph.sum(terms);
        self.bind(sum)
    }

    /// A name for what is not short.
    fn bind(&mut self, e: Expr) -> Expr {
        let g = self.graph;
        if g.size(&[e]) <= self.inline {
            return e;
        }
        if let Some(&name) = self.named.get(&e) {
            return name;
        }
        let symbol = g.symbol(&format!("plan {}", self.names));
        self.names += 1;
        let range = g.range(e, &self.ranges);
        self.ranges.insert(symbol, range);
        self.found.list.push((symbol, e));
        self.named.insert(e, g.variable(symbol));
        g.variable(symbol)
    }

    /// Puts down what tells of a pivot that is too small: multipliers, and terms that cancelled.
    fn watch(&mut self, terms: &[Expr], pivot: Expr, reciprocal: Expr, multipliers: &[(Expr, f64)]) {
        let g = self.graph;
        let moves = |e: &Expr| g.symbols_of(*e).iter().any(|s| self.ranges.get(s).is_none_or(|r| r.low != r.high));
        let mut watched: Vec<Expr> = multipliers
            .iter()
            .filter(|(e, _)| moves(e))
            .map(|&(e, scale)| {
                // powers of 16, so that terms with the same factor are added up before it is multiplied
                let scale = 16.0_f64.powi((scale.log2() / 4.0).round() as i32);
                g.mul(g.number(scale * scale), g.powi(e, 2))
            })
            .collect();
        if moves(&pivot) {
            let squares = self.cancelling(terms).into_iter().map(|e| g.powi(g.mul(e, reciprocal), 2));
            watched.extend(squares);
        }
        watched.retain(|&e| g.range(e, &self.ranges).high > HARMLESS);
        self.found.moving += usize::from(!watched.is_empty());
        self.found.watched.extend(watched);
    }

    /// Parts of a sum such that, where terms cancel, at least one part is large compared with the sum. Terms
    /// of one sign form one part. If one part is large, so is another: the longest is therefore left out.
    fn cancelling(&self, terms: &[Expr]) -> Vec<Expr> {
        let g = self.graph;
        let (mut parts, mut signed) = (Vec::new(), [Vec::new(), Vec::new()]);
        for &t in terms {
            let range = g.range(t, &self.ranges);
            match (range.low >= 0.0, range.high <= 0.0) {
                (true, _) => signed[0].push(t),
                (_, true) => signed[1].push(t),
                _ => parts.push(t),
            }
        }
        parts.extend(signed.iter().filter(|s| !s.is_empty()).map(|s| g.sum(s)));
        let longest = (0..parts.len()).max_by_key(|&i| g.size(&[parts[i]]));
        longest.into_iter().for_each(|i| {
            parts.remove(i);
        });
        parts
    }
}
