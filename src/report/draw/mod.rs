//! Pictures: figures of curves, bars and maps as plain shapes, written as SVG or PNG.

mod axis;
mod contour;
mod figure;
mod letters;
mod panel;
mod picture;
mod plot;
mod png;
mod svg;

pub use contour::Map;
pub use figure::Figure;
pub use panel::{Bar, Look, Marker, Note, Panel, Rule, Series, Shade, look};
pub use picture::{Colour, INK, Picture};
