//! A deliberately wrong formulation, as a negative control of the tests.
//!
//! Lindelöf's mistake of 1895: substitute the constraint into the Lagrangian and take Lagrange's equations of
//! the result,
//!
//! ```text
//! L̃(u̇, u, w, t) = L with q, q̇ replaced by the removal,     d/dt ∂L̃/∂u̇ − ∂L̃/∂u = 0 ,     ẇ = B ,
//! ```
//!
//! as if `w` did not depend on the variation of `u`. It is right for integrable constraints in Chaplygin form
//! (`w` in neither `L` nor `B`), and wrong nearly everywhere else. A test that does not notice is broken.

use comparison::Run;
use equations::{Block, Derivation, DerivationError, Equations, Formulation, Needs, Role, StateVariable, Statement};
use mechanics::{ConstantsRule, DisplacementParameter, Removal, System};
use motion::{Choice, Settings, setting, solve};
use scene::Scene;
use symbolic::Expr;

/// The control: beside the table of formulations, so that nobody picks it by name.
pub static SUBSTITUTION: Formulation = Formulation {
    name: "substitution",
    title: "substitution (wrong on purpose)",
    needs: Needs::Removal,
    starts_multipliers: false,
    derive: derive_for,
};

fn derive_for(system: &System, derivation: &Derivation) -> Result<Equations, DerivationError> {
    let missing = DerivationError::RemovalMissing { formulation: SUBSTITUTION.name };
    derivation.removal.map(|removal| derive(system, removal)).ok_or(missing)
}

/// What the wrong equations set to zero, `d/dt ∂L̃/∂u̇ − ∂L̃/∂u` in `(ü, u̇, u, w, t)`, one per parameter.
pub fn residuals(system: &System, removal: &Removal) -> Vec<Expr> {
    let (g, flow) = (&system.graph, removal.flow(system));
    let lagrangian = removal.rewrite(system, system.lagrangian);
    let of = |u: &DisplacementParameter| {
        let momentum = g.derivative(lagrangian, u.rate);
        g.sub(g.total_derivative(momentum, &flow), g.derivative(lagrangian, u.symbol))
    };
    removal.parameters.iter().map(of).collect()
}

/// The wrong equations for `removal`.
///
/// Second rates are treated as Lagrange's first-order equations would: no removal may bring them into `L`.
pub fn derive(system: &System, removal: &Removal) -> Equations {
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(SUBSTITUTION.name, &system);
    let lagrangian = removal.rewrite(&system, system.lagrangian);
    let residuals = residuals(&system, removal);
    for (u, &residual) in removal.parameters.iter().zip(&residuals) {
        let meaning = format!("balance for {}", g.name(u.symbol));
        equations.statements.push(Statement { meaning, left: residual, right: g.zero() });
        let role = if u.coordinate.is_some() { Role::Position } else { Role::DisplacementParameter };
        for (symbol, role, rate) in [(u.symbol, role, u.rate), (u.rate, Role::ParameterRate, u.second_rate)] {
            equations.states.push(StateVariable::of(g, symbol, role, rate, symbol));
        }
    }
    for w in &removal.memory {
        let role = if w.coordinate.is_some() { Role::Position } else { Role::Memory };
        let start = g.variable(w.symbol);
        equations.states.push(StateVariable { symbol: w.symbol, role, rate: w.rate, start });
    }
    equations.blocks = vec![Block {
        unknowns: removal.parameters.iter().map(|u| u.second_rate).collect(),
        residuals,
        guess: Vec::new(),
        regular: "Hessian of the substituted L in the rates of the parameters regular",
    }];
    equations.coordinates = removal.coordinates.clone();
    equations.velocities = removal.velocities(&system);
    let memory = removal.memory.iter().map(|w| w.rate);
    let singular: Vec<Expr> = equations.coordinates.iter().copied().chain(memory).chain([lagrangian]).collect();
    equations.guards = equations.singularities(g, &singular);
    equations.removal = Some(removal.clone());
    equations.graph = system.graph;
    equations.leave_out_unneeded()
}

/// The control on the first removal among the `choices` of a scene; `None` without one or with forces.
pub fn run(scene: &Scene, choices: &[Choice], settings: &Settings) -> Option<Run> {
    if scene.system.has_forces() {
        return None;
    }
    let removal = choices.iter().find_map(|choice| choice.removal.clone())?;
    let equations = derive(&scene.system, &removal);
    let choice = Choice {
        label: SUBSTITUTION.title.into(),
        formulation: &SUBSTITUTION,
        removal: Some(removal),
        constants: ConstantsRule::Zero,
    };
    let outcome = solve(setting(scene), equations, &ConstantsRule::Zero, settings);
    Some(Run { choice, outcome })
}
