//! Two mistakes give two errors, and the uses of the struct none.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrx * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center),
)]
struct Top {
    mass_matrix: Matrix3<f64>,
    weight: f64,
    center: Vector3<f64>,
}

fn main() -> Result<(), clebsch::Error> {
    let top = Top { mass_matrix: Matrix3::identity(), weight: 1.0, center: Vector3::z() };
    let stepper = top.stepper(0.01)?;
    let start = stepper.state(Matrix3::identity(), Vector3::x())?;
    for state in stepper.trajectory(start).take(10) {
        let state = state?;
        println!("{} {}", state.momentum(), stepper.conserved(&state));
    }
    Ok(())
}
