//! Realizations: unconstrained systems whose motions tend to constrained ones (T8).
//!
//! ```text
//! friction     L unchanged, force −N Aᵀ f                                   → Chetaev
//! added mass   L + ½ N f·f, started at the momenta p₀ = L_v + Aᵀ μ₀          → vakonomic with μ₀
//! both         L + ½ N f·f and the force −κ N Aᵀ f, started at the same p₀   → d/dt 𝓛_v − 𝓛_q = Q − κ Aᵀ μ
//! ```
//!
//! all at the rate 1/N. With added mass the state is `(q, v, μ)`, `μ = N f`: the equations of the family
//! between with `f = μ/N` instead of `f = 0`, a regular perturbation of the limit that is not stiff in `N`
//! (theorem 9). The removed-constraint motion needs the added mass on `ẇ − B(u̇, …)`, with `u` its
//! own coordinates: it is the vakonomic motion of that system (T2), and friction there leads elsewhere.
//!
//! Sources: C. Carathéodory 1933; A. V. Karapetyan 1981; V. V. Kozlov 1983.

use std::collections::HashMap;

use diffsol_methods::BDF;
use equations::{Derivation, Equations};
use integrate::Method;
use mechanics::{ConstantsRule, Parameter, Removal, State, System, complete_removal_start};
use motion::band::INSTANTS;
use motion::{CHETAEV, Metric, Motion, Setting, Settings, SolveError, solve};
use nalgebra::{DMatrix, DVector};
use symbolic::limits::ITERATIONS;
use symbolic::{CompileError, Expr, Graph, Symbol};

use crate::derived::equations;
use crate::transform::augmented;

/// Tolerances of the looser run: the second where strong added mass leaves more round-off than the first.
const TOLERANCES: [f64; 2] = [1e-9, 1e-7];

/// Limit on the steps of one run.
const MAX_STEPS: usize = 20_000;

/// What is made of a constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Realization {
    /// Force `−N Aᵀ f`.
    Friction,
    /// Lagrangian `L + ½ N f·f`.
    AddedMass,
    /// Lagrangian `L + ½ N f·f` and force `−κ N Aᵀ f`.
    Both {
        /// `κ`, in 1/s.
        kappa: f64,
    },
}

/// The unconstrained motion with strength `N` to `setting.end`; friction alone needs no `multipliers` `μ₀`.
///
/// # Errors
/// [`SolveError`] where it cannot be started.
pub fn realize(kind: Realization, strength: f64, setting: Setting, multipliers: &[f64]) -> Result<Motion, SolveError> {
    match kind {
        Realization::Friction => {
            let system = with_friction(setting.system, strength);
            let equations = equations(&system, CHETAEV, None)?;
            run(Setting { system: &system, ..setting }, BDF, equations, &[])
        }
        Realization::AddedMass | Realization::Both { .. } => {
            let kappa = if let Realization::Both { kappa } = kind { kappa } else { 0.0 };
            run_massive(strength, kappa, setting, multipliers, setting.system.dimension())
        }
    }
}

/// Added mass on the augmented system of a removal, started at the momenta of the removed-constraint motion
/// with costates `P(t₀)`; its first outputs are the coordinates of `setting.system`.
///
/// # Errors
/// [`SolveError`] where it cannot be started.
pub fn realize_removal(
    strength: f64,
    setting: Setting,
    removal: &Removal,
    costates: &[f64],
) -> Result<Motion, SolveError> {
    let (system, start, multipliers) = augmented_start(setting, removal, costates)?;
    let augmented = Setting { system: &system, start: &start, ..setting };
    run_massive(strength, 0.0, augmented, &multipliers, setting.system.dimension())
}

/// Added mass, and friction `kappa` times as large, from the momenta of `multipliers`.
fn run_massive(
    strength: f64,
    kappa: f64,
    setting: Setting,
    multipliers: &[f64],
    coordinates: usize,
) -> Result<Motion, SolveError> {
    let (start, multipliers) = at_momentum(setting, strength, multipliers)?;
    let (free, mut equations) = massive(setting.system, strength, kappa)?;
    equations.coordinates.truncate(coordinates);
    equations.velocities.truncate(coordinates);
    run(Setting { system: &free, start: &start, ..setting }, Method::Dop853, equations, &multipliers)
}

