//! The time of derivatives of a step relative to the step.

use crate::systems::{HeavyTop, Pendulum, Vehicle};
use crate::timing::{Run, Time, interleaved};
use clebsch::{Clebsch, Error, Sensitive, State, Stepper, Variational};
use nalgebra::{Matrix3, Matrix4, Matrix6, SVector, Vector3};
use std::hint::black_box;

/// One system.
pub struct Line {
    pub system: &'static str,
    /// Unknowns of a step.
    pub dimension: usize,
    /// Quantities that sensitivities are given for.
    pub quantities: usize,
    /// Of `step`, `step_tangent` and `step_sensitivity`, ns.
    pub times: Vec<Time>,
}

/// All systems.
pub fn lines() -> Vec<Line> {
    let mass_matrix = Matrix3::from_diagonal(&Vector3::new(1.25, 0.75, 0.25));
    let top = HeavyTop { mass_matrix, weight: 1.0, center: Vector3::z() }.into_stepper(0.01).expect("a top");
    let turning = top.state(Matrix3::identity(), Vector3::new(0.1, 0.3, 10.0)).expect("a state");
    let pendulum = Pendulum { mass: 1.0, length: 1.0, gravity: 9.81 }.into_stepper(0.01).expect("a pendulum");
    let swinging = pendulum.state(Vector3::y(), Vector3::new(1.0, 0.0, 0.5)).expect("a state");
    let inertia = Matrix6::from_diagonal(&SVector::from([1.0, 1.4, 1.9, 1.0, 1.5, 2.0]));
    let vehicle = Vehicle { inertia, weight: 1.0, center: Vector3::z() }.into_stepper(0.01).expect("a vehicle");
    let moving = vehicle.state(Matrix4::identity(), SVector::from([0.3, 0.2, 1.0, 0.5, 0.1, 0.4])).expect("a state");
    vec![
        line("heavy top", &top, turning),
        line("spherical pendulum", &pendulum, swinging),
        line("SE(3)", &vehicle, moving),
    ]
}

fn line<S, const M: usize, const P: usize>(system: &'static str, stepper: &Stepper<S>, start: State<S>) -> Line
where
    S: Sensitive<M, P> + Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let runs: [Run<'_>; 3] = [
        Box::new(move |times| repeat(times, start, |state| stepper.step(state))),
        Box::new(move |times| {
            repeat(times, start, |state| {
                let (state, tangent) = stepper.step_tangent(state)?;
                black_box(tangent);
                Ok(state)
            })
        }),
        Box::new(move |times| {
            repeat(times, start, |state| {
                let (state, tangent, sensitivity) = stepper.step_sensitivity::<P>(state)?;
                black_box((tangent, sensitivity));
                Ok(state)
            })
        }),
    ];
    Line { system, dimension: M, quantities: P, times: interleaved(&runs) }
}

fn repeat<S: Clebsch>(times: u64, start: State<S>, step: impl Fn(&State<S>) -> Result<State<S>, Error>) {
    let mut state = black_box(start);
    for _ in 0..times {
        state = step(&state).expect("a step of moderate size");
    }
    black_box(state);
}
