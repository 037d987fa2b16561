//! The paths of some molecules, how warm all are, and their energy.

use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{
    self, Area, BLUE, Drawn, GREEN, Globe, ORANGE, PURPLE, Panel, RED, Series, Track, View,
};
use clebsch_examples::scene::Failure;

/// Left the sphere, right the kinetic energy and the change of the energy of a molecule.
pub fn draw(flags: &Flags, sites: usize, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 540), |area| {
        let (left, right) = figure::columns(area, 470.0);
        globe(&figure::caption(&left, &format!("Paths of five of {sites} molecules"))?, watch)?;
        let (above, below) = figure::rows(&right, 250.0);
        curve("Kinetic energy of a molecule", "", watch.kinetic.clone()).draw(&above)?;
        curve("Change of the energy of a molecule", "time (s)", watch.changes.clone()).draw(&below)
    })
}

fn globe(area: &Area<'_>, watch: &Watch) -> Drawn {
    let colours = [BLUE, ORANGE, GREEN, RED, PURPLE];
    let tracks: Vec<Track<'_>> = (watch.paths.iter().zip(colours))
        .map(|(points, colour)| Track { points, colour: Some(colour), width: 1.2 })
        .collect();
    Globe { view: View { azimuth: 35.0, elevation: 18.0 }, pointers: &[], tracks: &tracks }.draw(area)
}

fn curve<'a>(title: &'a str, x_label: &'a str, points: Vec<(f64, f64)>) -> Panel<'a> {
    Panel { title, unit: "1/s²", x_label, series: vec![Series { label: "", colour: BLUE, points }] }
}
