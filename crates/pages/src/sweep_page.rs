//! The page and the picture of a sweep.

use std::fmt::Write;

use anyhow::Result;
use picture::{Axis, Curve, HeatMap, Picture, Style};

use crate::markdown::inert;
use crate::scene_page::ROWS;
use comparison::words::short;
use program::File;
use scene::{Scene, Table, TableError};

/// What varies: name, first value, last value, number of values.
pub type Swept = (String, f64, f64, usize);

/// The name of a number with its unit, which is known of coordinates and their velocities at the start.
pub fn with_unit(scene: &Scene, name: &str) -> String {
    let coordinate = scene.system.coordinates.iter().find(|c| c.name == name.trim_end_matches('\''));
    coordinate.map_or(name.to_owned(), |c| format!("{name} ({}{})", c.unit, if c.name == name { "" } else { "/s" }))
}

/// A row of the table, as read.
struct Point {
    at: Vec<f64>,
    verdict: String,
    apart: Option<f64>,
    answer: String,
    mismatch: Option<f64>,
}

/// What is drawn: the end of the file's name, the axis, what a point without it is, and how it is read off.
type Measure = (&'static str, &'static str, &'static str, fn(&Point) -> Option<f64>);

const MEASURES: [Measure; 2] = [
    ("apart", "time to a gap of 1e-3 (s)", "no such gap", |point| point.apart),
    ("decision", "relative mismatch", "not decided", |point| point.mismatch),
];

impl Point {
    fn has_some(&self) -> bool {
        self.answer.starts_with("some")
    }
}

/// A page about the table of a sweep over these ranges, with lines or maps of when the motions of the two
/// formulations part and of what is decided. The table is that of `deltaq compare --sweep`, whole.
///
/// # Errors
/// Where the table is none, or a picture cannot be drawn.
pub fn sweep_files(scene: &Scene, [first, second]: [&str; 2], ranges: &[Swept], table: &str) -> Result<Vec<File>> {
    let (count, name) = (ranges.len(), &scene.name);
    let title = &format!("{}: {first} and {second}", scene.title);
    let mark = &format!("constants make the {second} motion the {first} one");
    let table = Table::read(name, table)?;
    let point = |row: usize| -> Result<Point, TableError> {
        let text = |name: &str| table.column(name).map(|column| table.text(row, column).into_owned());
        let number = |name: &str| table.number_or_gap(row, table.column(name)?);
        let at = (0..count).map(|column| table.number(row, column)).collect::<Result<_, _>>()?;
        let (apart, mismatch) = (number("apart")?, number("mismatch")?);
        Ok(Point { at, verdict: text("verdict")?, apart, answer: text("answer")?, mismatch })
    };
    let points: Vec<Point> = table.rows().map(point).collect::<Result<_, _>>()?;
    let mut text = page(title, mark, ranges, &points);
    let mut files = Vec::new();
    let labelled: Vec<Swept> =
        ranges.iter().map(|(name, from, to, count)| (with_unit(scene, name), *from, *to, *count)).collect();
    for measure in &MEASURES {
        let says = message(&scene.title, [first, second], measure, &points);
        let svg = match &labelled[..] {
            [one] => line(&says, (second, mark), one, measure, &points),
            [y, x] => Ok(map(&says, mark, x, y, measure, &points)),
            _ => break,
        };
        let path = format!("{name}-{}.svg", measure.0);
        match svg {
            Ok(svg) => {
                let _ = writeln!(text, "![{}]({path})\n", inert(&says));
                files.push(File { path: path.into(), text: svg });
            }
            // motions that never part have no times to be drawn
            Err(picture::PictureError::NothingToDraw { .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    files.push(File { path: format!("{name}-sweep.md").into(), text });
    Ok(files)
}

/// What a picture shows.
fn message(title: &str, [first, second]: [&str; 2], (kind, .., value): &Measure, points: &[Point]) -> String {
    let (all, mut values) = (points.len(), points.iter().filter_map(value).collect::<Vec<f64>>());
    values.sort_by(f64::total_cmp);
    let count = values.len();
    match (*kind, &values[..]) {
        ("apart", [least, ..]) => {
            let [least, most] = [*least, values[count - 1]].map(short);
            format!("{title}: {first} and {second} differ by 1e-3 after {least} to {most} s at {count} of {all} points")
        }
        _ => {
            let some = points.iter().filter(|point| point.has_some()).count();
            format!("{title}: constants make the {second} motion the {first} one at {some} of {all} points")
        }
    }
}

fn page(title: &str, mark: &str, ranges: &[Swept], points: &[Point]) -> String {
    let number = |word: &str| points.iter().filter(|point| point.verdict == word).count();
    let some: Vec<&Point> = points.iter().filter(|point| point.has_some()).collect();
    let proved = points.iter().filter(|point| point.answer == "none proved").count();
    let names: Vec<&str> = ranges.iter().map(|(name, ..)| name.as_str()).collect();
    let title = inert(title);
    let mut text = format!(
        "# {title} over {}\n\n**The motions differ at {} of {} points and agree at {}; {} points are undecided, {} have no motion. It is \
         proved at {proved} points that no {mark}; at {} points some do.**\n",
        names.join(" and "),
        number("different"),
        points.len(),
        number("same"),
        number("undecided"),
        number(""),
        some.len(),
    );
    for point in some.iter().take(ROWS) {
        let at: Vec<String> = names.iter().zip(&point.at).map(|(name, x)| format!("{name} = {x}")).collect();
        let _ = write!(text, "\n- {}: {}", at.join(", "), point.answer);
    }
    if some.len() > ROWS {
        let _ = write!(text, "\n- and {} more", some.len() - ROWS);
    }
    text + "\n\n"
}

fn map(
    title: &str,
    mark: &str,
    (x, x0, x1, columns): &Swept,
    (y, y0, y1, _): &Swept,
    (_, label, empty, value): &Measure,
    points: &[Point],
) -> String {
    HeatMap {
        title: title.into(),
        x: Axis { range: Some((*x0, *x1)), ..Axis::linear(x.clone()) },
        y: Axis { range: Some((*y0, *y1)), ..Axis::linear(y.clone()) },
        columns: *columns,
        value: Axis::log(*label),
        cells: points.iter().map(value).collect(),
        empty: (*empty).into(),
        marked: points.iter().map(Point::has_some).collect(),
        mark: format!("some {mark}"),
    }
    .to_svg()
}

fn line(
    title: &str,
    (second, mark): (&str, &str),
    (name, ..): &Swept,
    (_, label, _, value): &Measure,
    points: &[Point],
) -> Result<String, picture::PictureError> {
    let along = points.iter().filter_map(|point| Some((point.at[0], value(point)?))).collect();
    let mut curves = vec![Curve { label: second.into(), style: Style::Vakonomic, points: along }];
    for point in points.iter().filter(|point| point.has_some()) {
        let at = value(point).map(|value| (point.at[0], value));
        curves.push(Curve { label: format!("some {mark}"), style: Style::Threshold, points: at.into_iter().collect() });
    }
    curves.retain(|curve| !curve.points.is_empty());
    Picture::new(title, Axis::linear(name.clone()), Axis::log(*label), curves).to_svg()
}
