//! Ensembles: many starts and parameters of one system at once, over vector lanes and processor cores.

mod motions;
mod reading;
mod run;
mod singly;
mod threads;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use equations::{Compiled, Equations, LaneEquations, Plan};
use integrate::{Interrupt, Method};
use mechanics::{ConstantsRule, State, System};
use scene::Scene;
use symbolic::caught;

use crate::by_name::{Beginning, ByName};
use crate::{Choice, Metric, Prepared, Settings, SolveError, setting};
pub use motions::{MemberMotion, instants};
pub use run::{EnsembleOptions, MemberRun};
pub use threads::{number_of_threads, over_threads};

/// Equations of a scene in one formulation, derived and compiled once for members that differ by start, by
/// the values of some parameters, by free constants and by duration.
///
/// [`Method::Taylor`] integrates eight members at a time. One that does not go well in company is integrated
/// alone, and says so ([`MemberRun::alone`]): where the form of the equations is not to be trusted, at
/// singularities, always where a block is left to solve numerically ([`Ensemble::refusal`]). One whose pivots
/// vanish at its start, or on its way while its error is estimated, is a motion of its own, as of
/// [`crate::solve_choice`], and goes on where that does.
///
/// ```
/// # let text = include_str!("../../scene/scenes/sledge.toml");
/// use motion::{Ensemble, EnsembleOptions, Settings, choices};
/// let scene = scene::Scene::parse("sledge", text)?;
/// let ensemble = Ensemble::new(&scene, &choices(&scene)[0], &["g", "phi"], &Settings::default())?;
/// let rows: Vec<[f64; 2]> = (0..20).map(|i| [9.0 + 0.1 * i as f64, 0.05 * i as f64]).collect();
/// let options = EnsembleOptions::default();
/// let motions = ensemble.answers(ensemble.members(&rows, options.threads), &[1.0], &options);
/// // the sledge turns at a constant rate
/// for ([_, phi], motion) in rows.iter().zip(motions) {
///     assert!((motion?.outputs[0].coordinates[2] - (1.1 + phi)).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Ensemble {
    by_name: ByName,
    lanes: Result<LaneEquations, String>,
    system: System,
    end: f64,
    settings: Settings,
    metric: Metric,
    /// The equations once more, in whose words a member says why it stopped: for all threads.
    words: Arc<Mutex<Equations>>,
}

/// What a member starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsembleStart {
    /// `(t₀, q₀, v₀)`, on the constraint.
    pub state: State,
    /// Time at which it is to end.
    pub end: f64,
    /// Values of the parameters that vary, in the order of the scene.
    pub parameters: Vec<f64>,
    /// Free constants.
    pub constants: ConstantsRule,
}

impl EnsembleStart {
    /// The start of `scene` with the values that these parameters have there.
    pub fn of(scene: &Scene, parameters: &[&str], constants: ConstantsRule) -> Self {
        let system = &scene.system;
        let varies = |symbol| parameters.contains(&system.graph.name(symbol).as_str());
        let parameters = system.parameters.iter().filter(|p| varies(p.symbol)).map(|p| p.value).collect();
        EnsembleStart { state: scene.start.clone(), end: setting(scene).end, parameters, constants }
    }
}

/// A member, ready to run.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsembleMember {
    t: f64,
    end: f64,
    y: Vec<f64>,
    /// Free constants, then the parameters that vary.
    constants: Vec<f64>,
    guess: Vec<f64>,
    /// What it was started from, for a motion of its own.
    given: EnsembleStart,
}

impl EnsembleMember {
    /// `y(t₀)`.
    pub fn start(&self) -> &[f64] {
        &self.y
    }

    /// The same member from another `y(t₀)`.
    #[must_use]
    pub fn starting_at(self, y: Vec<f64>) -> Self {
        EnsembleMember { y, ..self }
    }

    /// Values of the free constants, then of the parameters that vary.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }
}

