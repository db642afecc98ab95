//! # Chetaev's equations in quasi-velocities
//!
//! With `v = S w + s`, virtual displacements are `δq = S ε` with `ε` free, so that the principle becomes
//!
//! ```text
//! Sᵀ ( d/dt ∂L/∂v − ∂L/∂q − Q ) = 0 ,      q̇ = S w + s :
//! ```
//!
//! n − h equations without multipliers. With `v̇ = S ẇ + γ`, `γ = Ṡ w + ṡ`, they are
//!
//! ```text
//! SᵀMS ẇ = Sᵀ ( L_q + Q − L_vq v − L_vt − M γ ) .
//! ```
//!
//! The constraint holds in every state `(q, w)`: there is nothing to drift from and nothing to project.
//!
//! The residual of the balance before reduction is `Aᵀ λ`; the recursion of the velocities in reverse order
//! gives `λ` ([`crate::EliminatedConstraint`]), an output that no rate needs.
//!
//! `S` is not written out in `q`: it is a recursion ([`QuasiVelocities`]), as are its columns, `γ` and both
//! sides of the equation, each quantity short in those before. A chain of n bodies: O(n), not O(n²) or more.
//!
//! Where a [`Frame`] writes the kinetic energy as squares with constant coefficients, and this makes
//! equations cheaper, `v` are its velocities: `SᵀMS` is then independent of attitude, often constant.
//!
//! Sources: G. Hamel 1904; Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, chapter III.

use std::collections::{BTreeSet, HashMap};

use crate::backwards::{adjoints, multipliers};
use crate::chain::Chain;
use crate::drift::{Carried, Drift};
use crate::expressions::{SHORT, Sparse, products, sparse_rows};
use crate::{DependentVelocity, Frame, QuasiVelocities, Single, cheapest, matrix_moves};
use equations::{
    Block, Definitions, Derivation, DerivationError, Equations, Formulation, Named, Needs, Role, StateVariable,
    Statement,
};
use mechanics::System;
use symbolic::{Expr, Symbol};

/// The same motion in quasi-velocities; for constraints linear in the velocities.
pub const REDUCED_CHETAEV: Formulation = Formulation {
    name: "chetaev-reduced",
    title: "Chetaev, quasi-velocities",
    needs: Needs::Nothing,
    starts_multipliers: false,
    derive: derive_chetaev,
};

/// Derives the Chetaev equations with states `(q, w)` and unknowns `ẇ`. Multipliers are an output.
///
/// # Errors
/// [`DerivationError::Reduction`] where constraints are not linear in the velocities, or are dependent.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = reduction::derive_chetaev(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].right);
/// // the speed along the blade, and the turn; x' and y' follow
/// assert_eq!(line(0), "w_x*cos(phi)");
/// assert_eq!(line(1), "w_x*sin(phi)");
/// let balance = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(balance(2), "phi''");
/// assert_eq!(balance(3), "w_x' - cos(phi)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive_chetaev(system: &System, derivation: &Derivation) -> Result<Equations, DerivationError> {
    let chain = Chain::new(system);
    let own = |chain: &Chain| Ok(chain.own(system, derive_chetaev(&chain.system, derivation)?));
    if let Some(chain) = chain.as_ref().filter(|chain| chain.halves) {
        return own(chain);
    }
    let framed = system.clone();
    let mut candidates = vec![in_velocities(system.clone(), None, derivation)?];
    if let Some(frame) = Frame::new(&framed, derivation.start) {
        let in_frame = in_velocities(framed, Some(frame), derivation)?;
        if matrix_moves(&candidates[0]) && !matrix_moves(&in_frame) {
            return Ok(in_frame);
        }
        candidates.push(in_frame);
    }
    candidates.extend(chain.as_ref().map(own).transpose()?);
    Ok(cheapest(candidates))
}

