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

#[doc(hidden)]
pub mod axis;
mod bodies;
mod draw;
mod error;
mod frame;
mod heat;
mod layout;
mod plain;
mod plot;
mod solid;
mod style;
#[doc(hidden)]
pub mod text;
#[doc(hidden)]
pub mod trace;

pub use bodies::{Bodies, MovingPicture};
pub use draw::BUDGET;
pub use error::PictureError;
pub use heat::HeatMap;
pub use plot::{Axis, Curve, Panel, Picture, Scale};
pub use solid::{Camera, Placement, Seen, Solid, Space};
pub use style::{BLUE, GREEN, INKS, PURPLE, Stroke, Style, VERMILION};
