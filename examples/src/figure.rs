//! The figures of scenes: drawn with [`clebsch_plot::figure`], and written to `--figure` or to their default place.

mod place;

use crate::flags::Run;
use crate::scene::{Failure, say};
pub use clebsch_plot::figure::*;
pub use place::default_path;
use std::io;
use std::path::Path as File;

/// Draws a figure of `width` × `height` pixels, writes it to `--figure` or its default place, and says where it is.
///
/// # Errors
/// [`Failure::File`]
pub fn draw(run: &Run, name: &str, size: (u32, u32), paint: impl FnOnce(&Area<'_>) -> Drawn) -> Result<(), Failure> {
    draw_to(run.figure.as_deref(), name, size, paint)
}

/// The same for a program without the flags of scenes: to `path`, or to the default place of `name`.
///
/// # Errors
/// [`Failure::File`]
pub fn draw_to(
    path: Option<&File>,
    name: &str,
    size: (u32, u32),
    paint: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<(), Failure> {
    let path = path.map_or_else(|| default_path(name), File::to_owned);
    let svg = svg(size, paint).map_err(io::Error::other).map_err(Failure::file(&path))?;
    write(&path, &svg).map_err(Failure::file(&path))?;
    say(format_args!("figure      {}", path.display()));
    Ok(())
}

fn write(path: &File, svg: &str) -> io::Result<()> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, svg)
}
