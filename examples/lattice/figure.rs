//! Three layers of the block at the end: colours are directions about the third axis.

use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Cells, direction};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// Cells of a picture along each side.
const CELLS: usize = 40;
/// Layers, in parts of the block.
const LAYERS: [f64; 3] = [0.0, 1.0 / 6.0, 1.0 / 3.0];

/// One picture for each layer.
pub fn draw(flags: &Flags, q: &[Vector3<f64>]) -> Result<(), Failure> {
    let side = flags.side;
    figure::draw(&flags.run, SCENE.name, (1000, 370), |area| {
        let mut area = area.clone();
        for part in LAYERS {
            let layer = (part * side as f64) as usize;
            let (left, right) = figure::columns(&area, 330.0);
            let left = figure::caption(&left, &format!("Layer {layer} of {side}"))?;
            let place = |i: usize| (i * side) / CELLS;
            let colour = |i: usize, j: usize| {
                let q = &q[(layer * side + place(i)) * side + place(j)];
                direction(q.y.atan2(q.x), 1.0)
            };
            let columns: Vec<Vec<_>> = (0..CELLS).map(|i| (0..CELLS).map(|j| colour(i, j)).collect()).collect();
            let ends = (0.0, side as f64);
            Cells { x_label: "", y_label: "", x: ends, y: ends, columns: &columns }.draw(&left)?;
            area = right;
        }
        Ok(())
    })
}
