//! T8: what friction and added mass tend to.

use std::collections::HashMap;

use deltaq::{Metric, Motion, Setting, Settings, SolveError, solve};
use integrate::Method;
use mechanics::{ConstantsRule, State, System};
use nalgebra::{DMatrix, DVector};
use symbolic::{Expr, Matrix, Symbol};

use super::CheckError;
use super::agreement::numbers;
use crate::random::case::equations;
use crate::random::{Case, Kind};

/// `N`, each ten times the one before.
const STRENGTHS: [f64; 3] = [1e2, 1e3, 1e4];

/// What the distance must shrink by from `N = 10³` to `10⁴`: ten, within this factor.
const RATE: std::ops::RangeInclusive<f64> = 7.0..=14.0;

/// A distance that small at `N = 10³` says nothing about a rate.
const VISIBLE: f64 = 1e-7;

/// Instants at which distances are taken, in the second half of the run.
const INSTANTS: usize = 12;

/// Viscous force `−N Aᵀ f` on the free system, and added mass `L + ½ N f·f` from `p₀ = L_v + Aᵀ μ₀`; constraints linear in the velocities.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let linear = case.scene.system.constraints_linear_in_velocity();
    if case.scene.system.constraints.is_empty() || !linear || case.recipe.kind == Kind::NearRankLoss {
        return Ok(());
    }
    let mut viscous = Vec::new();
    let mut massive = Vec::new();
    for strength in STRENGTHS {
        let system = with_friction(&case.scene.system, strength);
        let mut motion = run(case, &system, &case.scene.start, Method::Bdf)?;
        viscous.push(distance(&mut case.chetaev, &mut motion, &mut case.metric)?);
        let system = with_added_mass(&case.scene.system, strength);
        let start = at_momentum(case, &system)?;
        let mut motion = run(case, &system, &start, Method::Dop853)?;
        massive.push(distance(&mut case.vakonomic, &mut motion, &mut case.metric)?);
    }
    for (claim, what, distances) in [
        ("friction tends to Chetaev at rate 1/N", "friction: distance at N = 1000 over that at 10000", viscous),
        ("added mass tends to vakonomic at rate 1/N", "added mass: distance at N = 1000 over that at 10000", massive),
    ] {
        if distances.iter().any(|d| d.is_nan()) {
            case.found.undecided(8, claim, "a motion stops early");
            continue;
        }
        if distances[1] < VISIBLE {
            continue;
        }
        let rate = distances[1] / distances[2];
        let note = format!("distances {:.1e}, {:.1e}, {:.1e}", distances[0], distances[1], distances[2]);
        case.found.require(8, claim, RATE.contains(&rate), note);
        case.found.observe(8, what, rate);
    }
    Ok(())
}

fn run(case: &Case, system: &System, start: &State, method: Method) -> Result<Motion, SolveError> {
    let settings = Settings { tolerance: 1e-8, method, max_steps: 50_000, ..Settings::default() };
    let equations = equations(system, "chetaev", None)?;
    solve(Setting { system, start, end: case.end() }, equations, &ConstantsRule::Zero, &settings)
}

/// Largest distance in the second half of the run.
fn distance(limit: &mut Motion, motion: &mut Motion, metric: &mut Metric) -> Result<f64, SolveError> {
    let (start, end) = (limit.start(), limit.end());
    if motion.end() < end {
        return Ok(f64::NAN);
    }
    let mut largest = 0.0_f64;
    for k in 0..=INSTANTS {
        let t = 0.5 * (start + end) + 0.5 * (end - start) * k as f64 / INSTANTS as f64;
        let (one, two) = (limit.at(t)?, motion.at(t)?);
        let difference: Vec<f64> = one.coordinates.iter().zip(&two.coordinates).map(|(a, b)| a - b).collect();
        largest = largest.max(metric.length(t, &one.coordinates, &one.velocities, &difference));
    }
    Ok(largest)
}

fn with_friction(system: &System, strength: f64) -> System {
    let mut other = system.clone();
    let g = &other.graph;
    let slip: Vec<Expr> = system.constraints.iter().map(|&f| g.mul(g.number(-strength), f)).collect();
    let forces = g.transpose_vec(&system.constraint_jacobian(), &slip);
    (other.forces, other.constraints) = (forces, Vec::new());
    other
}

fn with_added_mass(system: &System, strength: f64) -> System {
    let mut other = system.clone();
    let g = &other.graph;
    let square = g.dot(&system.constraints, &system.constraints);
    let lagrangian = g.add(system.lagrangian, g.mul(g.number(strength / 2.0), square));
    (other.lagrangian, other.constraints) = (lagrangian, Vec::new());
    other
}

/// The velocities with which the system with added mass has the momenta `L_v + Aᵀ μ₀` of the vakonomic start: linear equations, as the momenta
/// are affine in `v`.
fn at_momentum(case: &Case, other: &System) -> Result<State, SolveError> {
    let (system, state) = (&case.scene.system, &case.scene.start);
    let g = &other.graph;
    let v = other.velocities();
    let momenta = g.gradient(other.lagrangian, &v);
    let hessian: Matrix = g.jacobian(&momenta, &v);
    let values: HashMap<Symbol, f64> = other.values_at(state);
    let n = v.len();
    let mass = DMatrix::from_row_slice(n, n, &numbers(g, hessian.entries(), &values)?);
    let own = DVector::from_vec(numbers(g, &momenta, &values)?);
    let wanted = DVector::from_vec(super::agreement::momenta(system, state)?)
        + super::agreement::constraint_jacobian(system, state)?.transpose()
            * DVector::from_vec(case.scene.multipliers.clone());
    let change = mass.lu().solve(&(wanted - own)).unwrap_or_else(|| DVector::zeros(n));
    let v = state.v.iter().zip(change.iter()).map(|(v, d)| v + d).collect();
    Ok(State { v, ..state.clone() })
}
