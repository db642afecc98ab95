//! The names that a formula may call, and which name was meant by an unknown one.

/// The names that can be called.
pub(crate) const FUNCTIONS: [&str; 21] = [
    "sin", "cos", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan", "asinh", "acosh", "atanh", "exp", "log", "ln",
    "sqrt", "sec", "csc", "cot", "atan2", "pow",
];

/// How many arguments a function takes.
pub(crate) fn arity(name: &str) -> Option<usize> {
    match name {
        "atan2" | "pow" => Some(2),
        _ => FUNCTIONS.contains(&name).then_some(1),
    }
}

/// For a function that is not differentiable: what to write instead.
pub(crate) fn smooth_substitute(name: &str) -> Option<&'static str> {
    match name {
        "abs" => Some("a smooth substitute is sqrt(x^2 + eps^2)"),
        "sign" | "sgn" | "signum" => Some("a smooth substitute is tanh(x/eps)"),
        "heaviside" | "step" => Some("a smooth substitute is (1 + tanh(x/eps))/2"),
        "min" => Some("a smooth substitute is (a + b - sqrt((a - b)^2 + eps^2))/2"),
        "max" => Some("a smooth substitute is (a + b + sqrt((a - b)^2 + eps^2))/2"),
        "floor" | "ceil" | "round" | "mod" => Some("it jumps, and nothing smooth stands in its place"),
        _ => None,
    }
}

/// The nearest of `names` by edit distance, if it is near enough to be a slip.
pub(crate) fn nearest<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Option<String> {
    if name.len() > 40 {
        return None;
    }
    let limit = (name.len() / 3).clamp(1, 3);
    names
        .into_iter()
        .map(|other| (edit_distance(name, other), other))
        .filter(|(distance, other)| *distance <= limit && *distance < other.len().max(2))
        .min_by_key(|(distance, other)| (*distance, primes(other).abs_diff(primes(name))))
        .map(|(_, other)| other.to_owned())
}

fn primes(name: &str) -> usize {
    name.len() - name.trim_end_matches('\'').len()
}

/// Insertions, deletions, replacements and swaps of neighbours; letters that differ in case only are
/// equal.
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b) = (a.to_ascii_lowercase().into_bytes(), b.to_ascii_lowercase().into_bytes());
    let mut before = vec![0; b.len() + 1];
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = previous[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(previous[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut previous, row);
    }
    previous[b.len()]
}
