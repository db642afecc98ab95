//! Intermediate quantities of equations: each a short expression in states, parameters and earlier ones.

use std::collections::{HashMap, HashSet};

use symbolic::{Expr, Graph, Symbol};

use crate::fresh_symbol;

/// Intermediate quantities in the order of their computation. A recursion written as definitions is as long as the system; with everything
/// put in, it would be as long as its square, or longer.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    list: Vec<(Symbol, Expr)>,
    counts: HashMap<String, usize>,
}

impl Definitions {
    /// Symbols with their expressions; each contains earlier ones only.
    pub fn list(&self) -> &[(Symbol, Expr)] {
        &self.list
    }

    /// The list itself.
    pub fn into_list(self) -> Vec<(Symbol, Expr)> {
        self.list
    }

    /// Adds a definition of a symbol that exists already.
    pub fn define(&mut self, symbol: Symbol, e: Expr) {
        self.list.push((symbol, e));
    }

    /// `e` itself if it has at most `limit` nodes, else a new symbol `stem_1`, `stem_2`, … that is defined as `e`.
    pub fn short(&mut self, g: &Graph, stem: &str, limit: usize, e: Expr) -> Expr {
        if g.size(&[e]) <= limit {
            return e;
        }
        let count = self.counts.entry(stem.into()).or_insert(0);
        *count += 1;
        let symbol = fresh_symbol(g, &format!("{stem}_{count}"));
        self.define(symbol, e);
        g.variable(symbol)
    }
}

/// Those of `definitions` that `outputs` need, where `inputs` are known.
pub(crate) fn needed(
    g: &Graph,
    definitions: &[(Symbol, Expr)],
    inputs: &[Symbol],
    outputs: &[Expr],
) -> Vec<(Symbol, Expr)> {
    if definitions.is_empty() {
        return Vec::new();
    }
    let inputs: HashSet<Symbol> = inputs.iter().copied().collect();
    let mut wanted: HashSet<Symbol> = outputs.iter().flat_map(|&e| g.symbols_of(e)).collect();
    let mut kept = Vec::new();
    for &(symbol, e) in definitions.iter().rev() {
        if wanted.contains(&symbol) && !inputs.contains(&symbol) {
            wanted.extend(g.symbols_of(e));
            kept.push((symbol, e));
        }
    }
    kept.reverse();
    kept
}

/// The symbols in `roots`, and in the definitions by way of which they are computed.
pub(crate) fn symbols_behind(
    g: &Graph,
    definitions: &[(Symbol, Expr)],
    roots: impl IntoIterator<Item = Expr>,
) -> HashSet<Symbol> {
    let mut found: HashSet<Symbol> = roots.into_iter().flat_map(|e| g.symbols_of(e)).collect();
    for &(symbol, e) in definitions.iter().rev() {
        if found.contains(&symbol) {
            found.extend(g.symbols_of(e));
        }
    }
    found
}

/// Derivatives through definitions: `∂e/∂s` row-major for `outputs` and the independent symbols `by`, and the definitions that this needs,
/// those of `definitions` among them. With `e(s, d)`, `d = D(s, d earlier)`:
///
/// ```text
/// de/ds = ∂e/∂s + Σ ∂e/∂d · dd/ds ,     the sum over the definitions that e contains.
/// ```
pub(crate) fn jacobian(
    g: &Graph,
    definitions: &[(Symbol, Expr)],
    outputs: &[Expr],
    by: &[Symbol],
) -> (Vec<(Symbol, Expr)>, Vec<Expr>) {
    /// Nodes of a derivative that gets no name of its own.
    const SHORT: usize = 8;
    let places: HashMap<Symbol, usize> = by.iter().enumerate().map(|(i, &s)| (s, i)).collect();
    let inner: Vec<Symbol> = definitions.iter().map(|d| d.0).chain(by.iter().copied()).collect();
    let mut all = Definitions::default();
    // for each definition, the places of the symbols that it depends on, and the derivatives
    let mut known: HashMap<Symbol, Vec<(usize, Expr)>> = HashMap::new();
    let row = |known: &HashMap<Symbol, Vec<(usize, Expr)>>, e: Expr| {
        let mut terms: Vec<(usize, Expr)> = Vec::new();
        for (s, derivative) in g.sparse_gradient(e, &inner) {
            match (places.get(&s), known.get(&s)) {
                (Some(&place), _) => terms.push((place, derivative)),
                (None, Some(row)) => terms.extend(row.iter().map(|&(place, d)| (place, g.mul(derivative, d)))),
                (None, None) => {}
            }
        }
        terms.sort_by_key(|t| t.0);
        let groups = terms.chunk_by(|a, b| a.0 == b.0);
        let sum = |group: &[(usize, Expr)]| g.sum(&group.iter().map(|t| t.1).collect::<Vec<Expr>>());
        groups.map(|group| (group[0].0, sum(group))).collect::<Vec<(usize, Expr)>>()
    };
    for &(symbol, e) in definitions {
        all.define(symbol, e);
        let mut derivatives = row(&known, e);
        for (_, d) in &mut derivatives {
            *d = all.short(g, "d", SHORT, *d);
        }
        known.insert(symbol, derivatives);
    }
    let mut matrix = vec![g.zero(); outputs.len() * by.len()];
    for (i, &e) in outputs.iter().enumerate() {
        for (j, d) in row(&known, e) {
            matrix[i * by.len() + j] = d;
        }
    }
    (all.into_list(), matrix)
}
