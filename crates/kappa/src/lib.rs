//! # The family between the vakonomic and the d'Alembert–Lagrange (Chetaev) equations of nonholonomic systems
//!
//! Given: coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)`, constraints `f(q, v, t) = 0 ∈ Rʰ`, forces `Q` and
//! `κ ≥ 0`, the parameter `kappa`, in 1/s. `A = ∂f/∂v` (h×n), `𝓛 = L + μ·f`, multipliers `μ(t) ∈ Rʰ`.
//!
//! **The equations.**
//!
//! ```text
//! d/dt ∂𝓛/∂v − ∂𝓛/∂q = Q − κ Aᵀ μ ,        f(q, v, t) = 0 .
//! ```
//!
//! `κ = 0` is vakonomic. As `κ → ∞` the motion tends to Chetaev's, with the error 1/κ, if the start is
//! regular at `s μ₀` for all `0 ≤ s ≤ 1` (the matrix below is invertible with `s μ₀` instead of `μ`): `μ`
//! runs along `s μ₀` to `−λ/κ` within the time 1/κ, and what is left of the right-hand side is `Aᵀ λ`. For
//! `f` affine in `v` the matrix does not depend on `μ`. The Appell–Hamel system with `μ₀ > m/(2a²)` ends at
//! `t ≈ ln(2a²μ₀/m)/κ` instead, however large `κ` is. Proof: Theorem 9 of `docs/theory.md`.
//!
//! **What it is for.** A constraint kept by large added mass `½ N f·f` *and* large viscous friction `−κ N Aᵀ
//! f` leads, as `N → ∞`, to neither of the two but to this: `μ = lim N f`. Friction over mass is `κ`.
//!
//! **One instant.** With the state `(q, v, μ)` the equations are linear in `(a, μ̇)`:
//!
//! ```text
//! [ 𝓛_vv  Aᵀ ] [ a  ]   [ 𝓛_q + Q − κ Aᵀ μ − 𝓛_vq v − 𝓛_vt ]
//! [ A      0 ] [ μ̇ ] = [ −(f_q v + f_t)                    ]
//! ```
//!
//! **What the motion depends on.** `(q₀, v₀)`, `μ₀ ∈ Rʰ` and `κ`. Large `κ` makes the equations stiff.
//!
//! **What stays constant.** The energy `v·𝓛_v − 𝓛` changes at the rate `v·(Q − κ Aᵀ μ)`, which is zero where
//! `Q = 0` and `f` is homogeneous in `v`, as `A v = d f` then. The momentum `∂𝓛/∂v_i` is constant where
//! neither `L` nor `f` contains `q_i`, no force acts on it and `f` does not contain `v_i`.
//!
//! Sources: C. Carathéodory 1933; A. V. Karapetyan 1981; V. V. Kozlov 1992.

use equations::{
    Block, Derivation, DerivationError, Equations, Formulation, FreeConstant, Named, Needs, Role, StateVariable,
    parameter,
};
use mechanics::System;
use symbolic::Expr;

/// Entry of the table of formulations.
pub const FORMULATION: Formulation = Formulation {
    name: "kappa",
    title: "between, κ",
    needs: Needs::Parameters(&["kappa"]),
    starts_multipliers: true,
    derive,
};

/// Derives states `(q, v, μ)`, unknowns `(a, μ̇)`, free constants `μ₀`.
///
/// # Errors
/// [`DerivationError::ParameterMissing`] where the system has no parameter `kappa`.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// # let symbol = system.graph.symbol("kappa");
/// # system.parameters.push(mechanics::Parameter { symbol, value: 0.5, formula: None });
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = kappa::derive(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(line(0), "x'' - phi'*mu_1*cos(phi) - kappa*mu_1*sin(phi) - mu_1'*sin(phi) - 1");
/// assert_eq!(line(2), "phi'' + mu_1*(x'*cos(phi) + y'*sin(phi))");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(system: &System, _: &Derivation) -> Result<Equations, DerivationError> {
    let system = system.clone();
    let g = &system.graph;
    let missing = DerivationError::ParameterMissing { formulation: FORMULATION.name, parameter: "kappa" };
    let kappa = parameter(&system, "kappa").ok_or(missing)?;
    let mut equations = Equations::new(FORMULATION.name, &system);
    let (q, v, a) = (system.positions(), system.velocities(), system.accelerations());
    let [multipliers, starts, rates] = [("mu", ""), ("mu0", ""), ("mu", "'")].map(|(m, p)| system.multipliers(m, p));
    let mu = g.variables(&multipliers);
    let mut flow = system.flow();
    flow.extend(multipliers.iter().copied().zip(g.variables(&rates)));

    // d/dt ∂𝓛/∂v − ∂𝓛/∂q − Q + κ Aᵀ μ = 0
    let jacobian = system.constraint_jacobian();
    let augmented = g.add(system.lagrangian, g.dot(&mu, &system.constraints));
    let (momenta, gradient) = (g.gradient(augmented, &v), g.gradient(augmented, &q));
    let pull = g.transpose_vec(&jacobian, &mu);
    let mut residuals: Vec<Expr> = (0..q.len())
        .map(|i| {
            let inertia = g.sub(g.total_derivative(momenta[i], &flow), gradient[i]);
            g.sum(&[inertia, g.neg(system.forces[i]), g.mul(g.variable(kappa), pull[i])])
        })
        .collect();
    equations.state_balances(&system, &residuals);
    // d/dt f = 0
    residuals.extend(system.constraints.iter().map(|&f| g.total_derivative(f, &flow)));

    equations.add_positions_and_velocities(&system);
    for (i, &symbol) in multipliers.iter().enumerate() {
        equations.states.push(StateVariable::of(g, symbol, Role::Multiplier, rates[i], starts[i]));
        equations.free_constants.push(FreeConstant::new(starts[i]));
    }
    equations.multipliers = Named::symbols(g, &multipliers);
    equations.blocks = vec![Block {
        unknowns: a.iter().chain(&rates).copied().collect(),
        residuals,
        guess: Vec::new(),
        regular: "constraint Jacobian of full row rank, ∂²𝓛/∂v² regular on its kernel",
    }];
    equations.guard(g, &system.constraints);
    equations.return_onto_constraints(&system);
    let energy = g.sub(g.dot(&g.variables(&v), &momenta), augmented);
    let energy = system.is_workless(&jacobian).then_some(energy);
    equations.add_invariants(&system, energy, &momenta, &[&gradient, &system.forces, &pull]);
    equations.graph = system.graph;
    Ok(equations)
}
