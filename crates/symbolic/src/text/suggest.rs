//! The names that a formula may call, and which name was meant by an unknown one.

use std::ops::RangeInclusive;

use crate::Function;

/// What can be called besides the functions of [`Function`], and with how many arguments.
const OTHERS: [(&str, RangeInclusive<usize>); 16] = [
    ("ln", 1..=1),
    ("sqrt", 1..=1),
    ("sec", 1..=1),
    ("csc", 1..=1),
    ("cot", 1..=1),
    ("atan2", 2..=2),
    ("pow", 2..=2),
    ("step", 4..=4),
    ("dot", 2..=2),
    ("cross", 2..=2),
    ("norm", 1..=1),
    ("transpose", 1..=1),
    ("diag", 2..=usize::MAX),
    ("rotation", 2..=usize::MAX),
    ("angular_velocity", 1..=1),
    ("body_angular_velocity", 1..=1),
];

/// The names that a formula can call.
///
/// ```
/// assert!(symbolic::callable().any(|name| name == "atan2"));
/// ```
pub fn callable() -> impl Iterator<Item = &'static str> {
    Function::NAMES.into_iter().chain(OTHERS.iter().map(|(name, _)| *name))
}

/// How many arguments a function takes.
pub(crate) fn arity(name: &str) -> Option<RangeInclusive<usize>> {
    let other = OTHERS.iter().find(|(known, _)| *known == name).map(|(_, count)| count.clone());
    other.or_else(|| Function::NAMES.contains(&name).then_some(1..=1))
}

/// For a function that is not differentiable: what to write instead.
pub(crate) fn smooth_substitute(name: &str) -> Option<&'static str> {
    match name {
        "abs" => Some("a smooth substitute is sqrt(x^2 + eps^2)"),
        "sign" | "sgn" | "signum" => Some("a smooth substitute is tanh(x/eps)"),
        "heaviside" => Some("a smooth substitute is (1 + tanh(x/eps))/2, or step(t, a, b, width)"),
        "min" => Some("a smooth substitute is (a + b - sqrt((a - b)^2 + eps^2))/2"),
        "max" => Some("a smooth substitute is (a + b + sqrt((a - b)^2 + eps^2))/2"),
        "floor" | "ceil" | "round" | "mod" => Some("it jumps, and nothing smooth stands in its place"),
        _ => None,
    }
}

/// The nearest other of `names` by edit distance (swaps of neighbours: one; case: none), if near enough.
///
/// ```
/// assert_eq!(symbolic::nearest("lagrangain", ["forces", "lagrangian"]).as_deref(), Some("lagrangian"));
/// assert_eq!(symbolic::nearest("length", ["duration"]), None);
/// ```
pub fn nearest<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Option<String> {
    if name.len() > 40 {
        return None;
    }
    let limit = (name.len() / 3).clamp(1, 3);
    names
        .into_iter()
        .filter(|other| *other != name && other.chars().count().abs_diff(name.chars().count()) <= limit)
        .map(|other| (strsim::osa_distance(&name.to_ascii_lowercase(), &other.to_ascii_lowercase()), other))
        .filter(|(distance, other)| *distance <= limit && *distance < other.len().max(2))
        .min_by_key(|(distance, other)| (*distance, primes(other).abs_diff(primes(name))))
        .map(|(_, other)| other.to_owned())
}

fn primes(name: &str) -> usize {
    name.len() - name.trim_end_matches('\'').len()
}
