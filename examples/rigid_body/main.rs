//! A rigid body turning freely, from its inertia tensor: the first example of the README.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

/// A body that nothing acts on.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
)]
struct RigidBody {
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
}

fn main() -> Result<(), clebsch::Error> {
    // a book thrown with a spin about its middle axis: it turns over, again and again
    let book = RigidBody { inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)) };
    let stepper = book.stepper(0.01)?;
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.01, 2.0, 0.0))?;

    println!("time     body momentum              energy              spatial momentum has moved by");
    for (step, state) in stepper.trajectory(start).take(1_000_001).enumerate() {
        let state = state?;
        if [0, 500, 1_000, 1_000_000].contains(&step) {
            let (time, body) = (step / 100, state.momentum());
            let moved = (state.configuration() * body - start.momentum()).norm();
            let energy = stepper.energy(&state);
            println!("{time:<6} {:+.4} {:+.4} {:+.4}   {energy:.15}   {moved:.1e}", body.x, body.y, body.z);
        }
    }
    Ok(())
}
