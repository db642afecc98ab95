//! T4 and T10: what a formulation does not depend on.

use std::collections::HashMap;

use comparison::{Sampling, compare_motions};
use equations::Outputs;
use mechanics::{State, System};
use motion::{CERTAINTY, CHETAEV, Motion, REMOVED_CONSTRAINT, SolveError, VAKONOMIC};
use nalgebra::DMatrix;
use symbolic::{Expr, Function, Matrix, Symbol};

use super::CheckError;
use crate::Case;
use crate::case::Which;
use crate::derived::{equations, free_constants};
use crate::realization::numbers;
use crate::transform::{Rewritten, Scaling, recombined};

/// T4: constraints recombined by coefficients that depend on `q`, `μ₀ → G⁻ᵀ μ₀`; other coordinates.
pub(super) fn writing(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    let mixing = mixing(&system);
    if !system.constraints.is_empty() {
        let Some(mu) = with_mixing(case, &system, &mixing)? else { return Ok(()) };
        let other = recombined(&system, &mixing);
        let mut chetaev = case.run(equations(&other, CHETAEV, None)?, &[])?;
        case.same(4, "Chetaev: constraints recombined", Which::Chetaev, &mut chetaev);
        let mut vakonomic = case.run(equations(&other, VAKONOMIC, None)?, &mu)?;
        case.same(4, "vakonomic: constraints recombined", Which::Vakonomic, &mut vakonomic);
    }
    let n = system.dimension();
    let rewritten = Rewritten::new(&system, &shift(&system));
    let mut start = case.scene.start.clone();
    for i in (0..n.saturating_sub(1)).rev() {
        let (y, rate) = (start.q[i + 1], start.v[i + 1]);
        start.q[i] -= y.sin() / 4.0;
        start.v[i] -= rate * y.cos() / 4.0;
    }
    for (name, which, constants) in
        [(CHETAEV, Which::Chetaev, Vec::new()), (VAKONOMIC, Which::Vakonomic, case.scene.multipliers.clone())]
    {
        let equations = rewritten.outputs(equations(&rewritten.system, name, None)?);
        let mut motion = case.solve(&rewritten.system, &start, case.end(), equations, &constants)?;
        let claim = if which == Which::Chetaev { "Chetaev: other coordinates" } else { "vakonomic: other coordinates" };
        case.same(4, claim, which, &mut motion);
    }
    // the removed-constraint motion does depend on the parameters: measured, not required
    for i in 1..case.removed.len() {
        let differs = case.gap(Which::Removed(0), Which::Removed(i))?.certain_from.is_some();
        let what = if case.recipe.kind.is_integrable() {
            "integrable: removed constraint depends on the parameters"
        } else {
            "not integrable: removed constraint depends on the parameters"
        };
        case.found.count(4, what, differs);
    }
    Ok(())
}

/// `q₁ = y₁ + ¼ sin y₂`, …, each shifted by the next, the last by none.
fn shift(system: &System) -> Vec<Expr> {
    let (g, positions) = (&system.graph, system.positions());
    let by = |next: &Symbol| g.mul(g.ratio(1, 4), g.call(Function::Sin, g.variable(*next)));
    (0..positions.len()).map(|i| positions.get(i + 1).map_or(g.zero(), by)).collect()
}

/// Lower triangular with ones, and `1 + ¼ sin q₁` on the diagonal.
pub(super) fn mixing(system: &System) -> Matrix {
    let g = &system.graph;
    let first: Symbol = system.coordinates[0].position;
    let last: Symbol = system.coordinates[system.dimension() - 1].position;
    let varying = |s: Symbol, f: Function| g.add(g.one(), g.mul(g.ratio(1, 4), g.call(f, g.variable(s))));
    let h = system.constraints.len();
    Matrix::from_fn(h, h, |i, j| match i.cmp(&j) {
        std::cmp::Ordering::Less => g.zero(),
        std::cmp::Ordering::Equal => varying(first, Function::Sin),
        std::cmp::Ordering::Greater => g.mul(g.ratio(1, 2), varying(last, Function::Cos)),
    })
}

/// Values of the symbols of a system at the start of the scene.
pub(super) fn values(system: &System, case: &Case) -> HashMap<Symbol, f64> {
    let mut values = system.values_at(&case.scene.start);
    values.extend(system.parameter_values());
    values
}

/// `g⁻ᵀ μ₀` for constraints mixed by `g`.
pub(super) fn with_mixing(case: &Case, system: &System, mixing: &Matrix) -> Result<Option<Vec<f64>>, CheckError> {
    let h = system.constraints.len();
    let factor = DMatrix::from_row_slice(h, h, &numbers(&system.graph, mixing.entries(), &values(system, case))?);
    let mu = nalgebra::DVector::from_vec(case.scene.multipliers.clone());
    Ok(factor.transpose().lu().solve(&mu).map(|mu| mu.as_slice().to_vec()))
}

