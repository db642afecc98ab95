//! # The vakonomic equations of nonholonomic systems (variational nonholonomic, or constrained variational)
//!
//! They belong to constrained variational problems, such as optimal control and sub-Riemannian geodesics:
//! `ArnoldKozlovNeishtadt2006`, `Lewis2020` (keys of `docs/references.bib`).
//!
//! Given are coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)` with `v = q̇` and constraints
//! `f(q, v, t) = 0 ∈ Rʰ`. Write `A = ∂f/∂v` (h×n).
//!
//! **The principle.** The motion makes the action stationary for variations that keep the constraint to first
//! order; generalized forces `Q(q, v, t)`, where there are any, act by virtual work:
//!
//! ```text
//! ∫ (δL + Q·δq) dt = 0     for all δq with   f_v δq̇ + f_q δq = 0 ,   δq = 0 at both ends.
//! ```
//!
//! Such a motion is stationary among the curves with these ends that satisfy the constraint exactly. The
//! converse is false in general: it holds for curves without an abnormal lift (Proposition 12 of
//! `docs/theory.md`, where a strict minimum has no multiplier).
//!
//! **The equations.** Multipliers `μ(t) ∈ Rʰ` take the constraint into the Lagrangian, `𝓛 = L + μ·f`. On
//! admissible `δq` the term `μ·δf` adds nothing, so `∫ (δ𝓛 + Q·δq) dt = 0`; by parts, with `μ` such that the
//! balance holds for `h` of the `δqᵢ`, the other `n − h` being free,
//!
//! ```text
//! d/dt ∂𝓛/∂v − ∂𝓛/∂q = Q ,        f(q, v, t) = 0 .
//! ```
//!
//! `Q` is work on `δq` and not on `δf`: it stands beside `∂𝓛/∂q`, and `μ` is not in it.
//!
//! Written out, `d/dt L_v − L_q = Q + C μ − Aᵀ μ̇`, `C = f_qᵀ − Ȧᵀ`: instead of Chetaev's `Aᵀ λ`, the
//! Euler–Lagrange derivative `C μ` of `μ·f` with `μ` held fixed, and `−μ̇` corresponds to `λ`. `C` vanishes
//! if `f` is a total time derivative; its part on `ker A` is the curvature of the constraint, and vanishes
//! for all integrable ones, for which the two formulations agree. `μᵢ` has the unit of action over that of
//! `∫ fᵢ dt`.
//!
//! **One instant, multiplier form** ([`derive()`]). In the state `(q, v, μ)`, linear in `(a, μ̇)`:
//!
//! ```text
//! [ 𝓛_vv  Aᵀ ] [ a  ]   [ 𝓛_q + Q − 𝓛_vq v − 𝓛_vt ]
//! [ A      0 ] [ μ̇ ] = [ −(f_q v + f_t)           ]
//! ```
//!
//! **One instant, costate form** ([`derive_costate_form`]). With costates `p = ∂𝓛/∂v`, the state `(q, p)`,
//!
//! ```text
//! p − L_v − Aᵀ μ = 0 ,   f = 0    determine (v, μ);        q̇ = v ,   ṗ = ∂𝓛/∂q + Q .
//! ```
//!
//! Without `Q` these are Hamilton's equations of `H(q, p, t)` = stationary value of `p·v − L` over `v` with
//! `f = 0`. The constraint holds at every instant, not only by its derivative. For `L` a kinetic energy that
//! is definite on `ker A`, and `f` linear and autonomous, the motions are the normal sub-Riemannian
//! geodesics. The two forms are derived differently and have to agree.
//!
//! **What the motion depends on.** `(q₀, v₀)` *and* `μ₀ ∈ Rʰ`: one start, an `h`-parameter family of motions.
//!
//! **What stays constant.** The energy `v·𝓛_v − 𝓛` when nothing depends on time and no force acts, its rate
//! being `Q·v − ∂𝓛/∂t`; the momentum `∂𝓛/∂vᵢ` of every coordinate that neither `L` nor `f` contains and on
//! which no force acts.
//!
//! Sources: V. V. Kozlov 1983; V. I. Arnold, V. V. Kozlov, A. I. Neishtadt, *Mathematical Aspects of
//! Classical and Celestial Mechanics*, chapter 1.

