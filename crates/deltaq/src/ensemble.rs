//! Ensembles: many starts and parameters of one system at once, over vector lanes and processor cores.

mod motions;
mod run;
#[cfg(test)]
mod tests;
mod threads;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use equations::{Compiled, Equations, FreeConstant, LaneEquations};
use integrate::{Method, Start};
use mechanics::{ConstantsRule, State, System, complete_removal_start};
use scene::Scene;

use crate::constants::free_constants;
use crate::{Choice, Metric, Prepared, Settings, SolveError, constants_of, derive_in_form, setting};
pub use motions::MemberMotion;
pub use run::{EnsembleOptions, MemberRun};
pub use threads::{number_of_threads, over_threads};

/// Equations of a scene in one formulation, derived and compiled once for members that differ by start, by
/// the values of some parameters, by free constants and by duration.
///
/// [`Method::Taylor`] integrates eight members at a time. One that does not go well in company is integrated
/// alone, and says so ([`MemberRun::alone`]): where the form of the equations is not to be trusted, at
/// singularities, always where a block is left to solve numerically ([`Ensemble::refusal`]).
///
/// ```
/// # let text = include_str!("../../../validation/scenes/sledge.toml");
/// use deltaq::{Ensemble, EnsembleOptions, Settings, choices};
/// let scene = |g, phi| scene::Scene::parse_with("sledge", text, &[("g".into(), g), ("phi".into(), phi)]);
/// let base = scene(9.81, 0.3)?;
/// let mut ensemble = Ensemble::new(&base, &choices(&base)[0], &["g"], &Settings::default())?;
/// let mut members = Vec::new();
/// for i in 0..20 {
///     members.push(ensemble.member(&scene(9.0 + 0.1 * i as f64, 0.05 * i as f64)?)?);
/// }
/// // the sledge turns at a constant rate, y = (x, y, phi, …)
/// for (i, run) in ensemble.run(&members, &[1.0], &EnsembleOptions::default()).into_iter().enumerate() {
///     assert!((run?.states[0][2] - (1.1 + 0.05 * i as f64)).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Ensemble {
    prepared: Prepared,
    lanes: Result<LaneEquations, String>,
    choice: Choice,
    /// With the parameters of the scene.
    system: System,
    /// Those parameters of it that vary.
    varied: Vec<usize>,
    settings: Settings,
    metric: Metric,
    /// The equations once more, in whose words a member says why it stopped: for all threads.
    words: Arc<Mutex<Equations>>,
}

/// What a member starts from.
#[derive(Clone, Debug)]
pub struct EnsembleStart {
    /// `(t₀, q₀, v₀)`, on the constraint.
    pub state: State,
    /// Time at which it is to end.
    pub end: f64,
    /// Values of the parameters that vary, in the order in which they were named.
    pub parameters: Vec<f64>,
    /// Free constants.
    pub constants: ConstantsRule,
}

impl EnsembleStart {
    /// The start of `scene` with the values that these parameters have there.
    pub fn of(scene: &Scene, parameters: &[&str], constants: ConstantsRule) -> Self {
        let system = &scene.system;
        let value = |name: &&str| system.parameters.iter().find(|p| system.graph.name(p.symbol) == *name);
        let parameters = parameters.iter().filter_map(value).map(|p| p.value).collect();
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
}

impl EnsembleMember {
    /// `y(t₀)`.
    pub fn start(&self) -> &[f64] {
        &self.y
    }
}

impl Ensemble {
    /// Derives and compiles in the form chosen at the start of `scene`, which should be one of the members.
    ///
    /// [`Settings::method`] counts for nothing.
    ///
    /// # Errors
    /// As [`crate::solve_choice`]; [`SolveError::Member`] where a name is no parameter, or where parameters
    /// are to vary and the constants are natural at a horizon.
    pub fn new(scene: &Scene, choice: &Choice, parameters: &[&str], settings: &Settings) -> Result<Self, SolveError> {
        let (mut equations, _) = derive_in_form(&scene.system, &scene.start, choice, settings.form)?;
        let system = scene.system.clone();
        if !parameters.is_empty() && matches!(choice.constants, ConstantsRule::Natural { .. }) {
            let reason = "its constants are natural at a horizon, for which parameters have to be the same";
            return Err(SolveError::Member { reason: reason.into() });
        }
        let mut varied = Vec::new();
        let mut constants = vec![0.0; equations.free_constants.len()];
        for name in parameters {
            let place = system.parameters.iter().position(|p| system.graph.name(p.symbol) == *name);
            let Some(place) = place.filter(|place| !varied.contains(place)) else {
                return Err(SolveError::Member { reason: format!("`{name}` is no parameter, or named twice") });
            };
            let symbol = system.parameters[place].symbol;
            equations.parameters.remove(&symbol);
            equations.free_constants.push(FreeConstant { symbol, natural: None, memory: None });
            constants.push(system.parameters[place].value);
            varied.push(place);
        }
        let settings = Settings { method: Some(Method::Taylor), ..settings.clone() };
        let prepared = Prepared::around(setting(scene), equations, constants, &settings)?;
        let start = Start { t: scene.start.t, y: prepared.start.clone() };
        integrate::check_start(&start, setting(scene).end, &settings.options(settings.tolerance))?;
        let point = [&[start.t], &start.y[..], &prepared.constants].concat();
        let lanes = match system.breakpoints.is_empty() {
            true => LaneEquations::new(&prepared.equations, &prepared.form, &point)?,
            false => Err("the system has breakpoints, at which a motion begins anew".into()),
        };
        let symbols: Vec<_> = varied.iter().map(|&place| system.parameters[place].symbol).collect();
        let metric = Metric::varying(&system, &symbols)?;
        let words = Arc::new(Mutex::new(prepared.equations.clone()));
        Ok(Ensemble { prepared, lanes, choice: choice.clone(), system, varied, settings, metric, words })
    }

