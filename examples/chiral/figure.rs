//! The third axis of all rotations at the end, and the rounding of a connection.

use crate::{Flags, SCENE, Watched};
use clebsch_examples::figure::{self, BLUE, ORANGE, Panel, Series, Vectors};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// A picture, and two curves.
pub fn draw(flags: &Flags, watched: &Watched) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1040, 480), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let left = figure::caption(&left, "The third axis of all rotations at the end, made from elements of edges")?;
        let axes: Vec<Vector3<f64>> = watched.q.iter().map(|q| q * Vector3::z()).collect();
        Vectors { side: flags.length, count: flags.sites, vectors: &axes }.draw(&left)?;
        let points = |of: fn(&crate::sheet::Seen) -> f64| {
            watched.seen.iter().map(|(time, seen)| (*time, of(seen) * 1e15)).collect()
        };
        let series = vec![
            Series { label: "curvature", colour: BLUE, points: points(|seen| seen.flatness) },
            Series { label: "apart from configurations", colour: ORANGE, points: points(|seen| seen.apart) },
        ];
        Panel {
            title: "Curvature, and elements less those of configurations",
            unit: "1e-15",
            x_label: "time (s)",
            series,
        }
        .draw(&right)
    })
}
