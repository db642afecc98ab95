//! The page about how cost grows with size.

use anyhow::Result;

use crate::scaling::{FROM, Line, Point};
use bench::Exponent;
use comparison::words::{or_dash, short};
use motion::FORMS;
use pages::{DataPackage, Table};
use picture::{Axis, Curve, Picture, Style};
use program::File;

/// Largest exponents that are asked for: of one right-hand side, and of the derivation.
const RIGHT_HAND_SIDE: f64 = 1.2;
const DERIVATION: f64 = 1.5;

/// Page, pictures and tables.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn scaling_files(lines: &[Line]) -> Result<Vec<File>> {
    let pictures = [
        ("derivation", picture(lines, "Derivation", "derivation (s)", |p| Some(p.derivation))?),
        ("right-hand-side", picture(lines, "A right-hand side", "right-hand side (s)", |p| Some(p.right_hand_side))?),
        ("solve", picture(lines, "A solve over 10 s", "solve (s)", |p| p.solve)?),
    ];
    let mut data = DataPackage::new("data/scaling", "Cost over size: the car with n trailers");
    data.table("costs", "Every length of the train: counts and times", &costs(lines));
    data.table("ends", "Where a row of lengths ends, and motions that stopped", &ends(lines));
    let page = format!(
        "# Cost over size: the car with n trailers\n\n{}{INTRODUCTION}\n![Time of a right-hand side over the number of trailers]\
         (scaling-right-hand-side.svg)\n\nThe same for the [derivation](scaling-derivation.svg) and for a [solve](scaling-solve.svg).\n\n{}\n## Data\n\n{}",
        answer(lines),
        exponents(lines),
        data.list(0)
    );
    let files = pictures.into_iter().map(|(name, text)| File { path: format!("scaling-{name}.svg").into(), text });
    let files = [File { path: "scaling.md".into(), text: page }].into_iter().chain(files);
    Ok(files.chain(data.files()).collect())
}

const INTRODUCTION: &str = "Written by `evidence scaling --out reports/measured`. One knife edge per body, so two degrees of freedom for any length. \
    In maximal coordinates (x, y and heading of every body) every constraint involves neighbours only; all rows use these coordinates unless they say otherwise. \
    Times are the shortest of some repeats on one machine. The numbers of *expressions* (made for derivation and compilation), *operations* (of one right-hand \
    side, with n³/3 as an upper bound for each dense elimination) and *evaluations* are the same on every machine.\n";

/// Whether the forms in quasi-velocities grow as is asked for.
fn answer(lines: &[Line]) -> String {
    let said = |line: &Line| {
        let judged = |cost: fn(&Point) -> f64, limit| {
            let exponent = line.exponent(|p| Some(cost(p)))?;
            let met = if exponent.value <= limit { "met" } else { "**missed**" };
            Some(format!("{} (at most {limit}: {met})", fitted(exponent)))
        };
        let (side, derivation) =
            (judged(|p| p.right_hand_side, RIGHT_HAND_SIDE)?, judged(|p| p.derivation, DERIVATION)?);
        Some(format!(
            "- **`{}`**: a right-hand side grows as nᵖ with p = {side}, the derivation with p = {derivation}.\n",
            line.formulation
        ))
    };
    lines
        .iter()
        .filter(|line| FORMS.iter().any(|form| form.name == line.formulation))
        .filter_map(said)
        .collect::<String>()
        + "\n"
}

/// The tables, for a terminal.
pub fn scaling_text(lines: &[Line]) -> String {
    format!("{}\n{}\n{}", exponents(lines), costs(lines), ends(lines))
}

