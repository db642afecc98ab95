//! One scene in every formulation, pair by pair.

use equations::Formulation;
use mechanics::Integrability;
use scene::Scene;

use crate::fit::search::Found;
use crate::fits::{Fit, Fits, Start, fit_run, fits};
use crate::gap::Verdict;
use crate::runs::{Decided, Extent, Pair, Run, compared, decide, questions};
use crate::{Answer, Beyond, Membership, beyond_contacts, integrability};
use motion::{CHETAEV, Choice, Metric, Settings, SolveError, VAKONOMIC, constant_names, solve_choice};

/// A scene in every formulation.
pub struct Comparison {
    /// The scene.
    pub scene: Scene,
    /// Frobenius' verdict on the constraints.
    pub integrability: Integrability,
    /// The extent of the comparison.
    pub extent: Extent,
    /// Runs: the formulations of the table in order, removals within.
    pub runs: Vec<Run>,
    /// Pairs of runs that both gave a motion.
    pub pairs: Vec<Pair>,
    /// Fits of free constants, if any were asked for.
    pub fits: Vec<Fit>,
    /// Which motions are motions of another formulation for some values of its constants. Removals by
    /// coordinates are left out: their family is the vakonomic one.
    pub decided: Vec<Decided>,
    /// What the vakonomic motion needs and contacts cannot exert; `None` inside if nothing, or outside where
    /// the scene has no bodies or there is no such motion.
    pub beyond: Option<Option<Beyond>>,
}

impl Comparison {
    /// A comparison of a scene, before any motion is computed.
    ///
    /// # Errors
    /// [`mechanics::RemovalError`] for dependent constraints; [`SolveError::Tolerance`].
    pub fn new(scene: Scene, extent: Extent, settings: &Settings) -> Result<Comparison, SolveError> {
        settings.check()?;
        let integrability = integrability(&scene)?;
        let (runs, pairs, fits, decided) = Default::default();
        Ok(Comparison { scene, integrability, extent, runs, pairs, fits, decided, beyond: None })
    }

    /// Solves a choice, and adds it as [`Comparison::add`] does.
    ///
    /// # Errors
    /// As [`Comparison::add`].
    pub fn solve(&mut self, choice: Choice, settings: &Settings) -> Result<(), SolveError> {
        let outcome = solve_choice(&self.scene, &choice, settings);
        self.add(Run { choice, outcome })
    }

    /// Adds a run, and compares it with those before, where that is worth it. A motion that cannot be read
    /// off at its start is none; one that cannot later on is stopped there.
    ///
    /// # Errors
    /// [`SolveError::Compile`] where `L` or `f` contain a symbol that is not defined.
    pub fn add(&mut self, mut run: Run) -> Result<(), SolveError> {
        let (mut metric, second) = (Metric::new(&self.scene.system)?, self.runs.len());
        run.outcome = run.outcome.and_then(|mut motion| motion.at(motion.start()).map(|_| motion));
        if run.choice.formulation == VAKONOMIC
            && self.scene.meant.is_some()
            && let Ok(motion) = &mut run.outcome
        {
            // where it cannot be read off, nothing is said
            self.beyond = beyond_contacts(&self.scene, motion).ok();
        }
        for before in self.runs.iter_mut().enumerate() {
            self.pairs.extend(compared(&self.scene, self.extent, [before, (second, &mut run)], &mut metric)?);
        }
        self.runs.push(run);
        self.pairs.sort_by_key(|pair| (pair.first, pair.second));
        Ok(())
    }

    /// What [`Comparison::decide_next`] decides next: the runs of a family, and of a motion.
    pub fn undecided(&self) -> Option<(usize, usize)> {
        let is_new = |asked: &(usize, usize)| !self.decided.iter().any(|d| (d.family, d.curve) == *asked);
        let asked = questions(&self.scene, &self.runs);
        let principal = self.run(VAKONOMIC).zip(self.run(CHETAEV));
        let is_within = |asked: &(usize, usize)| match self.extent {
            Extent::Gaps => false,
            Extent::Answer => Some(*asked) == principal,
            Extent::Everything => true,
        };
        asked.into_iter().filter(is_within).find(is_new)
    }

    /// Decides whether the next motion is one of a family; `None` where nothing is left to be asked.
    pub fn decide_next(&mut self) -> Option<&Decided> {
        let asked = self.undecided()?;
        let mut decided = decide(&self.scene, &self.runs, asked);
        let none = |found: &Membership| matches!(found.answer(), Answer::NoneProved { .. });
        let is_asked = |p: &&mut Pair| [(p.first, p.second), (p.second, p.first)].contains(&asked);
        let proved = decided.outcome.as_ref().is_ok_and(none);
        for pair in self.pairs.iter_mut().filter(is_asked) {
            match &mut decided.outcome {
                _ if proved => pair.gap.prove(),
                Ok(found) if pair.gap.verdict == Verdict::Same => found.decision.is_noise(),
                _ => {}
            }
        }
        self.decided.push(decided);
        self.decided.last()
    }

    /// The first run of a formulation.
    pub fn run(&self, formulation: &Formulation) -> Option<usize> {
        self.runs.iter().position(|r| r.choice.formulation == formulation)
    }

