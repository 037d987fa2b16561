//! u over space and time: two kinks that meet, and a breather; errors against the spacing.

use crate::study::Errors;
use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{
    self, Area, BLUE, Cells, Curve, Decades, Drawn, GREEN, ORANGE, PURPLE, Panel, RED, Series, TEAL, diverging,
};
use clebsch_examples::scene::Failure;
use std::f64::consts::TAU;

/// Columns of a picture.
const COLUMNS: usize = 150;

/// Above both pictures, below the middle of the breather and the errors.
pub fn draw(flags: &Flags, pair: &Watch, breather: &Watch, errors: &[Errors]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 860), |area| {
        let (above, below) = figure::rows(area, 500.0);
        let (left, right) = figure::columns(&above, 500.0);
        picture(flags, pair, "A kink and an antikink pass through each other: u from -2π (blue) to 2π (red)", &left)?;
        picture(flags, breather, "A breather: u over x and t, the same colours", &right)?;
        let (left, right) = figure::columns(&below, 500.0);
        let curve = |which: usize| breather.middle.iter().map(|(time, both)| (*time, both[which])).collect();
        let series = vec![
            Series { label: "closed form", colour: ORANGE, points: curve(1) },
            Series { label: "steps", colour: BLUE, points: curve(0) },
        ];
        Panel { title: "Middle of the breather, by angles", unit: "rad", x_label: "time (s)", series }.draw(&left)?;
        let colours = [BLUE, TEAL, GREEN, RED, ORANGE, PURPLE];
        let dx = flags.spacing;
        let curves: Vec<Curve<'_>> = errors
            .iter()
            .zip(colours.into_iter().cycle())
            .map(|(errors, colour)| Curve {
                label: &errors.name,
                colour,
                width: 1.6,
                points: [2.0 * dx, dx, dx / 2.0].into_iter().zip(errors.values.map(f64::abs)).collect(),
                ringed: Vec::new(),
            })
            .collect();
        Decades { title: "Errors", x_label: "spacing (m)", y_label: "m/s, rad", curves: &curves }.draw(&right)
    })
}

fn picture(flags: &Flags, watch: &Watch, title: &str, area: &Area<'_>) -> Drawn {
    let area = figure::caption(area, title)?;
    let sites = watch.pictures.first().map_or(1, |(_, angles)| angles.len());
    let some = (0..sites).step_by(sites.div_ceil(COLUMNS));
    let column = |i: usize| watch.pictures.iter().map(|(_, angles)| diverging(angles[i] / TAU)).collect();
    let columns: Vec<Vec<_>> = some.map(column).collect();
    let (from, to) = match (watch.pictures.first(), watch.pictures.last()) {
        (Some((from, _)), Some((to, _))) => (*from, *to),
        _ => (0.0, 1.0),
    };
    let half = flags.length / 2.0;
    let cells = Cells { x_label: "x (m)", y_label: "t (s)", x: (-half, half), y: (from, to), columns: &columns };
    cells.draw(&area).map(|_| ())
}
