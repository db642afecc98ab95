//! # The first-order constraint law near the d'Alembert–Lagrange limit: ε and slip
//!
//! Friction instead of an ideal nonholonomic constraint has such corrections: `Eldering2016` of
//! `docs/references.bib`.
//!
//! Given: coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)`, constraints `f(q, v, t) = 0 ∈ Rʰ`, forces `Q`, and
//! two small numbers: `ε`, the parameter `epsilon`, a time of either sign, and `1/N`, the parameter `slip`.
//! One that is not given is zero. `A = ∂f/∂v` (h×n), and
//!
//! ```text
//! C = (∂f/∂q)ᵀ − Ȧᵀ          n×h ,    Ȧ along the motion.
//! ```
//!
//! `C λ` is the Euler–Lagrange derivative of `λ·f` with `λ` held fixed; its part on `ker A` is the curvature
//! of the constraint.
//!
//! **The equations.** With the multipliers `λ ∈ Rʰ` of Chetaev's reaction
//!
//! ```text
//! d/dt ∂L/∂v − ∂L/∂q = Q + Aᵀ λ − ε C λ ,        f(q, v, t) = −λ/N .
//! ```
//!
//! `ε = 0` and `1/N = 0` is Chetaev.
//!
//! **Where ε comes from.** With `λ := −(κ μ + μ̇)` the equations of the family `kappa` are
//! `d/dt ∂L/∂v − ∂L/∂q = Q + Aᵀ λ + C μ`. After the time 1/κ, `μ = −λ/κ + O(1/κ²)`; only `ε = 1/κ` remains.
//! So `−ε C λ` is the first-order vakonomic term in Chetaev's equations. Chetaev, a limit of the family, is
//! the inner point ε = 0 here, so that ε can be estimated. For `f` affine in `v` the law differs from the
//! family by `O(ε²)` if `μ₀ = O(ε)`, and then needs no `μ₀`. A fixed `μ₀ ≠ 0` kicks the start within the time
//! 1/κ: the law has to begin at `v₀ + ε Π C μ₀`, else it is `O(ε)` off (Theorem 10 of `docs/theory.md`).
//!
//! **Where slip comes from.** A contact of viscosity `N` keeps the constraint by the force `−N Aᵀ f`: that is
//! `Aᵀ λ` where `f = −λ/N`. The constraint holds only up to slip (creep).
//!
//! **One instant.** Without slip the unknowns are `(a, λ)`, and `f` is kept by its rate; where `f` is linear
//! in the velocities they are those of
//!
//! ```text
//! [ M  εC − Aᵀ ] [ a ]   [ L_q + Q − L_vq v − L_vt ]
//! [ A     0    ] [ λ ] = [ −(f_q v + f_t)          ]
//! ```
//!
//! With slip `λ = −N f` is known before, and only `M` has to be regular. Where `A` depends on the velocities,
//! `C` contains `a`, and the equations are not linear.
//!
//! **What the motion depends on.** On `(q₀, v₀)`; with slip, started at `f = 0`, the slip builds up within a
//! time of about `m/N`.
//!
//! **What stays constant.** Without slip the energy `v·L_v − L` where nothing depends on time, `Q = 0` and
//! `f` is homogeneous in `v`: `v·C λ = (1−d) λ·ḟ = 0` for degree `d`. So no friction along the motion
//! imitates ε.
//!
//! Source: V. V. Kozlov 1992 for the family; the expansion is this page's.

use equations::{Block, Derivation, DerivationError, Equations, Formulation, Named, Needs, parameter};
use mechanics::System;
use symbolic::Expr;

/// Entry of the table of formulations.
pub const FORMULATION: Formulation = Formulation {
    name: "first-order",
    title: "first order, ε and slip",
    needs: Needs::Parameters(&["epsilon", "slip"]),
    starts_multipliers: false,
    derive,
};

