//! The spin, the rocking and the energy of both spins against time.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, INK, ORANGE, Panel, Series};
use clebsch_examples::scene::Failure;

/// Three panels, one below the other.
pub fn draw(flags: &Flags, spins: &[Watch; 2]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (900, 600), |area| {
        let (first, rest) = figure::rows(area, 240.0);
        let (second, third) = figure::rows(&rest, 165.0);
        let mut series = curves(spins, |sample| sample.spins[0]);
        for watch in spins {
            let points = watch.samples.iter().map(|sample| (sample.time, sample.spins[1])).collect();
            series.insert(0, Series { label: "", colour: INK, points });
        }
        let title = "Spin about the third axis; below in black the other integrator";
        Panel { title, unit: "rad/s", x_label: "", series }.draw(&first)?;
        let series = curves(spins, |sample| sample.tilt.to_degrees());
        Panel { title: "Largest tilt of the third axis", unit: "°", x_label: "", series }.draw(&second)?;
        let series = curves(spins, |sample| sample.energy);
        Panel { title: "Error of the energy, relative", unit: "", x_label: "time (s)", series }.draw(&third)
    })
}

fn curves(spins: &[Watch; 2], value: fn(&Sample) -> f64) -> Vec<Series<'static>> {
    let curve = |(watch, colour): (&Watch, _)| {
        let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
        Series { label: watch.name, colour, points }
    };
    spins.iter().zip([ORANGE, BLUE]).map(curve).collect()
}
