//! The runs of `main.c` in Rust: the bits of their numbers, one number a line.

use clebsch::Clebsch;
use clebsch_c_example::{Fine, HeavyTop, Probe};
use nalgebra::{Matrix3, Quaternion, Vector3, Vector6};

fn main() -> Result<(), clebsch::Error> {
    let top = HeavyTop {
        mass_matrix: Matrix3::new(0.5, 0.125, 0.0, 0.125, 0.75, 0.0, 0.0, 0.0, 0.25),
        weight: 2.0,
        center: Vector3::new(0.0, 0.25, 1.0),
    };
    let stepper = top.stepper(0.015625)?;
    let mut state = stepper.state(Matrix3::identity(), Vector3::new(0.5, 0.25, 2.0))?;
    for _ in 0..100 {
        state = stepper.step(&state)?;
    }
    state = stepper.kick(&stepper.advance(&state, 900)?, Vector3::new(0.125, 0.0, -0.5))?;
    state = stepper.step(&state)?;
    let (q, n) = (state.configuration().transpose(), state.momentum());
    q.iter().chain(&n).chain([&stepper.energy(&state)]).for_each(|number| println!("{:016x}", number.to_bits()));

    let fine = top.into_stepper_by::<Fine>(0.0625)?;
    let state = fine.advance(&fine.state(Matrix3::identity(), Vector3::new(0.5, 0.25, 2.0))?, 50)?;
    let (q, n) = (state.configuration().transpose(), state.momentum());
    q.iter().chain(&n).for_each(|number| println!("{:016x}", number.to_bits()));

    let (moments, drift) = (Vector3::new(1.0, 1.5, 2.0), Vector3::new(0.25, 0.0, 0.0));
    let stepper = Probe { mass: 2.0, moments, stiffness: 8.0, drift }.into_stepper(0.0625)?;
    let (x, turn) = (Vector3::new(0.5, 0.0, 0.25), Quaternion::new(0.0, 0.0, 1.0, 0.0));
    let mut state = stepper.state_at(0.5, (x, turn), Vector6::new(0.0, 1.0, 0.0, 0.5, 0.25, 0.125))?;
    let input = (Vector3::new(0.25, 0.0, 0.0), Vector3::new(0.0, 0.0, 0.125));
    for _ in 0..200 {
        state = stepper.step_with(&state, &input)?;
    }
    let (x, turn) = *state.configuration();
    let numbers = [state.time()].into_iter().chain(x.iter().copied()).chain([turn.w, turn.i, turn.j, turn.k]);
    numbers.chain(state.momentum().iter().copied()).for_each(|number| println!("{:08x}", number.to_bits()));
    Ok(())
}
