//! # The removed-constraint equations of nonholonomic systems (Gao 2017)
//!
//! Source: `Gao2017` of `docs/references.bib`. They are the vakonomic equations of an augmented system.
//!
//! Given are coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)` and constraints `f(q, v, t) = 0 ∈ Rʰ`. New
//! displacement parameters `u ∈ Rᵐ`, `m = n − h`, are introduced such that the constraints hold whatever
//! `u(t)` is. The price is integrals over the past; as *memory variables* `w ∈ Rᵏ` they are
//!
//! ```text
//! ẇ = B(ü, u̇, u, w, t) ,      every qᵢ and q̇ᵢ an expression in (ü, u̇, u, w, t) .
//! ```
//!
//! Knife edge `ẏ cos φ − ẋ sin φ = 0`: with `u̇` the speed along the blade, `ẋ = u̇ cos φ`, `ẏ = u̇ sin φ`;
//! `u` and `φ` are free, `x` and `y` are memory.
//!
//! **The principle.** The system being unconstrained now, the action `∫ L dt` is stationary for all `δu` that
//! vanish at both ends; generalized forces `Q(q, q̇, t)` act by virtual work, `∫ (δL + Q·δq) dt = 0`. What a
//! variation of `u` does to `w` it does through `B`; `w(t₁)` is free. With `qᵢ(u̇, u, w, t)`,
//!
//! ```text
//! Q·δq = Q_u·δu + Q_u̇·δu̇ + Q_w·δw ,     Q_u = (∂q/∂u)ᵀQ ,   Q_u̇ = (∂q/∂u̇)ᵀQ ,   Q_w = (∂q/∂w)ᵀQ .
//! ```
//!
//! **The equations.** Take `ẇ = B` into account with costates `P ∈ Rᵏ`. With
//!
//! ```text
//! G = L(ü, u̇, u, w, t) + P·B(ü, u̇, u, w, t)
//!
//! d²/dt² ∂G/∂ü − d/dt (∂G/∂u̇ + Q_u̇) + ∂G/∂u + Q_u = 0 ,      Ṗ = −∂G/∂w − Q_w ,      ẇ = B .
//! ```
//!
//! (The variation of `∫ [L + P·(B − ẇ)] dt` and the virtual work are `∫ [G_ü·δü + (G_u̇ + Q_u̇)·δu̇ +
//! (G_u + Q_u)·δu + (G_w + Q_w)·δw − P·δẇ] dt`. By parts, `δw` gives `Ṗ` and the boundary term
//! `−P(t₁)·δw(t₁)`, `δu` the first. A force on a position that contains `u̇` does work on `δu̇`: it goes with
//! the momentum.) The paper's (34) and (35) are contained: their integration constants `Cᵢ` are `Pᵢ(t₀)`.
//! A motion has to choose one of three: *given*, *zero at the start* `P(t₀) = 0`, or *natural at a horizon*
//! `P(t₁) = 0`, which is what the principle itself asks for: the motion at `t` then depends on `t₁`. The last
//! two depend on more than the equations of motion without constraint: `L + dF(q, t)/dt` takes `P` to
//! `P − F_w`, so other motions have `P = 0` (`docs/removal.md`).
//!
//! **One instant, L of first order.** State `(u, u̇, w, P)`, linear in the unknown `ü`:
//!
//! ```text
//! G_u̇u̇ ü = G_u + Q_u − G_u̇u u̇ − G_u̇w B − G_u̇P Ṗ − G_u̇t − dQ_u̇/dt .
//! ```
//!
//! **One instant, L contains ü.** For those parameters the state also holds `ü` and the momentum
//! `p = G_u̇ + Q_u̇ − d/dt G_ü`; then `ṗ = G_u + Q_u`, and `d/dt G_ü = G_u̇ + Q_u̇ − p` is linear in
//! the unknown `u⃛`. The Hessian of `G` in the highest rates has to be regular, else
//! [`DerivationError::SingularHighestHessian`]: also where `ü` is in `Q_u`, `Q_u̇`, `Q_w` alone.
//!
//! **What the motion depends on.** On `(q₀, v₀)`, on the constants `P(t₀)` or the horizon, *and on the choice
//! of `u`*: coordinates give the vakonomic family. Quasi-velocities `u̇ = θ(q, v, t)` give the union over
//! `c = G_u̇` of the vakonomic families of `L − c·θ`. Every removal contains the vakonomic family (Theorem 4
//! of `docs/theory.md`, for `Q = 0` and `B` without `ü`).
//!
//! **What stays constant.** `u̇·G_u̇ − G` (with `ü`: `u̇·p + ü·G_ü − G`) when nothing depends on time and no
//! force acts: its rate is `Q·q̇`. `G_u̇ + Q_u̇` (or `p`) of a parameter with `G_u + Q_u = 0`.
//!
//! **Where it breaks.** Where the chart of the removal does. What coordinates, `B` and `G` divide by (for
//! `tan` the cosine) is in the graph, and is collected as guards; a motion stops where one changes its sign.
//! Where all `u` are coordinates, and others would do as well, it goes on in those before ([`Chart`]): the
//! momenta `p_u = G_u̇`, `p_w = −P` belong to the coordinates, whichever of them are called `u`.
//!
//! **What is left out.** A memory variable that neither `L` nor a rate with a costate of its own contains,
//! and on which no force does work, is a quadrature; its costate does not move. Zero at the start or at the
//! free end it is zero throughout, and takes its terms with it; given, it stays
//! ([`Derivation::all_costates`]).
//!
//! Source: P. Y. Gao, *Derivation of Lagrange equations of the first-order nonholonomic system based on the
//! principle of removal of constraint*, 2017.

