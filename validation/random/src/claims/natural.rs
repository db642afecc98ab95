//! Constants that are natural at a horizon: costates vanish there, in whatever units.

use deltaq::{CERTAINTY, Motion, REMOVED_CONSTRAINT, Setting, Settings, SolveError, TIGHTER, solve};
use mechanics::{ConstantsRule, Removal};
use symbolic::Expr;

use super::CheckError;
use crate::Case;
use crate::derived::{equations, free_constants};

/// Tolerance of the looser run.
const TOLERANCE: f64 = 1e-9;

/// Steps after which a run is given up.
const MAX_STEPS: usize = 3_000;

/// What the search may leave of a costate, over its size: a thousand times the tolerance of the kept run.
const LEFT: f64 = 1e3 * TOLERANCE * TIGHTER;

/// Instants at which a costate's size is looked at.
const INSTANTS: usize = 12;

/// Relative difference of constants that count as the same.
const SAME: f64 = 1e-6;

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
        let settings = Settings { tolerance: TOLERANCE, max_steps: MAX_STEPS, ..Settings::default() };
        solve(setting, equations.clone(), &rule, &settings)
    };
    let found = match case.natural.clone().filter(|_| planted) {
        Some(motion) => Ok(motion),
        None => run(ConstantsRule::Natural { horizon: setting.end }),
    };
    case.found.count(0, FOUND, found.is_ok());
    let Ok(mut motion) = found else { return Ok(None) };
    let (left, limit) = left(&mut motion, &mut run(ConstantsRule::Zero)?)?;
    case.found.bound(0, CLAIM, left, limit);
    Ok(Some(motion))
}

/// The largest `|P_k|` at the end over its size, the largest along either motion; and what it may be.
fn left(motion: &mut Motion, from_zero: &mut Motion) -> Result<(f64, f64), SolveError> {
    let natural: Vec<Expr> = motion.equations.free_constants.iter().filter_map(|constant| constant.natural).collect();
    let multipliers = motion.equations.multipliers.iter().enumerate();
    let places: Vec<usize> = multipliers.filter(|(_, m)| natural.contains(&m.expression)).map(|(k, _)| k).collect();
    let mut sizes = vec![0.0_f64; places.len()];
    for motion in [&mut *motion, from_zero] {
        for t in motion.grid(INSTANTS) {
            let values = motion.at(t)?.multipliers;
            sizes.iter_mut().zip(&places).for_each(|(size, &k)| *size = size.max(values[k].abs()));
        }
    }
    let (kept, looser) = motion.at_in_both_runs(motion.end())?;
    let (mut left, mut limit) = (0.0_f64, CERTAINTY * LEFT);
    for (&k, size) in places.iter().zip(sizes).filter(|(_, size)| *size > 0.0) {
        let (own, other) = (kept.multipliers[k], looser.multipliers[k]);
        left = left.max(own.abs() / size);
        limit = limit.max(CERTAINTY * (LEFT + (own - other).abs() / size));
    }
    Ok((left, limit))
}
