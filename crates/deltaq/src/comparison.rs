//! One scene in every formulation, pair by pair.

use mechanics::Integrability;
use scene::Scene;

use crate::fit::best_fit;
use crate::gap::{Gap, Verdict, compare_motions};
use crate::growth::{Growth, LeadingTerm, growth, leading_term};
use crate::{
    Choice, Membership, Metric, Motion, Settings, SolveError, constant_names, formulation, integrability, membership,
    setting, solve_choice,
};

/// A choice and what became of it.
pub struct Run {
    /// The choice.
    pub choice: Choice,
    /// The motion, or why there is none.
    pub outcome: Result<Motion, SolveError>,
}

/// Two runs compared.
pub struct Pair {
    /// Index of the first run.
    pub first: usize,
    /// Index of the second run.
    pub second: usize,
    /// The gap between them.
    pub gap: Gap,
    /// Growth of `second − first` near the start, where it stands out from the errors.
    pub growth: Option<Growth>,
    /// Predicted leading term, for Chetaev and vakonomic.
    pub predicted: Option<LeadingTerm>,
}

/// The best that free constants can do.
pub struct Fit {
    /// Index of the run whose constants were fitted.
    pub run: usize,
    /// Index of the run that was to be met.
    pub target: usize,
    /// The fitted motion; `None` where no constants lead to a motion over the whole horizon.
    pub fitted: Option<FittedMotion>,
}

/// A motion with fitted constants.
pub struct FittedMotion {
    /// Names and values of the constants.
    pub constants: Vec<(String, f64)>,
    /// The gap that remains.
    pub gap: Gap,
}

/// A scene in every formulation.
pub struct Comparison {
    /// The scene.
    pub scene: Scene,
    /// Frobenius' verdict on the constraints.
    pub integrability: Integrability,
    /// Runs: the formulations of the table in order, removals within.
    pub runs: Vec<Run>,
    /// Pairs of runs that both gave a motion.
    pub pairs: Vec<Pair>,
    /// Fits of free constants.
    pub fits: Vec<Fit>,
    /// Is Chetaev's motion vakonomic for some `μ₀`? `None` where there is no constraint, or one of the two has no motion.
    pub membership: Option<Result<Membership, SolveError>>,
}

impl Comparison {
    /// The first run of a formulation.
    pub fn run(&self, formulation: &str) -> Option<usize> {
        self.runs.iter().position(|r| r.choice.formulation == formulation)
    }

    /// Puts the constants that a run has in the place of fitted ones that leave a larger gap: fits minimize the sum of squares, not the
    /// largest gap, and a search is no reason to go farther away.
    pub fn keep_closer(&mut self) {
        for fit in &mut self.fits {
            let (first, second) = (fit.run.min(fit.target), fit.run.max(fit.target));
            let pair = self.pairs.iter().find(|p| (p.first, p.second) == (first, second));
            let (Some(found), Some(pair), Ok(motion)) = (&mut fit.fitted, pair, &self.runs[fit.run].outcome) else {
                continue;
            };
            if found.gap.largest > pair.gap.largest {
                let values = found.constants.iter_mut().zip(&motion.constants);
                values.for_each(|((_, value), own)| *value = *own);
                found.gap = pair.gap.clone();
            }
        }
    }

    /// The pair of two runs, in either order.
    pub fn pair(&self, a: usize, b: usize) -> Option<&Pair> {
        self.pairs.iter().find(|p| (p.first, p.second) == (a, b) || (p.first, p.second) == (b, a))
    }
}

