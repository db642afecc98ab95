//! The sparse elimination behind quasi-velocities.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use symbolic::{Expr, Graph, Symbol};

use super::{DependentVelocity, EliminatedConstraint, QuasiVelocity};
use crate::Frame;
use crate::frame::point;
use equations::Definitions;
use mechanics::{Coordinate, RemovalError, State, System, fresh_symbol};

/// A pivot may be this much smaller than the largest one if it fills less.
const PIVOT_CHOICE: f64 = 0.2;
/// Constant pivots under this part of the row's largest coefficient are treated as those that are not constant.
const CONSTANT_CHOICE: f64 = 1e-4;
/// Pivots under this size, rows scaled to 1, are zero: the constraints are dependent.
const PIVOT_LIMIT: f64 = 1e-10;
/// What is left of a difference under this part of its terms is tested for being zero.
const CANCELLED: f64 = 1e-9;
/// Nodes of a coefficient that gets no name of its own.
const SHORT: usize = 24;

/// The columns of a row with coefficients and their values at the start.
type Terms = BTreeMap<usize, (Expr, f64)>;

/// `Σ coefficient · velocity + offset = 0`.
struct Row {
    terms: Terms,
    offset: Expr,
    /// The largest coefficient that it ever had.
    scale: f64,
    /// A row in which no pair was found is not searched again until it changes.
    searched: bool,
    /// Its constant pivots in the queue.
    queued: Vec<Candidate>,
}

/// A velocity, and the rows that contain it.
struct Column {
    velocity: QuasiVelocity,
    rows: BTreeSet<usize>,
}

/// A constant pivot: what it may fill, then the latest column, then the first row.
type Candidate = (usize, Reverse<usize>, usize);

/// Two coefficients `a, b` of a row with constant `a² + b²`.
struct Couple {
    columns: (usize, usize),
    coefficients: (Expr, Expr),
    square: Expr,
}

pub(super) struct Elimination<'a> {
    g: &'a Graph,
    parameters: HashMap<Symbol, f64>,
    /// Parameters, start and coefficients.
    values: HashMap<Symbol, f64>,
    columns: Vec<Column>,
    rows: Vec<Row>,
    active: BTreeSet<usize>,
    queue: BTreeSet<Candidate>,
    pub(super) coefficients: Definitions,
    /// What each step defined.
    pub(super) steps: Vec<Vec<DependentVelocity>>,
    pub(super) guards: Vec<Expr>,
    pub(super) eliminated: Vec<EliminatedConstraint>,
}

impl<'a> Elimination<'a> {
    pub(super) fn new(system: &'a System, frame: Option<&Frame>, start: Option<&State>) -> Result<Self, RemovalError> {
        let g = &system.graph;
        let velocities = match frame {
            Some(frame) => frame.velocities.iter().map(|u| (u.symbol, u.rate, u.start)).collect(),
            None => {
                let own = |c: &Coordinate| (c.velocity, c.acceleration, g.variable(c.velocity));
                system.coordinates.iter().map(own).collect::<Vec<(Symbol, Symbol, Expr)>>()
            }
        };
        let columns = velocities.iter().enumerate().map(|(i, &(symbol, rate, start))| Column {
            velocity: QuasiVelocity { symbol, rate, start, coordinate: Some(i) },
            rows: BTreeSet::new(),
        });
        let mut elimination = Elimination {
            g,
            parameters: system.parameter_values(),
            values: point(system, start),
            columns: columns.collect(),
            rows: Vec::new(),
            active: (0..system.constraints.len()).collect(),
            queue: BTreeSet::new(),
            coefficients: Definitions::default(),
            steps: Vec::new(),
            guards: Vec::new(),
            eliminated: Vec::new(),
        };
        match frame {
            Some(frame) => frame.constraints.iter().for_each(|f| elimination.add_row(f.terms.clone(), f.offset)),
            None => elimination.read(system)?,
        }
        (0..elimination.rows.len()).for_each(|row| elimination.enqueue(row));
        Ok(elimination)
    }

