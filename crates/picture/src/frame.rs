//! Sizes: where each plot of a document stands, and its ranges and ticks.

use super::axis::{self, Direction, Interval, TICK_SIZE, Ticks};
use super::layout::{self, Entry, Measured, WIDTH};
use super::plot::{Curve, Panel, Picture};
use super::style::Style;
use super::text::{width, wrap};
use super::trace::{Extent, Place};

/// Font size of the headline, in pixels.
pub(super) const TITLE_SIZE: f64 = 15.0;
/// Height of the ticks and the label under a panel, in pixels.
const UNDER: f64 = 48.0;
/// How much wider bold text is.
pub(super) const BOLD: f64 = 1.12;
/// Height of one row of the legend, in pixels.
pub(super) const LEGEND_ROW: f64 = 20.0;

/// What is the same for all plots of a document.
pub(super) struct Frame {
    pub(super) title: Vec<String>,
    pub(super) left: f64,
    pub(super) legend_top: f64,
    pub(super) top: f64,
    pub(super) extent: Extent,
    pub(super) column: f64,
    pub(super) row: f64,
    pub(super) height: f64,
    pub(super) x: Interval,
    pub(super) y: Vec<Interval>,
}

/// A plot with its place in the document.
pub(super) struct Framed<'a> {
    pub(super) plot: &'a Panel,
    pub(super) measured: &'a [Measured],
    pub(super) corner: Place,
    pub(super) extent: Extent,
    pub(super) x: Interval,
    pub(super) y: Interval,
    pub(super) x_ticks: Ticks,
    pub(super) y_ticks: Ticks,
    /// Label of the horizontal axis.
    pub(super) x_label: &'a str,
    /// Whether the range of the horizontal axis is that of what is compared.
    pub(super) open: bool,
    pub(super) every: usize,
    pub(super) legend: &'a [Entry],
}

impl Frame {
    pub(super) fn new(plots: &Picture, ranges: &layout::Ranges, legend: &[Entry]) -> Self {
        let (mut x, mut y) = (ranges.x, ranges.y.clone());
        let threshold =
            |curve: &Curve| (curve.style == Style::Threshold).then(|| width(&curve.label, TICK_SIZE) + 10.0);
        let right = plots
            .panels
            .iter()
            .flat_map(|panel| panel.curves.iter().filter_map(threshold))
            .fold(18.0, f64::max)
            .min(160.0);
        // With equal aspect the vertical range depends on the width, and so the labels must not.
        let ticks = y
            .iter()
            .zip(&plots.panels)
            .flat_map(|(&y, panel)| axis::ticks(panel.y.scale, y, plots.height, Direction::Vertical).labelled);
        let widths = ticks.map(|tick| width(&tick.label, TICK_SIZE) + 36.0);
        let left = if plots.equal { 74.0 } else { widths.fold(60.0, f64::max) };
        let columns = plots.columns as f64;
        let column = WIDTH / columns;
        let box_width = (column - left - right).max(40.0);
        let mut height = plots.height;
        if plots.equal {
            height = (box_width * (y[0].span() / x.span())).clamp(240.0, 480.0);
            let unit = (x.span() / box_width).max(y[0].span() / height);
            x = x.with_span(unit * box_width);
            y[0] = y[0].with_span(unit * height);
        }
        let title = wrap(&plots.title, BOLD * TITLE_SIZE, WIDTH - left - 8.0);
        let legend_top = 8.0 + 20.0 * title.len() as f64;
        let (_, legend_rows) = layout::place_legend(legend, WIDTH - left - 8.0);
        let has_factor = |(&y, panel): (&Interval, &Panel)| {
            let ticks = axis::ticks(panel.y.scale, y, height, Direction::Vertical);
            ticks.factor.is_some()
        };
        let headed = plots.panels.iter().any(|panel| !panel.title.is_empty());
        let over = if headed || y.iter().zip(&plots.panels).any(has_factor) { 24.0 } else { 14.0 };
        let top = legend_top + f64::from(legend_rows) * LEGEND_ROW + over;
        let row = height + over + UNDER;
        let rows = plots.panels.len().div_ceil(plots.columns) as f64;
        Self {
            title,
            left,
            legend_top,
            top,
            extent: Extent { width: box_width, height },
            column,
            row,
            height: top + rows * row - over,
            x,
            y,
        }
    }

    pub(super) fn plots<'a>(
        &self,
        plots: &'a Picture,
        measured: &'a [Vec<Measured>],
        legend: &'a [Entry],
    ) -> Vec<Framed<'a>> {
        let x_ticks = axis::ticks(plots.x.scale, self.x, self.extent.width, Direction::Horizontal);
        plots
            .panels
            .iter()
            .zip(measured)
            .zip(&self.y)
            .enumerate()
            .map(|(i, ((plot, measured), &y))| {
                let (column, row) = ((i % plots.columns) as f64, (i / plots.columns) as f64);
                Framed {
                    plot,
                    measured,
                    corner: (self.left + column * self.column, self.top + row * self.row),
                    extent: self.extent,
                    x: self.x,
                    y,
                    x_ticks: x_ticks.clone(),
                    y_ticks: axis::ticks(plot.y.scale, y, self.extent.height, Direction::Vertical),
                    x_label: &plots.x.label,
                    open: plots.x.range.is_none(),
                    every: plots.every,
                    legend,
                }
            })
            .collect()
    }
}

impl Framed<'_> {
    /// Pixels from the left edge of the plot.
    pub(super) fn across(&self, x: f64) -> f64 {
        self.x.fraction(x) * self.extent.width
    }

    /// Pixels from the top edge of the plot.
    pub(super) fn down(&self, y: f64) -> f64 {
        (1.0 - self.y.fraction(y)) * self.extent.height
    }
}
