//! The paths in the plane, and the inputs of the parking.

use crate::geodesic::Moment;
use crate::place::coordinates;
use crate::plan::Plan;
use crate::study::Study;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, Arrow, BLUE, Drawn, GREEN, INK, ORANGE, PURPLE, Panel, Path, Plane};
use clebsch_examples::figure::{RGBColor, Series};
use clebsch_examples::scene::Failure;

/// A plan with its name and colour.
type Named<'a> = (&'static str, &'a Plan, RGBColor);

/// Left the paths from above; right the inputs of the parking with those of the closed form, and within bounds.
pub fn draw(flags: &Flags, [geodesic, parking, free_end]: [&Study; 3], bounded: Option<&Plan>) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 500.0);
        let title = format!("A unicycle drives for {} s", flags.run.duration());
        let mut plans = vec![("geodesic", &geodesic.plans[0], ORANGE)];
        plans.extend(bounded.map(|plan| ("no reverse gear", plan, PURPLE)));
        plans.extend([("free end", &free_end.plans[0], GREEN), ("parking", &parking.plans[0], BLUE)]);
        plane(&figure::caption(&left, &title)?, &plans)?;
        let (above, below) = figure::rows(&right, 270.0);
        let draw = |title, unit, x_label, value| Panel {
            title,
            unit,
            x_label,
            series: inputs(flags, parking, bounded, value),
        };
        draw("Turning rate", "rad/s", "", |moment| moment.input.x).draw(&above)?;
        draw("Speed", "m/s", "time (s)", |moment| moment.input.y).draw(&below)
    })
}

fn plane(area: &Area<'_>, plans: &[Named<'_>]) -> Drawn {
    let points = |plan: &Plan| -> Vec<(f64, f64)> {
        plan.path.iter().map(|moment| (moment.place[(0, 2)], moment.place[(1, 2)])).collect()
    };
    let lines: Vec<_> = plans.iter().map(|(_, plan, _)| points(plan)).collect();
    let path =
        |(points, (label, _, colour)): (_, &Named<'_>)| Path { label, points, colour: Some(*colour), width: 1.8 };
    let paths: Vec<_> = lines.iter().map(Vec::as_slice).zip(plans).map(path).collect();
    let arrow = |moment: &Moment, colour| {
        let [x, y, heading] = coordinates(&moment.place).into();
        Arrow { at: (x, y), heading, colour }
    };
    let mut arrows = Vec::new();
    for (_, plan, colour) in plans {
        let every = plan.steps().div_ceil(5);
        arrows.extend(plan.path.iter().step_by(every).skip(1).map(|moment| arrow(moment, *colour)));
        arrows.push(arrow(plan.end(), *colour));
    }
    arrows.push(Arrow { at: (0.0, 0.0), heading: 0.0, colour: INK });
    Plane { unit: "m", paths: &paths, arrows: &arrows }.draw(area)
}

fn inputs(flags: &Flags, study: &Study, bounded: Option<&Plan>, value: fn(&Moment) -> f64) -> Vec<Series<'static>> {
    // an input is constant within its step
    let stairs = |label, plan: &Plan, colour| {
        let steps = plan.path.iter().enumerate().take(plan.steps());
        let points = steps.flat_map(|(k, moment)| [k, k + 1].map(|k| (k as f64 * plan.h, value(moment)))).collect();
        Series { label, colour, points }
    };
    let mut series: Vec<_> = bounded.map(|plan| stairs("no reverse gear", plan, PURPLE)).into_iter().collect();
    series.push(stairs("parking", &study.plans[0], BLUE));
    if let Some(geodesic) = study.geodesic {
        let time = |k: u32| f64::from(k) * flags.run.duration() / 400.0;
        let points = (0..=400).map(|k| (time(k), value(&geodesic.at(time(k))))).collect();
        series.push(Series { label: "closed form", colour: ORANGE, points });
    }
    series
}