    /// Why no member can be integrated in company, if that is so.
    pub fn refusal(&self) -> Option<&str> {
        self.lanes.as_ref().err().map(String::as_str)
    }

    /// The equations of all members; parameters that vary are free constants in them, behind the others.
    pub fn equations(&self) -> &Equations {
        &self.prepared.equations
    }

    /// The equations compiled.
    pub fn compiled(&self) -> &Compiled {
        &self.prepared.compiled
    }

    /// The member `scene`, with other numbers; its multipliers are free constants if motions start from them.
    ///
    /// # Errors
    /// As [`Ensemble::member_at`]; [`SolveError::Member`] if another parameter than the varying has changed.
    pub fn member(&mut self, scene: &Scene) -> Result<EnsembleMember, SolveError> {
        if scene.system.parameters.len() != self.system.parameters.len() {
            return Err(SolveError::Member { reason: "another scene".into() });
        }
        for (i, (now, base)) in scene.system.parameters.iter().zip(&self.system.parameters).enumerate() {
            if now.value != base.value && !self.varied.contains(&i) {
                let name = self.system.graph.name(base.symbol);
                let reason = format!("{name} is {} and not {}, and is not among what varies", now.value, base.value);
                return Err(SolveError::Member { reason });
            }
        }
        let names: Vec<String> =
            self.varied.iter().map(|&i| self.system.graph.name(self.system.parameters[i].symbol)).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        self.member_at(&EnsembleStart::of(scene, &names, constants_of(&self.choice, scene)))
    }

    /// The member that starts there.
    ///
    /// # Errors
    /// [`SolveError`] without a start; [`SolveError::Member`] for parameters not finite or wrong in number.
    pub fn member_at(&mut self, start: &EnsembleStart) -> Result<EnsembleMember, SolveError> {
        let EnsembleStart { state, end, parameters, constants } = start;
        let end = *end;
        if parameters.len() != self.varied.len() || !parameters.iter().all(|x| x.is_finite()) {
            let reason = format!("{} finite values are needed for the parameters that vary", self.varied.len());
            return Err(SolveError::Member { reason });
        }
        for (&place, value) in self.varied.iter().zip(parameters) {
            self.system.parameters[place].value = *value;
        }
        let mut values = self.system.values_at(state);
        if let Some(removal) = &self.prepared.equations.removal {
            values.extend(complete_removal_start(&self.system, removal, state)?.values());
        }
        let prepared = &mut self.prepared;
        prepared.values.set(&values);
        prepared.t = state.t;
        let free = &mut prepared.equations.free_constants;
        let of_parameters = free.split_off(free.len() - parameters.len());
        let resolved = free_constants(prepared, constants, &self.settings);
        prepared.equations.free_constants.extend(of_parameters);
        let mut constants = resolved?;
        constants.extend(parameters);
        prepared.set_constants(constants.clone());
        let (y, guess) = (prepared.start.clone(), prepared.guess.clone());
        Ok(EnsembleMember { t: state.t, end, y, constants, guess })
    }

    /// [`Ensemble::member_at`] of all of them, over threads as [`EnsembleOptions::threads`] says: constants
    /// that are natural at a horizon take longer to find than a motion to integrate.
    pub fn members(&self, starts: &[EnsembleStart], threads: usize) -> Vec<Result<EnsembleMember, SolveError>> {
        let threads = number_of_threads(threads).clamp(1, starts.len().max(1));
        let copies: Vec<Mutex<Ensemble>> = (0..threads).map(|_| Mutex::new(self.clone())).collect();
        let next = AtomicUsize::new(0);
        let members = threads::shared(threads, starts.len(), 1, |take| {
            let copy = &copies[next.fetch_add(1, Ordering::Relaxed) % threads];
            let mut copy = copy.lock().unwrap_or_else(PoisonError::into_inner);
            std::iter::from_fn(take).map(|index| (index, copy.member_at(&starts[index]))).collect()
        });
        members.into_iter().flatten().collect()
    }
}

impl EnsembleMember {
    fn set(&self, compiled: &mut Compiled) {
        compiled.set_constants(&self.constants);
        if compiled.needs_guess() {
            compiled.set_guess(&self.guess);
        }
    }
}
