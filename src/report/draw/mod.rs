//! Pictures: figures of curves, bars and maps as plain shapes, written as SVG or PNG.

mod axis;
mod chart;
mod contour;
mod letters;
mod picture;
mod png;

pub use chart::{Bar, Figure, Look, Marker, Note, Panel, Rule, Series, Shade, look};
pub use contour::Map;
pub use picture::{Colour, Picture};
