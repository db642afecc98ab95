//! Quantities that may change within less than a step: rapidly varying functions, jumping angles, vanishing
//! divisors, ranks.

use std::collections::{HashMap, HashSet};

use symbolic::{Expr, Range, Steep, Symbol};

use crate::blocks::EvaluationFailure;
use crate::compiled::Compiled;
use crate::equations::Equations;

impl Equations {
    /// Rapidly varying functions in the equations whose arguments are known before the acceleration-level
    /// system is solved.
    pub fn steep(&self) -> Vec<Steep> {
        let mut steep = self.graph.steep(&self.all(), &self.values());
        if !steep.is_empty() {
            let is_known = self.is_known();
            steep.retain(|steep| is_known(steep.argument));
        }
        steep
    }

    /// The highest power of an unbounded quantity in the equations: [`symbolic::Graph::highest_power`].
    pub fn highest_power(&self) -> f64 {
        self.graph.highest_power(&self.all(), &self.values())
    }

    /// Angles of points in the equations, in the same way: [`symbolic::Graph::angles`].
    pub fn angles(&self) -> Vec<Expr> {
        let mut angles = self.graph.angles(&self.all());
        if !angles.is_empty() {
            let is_known = self.is_known();
            angles.retain(|&angle| is_known(angle));
        }
        angles
    }

    /// Divisors in the equations that change along a motion and may vanish, in the same way:
    /// [`symbolic::Graph::divisors`].
    pub fn divisors(&self) -> Vec<Expr> {
        let mut divisors = self.graph.divisors(&self.all(), &self.values());
        if !divisors.is_empty() {
            let (is_known, moving) = (self.is_known(), self.moving());
            divisors.retain(|&divisor| is_known(divisor) && !self.symbols_behind([divisor]).is_disjoint(&moving));
        }
        divisors
    }

    fn values(&self) -> HashMap<Symbol, Range> {
        self.parameters.iter().map(|(&s, &value)| (s, Range::point(value))).collect()
    }

    /// Symbols of time and states.
    fn moving(&self) -> HashSet<Symbol> {
        self.state_symbols().into_iter().chain([self.time]).collect()
    }

    /// All expressions that are evaluated for the rates.
    fn all(&self) -> Vec<Expr> {
        let definitions = self.definitions.iter().map(|(_, e)| *e);
        let residuals = self.blocks.iter().flat_map(|block| block.residuals.iter().copied());
        let rates = self.states.iter().map(|y| y.rate);
        definitions.chain(residuals).chain(rates).chain(self.given.iter().copied()).collect()
    }

    /// Whether something is known before the instant is solved.
    fn is_known(&self) -> impl Fn(Expr) -> bool {
        let defined = self.definitions.iter().map(|(symbol, _)| *symbol);
        let mut known: HashSet<Symbol> = defined.chain(self.known_symbols()).collect();
        known.extend(self.parameters.keys());
        move |e| self.symbols_behind([e]).is_subset(&known)
    }
}

impl Compiled {
    /// Gauges of functions that may change within little of their arguments: [`symbolic::Steep`].
    pub fn gauges(&self) -> &[fn(f64) -> f64] {
        &self.gauges
    }

    /// [`Equations::highest_power`].
    pub fn highest_power(&self) -> f64 {
        self.highest_power
    }

    /// The arguments of these functions.
    pub fn gauged(&mut self, t: f64, y: &[f64], arguments: &mut [f64]) {
        self.load(t, y);
        arguments.copy_from_slice(self.steep.evaluate(&self.instant.inputs[..self.instant.sizes.known()]));
    }

    /// The angles of points in the equations: [`symbolic::Graph::angles`].
    pub fn angles(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        self.load(t, y);
        self.angles.evaluate(&self.instant.inputs[..self.instant.sizes.known()]).to_vec()
    }

    /// Number of [`Equations::divisors`].
    pub fn divisors(&self) -> usize {
        self.divisors.values().len()
    }

    /// The values of what the equations divide by.
    pub fn divided(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.load(t, y);
        values.copy_from_slice(self.divisors.evaluate(&self.instant.inputs[..self.instant.sizes.known()]));
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
        self.load(t, y);
        if self.rows.as_ref().is_some_and(|rows| rows.need_unknowns) {
            self.solve_instant(t, y)?;
        }
        if let Some(rows) = &mut self.rows {
            entries.copy_from_slice(rows.program.evaluate(&self.instant.inputs[..rows.inputs]));
        }
        Ok(())
    }

    /// Whether other pivots might be taken ([`Equations::chart`]).
    pub fn has_chart(&self) -> bool {
        self.guards.values().len() > self.guards() || self.rows.as_ref().is_some_and(|rows| rows.replaceable)
    }
}
