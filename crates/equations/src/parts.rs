//! Parts that the equations of several formulations share.

use mechanics::System;
use symbolic::Expr;

use crate::equations::{ConstraintProjection, Equations, Named, Statement};

impl Equations {
    /// States `left = 0` for the reader: a balance per coordinate, and the constraints.
    pub fn state_balances(&mut self, system: &System, balances: &[Expr]) {
        let g = &system.graph;
        let statement = |meaning: String, left: Expr| Statement { meaning, left, right: g.zero() };
        let named = balances.iter().zip(&system.coordinates);
        self.statements = named.map(|(&e, c)| statement(format!("balance for {}", c.name), e)).collect();
        self.statements.extend(system.constraints.iter().map(|&f| statement("constraint".into(), f)));
    }

    /// Return of the velocities onto `f = 0`, in the metric `M = ∂²L/∂v²`.
    pub fn return_onto_constraints(&mut self, system: &System) {
        self.projection = (!system.constraints.is_empty()).then(|| ConstraintProjection {
            velocities: system.velocities(),
            constraints: system.constraints.clone(),
            jacobian: system.constraint_jacobian(),
            metric: system.velocity_hessian(),
        });
    }

    /// What stays constant where the rates of `momenta` are sums of `forces`, lists of one per coordinate:
    /// `energy`, where there is one, nothing depends on time and no force of the user's acts; and the
    /// momentum of each coordinate whose forces are all zero.
    pub fn add_invariants(&mut self, system: &System, energy: Option<Expr>, momenta: &[Expr], forces: &[&[Expr]]) {
        let energy = energy.filter(|_| system.is_autonomous() && !system.has_forces());
        self.invariants.extend(energy.map(|expression| Named { name: "energy".into(), expression }));
        for (i, c) in system.coordinates.iter().enumerate() {
            if forces.iter().all(|list| system.graph.is_zero(list[i])) {
                self.invariants.push(Named { name: format!("momentum {}", c.name), expression: momenta[i] });
            }
        }
    }
}