impl Ensemble {
    /// Derives and compiles in the form chosen at the start of `scene`, which should be one of the members;
    /// they differ from it by the numbers of these names, as of [`Scene::starts`], or `P0_w` for the costate
    /// of the memory variable `w` of a removal.
    ///
    /// [`Settings::method`] counts for nothing.
    ///
    /// # Errors
    /// As [`crate::solve_choice`]; [`SolveError::Scene`] where the scene has no such name;
    /// [`SolveError::Member`] where a name comes twice, where multipliers or costates are to vary that the
    /// formulation does not start from.
    pub fn new(scene: &Scene, choice: &Choice, names: &[&str], settings: &Settings) -> Result<Self, SolveError> {
        let settings = Settings { method: Some(Method::Taylor), ..settings.clone() };
        let mut by_name = ByName::new(scene, choice, names, &settings)?;
        if let ConstantsRule::Natural { horizon } = by_name.choice().constants {
            by_name.varying_mut().search_from_here(horizon);
        }
        let Prepared { equations, form, constants, start, .. } = by_name.varying().prepared();
        let start = integrate::Start { t: scene.start.t, y: start.clone() };
        integrate::check_start(&start, setting(scene).end, &settings.options(settings.tolerance))?;
        let point = [&[start.t], &start.y[..], constants].concat();
        let system = scene.system.clone();
        let lanes = match system.breakpoints.is_empty() {
            true if form.left.is_empty() => LaneEquations::new(equations, form, &point)?,
            true => LaneEquations::new(equations, &Plan::eliminated(equations, Some(&point))?, &point)?,
            false => Err("the system has breakpoints, at which a motion begins anew".into()),
        };
        let metric = Metric::varying(&system, &by_name.parameters())?;
        let words = Arc::new(Mutex::new(equations.clone()));
        let end = setting(scene).end;
        Ok(Ensemble { by_name, lanes, system, end, settings, metric, words })
    }

    /// Members end at `end`, and not where the scene does.
    pub fn until(self, end: f64) -> Self {
        Ensemble { end, ..self }
    }

    /// Why no member can be integrated in company, if that is so.
    pub fn refusal(&self) -> Option<&str> {
        self.lanes.as_ref().err().map(String::as_str)
    }

    /// The equations of all members; parameters that vary are free constants in them, behind the others.
    pub fn equations(&self) -> &Equations {
        &self.by_name.varying().prepared().equations
    }

    /// The equations compiled.
    pub fn compiled(&self) -> &Compiled {
        &self.by_name.varying().prepared().compiled
    }

    /// The member that starts there.
    ///
    /// # Errors
    /// [`SolveError`] without a start; [`SolveError::Member`] for parameters not finite or wrong in number.
    pub fn member_at(&mut self, start: &EnsembleStart) -> Result<EnsembleMember, SolveError> {
        let EnsembleStart { state, end, parameters, constants } = start;
        self.by_name.varying_mut().set(state, parameters, constants, false)?;
        let rule = constants.clone();
        let Prepared { start, constants, guess, .. } = self.by_name.varying().prepared();
        let (y, constants, guess) = (start.clone(), constants.clone(), guess.clone());
        let given = EnsembleStart { state: state.clone(), end: *end, parameters: parameters.clone(), constants: rule };
        Ok(EnsembleMember { t: state.t, end: *end, y, constants, guess, given })
    }

    /// The member with these numbers, one per name, or why there is none.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn member(&mut self, row: &[f64]) -> Result<EnsembleMember, String> {
        let cause = self.settings.interrupt.as_ref().and_then(Interrupt::cause);
        cause.map_or(Ok(()), |cause| Err(cause.to_string()))?;
        let Beginning { state, parameters, constants } =
            self.by_name.beginning(row).map_err(|fault| fault.to_string())?;
        let start = EnsembleStart { state, end: self.end, parameters, constants };
        self.member_at(&start).map_err(|error| error.to_string())
    }

    /// The members with these numbers, or why there are none, over threads as [`EnsembleOptions::threads`]
    /// says: constants that are natural at a horizon take longer to find than a motion to integrate.
    ///
    /// # Panics
    /// If a row has not as many numbers as there are names.
    pub fn members<R: AsRef<[f64]> + Sync>(&self, rows: &[R], threads: usize) -> Vec<Result<EnsembleMember, String>> {
        let threads = number_of_threads(threads).clamp(1, rows.len().max(1));
        let copies: Vec<Mutex<Ensemble>> = (0..threads).map(|_| Mutex::new(self.clone())).collect();
        let next = AtomicUsize::new(0);
        let members = threads::shared(threads, rows.len(), 1, |take| {
            let copy = &copies[next.fetch_add(1, Ordering::Relaxed) % threads];
            let mut copy = copy.lock().unwrap_or_else(PoisonError::into_inner);
            let mut member = |row| caught("row", || copy.member(row)).unwrap_or_else(|broken| Err(broken.to_string()));
            std::iter::from_fn(take).map(|index| (index, member(rows[index].as_ref()))).collect()
        });
        members.into_iter().flatten().collect()
    }
}

impl EnsembleMember {
    /// Sets its constants and its guess in the equations of the ensemble, compiled.
    pub fn set(&self, compiled: &mut Compiled) {
        compiled.set_constants(&self.constants);
        if compiled.needs_guess() {
            compiled.set_guess(&self.guess);
        }
    }
}

impl std::fmt::Debug for Ensemble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Ensemble").field("end", &self.end).finish_non_exhaustive()
    }
}