/// The system without constraints, and its equations in `(q, v, μ)` with `L + ½ N f·f` and `−κ N Aᵀ f`:
///
/// ```text
/// d/dt 𝓛_v − 𝓛_q = Q − κ Aᵀ μ ,        d/dt f = μ̇/N
/// ```
///
/// # Errors
/// [`SolveError`] where they cannot be derived.
pub fn massive(system: &System, strength: f64, kappa: f64) -> Result<(System, Equations), SolveError> {
    let mut equations = (motion::KAPPA.derive)(&with_kappa(system, kappa), &Derivation::default())?;
    let (g, n) = (&equations.graph, system.dimension());
    for block in &mut equations.blocks {
        for (residual, &rate) in block.residuals.iter_mut().zip(&block.unknowns).skip(n) {
            *residual = g.sub(*residual, g.div(g.variable(rate), g.number(strength)));
        }
    }
    // what holds on f = 0 only
    (equations.projection, equations.rows) = (None, None);
    equations.invariants.clear();
    Ok((unconstrained(system, 0.0, 0.0), equations))
}

/// The augmented system of a removal with its start and its multipliers `μ_k = −P_k − ∂L/∂ẇ_k`.
///
/// # Errors
/// [`SolveError`] where the removal cannot be started.
pub fn augmented_start(
    setting: Setting,
    removal: &Removal,
    costates: &[f64],
) -> Result<(System, State, Vec<f64>), SolveError> {
    let mut start = setting.start.clone();
    let values = complete_removal_start(setting.system, removal, setting.start)?.values();
    for u in removal.parameters.iter().filter(|u| u.coordinate.is_none()) {
        start.q.push(values.get(&u.symbol).copied().unwrap_or(0.0));
        start.v.push(values.get(&u.rate).copied().unwrap_or(0.0));
    }
    let momenta = momenta(setting.system, setting.start)?;
    let own = |w: &mechanics::MemoryVariable| w.coordinate.map_or(0.0, |c| momenta[c]);
    let multipliers = removal.memory.iter().zip(costates).map(|(w, p)| -p - own(w)).collect();
    Ok((augmented(setting.system, removal), start, multipliers))
}

/// Largest kinetic distance of two motions over the first's second half; NaN if the second stops early.
///
/// # Errors
/// [`SolveError`] where a motion cannot be read off.
pub fn distance(limit: &mut Motion, motion: &mut Motion, metric: &mut Metric) -> Result<f64, SolveError> {
    let (start, end) = (limit.start(), limit.end());
    if motion.end() < end {
        return Ok(f64::NAN);
    }
    let mut largest = 0.0_f64;
    for k in 0..=INSTANTS {
        let t = 0.5 * (start + end) + 0.5 * (end - start) * k as f64 / INSTANTS as f64;
        let (one, two) = (limit.at(t)?, motion.at(t)?);
        largest = largest.max(metric.distance(t, &one.coordinates, &one.velocities, &two.coordinates));
    }
    Ok(largest)
}

fn run(setting: Setting, method: Method, equations: Equations, constants: &[f64]) -> Result<Motion, SolveError> {
    let at = |tolerance: f64| {
        let settings = Settings { tolerance, method: Some(method), max_steps: MAX_STEPS, ..Settings::default() };
        solve(setting, equations.clone(), &ConstantsRule::Given(constants.to_vec()), &settings)
    };
    let sharp = at(TOLERANCES[0])?;
    if sharp.is_complete() { Ok(sharp) } else { at(TOLERANCES[1]) }
}

/// The system without its constraints and with the force `−N Aᵀ f` in their place.
pub fn with_friction(system: &System, strength: f64) -> System {
    unconstrained(system, 0.0, strength)
}

/// The system without its constraints and with the Lagrangian `L + ½ N f·f`.
pub fn with_added_mass(system: &System, strength: f64) -> System {
    unconstrained(system, strength, 0.0)
}

