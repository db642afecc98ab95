//! `deltaq fit`: which formulation films support, and the numbers that they show.

use std::fmt::Write;

use anyhow::{Context, Error, Result, bail};
use fit::{
    Deviations, Estimate, Film, Fit, FitError, Fitted, Question, ROBUST, Row, Verdict, fit_formulations, formulations,
    quantity,
};
use motion::Settings;
use program::{Answer, TextOrJson, parallel, typed, write_all};
use scene::table_text;

use crate::cli::FitArguments;
use crate::fit_pictures::pictures;

/// Fits every formulation to the films.
///
/// # Errors
/// A scene or film that cannot be read, with its place, and unknowns that make no sense.
pub fn run(arguments: &FitArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let deviations = Deviations::written(&arguments.sigma).context("--sigma")?;
    let mut films = Vec::new();
    for file in &arguments.films {
        let name = file.display().to_string();
        films.push(Film::read(&scene, &name, &table_text(file)?, &deviations)?);
    }
    for known in &arguments.known {
        let (film, number) = self::known(known, films.len())?;
        films[film].known.push(number);
    }
    let question = Question {
        unknowns: &arguments.free,
        law: &arguments.law,
        starts: arguments.starts,
        robust: arguments.robust.then_some(ROBUST),
        settings: Settings { tolerance: arguments.tolerance, max_steps: arguments.max_steps, ..Settings::default() },
        threads: parallel::threads(),
    };
    question.settings.check()?;
    let wanted = formulations(&arguments.formulations)?;
    let rows = fit_formulations(&scene, &mut films, &question, &wanted).map_err(plain)?;
    if rows.is_empty() {
        bail!("the scene has none of these formulations");
    }
    if let Some(folder) = &arguments.pictures {
        let law: Vec<String> = arguments.law.iter().map(|unknown| unknown.of_law().label()).collect();
        write_all(folder, &pictures(&films, &rows, &law)?)?;
    }
    let complaint = complaint(&rows);
    let text = match arguments.format {
        TextOrJson::Text => text(&films, &rows),
        TextOrJson::Json => typed(&Fitted::of(&scene, &films, &rows))?,
    };
    Ok(Answer { text, complaint, ..Answer::default() })
}

/// A contradiction has an exit code of its own.
fn plain(error: FitError) -> Error {
    match error {
        FitError::Contradicted(found) => found.into(),
        error => error.into(),
    }
}

/// `psi'@2=6`: the film from 0, name and value.
fn known(text: &str, films: usize) -> Result<(usize, (String, f64))> {
    let parts = text.split_once('=').and_then(|(name, value)| Some((name.split_once('@')?, value)));
    let Some(((name, film), value)) = parts else { bail!("--known: `{text}` is not NAME@FILM=VALUE") };
    let place = film.trim().parse::<usize>().ok().filter(|film| (1..=films).contains(film));
    let place = place.with_context(|| format!("--known: `{film}` in `{text}` is none of the {films} films"))?;
    Ok((place - 1, (name.trim().into(), quantity(value).context("--known")?)))
}

fn complaint(rows: &[Row]) -> Option<String> {
    if rows.iter().all(|row| row.fit.is_err()) {
        return Some("no formulation could be fitted".into());
    }
    let objected = rows.iter().any(|row| row.verdict == Verdict::None);
    objected.then(|| "no verdict: residuals of the best formulation are not those of noise".into())
}

fn text(films: &[Film], rows: &[Row]) -> String {
    let mut text = String::new();
    for film in films {
        let gaps = if film.gaps() > 0 { format!(", {} gaps", film.gaps()) } else { String::new() };
        let left_out = film.left_out.join(", ");
        let left_out = if left_out.is_empty() { left_out } else { format!("; not looked at: {left_out}") };
        let _ = writeln!(text, "{}: {} samples, {} numbers{gaps}{left_out}", film.name, film.t.len(), film.count());
        let estimated = film.columns.iter().filter(|column| column.estimated);
        let estimated: Vec<String> = estimated.map(|c| format!("{} ± {:.2e}", c.name, c.sigma)).collect();
        if !estimated.is_empty() {
            let estimated = estimated.join(", ");
            let _ = writeln!(text, "  {estimated}, as the best formulation leaves: χ² does not test it");
        }
    }
    for row in rows {
        let _ = writeln!(text, "\n{}: {}", row.choice.label, row.verdict.words());
        for note in &row.notes {
            let _ = writeln!(text, "  {note}");
        }
        if let Some(shown) = &row.shown {
            let _ = writeln!(text, "  {}", shown.words());
        }
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
            "  residual test failed: {} = {}, expected {} (p = {:.0e})",
            test.name, test.found, test.expected, test.probability
        );
    }
    let (minima, starts) = (fit.minima.len(), fit.starts);
    let seen = if minima == 1 { "one minimum".into() } else { format!("the least of {minima} minima") };
    let _ = writeln!(
        text,
        "  chi squared {:.2} for {} degrees of freedom, BIC {:.2}; {seen}, reached from {} of {starts} starts; from half of \
         them {:.2}",
        fit.chi_squared, fit.freedom, fit.bic, fit.reached, fit.by_half
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
