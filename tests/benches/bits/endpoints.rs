//! Tangent maps, and extremals between fixed endpoints.

#[path = "../../laws/tests/boundary/systems.rs"]
mod systems;

use crate::run::uneven;
use crate::trajectories::Recorder;
use clebsch::{Clebsch, Guess, Node, Sensitive, Variational};
use clebsch_tests::fixtures::driven_body5::DrivenBody5;
use clebsch_tests::fixtures::watched_top::WatchedTop;
use clebsch_tests::scenes::{centre, many, placed, principal, turned, unit};
use nalgebra::{Matrix3, Quaternion, SMatrix, SVector, Vector2, Vector3};
use systems::{Catch, Chain, Composed, Flyer, Free, QuaternionTop, Satellite, Spring, Top, Vehicle};

const H: f64 = 0.05;
/// Steps of a path.
const STEPS: usize = 12;

pub fn all(task: &Recorder) {
    let mass = principal();
    tangent(task, "watched_top", WatchedTop { mass, weight: 1.3 }, turned());
    tangent(task, "driven_body5", DrivenBody5 { j_d: many(), drag: 0.2 }, SMatrix::identity());
    path::<_, 3, 12>(task, "watched_top", WatchedTop { mass, weight: 1.3 }, turned());
    path::<_, 3, 12>(task, "boundary_free", Free { mass }, turned());
    path::<_, 3, 12>(task, "boundary_top", Top { mass, weight: 0.7 }, turned());
    path::<_, 3, 24>(task, "boundary_composed", Composed { mass, skew: 0.05, weight: 0.7 }, turned());
    path::<_, 3, 12>(task, "boundary_satellite", Satellite { inertia: mass, orbital_rate: 0.8 }, turned());
    path::<_, 6, 12>(task, "boundary_vehicle", Vehicle { inertia: mass, mass, weight: 0.3 }, placed());
    path::<_, 6, 12>(task, "boundary_flyer", Flyer { mass: 1.7, inertia: 0.8, pull: 1.1 }, (centre(), unit()));
    path::<_, 6, 12>(task, "boundary_chain", Chain { coupling: 0.3 }, (unit(), Vector3::x()));
    let top = QuaternionTop { inertia: mass, weight: 0.7 };
    path::<_, 3, 12>(task, "boundary_quaternions", top, Quaternion::new(0.8, 0.0, 0.6, 0.0));
    let spring = Spring { mass: 1.7, stiffness: 2.3, goal: Vector2::new(1.0, -2.0) };
    free_end(task, "boundary_spring", spring, Vector2::new(0.4, 0.3));
    let catch = Catch { mass_matrix: mass, weight: Vector3::new(0.3, 0.1, 1.0), stiffness: 3.0, goal: turned() };
    free_end(task, "boundary_catch", catch, Matrix3::identity());
}

/// Steps with their tangent maps and sensitivities.
fn tangent<S, const M: usize, const P: usize>(task: &Recorder, name: &str, system: S, q: S::Configuration)
where
    S: Sensitive<M, P> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let stepper = system.into_stepper(H).expect("parameters");
    task.quantity(name, "tangent", |record| {
        let mut state = stepper.state(q, uneven(1.0)).expect("a state");
        for _ in 0..20 {
            let (next, map, sensitivity) = stepper.step_sensitivity(&state).expect("a step");
            record.add(next.configuration());
            record.add(&next.momentum());
            for part in [map.motion_by_motion, map.motion_by_momentum, map.momentum_by_motion, map.momentum_by_momentum]
            {
                record.add(&part);
            }
            record.add(&sensitivity.motion);
            record.add(&sensitivity.momentum);
            state = next;
        }
    });
}

/// The extremal to where steps lead, N edges in all.
fn path<S, const M: usize, const N: usize>(task: &Recorder, name: &str, system: S, q: S::Configuration)
where
    S: Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let stepper = system.into_stepper(H).expect("parameters");
    task.quantity(name, "path", |record| {
        let start = stepper.project(q, uneven(1.0)).expect("a state");
        let target = stepper.trajectory(start).nth(STEPS).expect("endless").expect("a step");
        let boundary = stepper.boundary();
        let mut path: [Node<S, M>; N] = [boundary.rest(&q); N];
        let extremal = boundary.solve(&q, target.configuration(), Guess::Geodesic, &mut path).expect("an extremal");
        record.add(&extremal.action());
        record.note(&format!("{} {}", extremal.iterations(), extremal.negative()));
        for state in extremal.states() {
            record.add(state.configuration());
            record.add(&state.momentum());
        }
    });
}

/// The extremal to an end with a price.
fn free_end<S, const M: usize>(task: &Recorder, name: &str, system: S, q: S::Configuration)
where
    S: Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let stepper = system.into_stepper(H).expect("parameters");
    task.quantity(name, "free_end", |record| {
        let boundary = stepper.boundary();
        let mut path: [Node<S, M>; STEPS] = [boundary.rest(&q); STEPS];
        let extremal = boundary.solve_free(&q, Guess::Geodesic, &mut path).expect("an extremal");
        record.add(&extremal.action());
        record.add(extremal.end());
        record.add(extremal.momentum());
        record.add(extremal.final_momentum());
    });
}
