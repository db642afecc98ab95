//! One random system with its motions, on which claims are tested.

use comparison::{Gap, Membership, Sampling, Verdict, compare_motions_by, membership};
use equations::{Equations, Formulation};
use mechanics::{ConstantsRule, Removal, SingularValues, State, System};
use motion::band::{BEFORE_THE_END, INSTANTS, SEARCH_STEPS};
use motion::{
    CHETAEV, Ending, Metric, Motion, REMOVED_CONSTRAINT, Setting, Settings, SolveError, TIGHTER, VAKONOMIC, setting,
};
use nalgebra::DMatrix;
use referees::maggi::{self, MaggiError};
use scene::Scene;
use symbolic::Expr;
use symbolic::limits::SAME;

use super::derived::{equations, free_constants};
use super::finding::{Finding, Findings, Word};
use super::found_out::referee;
use super::recipe::Recipe;
use super::writings::Writing;
use crate::realization::{constraint_jacobian, numbers};
use review::substitution::SUBSTITUTION;

/// Tolerances tried one after the other: what round-off does not allow is asked for less sharply.
const TOLERANCES: [f64; 3] = [1e-11, 1e-9, 1e-7];

/// How often the run may be shortened.
const SHORTENED: usize = 6;

/// A motion of the removed-constraint formulation with its removal.
pub struct Removed {
    /// The removal.
    pub removal: Removal,
    /// `P(t₀)`, one per memory variable; zero for those without a costate.
    pub costates: Vec<f64>,
    /// The motion.
    pub motion: Motion,
}

/// A random system, its motions in every formulation, and what was found.
pub struct Case {
    /// Where it comes from.
    pub recipe: Recipe,
    /// The system and its start; the duration is one that all formulations last.
    pub scene: Scene,
    /// Measures gaps.
    pub metric: Metric,
    /// Chetaev.
    pub chetaev: Motion,
    /// Vakonomic with the multipliers of the scene.
    pub vakonomic: Motion,
    /// The removal of the scene, then the automatic ones.
    pub removed: Vec<Removed>,
    /// Lindelöf's mistake, on the removal by coordinates where there is one; it has no meaning with forces.
    pub control: Option<(Removal, Motion)>,
    /// Why the run was shortened, if it was.
    pub shortened: Option<String>,
    /// Gaps by round-off of data: `10² ε κ`, `κ` the condition of the saddle-point matrix at the start.
    pub floor: f64,
    /// The findings so far.
    pub found: Findings,
    /// The formulation of the motion that is planted in the vakonomic family.
    pub planted: &'static Formulation,
    /// What [`Case::membership`] has said, if it was asked.
    pub membership: Option<Membership>,
    /// Stands for the motion of the scene's removal with constants natural at the end, if it is given.
    pub natural: Option<Motion>,
    /// Stands for the motion of the family between vakonomic and Chetaev, if it is given.
    pub between: Option<Motion>,
    /// Stands for the other writing of the system, if it is given.
    pub writing: Option<&'static Writing>,
    /// What [`Case::referee`] has said, if it was asked.
    referee: Option<[maggi::Motion; 2]>,
}

/// What is observed of two motions that are the same: how near the gap comes to what it must not pass, at
/// most, as a part of that.
pub const NEAREST: &str = "gap over its limit, of motions that agree";

impl Case {
    /// Derives and integrates all formulations. If a motion stops early, the run is shortened until all last.
    ///
    /// # Errors
    /// [`SolveError`] where a formulation has no motion from this start.
    pub fn new(recipe: Recipe, name: &str) -> Result<Case, SolveError> {
        let mut scene = recipe.scene(name);
        let mut shortened = None;
        for _ in 0..SHORTENED {
            let case = Case::with_duration(&recipe, &scene)?;
            let Some((t, cause)) = case.earliest_stop() else { return Ok(Case { shortened, ..case }) };
            scene.duration = BEFORE_THE_END * (t - scene.start.t);
            shortened.get_or_insert(cause);
        }
        Case::with_duration(&recipe, &scene).map(|case| Case { shortened, ..case })
    }

