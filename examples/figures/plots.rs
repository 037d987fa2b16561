//! The pictures of the page on plots: a heavy top by the functions of `clebsch-plot`.

use crate::Pictures;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use clebsch_plot::{drift, quantities, sphere};
use nalgebra::{Rotation3, Vector3};

/// A rigid body turning about a fixed pivot in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    potential  = |R| self.weight * R[(2, 2)],
)]
struct Top {
    /// Principal moments of inertia, kg·m².
    moments: Vector3<f64>,
    /// Weight times the distance from the pivot to the centre of mass, N·m.
    weight: f64,
}

/// The path of the axis, the tilt with momentum and energy, and the drift.
pub fn plots(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let stepper = Top { moments: Vector3::new(1.0, 1.0, 0.5), weight: 1.0 }.into_stepper(0.01)?;
    let tilted = Rotation3::new(Vector3::new(1.0, 0.0, 0.0)).into_inner();
    let start = stepper.state(tilted, Vector3::new(0.0, 0.0, 3.2))?;
    let states = || stepper.trajectory(start).every(0.02).with_times().take(1500);
    let axis = sphere(states(), |(_, state)| state.configuration().column(2).into_owned())?;
    pictures.save("plots-sphere", |path| axis.save(path))?;
    let table = stepper.table().energy().with("tilt", |state| state.configuration()[(2, 2)].acos().to_degrees());
    let table = table.units(&[("t", "s"), ("tilt", "°"), ("N", "kg·m²/s"), ("energy", "J")]);
    let in_time = quantities(table, states())?.only(&["tilt", "N", "energy"])?;
    pictures.save("plots-quantities", |path| in_time.save(path))?;
    let long = stepper.trajectory(start).every(0.01).with_times().take(100_001);
    let moved = drift(stepper.table().energy().conserved(), long)?;
    pictures.save("plots-drift", |path| moved.save(path))?;
    let largest = moved.largest("about e3, spatial").unwrap_or(f64::NAN);
    claims.at_most(
        "plots: the momentum about the vertical stays",
        largest,
        f64::EPSILON * 1e5_f64.sqrt(),
        "rounding, ε √steps",
    );
    Ok(())
}
