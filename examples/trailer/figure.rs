//! The rig from above at some moments, and its inputs and the angle of its hitch in time.

use super::plan::{Plan, Problem};
use super::rig::{fold, outline, position};
use super::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, INK, ORANGE, PURPLE, Panel, Path, Plane, RED};
use clebsch_examples::figure::{RGBColor, Series};
use clebsch_examples::scene::Failure;

/// Tractor and trailer, and their colours.
const BODIES: [(&str, RGBColor); 2] = [("tractor", BLUE), ("trailer", ORANGE)];
/// The rig is drawn at the start, at the end, and so often in between.
const BETWEEN: usize = 4;

/// Left the rig from above; right thrust, torque and the angle of the hitch.
pub fn draw(flags: &Flags, problem: &Problem, plan: &Plan) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 540.0);
        let title = format!("A tractor backs its trailer into place in {} s", flags.run.duration());
        plane(&figure::caption(&left, &title)?, problem, plan)?;
        let (above, below) = figure::rows(&right, 175.0);
        let (middle, below) = figure::rows(&below, 175.0);
        thrust(flags, plan).draw(&above)?;
        torque(flags, plan).draw(&middle)?;
        hitch(flags, plan).draw(&below)
    })
}

fn plane(area: &Area<'_>, problem: &Problem, plan: &Plan) -> Drawn {
    let shown: Vec<_> = (0..=BETWEEN + 1).map(|moment| moment * plan.stages.len() / (BETWEEN + 1)).collect();
    let moments = plan.places().enumerate().filter(|(step, _)| shown.contains(step));
    let mut lines: Vec<(usize, Vec<(f64, f64)>)> = Vec::new();
    for (step, (poses, _)) in moments {
        for body in [1, 0] {
            // a path has no gaps: the outline and the drawbar are two
            let points = outline(&problem.rig, poses, body);
            let parts = points.split(|point| !point.0.is_finite()).filter(|part| part.len() > 1);
            lines.extend(parts.map(|part| (if step == 0 { 2 } else { body }, part.to_vec())));
        }
    }
    let tracks = [1, 0].map(|body| -> Vec<_> {
        plan.places().map(|(poses, _)| position(&poses[body])).map(|at| (at.x, at.y)).collect()
    });
    let colours = [BLUE, ORANGE, INK];
    let outlines =
        lines.iter().map(|(kind, points)| Path { label: "", points, colour: Some(colours[*kind]), width: 0.9 });
    let named = [1, 0].into_iter().zip(&tracks);
    let named = named.map(|(body, points)| {
        let (label, colour) = BODIES[body];
        Path { label, points, colour: Some(colour), width: 2.0 }
    });
    let paths: Vec<_> = outlines.chain(named).collect();
    Plane { unit: "m", paths: &paths, arrows: &[] }.draw(area)
}

fn thrust(flags: &Flags, plan: &Plan) -> Panel<'static> {
    let series = vec![stairs(flags, plan, 0, GREEN)];
    Panel { title: "Thrust", unit: "N", x_label: "", series }
}

fn torque(flags: &Flags, plan: &Plan) -> Panel<'static> {
    let series = vec![stairs(flags, plan, 1, PURPLE)];
    Panel { title: "Torque", unit: "N m", x_label: "", series }
}

/// An input is constant within its step.
fn stairs(flags: &Flags, plan: &Plan, index: usize, colour: RGBColor) -> Series<'static> {
    let steps = (0..).zip(plan.inputs());
    let points = steps.flat_map(|(step, input)| [step, step + 1].map(|end| (flags.run.time(end), input[index])));
    Series { label: "", colour, points: points.collect() }
}

fn hitch(flags: &Flags, plan: &Plan) -> Panel<'static> {
    let angle = (0..).zip(plan.places()).map(|(step, (poses, _))| (flags.run.time(step), fold(poses).to_degrees()));
    let angle = Series { label: "", colour: BLUE, points: angle.collect() };
    let bound =
        |value: f64| Series { label: "", colour: RED, points: vec![(0.0, value), (flags.run.duration(), value)] };
    let series = vec![bound(-flags.fold), bound(flags.fold), angle];
    Panel { title: "Angle of the hitch, and its bounds", unit: "degrees", x_label: "time (s)", series }
}
