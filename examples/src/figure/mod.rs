//! Figures as SVG: time series, powers of ten, paths on a sphere and in the plane, tables of colours.

mod canvas;
mod cells;
mod decades;
mod globe;
mod interval;
mod panel;
mod place;
mod plane;
mod theme;
mod vectors;

pub use canvas::{Area, Broken, Drawn, draw, draw_to};
pub use cells::{Cells, Frame, direction, diverging};
pub use decades::{Curve, Decades};
pub use globe::{Globe, Pointer, Track, View};
pub use interval::Interval;
pub use panel::{Panel, Series};
pub use plane::{Arrow, Path, Plane};
pub use plotters::style::RGBColor;
pub use theme::{
    BLUE, GREEN, INK, ORANGE, PIECES, PURPLE, RED, TEAL, along, caption, colour_bar, columns, pieces, rows,
};
pub use vectors::Vectors;
