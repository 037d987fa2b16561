//! Figures as SVG: time series, paths on a sphere and in the plane.

mod canvas;
mod globe;
mod interval;
mod panel;
mod place;
mod plane;
mod theme;

pub use canvas::{Area, Drawn, draw};
pub use globe::{Globe, Pointer, Track, View};
pub use interval::Interval;
pub use panel::{Panel, Series};
pub use plane::{Arrow, Path, Plane};
pub use plotters::style::RGBColor;
pub use theme::{BLUE, GREEN, INK, ORANGE, PIECES, PURPLE, RED, along, caption, colour_bar, columns, pieces, rows};
