//! Nutation: the path of the axis, its tilt, and the conserved quantities.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RGBColor};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;

/// Left the path of the body axis on the sphere; right tilt, energy and vertical momentum against time.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    let Some(&start) = watch.samples.first() else { return Ok(()) };
    figure::draw(&flags.run, SCENE.name, (1000, 540), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let title = format!("Axis of a heavy top, order {}, steps of {} s", flags.run.order, flags.run.step_size);
        globe(&figure::caption(&left, &title)?, flags, watch)?;
        let (first, rest) = figure::rows(&right, 165.0);
        let (second, third) = figure::rows(&rest, 165.0);
        let curve = |title, unit, x_label, colour: RGBColor, value: &dyn Fn(&Sample) -> f64| {
            let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
            Panel { title, unit, x_label, series: vec![Series { label: "", colour, points }] }
        };
        curve("Tilt of the axis", "degrees", "", ORANGE, &Sample::tilt).draw(&first)?;
        let energy = |sample: &Sample| sample.energy - start.energy;
        curve("Energy, change since the start", "J", "", BLUE, &energy).draw(&second)?;
        let vertical = |sample: &Sample| sample.vertical - start.vertical;
        curve("Vertical momentum, change since the start", "kg·m²/s", "time (s)", GREEN, &vertical).draw(&third)
    })
}

fn globe(area: &Area<'_>, flags: &Flags, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.samples.iter().map(|sample| sample.axis.into()).collect();
    let mut pointers = vec![Pointer { label: "up", direction: [0.0, 0.0, 1.0], colour: INK }];
    pointers.extend(path.last().map(|&direction| Pointer { label: "axis", direction, colour: PURPLE }));
    // The axis to the right of the observer, where its name has room.
    let azimuth = path.last().map_or(0.0, |axis| axis[1].atan2(axis[0]).to_degrees() - 65.0);
    let tracks = [Track { points: &path, colour: None, width: 1.4 }];
    Globe { view: View { azimuth, elevation: 35.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    figure::colour_bar(area, "0 s", &format!("{} s", flags.run.duration()))
}
