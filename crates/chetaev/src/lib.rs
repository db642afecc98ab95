//! # The Chetaev formulation (d'Alembert–Lagrange with reaction multipliers)
//!
//! Given are coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)` with `v = q̇`, constraints `f(q, v, t) = 0 ∈ Rʰ`
//! and generalized forces `Q(q, v, t)`. Write `A = ∂f/∂v` (h×n) and `M = ∂²L/∂v²` (n×n).
//!
//! **The principle.** At every instant `t`
//!
//! ```text
//! ( d/dt ∂L/∂v − ∂L/∂q − Q ) · δq = 0     for every virtual displacement with   A δq = 0.
//! ```
//!
//! That is Chetaev's condition: a displacement is virtual when it lies in the kernel of `∂f/∂v`. For
//! constraints linear in the velocities it is d'Alembert's principle; for others it is a definition.
//!
//! **The equations.** A covector that annihilates the kernel of `A` is a combination of the rows of `A`. So
//! there are reaction multipliers `λ ∈ Rʰ` with
//!
//! ```text
//! d/dt ∂L/∂v − ∂L/∂q = Q + Aᵀ λ ,        f(q, v, t) = 0 .
//! ```
//!
//! The reaction `Aᵀ λ` does no work on virtual displacements. `λᵢ` has the unit of power over that of `fᵢ`: a
//! force where `fᵢ` is a velocity.
//!
//! **One instant.** With `a = q̈` the first equation is linear in `(a, λ)`; so is the constraint after one
//! differentiation in time. Together they are the saddle-point system
//!
//! ```text
//! [ M  −Aᵀ ] [ a ]   [ L_q + Q − L_vq v − L_vt ]
//! [ A    0 ] [ λ ] = [ −(f_q v + f_t)          ]
//! ```
//!
//! with one solution if `A` has full row rank and `M` is regular on ker `A`. `M` itself may be singular.
//! Where `A` depends on the velocities it may lose rank along a motion, at the tip of a cone `f = 0`, and
//! several motions go on from there: the run stops.
//!
//! **What the motion depends on.** On `(q₀, v₀)` with `f(q₀, v₀, t₀) = 0`, and nothing else.
//!
//! **What stays constant.** The energy `v·L_v − L`, when nothing depends on time, `Q = 0`, and the motion
//! itself is a virtual displacement, `A v = 0` wherever `f = 0` (constraints homogeneous in `v`; *not* affine
//! ones). The momentum `∂L/∂vᵢ` of a coordinate not in `L` on which no reaction or force acts.
//!
//! Sources: N. G. Chetaev 1932; Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, 1972.

use equations::{Block, ConstraintProjection, Derivation, DerivationError, Equations, Formulation, Named, Statement};
use mechanics::{System, fresh_symbol};
use symbolic::{Expr, Symbol};

/// Entry of the table of formulations.
pub const FORMULATION: Formulation = Formulation {
    name: "chetaev",
    title: "Chetaev",
    needs_removal: false,
    starts_multipliers: false,
    parameter: None,
    derive,
};

/// Derives the Chetaev equations with states `(q, v)` and unknowns `(a, λ)`.
///
/// # Errors
/// None: every system has Chetaev equations. Whether they are regular shows when they are solved.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = chetaev::derive(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(line(0), "x'' + lambda_1*sin(phi) - 1");
/// assert_eq!(line(1), "y'' - lambda_1*cos(phi)");
/// assert_eq!(line(2), "phi''");
/// assert!(equations.free_constants.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(system: &System, _: &Derivation) -> Result<Equations, DerivationError> {
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(FORMULATION.name, &system);
    let (q, v, a) = (system.positions(), system.velocities(), system.accelerations());
    let flow = system.flow();
    let lambda: Vec<Symbol> = (1..=system.constraints.len()).map(|i| fresh_symbol(g, &format!("lambda_{i}"))).collect();

    // d/dt ∂L/∂v − ∂L/∂q − Q − Aᵀλ = 0
    let jacobian = g.jacobian(&system.constraints, &v);
    let momenta = g.gradient(system.lagrangian, &v);
    let gradient = g.gradient(system.lagrangian, &q);
    let reaction = g.transpose_vec(&jacobian, &g.variables(&lambda));
    let mut residuals: Vec<Expr> = (0..q.len())
        .map(|i| {
            let inertia = g.total_derivative(momenta[i], &flow);
            g.sub(inertia, g.sum(&[gradient[i], system.forces[i], reaction[i]]))
        })
        .collect();
    equations.statements = (0..q.len())
        .map(|i| Statement {
            meaning: format!("balance for {}", system.coordinates[i].name),
            left: residuals[i],
            right: g.zero(),
        })
        .chain(system.constraints.iter().map(|&f| Statement {
            meaning: "constraint".into(),
            left: f,
            right: system.graph.zero(),
        }))
        .collect();
    // d/dt f = 0
    residuals.extend(system.constraints.iter().map(|&f| g.total_derivative(f, &flow)));

    equations.add_positions_and_velocities(&system);
    equations.blocks = vec![Block {
        unknowns: a.iter().chain(&lambda).copied().collect(),
        residuals,
        guess: Vec::new(),
        regular: "constraint Jacobian of full row rank, mass matrix regular on its kernel",
    }];
    let moves = |&a: &Expr| g.symbols_of(a).iter().any(|symbol| v.contains(symbol));
    if (0..jacobian.rows()).any(|i| jacobian.row(i).iter().any(moves)) {
        equations.guard_rank(g);
    }
    equations.coordinates = g.variables(&q);
    equations.velocities = g.variables(&v);
    equations.multipliers = lambda.iter().map(|&s| Named { name: g.name(s), expression: g.variable(s) }).collect();
    equations.projection = (!system.constraints.is_empty()).then(|| ConstraintProjection {
        velocities: v.clone(),
        constraints: system.constraints.clone(),
        jacobian: jacobian.clone(),
        metric: g.jacobian(&momenta, &v),
    });

    if system.is_autonomous() && !system.has_forces() && system.is_workless() {
        equations.invariants.push(Named { name: "energy".into(), expression: system.energy() });
    }
    for i in 0..q.len() {
        let free =
            g.is_zero(gradient[i]) && g.is_zero(system.forces[i]) && jacobian.column(i).iter().all(|&e| g.is_zero(e));
        if free {
            let name = format!("momentum {}", system.coordinates[i].name);
            equations.invariants.push(Named { name, expression: momenta[i] });
        }
    }
    equations.graph = system.graph;
    Ok(equations)
}
