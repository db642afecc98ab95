//! Which rows of the tables the methods of the tools belong to.

use crate::Entrant;

/// The row of ours.
pub(crate) const OURS: &str = "deltaq";
/// The row of heyoka as it comes.
pub(crate) const HEYOKA: &str = "heyoka";

/// Row of a method of an entrant.
pub(crate) fn row(entrant: &Entrant, method: &str, has_trailers: bool) -> String {
    let tool = match entrant.tool {
        "ours" => return if method.starts_with("solve") { "deltaq, `solve` (two runs)".into() } else { OURS.into() },
        "heyoka" => HEYOKA,
        "scipy" if method.ends_with("whole") => "numba, DOP853 compiled whole",
        "scipy" if method.ends_with("numba") => "SciPy, right-hand side by numba",
        "scipy" => "SciPy",
        "sympy" => "SymPy",
        _ if method.starts_with("IDAS") => "CasADi, IDAS",
        _ => "CasADi, CVODES",
    };
    match (has_trailers, entrant.form) {
        (true, "reduced") => format!("{tool}, reduced by hand"),
        (true, _) if entrant.tool != "sympy" => format!("{tool}, multipliers"),
        _ => tool.into(),
    }
}

/// How much faster ours has to be than the peer of a row: not slower than heyoka, three times as fast as any other.
pub(crate) fn demanded(row: &str) -> f64 {
    if row.starts_with(HEYOKA) { 1.0 } else { 3.0 }
}
