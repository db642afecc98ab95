//! Constraints that are integrable each on its own.

use std::collections::{BTreeMap, BTreeSet};

use symbolic::{Expr, Symbol};

use crate::elimination::LinearForms;
use crate::{RemovalError, State, System};

impl System {
    /// How many independent combinations of the constraints are known to be integrable: exactly, and without
    /// brackets.
    pub fn integrable_constraints(&self, state: &State) -> usize {
        let known = self.without_exact_constraints(state).and_then(|(rest, _)| {
            let exact = self.constraints.len() - rest.constraints.len();
            Ok(exact + rest.integrable_alone()?)
        });
        known.unwrap_or(self.on_positions.len())
    }

    /// How many of the constraints are integrable each on its own: `ω ∧ dω = 0` for `ω = Σ a_j dq_j + b dt`,
    /// exactly, that is `ω = g dh` (Frobenius).
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`]
    pub(crate) fn integrable_alone(&self) -> Result<usize, RemovalError> {
        let g = &self.graph;
        let LinearForms { rows, offsets } = self.linear_constraints()?;
        let places: Vec<Symbol> = self.positions().into_iter().chain([self.time]).collect();
        let is_integrable = |(row, offset): &(BTreeMap<usize, Expr>, Expr)| {
            let a = |j: usize| row.get(&j).copied().unwrap_or(if j + 1 == places.len() { *offset } else { g.zero() });
            let turn = |j: usize, k: usize| g.sub(g.derivative(a(k), places[j]), g.derivative(a(j), places[k]));
            // of other places there are neither coefficients nor derivatives
            let seen: BTreeSet<Symbol> = row.values().chain([offset]).flat_map(|&e| g.symbols_of(e)).collect();
            let written = |&j: &usize| !g.is_zero(a(j)) || seen.contains(&places[j]);
            let own: Vec<usize> = (0..places.len()).filter(written).collect();
            let after = |i: usize| own.iter().copied().filter(move |&j| j > i);
            let pairs = |i: usize| after(i).flat_map(move |j| after(j).map(move |k| [i, j, k]));
            own.iter().copied().flat_map(pairs).all(|[i, j, k]| {
                let terms = [[i, j, k], [j, k, i], [k, i, j]].map(|[i, j, k]| g.mul(a(i), turn(j, k)));
                let sum = g.sum(&terms);
                g.vanishes_exactly(sum) || g.vanishes_exactly(self.as_written(sum))
            })
        };
        let exact = |(row, _): &(BTreeMap<usize, Expr>, Expr)| g.are_exact(&row.values().copied().collect::<Vec<_>>());
        Ok(rows.into_iter().zip(offsets).filter(|row| exact(row) && is_integrable(row)).count())
    }
}
