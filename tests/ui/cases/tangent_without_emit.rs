//! The derivative of a step has a word in `emit`.

use clebsch::Clebsch;
use nalgebra::Vector1;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| x.norm_squared() / 2,
)]
struct Spring;

fn main() -> Result<(), clebsch::Error> {
    let stepper = Spring.into_stepper(0.01)?;
    let start = stepper.state(Vector1::new(0.5), Vector1::zeros())?;
    let (_, tangent) = stepper.step_tangent(&start)?;
    println!("{tangent:?}");
    Ok(())
}
