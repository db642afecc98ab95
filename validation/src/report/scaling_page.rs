//! The page about how cost grows with size.

use std::fmt::Write;

use anyhow::Result;

use crate::scaling::{FROM, Line, Point};
use bench::Exponent;
use comparison::words::{or_dash, short};
use motion::FORMS;
use pages::Table;
use picture::{Axis, Curve, Picture, Style};
use program::File;

/// Largest exponents that are asked for: of one right-hand side, and of the derivation.
const RIGHT_HAND_SIDE: f64 = 1.2;
const DERIVATION: f64 = 1.5;

/// Page and pictures.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn scaling_files(lines: &[Line]) -> Result<Vec<File>> {
    let derivation = picture(lines, "Derivation", "derivation (s)", |p| Some(p.derivation))?;
    let side = picture(lines, "One right-hand side", "right-hand side (s)", |p| Some(p.right_hand_side))?;
    let solve = picture(lines, "Solve over 10 s", "solve (s)", |p| p.solve)?;
    let mut page = format!("# Cost over size: the car with n trailers\n\n{}", answer(lines));
    page += "Written by `evidence scaling --out reports/measured`. One knife edge a body: two degrees of freedom however long the train. In maximal \
             coordinates (x, y, heading of every body) every constraint touches neighbours only; that is what all rows use that do not say otherwise. \
             Times are the shortest of some repeats on one machine; *expressions* (made for derivation and compilation), *operations* (of one right-hand \
             side: instructions, and n³/3 for each dense elimination, an upper bound where it meets zeros) and *evaluations* are the same on every machine.\n\n";
    page += "![Derivation](scaling-derivation.svg)\n\n![Right-hand side](scaling-right-hand-side.svg)\n\n![Solve](scaling-solve.svg)\n\n";
    page += &scaling_text(lines);
    Ok(vec![
        File { path: "scaling.md".into(), text: page },
        File { path: "scaling-derivation.svg".into(), text: derivation },
        File { path: "scaling-right-hand-side.svg".into(), text: side },
        File { path: "scaling-solve.svg".into(), text: solve },
    ])
}

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

/// The tables.
pub fn scaling_text(lines: &[Line]) -> String {
    let mut text = format!(
        "## Exponents from n = {FROM}\n\nCost ∝ nᵖ, fitted to logarithms, with the standard error of p. Asked for: at most \
         {RIGHT_HAND_SIDE} for a right-hand side, at most {DERIVATION} for the derivation.\n\n"
    );
    let columns = ["formulation", ">to n", ">derivation, s", ">expressions", ">right-hand side, s", ">operations"];
    let mut table = Table::new(columns.into_iter().chain([">solve, s"]));
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
    text += &table.to_string();
    for line in lines {
        let columns = [">n", ">states", ">expressions", ">derivation, ms", ">operations", ">right-hand side, µs"];
        let mut table = Table::new(columns.into_iter().chain([">evaluations", ">solve, ms"]));
        for p in &line.points {
            let evaluations = p.evaluations.map_or("–".into(), |n| n.to_string());
            let solve = or_dash(p.solve.map(|s| 1e3 * s));
            let (derivation, side) = (short(1e3 * p.derivation), short(1e6 * p.right_hand_side));
            let counts = [&p.trailers, &p.states, &p.expressions, &p.operations];
            table.row(&[counts[0], counts[1], counts[2], &derivation, counts[3], &side, &evaluations, &solve]);
        }
        let _ = write!(text, "\n## {}\n\n{table}", line.formulation);
        if let Some(reason) = &line.ended {
            let _ = writeln!(text, "\nEnds here: {reason}.");
        }
        for p in line.points.iter().filter(|p| p.solve.is_some() && p.reached < 10.0) {
            let _ = writeln!(text, "\nn = {}: the motion stopped at t = {}.", p.trailers, short(p.reached));
        }
    }
    text
}

fn fitted(exponent: Exponent) -> String {
    format!("{:.2} ± {:.2}", exponent.value, exponent.error)
}

fn picture(lines: &[Line], title: &str, label: &str, cost: impl Fn(&Point) -> Option<f64>) -> Result<String> {
    let curve = |line: &Line| Curve {
        label: line.formulation.clone(),
        style: Style::of_formulation(&line.formulation).unwrap_or(Style::RemovedConstraint),
        points: line.points.iter().filter_map(|p| Some((p.trailers as f64, cost(p)?))).collect(),
    };
    let curves = lines.iter().map(curve).collect();
    Ok(Picture::new(format!("{title} of a car with n trailers"), Axis::log("n"), Axis::log(label), curves).to_svg()?)
}