/// T10.
pub(super) fn reversal_and_units(case: &mut Case) -> Result<(), CheckError> {
    let n = case.scene.system.dimension();
    backwards(case, &Scaling::reversal(n))?;
    let scaling = case.recipe.drawn.scaling(n);
    units(case, &scaling)
}

/// The reversed system, from the end of a motion with its multipliers and costates there, runs back.
fn backwards(case: &mut Case, reversal: &Scaling) -> Result<(), CheckError> {
    let t1 = case.end();
    let other = reversal.system(&case.scene.system);
    let clock = Sampling { rate: -1.0, offset: 0.0, ..Sampling::default() };
    let removed = (0..case.removed.len()).map(Which::Removed);
    let all = [Which::Chetaev, Which::Vakonomic].into_iter().chain(removed);
    for which in all.collect::<Vec<_>>() {
        let (end, less) = case.motion(which).at_in_both_runs(t1)?;
        let mut back = run_back(case, which, reversal, &other, &end)?;
        let mut gap = case.gap_by(which, &mut back, &clock)?;
        if case.is_apart(&gap) {
            // what the end is off by grows on the way back, and adds to what this run is off by
            let mut second = run_back(case, which, reversal, &other, &less)?;
            let between = compare_motions(&mut back, &mut second, &mut case.metric.clone())?;
            gap.points.iter_mut().for_each(|point| point.limit += CERTAINTY * between.largest);
        }
        case.note(10, claim(which), &gap, case.floor);
    }
    Ok(())
}

fn claim(which: Which) -> &'static str {
    match which {
        Which::Chetaev => "Chetaev runs back the way it came",
        Which::Removed(_) => "removed constraint runs back the way it came",
        _ => "vakonomic runs back the way it came",
    }
}

/// The motion of the reversed system `other` from `end`, which one of the case's own motions has come to.
fn run_back(
    case: &mut Case,
    which: Which,
    reversal: &Scaling,
    other: &System,
    end: &Outputs,
) -> Result<Motion, SolveError> {
    let state = State { t: case.end(), q: end.coordinates.clone(), v: end.velocities.clone() };
    let names: Vec<String> = case.motion(which).equations.multipliers.iter().map(|m| m.name.clone()).collect();
    let (equations, constants) = match which {
        Which::Chetaev => (equations(other, CHETAEV, None)?, Vec::new()),
        Which::Removed(i) => {
            let removal = &case.removed[i].removal;
            let graph = &case.scene.system.graph;
            let costate = |w: &mechanics::MemoryVariable| {
                let name = format!("P_{}", graph.name(w.symbol));
                names.iter().position(|n| *n == name).map_or(0.0, |k| end.multipliers[k])
            };
            let costates: Vec<f64> = removal.memory.iter().map(costate).collect();
            let costates = reversal.costates(removal, &costates);
            let equations = equations(other, REMOVED_CONSTRAINT, Some(&reversal.removal(other, removal)))?;
            let constants = free_constants(&equations, &costates);
            (equations, constants)
        }
        _ => (equations(other, VAKONOMIC, None)?, reversal.multipliers(&end.multipliers)),
    };
    // velocities of the reversed system are those of the motion backwards
    let start = reversal.state(&state);
    case.solve(other, &start, -case.scene.start.t, reversal.outputs(equations), &constants)
}

/// The same motion in other units of length (one per coordinate), time, action, and constraint.
fn units(case: &mut Case, scaling: &Scaling) -> Result<(), CheckError> {
    let other = scaling.system(&case.scene.system);
    let start = scaling.state(&case.scene.start);
    let end = case.end() / scaling.time;
    let clock = Sampling { rate: 1.0 / scaling.time, offset: 0.0, ..Sampling::default() };
    let mut runs = vec![
        (Which::Chetaev, "Chetaev in other units", equations(&other, CHETAEV, None)?, Vec::new()),
        (
            Which::Vakonomic,
            "vakonomic in other units",
            equations(&other, VAKONOMIC, None)?,
            scaling.multipliers(&case.scene.multipliers),
        ),
    ];
    for (i, removed) in case.removed.iter().enumerate() {
        let removal = scaling.removal(&other, &removed.removal);
        let equations = equations(&other, REMOVED_CONSTRAINT, Some(&removal))?;
        let constants = free_constants(&equations, &scaling.costates(&removal, &removed.costates));
        runs.push((Which::Removed(i), "removed constraint in other units", equations, constants));
    }
    for (which, claim, equations, constants) in runs {
        let mut motion = case.solve(&other, &start, end, scaling.outputs(equations), &constants)?;
        case.same_by(10, claim, which, &mut motion, &clock);
    }
    Ok(())
}