mod costates;
mod work;

use costates::Costates;
use equations::{
    Block, Chart, Derivation, DerivationError, Equations, Formulation, FreeConstant, Named, Needs, Role, StateVariable,
    Statement,
};
use mechanics::{DisplacementParameter, Removal, Surroundings, System, fresh_symbol, generic_rank};
use symbolic::{Expr, Graph, Range, Symbol};
use work::Work;

/// Entry of the table of formulations.
pub const FORMULATION: Formulation = Formulation {
    name: "removed-constraint",
    title: "removed constraint",
    needs: Needs::Removal,
    starts_multipliers: false,
    derive,
};

/// Derives the removed-constraint equations for [`Derivation::removal`], with free constants `P(t₀)` in the
/// order of the memory variables, then `p(t₀)` of parameters whose second rate `L` contains.
///
/// # Errors
/// [`DerivationError::RemovalMissing`], [`DerivationError::SingularHighestHessian`].
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// # let start = mechanics::State { t: 0.0, q: vec![0., 0., 0.3], v: vec![0.5, 0.5 * 0.3_f64.tan(), 1.] };
/// // the ice sledge, L = (x'^2 + y'^2 + phi'^2)/2 + x, with x' = u_x'*cos(phi), y' = u_x'*sin(phi)
/// let removal = mechanics::Removal::by_quasi_velocities(&system, &start)?;
/// let derivation = equations::Derivation { removal: Some(&removal), ..Default::default() };
/// let equations = removed_constraint::derive(&system, &derivation)?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// assert_eq!(line(0), "u_x'' - phi'*P_x*sin(phi) - cos(phi)");
/// assert_eq!(line(1), "phi'' + u_x'*P_x*sin(phi)");
/// // P_x' = -∂G/∂x; y has no costate
/// let costate = equations.statements.iter().find(|s| s.meaning == "costate").unwrap();
/// assert_eq!(equations.graph.plain(costate.left), "P_x'");
/// assert_eq!(equations.graph.plain(costate.right), "-1");
/// assert_eq!(equations.free_constants.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(system: &System, derivation: &Derivation) -> Result<Equations, DerivationError> {
    let removal = derivation.removal.ok_or(DerivationError::RemovalMissing { formulation: FORMULATION.name })?;
    let system = system.clone();
    let g = &system.graph;
    let mut equations = Equations::new(FORMULATION.name, &system);
    let lagrangian = removal.rewrite(&system, system.lagrangian);
    let work = Work::new(&system, removal);
    let costates = Costates::new(g, removal, lagrangian, &work, derivation.all_costates);
    let generating = costates.generating_function; // G
    let parameters = classify(g, removal, &[&[generating], &work.all()[..]].concat());
    if parameters.iter().any(|p| p.momentum.is_some()) {
        require_regular(&system, removal, (generating, &work), &parameters)?;
    }

    let mut flow = costates.flow(removal);
    for p in &parameters {
        flow.push((p.u.symbol, g.variable(p.u.rate)));
        flow.push((p.u.rate, g.variable(p.u.second_rate)));
        if p.momentum.is_some() {
            flow.push((p.u.second_rate, g.variable(p.unknown)));
        }
    }
    flow.push((system.time, g.one()));

    let state = |symbol, role, rate| StateVariable::of(g, symbol, role, rate, symbol);
    let mut residuals = Vec::new();
    for (i, p) in parameters.iter().enumerate() {
        let u = p.u;
        let gradient = g.add(g.derivative(generating, u.symbol), work.by_parameter[i]);
        let first = g.add(g.derivative(generating, u.rate), work.by_rate[i]);
        let role = if u.coordinate.is_some() { Role::Position } else { Role::DisplacementParameter };
        equations.states.push(state(u.symbol, role, u.rate));
        let (residual, conserved) = match p.momentum {
            // d/dt (∂G/∂u̇ + Q_u̇) − ∂G/∂u − Q_u = 0
            None => (g.sub(g.total_derivative(first, &flow), gradient), first),
            // d/dt ∂G/∂ü − ∂G/∂u̇ − Q_u̇ + p = 0,  ṗ = ∂G/∂u + Q_u
            Some(Momentum { state: momentum, start }) => {
                let second = g.total_derivative(g.derivative(generating, u.second_rate), &flow);
                equations.states.push(state(u.second_rate, Role::ParameterSecondRate, p.unknown));
                let (role, start) = (Role::ParameterMomentum, g.variable(start));
                equations.states.push(StateVariable { symbol: momentum, role, rate: gradient, start });
                (g.sum(&[second, g.neg(first), g.variable(momentum)]), g.variable(momentum))
            }
        };
        equations.states.push(state(u.rate, Role::ParameterRate, u.second_rate));
        let name = g.name(u.symbol);
        equations.statements.push(Statement {
            meaning: format!("balance for {name}"),
            left: residual,
            right: g.zero(),
        });
        equations.multipliers.push(Named { name: format!("p_{name}"), expression: conserved });
        if g.is_zero(gradient) {
            equations.invariants.push(Named { name: format!("momentum {name}"), expression: conserved });
        }
        residuals.push(residual);
    }
    costates.hand_over(g, removal, &mut equations);
    for p in &parameters {
        if let Some(Momentum { start, .. }) = p.momentum {
            equations.free_constants.push(FreeConstant::new(start));
        }
    }
    equations.blocks = vec![Block {
        unknowns: parameters.iter().map(|p| p.unknown).collect(),
        residuals,
        guess: Vec::new(),
        regular: "Hessian of G in the highest rates of the parameters regular",
    }];
    equations.coordinates = removal.coordinates.clone();
    equations.velocities = removal.velocities(&system);
    if system.is_autonomous() && !system.has_forces() {
        equations.invariants.push(Named { name: "energy".into(), expression: energy(g, generating, &parameters) });
    }
    let mut singular = equations.coordinates.clone();
    singular.extend(removal.memory.iter().map(|w| w.rate));
    singular.push(generating);
    equations.guard(g, &singular);
    let known = system.parameter_values().into_iter().map(|(symbol, x)| (symbol, Range::point(x))).collect();
    let coefficients: Vec<Expr> = removal.chart.iter().copied().filter(|&e| !g.range(e, &known).is_bounded()).collect();
    let independent = removal.parameters.iter().map(|u| g.name(u.symbol)).collect();
    equations.chart = (!coefficients.is_empty()).then_some(Chart { independent, coefficients, may_vanish: true });
    equations.removal = Some(removal.clone());
    drop(parameters);
    equations.graph = system.graph;
    Ok(equations)
}

