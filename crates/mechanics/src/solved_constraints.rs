//! Constraints linear in the velocities, solved for as many of them.

use std::collections::{BTreeMap, HashMap};

use symbolic::limits::{BESIDE, NOTHING, TOO_LONG};
use symbolic::{Expr, Graph, Matrix, Symbol};

use crate::elimination::{Candidate, LinearForms, Pivot, SparseMatrix, choose_pivot};
use crate::{RemovalError, State, System};

/// What is multiplied out may add up this much more than what it stands for: near `q = 24` the powers of `q`
/// that are `(q − 24)⁴` add up a million to come to nothing.
const ADDED_UP: f64 = 1e3;

/// A coefficient, its value at the start (NaN where that is not finite) and the nodes of its expression.
#[derive(Clone, Copy)]
struct Entry {
    e: Expr,
    number: f64,
    size: usize,
}

/// `v_d = K v_i + c`.
pub(crate) struct SolvedConstraints {
    pub(crate) dependent: Vec<usize>,
    pub(crate) independent: Vec<usize>,
    /// K, h×m.
    pub(crate) solution: Matrix,
    /// c, h.
    pub(crate) offset: Vec<Expr>,
    /// Quotients with the pivots as divisors, in `(q, t)`: they grow where a pivot becomes small.
    pub(crate) quotients: Vec<Expr>,
}

impl SolvedConstraints {
    pub(crate) fn new(system: &System, state: &State) -> Result<SolvedConstraints, RemovalError> {
        let g = &system.graph;
        let (n, h) = (system.dimension(), system.constraints.len());
        let values = system.values_at(state);
        let forms = system.linear_constraints()?;
        let speeds = system.speeds(&forms, state);
        let LinearForms { mut rows, offsets } = forms;
        // [A | b]
        for (row, &offset) in rows.iter_mut().zip(&offsets).filter(|(_, b)| !g.is_zero(**b)) {
            row.insert(n, offset);
        }
        let number = |e: Expr| g.evaluate(e, &values).unwrap_or(f64::NAN);
        let sized = |e: Expr, number: f64| Entry { e, number, size: g.size(&[e]) };
        let known = |e: Expr| sized(e, number(e));
        let all_known = |row: BTreeMap<usize, Expr>| row.into_iter().map(|(j, e)| (j, known(e))).collect();
        let mut matrix: SparseMatrix<Entry> = SparseMatrix::new(rows.into_iter().map(all_known).collect());
        // at the start itself much is zero
        let beside: HashMap<Symbol, f64> = values.iter().map(|(&s, x)| (s, (1.0 + BESIDE) * x)).collect();
        let added_up = |entry: Entry| {
            let value = g.bounded(entry.e, &beside).filter(|value| value.is_finite());
            value.map_or(f64::INFINITY, |value| value.magnitude)
        };
        // those of a chain double with each body, and little cancels in them
        let mut terms_left = TOO_LONG;
        // before − factor · entry, where entry is undivided/pivot
        let mut difference = |before: Entry, factor: Entry, entry: Entry, (undivided, pivot): (Expr, Expr)| {
            let was_zero = before.number == 0.0 && (factor.number == 0.0 || entry.number == 0.0);
            let e = g.sub(before.e, g.mul(factor.e, entry.e));
            let subtracted = factor.number * entry.number;
            // where nothing cancels, the numbers are as good as the expression
            let same = (before.number - subtracted).abs() > NOTHING * (before.number.abs() + subtracted.abs());
            let mut rest = sized(e, if same { before.number - subtracted } else { number(e) });
            // sin²/cos + cos is 1/cos
            let over_pivot = g.sub(g.mul(before.e, pivot), g.mul(factor.e, undivided));
            let terms = if rest.size > TOO_LONG { usize::MAX } else { g.expanded_terms(over_pivot) };
            if terms <= terms_left {
                terms_left -= terms;
                let over_pivot = known(cleared(g, g.div(g.expand_around_shifts(over_pivot), pivot)));
                let is_short = 3 * over_pivot.size <= 4 * rest.size;
                let better = is_short && added_up(over_pivot) <= ADDED_UP * added_up(rest);
                rest = if better { over_pivot } else { rest };
            }
            // what cancels unsimplified would be taken for a pivot, or for a dependence that is none
            let terms = before.number.abs() + subtracted.abs();
            let cancels = was_zero || rest.number.abs() <= NOTHING * terms;
            let stays = !(g.is_zero(rest.e) || cancels && g.vanishes_exactly(rest.e));
            if was_zero || cancels && g.is_round_off(rest.e, &values) {
                rest.number = 0.0;
            }
            stays.then_some(rest)
        };
        let mut pivots: BTreeMap<usize, usize> = BTreeMap::new();
        let mut quotients = Vec::new();
        for _ in 0..h {
            let (p, c) = choose_pivot(candidates(&matrix, &pivots, &speeds))?;
            let Some(Pivot { entry: pivot, row: undivided, column }) = matrix.take(p, c) else { break };
            let divided = |entry: &Entry| sized(g.div(entry.e, pivot.e), entry.number / pivot.number);
            let row: BTreeMap<usize, Entry> = undivided.iter().map(|(&j, entry)| (j, divided(entry))).collect();
            quotients.extend(row.range(..n).map(|(_, entry)| entry.e));
            for (i, factor) in column {
                for (&j, &entry) in &row {
                    let before = matrix.rows()[i].get(&j).copied().unwrap_or_else(|| sized(g.zero(), 0.0));
                    matrix.set(i, j, difference(before, factor, entry, (undivided[&j].e, pivot.e)));
                }
            }
            matrix.put_row(p, row);
            pivots.insert(c, p);
        }
        let dependent: Vec<usize> = pivots.keys().copied().collect();
        let independent: Vec<usize> = (0..n).filter(|j| !pivots.contains_key(j)).collect();
        let rows: Vec<&BTreeMap<usize, Entry>> = pivots.values().map(|&p| &matrix.rows()[p]).collect();
        let entry = |row: &BTreeMap<usize, Entry>, j: usize| row.get(&j).map_or(g.zero(), |entry| g.neg(entry.e));
        let solution = Matrix::from_fn(h, independent.len(), |i, j| entry(rows[i], independent[j]));
        let offset = rows.iter().map(|row| entry(row, n)).collect();
        Ok(SolvedConstraints { dependent, independent, solution, offset, quotients })
    }

