//! One scene in every formulation, pair by pair.

use std::time::Instant;

use equations::{Derivation, Equations, Formulation};
use mechanics::{ConstantsRule, Integrability, Recombination, Removal, State, System, integrability};
use nalgebra::{DMatrix, DVector};
use scene::Scene;

use crate::fit::best_fit;
use crate::gap::{Gap, Verdict, compare_motions};
use crate::growth::{Growth, LeadingTerm, growth, leading_term};
use crate::metric::Metric;
use crate::removals::removals;
use crate::{FORMS, FORMULATIONS, Motion, Setting, Settings, SolveError, formulation, solve};

/// One formulation of the scene, with all choices made.
#[derive(Clone)]
pub struct Choice {
    /// What the reader sees: the formulation, and the removal where there are several.
    pub label: String,
    /// Name of the formulation.
    pub formulation: &'static str,
    /// The removal, where the formulation needs one.
    pub removal: Option<Removal>,
    /// Free constants.
    pub constants: ConstantsRule,
}

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
}

impl Comparison {
    /// The first run of a formulation.
    pub fn run(&self, formulation: &str) -> Option<usize> {
        self.runs.iter().position(|r| r.choice.formulation == formulation)
    }

    /// The pair of two runs, in either order.
    pub fn pair(&self, a: usize, b: usize) -> Option<&Pair> {
        self.pairs.iter().find(|p| (p.first, p.second) == (a, b) || (p.first, p.second) == (b, a))
    }
}

/// Every choice that a comparison of `scene` makes. Where no removal can be found, the formulations that need one get a choice
/// without, which [`solve_choice`] refuses with the reason.
pub fn choices(scene: &Scene) -> Vec<Choice> {
    let mut choices = Vec::new();
    for formulation in FORMULATIONS {
        let removals = if formulation.needs_removal { removals(scene).unwrap_or_default() } else { Vec::new() };
        if removals.is_empty() {
            choices.push(without_removal(formulation, scene));
        }
        for removal in removals {
            choices.push(Choice {
                label: format!("{} ({})", formulation.title, removal.name),
                formulation: formulation.name,
                constants: removal.constants.clone(),
                removal: Some(removal),
            });
        }
    }
    choices
}

/// A choice of each of [`FORMS`], of which [`derive_at`] refuses those that `scene` does not have.
pub fn forms(scene: &Scene) -> Vec<Choice> {
    FORMS.iter().map(|form| without_removal(form, scene)).collect()
}

fn without_removal(formulation: &Formulation, scene: &Scene) -> Choice {
    let constants = default_constants(formulation, scene);
    Choice { label: formulation.title.into(), formulation: formulation.name, removal: None, constants }
}

/// The free constants of a formulation without a removal: the scene's multipliers where it starts from multipliers, else zero.
pub fn default_constants(formulation: &Formulation, scene: &Scene) -> ConstantsRule {
    if formulation.starts_multipliers { ConstantsRule::Given(scene.multipliers.clone()) } else { ConstantsRule::Zero }
}

/// Derives the equations of a choice, without what they do not need.
///
/// # Errors
/// [`SolveError::Derivation`], [`SolveError::Removal`].
pub fn derive(system: &System, choice: &Choice) -> Result<Equations, SolveError> {
    derive_from(system, None, choice)
}

/// [`derive()`] for a motion that starts at `start`, where pivots may have to be chosen.
fn derive_from(system: &System, start: Option<&State>, choice: &Choice) -> Result<Equations, SolveError> {
    let formulation: &Formulation = formulation(choice.formulation).unwrap_or(&FORMULATIONS[0]);
    let removal = choice.removal.as_ref();
    let equations = (formulation.derive)(system, &Derivation { removal, start })?;
    Ok(equations.leave_out_unneeded())
}

/// [`derive()`], from constraints that are independent at `start` where those of the system nearly are not ([`Recombination`]).
///
/// # Errors
/// As [`derive()`]; [`SolveError::Start`] where the constraints are dependent.
pub fn derive_at(system: &System, start: &State, choice: &Choice) -> Result<Equations, SolveError> {
    let combined = Recombination::at(system, start);
    if choice.removal.is_some() {
        // the constraints stand no more in the equations, but they gave the start
        let mut equations = derive(system, choice)?;
        equations.lost_digits = combined.ok().flatten().map_or(1.0, |combined| combined.ratio.recip());
        return Ok(equations);
    }
    match combined? {
        None => derive_from(system, Some(start), choice),
        Some(combined) => {
            Ok(derive_from(&combined.system(system), Some(start), choice)?.with_multipliers_restored(&combined))
        }
    }
}

