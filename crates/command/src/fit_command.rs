//! `deltaq fit`: which formulation films support, and the numbers that they show.

use std::fmt::Write;

use anyhow::{Context, Result, bail};
use deltaq::{Settings, VAKONOMIC_COSTATE, formulation};
use equations::Formulation;
use fit::{Deviations, Estimate, Film, Fit, Question, Row, Unknown, Verdict, fit_formulations, quantity};
use program::{Answer, TextOrJson, pretty};
use serde_json::{Value, json};

use crate::cli::FitArguments;

/// Residuals above this size count linearly with `--robust`.
const ROBUST: f64 = 1.345;

/// Fits every formulation to the films.
///
/// # Errors
/// A scene or film that cannot be read, with its place, and unknowns that make no sense.
pub fn run(arguments: &FitArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let deviations = deviations(&arguments.sigma)?;
    let mut films = Vec::new();
    for file in &arguments.films {
        let name = file.display().to_string();
        let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {name}"))?;
        films.push(Film::read(&scene, &name, &text, &deviations).context(name)?);
    }
    for known in &arguments.known {
        let (film, number) = self::known(known, films.len())?;
        films[film].known.push(number);
    }
    let law: Vec<Unknown> = arguments.law.iter().map(of_law).collect();
    let question = Question {
        unknowns: &arguments.free,
        law: &law,
        starts: arguments.starts,
        robust: arguments.robust.then_some(ROBUST),
        settings: Settings { tolerance: arguments.tolerance, max_steps: arguments.max_steps, ..Settings::default() },
    };
    question.settings.check()?;
    let all = arguments.formulations.iter().any(|name| name == "all");
    let names = arguments.formulations.iter().filter(|name| *name != "all");
    let named = names.map(|name| formulation(name)).collect::<Result<Vec<_>, _>>()?;
    let wanted = |f: &Formulation| if all { *f != *VAKONOMIC_COSTATE } else { named.iter().any(|own| **own == *f) };
    let rows = fit_formulations(&scene, &films, &question, &wanted)?;
    if rows.is_empty() {
        bail!("the scene has none of these formulations");
    }
    let complaint = complaint(&rows);
    let text = match arguments.format {
        TextOrJson::Text => text(&films, &rows),
        TextOrJson::Json => {
            let films: Vec<Value> = films.iter().map(film_value).collect();
            let rows: Vec<Value> = rows.iter().map(row_value).collect();
            pretty("fit", &json!({ "scene": scene.name, "films": films, "formulations": rows }))
        }
    };
    Ok(Answer { text, complaint })
}

/// `0.5mm`, `x=0.5mm`.
pub(crate) fn deviations(written: &[String]) -> Result<Deviations> {
    let mut deviations = Deviations::default();
    for text in written {
        match text.split_once('=') {
            Some((name, sigma)) => deviations.by_name.push((name.trim().into(), quantity(sigma).context("--sigma")?)),
            None => deviations.others = Some(quantity(text).context("--sigma")?),
        }
    }
    Ok(deviations)
}

/// `psi'@2=6`: the film from 0, name and value.
fn known(text: &str, films: usize) -> Result<(usize, (String, f64))> {
    let parts = text.split_once('=').and_then(|(name, value)| Some((name.split_once('@')?, value)));
    let Some(((name, film), value)) = parts else { bail!("--known: `{text}` is not NAME@FILM=VALUE") };
    let place = film.trim().parse::<usize>().ok().filter(|film| (1..=films).contains(film));
    let place = place.with_context(|| format!("--known: `{film}` in `{text}` is none of the {films} films"))?;
    Ok((place - 1, (name.trim().into(), quantity(value).context("--known")?)))
}

