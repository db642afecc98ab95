//! Pages whose words stand in files of their own.

use std::fmt::Display;

/// A template with values in the places of `{{name}}`.
///
/// # Panics
/// Where the template asks for a name that has no value.
///
/// ```
/// use pages::fill;
/// assert_eq!(fill("$g = {{g}}$ m/s²", &[("g", &9.81)]), "$g = 9.81$ m/s²");
/// ```
pub fn fill(template: &str, values: &[(&str, &dyn Display)]) -> String {
    let mut parts = template.split("{{");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").unwrap_or((part, ""));
        let value = values.iter().find(|(known, _)| *known == name);
        let (_, value) = value.unwrap_or_else(|| panic!("nothing stands for `{name}`"));
        text += &value.to_string();
        text += rest;
    }
    text
}
