//! Certificates that no constants make the vakonomic motion Chetaev's.

use deltaq::{PlainScene, certificate, holds_beside_numbers};
use integrate::Interrupt;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use scene::Number;

use crate::system::System;
use crate::{background, errors};

#[pymethods]
impl System {
    /// The fields of the certificate, from the start or from almost every one, or why there is none.
    #[pyo3(signature = (almost_every_start))]
    fn _certificate<'py>(
        &self,
        py: Python<'py>,
        almost_every_start: bool,
    ) -> PyResult<(Option<Bound<'py, PyDict>>, Option<String>)> {
        let (scene, interrupt) = (self.scene().clone(), Interrupt::default());
        let work = move || -> Result<_, deltaq::SolveError> {
            let found = certificate(&scene, almost_every_start)?;
            let sound = if found.is_ok() { holds_beside_numbers(&scene) } else { Ok(()) };
            Ok((found, sound))
        };
        let (found, sound) = background::run(py, &interrupt, work)?.map_err(errors::solve)?;
        sound.map_err(|contradicted| errors::DeltaqError::new_err(contradicted.to_string()))?;
        let found = match found {
            Err(reason) => return Ok((None, Some(reason))),
            Ok(found) => found,
        };
        let fields = PyDict::new(py);
        let (exponents, circle, neper) = found.exponents;
        fields.set_item("scene", plain(py, found.scene)?)?;
        fields.set_item("almost_every_start", almost_every_start)?;
        fields.set_item("prime", found.prime)?;
        fields.set_item("unity", found.unity)?;
        fields.set_item("exponents", [("order", exponents), ("e^i", circle), ("e", neper)].into_py_dict(py)?)?;
        fields.set_item("roots", found.roots.into_py_dict(py)?)?;
        fields.set_item("order", found.order)?;
        fields.set_item("rows", found.rows)?;
        fields.set_item("minor", found.minor)?;
        fields.set_item("divided_by", found.divided_by.into_py_dict(py)?)?;
        let set = self.overrides.iter().map(|(name, x)| (name, Number::from(*x).to_string()));
        fields.set_item("set", set.into_py_dict(py)?)?;
        fields.set_item("completed", found.completed)?;
        fields.set_item("motion", found.motion.into_py_dict(py)?)?;
        fields.set_item("reactions", found.reactions)?;
        Ok((Some(fields), None))
    }
}

fn plain(py: Python<'_>, scene: PlainScene) -> PyResult<Bound<'_, PyDict>> {
    let fields = PyDict::new(py);
    fields.set_item("coordinates", scene.coordinates)?;
    fields.set_item("parameters", scene.parameters.into_py_dict(py)?)?;
    fields.set_item("lagrangian", scene.lagrangian)?;
    fields.set_item("constraints", scene.constraints)?;
    fields.set_item("forces", scene.forces.into_py_dict(py)?)?;
    fields.set_item("time", scene.time)?;
    fields.set_item("positions", scene.positions.into_py_dict(py)?)?;
    fields.set_item("velocities", scene.velocities.into_py_dict(py)?)?;
    Ok(fields)
}