/// Words of laws: `eps` is `epsilon`, not below 0; a slip begins at 0.01.
pub(crate) fn of_law(unknown: &Unknown) -> Unknown {
    let mut unknown = unknown.clone();
    match unknown.name.as_str() {
        "eps" => (unknown.name, unknown.bound) = ("epsilon".into(), unknown.bound.or(Some(0.0))),
        "slip" => (unknown.start, unknown.bound) = (unknown.start.or(Some(0.01)), unknown.bound.or(Some(0.0))),
        _ => {}
    }
    unknown
}

fn complaint(rows: &[Row]) -> Option<String> {
    if rows.iter().all(|row| row.fit.is_err()) {
        return Some("no formulation could be fitted".into());
    }
    let objected = rows.iter().any(|row| row.verdict == Verdict::None);
    objected.then(|| "no verdict: residuals of the best formulation are not those of noise".into())
}

fn words(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Supported => "supported".into(),
        Verdict::Excluded { sigmas } => format!("excluded at {sigmas:.1} σ"),
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

fn text(films: &[Film], rows: &[Row]) -> String {
    let mut text = String::new();
    for film in films {
        let _ = writeln!(text, "{}: {} samples, {} numbers", film.name, film.t.len(), film.count());
    }
    for row in rows {
        let _ = writeln!(text, "\n{}: {}", row.choice.label, words(&row.verdict));
        if let Ok(fit) = &row.fit {
            fit_text(&mut text, fit);
        }
    }
    text
}

fn fit_text(text: &mut String, fit: &Fit) {
    let objections: Vec<_> = fit.objections().collect();
    if objections.is_empty() {
        let _ = writeln!(text, "  residuals are those of noise: {} tests", fit.tests.len());
    }
    for test in objections {
        let _ = writeln!(
            text,
            "  residuals object: {} is {:.4}, {:.4} is expected; probability {:.0e}",
            test.name, test.found, test.expected, test.probability
        );
    }
    let (minima, starts) = (fit.minima.len(), fit.starts);
    let seen = if minima == 1 { "one minimum".into() } else { format!("{minima} minima") };
    let _ = writeln!(
        text,
        "  chi squared {:.2} for {} degrees of freedom, BIC {:.2}; {seen} from {starts} starts",
        fit.chi_squared, fit.freedom, fit.bic
    );
    for hidden in &fit.hidden {
        let _ = writeln!(text, "  these films do not show a change of {hidden}");
    }
    for estimate in &fit.estimates {
        let Estimate { name, value, error, interval: [low, high], .. } = estimate;
        let by = if estimate.profiled { ", by the profile" } else { "" };
        let bound = estimate.at_bound.map_or(String::new(), |p| format!("; probability at the bound {p:.2e}"));
        let _ = writeln!(text, "  {name:<12} {value:>14.7e} ± {error:.1e}  95 %: {low:.6e} to {high:.6e}{by}{bound}");
    }
}

fn film_value(film: &Film) -> Value {
    let columns = film.columns.iter().map(|c| json!({ "name": c.name, "sigma": c.sigma })).collect::<Vec<_>>();
    json!({ "file": film.name, "samples": film.t.len(), "numbers": film.count(), "columns": columns })
}

fn row_value(row: &Row) -> Value {
    let verdict = match &row.verdict {
        Verdict::Supported => "supported",
        Verdict::Excluded { .. } => "excluded",
        Verdict::CannotTell { .. } => "cannot-tell",
        Verdict::None => "none",
        Verdict::NotFitted(_) => "not-fitted",
    };
    json!({
        "formulation": row.choice.formulation.name,
        "label": row.choice.label,
        "verdict": verdict,
        "words": words(&row.verdict),
        "from": match &row.verdict { Verdict::CannotTell { from, .. } => from.clone(), _ => Vec::new() },
        "needs": match &row.verdict { Verdict::CannotTell { needs, .. } => needs.clone(), _ => Vec::new() },
        "sigmas": match row.verdict { Verdict::Excluded { sigmas } => Some(sigmas), _ => None },
        "fit": row.fit.as_ref().ok().map(fit_value),
    })
}

fn fit_value(fit: &Fit) -> Value {
    // what is infinite is null
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
    })
}