    /// Fields that span the admissible directions in the space of `q`, or of `(q, t)`.
    pub(crate) fn fields(&self, system: &System, with_time: bool) -> Vec<Vec<Expr>> {
        let g = &system.graph;
        let size = system.dimension() + usize::from(with_time);
        let field = |own: usize, of_dependent: &dyn Fn(usize) -> Expr| {
            let mut x = vec![g.zero(); size];
            x[own] = g.one();
            for (row, &i) in self.dependent.iter().enumerate() {
                x[i] = of_dependent(row);
            }
            x
        };
        let mut fields: Vec<Vec<Expr>> = (0..self.independent.len())
            .map(|column| field(self.independent[column], &|row| self.solution[(row, column)]))
            .collect();
        if with_time {
            fields.push(field(size - 1, &|row| self.offset[row]));
        }
        fields
    }

    pub(crate) fn independent_rates(&self, system: &System) -> Vec<Symbol> {
        self.independent.iter().map(|&i| system.coordinates[i].velocity).collect()
    }

    /// Row of `K v_i + c`.
    pub(crate) fn rate(&self, system: &System, row: usize, independent: &[Expr]) -> Expr {
        let g = &system.graph;
        g.add(g.dot(self.solution.row(row), independent), self.offset[row])
    }
}

/// What is not a pivot yet, with its part in its row, all coordinates as fast as each other, and the length
/// of its expression.
fn candidates(matrix: &SparseMatrix<Entry>, taken: &BTreeMap<usize, usize>, speeds: &[f64]) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    for (i, row) in matrix.rows().iter().enumerate().filter(|(i, _)| !taken.values().any(|p| p == i)) {
        let size = |(&j, entry): (&usize, &Entry)| entry.number.abs() * speeds[j];
        let scale = row.range(..speeds.len()).map(size).fold(0.0, f64::max);
        for (&j, entry) in row.range(..speeds.len()) {
            let size = if scale > 0.0 { size((&j, entry)) / scale } else { 0.0 };
            if size.is_finite() && size > 0.0 {
                candidates.push(Candidate { size, cost: entry.size, place: (i, j) });
            }
        }
    }
    candidates
}

/// `e` multiplied out where fewer denominators are left so: the others are none, and would end a motion.
pub(crate) fn cleared(g: &Graph, e: Expr) -> Expr {
    if g.expanded_terms(e) > TOO_LONG {
        return e;
    }
    let expanded = g.expand_around_shifts(e);
    if g.denominators(&[expanded]).len() < g.denominators(&[e]).len() { expanded } else { e }
}
