//! The ring in time: the third component of the spins as a colour, and the energy.

use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::plotters::prelude::Rectangle;
use clebsch_examples::figure::plotters::style::Color;
use clebsch_examples::figure::{self, BLUE, Panel, Series};
use clebsch_examples::scene::Failure;

/// Above the field, below the change of the energy.
pub fn draw(flags: &Flags, sites: usize, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 600), |area| {
        let title = format!("A ring of {sites} spins: component along the field, site by site (upwards) in time");
        let area = figure::caption(area, &title)?;
        let (above, below) = figure::rows(&area, 330.0);
        picture(watch, &above)?;
        energy(watch).draw(&below)
    })
}

/// One rectangle for each site and time that was looked at.
fn picture(watch: &Watch, area: &figure::Area<'_>) -> figure::Drawn {
    let (width, height) = area.dim_in_pixel();
    let (left, right) = (640.0, f64::from(width) - 180.0);
    let columns = watch.picture.len().max(1) as f64;
    for (column, (_, spins)) in watch.picture.iter().enumerate() {
        let rows = spins.len().max(1) as f64;
        let x = |place: f64| (left + (right - left) * place / columns).round() as i32;
        let y = |place: f64| (f64::from(height) * (1.0 - place / rows)).round() as i32;
        for (row, z) in spins.iter().enumerate() {
            let corners = [(x(column as f64), y(row as f64 + 1.0)), (x(column as f64 + 1.0), y(row as f64))];
            area.draw(&Rectangle::new(corners, figure::along((z + 1.0) / 2.0).filled()))?;
        }
    }
    Ok(())
}

fn energy(watch: &Watch) -> Panel<'static> {
    let series = vec![Series { label: "", colour: BLUE, points: watch.energies.clone() }];
    Panel { title: "Change of the energy of a spin", unit: "1/s²", x_label: "time (s)", series }
}
