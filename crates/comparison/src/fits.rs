//! Fits of the free constants of one run to the motion of another.

use decision::AffineSet;
use equations::{Formulation, FreeConstant};
use mechanics::ConstantsRule;
use scene::Scene;

use crate::fit::CLOSE;
use crate::fit::search::{Aim, Found, search};
use crate::gap::{Gap, Verdict, compare_motions};
use crate::runs::{Decided, FittedMotion, Pair, Run};
use crate::{Answer, costates_of, multipliers_of};
use motion::{
    CERTAINTY, CHETAEV, Choice, Metric, Motion, REMOVED_CONSTRAINT, Setting, Settings, SolveError, VAKONOMIC,
    constant_names, derive_at, setting, solve,
};

/// Which free constants are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fits {
    /// None.
    None,
    /// Those whose membership was asked, and not decided.
    Undecided,
    /// Those of all motions that differ.
    All,
}

/// What free constants can do, as far as was found.
pub struct Fit {
    /// Index of the run whose constants were fitted.
    pub run: usize,
    /// Index of the run that was to be met.
    pub target: usize,
    /// The fitted motion; `None` where no constants lead to a motion over the whole horizon.
    pub fitted: Option<FittedMotion>,
    /// Whether constants follow from the target's without a search ([`costates_of`], [`multipliers_of`]).
    pub by_identity: bool,
}

