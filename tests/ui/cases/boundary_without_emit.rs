//! Fixed endpoints have a word in `emit`.

use clebsch::Clebsch;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| x.norm_squared() / 2,
)]
struct Spring;

fn main() -> Result<(), clebsch::Error> {
    let stepper = Spring.into_stepper(0.01)?;
    let _ = stepper.boundary();
    Ok(())
}
