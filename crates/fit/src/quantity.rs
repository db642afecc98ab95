//! Numbers with a unit.

use scene::Scene;

use crate::FitError;

/// Units that may stand behind a number: what they are of, and their size in that.
const UNITS: [(&str, &str, f64); 16] = [
    ("m", "m", 1.0),
    ("dm", "m", 0.1),
    ("cm", "m", 1e-2),
    ("mm", "m", 1e-3),
    ("um", "m", 1e-6),
    ("µm", "m", 1e-6),
    ("s", "s", 1.0),
    ("ms", "s", 1e-3),
    ("us", "s", 1e-6),
    ("µs", "s", 1e-6),
    ("rad", "rad", 1.0),
    ("mrad", "rad", 1e-3),
    ("deg", "rad", std::f64::consts::PI / 180.0),
    ("°", "rad", std::f64::consts::PI / 180.0),
    ("kg", "kg", 1.0),
    ("g", "kg", 1e-3),
];

fn names() -> String {
    UNITS.map(|(name, ..)| name).join(", ")
}

/// The size of a unit in m, s, rad and kg.
///
/// # Errors
/// [`FitError::Quantity`].
pub fn unit(name: &str) -> Result<f64, FitError> {
    let known = UNITS.iter().find(|(known, ..)| *known == name);
    known.map(|(.., size)| *size).ok_or_else(|| FitError::Quantity { text: name.into(), units: names() })
}

/// One of this unit in units of a column of the scene: of a coordinate or velocity by its label, `mm`; of
/// another column where no label of the scene is another unit than m, s, rad or kg.
///
/// # Errors
/// [`FitError::Quantity`], and [`FitError::Unit`] where label and unit are of different kinds.
pub(crate) fn unit_of(scene: &Scene, column: &str, name: &str) -> Result<f64, FitError> {
    let size = unit(name)?;
    let of = |label: &str| UNITS.iter().find(|(known, ..)| *known == label).map(|(_, kind, size)| (*kind, *size));
    let (kind, _) = of(name).unwrap_or(("", size));
    let refused = |label: &str| FitError::Unit { column: column.into(), unit: name.into(), label: label.into() };
    if column == "t" {
        return if kind == "s" { Ok(size) } else { Err(refused("s")) };
    }
    let plain = column.strip_suffix('\'').unwrap_or(column);
    let labels = || scene.system.coordinates.iter().map(|c| (c.name.as_str(), c.unit.as_str()));
    let own = labels().find(|(own, label)| *own == plain && !label.is_empty());
    let others = || labels().map(|(_, label)| label).find(|label| of(label).is_some_and(|(_, size)| size != 1.0));
    match own.map(|(_, label)| (label, of(label))) {
        Some((_, Some((same, whole)))) if same == kind => Ok(size / whole),
        Some((label, _)) => Err(refused(label)),
        None => others().map_or(Ok(size), |label| Err(refused(label))),
    }
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
    let (value, name) = split(text)?;
    Ok(value * name.map_or(Ok(1.0), unit)?)
}

/// A number and the unit behind it.
pub(crate) fn split(text: &str) -> Result<(f64, Option<&str>), FitError> {
    let text = text.trim();
    // the longest beginning that is a number
    let ends = text.char_indices().map(|(i, _)| i).skip(1).chain([text.len()]);
    let number = |end: usize| text[..end].trim_end().parse::<f64>().ok().filter(|x| x.is_finite());
    let refused = |_| FitError::Quantity { text: text.into(), units: names() };
    let (value, end) = ends.filter_map(|end| Some((number(end)?, end))).last().ok_or(()).map_err(refused)?;
    match text[end..].trim() {
        "" => Ok((value, None)),
        rest => unit(rest).map(|_| (value, Some(rest))).map_err(|_| refused(())),
    }
}
