//! T15 to T17: what the formulations see of `L` and of the way in which `f` is written.

use comparison::Sampling;
use equations::Equations;
use mechanics::{Removal, System};
use motion::{CHETAEV, KAPPA, Motion, REMOVED_CONSTRAINT, SolveError, VAKONOMIC};
use symbolic::{Expr, Function, Symbol};

use super::CheckError;
use super::invariance::{mixing, values, with_mixing};
use crate::Case;
use crate::case::Which;
use crate::derived::{equations, free_constants};
use crate::realization::{numbers, with_kappa};
use crate::transform::recombined;

/// `κ` of the family between the formulations.
const MIDDLE: f64 = 2.0;

/// What is counted of other motions: the negative controls.
const OTHERS: [(u8, &str); 4] = [
    (15, "not integrable: Chetaev's motion for L + phi f is another"),
    (15, "not integrable: the vakonomic motion for L + phi f with the same mu0 is another"),
    (16, "not integrable: removed constraint for L + dF/dt with the same P0 is another"),
    (17, "not integrable: kappa with recombined constraints and the same mu0 is another"),
];

/// T15: `L' = L + φ(q)·f` has the vakonomic motion of `L` with `μ₀' = μ₀ − φ(q₀)`, and its removed-constraint
/// motions, but another Chetaev motion.
pub(super) fn values_on_the_constraint(case: &mut Case) -> Result<(), CheckError> {
    let mut other = case.scene.system.clone();
    if other.constraints.is_empty() {
        return Ok(());
    }
    let g = &other.graph;
    let last = g.variable(other.coordinates[other.dimension() - 1].position);
    // one half, and a part that changes on the way
    let phi = |i: usize| g.add(g.ratio(1, 2), g.call(Function::Sin, g.add(last, g.ratio(i as i64, 1))));
    let phi: Vec<Expr> = (0..other.constraints.len()).map(phi).collect();
    let lagrangian = g.add(other.lagrangian, g.dot(&phi, &other.constraints));
    let at_start = numbers(g, &phi, &values(&other, case))?;
    other.lagrangian = lagrangian;
    let given = case.scene.multipliers.clone();
    let shifted: Vec<f64> = given.iter().zip(&at_start).map(|(mu, phi)| mu - phi).collect();
    let mut motion = run(case, &other, equations(&other, VAKONOMIC, None)?, &shifted)?;
    case.same(15, "vakonomic: L + phi f with mu0 - phi", Which::Vakonomic, &mut motion);
    if let Some(i) = case.removed.iter().position(|removed| removed.removal.name == "coordinates") {
        let (removal, costates) = (case.removed[i].removal.clone(), case.removed[i].costates.clone());
        let equations = equations(&other, REMOVED_CONSTRAINT, Some(&removal))?;
        let constants = free_constants(&equations, &costates);
        let mut motion = run(case, &other, equations, &constants)?;
        case.same(15, "removed constraint: L + phi f with the same P0", Which::Removed(i), &mut motion);
    }
    let chetaev = run(case, &other, equations(&other, CHETAEV, None)?, &[])?;
    other_motion(case, 0, Which::Chetaev, chetaev)?;
    let vakonomic = run(case, &other, equations(&other, VAKONOMIC, None)?, &given)?;
    other_motion(case, 1, Which::Vakonomic, vakonomic)
}

