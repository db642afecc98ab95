//! Free constants: zero, given, or natural at a horizon.

mod transversality;

use equations::Equations;
use mechanics::ConstantsRule;

use crate::{Prepared, Setting, Settings, SolveError};
use transversality::natural_constants;
pub use transversality::searched;
pub(crate) use transversality::{chord, places};

/// Compiles `equations` and computes what they start from. Nothing is integrated, unless the constants are
/// natural at a horizon; that is done as `settings` say.
///
/// # Errors
/// [`SolveError`] where there is no start.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// use motion::{Settings, choices, derive, prepare, setting};
/// // the ice sledge turns at a constant rate, y = (x, y, phi, x', y', phi')
/// let chetaev = choices(&scene).remove(0);
/// let equations = derive(&scene.system, &chetaev)?;
/// let mut prepared = prepare(setting(&scene), equations, &chetaev.constants, &Settings::default())?;
/// let mut rates = [0.0; 6];
/// prepared.compiled.rates(0.0, &prepared.start, &mut rates)?;
/// assert_eq!((rates[2], rates[5]), (1.0, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn prepare(
    setting: Setting,
    equations: Equations,
    constants: &ConstantsRule,
    settings: &Settings,
) -> Result<Prepared, SolveError> {
    let mut prepared = Prepared::new(setting, equations, settings)?;
    resolve(&mut prepared, constants, settings, Some(setting), None)?;
    Ok(prepared)
}

/// Sets the free constants as `rule` says; those that are natural are looked for from `near` on, or zero, and
/// where a `setting` is known by motions that go from chart to chart.
pub(crate) fn resolve(
    prepared: &mut Prepared,
    rule: &ConstantsRule,
    settings: &Settings,
    setting: Option<Setting>,
    near: Option<&[f64]>,
) -> Result<(), SolveError> {
    let own = prepared.own_constants().len();
    let constants = match rule {
        ConstantsRule::Zero => vec![0.0; own],
        ConstantsRule::Given(values) => given_constants(&prepared.equations, own, values)?,
        ConstantsRule::Natural { horizon } => natural_constants(prepared, *horizon, settings, setting, near)?,
    };
    prepared.set_constants(&constants);
    Ok(())
}

/// One value per free constant, or one per memory variable (then those without a costate have to be zero).
fn given_constants(equations: &Equations, own: usize, values: &[f64]) -> Result<Vec<f64>, SolveError> {
    let constants = &equations.free_constants[..own];
    if let Some(&value) = values.iter().find(|x| !x.is_finite()) {
        return Err(SolveError::ConstantNotFinite { formulation: equations.formulation.into(), value });
    }
    if values.len() == constants.len() {
        return Ok(values.to_vec());
    }
    let memory = equations.removal.as_ref().map(|r| r.memory.len());
    let used: Vec<Option<usize>> = constants.iter().map(|c| c.memory).collect();
    let unused_are_zero = values.iter().enumerate().all(|(i, &x)| x == 0.0 || used.contains(&Some(i)));
    if Some(values.len()) == memory && unused_are_zero {
        return Ok(used.into_iter().map(|i| i.map_or(0.0, |i| values[i])).collect());
    }
    Err(SolveError::ConstantCount {
        formulation: equations.formulation.into(),
        expected: constants.len(),
        names: constant_names(equations)[..own].join(", "),
        found: values.len(),
    })
}

/// Names of the free constants.
pub fn constant_names(equations: &Equations) -> Vec<String> {
    equations.free_constants.iter().map(|c| equations.graph.name(c.symbol)).collect()
}