    /// Is Chetaev's motion vakonomic for some `μ₀`? `None` without a constraint, or if one has no motion.
    pub fn membership(&self) -> Option<&Result<Membership, SolveError>> {
        let (family, curve) = (self.run(VAKONOMIC)?, self.run(CHETAEV)?);
        self.decided.iter().find(|d| (d.family, d.curve) == (family, curve)).map(|d| &d.outcome)
    }

    /// Looks for the constants with which one run comes closest to another, where the two differ and that is
    /// among the `wanted`; a run's own constants stay where they leave less.
    ///
    /// # Errors
    /// [`SolveError`] where a motion cannot be read off.
    pub fn fit(&mut self, wanted: Fits, settings: &Settings) -> Result<(), SolveError> {
        let mut metric = Metric::new(&self.scene.system)?;
        self.fits = match wanted {
            Fits::None => Vec::new(),
            _ => fits(&self.scene, &mut self.runs, &self.pairs, &self.decided, wanted, &mut metric, settings)?,
        };
        self.keep_closer();
        self.try_constants(&mut metric, settings);
        Ok(())
    }

    /// Solves with the constants that were decided to give a motion, where the family's run had others.
    fn try_constants(&mut self, metric: &mut Metric, settings: &Settings) {
        for decided in &mut self.decided {
            let (Ok(found), family) = (&decided.outcome, decided.family) else { continue };
            let point = &found.decision.set.point;
            let has_others = self.runs[family].outcome.as_ref().is_ok_and(|run| run.constants != *point);
            if has_others && matches!(found.answer(), Answer::SomeProved | Answer::Some { .. }) {
                let (open, part) = (found.decision.open(), found.decision.part());
                let start = Start::Known(Found { open, part, ..Found::given(point.clone()) });
                let fitted = fit_run(&self.scene, &mut self.runs, family, decided.curve, start, metric, settings);
                decided.witness = fitted.map(Option::flatten).map_err(|refused| refused.to_string()).transpose();
            }
        }
    }

    /// Puts the constants that a run has instead of fitted ones that leave, by more than errors, a larger gap
    /// up to the same time: a search is no reason to go farther away.
    pub(crate) fn keep_closer(&mut self) {
        for fit in &mut self.fits {
            let (first, second) = (fit.run.min(fit.target), fit.run.max(fit.target));
            let pair = self.pairs.iter().find(|p| (p.first, p.second) == (first, second));
            let (Some(found), Some(pair), Ok(motion)) = (&mut fit.fitted, pair, &self.runs[fit.run].outcome) else {
                continue;
            };
            let is_seen = found.gap.verdict == Verdict::Different && found.gap.end == pair.gap.end;
            if is_seen && found.gap.largest > pair.gap.largest {
                let names = constant_names(&motion.equations).into_iter();
                found.constants = names.zip(motion.constants.iter().copied()).collect();
                found.gap = pair.gap.clone();
                found.by_half = found.gap.largest;
            }
        }
    }

    /// The largest error estimate of a run in its pairs, kinetic metric; `None` where it is in none.
    pub fn estimate(&self, run: usize) -> Option<f64> {
        let of = |p: &Pair| {
            [(p.first, 0), (p.second, 1)].into_iter().find(|(i, _)| *i == run).map(|(_, i)| p.gap.estimates[i])
        };
        self.pairs.iter().filter_map(of).max_by(f64::total_cmp)
    }

    /// The pair of two runs, in either order.
    pub fn pair(&self, a: usize, b: usize) -> Option<&Pair> {
        self.pairs.iter().find(|p| (p.first, p.second) == (a, b) || (p.first, p.second) == (b, a))
    }
}

/// Computes `choices` of a scene ([`motion::choices`]: all), adds `extra` runs from elsewhere, compares and
/// fits.
///
/// # Errors
/// As [`compare_unfitted`] and [`Comparison::fit`].
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// use comparison::{Verdict, compare};
/// use motion::{CHETAEV, Settings, VAKONOMIC, choices};
/// // the ice sledge, with multipliers that are zero at the start
/// let choices = choices(&scene);
/// let comparison = compare(scene, choices, Vec::new(), &Settings::default())?;
/// let runs = (comparison.run(CHETAEV).unwrap(), comparison.run(VAKONOMIC).unwrap());
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
    comparison.fit(Fits::All, settings)?;
    Ok(comparison)
}

/// [`compare`] without fits, which take most of its time: everything is decided, nothing searched.
///
/// # Errors
/// As [`Comparison::new`] and [`Comparison::add`].
pub fn compare_unfitted(
    scene: Scene,
    choices: Vec<Choice>,
    extra: Vec<Run>,
    settings: &Settings,
) -> Result<Comparison, SolveError> {
    let mut comparison = Comparison::new(scene, Extent::Everything, settings)?;
    for choice in choices {
        comparison.solve(choice, settings)?;
    }
    extra.into_iter().try_for_each(|run| comparison.add(run))?;
    while comparison.decide_next().is_some() {}
    Ok(comparison)
}

impl std::fmt::Debug for Comparison {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let verdicts: Vec<&crate::Verdict> = self.pairs.iter().map(|pair| &pair.gap.verdict).collect();
        f.debug_struct("Comparison")
            .field("scene", &self.scene.name)
            .field("verdicts", &verdicts)
            .finish_non_exhaustive()
    }
}
