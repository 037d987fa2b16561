//! The pictures of the concepts in the book, and those of its page on plots. Each is drawn from steps of a declaration.
//! The numbers that the book quotes are claims.
//!
//! ```text
//! cargo run --release --example figures -- docs/book/src/concepts
//! ```
//!
//! Without a folder the pictures go to `figures` in the target folder of cargo.

mod body;
mod pendulum;
mod plots;
mod sleigh;
mod sphere;
mod string;
mod top;
mod turn;

use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{self, Area, Drawn, default_path};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_plot::PlotError;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Width and height of a picture, pixels.
const SIZE: (u32, u32) = (760, 360);

fn main() -> ExitCode {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    conclude(draw_all(&Pictures { folder }))
}

fn draw_all(pictures: &Pictures) -> Result<Claims, Failure> {
    let mut claims = Claims::new();
    body::group(pictures)?;
    body::action(pictures)?;
    body::momentum_map(pictures, &mut claims)?;
    sphere::discrete_lagrangian(pictures, &mut claims)?;
    pendulum::kick_and_drift(pictures)?;
    top::exact_drift(pictures, &mut claims)?;
    top::conserved(pictures, &mut claims)?;
    turn::optimal_control(pictures, &mut claims)?;
    sleigh::constraints(pictures, &mut claims)?;
    plots::plots(pictures, &mut claims)?;
    string::fields(pictures, &mut claims)?;
    Ok(claims)
}

/// Where the pictures go.
struct Pictures {
    folder: Option<PathBuf>,
}

impl Pictures {
    /// Draws the picture `name`.
    fn draw(&self, name: &str, paint: impl FnOnce(&Area<'_>) -> Drawn) -> Result<(), Failure> {
        figure::draw_to(Some(&self.path(name)), name, SIZE, paint)
    }

    /// Saves the picture `name` that a function of `clebsch-plot` has drawn.
    fn save(&self, name: &str, save: impl FnOnce(&Path) -> Result<(), PlotError>) -> Result<(), Failure> {
        let path = self.path(name);
        save(&path)?;
        say(format_args!("figure      {}", path.display()));
        Ok(())
    }

    fn path(&self, name: &str) -> PathBuf {
        let path = self.folder.as_deref().map(|folder| Path::join(folder, name).with_extension("svg"));
        path.unwrap_or_else(|| default_path(name))
    }
}