/// A displacement parameter together with how its equation is solved.
struct Parameter<'a> {
    u: &'a DisplacementParameter,
    /// `ü`, or `u̇` where neither `G` nor virtual work contains `ü`: the highest rate.
    highest: Symbol,
    /// What the instant is solved for: the rate of `highest`.
    unknown: Symbol,
    /// Present where `G` or virtual work contains `ü`.
    momentum: Option<Momentum>,
}

/// `p = G_u̇ + Q_u̇ − d/dt G_ü` and its value at the start.
#[derive(Clone, Copy)]
struct Momentum {
    state: Symbol,
    start: Symbol,
}

fn classify<'a>(g: &Graph, removal: &'a Removal, terms: &[Expr]) -> Vec<Parameter<'a>> {
    let classified = removal.parameters.iter().map(|u| {
        if !terms.iter().any(|&e| g.depends_on(e, u.second_rate)) {
            return Parameter { u, highest: u.rate, unknown: u.second_rate, momentum: None };
        }
        let name = g.name(u.symbol);
        let momentum =
            Momentum { state: fresh_symbol(g, &format!("p_{name}")), start: fresh_symbol(g, &format!("p0_{name}")) };
        let unknown = g.symbol(&format!("{}'", g.name(u.second_rate)));
        Parameter { u, highest: u.second_rate, unknown, momentum: Some(momentum) }
    });
    classified.collect()
}

