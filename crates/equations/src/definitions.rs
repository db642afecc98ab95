//! Intermediate quantities of equations: each short, in states, unknowns, parameters and earlier ones.

use std::collections::{HashMap, HashSet};

use symbolic::limits::SHORT;
use symbolic::{Expr, Graph, Symbol};

use mechanics::fresh_symbol;

/// Intermediate quantities in the order of their computation. A recursion written as definitions is as long
/// as the system; with everything put in, it would be as long as its square, or longer.
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

    /// `e` itself if it has at most `limit` nodes, else a new symbol `stem_1`, `stem_2`, … defined as `e`.
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

/// The symbols in `roots`, and in the definitions that these use.
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

/// Definitions that contain no unknowns, and those that do, by way of others too.
pub(crate) type Apart = (Vec<(Symbol, Expr)>, Vec<(Symbol, Expr)>);

/// `definitions` in two: those known beforehand, and those that wait for `unknowns`.
pub(crate) fn apart(g: &Graph, definitions: &[(Symbol, Expr)], unknowns: &[Symbol]) -> Apart {
    let mut waiting: HashSet<Symbol> = unknowns.iter().copied().collect();
    definitions.iter().copied().partition(|&(symbol, e)| {
        let waits = g.symbols_of(e).iter().any(|s| waiting.contains(s));
        if waits {
            waiting.insert(symbol);
        }
        !waits
    })
}

/// Derivatives through definitions: `∂e/∂s`, row-major, for the outputs and independent symbols of each of
/// `wanted` in turn, and all definitions then needed. With `e(s, d)`, `d = D(s, d earlier)`:
///
/// ```text
/// de/ds = ∂e/∂s + Σ ∂e/∂d · dd/ds ,     the sum over the definitions that e contains.
/// ```
pub(crate) fn jacobian(
    g: &Graph,
    definitions: &[(Symbol, Expr)],
    wanted: &[(&[Expr], &[Symbol])],
) -> (Vec<(Symbol, Expr)>, Vec<Expr>) {
    let independent: HashSet<Symbol> = wanted.iter().flat_map(|(_, by)| by.iter().copied()).collect();
    let inner: HashSet<Symbol> = definitions.iter().map(|d| d.0).chain(independent.iter().copied()).collect();
    let mut all = Definitions::default();
    // for each definition, the symbols that it depends on, and the derivatives
    let mut known: HashMap<Symbol, Vec<(Symbol, Expr)>> = HashMap::new();
    let row = |known: &HashMap<Symbol, Vec<(Symbol, Expr)>>, e: Expr| {
        let mut terms: Vec<(Symbol, Expr)> = Vec::new();
        let within: Vec<Symbol> = g.symbols_of(e).into_iter().filter(|s| inner.contains(s)).collect();
        for (s, derivative) in g.sparse_gradient(e, &within) {
            match known.get(&s) {
                _ if independent.contains(&s) => terms.push((s, derivative)),
                Some(row) => terms.extend(row.iter().map(|&(s, d)| (s, g.mul(derivative, d)))),
                None => {}
            }
        }
        terms.sort_by_key(|t| t.0);
        let groups = terms.chunk_by(|a, b| a.0 == b.0);
        let sum = |group: &[(Symbol, Expr)]| g.sum(&group.iter().map(|t| t.1).collect::<Vec<Expr>>());
        groups.map(|group| (group[0].0, sum(group))).collect::<Vec<(Symbol, Expr)>>()
    };
    for &(symbol, e) in definitions {
        all.define(symbol, e);
        let mut derivatives = row(&known, e);
        for (_, d) in &mut derivatives {
            *d = all.short(g, "d", SHORT, *d);
        }
        known.insert(symbol, derivatives);
    }
    let mut entries = Vec::new();
    for (outputs, by) in wanted {
        let places: HashMap<Symbol, usize> = by.iter().enumerate().map(|(i, &s)| (s, i)).collect();
        for &e in *outputs {
            let first = entries.len();
            entries.resize(first + by.len(), g.zero());
            for (s, d) in row(&known, e) {
                if let Some(place) = places.get(&s) {
                    entries[first + place] = d;
                }
            }
        }
    }
    (all.into_list(), entries)
}
