//! # The vakonomic equations in quasi-velocities
//!
//! With n − h quasi-velocities `w`, `v = S(q, t) w + s(q, t)`, Hamilton's equations need no multiplier:
//!
//! ```text
//! K(q, p, w, t) = p·v − L(q, v, t) ,   v = S w + s ,        ∂K/∂w = Sᵀ (p − L_v) = 0   determines w;
//!
//! q̇ = v ,        ṗ = −∂K/∂q |_w + Q = L_q + Q − (∂v/∂q)ᵀ (p − L_v) .
//! ```
//!
//! `H(q, p, t)` is the stationary value of `K` over `w`, so that `∂w/∂q` does not enter. These are the
//! equations of the costate form: `Sᵀ (p − L_v) = 0` says that `p − L_v = Aᵀ μ`, and `A (S w + s) + b = 0`,
//! differentiated at fixed `w`, that `A ∂v/∂q = −∂f/∂q`; hence `ṗ = L_q + f_qᵀ μ + Q = ∂(L + μ·f)/∂q + Q`.
//!
//! For `L` quadratic in the velocities, `w` solves n − h linear equations, `SᵀMS w = Sᵀ (p − L_v(q, s, t))`.
//!
//! `S` is not written out in `q`. It is a recursion ([`QuasiVelocities`]); going through it backwards gives
//! `(∂v/∂q)ᵀ (p − L_v)`: with `v̄_k` the derivative of `K` by `v_k` by way of all velocities that contain it,
//!
//! ```text
//! v_k = Σ S_kj v_j + s_k :      v̄_j += S_kj v̄_k ,      −ṗ += v̄_k (Σ ∂S_kj/∂q v_j + ∂s_k/∂q) .
//! ```
//!
//! Where the kinetic energy is a sum of squares with constant coefficients in a [`Frame`], and the equations
//! are cheaper so, the states are `e_k · p`, the momenta along the vectors of that frame:
//!
//! ```text
//! d/dt (e_k · p) = e_k · (R_q + Q − (∂u/∂q)ᵀ (p − L_u)) − Σ_c (e_c · p) dω^c(q̇, e_k) ,      R = L − ½ vᵀMv.
//! ```
//!
//! A chain of n bodies takes O(n). One more recursion gives multipliers: [`crate::EliminatedConstraint`].

use std::collections::HashMap;

use crate::backwards::{adjoints, by_positions, multipliers};
use crate::chain::Chain;
use crate::expressions::{SHORT, Sparse, sparse_rows};
use crate::{Frame, QuasiVelocities, cheapest, matrix_moves};
use equations::{
    Block, Definitions, Derivation, DerivationError, Equations, Formulation, Named, Needs, Role, StateVariable,
    Statement,
};
use mechanics::{System, fresh_symbol};
use symbolic::limits::LONG;
use symbolic::{Expr, Graph, Symbol};
use vakonomic::Augmented;

/// The same motion in quasi-velocities; for constraints linear in the velocities.
pub const REDUCED_VAKONOMIC: Formulation = Formulation {
    name: "vakonomic-reduced",
    title: "vakonomic, quasi-velocities",
    needs: Needs::Nothing,
    starts_multipliers: true,
    derive: derive_vakonomic,
};

/// Nodes of all velocities up to which they are put in: where they are longer, terms no more cancel.
const WHOLE: usize = 16;

