//! Quantities of the user's own along a motion.

use symbolic::{CompileError, Evaluator, Expr, Symbol};

use crate::System;

/// The observables of a system ([`crate::Watched`] that need not stay constant), compiled.
#[derive(Clone, Debug)]
pub struct Observables {
    names: Vec<String>,
    program: Evaluator<f64>,
}

impl Observables {
    /// Those of `system`, with the values of its parameters.
    ///
    /// # Errors
    /// [`CompileError`] where one contains another symbol than `(t, q, v)`.
    pub fn of(system: &System) -> Result<Self, CompileError> {
        let watched = system.watched.iter().filter(|watched| !watched.is_constant());
        let (names, expressions): (Vec<String>, Vec<Expr>) = watched.map(|w| (w.name.clone(), w.expression)).unzip();
        let inputs: Vec<Symbol> = [&[system.time], &system.positions()[..], &system.velocities()].concat();
        Ok(Observables { names, program: system.evaluator(&inputs, &expressions)? })
    }

    /// Their names.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Their values at `(t, q, v)`.
    ///
    /// # Panics
    /// If `q` or `v` has another length than the system has coordinates.
    pub fn at(&mut self, t: f64, q: &[f64], v: &[f64]) -> &[f64] {
        self.program.evaluate(&[&[t], q, v].concat())
    }
}