/// T16: `L' = L + dF(q)/dt` has every motion of `L`, with `P₀' = P₀ − F_w(q₀)`.
pub(super) fn gauge(case: &mut Case) -> Result<(), CheckError> {
    let mut other = case.scene.system.clone();
    let (g, positions, velocities) = (&other.graph, other.positions(), other.velocities());
    // not the rate of any single coordinate
    let term = |(i, q): (usize, &Symbol)| g.call(Function::Sin, g.add(g.variable(*q), g.ratio(i as i64, 1)));
    let terms: Vec<Expr> = positions.iter().enumerate().map(term).collect();
    let potential =
        g.add(terms.iter().fold(g.zero(), |sum, &t| g.add(sum, t)), g.mul(terms[0], terms[terms.len() - 1]));
    let gradient: Vec<Expr> = positions.iter().map(|&q| g.derivative(potential, q)).collect();
    let rates: Vec<Expr> = velocities.iter().map(|&v| g.variable(v)).collect();
    let lagrangian = g.add(other.lagrangian, g.dot(&gradient, &rates));
    let at_start = numbers(g, &gradient, &values(&other, case))?;
    other.lagrangian = lagrangian;
    let mut motion = run(case, &other, equations(&other, CHETAEV, None)?, &[])?;
    case.same(16, "Chetaev: L + dF/dt", Which::Chetaev, &mut motion);
    let mut motion = run(case, &other, equations(&other, VAKONOMIC, None)?, &case.scene.multipliers)?;
    case.same(16, "vakonomic: L + dF/dt with the same mu0", Which::Vakonomic, &mut motion);
    for i in 0..case.removed.len() {
        let (removal, costates) = (case.removed[i].removal.clone(), case.removed[i].costates.clone());
        let equations = equations(&other, REMOVED_CONSTRAINT, Some(&removal))?;
        let all = (0..removal.memory.len()).all(|k| equations.free_constants.iter().any(|c| c.memory == Some(k)));
        let Some(places) = places(&other, &removal).filter(|_| all) else { continue };
        let shifted: Vec<f64> = costates.iter().zip(&places).map(|(p, &place)| p - at_start[place]).collect();
        let mut motion = run(case, &other, equations.clone(), &free_constants(&equations, &shifted))?;
        case.same(16, "removed constraint: L + dF/dt with P0 - F_w", Which::Removed(i), &mut motion);
        let unshifted = run(case, &other, equations.clone(), &free_constants(&equations, &costates))?;
        other_motion(case, 2, Which::Removed(i), unshifted)?;
    }
    Ok(())
}

/// The coordinate that each memory variable is, where parameters and memory variables are coordinates.
fn places(system: &System, removal: &Removal) -> Option<Vec<usize>> {
    let plain = removal.coordinates.iter().all(|&q| system.graph.as_symbol(q).is_some());
    removal.memory.iter().map(|w| w.coordinate.filter(|_| plain)).collect()
}

/// T17: `f' = g(q) f` has the motion of the family between with `μ₀' = g⁻ᵀ μ₀`.
pub(super) fn writing_of_the_family(case: &mut Case) -> Result<(), CheckError> {
    let system = with_kappa(&case.scene.system, MIDDLE);
    if system.constraints.is_empty() {
        return Ok(());
    }
    let mixing = mixing(&system);
    let Some(transformed) = with_mixing(case, &system, &mixing)? else { return Ok(()) };
    let given = case.scene.multipliers.clone();
    let mut plain = match case.between.clone() {
        Some(motion) => motion,
        None => case.run(equations(&system, KAPPA, None)?, &given)?,
    };
    let other = recombined(&system, &mixing);
    let mut motion = run(case, &other, equations(&other, KAPPA, None)?, &transformed)?;
    case.pair(17, "kappa: constraints recombined, mu0 transformed", &mut plain, &mut motion);
    let mut same = run(case, &other, equations(&other, KAPPA, None)?, &given)?;
    let gap = case.gap_of(&mut plain, &mut same)?;
    count(case, 3, gap.certain_from.is_some());
    Ok(())
}

/// Counts a control, and whether the motion is another; of integrable systems it is none.
fn other_motion(case: &mut Case, control: usize, which: Which, mut motion: Motion) -> Result<(), CheckError> {
    let gap = case.gap_by(which, &mut motion, &Sampling::default())?;
    count(case, control, gap.certain_from.is_some());
    Ok(())
}

fn count(case: &mut Case, control: usize, differs: bool) {
    if !case.recipe.kind.is_integrable() {
        let (theorem, what) = OTHERS[control];
        case.found.count(theorem, what, differs);
    }
}

/// The motion of another system from the same start.
fn run(case: &Case, system: &System, equations: Equations, constants: &[f64]) -> Result<Motion, SolveError> {
    case.solve(system, &case.scene.start, case.end(), equations, constants)
}