/// Derives the vakonomic equations: states `(q, p)`, or `(q, e_k · p)` in a frame, unknowns `w`, free
/// constants `μ₀`; `p₀ = L_v + Aᵀ μ₀`. Multipliers are an output.
///
/// The equations for `w` are linear where `L` is quadratic in `v`; else Newton from the last accepted state.
///
/// # Errors
/// [`DerivationError::Reduction`] for constraints that are not linear in the velocities, or dependent.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // the ice sledge: L = (x'^2 + y'^2 + phi'^2)/2 + x, f = y'*cos(phi) - x'*sin(phi)
/// let equations = reduction::derive_vakonomic(&system, &equations::Derivation::default())?;
/// let line = |i: usize| equations.graph.plain(equations.statements[i].left);
/// // the speed along the blade is the momentum along it
/// assert_eq!(line(3), "w_x - p_x*cos(phi) - p_y*sin(phi)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive_vakonomic(system: &System, derivation: &Derivation) -> Result<Equations, DerivationError> {
    if let Some(chain) = Chain::new(system).filter(|chain| chain.halves) {
        return Ok(chain.own(system, derive_vakonomic(&chain.system, derivation)?));
    }
    let (system, framed) = (system.clone(), system.clone());
    let problem = Problem::new(&system, None, derivation)?;
    let mut candidates = vec![problem.equations(system.clone(), None)];
    if let Some(frame) = Frame::new(&framed, derivation.start) {
        let in_frame = Problem::new(&framed, Some(frame), derivation)?.equations(framed, None);
        if matrix_moves(&candidates[0]) && !matrix_moves(&in_frame) {
            return Ok(in_frame);
        }
        candidates.push(in_frame);
    }
    candidates.extend(problem.put_in(&system).map(|whole| problem.equations(system.clone(), Some(&whole))));
    Ok(cheapest(candidates))
}

/// Quasi-velocities put in: short for small systems, where terms meet that cancel.
struct Whole {
    /// `−∂K/∂w`
    balance: Vec<Expr>,
    /// `−∂K/∂q + Q`
    rates: Vec<Expr>,
}

struct Problem {
    /// In which velocities the quasi-velocities and the costates are; none for those of the coordinates.
    frame: Option<Frame>,
    quasi: QuasiVelocities,
    augmented: Augmented,
    /// Symbols of `p`, or of `e_k · p`.
    costates: Vec<Symbol>,
    /// Symbols of `ṗ`, for the reader.
    costate_rates: Vec<Symbol>,
    p: Vec<Expr>,
}

impl Problem {
    fn new(system: &System, frame: Option<Frame>, derivation: &Derivation) -> Result<Self, DerivationError> {
        let g = &system.graph;
        let quasi = QuasiVelocities::new(system, frame.as_ref(), derivation.start)
            .map_err(|error| DerivationError::Reduction { formulation: REDUCED_VAKONOMIC.name, error })?;
        let augmented = Augmented::new(system);
        let names: Vec<String> = match &frame {
            Some(frame) => frame.velocities.iter().map(|u| g.name(u.symbol).trim_end_matches('\'').into()).collect(),
            None => system.coordinates.iter().map(|c| c.name.clone()).collect(),
        };
        let costates: Vec<Symbol> = names.iter().map(|name| fresh_symbol(g, &format!("p_{name}"))).collect();
        let costate_rates = costates.iter().map(|&p| fresh_symbol(g, &format!("{}'", g.name(p)))).collect();
        Ok(Problem { frame, quasi, augmented, p: g.variables(&costates), costates, costate_rates })
    }

    /// The velocities in which the problem is written, and `∂L/∂u`.
    fn momenta(&self, system: &System) -> (Vec<Symbol>, Vec<Expr>) {
        let g = &system.graph;
        let v = system.velocities();
        let momenta = g.gradient(system.lagrangian, &v);
        let Some(frame) = &self.frame else { return (v, momenta) };
        let linear = frame.along(g, &system.at_rest(&momenta));
        let u: Vec<Symbol> = frame.velocities.iter().map(|u| u.symbol).collect();
        let own = frame.inertia.iter().zip(&u).zip(linear);
        let momenta = own.map(|((&c, &u), linear)| g.add(g.mul(c, g.variable(u)), linear)).collect();
        (u, momenta)
    }