fn require_regular(
    system: &System,
    removal: &Removal,
    (generating, work): (Expr, &Work),
    parameters: &[Parameter],
) -> Result<(), DerivationError> {
    let g = &system.graph;
    let highest: Vec<Symbol> = parameters.iter().map(|p| p.highest).collect();
    let mut momenta = g.gradient(generating, &highest);
    for (i, _) in parameters.iter().enumerate().filter(|(_, p)| p.momentum.is_none()) {
        momenta[i] = g.add(momenta[i], work.by_rate[i]);
    }
    let hessian = g.jacobian(&momenta, &highest);
    // without a value at any point tried, the start will tell
    let rank = generic_rank(g, &hessian, &Surroundings::of_zero(system));
    let Some(rank) = rank.filter(|&rank| rank < highest.len()) else { return Ok(()) };
    let second: Vec<String> =
        parameters.iter().filter(|p| p.momentum.is_some()).map(|p| g.name(p.u.second_rate)).collect();
    Err(DerivationError::SingularHighestHessian {
        formulation: FORMULATION.name,
        removal: removal.name.clone(),
        second_rates: second.join(", "),
        rank,
        size: highest.len(),
    })
}

/// `u̇·G_u̇ − G`; with `ü` in `G`: `u̇·p + ü·G_ü − G`.
fn energy(g: &Graph, generating: Expr, parameters: &[Parameter]) -> Expr {
    let mut terms = vec![g.neg(generating)];
    for p in parameters {
        let rate = g.variable(p.u.rate);
        match p.momentum {
            None => terms.push(g.mul(rate, g.derivative(generating, p.u.rate))),
            Some(Momentum { state, .. }) => {
                terms.push(g.mul(rate, g.variable(state)));
                let second = p.u.second_rate;
                terms.push(g.mul(g.variable(second), g.derivative(generating, second)));
            }
        }
    }
    g.sum(&terms)
}
