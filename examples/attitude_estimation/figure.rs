//! The errors of the attitude from each start.

use crate::orbit::Orbit;
use crate::report::Case;
use crate::{Estimate, Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, ORANGE, Panel, Series};
use clebsch_examples::scene::Failure;

/// One panel for each start.
pub fn draw(flags: &Flags, orbit: &Orbit, cases: &[Case]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (above, below) = figure::rows(area, 270.0);
        let [above, below] = [above, below].map(|row| figure::columns(&row, 500.0));
        for (area, case) in [above.0, above.1, below.0, below.1].iter().zip(cases) {
            let title = format!("{}: error, log₁₀ of degrees", case.name);
            let series = vec![
                Series { label: "filter", colour: ORANGE, points: errors(orbit, &case.filter) },
                Series { label: "window", colour: BLUE, points: errors(orbit, &case.window) },
            ];
            Panel { title: &title, unit: "", x_label: "time (h)", series }.draw(area)?;
        }
        Ok(())
    })
}

/// No more points than can be seen.
fn errors(orbit: &Orbit, estimates: &[Estimate]) -> Vec<(f64, f64)> {
    let every = estimates.len().div_ceil(400).max(1);
    let point = |estimate: &Estimate| (estimate.k as f64 * orbit.h / 3600.0, estimate.off(orbit).log10());
    estimates.iter().step_by(every).map(point).collect()
}