    /// The rows `A | b`.
    fn read(&mut self, system: &System) -> Result<(), RemovalError> {
        let g = self.g;
        let velocities = system.velocities();
        let places: HashMap<Symbol, usize> = velocities.iter().enumerate().map(|(i, &v)| (v, i)).collect();
        let at_rest: HashMap<Symbol, Expr> = velocities.iter().map(|&v| (v, g.zero())).collect();
        let jacobian = g.sparse_jacobian(&system.constraints, &velocities);
        for (row, (&f, entries)) in system.constraints.iter().zip(jacobian).enumerate() {
            if entries.iter().any(|(_, e)| g.symbols_of(*e).iter().any(|s| places.contains_key(s))) {
                return Err(RemovalError::NotLinear { constraint: row + 1, text: g.plain(f) });
            }
            let terms = entries.into_iter().map(|(v, e)| (places[&v], e)).collect();
            self.add_row(terms, g.substitute(f, &at_rest));
        }
        Ok(())
    }

    fn add_row(&mut self, terms: Vec<(usize, Expr)>, offset: Expr) {
        let row = self.rows.len();
        terms.iter().for_each(|(column, _)| {
            self.columns[*column].rows.insert(row);
        });
        let terms: Terms = terms.into_iter().map(|(column, e)| (column, (e, self.number(e)))).collect();
        let scale = largest(&terms);
        self.rows.push(Row { terms, offset, scale, searched: false, queued: Vec::new() });
    }

    pub(super) fn is_homogeneous(&self) -> bool {
        self.rows.iter().all(|row| self.g.is_zero(row.offset))
    }

    /// The velocities that were no pivots.
    pub(super) fn free(self, dependent: &HashSet<Symbol>) -> Vec<QuasiVelocity> {
        self.columns.into_iter().map(|c| c.velocity).filter(|w| !dependent.contains(&w.symbol)).collect()
    }

    /// Eliminates one constraint; `false` where none is left.
    pub(super) fn step(&mut self) -> Result<bool, RemovalError> {
        if self.active.is_empty() {
            return Ok(false);
        }
        if let Some(&(_, Reverse(column), row)) = self.queue.first() {
            self.by_pivot(row, column);
        } else if let Some((row, couple)) = self.find_couple() {
            self.by_couple(row, couple);
        } else {
            let (row, column) = self.largest_pivot()?;
            self.guards.push(self.rows[row].terms[&column].0);
            self.by_pivot(row, column);
        }
        Ok(true)
    }

    fn by_pivot(&mut self, row: usize, column: usize) {
        let (mut terms, offset, mut changed) = self.take(row);
        let Some((pivot, _)) = terms.remove(&column) else { return };
        let scale = self.g.neg(self.g.powi(pivot, -1));
        self.define(column, Vec::new(), &terms, offset, scale, &mut changed);
        changed.into_iter().for_each(|row| self.enqueue(row));
    }

    /// `v₁ = b w − a r/s`, `v₂ = −a w − b r/s`, with `s = a² + b²` and `r` the rest of the row; `w = (b v₁ − a v₂)/s`.
    fn by_couple(&mut self, row: usize, couple: Couple) {
        let g = self.g;
        let (mut terms, offset, mut changed) = self.take(row);
        let Couple { columns: (first, second), coefficients: (a, b), square } = couple;
        terms.remove(&first);
        terms.remove(&second);
        let speeds = [first, second].map(|c| self.columns[c].velocity.start);
        let across = g.sub(g.mul(b, speeds[0]), g.mul(a, speeds[1]));
        let name = g.name(self.columns[first].velocity.symbol);
        let name = format!("w_{}", name.trim_end_matches('\''));
        let symbol = fresh_symbol(g, &name);
        let velocity = QuasiVelocity {
            symbol,
            rate: fresh_symbol(g, &format!("{}'", g.name(symbol))),
            start: g.div(across, square),
            coordinate: None,
        };
        self.columns.push(Column { velocity, rows: BTreeSet::new() });
        let along = self.columns.len() - 1;
        let minus = |e: Expr| g.neg(g.div(e, square));
        let mut step = Vec::new();
        for (column, part, scale) in [(first, b, minus(a)), (second, g.neg(a), minus(b))] {
            self.define(column, vec![(along, part)], &terms, offset, scale, &mut changed);
            step.extend(self.steps.pop().unwrap_or_default());
        }
        self.steps.push(step);
        changed.into_iter().for_each(|row| self.enqueue(row));
    }

