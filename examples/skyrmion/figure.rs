//! The skyrmion, and the sweeps of both solvers.

use crate::{Flags, OF_CYCLE, SCENE, Solved};
use clebsch_examples::figure::{self, BLUE, Curve, Decades, ORANGE, RED, RGBColor, TEAL, Vectors};
use clebsch_examples::scene::Failure;

/// A picture of the middle grid, and curves of all.
pub fn draw(flags: &Flags, skyrmions: &[Solved], maps: &[Solved]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1040, 480), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let left = figure::caption(&left, "Arrows show q1 and q2; the paper is q = e3, black is q = -e3")?;
        if let Some(Solved { square, q, .. }) = skyrmions.get(1) {
            Vectors { side: square.side, count: square.sites(), vectors: q }.draw(&left)?;
        }
        let curve = |label: &'static str, colour: RGBColor, of: &[Solved], sweeps: fn(&Solved) -> u64| Curve {
            label,
            colour,
            width: 2.0,
            points: of.iter().map(|solved| (solved.square.sites() as f64, sweeps(solved) as f64)).collect(),
            ringed: Vec::new(),
        };
        let curves = [
            curve("skyrmion, over-relaxation", RED, skyrmions, |solved| solved.sweeps),
            curve("skyrmion, multigrid", ORANGE, skyrmions, |solved| OF_CYCLE * solved.cycles),
            curve("degree 0, over-relaxation", BLUE, maps, |solved| solved.sweeps),
            curve("degree 0, multigrid", TEAL, maps, |solved| OF_CYCLE * solved.cycles),
        ];
        Decades { title: "Sweeps to rest", x_label: "sites along a side", y_label: "sweeps", curves: &curves }
            .draw(&right)
    })
}
