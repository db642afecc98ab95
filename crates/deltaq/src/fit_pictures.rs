//! Pictures of fits: films with the fitted motions, residuals, profiles of numbers of a law.

use std::path::PathBuf;

use anyhow::Result;
use fit::{Film, Fit, RISE, Row, profile};
use motion::band::LOOKS;
use picture::{Axis, Curve, Panel, Picture, Style};
use program::File;

/// How far a profile goes beyond the interval, in its widths.
const BEYOND: f64 = 0.5;

/// `film.svg`, `residuals.svg`, and `profile-NAME.svg` for each of these numbers.
///
/// # Errors
/// A picture whose axes cannot be drawn.
pub(crate) fn pictures(films: &[Film], rows: &[Row], numbers: &[String]) -> Result<Vec<File>> {
    let svg = |name: String, picture: Picture| -> Result<File> {
        Ok(File { path: PathBuf::from(name), text: picture.to_svg()? })
    };
    let mut files =
        vec![svg("film.svg".into(), motions(films, rows))?, svg("residuals.svg".into(), residuals(films, rows))?];
    for name in numbers {
        for row in rows {
            if let Some(picture) = rise(row, name) {
                files.push(svg(format!("profile-{name}.svg"), picture)?);
            }
        }
    }
    Ok(files)
}

fn fitted(rows: &[Row]) -> impl Iterator<Item = (&Row, &Fit)> {
    rows.iter().filter_map(|row| Some((row, row.fit.as_ref().ok()?)))
}

fn style(row: &Row, place: usize) -> Style {
    Style::of_formulation(row.choice.formulation.name).unwrap_or(Style::Member(place as u8))
}

/// Verdicts, as a headline.
fn headline(rows: &[Row]) -> String {
    let each = rows.iter().map(|row| format!("{}: {}", row.choice.label, row.verdict.words()));
    each.collect::<Vec<_>>().join("; ")
}

/// The columns over time: samples, and each fitted motion at their times.
fn motions(films: &[Film], rows: &[Row]) -> Picture {
    let mut panels = Vec::new();
    for (number, film) in films.iter().enumerate() {
        for (c, column) in film.columns.iter().enumerate() {
            let seen = film.t.iter().zip(&film.rows).filter_map(|(t, row)| Some((*t, row[c]?)));
            let mut curves = vec![Curve { label: "film".into(), style: Style::Samples, points: seen.collect() }];
            for (place, (row, fit)) in fitted(rows).enumerate() {
                let of = fit.residuals.iter().filter(|r| r.film == number && r.column == c);
                let at = |line: usize| film.lines.iter().position(|own| *own == line);
                let value = |r: &fit::Residual| Some(film.rows[at(r.line)?][c]? + r.value * column.sigma);
                let points = of.filter_map(|r| Some((r.t, value(r)?))).collect();
                curves.push(Curve { label: row.choice.label.clone(), style: style(row, place), points });
            }
            let label =
                if films.len() > 1 { format!("{}, film {}", column.name, number + 1) } else { column.name.clone() };
            panels.push(Panel::new(Axis::linear(label), curves));
        }
    }
    Picture::panels(headline(rows), Axis::linear("t"), panels, 1)
}

/// What is left of the columns, in standard deviations: a panel per formulation.
fn residuals(films: &[Film], rows: &[Row]) -> Picture {
    let mut panels = Vec::new();
    for (row, fit) in fitted(rows) {
        let columns = films.iter().enumerate().flat_map(|(film, own)| (0..own.columns.len()).map(move |c| (film, c)));
        let curves = columns.enumerate().map(|(place, (film, c))| {
            let of = fit.residuals.iter().filter(|r| r.film == film && r.column == c);
            let name = &films[film].columns[c].name;
            let label = if films.len() > 1 { format!("{name}, film {}", film + 1) } else { name.clone() };
            Curve { label, style: Style::Member(place as u8), points: of.map(|r| (r.t, r.value)).collect() }
        });
        let title = match fit.objections().next() {
            Some(test) => format!("{}: {} objects", row.choice.label, test.name),
            None => format!("{}: noise", row.choice.label),
        };
        panels.push(Panel { title, y: Axis::linear("residual/σ"), curves: curves.collect() });
    }
    Picture::panels("What fitted motions leave of the films", Axis::linear("t"), panels, 1)
}

/// How χ² rises beside the estimate of a number.
fn rise(row: &Row, name: &str) -> Option<Picture> {
    let (problem, fit) = (row.problem.as_ref()?, row.fit.as_ref().ok()?);
    let estimate = fit.estimates.iter().find(|e| e.name == name)?;
    let [low, high] = estimate.interval.map(|end| if end.is_finite() { Some(end) } else { None });
    let (low, high) = (low?, high?);
    let bound = problem.unknowns().iter().find(|u| u.label() == name)?.bound.unwrap_or(f64::NEG_INFINITY);
    let (from, to) = ((low - BEYOND * (high - low)).max(bound), high + BEYOND * (high - low));
    let at: Vec<f64> = (0..=LOOKS).map(|i| from + (to - from) * i as f64 / LOOKS as f64).collect();
    let rises = profile(problem, fit, name, &at)?;
    let points = at.iter().copied().zip(rises).filter(|(_, rise)| rise.is_finite()).collect();
    let curves = vec![
        Curve { label: "95 %".into(), style: Style::Threshold, points: vec![(from, RISE), (to, RISE)] },
        Curve { label: row.choice.label.clone(), style: Style::of_formulation(row.choice.formulation.name)?, points },
    ];
    let title = format!("{name} is between {low:.3e} and {high:.3e}, by {}", row.choice.label);
    Some(Picture::new(title, Axis::linear(name), Axis::linear("rise of χ²"), curves))
}
