//! Constants that are natural at a horizon: costates vanish there, in whatever units.

use mechanics::{ConstantsRule, Removal};
use motion::band::{INSTANTS, RESIDUAL, SEARCH_STEPS};
use motion::{CERTAINTY, Motion, REMOVED_CONSTRAINT, Setting, Settings, SolveError, TIGHTER, solve};
use nalgebra::{DMatrix, DVector};
use symbolic::Expr;
use symbolic::limits::{OF_TERMS, SAME};

use super::CheckError;
use crate::Case;
use crate::derived::{equations, free_constants};
use crate::realization::numbers;

const CLAIM: &str = "natural costates vanish at the horizon";
const FOUND: &str = "constants natural at the end of the run are found";
const ALIKE: &str = "natural constants in other units are the same";

/// `P(T) = 0` with the removal of the scene, in its units and in others.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let Some(removed) = case.removed.first().filter(|_| case.recipe.drawn.natural) else { return Ok(()) };
    let (system, removal, end) = (case.scene.system.clone(), removed.removal.clone(), case.end());
    let (scaling, start) = (case.recipe.drawn.scaling(system.dimension()), case.scene.start.clone());
    let own = Setting { system: &system, start: &start, end };
    let Some(natural) = judged(case, own, &removal, true)? else { return Ok(()) };
    let (scaled, state) = (scaling.system(&system), scaling.state(&start));
    let in_units = scaling.removal(&scaled, &removal);
    let other = Setting { system: &scaled, start: &state, end: end / scaling.time };
    let Some(again) = judged(case, other, &in_units, false)? else { return Ok(()) };
    // the conditions are not linear in the constants, and other constants may meet them, too
    let mut costates = vec![0.0; removal.memory.len()];
    for (constant, value) in natural.equations.free_constants.iter().zip(&natural.constants) {
        costates[constant.memory.unwrap_or(0)] = *value;
    }
    let expected = free_constants(&again.equations, &scaling.costates(&removal, &costates));
    let near = |(x, y): (&f64, &f64)| (x - y).abs() <= SAME * x.abs().max(y.abs());
    case.found.count(0, ALIKE, expected.iter().zip(&again.constants).all(near));
    Ok(())
}

/// The motion with natural constants, judged, or what the case has `planted`; `None` where none is found.
fn judged(case: &mut Case, setting: Setting, removal: &Removal, planted: bool) -> Result<Option<Motion>, CheckError> {
    let equations = equations(setting.system, REMOVED_CONSTRAINT, Some(removal))?;
    if equations.free_constants.is_empty() {
        return Ok(None);
    }
    let run = |rule: ConstantsRule| {
        let settings = Settings { max_steps: SEARCH_STEPS, ..Settings::default() };
        solve(setting, equations.clone(), &rule, &settings)
    };
    let found = match case.natural.clone().filter(|_| planted) {
        Some(motion) => Ok(motion),
        None => run(ConstantsRule::Natural { horizon: setting.end }),
    };
    case.found.count(0, FOUND, found.is_ok());
    let Ok(mut motion) = found else { return Ok(None) };
    let least: Vec<f64> = momenta(setting)?.into_iter().map(|size| OF_TERMS * size).collect();
    let (left, limit) = left(&mut motion, &mut run(ConstantsRule::Zero)?, removal, &least)?;
    case.found.bound(0, CLAIM, left, limit);
    Ok(Some(motion))
}

/// How large a momentum may be for its kinetic energy at the start: `p_i² ≤ M_ii vᵀM v`.
fn momenta(setting: Setting) -> Result<Vec<f64>, SolveError> {
    let (system, v) = (setting.system, setting.system.velocities());
    let (g, n) = (&system.graph, v.len());
    let mut values = system.parameter_values();
    values.extend(system.values_at(setting.start));
    let mass = g.jacobian(&g.gradient(system.lagrangian, &v), &v);
    let mass = DMatrix::from_row_slice(n, n, &numbers(g, mass.entries(), &values)?);
    let speed = DVector::from_column_slice(&setting.start.v);
    let energy = speed.dot(&(&mass * &speed)).abs();
    Ok((0..n).map(|i| (mass[(i, i)].abs() * energy).sqrt()).collect())
}

/// The largest `|P_k|` at the end over its size, the largest along either motion; and what it may be. Those
/// of coordinates that are not larger than `least` do not count.
fn left(
    motion: &mut Motion,
    from_zero: &mut Motion,
    removal: &Removal,
    least: &[f64],
) -> Result<(f64, f64), SolveError> {
    let constants = motion.equations.free_constants.iter();
    let natural: Vec<(Expr, f64)> = constants
        .filter_map(|constant| {
            let coordinate = constant.memory.and_then(|k| removal.memory[k].coordinate);
            Some((constant.natural?, coordinate.map_or(0.0, |i| least[i])))
        })
        .collect();
    let of = |e: Expr| natural.iter().find(|(costate, _)| *costate == e).map(|(_, least)| *least);
    let multipliers = motion.equations.multipliers.iter().enumerate();
    let (places, least): (Vec<usize>, Vec<f64>) = multipliers.filter_map(|(k, m)| Some((k, of(m.expression)?))).unzip();
    let mut sizes = vec![0.0_f64; places.len()];
    for motion in [&mut *motion, from_zero] {
        for t in motion.grid(INSTANTS) {
            let values = motion.at(t)?.multipliers;
            sizes.iter_mut().zip(&places).for_each(|(size, &k)| *size = size.max(values[k].abs()));
        }
    }
    let (kept, looser) = motion.at_in_both_runs(motion.end())?;
    let (mut left, mut apart) = (0.0_f64, 0.0_f64);
    for ((&k, size), _) in places.iter().zip(sizes).zip(least).filter(|((_, size), least)| size > least) {
        let (own, other) = (kept.multipliers[k], looser.multipliers[k]);
        left = left.max(own.abs() / size);
        apart = apart.max((own - other).abs() / size);
    }
    // what the search may leave of a costate, over its size
    let may_leave = RESIDUAL * TIGHTER * Settings::default().tolerance;
    Ok((left, CERTAINTY * (may_leave + apart)))
}
