//! The columns of `S`, and what they make of a mass matrix and of a force.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use symbolic::limits::LONG;
use symbolic::{Expr, Graph, Symbol};

use super::recursion::QuasiVelocities;
use crate::expressions::{SHORT, Sparse, products};
use equations::Definitions;

/// Nodes of a link's coefficient, a sum, that gets no name of its own: those of links after it contain it.
const LINK: usize = 3;
/// Nodes of a side of reduced equations that gets no name of its own.
pub(super) const SIDE: usize = 24;

/// `S(q, t)`, n×(n − h), sparse: one column a quasi-velocity, in which the entries stand by coordinate.
#[derive(Clone, Debug)]
pub struct Columns {
    columns: Vec<Sparse>,
    singles: HashMap<Symbol, Single>,
}

/// The coefficient of a dependent velocity that hangs on one quasi-velocity alone, by way of such: `v = S w`.
#[derive(Clone, Copy, Debug)]
pub struct Single {
    /// Place of `w` among the free ones.
    pub column: usize,
    /// `S(q, t)`, by its name if it is long.
    pub coefficient: Expr,
    /// `S` as it is written.
    pub written: Expr,
}

impl QuasiVelocities {
    /// The columns of `S`, by `definitions`, which contain [`QuasiVelocities::coefficients`] already.
    pub fn columns(&self, g: &Graph, definitions: &mut Definitions) -> Columns {
        let mut columns = vec![Sparse::new(); self.free.len()];
        // row by row: which column has what entry
        let mut rows: HashMap<Symbol, Sparse> = HashMap::new();
        for (column, w) in self.free.iter().enumerate() {
            rows.insert(w.symbol, Sparse::from([(column, g.one())]));
            if let Some(i) = w.coordinate {
                columns[column].insert(i, g.one());
            }
        }
        let (mut singles, mut others) = (HashMap::new(), BTreeSet::new());
        for d in &self.dependent {
            let mut entries: BTreeMap<usize, Vec<Expr>> = BTreeMap::new();
            for (s, coefficient) in &d.terms {
                for (&column, &e) in &rows[s] {
                    entries.entry(column).or_default().push(g.mul(*coefficient, e));
                }
            }
            let sum = |terms: Vec<Expr>| g.sum(&terms);
            let entries =
                entries.into_iter().map(|(column, terms)| (column, sum(terms))).filter(|(_, e)| !g.is_zero(*e));
            let entries: Vec<(usize, Expr)> = entries.collect();
            let limit = if entries.len() == 1 && d.terms.len() > 1 { LINK } else { SHORT };
            let row: Sparse =
                entries.iter().map(|&(column, e)| (column, definitions.short(g, "S", limit, e))).collect();
            if let Some(i) = d.coordinate {
                for (&column, &e) in &row {
                    columns[column].insert(i, e);
                }
            }
            if let [(column, written)] = entries[..]
                && self.homogeneous
                && (d.terms.len() > 1 || row[&column] != written)
                && g.symbols_of(written).is_disjoint(&others)
            {
                singles.insert(d.symbol, Single { column, coefficient: row[&column], written });
            } else {
                others.extend(row.values().filter_map(|&e| g.as_symbol(e)));
            }
            rows.insert(d.symbol, row);
        }
        Columns { columns, singles }
    }
}

impl Columns {
    /// The coefficient of a velocity that hangs on one quasi-velocity alone, by way of such.
    pub fn single(&self, velocity: Symbol) -> Option<Single> {
        self.singles.get(&velocity).copied()
    }

    /// Without the entries of some coordinates.
    pub fn without(&self, coordinates: &HashSet<usize>) -> Columns {
        let mut columns = self.columns.clone();
        columns.iter_mut().for_each(|column| column.retain(|i, _| !coordinates.contains(i)));
        Columns { columns, singles: self.singles.clone() }
    }

    /// `SᵀMS` for a symmetric `M`, given by its rows.
    pub fn reduced(&self, g: &Graph, mass: &[BTreeMap<usize, Expr>], definitions: &mut Definitions) -> Vec<Vec<Expr>> {
        let products: Vec<Sparse> = self
            .columns
            .iter()
            .map(|column| {
                multiply(g, mass, column).into_iter().map(|(i, e)| (i, definitions.short(g, "m", SHORT, e))).collect()
            })
            .collect();
        let count = self.columns.len();
        let mut reduced = vec![vec![g.zero(); count]; count];
        for (i, column) in self.columns.iter().enumerate() {
            for (j, product) in products.iter().enumerate().take(i + 1) {
                let entry = definitions.short(g, "m", SIDE, g.expand_if_shorter(dot(g, column, product), LONG));
                (reduced[i][j], reduced[j][i]) = (entry, entry);
            }
        }
        reduced
    }

    /// `Sᵀ force`, with an entry of `force` for each coordinate.
    pub fn projected(&self, g: &Graph, force: &[Expr], definitions: &mut Definitions) -> Vec<Expr> {
        let force: Sparse = force.iter().copied().enumerate().collect();
        let columns = self.columns.iter();
        columns
            .map(|column| definitions.short(g, "m", SIDE, g.expand_if_shorter(dot(g, column, &force), LONG)))
            .collect()
    }

    /// The same without definitions for the results, for a force that contains unknowns.
    pub fn projected_whole(&self, g: &Graph, force: &[Expr]) -> Vec<Expr> {
        let force: Sparse = force.iter().copied().enumerate().collect();
        self.columns.iter().map(|column| dot(g, column, &force)).collect()
    }
}

/// `rows · column`
fn multiply(g: &Graph, rows: &[Sparse], column: &Sparse) -> Sparse {
    let mut product = Sparse::new();
    for &i in &reach(rows, column) {
        let e = dot(g, &rows[i], column);
        if !g.is_zero(e) {
            product.insert(i, e);
        }
    }
    product
}

/// The rows of a symmetric matrix that meet an entry of `column`.
fn reach(rows: &[Sparse], column: &Sparse) -> BTreeSet<usize> {
    column.keys().flat_map(|&j| rows[j].keys().copied()).collect()
}

/// `Σ aᵢ bᵢ`
fn dot(g: &Graph, a: &Sparse, b: &Sparse) -> Expr {
    g.sum(&products(g, a, b))
}
