//! Quantities that may change within less than a step: rapidly varying functions, jumping angles, vanishing
//! divisors, ranks.

use std::collections::{HashMap, HashSet};

use symbolic::{Expr, Range, Steep, Symbol};

use crate::blocks::EvaluationFailure;
use crate::compiled::Compiled;
use crate::equations::Equations;

impl Equations {
    /// Rapidly varying functions in the equations.
    pub fn steep(&self) -> Vec<Steep> {
        let steep = self.graph.steep(&self.all(), &self.values());
        let told = self.told(steep.iter().map(|steep| steep.argument));
        steep.into_iter().zip(told).filter_map(|(steep, told)| Some(Steep { argument: told?, ..steep })).collect()
    }

    /// The highest power of an unbounded quantity in the equations: [`symbolic::Graph::highest_power`].
    pub fn highest_power(&self) -> f64 {
        self.graph.highest_power(&self.all(), &self.values())
    }

    /// Angles of points in the equations: [`symbolic::Graph::angles`].
    pub fn angles(&self) -> Vec<Expr> {
        self.told(self.graph.angles(&self.all())).into_iter().flatten().collect()
    }

    /// Divisors in the equations that change along a motion and may vanish: [`symbolic::Graph::divisors`].
    pub fn divisors(&self) -> Vec<Expr> {
        let divisors = self.told(self.graph.divisors(&self.all(), &self.values()));
        let moving = if divisors.is_empty() { HashSet::new() } else { self.moving() };
        let moves = |divisor: &Expr| !self.symbols_behind([*divisor]).is_disjoint(&moving);
        divisors.into_iter().flatten().filter(moves).collect()
    }

    /// Quantities in `(t, y, z)`, with outputs in the place of coordinates and velocities that are neither
    /// states nor unknowns; `None` where the equations do not tell one.
    fn told(&self, quantities: impl IntoIterator<Item = Expr>) -> Vec<Option<Expr>> {
        let mut quantities = quantities.into_iter().peekable();
        if quantities.peek().is_none() {
            return Vec::new();
        }
        let defined = self.definitions.iter().map(|(symbol, _)| *symbol);
        let mut told: HashSet<Symbol> = defined.chain(self.known_symbols()).chain(self.unknowns()).collect();
        told.extend(self.parameters.keys());
        let (q, v) = self.own.split_at(self.own.len() / 2);
        let outputs = q.iter().zip(&self.coordinates).chain(v.iter().zip(&self.velocities));
        let outputs: HashMap<Symbol, Expr> =
            outputs.map(|(&own, &output)| (own, output)).filter(|(own, _)| !told.contains(own)).collect();
        let is_told = |e: &Expr| self.symbols_behind([*e]).is_subset(&told);
        quantities.map(|e| Some(self.graph.substitute(e, &outputs)).filter(is_told)).collect()
    }

    fn values(&self) -> HashMap<Symbol, Range> {
        self.parameters.iter().map(|(&s, &value)| (s, Range::point(value))).collect()
    }

    /// Symbols of time, states and unknowns.
    fn moving(&self) -> HashSet<Symbol> {
        self.state_symbols().into_iter().chain([self.time]).chain(self.unknowns()).collect()
    }

    /// All expressions that are evaluated for the rates.
    fn all(&self) -> Vec<Expr> {
        let definitions = self.definitions.iter().map(|(_, e)| *e);
        let residuals = self.blocks.iter().flat_map(|block| block.residuals.iter().copied());
        let rates = self.states.iter().map(|y| y.rate);
        definitions.chain(residuals).chain(rates).chain(self.given.iter().copied()).collect()
    }
}

impl Compiled {
    /// Loads `(t, y)`, and solves the equations of the instant there if they are needed.
    fn reach(&mut self, need_unknowns: bool, t: f64, y: &[f64]) -> Result<(), EvaluationFailure> {
        self.load(t, y);
        if need_unknowns { self.solve_instant(t, y) } else { Ok(()) }
    }

    /// Gauges of functions that may change within little of their arguments: [`symbolic::Steep`].
    pub fn gauges(&self) -> &[fn(f64) -> f64] {
        &self.gauges
    }

    /// [`Equations::highest_power`].
    pub fn highest_power(&self) -> f64 {
        self.highest_power
    }

    /// The arguments of these functions.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn gauged(&mut self, t: f64, y: &[f64], arguments: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.reach(self.steep.need_unknowns, t, y)?;
        arguments.copy_from_slice(self.steep.evaluate(&self.instant.inputs));
        Ok(())
    }

    /// The angles of points in the equations: [`symbolic::Graph::angles`].
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn angles(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.reach(self.angles.need_unknowns, t, y)?;
        Ok(self.angles.evaluate(&self.instant.inputs).to_vec())
    }

    /// Number of [`Equations::divisors`].
    pub fn divisors(&self) -> usize {
        self.divisors.count()
    }

    /// The values of what the equations divide by.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn divided(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.reach(self.divisors.need_unknowns, t, y)?;
        values.copy_from_slice(self.divisors.evaluate(&self.instant.inputs));
        Ok(())
    }

    /// Rows and columns of [`Equations::rows`]; `(0, 0)` where there are none.
    pub fn rank(&self) -> (usize, usize) {
        self.rows.as_ref().map_or((0, 0), |rows| rows.shape)
    }

    /// The entries of [`Equations::rows`] at `(t, y)`, row-major.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn rows(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.reach(self.rows.as_ref().is_some_and(|rows| rows.entries.need_unknowns), t, y)?;
        if let Some(rows) = &mut self.rows {
            entries.copy_from_slice(rows.entries.evaluate(&self.instant.inputs));
        }
        Ok(())
    }

    /// Whether other pivots might be taken ([`Equations::chart`]).
    pub fn has_chart(&self) -> bool {
        self.guards.values().len() > self.guards() || self.rows.as_ref().is_some_and(|rows| rows.replaceable)
    }
}
