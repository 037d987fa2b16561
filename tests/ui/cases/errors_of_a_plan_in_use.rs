//! One mistake gives one error, and the plans of the struct none.

use clebsch::{Clebsch, Controlled, Target};
use nalgebra::Matrix3;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |u: Vector2| vector![u.x, u.y, 0],
    cost     = |h, u| h * (self.turn_prize * u.x.powi(2) + u.y.powi(2)) / 2,
    bounds   = |u| [u.x <= 1, -1 <= u.x],
)]
struct Unicycle {
    turn_price: f64,
}

fn main() -> Result<(), clebsch::Error> {
    let control = Unicycle { turn_price: 1.0 }.control(0.1)?;
    let mut plan = [control.stage(&Matrix3::identity()); 10];
    let optimum = control.solve(&Matrix3::identity(), Target::Free, &mut plan)?;
    println!("{}", optimum.stages()[0].input());
    Ok(())
}
