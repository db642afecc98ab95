//! # The drift
//!
//! With `v = S w + s`, accelerations are `v̇ = S ẇ + γ`, `γ = Ṡ w + ṡ`. Time derivatives get names: Taylor
//! series take them from those of what they are derivatives of, without a product
//! ([`Equations::derivatives`]).
//!
//! Velocities `v_i = S_i w` that hang on one quasi-velocity, with constant masses `m_i` of their own, take
//! part in its equation by the rate of their energy over `w`,
//!
//! ```text
//! Σ m_i S_i v̇_i = Σ m_i S_i (S_i ẇ + Ṡ_i w) = m ẇ + ½ ṁ w ,      m = Σ m_i S_i² .
//! ```

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::expressions::{SHORT, Sparse};
use crate::{Columns, DependentVelocity, QuasiVelocities, Single};
use equations::{Definitions, Equations};
use mechanics::System;
use symbolic::limits::LONG;
use symbolic::{Expr, Graph, Symbol};

/// Nodes of a time derivative that gets no name of its own.
const NAME: usize = 1;

/// `γ`, the accelerations at `ẇ = 0`.
pub(crate) struct Drift {
    /// By coordinate.
    pub(crate) gamma: Vec<Expr>,
    /// `S` and `Ṡ` of the coordinates whose velocity is `S w`.
    singles: BTreeMap<usize, (Single, Expr)>,
}

/// Time derivatives with names.
struct Rates<'a> {
    g: &'a Graph,
    definitions: &'a mut Definitions,
    derivatives: &'a mut Vec<(Symbol, Expr)>,
    known: HashMap<Symbol, Expr>,
}

impl Rates<'_> {
    /// Along the motion.
    fn of(&self, e: Expr) -> Expr {
        let symbols = self.g.symbols_of(e).into_iter().filter_map(|s| Some((s, *self.known.get(&s)?)));
        self.g.total_derivative(e, &symbols.collect::<Vec<(Symbol, Expr)>>())
    }

    /// `rate`, the derivative of `of`, with a name if it has more nodes than `limit`.
    fn named(&mut self, stem: &str, limit: usize, of: Expr, rate: Expr) -> Expr {
        let named = self.definitions.short(self.g, stem, limit, rate);
        if named != rate {
            self.derivatives.extend(self.g.as_symbol(named).map(|symbol| (symbol, of)));
        }
        named
    }

    /// `Σ (coefficient' · velocity + coefficient · acceleration) + offset'`, by the accelerations before.
    fn acceleration(&mut self, d: &DependentVelocity, before: &HashMap<Symbol, Expr>) -> Expr {
        let (g, offset) = (self.g, self.of(d.offset));
        let mut slopes: Vec<Expr> = d.terms.iter().map(|t| self.of(t.1)).collect();
        let sum = |slopes: &[Expr]| {
            let mut terms = vec![offset];
            for (&(s, coefficient), &slope) in d.terms.iter().zip(slopes) {
                terms.push(g.mul(slope, g.variable(s)));
                terms.extend(before.get(&s).map(|&rate| g.mul(coefficient, rate)));
            }
            g.sum(&terms)
        };
        let whole = sum(&slopes);
        if g.size(&[whole]) <= SHORT {
            return whole;
        }
        for (slope, (_, of)) in slopes.iter_mut().zip(&d.terms) {
            *slope = self.named("dc", NAME, *of, *slope);
        }
        self.definitions.short(g, "a", SHORT, sum(&slopes))
    }
}

impl Drift {
    /// The definitions contain the velocities and the columns already.
    pub(crate) fn new(
        system: &System,
        quasi: &QuasiVelocities,
        columns: &Columns,
        equations: &mut Equations,
        definitions: &mut Definitions,
    ) -> Drift {
        let g = &system.graph;
        let mut known: HashMap<Symbol, Expr> =
            system.coordinates.iter().map(|c| (c.position, g.variable(c.velocity))).collect();
        known.insert(system.time, g.one());
        let mut rates = Rates { g, definitions, derivatives: &mut equations.derivatives, known };
        for &(symbol, e) in quasi.coefficients.list() {
            let rate = rates.of(e);
            let rate = rates.named("dc", SHORT, g.variable(symbol), rate);
            rates.known.insert(symbol, rate);
        }
        let (mut gamma, mut singles) = (vec![g.zero(); system.dimension()], BTreeMap::new());
        let mut by_symbol: HashMap<Symbol, Expr> = HashMap::new();
        for d in &quasi.dependent {
            let rate = match columns.single(d.symbol) {
                Some(single) => {
                    let Single { column, coefficient, written } = single;
                    let slope = rates.of(written);
                    let slope = rates.named("dS", NAME, coefficient, slope);
                    rates.known.extend(g.as_symbol(coefficient).map(|symbol| (symbol, slope)));
                    singles.extend(d.coordinate.map(|i| (i, (single, slope))));
                    g.mul(slope, g.variable(quasi.free[column].symbol))
                }
                None => rates.acceleration(d, &by_symbol),
            };
            by_symbol.insert(d.symbol, rate);
            if let Some(i) = d.coordinate {
                gamma[i] = rate;
            }
        }
        Drift { gamma, singles }
    }
}

/// Velocities `S w` with masses of their own.
pub(crate) struct Carried {
    /// Their coordinates.
    pub(crate) coordinates: HashSet<usize>,
    /// `m` and `ṁ`, by place of `w`.
    pub(crate) inertia: BTreeMap<usize, (Expr, Expr)>,
}

impl Carried {
    /// By `drift` and the rows of the mass matrix.
    pub(crate) fn new(
        system: &System,
        drift: &Drift,
        mass: &[Sparse],
        equations: &mut Equations,
        definitions: &mut Definitions,
    ) -> Carried {
        let g = &system.graph;
        let own = |i: usize| match mass[i].iter().collect::<Vec<_>>()[..] {
            [(&j, &m)] if i == j && equations.is_constant(g, m) => Some(m),
            _ => None,
        };
        // S² and S Ṡ, by place and mass
        let mut squares: BTreeMap<usize, BTreeMap<Expr, [Vec<Expr>; 2]>> = BTreeMap::new();
        let mut coordinates = HashSet::new();
        for (&i, (Single { column, coefficient, .. }, slope)) in &drift.singles {
            let Some(m) = own(i) else { continue };
            let [squares, rates] = squares.entry(*column).or_default().entry(m).or_default();
            squares.push(g.powi(*coefficient, 2));
            rates.push(g.mul(*coefficient, *slope));
            coordinates.insert(i);
        }
        let mut inertia = BTreeMap::new();
        let weighted = |(m, [squares, rates]): (Expr, [Vec<Expr>; 2])| {
            [g.mul(m, g.sum(&squares)), g.product(&[g.integer(2), m, g.sum(&rates)])]
        };
        for (column, by_mass) in squares {
            let terms: Vec<[Expr; 2]> = by_mass.into_iter().map(weighted).collect();
            let [m, rate] = [0, 1].map(|i| g.sum(&terms.iter().map(|t| t[i]).collect::<Vec<Expr>>()));
            let expanded = g.expand_if_shorter(m, LONG);
            let (m, rate) = if equations.is_constant(g, expanded) { (expanded, g.zero()) } else { (m, rate) };
            let m = definitions.short(g, "m", NAME, m);
            let derivatives = &mut equations.derivatives;
            let mut rates = Rates { g, definitions: &mut *definitions, derivatives, known: HashMap::new() };
            inertia.insert(column, (m, rates.named("dm", NAME, m, rate)));
        }
        Carried { coordinates, inertia }
    }
}