    /// `ṗ`, where `along` is `(∂v/∂q)ᵀ (p − L_v)` at fixed `w`; in a frame `e_k · (R_q + Q − along) − Σ_c p_c
    /// dω^c(q̇, e_k)`, with `R` what `L` is without its squares.
    fn rates(&self, system: &System, momenta: &[Expr], along: &[Expr]) -> Vec<Expr> {
        let g = &system.graph;
        let q = system.positions();
        let applied = |potential: Expr| -> Vec<Expr> {
            g.gradient(potential, &q).into_iter().zip(&system.forces).map(|(e, &force)| g.add(e, force)).collect()
        };
        let Some(frame) = &self.frame else {
            return applied(system.lagrangian)
                .iter()
                .zip(along)
                .map(|(&l_q, &along)| g.expand_if_shorter(g.sub(l_q, along), LONG))
                .collect();
        };
        let u = frame.velocities.iter().map(|u| g.variable(u.symbol));
        let linear = momenta.iter().zip(&frame.inertia).zip(u).map(|((&l_u, &c), u)| g.mul(u, g.sub(l_u, g.mul(c, u))));
        let rest: Vec<Expr> = linear.chain(system.at_rest(&[system.lagrangian])).collect();
        let applied: Vec<Expr> =
            applied(g.sum(&rest)).iter().zip(along).map(|(&r_q, &along)| g.sub(r_q, along)).collect();
        let (applied, turned) = (frame.along(g, &applied), frame.turned(g, &self.p));
        applied.into_iter().zip(turned).map(|(applied, turned)| g.sub(applied, turned)).collect()
    }

    /// The equations by recursion, or by what is given for `∂K/∂w = 0` and `ṗ`.
    fn equations(&self, system: System, whole: Option<&Whole>) -> Equations {
        let Problem { frame, quasi, augmented, costates, costate_rates, p } = self;
        let g = &system.graph;
        let mut equations = Equations::new(REDUCED_VAKONOMIC.name, &system);
        let (q, v) = (system.positions(), system.velocities());
        let (own, momenta) = self.momenta(&system);

        let mut definitions = quasi.coefficients.clone();
        let residuals = match whole {
            Some(whole) => whole.balance.clone(),
            None => stationarity(g, quasi, (&own, p), &momenta, &mut definitions),
        };
        quasi.hand_over(g, |d| d.value(g), frame.as_ref(), &mut equations, &mut definitions);
        for (w, &residual) in quasi.free.iter().zip(&residuals) {
            let meaning = format!("stationary in {}", g.name(w.symbol));
            equations.statements.push(Statement { meaning, left: residual, right: g.zero() });
        }
        let seeds: Vec<Expr> = p.iter().zip(&momenta).map(|(&p, &l_v)| g.sub(p, l_v)).collect();
        let adjoints = adjoints(g, quasi, &seeds, &mut definitions);
        let rates = match whole {
            Some(whole) => whole.rates.clone(),
            None => {
                let along = by_positions(&system, quasi, &adjoints, &mut definitions);
                self.rates(&system, &momenta, &along)
            }
        };

        let p0 = match frame {
            Some(frame) => frame.along(g, &augmented.momenta),
            None => augmented.momenta.clone(),
        };
        let at_start = augmented.multipliers.iter().copied().zip(g.variables(&augmented.starts)).collect();
        for i in 0..q.len() {
            equations.states.push(StateVariable::of(g, q[i], Role::Position, v[i], q[i]));
        }
        for (i, (&symbol, &rate)) in costates.iter().zip(&rates).enumerate() {
            let start = g.substitute(p0[i], &at_start);
            equations.states.push(StateVariable { symbol, role: Role::Costate, rate, start });
            let left = g.variable(costate_rates[i]);
            equations.statements.push(Statement { meaning: "costate".into(), left, right: rate });
        }
        equations.blocks = vec![Block {
            unknowns: quasi.free.iter().map(|w| w.symbol).collect(),
            residuals,
            guess: quasi.free.iter().map(|w| w.start).collect(),
            regular: "∂²L/∂v² regular on the admissible velocities",
        }];
        multipliers(g, quasi, &augmented.multipliers, &adjoints, &mut definitions);
        hand_over(&mut equations, &system, augmented, &self.canonical(g));
        equations.chosen.extend(frame.as_ref().map(|frame| frame.words(g)));
        equations.definitions = definitions.into_list();
        equations.graph = system.graph;
        equations
    }

