//! Somebody's equations, reviewed.

use integrate::Interrupt;
use pyo3::prelude::*;
use review::{Asked, Reviewed, review, states};
use stubs::stubbed;

use crate::answer::typed;
use crate::system::System;
use crate::{arguments, background, errors};

/// `(t, q, v)`.
type Plain = (f64, Vec<f64>, Vec<f64>);

#[stubbed]
impl System {
    /// What `review` finds, as JSON.
    fn _review(
        &self,
        py: Python<'_>,
        file: String,
        text: String,
        wheres: Vec<String>,
        formulation: &str,
        tolerance: f64,
    ) -> PyResult<String> {
        let asked = Asked { formulation: arguments::formulation(formulation)?, wheres, tolerance };
        let (scene, interrupt) = (self.scene()?, Interrupt::default());
        let work = move || {
            let found = review(&scene, &file, &text, &asked);
            let found = found.map_err(|fault| errors::DeltaqError::new_err(fault.to_string()))?;
            typed(&Reviewed { scene: &scene.name, file: &file, found: &found })
        };
        background::run(py, &interrupt, work)?
    }

    /// States at which a program can be asked for its accelerations.
    fn _review_states(&self) -> PyResult<Vec<Plain>> {
        let scene = self.scene()?;
        Ok(states(&scene).into_iter().map(|state| (state.t, state.q, state.v)).collect())
    }
}
