//! What is drawn, before anything has a place.

use super::{Aspect, Axis, Curve};

/// Everything a document shows.
pub(super) struct Plots<'a> {
    pub(super) title: &'a str,
    pub(super) x: &'a Axis,
    pub(super) panels: Vec<Plot<'a>>,
    /// At least 1.
    pub(super) columns: usize,
    /// Height of each plot in pixels, with [`Aspect::Fill`].
    pub(super) height: f64,
    pub(super) aspect: Aspect,
}

/// One plot of the document.
pub(super) struct Plot<'a> {
    pub(super) y: &'a Axis,
    pub(super) curves: &'a [Curve],
}
