//! Fits of the free constants of one run to the motion of another.

use equations::{Equations, Formulation, FreeConstant};
use mechanics::ConstantsRule;
use scene::Scene;

use crate::fit::SEARCH_TOLERANCE;
use crate::gap::{Gap, Verdict, compare_motions};
use crate::gap_search::{Aim, Closest, WORK, closest};
use crate::runs::{Decided, Pair, Run};
use crate::screening::Screening;
use crate::{
    Answer, CHETAEV, Choice, Ensemble, Metric, Motion, REMOVED_CONSTRAINT, Setting, Settings, SolveError, VAKONOMIC,
    constant_names, costates_of, derive_at, multipliers_of, setting, solve,
};

/// Divisor of the work limit of all searches, except that of a vakonomic motion for Chetaev's.
const LESS: usize = 4;

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

/// A motion with fitted constants.
pub struct FittedMotion {
    /// Names and values of the constants.
    pub constants: Vec<(String, f64)>,
    /// The gap that remains.
    pub gap: Gap,
    /// From how many values of the constants its largest value was searched; 0 for an identity.
    pub starts: usize,
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
            let known = by_identity(scene, &runs[run].choice, &runs[target], &fits)?;
            let by_identity = known.is_some();
            let mut known = known.map(|costates| (costates, 0));
            if let (None, Some(&first)) = (&known, vakonomic.first()) {
                known =
                    by_multipliers(scene, runs, [first, run, target], may_vanish((first, target)), metric, settings)?;
            }
            let nearest = answer((run, target)).map(|found| found.decision.set.point.clone());
            let may_vanish = may_vanish((run, target));
            let start = known.map_or(Start::Search { nearest, may_vanish }, Start::Known);
            if let Some(fitted) = fit_run(scene, runs, run, target, start, metric, settings)? {
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
) -> Result<Option<(Vec<f64>, usize)>, SolveError> {
    let (Some(removal), Ok(family)) = (runs[run].choice.removal.clone(), &runs[vakonomic].outcome) else {
        return Ok(None);
    };
    let zero = vec![0.0; family.constants.len()];
    if costates_of(scene, &removal, &zero)?.is_none() {
        return Ok(None);
    }
    let (equations, guesses) = (family.equations.clone(), [zero, family.constants.clone()]);
    let screening = screening(scene, &runs[vakonomic].choice, &equations, settings);
    let aim = Aim { guesses: &guesses, screening, limit: WORK / LESS, may_vanish };
    let Ok(goal) = &mut runs[target].outcome else { return Ok(None) };
    let found = closest(setting(scene), &equations, goal, aim, metric, settings)?;
    let Some(Closest { motion, starts }) = found else { return Ok(None) };
    Ok(costates_of(scene, &removal, &motion.constants)?.map(|costates| (costates, starts)))
}

/// The motions of a choice over its free constants, in lanes; `None` where these are no numbers of a start.
fn screening(scene: &Scene, choice: &Choice, equations: &Equations, settings: &Settings) -> Option<Screening> {
    let names = constant_names(equations);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let choice = Choice { constants: ConstantsRule::Zero, ..choice.clone() };
    let settings = Settings { tolerance: SEARCH_TOLERANCE, ..settings.clone() };
    Ensemble::new(scene, &choice, &names, &settings).ok().map(Screening::new)
}

/// Where the constants of a fit come from.
pub enum Start {
    /// They are these, one per memory variable, found from this number of starts.
    Known((Vec<f64>, usize)),
    /// They are searched, from the least-norm element of the decided set or the nearest miss, from zero
    /// where nothing was decided; or from those of the run, where these are closer.
    Search {
        /// That element, or the nearest miss.
        nearest: Option<Vec<f64>>,
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
    let (mut equations, mut constants) = (motion.equations.clone(), motion.constants.clone());
    let memory = equations.removal.as_ref().map_or(0, |removal| removal.memory.len());
    if memory > constants.len() {
        // costates that are zero by the rule of the run are free here
        let choice = Choice { constants: ConstantsRule::Given(vec![1.0; memory]), ..runs[run].choice.clone() };
        let all = derive_at(&scene.system, &scene.start, &choice)?;
        let own = |c: &FreeConstant| {
            let kept = equations.free_constants.iter().position(|own| own.memory == c.memory);
            kept.map_or(0.0, |i| constants[i])
        };
        constants = all.free_constants.iter().map(own).collect();
        equations = all;
    }
    if constants.is_empty() {
        return Ok(None);
    }
    let is_principal = [run, target].map(|i| runs[i].choice.formulation) == [VAKONOMIC, CHETAEV];
    let choice = runs[run].choice.clone();
    let searched = !matches!(start, Start::Known((_, 0)));
    let Ok(goal) = &mut runs[target].outcome else { return Ok(None) };
    let found = match start {
        Start::Known((values, starts)) => {
            let within = Setting { end: goal.end(), ..setting(scene) };
            let motion = solve(within, equations, &ConstantsRule::Given(values), settings)?;
            Some(Closest { motion, starts })
        }
        Start::Search { nearest, may_vanish } => {
            let nearest = nearest.filter(|nearest| nearest.len() == constants.len());
            let guesses = [nearest.unwrap_or_else(|| vec![0.0; constants.len()]), constants];
            let limit = if is_principal { WORK } else { WORK / LESS };
            let screening = screening(scene, &choice, &equations, settings);
            let aim = Aim { guesses: &guesses, screening, limit, may_vanish };
            closest(setting(scene), &equations, goal, aim, metric, settings)?
        }
    };
    let Some(Closest { mut motion, starts }) = found else { return Ok(Some(None)) };
    let mut gap = compare_motions(goal, &mut motion, metric)?;
    if searched && gap.verdict == Verdict::Different && gap.largest <= unknown(scene, &mut motion, metric, settings)? {
        let because =
            "a search knows the constants to ten digits, and what is left is less than they leave open".into();
        gap.verdict = Verdict::Undecided { because };
    }
    let names = constant_names(&motion.equations);
    let constants = names.into_iter().zip(motion.constants.clone()).collect();
    Ok(Some(Some(FittedMotion { constants, gap, starts })))
}

/// The part of the constants to which a search knows them.
const KNOWN: f64 = 1e-10;

/// The largest gap that the digits of a motion's constants make that a search does not know.
///
/// # Errors
/// [`SolveError`] where a motion cannot be started or read off.
pub fn unknown(
    scene: &Scene,
    motion: &mut Motion,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<f64, SolveError> {
    let constants = motion.constants.clone();
    let size = constants.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
    let mut gap = 0.0;
    for j in 0..constants.len() {
        let mut moved = constants.clone();
        moved[j] += KNOWN * size;
        let within = Setting { end: motion.end(), ..setting(scene) };
        let mut other = solve(within, motion.equations.clone(), &ConstantsRule::Given(moved), settings)?;
        gap += compare_motions(motion, &mut other, metric)?.largest;
    }
    Ok(gap)
}