/// The equations in quasi-velocities of coordinates, or of a frame.
fn in_velocities(system: System, frame: Option<Frame>, derivation: &Derivation) -> Result<Equations, DerivationError> {
    let g = &system.graph;
    let quasi = QuasiVelocities::new(&system, frame.as_ref(), derivation.start)
        .map_err(|error| DerivationError::Reduction { formulation: REDUCED_CHETAEV.name, error })?;
    let mut equations = Equations::new(REDUCED_CHETAEV.name, &system);
    let mut definitions = quasi.coefficients.clone();
    let columns = quasi.columns(g, &mut definitions);
    let value = |d: &DependentVelocity| match columns.single(d.symbol) {
        Some(Single { column, coefficient, .. }) => g.mul(coefficient, g.variable(quasi.free[column].symbol)),
        None => d.value(g),
    };
    quasi.hand_over(g, value, frame.as_ref(), &mut equations, &mut definitions);
    let drift = Drift::new(&system, &quasi, &columns, &mut equations, &mut definitions);
    let momenta = g.gradient(system.lagrangian, &system.velocities());
    let mass = match &frame {
        None => sparse_rows(g, &momenta, &system.velocities()),
        Some(frame) => frame.inertia.iter().enumerate().map(|(k, &e)| Sparse::from([(k, e)])).collect(),
    };
    let carried = Carried::new(&system, &drift, &mass, &mut equations, &mut definitions);
    // the reactions need what is left without the carried velocities' own share, and that share
    let mut gamma = drift.gamma.clone();
    carried.coordinates.iter().for_each(|&i| gamma[i] = g.zero());
    let mut applied = match &frame {
        None => balance(&system, &momenta, &gamma),
        Some(frame) => balance_in_frame(&system, (frame, &quasi.multiples(&system)), &momenta, &gamma),
    };
    let mut force = applied.clone();
    for (i, force) in force.iter_mut().enumerate() {
        let is_carried = carried.coordinates.contains(&i);
        let own = if is_carried { g.mul(mass[i][&i], drift.gamma[i]) } else { g.zero() };
        *force = definitions.short(g, "r", SHORT, g.add(*force, own));
        if !is_carried {
            applied[i] = *force;
        }
    }

    // SᵀMS ẇ + Sᵀ force = 0
    let mut reduced = columns.without(&carried.coordinates).reduced(g, &mass, &mut definitions);
    let mut applied = columns.projected(g, &applied, &mut definitions);
    for (&a, &(m, rate)) in &carried.inertia {
        let w = g.variable(quasi.free[a].symbol);
        reduced[a][a] = g.add(reduced[a][a], m);
        applied[a] = g.add(applied[a], g.product(&[g.ratio(1, 2), rate, w]));
    }
    let rates: Vec<Expr> = quasi.free.iter().map(|w| g.variable(w.rate)).collect();
    let residuals: Vec<Expr> =
        reduced.iter().zip(applied).map(|(row, applied)| g.add(g.dot(row, &rates), applied)).collect();
    for (w, &residual) in quasi.free.iter().zip(&residuals) {
        let meaning = format!("balance for {}", g.name(w.symbol));
        equations.statements.push(Statement { meaning, left: residual, right: g.zero() });
    }
    equations.blocks = vec![Block {
        unknowns: quasi.free.iter().map(|w| w.rate).collect(),
        residuals,
        guess: Vec::new(),
        regular: "mass matrix regular on the admissible velocities",
    }];
    reactions(&system, &quasi, (&mass, &force), &mut equations, &mut definitions);
    equations.chosen.extend(frame.map(|frame| frame.words(g)));
    hand_over(&mut equations, &system, &quasi, &momenta);
    equations.definitions = definitions.into_list();
    equations.graph = system.graph;
    Ok(equations)
}

/// `d/dt L_v − L_q − Q` with `v̇ = γ`, by coordinate.
fn balance(system: &System, momenta: &[Expr], gamma: &[Expr]) -> Vec<Expr> {
    let g = &system.graph;
    let (q, v) = (system.positions(), system.velocities());
    let gradient = g.gradient(system.lagrangian, &q);
    let mut flow: Vec<(Symbol, Expr)> = q.iter().zip(&v).map(|(&q, &v)| (q, g.variable(v))).collect();
    flow.extend(v.iter().copied().zip(gamma.iter().copied()));
    flow.push((system.time, g.one()));
    let inertia = g.total_derivatives(momenta, &flow);
    (0..q.len()).map(|i| g.sub(inertia[i], g.add(gradient[i], system.forces[i]))).collect()
}

