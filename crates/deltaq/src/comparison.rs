//! One scene in every formulation, pair by pair.

use mechanics::Integrability;
use scene::Scene;

use crate::fits::{Fit, fits};
use crate::gap::{Verdict, compare_motions};
use crate::growth::growth;
use crate::runs::{Decided, Pair, Run, decided, predicted};
use crate::{
    Choice, Membership, Metric, Settings, SolveError, constant_names, formulation, integrability, solve_choice,
};

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
    /// Fits of free constants, if any were asked for.
    pub fits: Vec<Fit>,
    /// Which motions are motions of another formulation for some values of its constants. Of removals by
    /// coordinates nothing is asked: their families are the vakonomic one.
    pub decided: Vec<Decided>,
}

impl Comparison {
    /// The first run of a formulation.
    pub fn run(&self, formulation: &str) -> Option<usize> {
        self.runs.iter().position(|r| r.choice.formulation == formulation)
    }

    /// Is Chetaev's motion vakonomic for some `μ₀`? `None` without a constraint, or if one has no motion.
    pub fn membership(&self) -> Option<&Result<Membership, SolveError>> {
        let (family, curve) = (self.run("vakonomic")?, self.run("chetaev")?);
        self.decided.iter().find(|d| (d.family, d.curve) == (family, curve)).map(|d| &d.outcome)
    }

    /// Looks for the constants with which one run comes closest to another, wherever two differ.
    ///
    /// # Errors
    /// [`SolveError`] where a motion cannot be read off.
    pub fn fit(&mut self, settings: &Settings) -> Result<(), SolveError> {
        let mut metric = Metric::new(&self.scene.system)?;
        self.fits = fits(&self.scene, &mut self.runs, &self.pairs, &self.decided, &mut metric, settings)?;
        Ok(())
    }

    /// Puts the constants that a run has in the place of fitted ones that leave a larger gap: fits minimize
    /// the sum of squares, not the largest gap, and a search is no reason to go farther away.
    pub fn keep_closer(&mut self) {
        for fit in &mut self.fits {
            let (first, second) = (fit.run.min(fit.target), fit.run.max(fit.target));
            let pair = self.pairs.iter().find(|p| (p.first, p.second) == (first, second));
            let (Some(found), Some(pair), Ok(motion)) = (&mut fit.fitted, pair, &self.runs[fit.run].outcome) else {
                continue;
            };
            if found.gap.largest > pair.gap.largest {
                let names = constant_names(&motion.equations).into_iter();
                found.constants = names.zip(motion.constants.iter().copied()).collect();
                found.gap = pair.gap.clone();
            }
        }
    }

    /// The pair of two runs, in either order.
    pub fn pair(&self, a: usize, b: usize) -> Option<&Pair> {
        self.pairs.iter().find(|p| (p.first, p.second) == (a, b) || (p.first, p.second) == (b, a))
    }
}

/// Computes `choices` of a scene ([`crate::choices`]: all), adds `extra` runs from elsewhere, compares and
/// fits.
///
/// # Errors
/// As [`compare_unfitted`] and [`Comparison::fit`].
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
    let mut comparison = compare_unfitted(scene, choices, extra, settings)?;
    comparison.fit(settings)?;
    Ok(comparison)
}

/// [`compare`] without fits, which take most of its time: everything is decided, nothing searched.
///
/// # Errors
/// [`mechanics::RemovalError`] for dependent constraints; [`SolveError`] where a motion cannot be read off.
pub fn compare_unfitted(
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
            let predicted = match growth {
                Some(_) => predicted(&scene, &left[first].choice, &right[0]),
                None => None,
            };
            pairs.push(Pair { first, second, gap, growth, predicted });
        }
    }
    let decided = decided(&scene, &runs);
    Ok(Comparison { scene, integrability, runs, pairs, fits: Vec::new(), decided })
}

/// The costate form is compared with the vakonomic one only, a run from outside the table with Chetaev only.
fn worth_comparing(first: &Run, second: &Run) -> bool {
    let names = [first.choice.formulation, second.choice.formulation];
    let only_with = |name: &str, partner: &str| !names.contains(&name) || names.contains(&partner);
    let outside = names.iter().find(|name| formulation(name).is_none());
    only_with(vakonomic::COSTATE_FORM.name, vakonomic::FORMULATION.name)
        && outside.is_none_or(|name| only_with(name, chetaev::FORMULATION.name))
}
