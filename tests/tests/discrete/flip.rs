//! Equations with a wrong sign.

use std::collections::HashMap;

use equations::{Equations, Role};
use mechanics::{DisplacementParameter, System};
use symbolic::{Expr, Graph, Symbol};

use super::flipped::Trial;

/// A sign to flip.
#[derive(Clone, Copy, Debug)]
pub enum Flip {
    /// `d/dt L_v − L_q` becomes `d/dt L_v + L_q`.
    Force,
    /// `− μ·f_q` becomes `+ μ·f_q`.
    Curvature,
    /// `d/dt G_u̇ − G_u` becomes `d/dt G_u̇ + G_u`.
    ParameterForce,
    /// `Ṗ = −G_w` becomes `Ṗ = G_w`.
    Costate,
}

/// What the residuals are the Euler–Lagrange expressions of, with the sign `+ d/dt ∂/∂v − ∂/∂q`.
struct Whole {
    /// `L`, `L + μ·f`, or `G`.
    function: Expr,
    /// `q` or `u`.
    positions: Vec<Symbol>,
    /// `v` or `u̇`.
    rates: Vec<Symbol>,
    /// `a` or `ü`.
    second_rates: Vec<Symbol>,
}

/// `system` holds the graph of the equations.
fn whole(trial: &Trial, system: &System, equations: &Equations) -> Whole {
    let g = &system.graph;
    let Some(removal) = &trial.removal else {
        return Whole {
            function: g.add(system.lagrangian, constraint_part(system, equations)),
            positions: system.positions(),
            rates: system.velocities(),
            second_rates: system.accelerations(),
        };
    };
    let costates = variables(g, equations, Role::MemoryCostate);
    assert_eq!(costates.len(), equations.free_constants.len());
    let constants = equations.free_constants.iter().zip(&costates);
    let terms = constants.filter_map(|(c, &p)| c.memory.map(|i| g.mul(p, removal.memory[i].rate)));
    let function = g.add(removal.rewrite(system, system.lagrangian), g.sum(&terms.collect::<Vec<_>>()));
    let symbols = |of: fn(&DisplacementParameter) -> Symbol| removal.parameters.iter().map(of).collect();
    let (positions, rates, second_rates) = (symbols(|u| u.symbol), symbols(|u| u.rate), symbols(|u| u.second_rate));
    Whole { function, positions, rates, second_rates }
}

fn variables(g: &Graph, equations: &Equations, role: Role) -> Vec<Expr> {
    equations.states.iter().filter(|y| y.role == role).map(|y| g.variable(y.symbol)).collect()
}

/// `μ·f`; zero for Chetaev, which has no such states.
fn constraint_part(system: &System, equations: &Equations) -> Expr {
    let multipliers = variables(&system.graph, equations, Role::Multiplier);
    if multipliers.is_empty() { system.graph.zero() } else { system.graph.dot(&multipliers, &system.constraints) }
}

/// That every residual contains `+ Σ ∂²/∂v_i∂v_j a_j` of the whole, identically: with the other sign, what is added would be no flip.
fn assert_signs(what: &str, g: &Graph, residuals: &[Expr], whole: &Whole, parameters: &HashMap<Symbol, f64>) {
    for (&residual, &rate) in residuals.iter().zip(&whole.rates) {
        let momentum = g.derivative(whole.function, rate);
        for (&other, &a) in whole.rates.iter().zip(&whole.second_rates) {
            let difference = g.sub(g.derivative(residual, a), g.derivative(momentum, other));
            assert!(g.vanishes(difference, parameters).is_zero(), "{what}: {}", g.plain(difference));
        }
    }
}

/// The equations with the flip.
pub fn corrupt(trial: &Trial, mut equations: Equations, flip: Flip) -> Equations {
    // Every derivation clones the graph of the system, so that the system's expressions are in that of the equations too.
    let mut system = trial.scene.system.clone();
    system.graph = equations.graph.clone();
    let g = &system.graph;
    let whole = whole(trial, &system, &equations);
    let [block] = equations.blocks.as_slice() else { panic!("{}: one block is expected", trial.what) };
    assert_signs(&trial.what, g, &block.residuals, &whole, &system.parameter_values());
    let flipped = match flip {
        Flip::Force => g.gradient(system.lagrangian, &whole.positions),
        Flip::Curvature => g.gradient(constraint_part(&system, &equations), &whole.positions),
        Flip::ParameterForce => g.gradient(whole.function, &whole.positions),
        Flip::Costate => Vec::new(),
    };
    if let Flip::Costate = flip {
        for costate in equations.states.iter_mut().filter(|y| y.role == Role::MemoryCostate) {
            costate.rate = g.neg(costate.rate);
        }
    }
    for (residual, term) in equations.blocks[0].residuals.iter_mut().zip(flipped) {
        *residual = g.add(*residual, g.mul(g.integer(2), term));
    }
    equations.graph = system.graph;
    equations
}
