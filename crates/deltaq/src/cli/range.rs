//! Equidistant values, and their combinations.

use motion::equidistant_value;
use scene::MOST_ROWS;

/// Equidistant values of something that varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// What varies.
    pub name: String,
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values.
    pub count: usize,
}

impl Range {
    /// Combination number `index` of the values of these ranges, the last one changing fastest, and
    /// how often all combinations have come before it.
    pub fn combined(ranges: &[Range], index: usize) -> (Vec<f64>, usize) {
        let mut rest = index;
        let mut values: Vec<f64> = Vec::with_capacity(ranges.len());
        for range in ranges.iter().rev() {
            values.push(equidistant_value(range.from, range.to, range.count, rest % range.count));
            rest /= range.count;
        }
        values.reverse();
        (values, rest)
    }

    /// How many combinations there are, if not too many.
    pub fn combinations(ranges: &[Range]) -> Option<usize> {
        let count = ranges.iter().try_fold(1_usize, |count, range| count.checked_mul(range.count));
        count.filter(|count| *count <= MOST_ROWS)
    }
}

/// `NAME=FROM:TO:COUNT`, or `NAME=FROM..TO:COUNT`.
pub(super) fn range(text: &str) -> Result<Range, String> {
    let parts = text.split_once('=').and_then(|(name, rest)| {
        let (ends, count) = rest.rsplit_once(':')?;
        let (from, to) = ends.split_once("..").or_else(|| ends.split_once(':'))?;
        Some((name, from, to, count))
    });
    let (name, from, to, count) = parts.ok_or_else(|| format!("`{text}` is not NAME=FROM:TO:COUNT"))?;
    let number = |x: &str| match x.parse::<scene::Number>().map(|number| number.value()) {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("`{x}` in `{text}` is not a finite number")),
        Err(error) => Err(format!("`{x}` in `{text}`: {error}")),
    };
    let count: usize = count.trim().parse().map_err(|_| format!("`{count}` in `{text}` is not a count"))?;
    if !(1..=MOST_ROWS).contains(&count) {
        return Err(format!("`{text}` asks for {count} values; 1 to {MOST_ROWS} are possible"));
    }
    Ok(Range { name: name.trim().into(), from: number(from)?, to: number(to)?, count })
}
