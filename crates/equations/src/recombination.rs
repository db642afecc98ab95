//! Multipliers of constraints that were recombined.

use std::collections::HashMap;

use mechanics::Recombination;
use symbolic::Matrix;

use crate::equations::{Equations, LeftOut};

impl Equations {
    /// Equations of [`Recombination::system`] whose multipliers, handed out and given at the start, are those
    /// of the constraints as given: `λ = Tᵀ λ'` where the constraints were replaced by `f' = T f`.
    pub fn with_multipliers_restored(mut self, recombination: &Recombination) -> Self {
        let g = &self.graph;
        let numbers = |m: &nalgebra::DMatrix<f64>| Matrix::from_fn(m.nrows(), m.ncols(), |i, j| g.number(m[(i, j)]));
        let back = recombination.matrix.transpose();
        if self.multipliers.len() == back.ncols() {
            let own: Vec<_> = self.multipliers.iter().map(|m| m.expression).collect();
            for (multiplier, e) in self.multipliers.iter_mut().zip(g.mat_vec(&numbers(&back), &own)) {
                multiplier.expression = e;
            }
        }
        // μ = Tᵀ μ', so that μ'₀ = T⁻ᵀ μ₀
        let starts = self.constant_symbols();
        if let Some(inverse) = back.try_inverse().filter(|m| m.ncols() == starts.len()) {
            let given = g.mat_vec(&numbers(&inverse), &g.variables(&starts));
            let map: HashMap<_, _> = starts.into_iter().zip(given).collect();
            for state in &mut self.states {
                state.start = g.substitute(state.start, &map);
            }
            for guess in self.blocks.iter_mut().flat_map(|block| &mut block.guess) {
                *guess = g.substitute(*guess, &map);
            }
        }
        let words = format!(
            "the constraints are nearly dependent at the start (ratio of singular values {:.1e}) and were replaced by orthonormal combinations of them, \
             which have the same motion; multipliers are handed out for the constraints as given",
            recombination.ratio
        );
        self.left_out.push(LeftOut { variables: Vec::new(), words });
        self
    }
}