    /// Takes a row out; also returned: the rows that share a column with it.
    fn take(&mut self, row: usize) -> (Terms, Expr, BTreeSet<usize>) {
        self.active.remove(&row);
        self.eliminated.push(EliminatedConstraint { constraint: row, slopes: Vec::new(), added: Vec::new() });
        for candidate in std::mem::take(&mut self.rows[row].queued) {
            self.queue.remove(&candidate);
        }
        let terms = std::mem::take(&mut self.rows[row].terms);
        let mut neighbours = BTreeSet::new();
        for column in terms.keys() {
            self.columns[*column].rows.remove(&row);
            neighbours.extend(&self.columns[*column].rows);
        }
        (terms, self.rows[row].offset, neighbours)
    }

    /// Defines the velocity of `column` as `own + scale · (terms + offset)`, and puts that into the other rows.
    fn define(
        &mut self,
        column: usize,
        own: Vec<(usize, Expr)>,
        terms: &Terms,
        offset: Expr,
        scale: Expr,
        changed: &mut BTreeSet<usize>,
    ) {
        let g = self.g;
        let mut parts: Vec<(usize, Expr)> = own;
        for (&j, &(e, _)) in terms {
            let e = self.named(g.mul(scale, e));
            parts.push((j, e));
        }
        let offset = self.named(g.mul(scale, offset));
        let QuasiVelocity { symbol, coordinate, .. } = self.columns[column].velocity;
        let mut added = Vec::new();
        for row in std::mem::take(&mut self.columns[column].rows) {
            let Some((factor, _)) = self.rows[row].terms.remove(&column) else { continue };
            added.push((row, g.mul(factor, scale)));
            for &(j, e) in &parts {
                self.add(row, j, g.mul(factor, e));
            }
            let rest = g.add(self.rows[row].offset, g.mul(factor, offset));
            self.rows[row].offset = self.named(rest);
            changed.insert(row);
        }
        let terms = parts.into_iter().map(|(j, e)| (self.columns[j].velocity.symbol, e)).collect();
        if let Some(eliminated) = self.eliminated.last_mut() {
            eliminated.slopes.push((symbol, g.neg(scale)));
            eliminated.added.extend(added);
        }
        self.steps.push(vec![DependentVelocity { symbol, coordinate, terms, offset }]);
    }

    /// Adds to a coefficient. What cancels without simplifying is taken out: it would be taken for a pivot.
    fn add(&mut self, row: usize, column: usize, e: Expr) {
        let g = self.g;
        let old = self.rows[row].terms.get(&column).copied();
        let sum = old.map_or(e, |(old, _)| g.add(old, e));
        let value = self.number(sum);
        let size = old.map_or(0.0, |old| old.1.abs());
        self.rows[row].scale = self.rows[row].scale.max(value.abs()).max(size);
        let cancels = g.is_zero(sum)
            || (old.is_some() && value.abs() <= CANCELLED * size && g.vanishes(sum, &self.parameters).is_zero());
        if cancels {
            self.rows[row].terms.remove(&column);
            self.columns[column].rows.remove(&row);
        } else {
            let sum = self.named(sum);
            self.rows[row].terms.insert(column, (sum, value));
            self.columns[column].rows.insert(row);
        }
    }