/// Fits one run's free constants to another wherever the two differ: vakonomic to Chetaev, the first removed
/// run to Chetaev, vakonomic and other removals' runs. Removals by coordinates and vakonomic need no search.
pub(crate) fn fits(
    scene: &Scene,
    runs: &mut [Run],
    pairs: &[Pair],
    decided: &[Decided],
    fits: Fits,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Vec<Fit>, SolveError> {
    let of = |own: &Formulation| -> Vec<usize> {
        let motion = |r: &Run| r.choice.formulation == own && r.outcome.as_ref().is_ok_and(|m| m.end() > m.start());
        (0..runs.len()).filter(|&i| motion(&runs[i])).collect()
    };
    let (chetaev, vakonomic, removed) = (of(CHETAEV), of(VAKONOMIC), of(REMOVED_CONSTRAINT));
    let mut wanted: Vec<(usize, usize)> = Vec::new();
    for &target in &chetaev {
        wanted.extend(vakonomic.iter().chain(removed.first()).map(|&run| (run, target)));
    }
    if let [first, others @ ..] = &removed[..] {
        wanted.extend(vakonomic.iter().chain(others).map(|&target| (*first, target)));
    }
    if fits == Fits::Undecided {
        let open = |d: &Decided| !d.outcome.as_ref().is_ok_and(|found| found.answer() != Answer::Undecided);
        let open: Vec<_> = decided.iter().filter(|d| open(d)).map(|d| (d.family, d.curve)).collect();
        wanted.retain(|asked| open.contains(asked));
    }
    let answer = |asked: (usize, usize)| {
        let decided = decided.iter().find(|d| (d.family, d.curve) == asked)?;
        decided.outcome.as_ref().ok()
    };
    let may_vanish = |asked| {
        !answer(asked).is_some_and(|found| matches!(found.answer(), Answer::NoneProved { .. } | Answer::None { .. }))
    };
    let mut fits = Vec::new();
    for (run, target) in wanted {
        let pair = |p: &&Pair| (p.first, p.second) == (target.min(run), target.max(run));
        if pairs.iter().find(pair).is_some_and(|p| p.gap.certain_from.is_some()) {
            let identity = by_identity(scene, &runs[run].choice, &runs[target], &fits)?;
            let by_identity = identity.is_some();
            let mut start = identity.map(|constants| Start::Known(Found::given(constants)));
            if let (None, Some(&first)) = (&start, vakonomic.first()) {
                let may_vanish = may_vanish((first, target));
                let found = by_multipliers(scene, runs, [first, run, target], may_vanish, metric, settings)?;
                start = found.map(Start::Known);
            }
            let set = answer((run, target)).map(|found| found.decision.set.clone());
            let start = start.unwrap_or_else(|| Start::Search { set, may_vanish: may_vanish((run, target)) });
            if let Some(mut fitted) = fit_run(scene, runs, run, target, start, metric, settings)? {
                // one family: what is nearest was searched before, in other constants
                let same = fits.first().filter(|_| by_identity && runs[target].choice.formulation == CHETAEV);
                if let (Some(fitted), Some(before)) = (&mut fitted, same.and_then(|fit: &Fit| fit.fitted.as_ref())) {
                    fitted.by_half = before.by_half;
                }
                fits.push(Fit { run, target, fitted, by_identity });
            }
        }
    }
    Ok(fits)
}

/// The constants that give a removal by coordinates the motion `target`, vakonomic or of another such
/// removal; or, for Chetaev's `target`, the vakonomic motion fitted to it before.
fn by_identity(scene: &Scene, choice: &Choice, target: &Run, before: &[Fit]) -> Result<Option<Vec<f64>>, SolveError> {
    let (Some(removal), Ok(motion)) = (&choice.removal, &target.outcome) else { return Ok(None) };
    let multipliers = match &target.choice.removal {
        None if target.choice.formulation == VAKONOMIC => Some(motion.constants.clone()),
        None => {
            let fitted = before.first().and_then(|fit| fit.fitted.as_ref());
            fitted.map(|fitted| fitted.constants.iter().map(|(_, mu)| *mu).collect())
        }
        Some(other) => {
            let mut costates = vec![0.0; other.memory.len()];
            for (constant, value) in motion.equations.free_constants.iter().zip(&motion.constants) {
                constant.memory.into_iter().for_each(|i| costates[i] = *value);
            }
            multipliers_of(scene, other, &costates)?
        }
    };
    multipliers.map_or(Ok(None), |multipliers| costates_of(scene, removal, &multipliers))
}

/// The constants of a removal by coordinates for which it comes closest to `target`: those of the vakonomic
/// motion that does, which needs no charts. `None` for other removals, or where that finds none.
fn by_multipliers(
    scene: &Scene,
    runs: &mut [Run],
    [vakonomic, run, target]: [usize; 3],
    may_vanish: bool,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Found>, SolveError> {
    let (Some(removal), Ok(family)) = (runs[run].choice.removal.clone(), &runs[vakonomic].outcome) else {
        return Ok(None);
    };
    let zero = vec![0.0; family.constants.len()];
    if costates_of(scene, &removal, &zero)?.is_none() {
        return Ok(None);
    }
    let (equations, guesses) = (family.equations.clone(), [zero, family.constants.clone()]);
    let aim = Aim { guesses: &guesses, directions: &[], may_vanish };
    let Ok(goal) = &mut runs[target].outcome else { return Ok(None) };
    let Some(found) = search(setting(scene), &equations, goal, &aim, metric, settings)? else { return Ok(None) };
    let costates = |multipliers: &[f64]| costates_of(scene, &removal, multipliers);
    let (Some(constants), Some(by_half)) = (costates(&found.constants)?, costates(&found.by_half)?) else {
        return Ok(None);
    };
    Ok(Some(Found { constants, by_half, ..found }))
}

/// Where the constants of a fit come from.
pub enum Start {
    /// They are these, one per memory variable.
    Known(Found),
    /// They are searched, from the decided set or the nearest miss on; from zero where nothing was decided.
    Search {
        /// That set.
        set: Option<AffineSet>,
        /// Whether the gap may vanish.
        may_vanish: bool,
    },
}

/// Outer `None`: there is nothing to fit. Inner `None`: no constants lead to a motion.
///
/// # Errors
/// [`SolveError`] where a motion cannot be started or read off.
pub fn fit_run(
    scene: &Scene,
    runs: &mut [Run],
    run: usize,
    target: usize,
    start: Start,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Option<FittedMotion>>, SolveError> {
    let Ok(motion) = &runs[run].outcome else { return Ok(None) };
    let (mut equations, mut own) = (motion.equations.clone(), motion.constants.clone());
    let memory = equations.removal.as_ref().map_or(0, |removal| removal.memory.len());
    if memory > own.len() {
        // costates that are zero by the rule of the run are free here
        let choice = Choice { constants: ConstantsRule::Given(vec![1.0; memory]), ..runs[run].choice.clone() };
        let all = derive_at(&scene.system, &scene.start, &choice)?;
        let start = |c: &FreeConstant| {
            let kept = equations.free_constants.iter().position(|known| known.memory == c.memory);
            kept.map_or(0.0, |i| own[i])
        };
        own = all.free_constants.iter().map(start).collect();
        equations = all;
    }
    if own.is_empty() {
        return Ok(None);
    }
    let Ok(goal) = &mut runs[target].outcome else { return Ok(None) };
    let found = match start {
        Start::Known(found) => Some(found),
        Start::Search { set, may_vanish } => {
            let set = set.filter(|set| set.point.len() == own.len());
            let (point, directions) = set.map_or((vec![0.0; own.len()], vec![]), |s| (s.point, s.directions));
            let aim = Aim { guesses: &[point, own.clone()], directions: &directions, may_vanish };
            search(setting(scene), &equations, goal, &aim, metric, settings)?
        }
    };
    let Some(Found { constants, by_half, starts, mut open, part }) = found else { return Ok(Some(None)) };
    let end = goal.end();
    let within = Setting { end, ..setting(scene) };
    let mut gap_of = |constants: &[f64]| -> Result<(Motion, Gap), SolveError> {
        let mut motion = solve(within, equations.clone(), &ConstantsRule::Given(constants.to_vec()), settings)?;
        let gap = compare_motions(goal, &mut motion, metric)?;
        Ok((motion, gap))
    };
    let (mut motion, mut gap) = gap_of(&constants)?;
    // a gap up to where a motion breaks off is not that of the whole; that of the run's own constants may be,
    // and these are exact
    let searched = starts > 0 && gap.end == end;
    if starts > 0 && !searched {
        (motion, gap) = gap_of(&own)?;
    }
    if gap.end != end {
        return Ok(Some(None));
    }
    let largest = |gap: &Gap| if gap.end == end { gap.largest } else { f64::INFINITY };
    let by_half = if by_half == constants { gap.largest } else { largest(&gap_of(&by_half)?.1) };
    if searched && gap.largest < CLOSE * gap.scale {
        // no better than motions are
        let known = KNOWN.max(CERTAINTY * gap.estimates.iter().sum::<f64>() / gap.scale);
        let size = constants.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
        open = vec![known * size; constants.len()];
    }
    if gap.verdict == Verdict::Different {
        let told = if part < 1.0 { CERTAINTY * part * gap.scale } else { 0.0 };
        if gap.largest <= told + unknown(scene, &mut motion, &open, metric, settings)? {
            let because = "what is left is less than the decision and the digits of the constants leave open".into();
            gap.verdict = Verdict::Undecided { because };
        }
    }
    let names = constant_names(&motion.equations);
    let constants = names.into_iter().zip(motion.constants.clone()).collect();
    Ok(Some(Some(FittedMotion { constants, gap, starts, by_half })))
}

/// The part of the constants to which a search knows them at best.
const KNOWN: f64 = 1e-10;

/// The largest gap that changes of a motion's constants make by which they are `open`.
///
/// # Errors
/// [`SolveError`] where a motion cannot be started or read off.
pub fn unknown(
    scene: &Scene,
    motion: &mut Motion,
    open: &[f64],
    metric: &mut Metric,
    settings: &Settings,
) -> Result<f64, SolveError> {
    let mut gap = 0.0;
    for (j, by) in open.iter().enumerate().filter(|(_, by)| **by > 0.0) {
        let mut moved = motion.constants.clone();
        moved[j] += by;
        let within = Setting { end: motion.end(), ..setting(scene) };
        let mut other = solve(within, motion.equations.clone(), &ConstantsRule::Given(moved), settings)?;
        gap += compare_motions(motion, &mut other, metric)?.largest;
    }
    Ok(gap)
}
