//! Numbers from the command line instead of those of the file.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use bodies::Written;

use super::section::{Source, Value, suggestion};
use crate::{Number, SceneError, SceneErrorKind};

/// Overrides not asked for by anybody are misspelt: each name that is looked up is remembered.
pub(super) struct Overrides {
    values: BTreeMap<String, Number>,
    asked: RefCell<BTreeSet<String>>,
}

impl Overrides {
    pub(super) fn new<N: Clone + Into<Number>>(source: Source, overrides: &[(String, N)]) -> Result<Self, SceneError> {
        let mut values = BTreeMap::new();
        for (name, number) in overrides {
            let number: Number = number.clone().into();
            let value = number.value();
            if !value.is_finite() {
                let kind = SceneErrorKind::NotFinite { what: format!("the override of `{name}`"), value };
                return Err(SceneError::outside(source.file, kind));
            }
            values.insert(name.clone(), number);
        }
        Ok(Overrides { values, asked: RefCell::default() })
    }

    /// The override of `name`. A name asked for before belongs to whoever asked first.
    pub(super) fn get(&self, name: &str) -> Option<f64> {
        self.asked(name).map(Number::value)
    }

    /// [`Self::get`] with its formula, where there is one.
    pub(super) fn written(&self, name: &str) -> Option<Value> {
        self.asked(name).map(|number| match number.formula() {
            Some(text) => Value::Expression(Written { text: text.into(), place: 0..0 }),
            None => Value::Number(number.value()),
        })
    }

    fn asked(&self, name: &str) -> Option<&Number> {
        let first = self.asked.borrow_mut().insert(name.into());
        self.values.get(name).filter(|_| first)
    }

    /// All overrides must have been asked for.
    pub(super) fn check_used(&self, source: Source) -> Result<(), SceneError> {
        let asked = self.asked.borrow();
        match self.values.keys().find(|name| !asked.contains(*name)) {
            None => Ok(()),
            Some(name) => {
                let known: Vec<String> = asked.iter().cloned().collect();
                let expected =
                    "parameter, coordinate, start velocity, time, duration or multiplier (mu0_1, …) to override";
                let suggestion = if name == "t" { Some("time".into()) } else { suggestion(name, &known) };
                let kind = SceneErrorKind::UnknownName { name: name.clone(), expected, suggestion };
                Err(SceneError::outside(source.file, kind))
            }
        }
    }
}