/// The balance in a frame: its mass matrix is diagonal and constant, and
///
/// ```text
/// force_k = c_k γ_k + Σ_c c_c u_c dω^c(q̇, e_k) + e_k · (d/dt R_v − R_q − Q) ,      R = L − ½ vᵀMv.
/// ```
fn balance_in_frame(
    system: &System,
    (frame, multiples): (&Frame, &HashMap<Symbol, Expr>),
    momenta: &[Expr],
    gamma: &[Expr],
) -> Vec<Expr> {
    let g = &system.graph;
    let (q, v) = (system.positions(), system.velocities());
    let linear = system.at_rest(momenta);
    let rest = g.add(system.at_rest(&[system.lagrangian])[0], g.dot(&linear, &g.variables(&v)));
    let mut flow: Vec<(Symbol, Expr)> = q.iter().zip(&v).map(|(&q, &v)| (q, g.variable(v))).collect();
    flow.push((system.time, g.one()));
    let (inertia, gradient) = (g.total_derivatives(&linear, &flow), g.gradient(rest, &q));
    let applied: Vec<Expr> = (0..q.len()).map(|i| g.sub(inertia[i], g.add(gradient[i], system.forces[i]))).collect();
    let u = frame.velocities.iter().map(|u| g.variable(u.symbol));
    let own: Vec<Expr> = frame.inertia.iter().zip(u).map(|(&c, u)| g.mul(c, u)).collect();
    let turned = g.substitute_all(&frame.turned(g, &own), multiples);
    let applied = frame.along(g, &applied);
    (0..q.len()).map(|k| g.sum(&[g.mul(frame.inertia[k], gamma[k]), turned[k], applied[k]])).collect()
}

/// Defines `λ` by `Aᵀ λ = M S ẇ + force`.
fn reactions(
    system: &System,
    quasi: &QuasiVelocities,
    (mass, force): (&[Sparse], &[Expr]),
    equations: &mut Equations,
    definitions: &mut Definitions,
) {
    let g = &system.graph;
    let mut rates: HashMap<Symbol, Expr> = HashMap::new();
    let mut moved = Sparse::new();
    for w in &quasi.free {
        rates.insert(w.symbol, g.variable(w.rate));
        moved.extend(w.coordinate.map(|i| (i, g.variable(w.rate))));
    }
    for d in &quasi.dependent {
        let terms: Vec<Expr> = d.terms.iter().map(|(s, coefficient)| g.mul(*coefficient, rates[s])).collect();
        let rate = definitions.short(g, "a", SHORT, g.sum(&terms));
        rates.insert(d.symbol, rate);
        moved.extend(d.coordinate.map(|i| (i, rate)));
    }
    let whole = mass.iter().zip(force).map(|(row, &force)| g.add(g.sum(&products(g, row, &moved)), force));
    let adjoints = adjoints(g, quasi, &whole.collect::<Vec<Expr>>(), definitions);
    let lambda = system.multipliers("lambda", "");
    multipliers(g, quasi, &lambda, &adjoints, definitions);
    equations.multipliers = Named::symbols(g, &lambda);
}

/// States, outputs and invariants.
fn hand_over(equations: &mut Equations, system: &System, quasi: &QuasiVelocities, momenta: &[Expr]) {
    let g = &system.graph;
    for c in &system.coordinates {
        equations.states.push(StateVariable::of(g, c.position, Role::Position, c.velocity, c.position));
    }
    for w in &quasi.free {
        let own = system.coordinates.iter().any(|c| c.velocity == w.symbol);
        let role = if own { Role::Velocity } else { Role::QuasiVelocity };
        equations.states.push(StateVariable { symbol: w.symbol, role, rate: g.variable(w.rate), start: w.start });
    }
    // energy is constant if the motion itself is a virtual displacement; so are momenta without reactions
    if quasi.homogeneous && system.is_autonomous() && !system.has_forces() {
        let power = g.dot(&g.variables(&system.velocities()), momenta);
        equations.invariants.push(Named { name: "energy".into(), expression: g.sub(power, system.lagrangian) });
    }
    let bound: BTreeSet<Symbol> = system.constraints.iter().flat_map(|&f| g.symbols_of(f)).collect();
    for (i, c) in system.coordinates.iter().enumerate() {
        let free = !g.depends_on(system.lagrangian, c.position) && g.is_zero(system.forces[i]);
        if free && !bound.contains(&c.velocity) {
            equations.invariants.push(Named { name: format!("momentum {}", c.name), expression: momenta[i] });
        }
    }
}
