//! Numbers from the command line in the place of those of the file.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::section::{Source, suggestion};
use crate::{SceneError, SceneErrorKind};

/// Overrides not asked for by anybody are misspelt: each name that is looked up is remembered.
pub(super) struct Overrides {
    values: BTreeMap<String, f64>,
    asked: RefCell<BTreeSet<String>>,
}

impl Overrides {
    pub(super) fn new(source: Source, overrides: &[(String, f64)]) -> Result<Self, SceneError> {
        for (name, value) in overrides {
            if !value.is_finite() {
                let kind = SceneErrorKind::NotFinite { what: format!("the override of `{name}`"), value: *value };
                return Err(SceneError::outside(source.file, kind));
            }
        }
        Ok(Overrides { values: overrides.iter().cloned().collect(), asked: RefCell::default() })
    }

    /// The override of `name`. A name asked for before belongs to whoever asked first.
    pub(super) fn get(&self, name: &str) -> Option<f64> {
        let first = self.asked.borrow_mut().insert(name.into());
        self.values.get(name).copied().filter(|_| first)
    }

    /// All overrides must have been asked for.
    pub(super) fn check_used(&self, source: Source) -> Result<(), SceneError> {
        let asked = self.asked.borrow();
        match self.values.keys().find(|name| !asked.contains(*name)) {
            None => Ok(()),
            Some(name) => {
                let known: Vec<String> = asked.iter().cloned().collect();
                let expected =
                    "parameter, coordinate, start velocity, time, duration or multiplier (mu1, …) to override";
                let suggestion = if name == "t" { Some("time".into()) } else { suggestion(name, &known) };
                let kind = SceneErrorKind::UnknownName { name: name.clone(), expected, suggestion };
                Err(SceneError::outside(source.file, kind))
            }
        }
    }
}
