//! The page about the mechanical problems of the Test Set for IVP Solvers.

use std::fmt::Write;

use anyhow::Result;

use crate::ivp::{Errors, Point, Problem};
use comparison::words::{or_dash, short};
use pages::Table;
use picture::{Axis, Curve, Picture, Style};
use program::File;

/// Page and pictures.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn ivp_files(measured: &[(Problem, Vec<Point>)]) -> Result<Vec<File>> {
    let mut page = format!("# Test problems of others: the Test Set for IVP Solvers\n\n{}\n", summary(measured));
    page += "Written by `evidence ivp --out reports/measured`. The problems are the mechanical systems of the [test set](https://archimede.uniba.it/~testset/) \
             (Lioen, de Swart 1998; Mazzia, Magherini 2008) that have a Lagrangian and constraints on positions. The slider crank (elastic rod) \
             and the wheelset (creep forces by table) do not. A scene gives $L$, $f$ and $Q$; deltaq supplies equations, index reduction, projection and multipliers. \
             The *referee* `validation/ivp/referee.py` integrates the equations as the test set prints them, by extrapolation of order 12 in long double, twice. \
             Errors are the largest over all coordinates, or all multipliers, at the end, against the referee. \
             Times are the shortest of three on one machine, from the scene to the answer: derivation, compilation and both runs. \
             Figures of other programs are quoted from their own pages, which measured on other machines.\n\n";
    page += "## Errors of the printed values\n\n";
    page += &printed(measured).to_string();
    page += "\nThe *gap* is the difference between the referee's run and its run with half as many steps.\n";
    let mut files = Vec::new();
    for (problem, points) in measured {
        let name = &problem.name;
        let _ = write!(page, "\n## {name}\n\n{}\n\n![{}](ivp-{name}.svg)\n\n", problem.said, title(problem, points));
        page += &solves(points).to_string();
        let _ = write!(page, "\n**Elsewhere:** {}\n", problem.others);
        files.push(File { path: format!("ivp-{name}.svg").into(), text: picture(problem, points)? });
    }
    files.insert(0, File { path: "ivp.md".into(), text: page });
    Ok(files)
}

/// The page in one paragraph, from what was measured.
fn summary(measured: &[(Problem, Vec<Point>)]) -> String {
    let told = measured.iter().map(|(problem, points)| {
        let printed = problem.printed.last().map(|printed| problem.errors(&printed.values).coordinates);
        let best = points.iter().filter_map(|point| point.errors.as_ref().ok()).map(|errors| errors.coordinates);
        let best = best.fold(f64::INFINITY, f64::min);
        format!("{}: printed {}, here {}", problem.name, or_dash(printed), short(best))
    });
    format!("**Largest errors of coordinates at the end. {}.**\n", told.collect::<Vec<_>>().join("; "))
}

fn printed(measured: &[(Problem, Vec<Point>)]) -> Table {
    let columns = ["problem", "printed", ">digits printed", ">error of coordinates", ">of multipliers", ">gap"];
    let mut table = Table::new(columns);
    for (problem, _) in measured {
        for printed in &problem.printed {
            let Errors { coordinates, multipliers } = problem.errors(&printed.values);
            let digits = if printed.by.contains("quadruple") { 21 } else { 16 };
            let cells = [short(coordinates), or_dash(multipliers), short(problem.gap)];
            table.row(&[&problem.name, &printed.by, &digits, &cells[0], &cells[1], &cells[2]]);
        }
    }
    table
}

/// What stands for the method if none was asked for.
const DEFAULT: &str = "auto (default)";

/// The method that was asked for.
fn asked(point: &Point) -> &'static str {
    point.method.unwrap_or(DEFAULT)
}

fn solves(points: &[Point]) -> Table {
    let columns = ["method", ">tolerance", ">ms", ">error of coordinates", ">estimated", ">error of multipliers"];
    let mut table = Table::new(columns);
    for point in points {
        let told = [short(point.tolerance), short(1e3 * point.seconds)];
        match &point.errors {
            Ok(errors) => {
                let cells = [short(errors.coordinates), short(point.estimate), or_dash(errors.multipliers)];
                table.row(&[&asked(point), &told[0], &told[1], &cells[0], &cells[1], &cells[2]]);
            }
            Err(reason) => table.row(&[&asked(point), &told[0], &told[1], reason, &"–", &"–"]),
        }
    }
    table
}

fn picture(problem: &Problem, points: &[Point]) -> Result<String> {
    let mut curves: Vec<Curve> = Vec::new();
    for point in points {
        let Ok(errors) = &point.errors else { continue };
        let xy = (point.seconds, errors.coordinates.max(f64::EPSILON));
        match curves.last_mut().filter(|curve| curve.label == asked(point)) {
            Some(curve) => curve.points.push(xy),
            None => {
                let style = if asked(point) == DEFAULT { Style::Ink } else { Style::Member(curves.len() as u8) };
                curves.push(Curve { label: asked(point).into(), style, points: vec![xy] });
            }
        }
    }
    let x = Axis::log("time from the scene to the answer (s)");
    let y = Axis::log("largest error of a coordinate at the end");
    Ok(Picture::new(title(problem, points), x, y, curves).to_svg()?)
}

/// What the picture says: the least error of the default, and its time.
fn title(problem: &Problem, points: &[Point]) -> String {
    let of_default = points.iter().filter(|point| point.method.is_none());
    let reached = of_default.filter_map(|point| Some((point.errors.as_ref().ok()?.coordinates, point.seconds)));
    match reached.min_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((error, time)) => {
            format!("{}: the default reaches an error of {} in {} ms", problem.name, short(error), short(1e3 * time))
        }
        None => format!("{}: error against run time", problem.name),
    }
}
