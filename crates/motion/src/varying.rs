//! Equations derived and compiled once, for other starts, free constants and values of some parameters.

use std::f64::consts::GOLDEN_RATIO;

use equations::{Equations, FreeConstant};
use mechanics::{ConstantsRule, Parameter, RemovalProgram, State, System};
use scene::Scene;
use symbolic::limits::BESIDE;
use symbolic::{Evaluator, Symbol};

use crate::constants::{chord, resolve};
use crate::{Choice, Form, Prepared, Settings, SolveError, derive_in_form, setting};

/// A motion of a scene while numbers vary: what is derived and compiled stays.
///
/// ```
/// # let text = include_str!("../../scene/scenes/sledge.toml");
/// use motion::{Settings, Varying, choices};
/// use integrate::Options;
/// use mechanics::ConstantsRule;
/// let scene = scene::Scene::parse("sledge", text)?;
/// let g = scene.system.graph.find_symbol("g").unwrap();
/// let mut varying = Varying::new(&scene, &choices(&scene)[0], &[g], &Settings::default())?;
/// // the sledge turns at a constant rate, whatever g: y = (x, y, phi, …)
/// for g in [1.0, 9.8] {
///     varying.set(&scene.start, &[g], &ConstantsRule::Zero, false)?;
///     let run = varying.prepared_mut().integrate(1.0, &Options::with_tolerance(1e-10))?;
///     let turn = run.solution.dense.end_state()[2] - scene.start.q[2];
///     assert!((turn - 1.1).abs() < 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Varying {
    prepared: Prepared,
    /// Of equations in the variables of a removal: their start.
    removal: Option<RemovalProgram>,
    /// What has to stay positive for the system as it was written, in `q, v, t` and the parameters, and how
    /// that is called.
    domains: Evaluator<f64>,
    domain_names: Vec<String>,
    settings: Settings,
}

impl Varying {
    /// Derives and compiles in the form chosen at the start of `scene`. The parameters that vary are free
    /// constants in the equations, behind the others, in the order of the scene.
    ///
    /// # Errors
    /// As [`crate::solve_choice`]; [`SolveError::Removal`] where the removal holds for the scene's own values
    /// of these parameters only.
    pub fn new(scene: &Scene, choice: &Choice, varied: &[Symbol], settings: &Settings) -> Result<Self, SolveError> {
        let system = &scene.system;
        let (varied, fixed): (Vec<_>, Vec<_>) =
            system.parameters.iter().cloned().partition(|p| varied.contains(&p.symbol));
        let general = System { parameters: fixed, ..system.clone() };
        choice.removal.as_ref().map(|removal| removal.verify(&general)).transpose()?;
        let mut equations = derived(scene, choice, &varied, settings.form)?;
        let mut constants = vec![0.0; equations.free_constants.len()];
        for Parameter { symbol, value, .. } in &varied {
            equations.parameters.remove(symbol);
            equations.free_constants.push(FreeConstant { symbol: *symbol, natural: None, memory: None });
            constants.push(*value);
        }
        let prepared = Prepared::around(setting(scene), equations, constants, varied.len(), settings)?;
        let symbols: Vec<Symbol> = varied.iter().map(|p| p.symbol).collect();
        let removal = prepared.equations.removal.as_ref();
        let removal = removal.map(|removal| RemovalProgram::new(system, removal, &symbols));
        let inputs = [&system.positions()[..], &system.velocities(), &[system.time], &symbols].concat();
        let domains = system.evaluator(&inputs, &system.domains)?;
        let domain_names = system.domains.iter().map(|e| system.graph.plain(*e)).collect();
        Ok(Varying { prepared, removal, domains, domain_names, settings: settings.clone() })
    }

    /// Sets `(t₀, q₀, v₀)`, the parameters that vary and the other free constants. What is natural at a
    /// horizon is looked for from zero on (in an ensemble from the constants of its scene), or, if `near`,
    /// from the constants of the motion before.
    ///
    /// # Errors
    /// [`SolveError`] without a start, or where a formula as written has no value there;
    /// [`SolveError::Member`] for parameters not finite or wrong in number.
    pub fn set(
        &mut self,
        state: &State,
        parameters: &[f64],
        constants: &ConstantsRule,
        near: bool,
    ) -> Result<(), SolveError> {
        let varied = self.prepared.constants.len() - self.constants().len();
        if parameters.len() != varied || !parameters.iter().all(|x| x.is_finite()) {
            let reason = format!("{varied} finite values are needed for the parameters that vary");
            return Err(SolveError::Member { reason });
        }
        let at = [&state.q[..], &state.v, &[state.t], parameters].concat();
        let outside = self.domains.evaluate(&at).iter().zip(&self.domain_names).find(|(value, _)| **value < 0.0);
        if let Some((&value, expression)) = outside {
            return Err(SolveError::OutsideDomain { expression: expression.clone(), value });
        }
        let removal = self.removal.as_mut().map(|removal| removal.start(state, parameters)).transpose()?;
        let prepared = &mut self.prepared;
        prepared.values.set_state(state);
        if let Some(removal) = removal {
            prepared.values.set(&removal.values());
        }
        prepared.t = state.t;
        prepared.set_parameters(parameters);
        let near = near.then(|| prepared.own_constants().to_vec());
        resolve(prepared, constants, &self.settings, None, near.as_deref())
    }

    /// From now on constants that are natural at `horizon` are searched from those of the scene on, by the
    /// Jacobian there.
    pub(crate) fn search_from_here(&mut self, horizon: f64) {
        self.prepared.chord = chord(&mut self.prepared.clone(), horizon, &self.settings);
    }

    /// Sets the parameters that vary and the other free constants, for states of the caller's own: what a
    /// motion starts from stays as it was.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn set_numbers(&mut self, parameters: &[f64], constants: &[f64]) {
        let prepared = &mut self.prepared;
        assert_eq!(parameters.len() + constants.len(), prepared.constants.len(), "numbers");
        prepared.set_parameters(parameters);
        prepared.constants[..constants.len()].copy_from_slice(constants);
        prepared.compiled.set_constants(&prepared.constants);
    }

    /// The equations, compiled and started.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// The same, to be integrated.
    pub fn prepared_mut(&mut self) -> &mut Prepared {
        &mut self.prepared
    }

    /// The free constants but the parameters that vary.
    pub fn constants(&self) -> &[f64] {
        self.prepared.own_constants()
    }
}

/// The equations of `choice` for all values of the parameters that vary.
fn derived(scene: &Scene, choice: &Choice, varied: &[Parameter], form: Form) -> Result<Equations, SolveError> {
    // what vanishes for the values of the scene only has to stay
    let mut system = scene.system.clone();
    let is_varied = |p: &&mut Parameter| varied.iter().any(|varied| varied.symbol == p.symbol);
    for (p, part) in system.parameters.iter_mut().filter(is_varied).zip(1..) {
        p.value += BESIDE * (1.0 + p.value.abs()) * (0.5 + (GOLDEN_RATIO * f64::from(part)).fract());
    }
    Ok(derive_in_form(&system, &scene.start, choice, form)?.0)
}
