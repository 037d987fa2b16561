//! Where the longest axis points as seen from the orbit, the librations, and the triangle of stability.

use crate::survey::Case;
use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RED};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;

/// Left the path of the longest axis in the orbiting frame; right the angles, Jacobi's integral, and the plane of k_yaw and k_roll.
pub fn draw(flags: &Flags, watch: &Watch, cases: &[Case]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 640), |area| {
        let (left, right) = figure::columns(area, 470.0);
        globe(&figure::caption(&left, "A spacecraft held by the gradient of gravity")?, watch)?;
        let (first, rest) = figure::rows(&right, 190.0);
        let (second, third) = figure::rows(&rest, 150.0);
        angles(watch).draw(&first)?;
        jacobi(watch).draw(&second)?;
        triangle(cases).draw(&third)
    })
}

fn globe(area: &Area<'_>, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.samples.iter().map(|sample| sample.axis.into()).collect();
    let axis = |label, direction| Pointer { label, direction, colour: INK };
    let mut pointers =
        vec![axis("outwards", [1.0, 0.0, 0.0]), axis("along", [0.0, 1.0, 0.0]), axis("normal", [0.0, 0.0, 1.0])];
    pointers.extend(path.last().map(|&direction| Pointer { label: "longest", direction, colour: PURPLE }));
    let tracks = [Track { points: &path, colour: None, width: 1.0 }];
    Globe { view: View { azimuth: -25.0, elevation: 15.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    let orbits = watch.samples.last().map_or(0.0, |sample| sample.orbits);
    figure::colour_bar(area, "0", &format!("{orbits:.1} orbits"))
}

fn angles(watch: &Watch) -> Panel<'static> {
    let curve = |label, colour, value: fn(&Sample) -> f64| {
        let points = watch.samples.iter().map(|sample| (sample.orbits, value(sample).to_degrees())).collect();
        Series { label, colour, points }
    };
    let series = vec![
        curve("yaw", ORANGE, |sample| sample.angles.x),
        curve("roll", GREEN, |sample| sample.angles.y),
        curve("pitch", BLUE, |sample| sample.angles.z),
    ];
    Panel { title: "Librations", unit: "degrees", x_label: "", series }
}

fn jacobi(watch: &Watch) -> Panel<'static> {
    let points = watch.samples.iter().map(|sample| (sample.orbits, sample.jacobi)).collect();
    let series = vec![Series { label: "", colour: PURPLE, points }];
    Panel { title: "Jacobi's integral, change since the start", unit: "J", x_label: "orbits", series }
}

/// The regions of Lagrange and of DeBra and Delp in the plane of k_yaw (to the right) and k_roll (upwards). Crosses are
/// unstable orientations of the body, the square is the stable one.
fn triangle(cases: &[Case]) -> Panel<'static> {
    let grid = |i: i32| f64::from(i) / 200.0;
    let edge = (-200..=0).map(|i| (grid(i), edge(grid(i)))).collect();
    let gap = (0.0, f64::NAN);
    let lagrange = vec![(0.0, 0.0), (1.0, 1.0), gap, (0.0, 0.0), (0.0, 1.0), gap, (0.0, 1.0), (1.0, 1.0)];
    let mark = |case: &Case| {
        let (x, y, size) = (case.linear.yaw, case.linear.roll, 0.02);
        let gap = (x, f64::NAN);
        let corners = [(x - size, y - size), (x + size, y - size), (x + size, y + size), (x - size, y + size)];
        let [a, b, c, d] = corners;
        if case.theory() > 0.0 { vec![a, c, gap, b, d, gap] } else { vec![a, b, c, d, a, gap] }
    };
    let points = |is_stable: bool| {
        cases.iter().filter(|case| (case.theory() == 0.0) == is_stable).flat_map(mark).collect::<Vec<_>>()
    };
    Panel {
        title: "k_roll against k_yaw",
        unit: "",
        x_label: "k_yaw",
        series: vec![
            Series { label: "Lagrange", colour: GREEN, points: lagrange },
            Series { label: "DeBra–Delp", colour: ORANGE, points: edge },
            Series { label: "stable", colour: BLUE, points: points(true) },
            Series { label: "unstable", colour: RED, points: points(false) },
        ],
    }
}

/// k₁ with 1 + 3k₁ + k₁k₃ = 4√(k₁k₃), for k₃ from −1 to 0.
fn edge(yaw: f64) -> f64 {
    // With u = √(−k₁): (3 + k₃) u² + 4√(−k₃) u − 1 = 0.
    let (a, b) = (3.0 + yaw, 4.0 * (-yaw).max(0.0).sqrt());
    let u = 2.0 / (b + (b * b + 4.0 * a).sqrt());
    -u * u
}
