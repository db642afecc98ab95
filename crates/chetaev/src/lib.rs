//! # The d'Alembert–Lagrange equations of nonholonomic systems (Chetaev's condition)
//!
//! Wheels, skates and rolling bodies follow these equations, because friction holds their constraints. The
//! rule is that of `Chetaev1932`; textbooks are `NeimarkFufaev1972` and `Bloch2003` (keys of
//! `docs/references.bib`).
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
//! **What the motion depends on.** Only on `(q₀, v₀)` with `f(q₀, v₀, t₀) = 0`.
//!
//! **What stays constant.** The energy `v·L_v − L`, when nothing depends on time, `Q = 0`, and the motion
//! itself is a virtual displacement, `A v = 0` wherever `f = 0` (constraints homogeneous in `v`; *not* affine
//! ones). The momentum `∂L/∂vᵢ` of a coordinate not in `L` on which no reaction or force acts.
//!
//! **Reactions of one's own** ([`PRESCRIBED`]). Where a motor, a servo or friction keeps the constraint,
//! what is virtual is not `A δq = 0`. Conditions `w(q, v, t) ∈ Rʰ` say what is: with `W = ∂w/∂v`
//!
//! ```text
//! ( d/dt ∂L/∂v − ∂L/∂q − Q ) · δq = 0  wherever  W δq = 0 :     d/dt ∂L/∂v − ∂L/∂q = Q + Wᵀ λ ,     f = 0 .
//! ```
//!
//! Only `A` of the first rows of the saddle-point system becomes `W`. It has one solution where `W M⁻¹ Aᵀ` is
//! regular. Reactions do no work where `W v = 0`; else they feed the motion. `w = f` is Chetaev.
//!
//! Sources: N. G. Chetaev 1932; P. Appell 1911 and H. Béghin 1922 (servo constraints); C.-M. Marle 1998;
//! Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, 1972.

use equations::{Block, Derivation, DerivationError, Equations, Formulation, Named, Needs};
use mechanics::System;
use symbolic::Matrix;

/// Entry of the table of formulations.
pub const FORMULATION: Formulation =
    Formulation { name: "chetaev", title: "Chetaev", needs: Needs::Nothing, starts_multipliers: false, derive };

/// Entry of the table: virtual displacements as the system prescribes them, `W δq = 0`.
pub const PRESCRIBED: Formulation = Formulation {
    name: "prescribed",
    title: "prescribed δq",
    needs: Needs::VirtualConditions,
    starts_multipliers: false,
    derive: derive_prescribed,
};

const WITH_CHETAEV: &str = "constraint Jacobian of full row rank, mass matrix regular on its kernel";
const WITH_PRESCRIBED: &str = "W M⁻¹ Aᵀ regular: virtual displacements leave the reactions that keep the constraint";

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
    Ok(balance(FORMULATION.name, system, &system.constraint_jacobian()))
}

/// Derives `E = Q + Wᵀ λ`, `f = 0` with states `(q, v)` and unknowns `(a, λ)`.
///
/// # Errors
/// [`DerivationError::VirtualConditionsMissing`], [`DerivationError::VirtualConditions`].
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // the ice sledge, kept on its course by the rudder's torque: δφ = 0
/// system.virtual_conditions = vec![system.expression("phi'")?];
/// let equations = (chetaev::PRESCRIBED.derive)(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!([line(0), line(1), line(2)], ["x'' - 1", "y''", "phi'' - lambda_1"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
fn derive_prescribed(system: &System, _: &Derivation) -> Result<Equations, DerivationError> {
    let (formulation, found) = (PRESCRIBED.name, system.virtual_conditions.len());
    match system.constraints.len() {
        _ if found == 0 => Err(DerivationError::VirtualConditionsMissing { formulation }),
        expected if found != expected => Err(DerivationError::VirtualConditions { formulation, found, expected }),
        _ => {
            let rows = system.graph.jacobian(&system.virtual_conditions, &system.velocities());
            Ok(balance(formulation, system, &rows))
        }
    }
}

/// `E = Q + Wᵀ λ`, `f = 0` for the rows `W` (h×n).
fn balance(formulation: &'static str, system: &System, rows: &Matrix) -> Equations {
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(formulation, &system);
    let (q, v, a) = (system.positions(), system.velocities(), system.accelerations());
    let flow = system.flow();
    let prescribed = rows.entries() != system.constraint_jacobian().entries();
    let lambda = system.multipliers("lambda", "");

    // d/dt ∂L/∂v − ∂L/∂q − Q − Wᵀλ = 0
    let momenta = g.gradient(system.lagrangian, &v);
    let gradient = g.gradient(system.lagrangian, &q);
    let reaction = g.transpose_vec(rows, &g.variables(&lambda));
    let mut residuals = system.balances(&momenta, &[&gradient, &system.forces, &reaction], &flow);
    equations.state_balances(&system, &residuals);
    // d/dt f = 0
    residuals.extend(system.constraints.iter().map(|&f| g.total_derivative(f, &flow)));

    equations.add_positions_and_velocities(&system);
    equations.blocks = vec![Block {
        unknowns: a.iter().chain(&lambda).copied().collect(),
        residuals,
        guess: Vec::new(),
        regular: if prescribed { WITH_PRESCRIBED } else { WITH_CHETAEV },
    }];
    if prescribed {
        equations.guard_regular(g);
    }
    equations.multipliers = Named::symbols(g, &lambda);
    equations.return_onto_constraints(&system);
    let energy = system.is_workless(rows).then(|| system.energy());
    equations.add_invariants(&system, energy, &momenta, &[&gradient, &system.forces, &reaction]);
    equations.graph = system.graph;
    equations
}
