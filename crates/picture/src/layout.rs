//! Where things stand: points in the measures of their axes, ranges, legend.

use super::axis::{self, Interval, LeftOut};
use super::error::PictureError;
use super::plot::{Axis, Curve, Panel, Picture};
use super::style::{MARKS, Style};
use super::text::{fit, width};

/// Width of every picture in pixels.
pub(super) const WIDTH: f64 = 720.0;
/// Font size of axis labels and legend, in pixels.
pub(super) const LABEL_SIZE: f64 = 13.0;
/// Length of the line in the legend, in pixels.
pub(super) const SWATCH: f64 = 42.0;

/// A curve in the measures of its axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Measured {
    /// Points that are joined by a line.
    pub(super) runs: Vec<Vec<(f64, f64)>>,
    pub(super) not_finite: usize,
    pub(super) not_positive: usize,
}

impl Measured {
    pub(super) fn new(curve: &Curve, x: &Axis, y: &Axis) -> Self {
        let mut measured = Self::default();
        let mut run = Vec::new();
        for &(at_x, at_y) in &curve.points {
            match (axis::measure(x.scale, at_x), axis::measure(y.scale, at_y)) {
                (Ok(at_x), Ok(at_y)) => run.push((at_x, at_y)),
                (x, y) => {
                    let not_finite = [x.err(), y.err()].contains(&Some(LeftOut::NotFinite));
                    *if not_finite { &mut measured.not_finite } else { &mut measured.not_positive } += 1;
                    measured.runs.push(std::mem::take(&mut run));
                }
            }
        }
        measured.runs.push(run);
        measured.runs.retain(|run| !run.is_empty());
        measured
    }

    pub(super) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.runs.iter().flatten().copied()
    }
}

/// The range of the horizontal axis, and of each vertical one.
pub(super) struct Ranges {
    pub(super) x: Interval,
    pub(super) y: Vec<Interval>,
}

/// Ranges as given, or from the points that the range of the other axis lets be seen.
pub(super) fn ranges(plots: &Picture, measured: &[Vec<Measured>]) -> Result<Ranges, PictureError> {
    let given_x = axis::given(&plots.x)?;
    let given_y = plots.panels.iter().map(|panel| axis::given(&panel.y)).collect::<Result<Vec<_>, _>>()?;
    let nothing = |axis: &Axis, curves: &mut dyn Iterator<Item = &Measured>| {
        let (not_finite, not_positive) =
            curves.fold((0, 0), |sum, curve| (sum.0 + curve.not_finite, sum.1 + curve.not_positive));
        PictureError::NothingToDraw { title: plots.title.clone(), axis: axis.label.clone(), not_finite, not_positive }
    };
    if plots.panels.is_empty() {
        return Err(nothing(&plots.x, &mut std::iter::empty()));
    }
    let seen = |limit: Option<Interval>, at: f64| limit.is_none_or(|limit| limit.contains(at));
    let margin = if plots.equal { 0.05 } else { 0.02 };
    let set = |panel: &Panel, measured: &Vec<Measured>, seen: &dyn Fn((f64, f64)) -> Option<f64>| {
        let curves = panel.curves.iter().zip(measured).filter(|(curve, _)| curve.style != Style::Family);
        curves.map(|(_, measured)| measured.points().filter_map(seen).collect()).collect::<Vec<Vec<f64>>>()
    };
    let all_x = plots
        .panels
        .iter()
        .zip(measured)
        .zip(&given_y)
        .flat_map(|((panel, curves), &limit)| set(panel, curves, &|(x, y)| seen(limit, y).then_some(x)));
    let x = given_x
        .or_else(|| axis::around(plots.x.scale, all_x, margin))
        .ok_or_else(|| nothing(&plots.x, &mut measured.iter().flatten()))?;
    let y = plots
        .panels
        .iter()
        .zip(measured)
        .zip(given_y)
        .map(|((panel, curves), given)| {
            let all_y = set(panel, curves, &|(x, y)| seen(given_x, x).then_some(y));
            given
                .or_else(|| axis::around(panel.y.scale, all_y.into_iter(), 0.05))
                .ok_or_else(|| nothing(&panel.y, &mut curves.iter()))
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Ranges { x, y })
}

/// One line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    label: String,
    pub(super) style: Style,
    /// The first label of a style has none, and after the fifth they repeat.
    pub(super) mark: Option<&'static str>,
    /// How many labels of this style came before.
    pub(super) rank: usize,
    points: usize,
    not_finite: usize,
    not_positive: usize,
}

impl Entry {
    /// An entry without marks, all of whose points are drawn.
    pub(super) fn plain(label: String, style: Style) -> Self {
        Entry { label, style, mark: None, rank: 0, points: 1, not_finite: 0, not_positive: 0 }
    }

    /// The label, and what is not drawn.
    pub(super) fn text(&self) -> String {
        let notes: Vec<String> = [(self.not_positive, "≤ 0"), (self.not_finite, "not finite")]
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        match (self.points, notes.is_empty()) {
            (0, true) => format!("{} (no points)", self.label),
            (_, true) => self.label.clone(),
            (_, false) => format!("{} (left out: {})", self.label, notes.join(", ")),
        }
    }

    /// Is this the entry of that curve?
    pub(super) fn stands_for(&self, curve: &Curve) -> bool {
        self.style == curve.style && self.label == curve.label
    }
}

/// The legend: an entry per style and label, in the order of curves. Thresholds are named where they stand.
pub(super) fn legend(plots: &Picture, measured: &[Vec<Measured>]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for (panel, measured) in plots.panels.iter().zip(measured) {
        for (curve, measured) in panel.curves.iter().zip(measured) {
            if curve.style == Style::Threshold {
                continue;
            }
            let known = entries.iter().position(|entry| entry.stands_for(curve));
            let at = known.unwrap_or_else(|| {
                let rank = entries.iter().filter(|entry| entry.style == curve.style).count();
                entries.push(Entry {
                    label: curve.label.clone(),
                    style: curve.style,
                    mark: rank.checked_sub(1).map(|n| MARKS[n % MARKS.len()]),
                    rank,
                    points: 0,
                    not_finite: 0,
                    not_positive: 0,
                });
                entries.len() - 1
            });
            entries[at].points += measured.points().count();
            entries[at].not_finite += measured.not_finite;
            entries[at].not_positive += measured.not_positive;
        }
    }
    entries
}

/// Where an entry of the legend stands, from its top left corner.
pub(super) struct Placed<'a> {
    pub(super) entry: &'a Entry,
    pub(super) text: String,
    pub(super) x: f64,
    pub(super) row: u32,
}

/// Set the legend in rows of at most `limit` pixels.
pub(super) fn place_legend(entries: &[Entry], limit: f64) -> (Vec<Placed<'_>>, u32) {
    let (mut x, mut row) = (0.0, 0);
    let mut placed = Vec::new();
    for entry in entries {
        let text = fit(&entry.text(), LABEL_SIZE, limit - SWATCH - 8.0);
        let needed = SWATCH + 8.0 + width(&text, LABEL_SIZE);
        if x > 0.0 && x + needed > limit {
            x = 0.0;
            row += 1;
        }
        placed.push(Placed { entry, text, x, row });
        x += needed + 16.0;
    }
    let rows = if placed.is_empty() { 0 } else { row + 1 };
    (placed, rows)
}
