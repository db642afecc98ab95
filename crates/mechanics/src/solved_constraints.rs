//! Constraints linear in the velocities, solved for as many of them.

use std::collections::{BTreeMap, HashMap};

use symbolic::{Expr, Graph, Matrix, Symbol};

use crate::elimination::{Candidate, LinearForms, Pivot, SparseMatrix, choose_pivot};
use crate::{RemovalError, State, System};

/// `v_d = K v_i + c`.
pub(crate) struct SolvedConstraints {
    pub(crate) dependent: Vec<usize>,
    pub(crate) independent: Vec<usize>,
    /// K, h×m.
    pub(crate) solution: Matrix,
    /// c, h.
    pub(crate) offset: Vec<Expr>,
    /// What was divided by the pivots, in `(q, t)`: it grows where one of them becomes small.
    pub(crate) quotients: Vec<Expr>,
}

impl SolvedConstraints {
    pub(crate) fn new(system: &System, state: &State) -> Result<SolvedConstraints, RemovalError> {
        let g = &system.graph;
        let (n, h) = (system.dimension(), system.constraints.len());
        let constants = system.parameter_values();
        let mut values = constants.clone();
        values.extend(system.values_at(state));
        let LinearForms { mut rows, offsets } = system.linear_constraints()?;
        // [A | b]
        for (row, &offset) in rows.iter_mut().zip(&offsets).filter(|(_, b)| !g.is_zero(**b)) {
            row.insert(n, offset);
        }
        let mut matrix = SparseMatrix::new(rows);
        let mut pivots: BTreeMap<usize, usize> = BTreeMap::new();
        let mut quotients = Vec::new();
        for _ in 0..h {
            let (p, c) = choose_pivot(candidates(g, &matrix, &pivots, n, &values))?;
            let Some(Pivot { entry: pivot, row, column }) = matrix.take(p, c) else { break };
            let undivided = row;
            let row: BTreeMap<usize, Expr> = undivided.iter().map(|(&j, &e)| (j, g.div(e, pivot))).collect();
            quotients.extend(row.range(..n).map(|(_, &e)| e));
            for (i, factor) in column {
                for (&j, &e) in &row {
                    let before = matrix.rows()[i].get(&j).copied().unwrap_or(g.zero());
                    let rest = g.sub(before, g.mul(factor, e));
                    // sin²/cos + cos is 1/cos
                    let over_pivot = g.expand(g.sub(g.mul(before, pivot), g.mul(factor, undivided[&j])));
                    let over_pivot = cleared(g, g.div(over_pivot, pivot));
                    let rest = if 3 * g.size(&[over_pivot]) <= 4 * g.size(&[rest]) { over_pivot } else { rest };
                    // what cancels unsimplified would be taken for a pivot, or for a dependence that is none
                    matrix.set(i, j, (!g.vanishes_at_points(rest, &constants).is_zero()).then_some(rest));
                }
            }
            matrix.put_row(p, row);
            pivots.insert(c, p);
        }
        let dependent: Vec<usize> = pivots.keys().copied().collect();
        let independent: Vec<usize> = (0..n).filter(|j| !pivots.contains_key(j)).collect();
        let rows: Vec<&BTreeMap<usize, Expr>> = pivots.values().map(|&p| &matrix.rows()[p]).collect();
        let entry = |row: &BTreeMap<usize, Expr>, j: usize| row.get(&j).map_or(g.zero(), |&e| g.neg(e));
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

/// What is no pivot yet, with its size in its row and the length of its expression.
fn candidates(
    g: &Graph,
    matrix: &SparseMatrix<Expr>,
    taken: &BTreeMap<usize, usize>,
    columns: usize,
    values: &HashMap<Symbol, f64>,
) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    for (i, row) in matrix.rows().iter().enumerate().filter(|(i, _)| !taken.values().any(|p| p == i)) {
        let number = |e: Expr| g.evaluate(e, values).unwrap_or(f64::NAN);
        let entries: Vec<(usize, Expr, f64)> = row.range(..columns).map(|(&j, &e)| (j, e, number(e))).collect();
        let scale = entries.iter().fold(0.0_f64, |a, (_, _, x)| a.max(x.abs()));
        for (j, e, x) in entries {
            let size = if scale > 0.0 { x.abs() / scale } else { 0.0 };
            if size.is_finite() && size > 0.0 {
                candidates.push(Candidate { size, cost: g.size(&[e]), place: (i, j) });
            }
        }
    }
    candidates
}

/// `e` multiplied out where fewer denominators are left so: the others are none, and would end a motion.
pub(crate) fn cleared(g: &Graph, e: Expr) -> Expr {
    let expanded = g.expand(e);
    if g.denominators(&[expanded]).len() < g.denominators(&[e]).len() { expanded } else { e }
}
