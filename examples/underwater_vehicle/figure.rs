//! The wandering axis of the rise, and growth rates on both sides of the thresholds.

use crate::survey::{Case, Family};
use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RGBColor};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;

/// Left the path of the long axis on the sphere; right its tilt, the energy, and growth rates: theory and steps.
pub fn draw(flags: &Flags, watch: &Watch, cases: &[Case]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 600), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let title = format!("Axis of a rising vehicle: ballast {} m, spin {} rad/s", flags.offset, flags.spin);
        globe(&figure::caption(&left, &title)?, flags, watch)?;
        let (first, rest) = figure::rows(&right, 160.0);
        let (second, third) = figure::rows(&rest, 180.0);
        curve(watch, ("Tilt of the axis", "degrees", ""), ORANGE, Sample::tilt).draw(&first)?;
        curve(watch, ("Energy, change since the start", "J", "time (s)"), BLUE, |sample| sample.energy)
            .draw(&second)?;
        growth(flags, cases).draw(&third)
    })
}

fn globe(area: &Area<'_>, flags: &Flags, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.samples.iter().map(|sample| sample.axis.into()).collect();
    let mut pointers = vec![Pointer { label: "up", direction: [0.0, 0.0, 1.0], colour: INK }];
    pointers.extend(path.last().map(|&direction| Pointer { label: "axis", direction, colour: PURPLE }));
    let tracks = [Track { points: &path, colour: None, width: 1.2 }];
    Globe { view: View { azimuth: 30.0, elevation: 55.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    figure::colour_bar(area, "0 s", &format!("{} s", flags.run.duration()))
}

fn curve<'a>(
    watch: &Watch,
    (title, unit, x_label): (&'a str, &'a str, &'a str),
    colour: RGBColor,
    value: fn(&Sample) -> f64,
) -> Panel<'a> {
    let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
    Panel { title, unit, x_label, series: vec![Series { label: "", colour, points }] }
}

/// Lines are the linear theory, crosses the steps.
fn growth(flags: &Flags, cases: &[Case]) -> Panel<'static> {
    let mut series = Vec::new();
    for (family, colour) in Family::ALL.into_iter().zip([GREEN, BLUE, ORANGE]) {
        let found: Vec<&Case> = cases.iter().filter(|case| case.family == family).collect();
        if found.is_empty() {
            continue;
        }
        let base = flags.family(family).0;
        let ratio = |i: i32| f64::from(i) / 200.0;
        let theory = |i: i32| (ratio(i), family.member(&base, ratio(i)).oscillation().growth());
        series.push(Series { label: family.name(), colour, points: (0..=420).map(theory).collect() });
        let highest = found.iter().fold(0.0, |highest: f64, case| highest.max(case.growth));
        let crosses = found.iter().flat_map(|case| cross(case.ratio, case.growth, 0.01, 0.02 * highest)).collect();
        series.push(Series { label: "", colour: INK, points: crosses });
    }
    Panel { title: "Growth, × by steps", unit: "1/s", x_label: "ballast, or spin, over its threshold", series }
}

fn cross(x: f64, y: f64, width: f64, height: f64) -> [(f64, f64); 6] {
    let gap = (x, f64::NAN);
    [(x - width, y - height), (x + width, y + height), gap, (x - width, y + height), (x + width, y - height), gap]
}