    fn with_duration(recipe: &Recipe, scene: &Scene) -> Result<Case, SolveError> {
        let system = &scene.system;
        let floor = floor(system, &scene.start, &scene.multipliers)?;
        let run = |equations: Equations, constants: &[f64]| solve(setting(scene), equations, constants, floor, false);
        let chetaev = run(equations(system, CHETAEV, None)?, &[])?;
        let vakonomic = run(equations(system, VAKONOMIC, None)?, &scene.multipliers)?;
        let mut removed = Vec::new();
        for removal in motion::removals(scene)? {
            let equations = equations(system, REMOVED_CONSTRAINT, Some(&removal))?;
            let costates = some_costates(recipe, &equations, removal.memory.len());
            let motion = run(equations.clone(), &free_constants(&equations, &costates))?;
            removed.push(Removed { removal, costates, motion });
        }
        let by_coordinates = removed.iter().find(|r| r.removal.name == "coordinates").or(removed.first());
        let control = match by_coordinates.filter(|_| !system.has_forces()) {
            Some(Removed { removal, .. }) => {
                Some((removal.clone(), run(review::substitution::derive(system, removal), &[])?))
            }
            None => None,
        };
        Ok(Case {
            recipe: recipe.clone(),
            metric: Metric::new(system)?,
            scene: scene.clone(),
            chetaev,
            vakonomic,
            removed,
            control,
            shortened: None,
            floor,
            found: Findings::default(),
            planted: VAKONOMIC,
            membership: None,
            natural: None,
            between: None,
            writing: None,
            referee: None,
        })
    }

    /// The set of all `μ₀` with which the vakonomic motion is Chetaev's; `None` where there is no constraint,
    /// and for an indefinite `M`, which measures no mismatch.
    ///
    /// # Errors
    /// [`SolveError`] where it cannot be decided.
    pub fn membership(&mut self) -> Result<Option<Membership>, SolveError> {
        if self.membership.is_none() && !self.recipe.drawn.indefinite {
            self.membership = membership(&self.scene, self.end())?;
        }
        Ok(self.membership.clone())
    }

    /// Chetaev's motion by Maggi's equations, at two tolerances, the sharper one last.
    ///
    /// # Errors
    /// [`MaggiError`] where it cannot be started.
    pub fn referee(&mut self) -> Result<&mut [maggi::Motion; 2], MaggiError> {
        let found = match self.referee.take() {
            Some(found) => found,
            None => referee(Setting { end: self.end(), ..setting(&self.scene) })?,
        };
        Ok(self.referee.insert(found))
    }