/// The system with `L + ½ mass f·f` and the force `Q − friction Aᵀ f` instead of its constraints.
fn unconstrained(system: &System, mass: f64, friction: f64) -> System {
    let mut other = system.clone();
    let g = &other.graph;
    let square = g.dot(&system.constraints, &system.constraints);
    let lagrangian = g.add(system.lagrangian, g.mul(g.number(mass / 2.0), square));
    let slip: Vec<Expr> = system.constraints.iter().map(|&f| g.mul(g.number(-friction), f)).collect();
    let drag = g.transpose_vec(&g.jacobian(&system.constraints, &system.velocities()), &slip);
    let forces = system.forces.iter().zip(drag).map(|(&q, drag)| g.add(q, drag)).collect();
    (other.lagrangian, other.forces, other.constraints) = (lagrangian, forces, Vec::new());
    other
}

/// The system with the parameter `kappa` of the family between.
pub fn with_kappa(system: &System, value: f64) -> System {
    let mut other = system.clone();
    other.parameters.push(Parameter { symbol: other.graph.symbol("kappa"), value, formula: None });
    other
}

/// Velocities and `μ = N f` that have the start's momenta `L_v + Aᵀ μ₀`, by Newton's method.
///
/// # Errors
/// [`SolveError`] where momenta or the mass matrix have no value.
pub fn at_momentum(setting: Setting, strength: f64, multipliers: &[f64]) -> Result<(State, Vec<f64>), SolveError> {
    let (system, mut state) = (setting.system, setting.start.clone());
    let (g, v, h) = (&system.graph, system.velocities(), multipliers.len());
    let wanted = DVector::from_vec(momenta(system, &state)?)
        + constraint_jacobian(system, &state)?.transpose() * DVector::from_column_slice(multipliers);
    let mut multipliers = multipliers.to_vec();
    let symbols = system.multipliers("mu", "");
    let augmented = g.add(system.lagrangian, g.dot(&g.variables(&symbols), &system.constraints));
    let rows = [&g.gradient(augmented, &v)[..], &system.constraints].concat();
    let slopes = g.jacobian(&rows, &[&v[..], &symbols].concat());
    for _ in 0..ITERATIONS {
        let mut numbers_at = values(system, &state);
        numbers_at.extend(symbols.iter().copied().zip(multipliers.iter().copied()));
        let mut left = DVector::from_vec(numbers(g, &rows, &numbers_at)?);
        let mut matrix = DMatrix::from_row_slice(v.len() + h, v.len() + h, &numbers(g, slopes.entries(), &numbers_at)?);
        for (i, wanted) in wanted.iter().enumerate() {
            left[i] -= wanted;
        }
        for (i, mu) in multipliers.iter().enumerate() {
            left[v.len() + i] -= mu / strength;
            matrix[(v.len() + i, v.len() + i)] -= 1.0 / strength;
        }
        let change = matrix.lu().solve(&left).unwrap_or_else(|| DVector::from_element(v.len() + h, f64::NAN));
        state.v.iter_mut().chain(&mut multipliers).zip(change.iter()).for_each(|(x, d)| *x -= d);
        if change.norm() <= f64::EPSILON * DVector::from_column_slice(&state.v).norm() {
            break;
        }
    }
    Ok((state, multipliers))
}

/// `∂L/∂v` at a state.
///
/// # Errors
/// [`CompileError`] where it has no value.
pub fn momenta(system: &System, state: &State) -> Result<Vec<f64>, CompileError> {
    let momenta = system.graph.gradient(system.lagrangian, &system.velocities());
    numbers(&system.graph, &momenta, &values(system, state))
}

/// `A = ∂f/∂v` at a state.
///
/// # Errors
/// [`CompileError`] where it has no value.
pub fn constraint_jacobian(system: &System, state: &State) -> Result<DMatrix<f64>, CompileError> {
    matrix(system, &system.constraint_jacobian(), state)
}

fn matrix(system: &System, m: &symbolic::Matrix, state: &State) -> Result<DMatrix<f64>, CompileError> {
    let entries = numbers(&system.graph, m.entries(), &values(system, state))?;
    Ok(DMatrix::from_row_slice(m.rows(), m.columns(), &entries))
}

fn values(system: &System, state: &State) -> HashMap<Symbol, f64> {
    let mut values = system.parameter_values();
    values.extend(system.values_at(state));
    values
}

/// Expressions as numbers.
///
/// # Errors
/// [`CompileError`] where one has no value.
pub fn numbers(g: &Graph, es: &[Expr], values: &HashMap<Symbol, f64>) -> Result<Vec<f64>, CompileError> {
    es.iter().map(|&e| g.evaluate(e, values)).collect()
}
