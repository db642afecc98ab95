//! Pictures for the reports: curves over two axes, written as SVG.
//!
//! [`Picture`] is one plot: plane motions over one another (with [`Aspect::Equal`]), or a gap over time on two
//! logarithmic axes with its thresholds and its error floor. [`SmallMultiples`] is several plots over one shared
//! horizontal axis: positions over time, one panel a coordinate.
//!
//! What every picture keeps:
//! - A [`Style`] has one colour, one dash and one width, the same everywhere. Styles are nested (wide solid below, narrow
//!   broken above), so that identical motions show all of themselves.
//! - The same input gives the same bytes. Coordinates are rounded to 0.1 px, and points that do not move the drawn line
//!   by more than that are left out. A file that would pass 60 kB is thinned further, to 1.6 px at the coarsest; a long curve
//!   that fills the plane may pass it all the same.
//! - The ground is transparent. Ink is `currentColor`: a mid-grey that is legible on white and on black, and which a
//!   viewer that knows `prefers-color-scheme` makes darker or lighter.
//! - A point that cannot be drawn (not finite, over 1e300 in magnitude, or under 1e-300 on a logarithmic axis) breaks
//!   the line, and the legend says how many there were.
//!
//! The SVG is written here rather than through `plotters` (0.3.7), whose SVG backend has fixed colours only: no `class`, no
//! `currentColor`, no dashes (a dashed line becomes one element for each dash, which defeats small files), no `<title>`;
//! and whose legend lies within the plot. What would be left to it is choosing ticks.

mod axis;
mod draw;
mod frame;
mod layout;
mod plots;
mod style;
#[cfg(test)]
mod tests;
mod text;
mod trace;

use plots::{Plot, Plots};
pub use style::Style;

/// One line of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What the legend says. Curves of one style and one label, in different panels, share one line of the legend.
    pub label: String,
    /// Colour, dash and width. A second label of the same style in one picture gets marks along its line.
    pub style: Style,
    /// Points in drawing order, each in the units of the axes. A single point is drawn as a dot, except for
    /// [`Style::Threshold`], where it is a level: a line at its height across the whole panel.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// A horizontal line across the whole panel, named at its right end instead of in the legend.
    pub fn threshold(label: impl Into<String>, level: f64) -> Self {
        Self { label: label.into(), style: Style::Threshold, points: vec![(f64::NAN, level)] }
    }

    /// The height of a curve that is a level across the whole panel.
    fn level(&self) -> Option<f64> {
        match (self.style, self.points.as_slice()) {
            (Style::Threshold, [(_, level)]) => Some(*level),
            _ => None,
        }
    }
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
    /// Lowest and highest value shown; `None` takes them from the points, with a small margin. Points that all agree
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

/// How the lengths of the two axes are related.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aspect {
    /// Each axis fills its side of the plot.
    Fill,
    /// One unit is equally long on both axes; the shorter range is widened. Both axes must be linear.
    Equal,
}

/// One plot.
///
/// ```
/// use picture::{Aspect, Axis, Curve, Picture, Style};
///
/// let circle = (0..=200).map(|i| (f64::from(i) / 200.0 * std::f64::consts::TAU).sin_cos());
/// let svg = Picture {
///     title: "Knife edge on a level plane".into(),
///     x: Axis::linear("x (m)"),
///     y: Axis::linear("y (m)"),
///     curves: vec![Curve { label: "Chetaev".into(), style: Style::Chetaev, points: circle.collect() }],
///     aspect: Aspect::Equal,
/// }
/// .to_svg()?;
/// assert!(svg.starts_with("<svg") && svg.contains("<title>Knife edge on a level plane</title>"));
/// assert!(svg.len() < 10_000);
/// # Ok::<(), picture::PictureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Headline of the picture, and its text for readers who do not see it.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Lines, in the order of the legend.
    pub curves: Vec<Curve>,
    /// How the lengths of the two axes are related.
    pub aspect: Aspect,
}

/// One plot of [`SmallMultiples`].
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Vertical axis.
    pub y: Axis,
    /// Lines, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// Several plots over one horizontal axis, with one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct SmallMultiples {
    /// Headline of the picture, and its text for readers who do not see it.
    pub title: String,
    /// Horizontal axis of every panel.
    pub x: Axis,
    /// The plots, row by row.
    pub panels: Vec<Panel>,
    /// How many plots stand side by side; 0 counts as 1.
    pub columns: usize,
}

/// Why a picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// No point is left to set the range of an axis that has none of its own.
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
    /// A picture without panels.
    #[error("\"{title}\" has no panels")]
    NoPanels {
        /// Title of the picture.
        title: String,
    },
    /// A range that is not finite, does not rise, is narrower than 1e-9 of its magnitude, or reaches 0 on a
    /// logarithmic axis.
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
    /// [`Aspect::Equal`] with a logarithmic axis.
    #[error("axis \"{axis}\" is logarithmic, which has no equal aspect")]
    EqualAspectOnLog {
        /// Label of the axis.
        axis: String,
    },
}

impl Picture {
    /// A picture in which each axis fills its side.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, curves: Vec<Curve>) -> Self {
        Picture { title: title.into(), x, y, curves, aspect: Aspect::Fill }
    }

    /// The picture as a complete SVG document.
    ///
    /// # Errors
    /// Every variant of [`PictureError`] but [`PictureError::NoPanels`].
    pub fn to_svg(&self) -> Result<String, PictureError> {
        if self.aspect == Aspect::Equal
            && let Some(axis) = [&self.x, &self.y].into_iter().find(|axis| axis.scale == Scale::Log)
        {
            return Err(PictureError::EqualAspectOnLog { axis: axis.label.clone() });
        }
        draw::document(&Plots {
            title: &self.title,
            x: &self.x,
            panels: vec![Plot { y: &self.y, curves: &self.curves }],
            columns: 1,
            height: 340.0,
            aspect: self.aspect,
        })
    }
}

impl SmallMultiples {
    /// All panels as one complete SVG document.
    ///
    /// # Errors
    /// Every variant of [`PictureError`] but [`PictureError::EqualAspectOnLog`].
    pub fn to_svg(&self) -> Result<String, PictureError> {
        if self.panels.is_empty() {
            return Err(PictureError::NoPanels { title: self.title.clone() });
        }
        draw::document(&Plots {
            title: &self.title,
            x: &self.x,
            panels: self.panels.iter().map(|panel| Plot { y: &panel.y, curves: &panel.curves }).collect(),
            columns: self.columns.clamp(1, self.panels.len()),
            height: 150.0,
            aspect: Aspect::Fill,
        })
    }
}