    fn earliest_stop(&self) -> Option<(f64, String)> {
        let stop = |label: &str, motion: &Motion| match &motion.ending {
            Ending::Stopped { t, cause } => Some((*t, format!("{label}: {cause}"))),
            Ending::Completed => None,
        };
        let removed = self.removed.iter().map(|r| (format!("removed constraint ({})", r.removal.name), &r.motion));
        let control = self.control.iter().map(|(_, motion)| (SUBSTITUTION.name.to_string(), motion));
        [("Chetaev".to_string(), &self.chetaev), ("vakonomic".to_string(), &self.vakonomic)]
            .into_iter()
            .chain(removed)
            .chain(control)
            .filter_map(|(label, motion)| stop(&label, motion))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Time of the end.
    pub fn end(&self) -> f64 {
        self.scene.start.t + self.scene.duration
    }

    /// A motion of `equations` of another system from `start`, with every block by LU factorization: what is
    /// said of the case's own motions is said of the forms that were chosen for them as well.
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn solve(
        &self,
        system: &System,
        start: &State,
        end: f64,
        equations: Equations,
        constants: &[f64],
    ) -> Result<Motion, SolveError> {
        solve(Setting { system, start, end }, equations, constants, self.floor, true)
    }

    /// The motion of another formulation, or with other constants, from the start of the scene.
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn run(&self, equations: Equations, constants: &[f64]) -> Result<Motion, SolveError> {
        solve(setting(&self.scene), equations, constants, self.floor, false)
    }

    /// Notes whether two motions are the same.
    pub fn same(&mut self, theorem: u8, claim: &'static str, first: Which, second: &mut Motion) {
        self.same_by(theorem, claim, first, second, &Sampling::default());
    }

    /// Notes whether two motions are the same, with clocks that differ.
    pub fn same_by(
        &mut self,
        theorem: u8,
        claim: &'static str,
        first: Which,
        second: &mut Motion,
        sampling: &Sampling,
    ) {
        let gap = self.gap_by(first, second, sampling);
        self.note_if_read(theorem, claim, gap);
    }

    /// Notes whether two motions with this gap are the same; one under `floor` is none.
    pub fn note(&mut self, theorem: u8, claim: &'static str, gap: &Gap, floor: f64) {
        let found = finding(theorem, claim, gap, floor);
        if found.word == Word::Holds {
            let parts = gap.points.iter().filter(|p| p.limit.is_finite()).map(|p| p.gap / p.limit.max(floor));
            self.found.observe(theorem, NEAREST, parts.fold(0.0, f64::max));
        }
        self.found.findings.push(found);
    }

    /// Whether a gap denies that two motions are the same.
    pub fn is_apart(&self, gap: &Gap) -> bool {
        finding(0, "", gap, self.floor).word == Word::Fails
    }

    /// The gap between one of the case's own motions and another, with clocks that differ.
    ///
    /// # Errors
    /// [`SolveError`] where the first cannot be read off.
    pub fn gap_by(&mut self, first: Which, second: &mut Motion, sampling: &Sampling) -> Result<Gap, SolveError> {
        let (mut metric, sampling) = (self.metric.clone(), Sampling { instants: INSTANTS, ..*sampling });
        compare_motions_by(self.motion(first), second, &mut metric, &sampling)
    }

    /// Notes whether two motions are the same, of which none need be the case's own.
    pub fn pair(&mut self, theorem: u8, claim: &'static str, first: &mut Motion, second: &mut Motion) {
        let gap = self.gap_of(first, second);
        self.note_if_read(theorem, claim, gap);
    }

    /// Notes whether two motions are the same, undecided where one cannot be read off.
    fn note_if_read(&mut self, theorem: u8, claim: &'static str, gap: Result<Gap, SolveError>) {
        match gap {
            Ok(gap) => self.note(theorem, claim, &gap, self.floor),
            Err(error) => self.found.undecided(theorem, claim, error),
        }
    }

    /// The gap between two motions.
    ///
    /// # Errors
    /// [`SolveError`] where the first cannot be read off.
    pub fn gap_of(&self, first: &mut Motion, second: &mut Motion) -> Result<Gap, SolveError> {
        let sampling = Sampling { instants: INSTANTS, ..Sampling::default() };
        compare_motions_by(first, second, &mut self.metric.clone(), &sampling)
    }

    /// The gap between two of the case's own motions.
    ///
    /// # Errors
    /// [`SolveError`] where one cannot be read off.
    pub fn gap(&mut self, first: Which, second: Which) -> Result<Gap, SolveError> {
        let mut other = self.motion(second).clone();
        self.gap_by(first, &mut other, &Sampling::default())
    }

    /// One of the case's own motions.
    ///
    /// # Panics
    /// For a removal or a control that the case does not have.
    pub fn motion(&mut self, which: Which) -> &mut Motion {
        match which {
            Which::Chetaev => &mut self.chetaev,
            Which::Vakonomic => &mut self.vakonomic,
            Which::Removed(i) => &mut self.removed[i].motion,
            Which::Control => &mut self.control.as_mut().expect("asked for only where there is one").1,
        }
    }
}

/// A motion of a [`Case`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Chetaev.
    Chetaev,
    /// Vakonomic with the multipliers of the scene.
    Vakonomic,
    /// Removed constraint, by place in [`Case::removed`].
    Removed(usize),
    /// The control.
    Control,
}

