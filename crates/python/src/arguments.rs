//! What is chosen by name: formulation, removal, constants, method.

use comparison::{Extent, Fits};
use equations::Formulation;
use integrate::{Interrupt, Method, Projection};
use mechanics::{ConstantsRule, Removal};
use motion::{Choice, FORM_WORDS, Form, Settings, default_constants, formulation_in, removal_names, removals};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyMapping, PyString};
use scene::Scene;

use crate::arrays::{Floats, list};
use crate::{background, errors};

/// Any mapping, as a dict.
pub(crate) struct Table<'py>(pub(crate) Bound<'py, PyDict>);

/// Any mapping of names to numbers, in its order.
pub(crate) struct Numbers(pub(crate) Vec<(String, f64)>);

impl<'py> FromPyObject<'_, 'py> for Table<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(table) = object.cast::<PyDict>() {
            return Ok(Table(table.to_owned()));
        }
        match object.cast::<PyMapping>() {
            Ok(mapping) => Ok(Table(PyDict::from_sequence(mapping.items()?.as_any())?)),
            Err(_) => Err(PyTypeError::new_err(format!("{} where a dict is expected", object.get_type()))),
        }
    }
}

impl FromPyObject<'_, '_> for Numbers {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let Table(table) = object.extract()?;
        table
            .iter()
            .map(|(name, number)| Ok((name.extract()?, number.extract()?)))
            .collect::<PyResult<_>>()
            .map(Numbers)
    }
}

/// How to integrate, and the flag that ends it.
pub(crate) fn settings(
    method: &str,
    tolerance: f64,
    project: bool,
    max_steps: usize,
    max_step: Option<f64>,
    time_limit: Option<f64>,
) -> PyResult<(Settings, Interrupt)> {
    if let Some(seconds) = time_limit.filter(|seconds| seconds.is_nan() || *seconds <= 0.0) {
        return Err(PyValueError::new_err(format!("time_limit is {seconds}; it must be above 0")));
    }
    let max_step = max_step.unwrap_or(f64::INFINITY);
    if max_step.is_nan() || max_step <= 0.0 {
        return Err(PyValueError::new_err(format!("max_step is {max_step}; it must be above 0")));
    }
    let method = match (Method::ALL.into_iter().find(|m| m.name() == method), method) {
        (None, "auto") => None,
        (None, other) => return Err(unknown("method", other, Method::ALL.into_iter().map(Method::name))),
        (method, _) => method,
    };
    let interrupt = Interrupt::default();
    let settings = Settings {
        tolerance,
        method,
        projection: if project { Projection::EveryStep } else { Projection::Off },
        max_steps,
        max_step,
        time_limit,
        interrupt: Some(interrupt.clone()),
        ..Settings::default()
    };
    settings.check().map_err(errors::solve)?;
    Ok((settings, interrupt))
}

/// Which free constants are fitted, and what a comparison computes.
pub(crate) const FITS: [(&str, Fits); 3] = [("undecided", Fits::Undecided), ("all", Fits::All), ("none", Fits::None)];
pub(crate) const EXTENTS: [(&str, Extent); 3] =
    [("answer", Extent::Answer), ("everything", Extent::Everything), ("gaps", Extent::Gaps)];

/// What a word of the argument `what` stands for.
pub(crate) fn among<T: Copy>(what: &str, word: &str, words: &[(&str, T)]) -> PyResult<T> {
    let found = words.iter().find(|(known, _)| *known == word);
    found.map(|(_, meant)| *meant).ok_or_else(|| unknown(what, word, words.iter().map(|(known, _)| *known)))
}

/// The refusal of a name that is none of those that are known.
pub(crate) fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> PyErr {
    errors::unknown(format!("unknown {what} `{name}`; known: {}", known.collect::<Vec<_>>().join(", ")))
}

/// The formulation of that name.
pub(crate) fn formulation(name: &str) -> PyResult<&'static Formulation> {
    motion::formulation(name).map_err(|error| errors::unknown(error.to_string()))
}

