//! Pictures for the reports: curves over two axes, and solids that move, written as SVG; curves for terminals
//! in characters.
//!
//! A [`Picture`] is one plot: a gap over time on two logarithmic axes with its certainty limit, or plane
//! motions over one another with dots at equal times ([`Picture::plane`]); or several over one shared
//! horizontal axis ([`Picture::panels`]): positions over time, one panel a coordinate.
//!
//! What every picture keeps:
//! - A [`Style`] has one colour, one dash and one width, the same everywhere. Styles are nested (wide solid
//!   below, narrow broken above), so that identical motions show all of themselves.
//! - A linear axis is as long as what is compared needs: a curve but the first that alone would make it over
//!   five times as long is cut, with an arrowhead where it leaves and the value that it gets to.
//! - The same input gives the same bytes. Coordinates are rounded to 0.1 px, and points that do not move the
//!   drawn line by more than that are left out. A file that would pass 60 kB is thinned further, to 1.6 px at
//!   the coarsest; a long curve that fills the plane may pass it all the same.
//! - The ground is transparent. Ink is `currentColor`: a mid-grey that is legible on white and on black, and
//!   which a viewer that knows `prefers-color-scheme` makes darker or lighter.
//! - A point that cannot be drawn (not finite, over 1e300 in magnitude, or under 1e-300 on a logarithmic
//!   axis) breaks the line, and the legend says how many there were.
//!
//! The SVG is written here, not by `plotters` (0.3.7): its SVG backend has fixed colours only: no `class`, no
//! `currentColor`, no dashes (each dash is an element, which defeats small files), no `<title>`; its legend
//! lies within the plot. It would only choose ticks.

mod axis;
mod bodies;
mod draw;
mod frame;
mod heat;
mod layout;
mod plain;
mod solid;
mod style;
#[cfg(test)]
mod tests;
mod text;
mod trace;

pub use bodies::{Bodies, MovingPicture};
pub use heat::HeatMap;
pub use solid::{Camera, Placement, Seen, Solid, Space};
pub use style::Style;

/// One line of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What the legend says. Curves of one style and label, in different panels, share a line of the legend.
    pub label: String,
    /// Colour, dash and width. A second label of the same style in one picture gets marks along its line.
    pub style: Style,
    /// Points in drawing order, each in the units of the axes. A single point is drawn as a dot.
    pub points: Vec<(f64, f64)>,
}

/// How values are laid along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences take equal lengths.
    Linear,
    /// Equal ratios take equal lengths. Values that are not positive are not drawn.
    Log,
}

/// One axis: what it measures, its scale and its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit: `x (m)`.
    pub label: String,
    /// How values are laid along the axis.
    pub scale: Scale,
    /// Lowest and highest value shown; `None` takes them from the points, with a small margin, but not from
    /// those of a [`Style::Family`], nor on a linear axis from those of a runaway. Points that all agree
    /// within 1e-6 of their magnitude are shown as one value in the middle of a range of ±5 %.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis with its range from the points.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis with its range from the points.
    pub fn log(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }
}

/// Curves over two axes: one panel or several, with one legend.
///
/// ```
/// use picture::{Curve, Picture, Style};
///
/// let circle = (0..=200).map(|i| (f64::from(i) / 200.0 * std::f64::consts::TAU).sin_cos());
/// let curve = Curve { label: "Chetaev".into(), style: Style::Chetaev, points: circle.collect() };
/// let svg = Picture::plane("Knife edge on a level plane", ["x (m)", "y (m)"], vec![curve], 40).to_svg()?;
/// assert!(svg.starts_with("<svg") && svg.contains("<title>Knife edge on a level plane</title>"));
/// assert!(svg.len() < 10_000);
/// # Ok::<(), picture::PictureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Headline of the picture, and its text for readers who do not see it.
    title: String,
    /// Horizontal axis of every panel.
    x: Axis,
    /// Row by row.
    panels: Vec<Panel>,
    /// How many panels stand side by side; at least 1.
    columns: usize,
    /// Height of each panel in pixels, unless its axes are in one unit.
    height: f64,
    /// Whether one unit is equally long on both axes; the shorter range is widened.
    equal: bool,
    /// Every `every`-th point of each curve has a dot (0: none), the first point of the first curve a ring.
    every: usize,
}

/// One plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What stands above it, if anything.
    pub title: String,
    /// Vertical axis.
    pub y: Axis,
    /// Lines, in the order of the legend.
    pub curves: Vec<Curve>,
}

impl Panel {
    /// Without a title.
    pub fn new(y: Axis, curves: Vec<Curve>) -> Self {
        Panel { title: String::new(), y, curves }
    }
}

/// Why a picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// No panel, or no point that is left to set the range of an axis that has none of its own.
    #[error(
        "nothing to draw in \"{title}\": no point sets the range of axis \"{axis}\" \
         ({not_finite} points are not finite, {not_positive} not positive on a logarithmic axis)"
    )]
    NothingToDraw {
        /// Title of the picture.
        title: String,
        /// Label of the axis whose range is open.
        axis: String,
        /// Points that are not finite, or over 1e300 in magnitude.
        not_finite: usize,
        /// Points that are not positive on a logarithmic axis.
        not_positive: usize,
    },
    /// A range not finite, not rising, narrower than 1e-9 of its magnitude, or with 0 on a logarithmic axis.
    #[error(
        "axis \"{axis}\" cannot run from {low:e} to {high:e}: the ends must be finite, at most 1e300 in magnitude, rising, \
         at least 1e-9 of their magnitude apart, and positive on a logarithmic axis"
    )]
    Range {
        /// Label of the axis.
        axis: String,
        /// Lowest value asked for.
        low: f64,
        /// Highest value asked for.
        high: f64,
    },
}

impl Picture {
    /// One panel.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, curves: Vec<Curve>) -> Self {
        Picture { height: 340.0, ..Picture::panels(title, x, vec![Panel::new(y, curves)], 1) }
    }

    /// One panel on whose axes, both linear, a unit is equally long. Where points are at equal times, `every`
    /// shows times and their direction: a dot on every so many-th one, a ring where all begin; 0 for none.
    pub fn plane(title: impl Into<String>, axes: [&str; 2], curves: Vec<Curve>, every: usize) -> Self {
        let [x, y] = axes.map(Axis::linear);
        Picture { equal: true, every, ..Picture::new(title, x, y, curves) }
    }

    /// Panels over one horizontal axis, so many side by side.
    pub fn panels(title: impl Into<String>, x: Axis, panels: Vec<Panel>, columns: usize) -> Self {
        let columns = columns.min(panels.len()).max(1);
        Picture { title: title.into(), x, panels, columns, height: 150.0, equal: false, every: 0 }
    }

    /// The picture as a complete SVG document.
    ///
    /// # Errors
    /// [`PictureError`], where an axis cannot be drawn.
    pub fn to_svg(&self) -> Result<String, PictureError> {
        draw::document(self)
    }

    /// The first panel in characters: lines of at most `width`, `height` rows of curves, axes and a legend;
    /// the first curve in letters `a`, the second in `b`, thresholds dotted.
    ///
    /// # Errors
    /// [`PictureError`], where an axis cannot be drawn.
    pub fn to_text(&self, width: usize, height: usize) -> Result<String, PictureError> {
        plain::text(self, width, height)
    }
}
