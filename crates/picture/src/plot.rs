//! Plots: curves over axes, in panels.

use crate::style::Style;

/// One line of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Label in the legend. Curves of one style and label, in different panels, share a line of the legend.
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
    pub(crate) title: String,
    /// Horizontal axis of every panel.
    pub(crate) x: Axis,
    /// Row by row.
    pub(crate) panels: Vec<Panel>,
    /// How many panels stand side by side; at least 1.
    pub(crate) columns: usize,
    /// Height of each panel in pixels, unless its axes are in one unit.
    pub(crate) height: f64,
    /// Whether one unit is equally long on both axes; the shorter range is widened.
    pub(crate) equal: bool,
    /// Every `every`-th point of each curve has a dot (0: none), the first point of the first curve a ring.
    pub(crate) every: usize,
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

impl Picture {
    /// One panel.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, curves: Vec<Curve>) -> Self {
        Picture { height: 340.0, ..Picture::panels(title, x, vec![Panel::new(y, curves)], 1) }
    }

    /// One panel on whose axes, both linear, a unit is equally long. Where points are at equal times, `every`
    /// shows times and their direction: a dot on every `every`-th one, a ring where all begin; 0 for none.
    pub fn plane(title: impl Into<String>, axes: [&str; 2], curves: Vec<Curve>, every: usize) -> Self {
        let [x, y] = axes.map(Axis::linear);
        Picture { equal: true, every, ..Picture::new(title, x, y, curves) }
    }

    /// Panels over one horizontal axis, `columns` side by side.
    pub fn panels(title: impl Into<String>, x: Axis, panels: Vec<Panel>, columns: usize) -> Self {
        let columns = columns.min(panels.len()).max(1);
        Picture { title: title.into(), x, panels, columns, height: 150.0, equal: false, every: 0 }
    }
}
