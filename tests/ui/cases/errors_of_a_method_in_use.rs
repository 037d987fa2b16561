//! A mistake in a method gives one error, and the uses of the struct and of its methods none.

use clebsch::Clebsch;
use nalgebra::Vector3;

struct Fine;
struct Coarse;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action        = |a: Translation<3>, x: Vector3| x + a,
    lagrangian    = |v| v.norm_squared() / 2,
    potential     = |x| self.gravity * x.z,
    method Fine   = (order = 6, tolerance = 1e-8),
    method Coarse = (order = 1),
)]
struct Stone {
    gravity: f64,
}

fn main() -> Result<(), clebsch::Error> {
    let stone = Stone { gravity: 9.81 };
    let fine = stone.stepper_by::<Fine>(0.01)?;
    let coarse = stone.stepper_by::<Coarse>(0.01)?;
    let start = coarse.state(Vector3::x(), Vector3::z())?;
    println!("{}", fine.step(&fine.state_of(&coarse, &start)?)?.momentum());
    Ok(())
}