/// The formulation of that name in that form.
pub(crate) fn in_form(word: &str, name: &str) -> PyResult<(&'static Formulation, Form)> {
    if !FORM_WORDS.contains(&word) {
        return Err(unknown("form", word, FORM_WORDS.into_iter()));
    }
    let no_such_form = || PyValueError::new_err(format!("{name} has no form `{word}`"));
    formulation_in(word, formulation(name)?).ok_or_else(no_such_form)
}

/// The choice of a formulation, a removal and constants for a scene, which it comes back with: a removal is
/// derived, and that can take long.
pub(crate) fn choice(
    py: Python<'_>,
    interrupt: &Interrupt,
    scene: Scene,
    (formulation, removal): (&'static Formulation, Option<&str>),
    constants: Option<ConstantsRule>,
) -> PyResult<(Scene, Choice)> {
    background::run(py, interrupt, move || {
        let choice = chosen(&scene, formulation, removal, constants)?;
        Ok((scene, choice))
    })?
}

fn chosen(
    scene: &Scene,
    formulation: &'static Formulation,
    removal: Option<&str>,
    constants: Option<ConstantsRule>,
) -> PyResult<Choice> {
    if removal.is_some() && !formulation.needs_removal() {
        return Err(PyValueError::new_err(format!("the {} formulation takes no removal", formulation.name)));
    }
    let removal = if formulation.needs_removal() { Some(pick(scene, removal)?) } else { None };
    let usual = || removal.as_ref().map_or_else(|| default_constants(formulation, scene), |r| r.constants.clone());
    let constants = constants.unwrap_or_else(usual);
    Ok(Choice { label: formulation.title.into(), formulation, removal, constants })
}

/// The removal of that name, by default the first.
fn pick(scene: &Scene, name: Option<&str>) -> PyResult<Removal> {
    let Some(name) = name else { return Ok(removals(scene).map_err(errors::solve)?.swap_remove(0)) };
    let found = motion::removal(scene, name).map_err(errors::solve)?;
    found.ok_or_else(|| unknown("removal", name, removal_names(scene).into_iter()))
}

/// Free constants from the arguments `constants` and `mu0`.
pub(crate) fn constants(
    constants: Option<&Bound<'_, PyAny>>,
    mu0: Option<Floats<'_>>,
) -> PyResult<Option<ConstantsRule>> {
    match (constants, mu0) {
        (Some(_), Some(_)) => Err(PyTypeError::new_err("either constants or mu0, not both")),
        (None, None) => Ok(None),
        (None, Some(mu0)) => Ok(Some(ConstantsRule::Given(list("mu0", &mu0)?))),
        (Some(rule), None) => rule_from(rule).map(Some),
    }
}

/// The rule as an argument of Python has it.
pub(crate) fn rule_value<'py>(py: Python<'py>, rule: &ConstantsRule) -> PyResult<Bound<'py, PyAny>> {
    match rule {
        ConstantsRule::Zero => "zero".into_bound_py_any(py),
        ConstantsRule::Natural { horizon } => [("horizon", *horizon)].into_py_dict(py).map(Bound::into_any),
        ConstantsRule::Given(values) => values.into_bound_py_any(py),
    }
}

fn rule_from(rule: &Bound<'_, PyAny>) -> PyResult<ConstantsRule> {
    let expected = "constants is none of \"zero\", {\"horizon\": T}, an array of numbers";
    if let Ok(word) = rule.cast::<PyString>() {
        return match &*word.to_cow()? {
            "zero" => Ok(ConstantsRule::Zero),
            other => Err(PyValueError::new_err(format!("{expected}: {other:?}"))),
        };
    }
    if let Ok(Table(table)) = rule.extract() {
        return match (table.len(), table.get_item("horizon")?) {
            (1, Some(horizon)) => Ok(ConstantsRule::Natural { horizon: horizon.extract()? }),
            _ => Err(PyValueError::new_err(format!("{expected}: {table}"))),
        };
    }
    let values: Floats = rule.extract().map_err(|_| PyTypeError::new_err(format!("{expected}: {rule}")))?;
    Ok(ConstantsRule::Given(list("constants", &values)?))
}
