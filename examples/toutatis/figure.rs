//! The path of the long axis.

use crate::comparison::{Comparison, PUBLISHED};
use crate::periods::Period;
use crate::watch::{SHORT_PATH, Watch, angle_to_third};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, Drawn, Globe, INK, Interval, ORANGE, PIECES, Panel, Pointer, RGBColor};
use clebsch_examples::figure::{Series, Track, View, along, pieces};
use clebsch_examples::scene::Failure;

/// The path of the short axis.
const FAINT: RGBColor = RGBColor(176, 190, 208);
/// The short axis.
const GREY: RGBColor = RGBColor(104, 118, 138);

/// Left the path on the sphere of directions; right the same unrolled, and the periods.
pub fn draw(flags: &Flags, watch: &Watch, comparison: &Comparison) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 520), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let body = if flags.is_toutatis() { "Asteroid 4179 Toutatis" } else { "A tumbling body" };
        let days = flags.run.duration();
        let title = format!("{body}: its long axis over {days} days, its short axis over {}", days.min(SHORT_PATH));
        globe(&figure::caption(&left, &title)?, flags, watch)?;
        match comparison.measured.filter(|_| flags.is_toutatis()) {
            None => unrolled(&right, watch),
            Some(measured) => {
                let (upper, lower) = figure::rows(&right, 336.0);
                unrolled(&upper, watch)?;
                let (first, second) = figure::rows(&lower, 88.0);
                let interval = |title, period| {
                    let (published, uncertainty) = PUBLISHED.get(period);
                    Interval { title, published, uncertainty, computed: measured.get(period) }
                };
                interval("Rotation about the long axis, days: integrated and published", Period::Rotation)
                    .draw(&first)?;
                interval("Mean precession of the long axis, days", Period::Precession).draw(&second)
            }
        }
    })
}

fn globe(area: &Area<'_>, flags: &Flags, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.path.iter().map(|point| point.1).collect();
    let tracks = [
        Track { points: &watch.short_path, colour: Some(FAINT), width: 0.9 },
        Track { points: &path, colour: None, width: 2.2 },
    ];
    let mut pointers = vec![Pointer { label: "L", direction: [0.0, 0.0, 1.0], colour: INK }];
    pointers.extend(watch.short_path.last().map(|&direction| Pointer { label: "short axis", direction, colour: GREY }));
    pointers.extend(path.last().map(|&direction| Pointer { label: "long axis", direction, colour: ORANGE }));
    // The long axis to the right of the observer, where its name has room.
    let azimuth = path.last().map_or(0.0, |axis| axis[1].atan2(axis[0]).to_degrees() - 65.0);
    Globe { view: View { azimuth, elevation: 28.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    figure::colour_bar(area, "day 0", &format!("day {}", flags.run.duration()))
}

/// The angle to the momentum against the azimuth about it.
fn unrolled(area: &Area<'_>, watch: &Watch) -> Drawn {
    let series = pieces(&watch.path).enumerate().map(|(index, piece)| {
        let colour = along(index as f64 / (PIECES - 1) as f64);
        Series { label: "", colour, points: unroll(piece) }
    });
    Panel {
        title: "Angle between the long axis and the angular momentum L",
        unit: "degrees",
        x_label: "azimuth about L (degrees)",
        series: series.collect(),
    }
    .draw(area)
}

/// (azimuth, angle), with a gap where the azimuth passes 360°.
fn unroll(path: &[(f64, [f64; 3])]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(path.len());
    for (_, axis) in path {
        let azimuth = axis[1].atan2(axis[0]).to_degrees().rem_euclid(360.0);
        if points.last().is_some_and(|last| (last.0 - azimuth).abs() > 180.0) {
            points.push((azimuth, f64::NAN));
        }
        points.push((azimuth, angle_to_third(axis)));
    }
    points
}