/// Costates of the recipe, zero where the variable has none.
fn some_costates(recipe: &Recipe, equations: &Equations, memory: usize) -> Vec<f64> {
    let used = |i: &usize| equations.free_constants.iter().any(|c| c.memory == Some(*i));
    let value = |i: usize| if used(&i) { recipe.costates[i % recipe.costates.len()] as f64 / 8.0 } else { 0.0 };
    (0..memory).map(value).collect()
}

/// Solves at the sharpest of [`TOLERANCES`] that `floor` allows and the motion lasts; [`Settings::plain`].
fn solve(
    setting: Setting,
    equations: Equations,
    constants: &[f64],
    floor: f64,
    plain: bool,
) -> Result<Motion, SolveError> {
    let rule = ConstantsRule::Given(constants.to_vec());
    let mut best: Option<Motion> = None;
    for tolerance in tolerances(floor) {
        let settings = Settings { tolerance, max_steps: SEARCH_STEPS, plain, ..Settings::default() };
        let motion = motion::solve(setting, equations.clone(), &rule, &settings)?;
        if motion.is_complete() {
            return Ok(motion);
        }
        if best.as_ref().is_none_or(|b| motion.end() > b.end()) {
            best = Some(motion);
        }
    }
    match best {
        Some(motion) => Ok(motion),
        None => unreachable!("there is a tolerance"),
    }
}

/// Tolerances of runs that a floor ([`Case::floor`]) allows, sharp ones first; the last one always.
pub fn tolerances(floor: f64) -> impl Iterator<Item = f64> {
    let is_allowed =
        move |tolerance: &f64| tolerance * TIGHTER >= SAME * floor || *tolerance == TOLERANCES[TOLERANCES.len() - 1];
    TOLERANCES.into_iter().filter(is_allowed)
}

/// `10² ε κ` with the condition `κ` of the saddle-point matrix `[𝓛_vv Aᵀ; A 0]` at the start: data with
/// round-off give accelerations, multipliers, costates to `ε κ`. Near dependence means `κ ∝ 1/angle²`.
///
/// # Errors
/// [`SolveError`] where an entry has no value.
pub fn floor(system: &System, start: &State, multipliers: &[f64]) -> Result<f64, SolveError> {
    let h = system.constraints.len();
    if h == 0 {
        return Ok(0.0);
    }
    let (g, v) = (&system.graph, system.velocities());
    let mu: Vec<Expr> = multipliers.iter().map(|&mu| g.number(mu)).collect();
    let augmented = g.add(system.lagrangian, g.dot(&mu, &system.constraints));
    let hessian = g.jacobian(&g.gradient(augmented, &v), &v);
    let n = v.len();
    let hessian = DMatrix::from_row_slice(n, n, &numbers(g, hessian.entries(), &system.values_at(start))?);
    let a = constraint_jacobian(system, start)?;
    let mut saddle = DMatrix::zeros(n + h, n + h);
    saddle.view_mut((0, 0), (n, n)).copy_from(&hessian);
    saddle.view_mut((0, n), (n, h)).copy_from(&a.transpose());
    saddle.view_mut((n, 0), (h, n)).copy_from(&a);
    let singular = SingularValues::of(&saddle).values;
    let (smallest, largest) = singular.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &s| (a.min(s), b.max(s)));
    Ok(1e2 * f64::EPSILON * largest / smallest)
}

/// The claim that two motions are the same.
fn finding(theorem: u8, claim: &'static str, gap: &Gap, floor: f64) -> Finding {
    let limit = gap.points.iter().fold(floor, |a, p| a.max(p.limit));
    let doubted = limit.is_infinite();
    let certain = gap.points.iter().any(|p| p.gap > p.limit.max(floor));
    let (word, note) = match &gap.verdict {
        Verdict::Different if certain => {
            (Word::Fails, format!("different from t = {:.4}", gap.certain_from.unwrap_or(f64::NAN)))
        }
        Verdict::Different if doubted => (Word::Undecided, "the error estimate is in doubt".into()),
        Verdict::Same | Verdict::Different => (Word::Holds, String::new()),
        Verdict::Undecided { because } => (Word::Undecided, because.clone()),
    };
    Finding { theorem, claim, word, figure: gap.largest, limit, note }
}