/// Computes these choices of a scene, those of [`crate::choices`] for all formulations, and compares them. `extra` are further runs, derived elsewhere.
///
/// # Errors
/// [`mechanics::RemovalError`] where the constraints are dependent; [`SolveError`] where a computed motion cannot be read off.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// use deltaq::{Settings, Verdict, choices, compare};
/// // the ice sledge, with multipliers that are zero at the start
/// let choices = choices(&scene);
/// let comparison = compare(scene, choices, Vec::new(), &Settings::default())?;
/// let runs = (comparison.run("chetaev").unwrap(), comparison.run("vakonomic").unwrap());
/// let pair = comparison.pair(runs.0, runs.1).unwrap();
/// assert_eq!(pair.gap.verdict, Verdict::Different);
/// assert_eq!(pair.predicted.as_ref().unwrap().exponent, 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(
    scene: Scene,
    choices: Vec<Choice>,
    extra: Vec<Run>,
    settings: &Settings,
) -> Result<Comparison, SolveError> {
    let integrability = integrability(&scene.system, &scene.start)?;
    let mut metric = Metric::new(&scene.system)?;
    let mut runs: Vec<Run> =
        choices.into_iter().map(|choice| Run { outcome: solve_choice(&scene, &choice, settings), choice }).collect();
    runs.extend(extra);

    let mut pairs = Vec::new();
    for first in 0..runs.len() {
        for second in first + 1..runs.len() {
            if !worth_comparing(&runs[first], &runs[second]) {
                continue;
            }
            let (left, right) = runs.split_at_mut(second);
            let (Ok(one), Ok(two)) = (&mut left[first].outcome, &mut right[0].outcome) else { continue };
            let gap = compare_motions(one, two, &mut metric)?;
            let limit = |t: f64| gap.limit_at(t);
            let growth = match gap.verdict {
                Verdict::Different => growth(two, one, &mut metric, &limit)?,
                _ => None,
            };
            let mut pair = Pair { first, second, gap, growth, predicted: None };
            let names = (left[first].choice.formulation, right[0].choice.formulation);
            if names == ("chetaev", "vakonomic")
                && let Ok(chetaev) = &mut left[first].outcome
            {
                let reaction = chetaev.at(scene.start.t)?.multipliers;
                pair.predicted = leading_term(&scene.system, &scene.start, &scene.multipliers, &reaction)?;
            }
            pairs.push(pair);
        }
    }
    let end_of = |name: &str| {
        runs.iter().find(|r| r.choice.formulation == name).and_then(|r| r.outcome.as_ref().ok()).map(Motion::end)
    };
    let membership = match (end_of("chetaev"), end_of("vakonomic")) {
        (Some(end), Some(_)) => membership(&scene, end).transpose(),
        _ => None,
    };
    let decided = membership.as_ref().and_then(|m| m.as_ref().ok()).map(|m| m.decision.set.point.clone());
    let fits = fits(&scene, &mut runs, &pairs, decided, &mut metric, settings)?;
    Ok(Comparison { scene, integrability, runs, pairs, fits, membership })
}

/// The costate form is the vakonomic motion once more, and compared with that only; a run from outside the table with Chetaev only.
fn worth_comparing(first: &Run, second: &Run) -> bool {
    let names = [first.choice.formulation, second.choice.formulation];
    let only_with = |name: &str, partner: &str| !names.contains(&name) || names.contains(&partner);
    let outside = names.iter().find(|name| formulation(name).is_none());
    only_with(vakonomic::COSTATE_FORM.name, vakonomic::FORMULATION.name)
        && outside.is_none_or(|name| only_with(name, chetaev::FORMULATION.name))
}

/// Fits the free constants of one run to another wherever the two differ: vakonomic to Chetaev, the first removed-constraint run to
/// Chetaev, to vakonomic, and to the removed-constraint runs of other removals.
fn fits(
    scene: &Scene,
    runs: &mut [Run],
    pairs: &[Pair],
    decided: Option<Vec<f64>>,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Vec<Fit>, SolveError> {
    let of = |name: &str| -> Vec<usize> {
        let motion = |r: &Run| r.choice.formulation == name && r.outcome.as_ref().is_ok_and(|m| m.end() > m.start());
        (0..runs.len()).filter(|&i| motion(&runs[i])).collect()
    };
    let (chetaev, vakonomic, removed) = (of("chetaev"), of("vakonomic"), of("removed-constraint"));
    let mut wanted: Vec<(usize, usize)> = Vec::new();
    for &target in &chetaev {
        wanted.extend(vakonomic.iter().chain(removed.first()).map(|&run| (run, target)));
    }
    if let [first, others @ ..] = &removed[..] {
        wanted.extend(vakonomic.iter().chain(others).map(|&target| (*first, target)));
    }
    let mut fits = Vec::new();
    for (run, target) in wanted {
        let pair = |p: &&Pair| (p.first, p.second) == (target.min(run), target.max(run));
        if pairs.iter().find(pair).is_some_and(|p| p.gap.verdict == Verdict::Different)
            && let Some(fitted) = fit_run(scene, runs, run, target, decided.as_deref(), metric, settings)?
        {
            fits.push(Fit { run, target, fitted });
        }
    }
    Ok(fits)
}

/// `decided` is the least-norm element of the decided set, or the nearest miss. Outer `None`: there is nothing to fit. Inner `None`: no constants lead to a motion.
fn fit_run(
    scene: &Scene,
    runs: &mut [Run],
    run: usize,
    target: usize,
    decided: Option<&[f64]>,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Option<FittedMotion>>, SolveError> {
    let Ok(motion) = &runs[run].outcome else { return Ok(None) };
    let (equations, constants) = (motion.equations.clone(), motion.constants.clone());
    if constants.is_empty() {
        return Ok(None);
    }
    let mut guesses = vec![vec![0.0; constants.len()]];
    if constants != guesses[0] {
        guesses.push(constants);
    }
    if runs[run].choice.formulation == "vakonomic" {
        guesses.extend(decided.map(<[f64]>::to_vec));
    }
    let Ok(goal) = &mut runs[target].outcome else { return Ok(None) };
    let Some(mut motion) = best_fit(setting(scene), &equations, goal, &guesses, metric, settings)? else {
        return Ok(Some(None));
    };
    let gap = compare_motions(goal, &mut motion, metric)?;
    let names = constant_names(&motion.equations);
    Ok(Some(Some(FittedMotion { constants: names.into_iter().zip(motion.constants.clone()).collect(), gap })))
}
