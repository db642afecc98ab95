//! The sparse elimination behind quasi-velocities.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use symbolic::limits::{DEPENDENT, NOTHING, PIVOT};
use symbolic::{Expr, Graph, Range, Symbol};

use super::columns::SIDE;
use super::recursion::{DependentVelocity, EliminatedConstraint, QuasiVelocities, QuasiVelocity};
use crate::Frame;
use crate::expressions::point;
use equations::Definitions;
use mechanics::elimination::{Candidate, LinearForms, SparseMatrix, choose_pivot};
use mechanics::{Coordinate, RemovalError, State, System, fresh_symbol};

/// The columns of a row with coefficients and their values at the start.
type Terms = BTreeMap<usize, (Expr, f64)>;

/// What is known of a row `Σ coefficient · velocity + offset = 0` beside its coefficients.
struct Row {
    offset: Expr,
    /// The largest coefficient that it ever had.
    scale: f64,
    /// A row in which no pair was found is not searched again until it changes.
    searched: bool,
    /// Its constant pivots in the queue.
    queued: Vec<ConstantPivot>,
}

/// A constant pivot: what it may fill, then the latest column, then the first row.
type ConstantPivot = (usize, Reverse<usize>, usize);

/// Two coefficients `a, b` of a row with constant `a² + b²`.
struct Couple {
    columns: (usize, usize),
    coefficients: (Expr, Expr),
    square: Expr,
}

