//! The words that all pictures share: title, size, text and file.

use crate::PlotError;
use crate::figure::{self, Area, Drawn};
use std::fs;
use std::path::Path;

/// Title and size of a picture.
#[derive(Clone, Debug)]
pub(crate) struct Page {
    pub title: String,
    /// Width and height, pixels.
    pub size: (u32, u32),
}

impl Page {
    /// A smaller picture has no room for its axes, and a larger one overflows the units of the drawing.
    const SIDES: (u32, u32) = (240, 20_000);

    pub fn new(title: &str, size: (u32, u32)) -> Self {
        Self { title: title.to_owned(), size }
    }

    pub fn resize(&mut self, width: u32, height: u32) {
        let within = |side: u32| side.clamp(Self::SIDES.0, Self::SIDES.1);
        self.size = (within(width), within(height));
    }

    /// The picture below its title.
    pub fn svg(&self, paint: impl FnOnce(&Area<'_>) -> Drawn) -> Result<String, PlotError> {
        self.untitled(
            |area| {
                if self.title.is_empty() { paint(area) } else { paint(&figure::caption(area, &self.title)?) }
            },
        )
    }

    /// The picture alone, for charts that have a title of their own.
    pub fn untitled(&self, paint: impl FnOnce(&Area<'_>) -> Drawn) -> Result<String, PlotError> {
        figure::svg(self.size, paint).map_err(|error| PlotError::Drawing(error.to_string()))
    }
}

/// Writes a text to a file. Its folder is made where it is missing.
pub(crate) fn write(path: &Path, text: &str) -> Result<(), PlotError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let made = folder.map_or(Ok(()), fs::create_dir_all);
    made.and_then(|()| fs::write(path, text)).map_err(|error| PlotError::File { path: path.to_owned(), error })
}

/// The methods of a type with a field `page` and a method `paint`.
macro_rules! picture {
    ($type:ident) => {
        impl $type {
            /// The same picture with another title; empty for none.
            #[must_use]
            pub fn title(mut self, title: &str) -> Self {
                self.page.title = title.to_owned();
                self
            }

            /// The same picture in another size, in pixels. Sides are at least 240 and at most 20 000.
            #[must_use]
            pub fn size(mut self, width: u32, height: u32) -> Self {
                self.page.resize(width, height);
                self
            }

            /// Writes the picture to a file, as SVG. A folder that is not there is made.
            ///
            /// # Errors
            /// Those of [`svg`](Self::svg), and [`PlotError::File`].
            pub fn save(&self, path: impl AsRef<std::path::Path>) -> Result<(), PlotError> {
                crate::picture::write(path.as_ref(), &self.svg()?)
            }
        }
    };
}
pub(crate) use picture;

/// Colours of curves, one after the other.
pub(crate) fn colour(index: usize) -> figure::RGBColor {
    const COLOURS: [figure::RGBColor; 6] =
        [figure::BLUE, figure::ORANGE, figure::GREEN, figure::RED, figure::PURPLE, figure::TEAL];
    COLOURS[index % COLOURS.len()]
}

/// A name that has room next to a chart.
pub(crate) fn short(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}
