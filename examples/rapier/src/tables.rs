//! The table of the scenes.

use super::scenes::{By, collision, crowd, gyroscope, resting, stack, thrown, tumbling};
use crate::theory::STEP;
use clebsch::Error;

/// Prints all scenes, one column for each way of turning the bodies. `scalar` begins each line.
///
/// # Errors
/// Those of clebsch.
pub fn print(scalar: &str) -> Result<(), Error> {
    let row = |name: &str, [rapier, clebsch, replacing]: [String; 3]| {
        println!("{}", format!("{scalar}  {name:<46} {rapier:>9} {clebsch:>9} {replacing:>9}").trim_end());
    };
    row("turned by", ["rapier", "clebsch", "replacing"].map(str::to_owned));

    let reports = each(|by| tumbling(by, 100_000))?;
    row("body that turns over: turns", reports.each_ref().map(|it| it.turns.to_string()));
    row("its L: angle to that at the start, rad", reports.each_ref().map(|it| short(it.direction)));
    row("its energy: relative change", reports.each_ref().map(|it| short(it.energy)));
    let [rapier, clebsch, _] = reports.map(|it| format!("{:.0}", it.nanoseconds));
    let of_one = [rapier, clebsch, String::new()];

    let reports = each(|by| thrown(by, [1.0, 4.0, -2.0], &[STEP]))?;
    row("thrown body: error of the attitude, rad", reports.each_ref().map(|it| short(it.attitude)));
    row("its centre of mass: error of the path, m", reports.each_ref().map(|it| short(it.path)));

    let reports = each(|by| gyroscope(by, STEP))?;
    row("wheel on a joint: its way around, over theory", reports.each_ref().map(|it| format!("{:.3}", it.angle)));
    row("its axle: tilt, rad", reports.each_ref().map(|it| format!("{:.3}", it.tilt)));

    let reports = each(collision)?;
    row("two boxes collide: error of the balance of L", reports.each_ref().map(|it| short(it.balance)));

    let reports = each(resting)?;
    row("box on the floor: angular velocity, rad/s", reports.each_ref().map(|it| short(it.rate)));
    row("it creeps, m/s", reports.each_ref().map(|it| short(it.creeping)));

    let reports = each(stack)?;
    let steps = |after: Option<u32>| after.map_or("never".into(), |steps| steps.to_string());
    row("five boxes in a stack: steps until they sleep", reports.each_ref().map(|it| steps(it.asleep_after)));
    row("their height, less that of five boxes, m", reports.each_ref().map(|it| short(it.height)));

    row("a step of one body, ns", of_one);
    let [rapier, clebsch] = [crowd(By::Rapier, 1000)?, crowd(By::Clebsch, 1000)?].map(|time| format!("{time:.0}"));
    row("a step of 1000 boxes, ns for each", [rapier, clebsch, String::new()]);
    Ok(())
}

fn each<T>(run: impl Fn(By) -> Result<T, Error>) -> Result<[T; 3], Error> {
    Ok([run(By::Rapier)?, run(By::Clebsch)?, run(By::Replacing)?])
}

fn short(x: f64) -> String {
    format!("{x:.1e}")
}