impl QuasiVelocities {
    /// Eliminates the constraints of `system`, from the velocities of `frame` or, without one, of the
    /// coordinates. Sizes of pivots are those at `start`; without a start, at a point of no significance.
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`], [`RemovalError::Dependent`]: constraints not linear in `v`, or dependent.
    pub fn new(system: &System, frame: Option<&Frame>, start: Option<&State>) -> Result<Self, RemovalError> {
        let mut elimination = Elimination::new(system, frame, start)?;
        let homogeneous = elimination.is_homogeneous();
        while elimination.step()? {}
        let Elimination { velocities, steps, coefficients, guards, quotients, eliminated, .. } = elimination;
        let dependent: Vec<DependentVelocity> = steps.into_iter().rev().flatten().collect();
        let pivots: HashSet<Symbol> = dependent.iter().map(|d| d.symbol).collect();
        let free = velocities.into_iter().filter(|w| !pivots.contains(&w.symbol)).collect();
        Ok(QuasiVelocities { free, dependent, eliminated, coefficients, guards, quotients, homogeneous })
    }
}

struct Elimination<'a> {
    system: &'a System,
    g: &'a Graph,
    /// Parameters, start and coefficients.
    values: HashMap<Symbol, f64>,
    /// Ranges of parameters and of named coefficients.
    ranges: HashMap<Symbol, Range>,
    /// By column.
    velocities: Vec<QuasiVelocity>,
    matrix: SparseMatrix<(Expr, f64)>,
    rows: Vec<Row>,
    active: BTreeSet<usize>,
    queue: BTreeSet<ConstantPivot>,
    coefficients: Definitions,
    /// What each step defined.
    steps: Vec<Vec<DependentVelocity>>,
    guards: Vec<Expr>,
    quotients: Vec<Expr>,
    eliminated: Vec<EliminatedConstraint>,
}

impl<'a> Elimination<'a> {
    fn new(system: &'a System, frame: Option<&Frame>, start: Option<&State>) -> Result<Self, RemovalError> {
        let g = &system.graph;
        let velocities = match frame {
            Some(frame) => frame.velocities.iter().map(|u| (u.symbol, u.rate, u.start)).collect(),
            None => {
                let own = |c: &Coordinate| (c.velocity, c.acceleration, g.variable(c.velocity));
                system.coordinates.iter().map(own).collect::<Vec<(Symbol, Symbol, Expr)>>()
            }
        };
        let velocities = velocities.into_iter().enumerate();
        let velocities =
            velocities.map(|(i, (symbol, rate, start))| QuasiVelocity { symbol, rate, start, coordinate: Some(i) });
        let LinearForms { rows, offsets } = match frame {
            Some(frame) => frame.constraints.clone(),
            None => system.linear_constraints()?,
        };
        let mut elimination = Elimination {
            g,
            system,
            values: point(system, start),
            ranges: system.parameter_values().into_iter().map(|(s, x)| (s, Range::point(x))).collect(),
            velocities: velocities.collect(),
            matrix: SparseMatrix::new(Vec::new()),
            rows: Vec::new(),
            active: (0..system.constraints.len()).collect(),
            queue: BTreeSet::new(),
            coefficients: Definitions::default(),
            steps: Vec::new(),
            guards: Vec::new(),
            quotients: Vec::new(),
            eliminated: Vec::new(),
        };
        let number = |(j, e): (usize, Expr)| (j, (e, elimination.number(e)));
        let rows: Vec<Terms> = rows.into_iter().map(|row| row.into_iter().map(number).collect()).collect();
        let known = |(terms, offset)| Row { offset, scale: largest(terms), searched: false, queued: Vec::new() };
        elimination.rows = rows.iter().zip(offsets).map(known).collect();
        elimination.matrix = SparseMatrix::new(rows);
        (0..elimination.rows.len()).for_each(|row| elimination.enqueue(row));
        Ok(elimination)
    }

    fn is_homogeneous(&self) -> bool {
        self.rows.iter().all(|row| self.g.is_zero(row.offset))
    }

    /// Eliminates one constraint; `false` where none is left.
    fn step(&mut self) -> Result<bool, RemovalError> {
        if self.active.is_empty() {
            return Ok(false);
        }
        if let Some(&(_, Reverse(column), row)) = self.queue.first() {
            self.by_pivot(row, column);
            self.watch_quotients(|elimination, e| !elimination.g.range(e, &elimination.ranges).is_bounded());
        } else if let Some((row, couple)) = self.find_couple() {
            self.by_couple(row, couple);
        } else {
            let (row, column) = self.largest_pivot()?;
            self.guards.push(self.matrix.rows()[row][&column].0);
            self.by_pivot(row, column);
            self.watch_quotients(|_, _| true);
        }
        Ok(true)
    }

    /// Adds to what is watched the coefficients of the last step that may grow.
    fn watch_quotients(&mut self, may_grow: impl Fn(&Self, Expr) -> bool) {
        let divided = self.steps.last().into_iter().flatten().flat_map(|d| &d.terms);
        let watched: Vec<Expr> = divided.map(|(_, e)| *e).filter(|&e| may_grow(self, e)).collect();
        self.quotients.extend(watched);
    }

    fn by_pivot(&mut self, row: usize, column: usize) {
        let (mut terms, offset, mut changed) = self.take(row);
        let Some((pivot, _)) = terms.remove(&column) else { return };
        let scale = self.g.neg(self.g.powi(pivot, -1));
        self.define(column, Vec::new(), &terms, offset, scale, &mut changed);
        changed.into_iter().for_each(|row| self.enqueue(row));
    }

    /// `v₁ = b w − a r/s`, `v₂ = −a w − b r/s`, `s = a² + b²`, `r`: rest of row; `w = (b v₁ − a v₂)/s`.
    fn by_couple(&mut self, row: usize, couple: Couple) {
        let g = self.g;
        let (mut terms, offset, mut changed) = self.take(row);
        let Couple { columns: (first, second), coefficients: (a, b), square } = couple;
        terms.remove(&first);
        terms.remove(&second);
        let speeds = [first, second].map(|c| self.velocities[c].start);
        let across = g.sub(g.mul(b, speeds[0]), g.mul(a, speeds[1]));
        let name = g.name(self.velocities[first].symbol);
        let name = format!("w_{}", name.trim_end_matches('\''));
        let symbol = fresh_symbol(g, &name);
        let velocity = QuasiVelocity {
            symbol,
            rate: fresh_symbol(g, &format!("{}'", g.name(symbol))),
            start: g.div(across, square),
            coordinate: None,
        };
        self.velocities.push(velocity);
        let along = self.velocities.len() - 1;
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
        let terms = self.matrix.take_row(row);
        let neighbours = terms.keys().flat_map(|&column| self.matrix.rows_with(column)).collect();
        (terms, self.rows[row].offset, neighbours)
    }

    /// Defines the velocity of `column` as `own + scale · (terms + offset)`; puts it into the other rows.
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
        let mut parts: Vec<(usize, Expr, bool)> = own.into_iter().map(|(j, e)| (j, e, false)).collect();
        for (&j, &(e, x)) in terms {
            let e = self.named(g.mul(scale, e));
            parts.push((j, e, x == 0.0));
        }
        let offset = self.named(g.mul(scale, offset));
        let QuasiVelocity { symbol, coordinate, .. } = self.velocities[column];
        let mut added = Vec::new();
        for (row, (factor, x)) in self.matrix.take_column(column) {
            added.push((row, g.mul(factor, scale)));
            for &(j, e, is_zero) in &parts {
                self.add(row, j, g.mul(factor, e), is_zero || x == 0.0);
            }
            let rest = g.add(self.rows[row].offset, g.mul(factor, offset));
            self.rows[row].offset = self.named(rest);
            changed.insert(row);
        }
        let terms = parts.into_iter().map(|(j, e, _)| (self.velocities[j].symbol, e)).collect();
        if let Some(eliminated) = self.eliminated.last_mut() {
            eliminated.slopes.push((symbol, g.neg(scale)));
            eliminated.added.extend(added);
        }
        self.steps.push(vec![DependentVelocity { symbol, coordinate, terms, offset }]);
    }

    /// Adds to a coefficient what is zero at the start if `is_zero`. What cancels exactly is taken out; what
    /// is round-off at the start stays as 0 there, and so is not a pivot.
    fn add(&mut self, row: usize, column: usize, e: Expr, is_zero: bool) {
        let g = self.g;
        let old = self.matrix.rows()[row].get(&column).copied();
        let sum = old.map_or(e, |(old, _)| g.add(old, e));
        let value = self.number(sum);
        let size = old.map_or(0.0, |old| old.1.abs());
        self.rows[row].scale = self.rows[row].scale.max(value.abs()).max(size);
        let cancelled = old.is_some() && value.abs() <= NOTHING * size;
        let known_zero = is_zero && old.is_none_or(|old| old.1 == 0.0);
        let entry = if g.is_zero(sum) || (cancelled || known_zero && old.is_some()) && g.vanishes_exactly(sum) {
            None
        } else if known_zero || cancelled && g.is_round_off(sum, &self.values) {
            Some((self.named(sum), 0.0))
        } else {
            Some((self.named(sum), value))
        };
        self.matrix.set(row, column, entry);
    }

    /// Puts the constant pivots of a row into the queue anew.
    fn enqueue(&mut self, row: usize) {
        if !self.active.contains(&row) {
            return;
        }
        for candidate in std::mem::take(&mut self.rows[row].queued) {
            self.queue.remove(&candidate);
        }
        let terms = &self.matrix.rows()[row];
        let faint = DEPENDENT * largest(terms);
        let constants = terms.iter().filter(|(_, (e, x))| x.abs() >= faint && *x != 0.0 && self.system.is_constant(*e));
        let constants: Vec<(usize, f64)> = constants.map(|(&column, (_, x))| (column, x.abs())).collect();
        let limit = constants.iter().fold(0.0, |limit: f64, (_, x)| limit.max(PIVOT * x));
        let large = constants.into_iter().filter(|(_, x)| *x >= limit);
        let queued: Vec<ConstantPivot> =
            large.map(|(column, _)| (self.fill(row, column), Reverse(column), row)).collect();
        self.queue.extend(&queued);
        self.rows[row].queued = queued;
        self.rows[row].searched = false;
    }

    /// What a pivot may fill in (Markowitz): the other entries of its row times those of its column.
    fn fill(&self, row: usize, column: usize) -> usize {
        (self.matrix.rows()[row].len() - 1) * (self.matrix.rows_with(column).len() - 1)
    }

    /// The first row with two coefficients whose squares add up to a constant.
    fn find_couple(&mut self) -> Option<(usize, Couple)> {
        let rows: Vec<usize> = self.active.iter().copied().filter(|&row| !self.rows[row].searched).collect();
        for row in rows {
            let terms: Vec<(usize, Expr, f64)> =
                self.matrix.rows()[row].iter().map(|(&column, &(e, x))| (column, e, x)).collect();
            for (i, &(first, a, x)) in terms.iter().enumerate() {
                for &(second, b, y) in &terms[i + 1..] {
                    let square = self.g.add(self.g.powi(a, 2), self.g.powi(b, 2));
                    let length = x.hypot(y);
                    if self.system.is_constant(square) && length > PIVOT * largest(&self.matrix.rows()[row]) {
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
        let mut candidates = Vec::new();
        for &row in &self.active {
            let scale = self.rows[row].scale;
            for (&column, &(_, x)) in &self.matrix.rows()[row] {
                let size = if scale > 0.0 { x.abs() / scale } else { 0.0 };
                if size.is_finite() && size > 0.0 {
                    candidates.push(Candidate { size, cost: self.fill(row, column), place: (row, column) });
                }
            }
        }
        choose_pivot(candidates)
    }

    fn named(&mut self, e: Expr) -> Expr {
        let named = self.coefficients.short(self.g, "c", SIDE, e);
        if named != e
            && let Some(symbol) = self.g.as_symbol(named)
        {
            let value = self.number(e);
            self.values.insert(symbol, value);
            self.ranges.insert(symbol, self.g.range(e, &self.ranges));
        }
        named
    }

    /// The value at the start; NaN where it is not finite.
    fn number(&self, e: Expr) -> f64 {
        self.g.evaluate(e, &self.values).unwrap_or(f64::NAN)
    }
}

fn largest(terms: &Terms) -> f64 {
    terms.values().fold(0.0, |largest, (_, x)| largest.max(x.abs()))
}
