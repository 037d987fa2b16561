//! One mistake gives one error, and the plans and the steps of the struct none, where its force reads references.

use clebsch::{Clebsch, Controlled, Target};
use nalgebra::{Matrix3, Vector1, Vector3};

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.norm_squared() / 2,
    force      = |omega, torque: Vector3, grip: Vector1| grip.x * torque - self.dragg * omega,
    effort     = |h, torque, grip, wanted: Vector3| h * grip.x * (torque - wanted).norm_squared() / 2,
)]
struct Body {
    drag: f64,
}

fn main() -> Result<(), clebsch::Error> {
    let (grip, wanted) = (Vector1::new(1.0), Vector3::x());
    let stepper = Body { drag: 1.0 }.into_stepper(0.1)?;
    let state = stepper.state(Matrix3::identity(), Vector3::zeros())?;
    let next = stepper.step_with(&state, &(wanted, grip))?;
    let start = (*next.configuration(), next.momentum());
    let control = Body { drag: 1.0 }.control(0.1)?;
    let mut plan = [control.stage(&start); 10];
    control.refer(&mut plan, |_, _| (grip, wanted));
    let optimum = control.solve(&start, Target::Free, &mut plan)?;
    println!("{}", optimum.stages()[0].input());
    println!("{}", control.follow_with(&start, &wanted, &(grip, wanted))?.1);
    Ok(())
}
