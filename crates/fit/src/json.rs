//! Answers as JSON, printed by the command and read by Python. Infinite numbers are null.

use scene::Scene;
use serde_json::{Value, json};

use crate::{Aim, Best, Design, Film, Fit, Identifiability, Point, Row, Verdict, significance};

impl Verdict {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Verdict::Supported => "supported".into(),
            Verdict::Excluded { sigmas } => format!("excluded at {}", significance(*sigmas)),
            Verdict::Unsettled { sigmas } => {
                let sigmas = significance(*sigmas);
                format!("search not settled: excluded at {sigmas}, if the least χ² that was found is the least")
            }
            Verdict::Explained { with: None, from } => format!("these films cannot tell it from {}", from.join(", ")),
            Verdict::Explained { with: Some(with), from } => {
                format!("these films cannot tell it, with {with}, from {}; without, it is excluded", from.join(", "))
            }
            Verdict::CannotTell { from, needs } => {
                let each = from.iter().zip(needs).map(|(label, needs)| match needs {
                    Some(longer) => format!("{label} (if that is right, a film {longer} times as long can)"),
                    None => format!("{label} (no film up to 8 times as long was found that can)"),
                });
                format!("these films cannot tell it from {}", each.collect::<Vec<_>>().join(", "))
            }
            Verdict::None => "no verdict".into(),
            Verdict::NotFitted(error) => format!("not fitted: {error}"),
        }
    }
}

/// The answer of `deltaq fit`, by its schema.
pub fn fit_value(scene: &Scene, films: &[Film], rows: &[Row]) -> Value {
    let films: Vec<Value> = films.iter().map(film).collect();
    let rows: Vec<Value> = rows.iter().map(row).collect();
    json!({ "scene": scene.name, "films": films, "formulations": rows })
}

fn columns(film: &Film) -> Vec<Value> {
    film.columns.iter().map(|c| json!({ "name": c.name, "sigma": c.sigma, "estimated": c.estimated })).collect()
}

fn film(film: &Film) -> Value {
    json!({ "file": film.name, "samples": film.t.len(), "numbers": film.count(), "columns": columns(film) })
}

fn row(row: &Row) -> Value {
    let verdict = match &row.verdict {
        Verdict::Supported => "supported",
        Verdict::Excluded { .. } => "excluded",
        Verdict::Unsettled { .. } => "not-settled",
        Verdict::CannotTell { .. } | Verdict::Explained { .. } => "cannot-tell",
        Verdict::None => "none",
        Verdict::NotFitted(_) => "not-fitted",
    };
    json!({
        "formulation": row.choice.formulation.name,
        "label": row.choice.label,
        "verdict": verdict,
        "words": row.verdict.words(),
        "from": match &row.verdict { Verdict::CannotTell { from, .. } | Verdict::Explained { from, .. } => from.clone(), _ => Vec::new() },
        "needs": match &row.verdict { Verdict::CannotTell { needs, .. } => needs.clone(), _ => Vec::new() },
        "sigmas": match row.verdict { Verdict::Excluded { sigmas } | Verdict::Unsettled { sigmas } => Some(sigmas), _ => None },
        "notes": row.notes,
        "shown": row.shown.as_ref().map(shown),
        "fit": row.fit.as_ref().ok().map(fitted),
    })
}

fn shown(shown: &Identifiability) -> Value {
    let (answer, hidden, order) = match shown {
        Identifiability::Proved { .. } => ("proved", Vec::new(), None),
        Identifiability::Hidden { combinations, order } => ("hidden", combinations.clone(), Some(*order)),
        Identifiability::Open(_) => ("open", Vec::new(), None),
    };
    json!({ "answer": answer, "hidden": hidden, "order": order, "words": shown.words() })
}

fn fitted(fit: &Fit) -> Value {
    let estimates = fit.estimates.iter().map(|e| {
        json!({
            "name": e.name, "value": e.value, "error": e.error, "low": e.interval[0], "high": e.interval[1],
            "profiled": e.profiled, "at_bound": e.at_bound,
        })
    });
    let tests = fit.tests.iter().map(|t| {
        json!({
            "name": t.name, "found": t.found, "expected": t.expected, "probability": t.probability, "objects": t.objects,
        })
    });
    json!({
        "estimates": estimates.collect::<Vec<_>>(), "tests": tests.collect::<Vec<_>>(), "chi_squared": fit.chi_squared,
        "freedom": fit.freedom, "bic": fit.bic, "hidden": fit.hidden, "minima": fit.minima, "starts": fit.starts,
        "reached": fit.reached, "by_half": fit.by_half,
    })
}

/// The answer of `deltaq design`, by its schema.
pub fn design_value(scene: &Scene, films: &[Film], design: &Design, best: &Best) -> Value {
    let chosen = design.chosen().iter();
    let chosen = chosen.map(|c| json!({ "name": c.label, "low": c.ends[0], "high": c.ends[1], "own": c.own }));
    let (tell, estimate) = match design.aim() {
        Aim::Tell(..) => (json!(design.labels()), Value::Null),
        Aim::Estimate(name) => (Value::Null, json!(name)),
    };
    json!({
        "scene": scene.name,
        "films": films.len(),
        "samples": films[0].t.len(),
        "columns": columns(&films[0]),
        "tell": tell,
        "estimate": estimate,
        "chosen": chosen.collect::<Vec<_>>(),
        "best": point(&best.best),
        "own": best.own.as_ref().ok().map(point),
        "others": best.others.iter().map(point).collect::<Vec<_>>(),
        "shortest": best.shortest,
        "tried": best.tried,
        "without_motion": best.without_motion,
    })
}

fn point(point: &Point) -> Value {
    let numbers = point.numbers.iter().map(|(name, value)| json!({ "name": name, "value": value }));
    let by_starts = point.by_starts.iter().map(|(starts, value)| json!({ "starts": starts, "value": value }));
    json!({
        "at": point.at, "value": point.value, "numbers": numbers.collect::<Vec<_>>(), "minima": point.minima,
        "by_starts": by_starts.collect::<Vec<_>>(), "hidden": point.hidden,
    })
}
