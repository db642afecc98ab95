//! Pictures: curves over two axes and bodies in motion as SVG, and curves in characters for terminals.
//!
//! - A [`Style`] has one colour, one dash and one width everywhere. Styles are nested (wide solid below,
//!   narrow broken above), so identical motions show all of themselves.
//! - A curve that alone would make a linear axis over five times as long is cut, with an arrowhead and the
//!   value that it reaches.
//! - The same input gives the same bytes. Points that move the line by less than 0.1 px are left out, more of
//!   them if a file would pass 60 kB.
//! - The ground is transparent. Ink is `currentColor`, which follows `prefers-color-scheme`.
//! - A point that cannot be drawn breaks the line, and the legend counts such points.

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