/// Derives and integrates a choice from the start of the scene.
///
/// # Errors
/// [`SolveError`] where there is no motion.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", r#"
/// # title = "Ice sledge on an incline"
/// # [coordinates]
/// # x   = { start = 0 }
/// # y   = { start = 0 }
/// # phi = { start = 0.3 }
/// # [system]
/// # lagrangian  = "(x'^2 + y'^2 + phi'^2)/2 + x"
/// # constraints = ["y'*cos(phi) - x'*sin(phi)"]
/// # [start.velocities]
/// # "phi'" = 1
/// # "x'" = 0.5
/// # [run]
/// # duration = 1
/// # "#)?;
/// use deltaq::{Settings, choices, solve_choice};
/// // the ice sledge turns at a constant rate: phi = 0.3 + t
/// let chetaev = choices(&scene).into_iter().find(|c| c.formulation == "chetaev").unwrap();
/// let mut motion = solve_choice(&scene, &chetaev, &Settings::default())?;
/// assert!(motion.is_complete());
/// assert!((motion.at(1.0)?.coordinates[2] - 1.3).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_choice(scene: &Scene, choice: &Choice, settings: &Settings) -> Result<Motion, SolveError> {
    if choice.removal.is_none() && formulation(choice.formulation).is_some_and(|f| f.needs_removal) {
        removals(scene)?;
    }
    let clock = Instant::now();
    let equations = derive_at(&scene.system, &scene.start, choice)?;
    let derive = clock.elapsed().as_secs_f64();
    let mut motion = solve(setting(scene), equations, &choice.constants, settings)?;
    motion.seconds.derive = derive;
    Ok(motion)
}

/// What every motion of a scene starts from.
pub fn setting(scene: &Scene) -> Setting<'_> {
    Setting { system: &scene.system, start: &scene.start, end: scene.start.t + scene.duration }
}

/// Computes all formulations of a scene and compares them. `extra` are further runs, derived elsewhere.
///
/// # Errors
/// [`mechanics::RemovalError`] where the constraints are dependent; [`SolveError`] where a computed motion cannot be read off.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", r#"
/// # title = "Ice sledge on an incline"
/// # [coordinates]
/// # x   = { start = 0 }
/// # y   = { start = 0 }
/// # phi = { start = 0.3 }
/// # [system]
/// # lagrangian  = "(x'^2 + y'^2 + phi'^2)/2 + x"
/// # constraints = ["y'*cos(phi) - x'*sin(phi)"]
/// # [start.velocities]
/// # "phi'" = 1
/// # "x'" = 0.5
/// # [run]
/// # duration = 1
/// # "#)?;
/// use deltaq::{Settings, Verdict, compare};
/// // the ice sledge, with multipliers that are zero at the start
/// let comparison = compare(scene, Vec::new(), &Settings::default())?;
/// let runs = (comparison.run("chetaev").unwrap(), comparison.run("vakonomic").unwrap());
/// let pair = comparison.pair(runs.0, runs.1).unwrap();
/// assert_eq!(pair.gap.verdict, Verdict::Different);
/// assert_eq!(pair.predicted.as_ref().unwrap().exponent, 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(scene: Scene, extra: Vec<Run>, settings: &Settings) -> Result<Comparison, SolveError> {
    let integrability = integrability(&scene.system, &scene.start)?;
    let mut metric = Metric::new(&scene.system)?;
    let mut runs: Vec<Run> = choices(&scene)
        .into_iter()
        .map(|choice| Run { outcome: solve_choice(&scene, &choice, settings), choice })
        .collect();
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
    let fits = fits(&scene, &mut runs, &pairs, &mut metric, settings)?;
    Ok(Comparison { scene, integrability, runs, pairs, fits })
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
            && let Some(fitted) = fit_run(scene, runs, run, target, metric, settings)?
        {
            fits.push(Fit { run, target, fitted });
        }
    }
    Ok(fits)
}

/// Outer `None`: there is nothing to fit. Inner `None`: no constants lead to a motion.
fn fit_run(
    scene: &Scene,
    runs: &mut [Run],
    run: usize,
    target: usize,
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
        guesses.extend(costate_free_guess(&scene.system, &scene.start));
    }
    let Ok(goal) = &mut runs[target].outcome else { return Ok(None) };
    let Some(mut motion) = best_fit(setting(scene), &equations, goal, &guesses, metric, settings)? else {
        return Ok(Some(None));
    };
    let gap = compare_motions(goal, &mut motion, metric)?;
    let names = crate::constant_names(&motion.equations);
    Ok(Some(Some(FittedMotion { constants: names.into_iter().zip(motion.constants.clone()).collect(), gap })))
}

/// The `μ₀` that makes the costate `L_v + Aᵀ μ₀` smallest: where a vakonomic motion can be a Chetaev one, it often is this.
fn costate_free_guess(system: &System, start: &State) -> Option<Vec<f64>> {
    let system = system.clone();
    let g = &system.graph;
    let mut values = system.parameter_values();
    values.extend(system.values_at(start));
    let number = |&e: &symbolic::Expr| g.evaluate(e, &values).ok();
    let momenta: Option<Vec<f64>> = g.gradient(system.lagrangian, &system.velocities()).iter().map(number).collect();
    let jacobian = system.constraint_jacobian();
    let entries: Option<Vec<f64>> = jacobian.entries().iter().map(number).collect();
    let a = DMatrix::from_row_slice(jacobian.rows(), jacobian.columns(), &entries?);
    let solution = a.transpose().svd(true, true).solve(&-DVector::from_vec(momenta?), 1e-12).ok()?;
    Some(solution.as_slice().to_vec())
}