    /// Puts the constant pivots of a row into the queue anew.
    fn enqueue(&mut self, row: usize) {
        if !self.active.contains(&row) {
            return;
        }
        for candidate in std::mem::take(&mut self.rows[row].queued) {
            self.queue.remove(&candidate);
        }
        let terms = &self.rows[row].terms;
        let largest = largest(terms);
        let queued: Vec<Candidate> = terms
            .iter()
            .filter(|(_, (e, x))| x.abs() >= CONSTANT_CHOICE * largest && *x != 0.0 && self.is_constant(*e))
            .map(|(&column, _)| (self.fill(row, column), Reverse(column), row))
            .collect();
        self.queue.extend(&queued);
        self.rows[row].queued = queued;
        self.rows[row].searched = false;
    }

    /// What a pivot may fill in (Markowitz): the other entries of its row times those of its column.
    fn fill(&self, row: usize, column: usize) -> usize {
        (self.rows[row].terms.len() - 1) * (self.columns[column].rows.len() - 1)
    }

    /// The first row with two coefficients whose squares add up to a constant.
    fn find_couple(&mut self) -> Option<(usize, Couple)> {
        let rows: Vec<usize> = self.active.iter().copied().filter(|&row| !self.rows[row].searched).collect();
        for row in rows {
            let terms: Vec<(usize, Expr, f64)> =
                self.rows[row].terms.iter().map(|(&column, &(e, x))| (column, e, x)).collect();
            for (i, &(first, a, x)) in terms.iter().enumerate() {
                for &(second, b, y) in &terms[i + 1..] {
                    let square = self.g.add(self.g.powi(a, 2), self.g.powi(b, 2));
                    let length = x.hypot(y);
                    if self.is_constant(square) && length > CONSTANT_CHOICE * largest(&self.rows[row].terms) {
                        return Some((row, Couple { columns: (first, second), coefficients: (a, b), square }));
                    }
                }
            }
            self.rows[row].searched = true;
        }
        None
    }

    /// Among the pivots that are large at the start, the one that fills least.
    fn largest_pivot(&self) -> Result<(usize, usize), RemovalError> {
        let mut candidates: Vec<(f64, usize, usize, usize)> = Vec::new();
        for &row in &self.active {
            let scale = self.rows[row].scale;
            for (&column, &(_, x)) in &self.rows[row].terms {
                let size = if scale > 0.0 { x.abs() / scale } else { 0.0 };
                if size.is_finite() && size > 0.0 {
                    candidates.push((size, self.fill(row, column), row, column));
                }
            }
        }
        let largest = candidates.iter().fold(0.0_f64, |a, c| a.max(c.0));
        if largest < PIVOT_LIMIT {
            return Err(RemovalError::Dependent { pivot: largest, limit: PIVOT_LIMIT });
        }
        candidates.retain(|c| c.0 >= PIVOT_CHOICE * largest);
        candidates.sort_by(|a, b| a.1.cmp(&b.1).then(b.0.total_cmp(&a.0)).then((a.2, a.3).cmp(&(b.2, b.3))));
        Ok((candidates[0].2, candidates[0].3))
    }

    fn named(&mut self, e: Expr) -> Expr {
        let named = self.coefficients.short(self.g, "c", SHORT, e);
        if named != e
            && let Some(symbol) = self.g.as_symbol(named)
        {
            let value = self.number(e);
            self.values.insert(symbol, value);
        }
        named
    }

    /// The value at the start; NaN where it is not finite.
    fn number(&self, e: Expr) -> f64 {
        self.g.evaluate(e, &self.values).unwrap_or(f64::NAN)
    }

    fn is_constant(&self, e: Expr) -> bool {
        self.g.symbols_of(e).iter().all(|s| self.parameters.contains_key(s))
    }
}

fn largest(terms: &Terms) -> f64 {
    terms.values().fold(0.0, |largest, (_, x)| largest.max(x.abs()))
}
