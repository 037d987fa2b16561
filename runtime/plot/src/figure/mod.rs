//! Parts of figures, for pictures of your own: time series, powers of ten, paths on a sphere and in the plane, tables of colours.
//!
//! [`svg`] gives an [`Area`], which [`columns`], [`rows`] and [`caption`] divide, and each part draws into an area.
//! Numbers that are not finite are gaps, or are drawn somewhere: nothing here panics.
//!
//! Areas are those of [`plotters`], so its elements can be drawn on them too.
//!
//! ```
//! use clebsch_plot::figure::{self, Globe, ORANGE, Panel, Pointer, Series, Track, View};
//!
//! let path: Vec<[f64; 3]> = (0..200).map(|i| f64::from(i) / 10.0).map(|t| [t.cos() * 0.6, t.sin() * 0.6, 0.8]).collect();
//! let height = Series { label: "", colour: ORANGE, points: path.iter().map(|point| (point[0], point[1])).collect() };
//! let svg = figure::svg((1000, 500), |area| {
//!     let (left, right) = figure::columns(area, 470.0);
//!     let tracks = [Track { points: &path, colour: None, width: 1.4 }];
//!     let pointers = [Pointer { label: "up", direction: [0.0, 0.0, 1.0], colour: figure::INK }];
//!     let view = View { azimuth: 30.0, elevation: 25.0 };
//!     Globe { view, pointers: &pointers, tracks: &tracks }.draw(&figure::caption(&left, "A path")?)?;
//!     Panel { title: "seen from above", unit: "m", x_label: "x (m)", series: vec![height] }.draw(&right)
//! })?;
//! assert!(svg.contains("seen from above"));
//! # Ok::<(), figure::Broken>(())
//! ```

mod canvas;
mod cells;
mod decades;
mod globe;
mod interval;
mod panel;
mod plane;
mod theme;
mod vectors;

pub use canvas::{Area, Broken, Drawn, svg};
pub use cells::{Cells, Frame, direction, diverging};
pub use decades::{Curve, Decades};
pub use globe::{Globe, Pointer, Track, View};
pub use interval::Interval;
pub use panel::{Panel, Series};
pub use plane::{Arrow, Path, Plane};
pub use plotters;
pub use plotters::style::RGBColor;
pub use theme::{
    BLUE, GREEN, INK, ORANGE, PIECES, PURPLE, RED, TEAL, along, caption, colour_bar, columns, legend, pieces, rows,
};
pub use vectors::Vectors;
