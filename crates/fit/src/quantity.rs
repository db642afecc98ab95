//! Numbers with a unit.

use crate::FitError;

/// Units that may stand behind a number, and their size in m, s, rad and kg.
const UNITS: [(&str, f64); 16] = [
    ("m", 1.0),
    ("dm", 0.1),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("um", 1e-6),
    ("µm", 1e-6),
    ("s", 1.0),
    ("ms", 1e-3),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("rad", 1.0),
    ("mrad", 1e-3),
    ("deg", std::f64::consts::PI / 180.0),
    ("°", std::f64::consts::PI / 180.0),
    ("kg", 1.0),
    ("g", 1e-3),
];

/// The size of a unit in m, s, rad and kg.
///
/// # Errors
/// [`FitError::Quantity`].
pub fn unit(name: &str) -> Result<f64, FitError> {
    let refused = || {
        let units = UNITS.map(|(name, _)| name).join(", ");
        FitError::Quantity { text: name.into(), units }
    };
    UNITS.iter().find(|(known, _)| *known == name).map(|(_, size)| *size).ok_or_else(refused)
}

/// A number, perhaps with a unit behind it, in m, s, rad and kg.
///
/// # Errors
/// [`FitError::Quantity`].
///
/// ```
/// assert_eq!(fit::quantity("0.5 mm"), Ok(0.5e-3));
/// assert!(fit::quantity("1 inch").is_err());
/// ```
pub fn quantity(text: &str) -> Result<f64, FitError> {
    let text = text.trim();
    // the longest beginning that is a number
    let ends = text.char_indices().map(|(i, _)| i).skip(1).chain([text.len()]);
    let number = |end: usize| text[..end].trim_end().parse::<f64>().ok().filter(|x| x.is_finite());
    let refused = |_| FitError::Quantity { text: text.into(), units: UNITS.map(|(name, _)| name).join(", ") };
    let (value, end) = ends.filter_map(|end| Some((number(end)?, end))).last().ok_or(()).map_err(refused)?;
    match text[end..].trim() {
        "" => Ok(value),
        rest => Ok(value * unit(rest).map_err(|_| refused(()))?),
    }
}