/// The Euler–Lagrange derivative `C μ` of `μ·f`, `C = (∂f/∂q)ᵀ − Ȧᵀ`, with `multipliers` `μ` held fixed: n
/// components, in `(q, v, a, t)`.
pub fn euler_lagrange(system: &System, multipliers: &[Expr]) -> Vec<Expr> {
    let g = &system.graph;
    let flow = system.flow();
    let (by_q, by_v) = (g.jacobian(&system.constraints, &system.positions()), system.constraint_jacobian());
    let column = |i: usize| -> Vec<Expr> {
        by_q.column(i).into_iter().zip(by_v.column(i)).map(|(q, a)| g.sub(q, g.total_derivative(a, &flow))).collect()
    };
    (0..system.dimension()).map(|i| g.dot(&column(i), multipliers)).collect()
}

/// Derives the equations with states `(q, v)` and unknowns `(a, λ)`.
///
/// # Errors
/// [`DerivationError::ParameterMissing`] where the system has neither of the parameters `epsilon` and `slip`.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// # let symbol = system.graph.symbol("epsilon");
/// # system.parameters.push(mechanics::Parameter { symbol, value: 0.01, formula: None });
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = first_order::derive(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(line(0), "x'' + phi'*epsilon*lambda_1*cos(phi) + lambda_1*sin(phi) - 1");
/// assert_eq!(line(2), "phi'' - epsilon*lambda_1*(x'*cos(phi) + y'*sin(phi))");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(system: &System, _: &Derivation) -> Result<Equations, DerivationError> {
    let [epsilon, slip] = ["epsilon", "slip"].map(|name| parameter(system, name));
    if epsilon.or(slip).is_none() {
        return Err(DerivationError::ParameterMissing { formulation: FORMULATION.name, parameter: "epsilon" });
    }
    let variable = |symbol| system.graph.variable(symbol);
    let creeping = slip.filter(|symbol| system.parameter_values()[symbol] != 0.0);
    Ok(law(system, epsilon.map_or(system.graph.zero(), variable), creeping.map(variable)))
}

/// The equations for expressions `ε` and `1/N`; without the second, constraints are kept.
pub fn law(system: &System, epsilon: Expr, slip: Option<Expr>) -> Equations {
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(FORMULATION.name, &system);
    let (q, v) = (system.positions(), system.velocities());
    let flow = system.flow();
    let multipliers = system.multipliers("lambda", "");
    let lambda = g.variables(&multipliers);

    // d/dt ∂L/∂v − ∂L/∂q − Q − Aᵀλ + ε Cλ = 0
    let momenta = g.gradient(system.lagrangian, &v);
    let gradient = g.gradient(system.lagrangian, &q);
    let trace = g.neg(epsilon);
    let along = g.transpose_vec(&system.constraint_jacobian(), &lambda);
    let turned = euler_lagrange(&system, &lambda);
    let reaction: Vec<Expr> = along.iter().zip(turned).map(|(&a, c)| g.add(a, g.mul(trace, c))).collect();
    let mut residuals = system.balances(&momenta, &[&gradient, &system.forces, &reaction], &flow);
    equations.state_balances(&system, &residuals);
    match slip {
        // f + λ/N = 0
        Some(slip) => {
            let creep = |(&f, &lambda): (&Expr, &Expr)| g.add(f, g.mul(slip, lambda));
            residuals.extend(system.constraints.iter().zip(&lambda).map(creep));
            for (statement, &residual) in equations.statements[q.len()..].iter_mut().zip(&residuals[q.len()..]) {
                (statement.meaning, statement.left) = ("slip".into(), residual);
            }
            equations.creeps = true;
        }
        // d/dt f = 0
        None => {
            residuals.extend(system.constraints.iter().map(|&f| g.total_derivative(f, &flow)));
            equations.return_onto_constraints(&system);
        }
    }

    equations.add_positions_and_velocities(&system);
    equations.blocks = vec![Block {
        unknowns: system.accelerations().into_iter().chain(multipliers.iter().copied()).collect(),
        residuals,
        guess: Vec::new(),
        regular: "constraint Jacobian of full row rank, mass matrix regular on its kernel, and ε small",
    }];
    equations.multipliers = Named::symbols(g, &multipliers);
    let workless = slip.is_none() && system.is_workless(&system.constraint_jacobian());
    equations.add_invariants(
        &system,
        workless.then(|| system.energy()),
        &momenta,
        &[&gradient, &system.forces, &reaction],
    );
    equations.graph = system.graph;
    equations
}
