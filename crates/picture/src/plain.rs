//! The first panel of a picture in characters, for terminals: a letter a curve, dots for a threshold.

use super::axis::{Direction, Interval, TICK_SIZE, around, given, measure, ticks};
use super::error::PictureError;
use super::plot::{Axis, Curve, Picture};
use super::style::Style;

/// Columns of the labels of the vertical axis, and of the least plot beside them.
const LABELS: usize = 7;
const LEAST: usize = 20;

/// Pixels of a character, by which ticks are chosen.
const CELL: (f64, f64) = (0.6 * TICK_SIZE, 1.5 * TICK_SIZE);

impl Picture {
    /// The first panel in characters: lines of at most `width`, `height` rows of curves, axes and a legend;
    /// the first curve in letters `a`, the second in `b`, thresholds dotted.
    ///
    /// # Errors
    /// [`PictureError`], where an axis cannot be drawn.
    pub fn to_text(&self, width: usize, height: usize) -> Result<String, PictureError> {
        text(self, width, height)
    }
}

/// Curves are `a`, `b`, … in their order, those before over those behind.
fn text(picture: &Picture, width: usize, height: usize) -> Result<String, PictureError> {
    let curves = picture.panels.first().map_or(&[][..], |panel| &panel.curves);
    let vertical = picture.panels.first().map_or(&picture.x, |panel| &panel.y);
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let x = range(picture, &picture.x, points().map(|p| p.0))?;
    let y = range(picture, vertical, points().map(|p| p.1))?;
    let (columns, rows) = (width.saturating_sub(LABELS + 1).max(LEAST), height.max(2));
    let cell = |interval: Interval, at: f64, count: usize| {
        let fraction = interval.fraction(at);
        (0.0..=1.0).contains(&fraction).then(|| (fraction * (count - 1) as f64).round() as usize)
    };
    let mut canvas = vec![vec![' '; columns]; rows];
    let mark =
        |(i, curve): (u8, &Curve)| if curve.style == Style::Threshold { '·' } else { char::from(b'a' + i % 26) };
    let marks: Vec<char> = (0..=u8::MAX).zip(curves).map(mark).collect();
    for (curve, &mark) in curves.iter().zip(&marks).rev() {
        let mut before = None;
        for &(h, v) in &curve.points {
            let place = measure(picture.x.scale, h).ok().zip(measure(vertical.scale, v).ok());
            let place = place.and_then(|(h, v)| Some((cell(x, h, columns)?, cell(y, v, rows)?)));
            if let Some((column, row)) = place {
                // a steep curve has no gaps
                let from =
                    before.filter(|&(c, _): &(usize, usize)| c.abs_diff(column) <= 1).map_or(row, |(_, row)| row);
                (from.min(row)..=from.max(row)).for_each(|row| canvas[rows - 1 - row][column] = mark);
            }
            before = place;
        }
    }
    let labels = ticks(vertical.scale, y, rows as f64 * CELL.1, Direction::Vertical);
    let mut lines =
        vec![[Some(vertical.label.clone()), labels.factor].into_iter().flatten().collect::<Vec<_>>().join(" ")];
    for (i, line) in canvas.iter().enumerate() {
        let tick = labels.labelled.iter().find(|tick| cell(y, tick.at, rows) == Some(rows - 1 - i));
        let (label, edge) = tick.map_or(("", '│'), |tick| (&tick.label[..], '┤'));
        lines.push(format!("{label:>LABELS$}{edge}{}", line.iter().collect::<String>()));
    }
    let labels = ticks(picture.x.scale, x, columns as f64 * CELL.0, Direction::Horizontal);
    let (mut rule, mut under) = (vec!['─'; columns], vec![' '; LABELS + 1 + columns + LABELS]);
    for tick in &labels.labelled {
        let Some(column) = cell(x, tick.at, columns) else { continue };
        rule[column] = '┬';
        let begin = LABELS + 1 + column - tick.label.chars().count() / 2;
        tick.label.chars().zip(begin..).for_each(|(c, place)| under[place] = c);
    }
    lines.push(format!("{:LABELS$}└{}", "", rule.iter().collect::<String>()));
    lines.push(under.iter().collect());
    let what = [Some(picture.x.label.clone()), labels.factor].into_iter().flatten().collect::<Vec<_>>().join(" ");
    lines.push(format!("{:LABELS$} {what}", ""));
    for (curve, mark) in curves.iter().zip(&marks) {
        lines.push(format!("{:LABELS$} {mark} {}", "", curve.label));
    }
    Ok(lines.iter().map(|line| line.trim_end().to_owned() + "\n").collect())
}

/// The range of an axis: as given, or around these values.
fn range(picture: &Picture, axis: &Axis, values: impl Iterator<Item = f64> + Clone) -> Result<Interval, PictureError> {
    if let Some(interval) = given(axis)? {
        return Ok(interval);
    }
    let measures = values.clone().filter_map(|value| measure(axis.scale, value).ok());
    around(axis.scale, std::iter::once(measures.collect()), 0.0).ok_or_else(|| {
        let left_out = |wanted| values.clone().filter(|&value| measure(axis.scale, value) == Err(wanted)).count();
        PictureError::NothingToDraw {
            title: picture.title.clone(),
            axis: axis.label.clone(),
            not_finite: left_out(super::axis::LeftOut::NotFinite),
            not_positive: left_out(super::axis::LeftOut::NotPositive),
        }
    })
}
