//! The field at four times: colours and arrows are directions about the third axis.

use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, Panel, Series, Vectors};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// Four pictures, and the energy below.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 1120), |area| {
        let title = "Unit vectors on a sheet: arrows show q1 and q2; the paper is q = e3, colours are directions, black is q = -e3";
        let mut area = figure::caption(area, title)?;
        for pair in watch.pictures.chunks(2).take(2) {
            let (row, below) = figure::rows(&area, 455.0);
            let (left, right) = figure::columns(&row, 500.0);
            for (picture, place) in pair.iter().zip([left, right]) {
                sheet(flags, picture, &place)?;
            }
            area = below;
        }
        let series = vec![Series { label: "", colour: BLUE, points: watch.energies.clone() }];
        Panel { title: "Change of the energy over the energy", unit: "", x_label: "time (s)", series }.draw(&area)
    })
}

fn sheet(flags: &Flags, (time, q): &(f64, Vec<Vector3<f64>>), area: &Area<'_>) -> Drawn {
    let (area, _) = figure::columns(area, 470.0);
    let area = figure::caption(&area, &format!("{time:.2} s"))?;
    Vectors { side: flags.length, count: flags.sites, vectors: q }.draw(&area)
}