use equations::{
    Block, Derivation, DerivationError, Equations, Formulation, FreeConstant, Named, Needs, Role, StateVariable,
};
use mechanics::{System, fresh_symbol};
use symbolic::{Expr, Symbol};

/// Entry of the table of formulations: the multiplier form.
pub const FORMULATION: Formulation =
    Formulation { name: "vakonomic", title: "vakonomic", needs: Needs::Nothing, starts_multipliers: true, derive };

/// The same motion in costate (Hamiltonian) form.
pub const COSTATE_FORM: Formulation = Formulation {
    name: "vakonomic-costate",
    title: "vakonomic, costate form",
    needs: Needs::Nothing,
    starts_multipliers: true,
    derive: derive_costate_form,
};

/// What all forms of the vakonomic equations start from: `𝓛 = L + μ·f`, its derivatives, and `Q`.
pub struct Augmented {
    /// Symbols of `μ` at an instant, one per constraint.
    pub multipliers: Vec<Symbol>,
    /// Symbols of `μ₀` at the start.
    pub starts: Vec<Symbol>,
    /// `𝓛`.
    pub lagrangian: Expr,
    /// `∂𝓛/∂v = L_v + Aᵀ μ`, length n.
    pub momenta: Vec<Expr>,
    /// `∂𝓛/∂q + Q`, length n: what changes the momenta.
    pub applied: Vec<Expr>,
}

impl Augmented {
    /// With multipliers of its own, in the graph of the system.
    pub fn new(system: &System) -> Self {
        let graph = &system.graph;
        let [multipliers, starts] = ["mu", "mu0"].map(|stem| system.multipliers(stem, ""));
        let coupling = graph.dot(&graph.variables(&multipliers), &system.constraints);
        let lagrangian = graph.add(system.lagrangian, coupling);
        let momenta = graph.gradient(lagrangian, &system.velocities());
        let gradient = graph.gradient(lagrangian, &system.positions());
        let applied = gradient.into_iter().zip(&system.forces).map(|(l_q, &force)| graph.add(l_q, force)).collect();
        Augmented { multipliers, starts, lagrangian, momenta, applied }
    }

    /// `μ₀`, which `(q₀, v₀)` does not determine.
    pub fn free_constants(&self) -> Vec<FreeConstant> {
        self.starts.iter().copied().map(FreeConstant::new).collect()
    }
}

/// Derives the multiplier form: states `(q, v, μ)`, unknowns `(a, μ̇)`, free constants `μ₀`.
///
/// # Errors
/// None: every system has these equations.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = vakonomic::derive(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(line(0), "x'' - phi'*mu_1*cos(phi) - mu_1'*sin(phi) - 1");
/// assert_eq!(line(2), "phi'' + mu_1*(x'*cos(phi) + y'*sin(phi))");
/// assert_eq!(equations.free_constants.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(system: &System, _: &Derivation) -> Result<Equations, DerivationError> {
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(FORMULATION.name, &system);
    let augmented = Augmented::new(&system);
    let a = system.accelerations();
    let rates: Vec<Symbol> =
        augmented.multipliers.iter().map(|&mu| fresh_symbol(g, &format!("{}'", g.name(mu)))).collect();
    let mut flow = system.flow();
    flow.extend(augmented.multipliers.iter().zip(&rates).map(|(&mu, &rate)| (mu, g.variable(rate))));

    // d/dt ∂𝓛/∂v − ∂𝓛/∂q − Q = 0
    let mut residuals = system.balances(&augmented.momenta, &[&augmented.applied], &flow);
    equations.state_balances(&system, &residuals);
    // d/dt f = 0
    residuals.extend(system.constraints.iter().map(|&f| g.total_derivative(f, &flow)));

    equations.add_positions_and_velocities(&system);
    for (i, &mu) in augmented.multipliers.iter().enumerate() {
        equations.states.push(StateVariable::of(g, mu, Role::Multiplier, rates[i], augmented.starts[i]));
    }
    equations.blocks = vec![Block {
        unknowns: a.iter().chain(&rates).copied().collect(),
        residuals,
        guess: Vec::new(),
        regular: "constraint Jacobian of full row rank, ∂²𝓛/∂v² regular on its kernel",
    }];
    equations.return_onto_constraints(&system);
    // where f = h/D, the multiplier goes through zero with D, and its rate is 0/0
    equations.guard(g, &system.constraints);
    finish(&mut equations, system, augmented);
    Ok(equations)
}

