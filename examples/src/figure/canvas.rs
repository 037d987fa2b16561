//! An SVG file to draw on.

use super::place::default_path;
use super::theme::PAPER;
use crate::flags::Run;
use crate::scene::{Failure, say};
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, SVGBackend};
use std::io;
use std::path::Path;

/// Units of the drawing per pixel of the page: the backend rounds to integer units, which would make curves jagged
/// at 1.
pub(super) const FINENESS: u32 = 10;

/// A part of the figure, in units of 1/10 pixel.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The error of a drawing operation.
pub type Broken = DrawingAreaErrorKind<io::Error>;

/// The outcome of a drawing operation.
pub type Drawn = Result<(), Broken>;

/// Draws a figure of `width` × `height` pixels, writes it to `--figure` or its default place, and says where it is.
///
/// # Errors
/// [`Failure::File`]
pub fn draw(
    run: &Run,
    name: &str,
    (width, height): (u32, u32),
    paint: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<(), Failure> {
    draw_to(run.figure.as_deref(), name, (width, height), paint)
}

/// The same for a program without the flags of scenes: to `path`, or to the default place of `name`.
///
/// # Errors
/// [`Failure::File`]
pub fn draw_to(
    path: Option<&Path>,
    name: &str,
    (width, height): (u32, u32),
    paint: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<(), Failure> {
    let path = path.map_or_else(|| default_path(name), Path::to_owned);
    let svg = render((width, height), paint).map_err(io::Error::other).map_err(Failure::file(&path))?;
    write(&path, &svg).map_err(Failure::file(&path))?;
    say(format_args!("figure      {}", path.display()));
    Ok(())
}

fn render(
    (width, height): (u32, u32),
    paint: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<String, DrawingAreaErrorKind<io::Error>> {
    let (fine_width, fine_height) = (width * FINENESS, height * FINENESS);
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

fn write(path: &Path, svg: &str) -> io::Result<()> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, svg)
}
