//! Certificates that no constants make the vakonomic motion Chetaev's; measures and integrals.

use comparison::{certificate, holds_beside_numbers};
use integrals::{Integrals, NoAnswer, NoMultipliers, Open};
use integrate::Interrupt;
use pyo3::prelude::*;
use scene::Number;
use stubs::stubbed;

use crate::answer::typed;
use crate::system::System;
use crate::{arguments, background, errors};

#[stubbed]
impl System {
    /// The certificate as JSON, from the start or from almost every one, or why there is none.
    fn _certificate(&self, py: Python<'_>, almost_every_start: bool) -> PyResult<(Option<String>, Option<String>)> {
        let (scene, interrupt) = (self.scene()?, Interrupt::default());
        let work = move || -> Result<_, motion::SolveError> {
            let found = certificate(&scene, almost_every_start)?;
            let sound = if found.is_ok() { holds_beside_numbers(&scene) } else { Ok(()) };
            Ok((found, sound))
        };
        let (found, sound) = background::run(py, &interrupt, work)?.map_err(errors::solve)?;
        sound.map_err(|contradicted| errors::DeltaqError::new_err(contradicted.to_string()))?;
        Ok(match found {
            Err(reason) => (None, Some(reason)),
            Ok(found) => (Some(typed(&NoMultipliers::of(&found, &self.set()))?), None),
        })
    }

    /// What is computed by `integrals`, as JSON.
    fn _integrals(&self, py: Python<'_>, formulation: &str, degree: u8, names: Vec<String>) -> PyResult<String> {
        let (interrupt, own) = (Interrupt::default(), arguments::formulation(formulation)?);
        let (scene, choice) = arguments::choice(py, &interrupt, self.scene()?, (own, None), None)?;
        let work = move || Integrals::find(&scene, &choice, degree.into(), &names);
        let found = background::run(py, &interrupt, work)?.map_err(|fault| match fault {
            NoAnswer::Open(Open::Name { .. }) => errors::unknown(fault.to_string()),
            NoAnswer::Equations(fault) => errors::solve(fault),
            other => errors::DeltaqError::new_err(other.to_string()),
        })?;
        typed(&found.answer())
    }
}

impl System {
    /// Numbers that were set, as they were written.
    fn set(&self) -> Vec<(String, String)> {
        self.overrides.iter().map(|(name, x)| (name.clone(), Number::from(*x).to_string())).collect()
    }
}