/// Derives the costate form: states `(q, p)`, unknowns `(v, μ)`, free constants `μ₀`; `p₀ = L_v + Aᵀ μ₀`.
///
/// The equations for `(v, μ)` are linear where `L` is quadratic and `f` linear in `v`; otherwise they are
/// solved by Newton's method from the last accepted state.
///
/// # Errors
/// None: every system has these equations.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = vakonomic::derive_costate_form(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(line(0), "mu_1*sin(phi) - x' + p_x");
/// // p_phi' = ∂𝓛/∂phi + Q_phi, here without a force
/// let p_phi = equations.states.iter().find(|y| equations.graph.name(y.symbol) == "p_phi").unwrap();
/// assert_eq!(equations.graph.plain(p_phi.rate), "-mu_1*(x'*cos(phi) + y'*sin(phi))");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive_costate_form(system: &System, _: &Derivation) -> Result<Equations, DerivationError> {
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(COSTATE_FORM.name, &system);
    let augmented = Augmented::new(&system);
    let (q, v) = (system.positions(), system.velocities());
    let at_start = augmented.multipliers.iter().copied().zip(g.variables(&augmented.starts)).collect();
    let costates: Vec<Symbol> = system.coordinates.iter().map(|c| fresh_symbol(g, &format!("p_{}", c.name))).collect();

    // p − ∂𝓛/∂v = 0,  f = 0
    let mut residuals: Vec<Expr> = (0..q.len()).map(|i| g.sub(g.variable(costates[i]), augmented.momenta[i])).collect();
    residuals.extend(&system.constraints);
    equations.state_balances(&system, &residuals[..q.len()]);

    for i in 0..q.len() {
        equations.states.push(StateVariable::of(g, q[i], Role::Position, v[i], q[i]));
    }
    for (i, &symbol) in costates.iter().enumerate() {
        let start = g.substitute(augmented.momenta[i], &at_start);
        equations.states.push(StateVariable { symbol, role: Role::Costate, rate: augmented.applied[i], start });
    }
    equations.blocks = vec![Block {
        unknowns: v.iter().chain(&augmented.multipliers).copied().collect(),
        residuals,
        guess: g.variables(&v).into_iter().chain(g.variables(&augmented.starts)).collect(),
        regular: "constraint Jacobian of full row rank, ∂²𝓛/∂v² regular on its kernel",
    }];
    finish(&mut equations, system, augmented);
    Ok(equations)
}

/// [`derive_costate_form`] from momenta: the free constants are `p₀ ∈ Rⁿ`, with `p₀ − L_v` in the image of
/// `Aᵀ`, and the momenta stand for the multipliers, under the names that they have where they are constant.
///
/// # Errors
/// As [`derive_costate_form`].
pub fn derive_from_momenta(system: &System) -> Result<Equations, DerivationError> {
    let mut equations = derive_costate_form(system, &Derivation::default())?;
    let g = &equations.graph;
    let zero = equations.free_constants.iter().map(|c| (c.symbol, g.zero())).collect();
    equations.blocks.iter_mut().flat_map(|b| &mut b.guess).for_each(|guess| *guess = g.substitute(*guess, &zero));
    equations.free_constants.clear();
    equations.multipliers.clear();
    let costates = equations.states.iter_mut().filter(|y| y.role == Role::Costate);
    for (y, c) in costates.zip(&system.coordinates) {
        let symbol = fresh_symbol(g, &format!("p0_{}", c.name));
        y.start = g.variable(symbol);
        equations.free_constants.push(FreeConstant::new(symbol));
        let (name, expression) = (format!("momentum {}", c.name), g.variable(y.symbol));
        equations.multipliers.push(Named { name, expression });
    }
    Ok(equations)
}

/// What both forms share: outputs, free constants and the quantities that stay constant.
fn finish(equations: &mut Equations, system: System, augmented: Augmented) {
    let g = &system.graph;
    equations.multipliers = Named::symbols(g, &augmented.multipliers);
    equations.free_constants = augmented.free_constants();
    let action = g.dot(&g.variables(&system.velocities()), &augmented.momenta);
    let energy = g.sub(action, augmented.lagrangian);
    equations.add_invariants(&system, Some(energy), &augmented.momenta, &[&augmented.applied]);
    equations.graph = system.graph;
}
