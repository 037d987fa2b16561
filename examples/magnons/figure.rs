//! Both frequencies against k, with measured ones, and the packet over space and time.

use crate::cone::{Branch, Cone};
use crate::packet::Packet;
use crate::{Flags, Measured, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Cells, Drawn, GREEN, ORANGE, Panel, RED, Series, TEAL, diverging};
use clebsch_examples::scene::Failure;
use std::f64::consts::PI;

/// Columns of the picture.
const COLUMNS: usize = 160;
/// Points of a curve.
const POINTS: usize = 120;

/// Left the frequencies, right the packet.
pub fn draw(flags: &Flags, measured: &[Measured], packet: &Packet) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 640), |area| {
        let (left, right) = figure::columns(area, 480.0);
        let (above, below) = figure::rows(&left, 310.0);
        let heisenberg = curve(flags, |cone| cone.heisenberg());
        let slow = curve(flags, |cone| cone.frequency(Branch::Slow));
        let fast = curve(flags, |cone| cone.frequency(Branch::Fast));
        let marks = |branch: Branch| marks(&measured.iter().filter(|one| one.branch == branch).collect::<Vec<_>>());
        let series = vec![
            Series { label: "Heisenberg", colour: GREEN, points: heisenberg },
            Series { label: "with inertia", colour: BLUE, points: slow },
            Series { label: "measured", colour: RED, points: marks(Branch::Slow) },
        ];
        Panel { title: "Slow waves: frequency", unit: "1/s", x_label: "", series }.draw(&above)?;
        let series = vec![
            Series { label: "continuous time", colour: ORANGE, points: fast },
            Series { label: "steps", colour: TEAL, points: curve(flags, |cone| cone.of_steps(Branch::Fast)) },
            Series { label: "measured", colour: RED, points: marks(Branch::Fast) },
        ];
        Panel { title: "Fast waves, nutation", unit: "1/s", x_label: "k (rad)", series }.draw(&below)?;
        picture(packet, &right)
    })
}

fn curve(flags: &Flags, frequency: impl Fn(&Cone) -> f64) -> Vec<(f64, f64)> {
    let k = |i: usize| PI * i as f64 / POINTS as f64;
    (0..=POINTS).map(|i| (k(i), frequency(&Cone { k: k(i), ..flags.cone() }))).collect()
}

/// A cross for each measured frequency.
fn marks(measured: &[&Measured]) -> Vec<(f64, f64)> {
    let span = |of: fn(&Measured) -> f64| {
        let values = || measured.iter().map(|one| of(one));
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let (wide, high) = (span(|one| one.k) / 90.0, span(|one| one.found) / 50.0);
    let cross = |one: &&Measured| {
        let (x, y) = (one.k, one.found);
        let gap = (x, f64::NAN);
        [(x - wide, y), (x + wide, y), gap, (x, y - high), (x, y + high), gap]
    };
    measured.iter().flat_map(cross).collect()
}

fn picture(packet: &Packet, area: &Area<'_>) -> Drawn {
    let area = figure::caption(area, "A packet of slow waves: q1 over the ring and time")?;
    let columns: Vec<Vec<_>> = (0..packet.sites)
        .step_by(packet.sites.div_ceil(COLUMNS))
        .map(|i| packet.pictures.iter().map(|(_, q)| diverging(q[i])).collect())
        .collect();
    let end = packet.pictures.last().map_or(1.0, |(time, _)| *time);
    let x = (0.0, packet.sites as f64);
    Cells { x_label: "site", y_label: "t (s)", x, y: (0.0, end), columns: &columns }.draw(&area).map(|_| ())
}
