//! Divisors in expressions.

use crate::{Expr, Graph, Range, Symbol};
use rustc_hash::FxHashMap;
use std::collections::HashMap;

impl Graph {
    /// Divisors in `es` that may vanish: bases of negative powers, and of powers whose exponents are not
    /// numbers; the cosine under a tangent. `known` are ranges of symbols, such as the values of parameters.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let never = g.add(g.powi(x, 2), g.one());
    /// assert_eq!(g.divisors(&[g.powi(x, -2), g.powi(never, -1)], &HashMap::new()), [x]);
    /// ```
    pub fn divisors(&self, es: &[Expr], known: &HashMap<Symbol, Range>) -> Vec<Expr> {
        let mut ranges = FxHashMap::default();
        let mut vanishes = |e: &Expr| {
            let Range { low, high } = self.range_among(*e, known, &mut ranges);
            low <= 0.0 && high >= 0.0
        };
        self.divided_by(es, |_, _| true).into_iter().filter(|base| vanishes(base)).collect()
    }
}
