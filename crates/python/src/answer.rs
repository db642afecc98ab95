//! Answers as JSON, as the program prints them.

use pyo3::PyResult;
use schemars::JsonSchema;
use serde::Serialize;

use crate::errors::DeltaqError;

#[derive(Serialize)]
struct Headed<'a, T> {
    schema: String,
    #[serde(flatten)]
    answer: &'a T,
}

/// With the name of its schema, which is that of the type.
pub(crate) fn typed<T: Serialize + JsonSchema>(answer: &T) -> PyResult<String> {
    let headed = Headed { schema: format!("deltaq/{}", T::schema_name()), answer };
    serde_json::to_string(&headed).map_err(|fault| DeltaqError::new_err(fault.to_string()))
}
