//! Numbers as readers like them.

/// Few digits: `0.123`, `12.3`, `1.2e-7`; `0` for zero.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if !x.is_finite() {
        x.to_string()
    } else if (0.001..10_000.0).contains(&x.abs()) {
        let digits = (2 - x.abs().log10().floor() as i32).max(0) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
    } else {
        format!("{x:.1e}")
    }
}

/// One digit, rounded up: what a number is at most. `0` for zero.
pub fn at_most(x: f64) -> f64 {
    let unit = 10f64.powf(x.abs().log10().floor());
    // what the division makes of a whole number is not rounded up again
    let digits = (x / unit * (1.0 - 1e-12)).ceil();
    if x == 0.0 || !x.is_finite() { x } else { format!("{:.0e}", digits * unit).parse().unwrap_or(x) }
}

/// Five significant digits.
pub fn precise(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if (0.001..10_000.0).contains(&x.abs()) {
        let digits = (4 - x.abs().log10().floor() as i32).max(0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.4e}")
    }
}

/// A number or a dash.
pub fn or_dash(x: Option<f64>) -> String {
    x.map_or("–".into(), short)
}

/// `a`, `a and b`, `a, b and c`.
pub fn enumerate(items: &[String]) -> String {
    match items {
        [] => "none".into(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