/// The exponents with their table.
fn exponents(lines: &[Line]) -> String {
    let columns = ["formulation", ">to n", ">derivation", ">expressions", ">right-hand side", ">operations", ">solve"];
    let mut table = Table::new(columns);
    for line in lines {
        let longest = line.points.last().map_or(0, |p| p.trailers);
        let costs: [fn(&Point) -> Option<f64>; 5] = [
            |p| Some(p.derivation),
            |p| Some(p.expressions as f64),
            |p| Some(p.right_hand_side),
            |p| Some(p.operations as f64),
            |p| p.solve,
        ];
        let costs = costs.map(|cost| line.exponent(cost).map_or("–".into(), fitted));
        table.cells([line.formulation.clone(), longest.to_string()].into_iter().chain(costs));
    }
    format!(
        "## Exponents from n = {FROM}\n\nCost ∝ nᵖ: p, fitted to logarithms, with its standard error. Targets: at most \
         {RIGHT_HAND_SIDE} for a right-hand side, at most {DERIVATION} for the derivation.\n\n{table}"
    )
}

/// Everything that was counted and timed.
fn costs(lines: &[Line]) -> Table {
    let columns = ["formulation", ">n", ">states", ">expressions", ">derivation (ms)", ">operations"];
    let mut table = Table::new(columns.into_iter().chain([">right-hand side (µs)", ">evaluations", ">solve (ms)"]));
    for (line, p) in lines.iter().flat_map(|line| line.points.iter().map(move |p| (line, p))) {
        let evaluations = p.evaluations.map_or("–".into(), |n| n.to_string());
        let solve = or_dash(p.solve.map(|s| 1e3 * s));
        let (derivation, side) = (short(1e3 * p.derivation), short(1e6 * p.right_hand_side));
        let [n, states, expressions, operations] = [&p.trailers, &p.states, &p.expressions, &p.operations];
        table.row(&[&line.formulation, n, states, expressions, &derivation, operations, &side, &evaluations, &solve]);
    }
    table
}

/// Why longer trains are left out, and motions that stopped.
fn ends(lines: &[Line]) -> Table {
    let mut table = Table::new(["formulation", "what"]);
    for line in lines {
        line.ended.iter().for_each(|reason| table.row(&[&line.formulation, &format!("ends here: {reason}")]));
        for p in line.points.iter().filter(|p| p.solve.is_some() && p.reached < 10.0) {
            let what = format!("n = {}: the motion stopped at t = {}", p.trailers, short(p.reached));
            table.row(&[&line.formulation, &what]);
        }
    }
    table
}

fn fitted(exponent: Exponent) -> String {
    format!("{:.2} ± {:.2}", exponent.value, exponent.error)
}

/// A point that costs this many times as much as the one before is written, not drawn.
const OUTLIER: f64 = 100.0;

/// The name of a formulation in words.
fn words(formulation: &str) -> String {
    let named = motion::formulation(formulation).map(|known| known.title.to_owned());
    let form = FORMS.iter().find(|form| form.name == formulation);
    let stem = formulation.trim_end_matches("-reduced");
    match (named, form) {
        (Ok(title), _) => title,
        (_, Some(_)) => {
            let title = motion::formulation(stem).map_or(stem.to_owned(), |known| known.title.to_owned());
            format!("{title}, quasi-velocities")
        }
        _ => formulation.replace("removed-constraint", "removed constraint"),
    }
}

fn picture(lines: &[Line], title: &str, label: &str, cost: impl Fn(&Point) -> Option<f64>) -> Result<String> {
    let curve = |line: &Line| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut label = words(&line.formulation);
        for p in &line.points {
            let Some(at) = cost(p) else { continue };
            if points.last().is_some_and(|before| at > OUTLIER * before.1) {
                label += &format!(" (n = {}: {} s)", p.trailers, short(at));
                break;
            }
            points.push((p.trailers as f64, at));
        }
        let style = Style::of_formulation(&line.formulation).unwrap_or(Style::RemovedConstraint);
        Curve { label, style, points }
    };
    let reduced = lines.iter().find(|line| FORMS.iter().any(|form| form.name == line.formulation));
    let grows = reduced.and_then(|line| line.exponent(&cost)).map(|found| found.value);
    let grows = grows.map_or("over its length".into(), |p| format!("grows as n^{p:.1} in quasi-velocities"));
    let curves = lines.iter().map(curve).filter(|curve| !curve.points.is_empty()).collect();
    let title = format!("{title} of a car with n trailers {grows}");
    Ok(Picture::new(title, Axis::log("number of trailers n"), Axis::log(label), curves).to_svg()?)
}
