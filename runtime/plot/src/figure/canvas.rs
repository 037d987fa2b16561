//! An SVG file to draw on.

use super::theme::PAPER;
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, SVGBackend};
use std::io;

/// Units of the drawing per pixel of the page: the backend rounds to integer units, which would make curves jagged
/// at 1.
pub(super) const FINENESS: u32 = 10;

/// A part of the figure, in units of 1/10 pixel.
///
/// ```
/// use clebsch_plot::figure::plotters::{prelude::Circle, style::Color};
/// use clebsch_plot::figure::{self, Area, Drawn, TEAL};
///
/// /// A dot of 20 pixels in the corner.
/// fn dot(area: &Area<'_>) -> Drawn {
///     area.draw(&Circle::new((0, 0), 200, TEAL.filled()))
/// }
/// let svg = figure::svg((100, 100), dot)?;
/// # assert!(svg.contains("<circle"));
/// # Ok::<(), figure::Broken>(())
/// ```
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The error of a drawing operation.
///
/// ```
/// use clebsch_plot::figure::{self, Broken, Drawn};
///
/// /// A picture that others may have refused.
/// fn twice(first: Drawn) -> Result<String, Broken> {
///     first?;
///     figure::svg((100, 100), |_| Ok(()))
/// }
/// # assert!(twice(Ok(())).is_ok());
/// ```
pub type Broken = DrawingAreaErrorKind<io::Error>;

/// The outcome of a drawing operation.
///
/// ```
/// use clebsch_plot::figure::{Area, Drawn, Panel};
///
/// fn draw(area: &Area<'_>) -> Drawn {
///     Panel { title: "nothing yet", unit: "", x_label: "time (s)", series: Vec::new() }.draw(area)
/// }
/// # assert!(clebsch_plot::figure::svg((300, 200), draw).is_ok());
/// ```
pub type Drawn = Result<(), Broken>;

/// A picture of `width` × `height` pixels, as the text of an SVG file. `paint` draws on its area.
///
/// ```
/// use clebsch_plot::figure::{self, BLUE, Panel, Series};
///
/// let points = (0..100).map(|i| f64::from(i) / 10.0).map(|t| (t, t.sin())).collect();
/// let curve = Series { label: "", colour: BLUE, points };
/// let panel = Panel { title: "Tilt", unit: "rad", x_label: "time (s)", series: vec![curve] };
/// let svg = figure::svg((600, 200), |area| panel.draw(area))?;
/// assert!(svg.starts_with("<svg width=\"600\" height=\"200\"") && svg.contains("<polyline"));
/// # Ok::<(), figure::Broken>(())
/// ```
///
/// # Errors
/// Those of `paint`.
pub fn svg((width, height): (u32, u32), paint: impl FnOnce(&Area<'_>) -> Drawn) -> Result<String, Broken> {
    let (fine_width, fine_height) = (width.saturating_mul(FINENESS), height.saturating_mul(FINENESS));
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (fine_width, fine_height)).into_drawing_area();
        area.fill(&PAPER)?;
        paint(&area)?;
        area.present()?;
    }
    // The page size in pixels; the viewBox keeps the finer units.
    let size = |width: u32, height: u32| format!("width=\"{width}\" height=\"{height}\"");
    Ok(svg.replacen(&size(fine_width, fine_height), &size(width, height), 1))
}