    /// `p` by coordinate.
    fn canonical(&self, g: &Graph) -> Vec<Expr> {
        let Some(frame) = &self.frame else { return self.p.clone() };
        let mut terms = vec![Vec::new(); self.p.len()];
        for (form, &p) in frame.forms.iter().zip(&self.p) {
            form.iter().for_each(|(&i, &e)| terms[i].push(g.mul(e, p)));
        }
        terms.iter().map(|terms| g.sum(terms)).collect()
    }

    /// The derivatives of `K` with the velocities put in; none where that is long.
    fn put_in(&self, system: &System) -> Option<Whole> {
        let g = &system.graph;
        let mut at: HashMap<Symbol, Expr> = HashMap::new();
        for &(symbol, e) in self.quasi.coefficients.list() {
            at.insert(symbol, g.substitute(e, &at));
        }
        for d in &self.quasi.dependent {
            at.insert(d.symbol, g.substitute(d.value(g), &at));
        }
        let v = g.substitute_all(&g.variables(&system.velocities()), &at);
        if g.size(&v) > WHOLE {
            return None;
        }
        let lagrangian = g.substitute(system.lagrangian, &at);
        let function = g.sub(g.dot(&self.p, &v), g.expand_if_shorter(lagrangian, LONG));
        let w: Vec<Symbol> = self.quasi.free.iter().map(|w| w.symbol).collect();
        let minus = |by: &[Symbol]| {
            g.gradient(function, by).into_iter().map(|e| g.expand_if_shorter(g.neg(e), LONG)).collect::<Vec<Expr>>()
        };
        let forces = g.substitute_all(&system.forces, &at);
        let rates = minus(&system.positions()).into_iter().zip(forces).map(|(e, force)| g.add(e, force)).collect();
        Some(Whole { balance: minus(&w), rates })
    }
}

/// `Sᵀ (L_v − p)` in `(t, q, p, w)`, without what depends on `w` by way of definitions.
fn stationarity(
    g: &Graph,
    quasi: &QuasiVelocities,
    (v, p): (&[Symbol], &[Expr]),
    momenta: &[Expr],
    definitions: &mut Definitions,
) -> Vec<Expr> {
    let mass = sparse_rows(g, momenta, v);
    let quadratic = mass.iter().flat_map(Sparse::values).all(|&e| g.symbols_of(e).iter().all(|s| !v.contains(s)));
    let columns = quasi.columns(g, definitions);
    // v at w = 0 where L is quadratic, else v itself
    let mut at: HashMap<Symbol, Expr> = HashMap::new();
    if quadratic {
        at.extend(quasi.free.iter().map(|w| (w.symbol, g.zero())));
    }
    for d in &quasi.dependent {
        let mut value = g.substitute(d.value(g), &at);
        if quadratic {
            value = definitions.short(g, "s", SHORT, value);
        }
        at.insert(d.symbol, value);
    }
    let momenta = g.substitute_all(momenta, &at);
    let rest: Vec<Expr> = momenta.iter().zip(p).map(|(&l_v, &p)| g.sub(l_v, p)).collect();
    if !quadratic {
        return columns.projected_whole(g, &rest);
    }
    let reduced = columns.reduced(g, &mass, definitions);
    let rest = columns.projected(g, &rest, definitions);
    let w: Vec<Expr> = quasi.free.iter().map(|w| g.variable(w.symbol)).collect();
    reduced.iter().zip(rest).map(|(row, rest)| g.add(g.dot(row, &w), rest)).collect()
}

/// Outputs, free constants and invariants.
fn hand_over(equations: &mut Equations, system: &System, augmented: &Augmented, p: &[Expr]) {
    let g = &system.graph;
    let v = g.variables(&system.velocities());
    equations.multipliers = Named::symbols(g, &augmented.multipliers);
    equations.free_constants = augmented.free_constants();
    let energy = g.sub(g.dot(&v, p), system.lagrangian);
    equations.add_invariants(system, Some(energy), p, &[&augmented.applied]);
}
