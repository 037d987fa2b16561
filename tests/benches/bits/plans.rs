//! Plans at the least price.

use crate::trajectories::Recorder;
use clebsch::{Controlled, Target};
use clebsch_tests::fixtures::regulator::Regulator;
use clebsch_tests::fixtures::steered_body::SteeredBody;
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::scenes::{inertia, turned};
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};

pub fn all(task: &Recorder) {
    let regulator = Regulator { mass: 1.3, stiffness: 2.0, price: 0.5 };
    plan(task, "regulator", regulator, 0.1, &Vector2::new(1.0, -0.4), Target::Free);
    let unicycle =
        Unicycle { turn_price: 1.0, top_turn: 3.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
    let (sine, cosine) = (0.6, 0.8);
    let target = Matrix3::new(cosine, -sine, 1.5, sine, cosine, 0.5, 0.0, 0.0, 1.0);
    plan(task, "unicycle", unicycle, 0.05, &Matrix3::identity(), Target::Place(target));
    let priced =
        Unicycle { turn_price: 1.0, top_turn: 3.0, time_price: 0.3, miss_price: 4.0, goal: Vector2::new(1.2, 0.4) };
    plan(task, "unicycle_priced", priced, 0.05, &Matrix3::identity(), Target::Free);
    let body = SteeredBody { inertia: inertia(), damping: 0.1, top: 4.0 };
    let start = (turned(), Vector3::zeros());
    let turn = Rotation3::from_scaled_axis(Vector3::new(0.1, -0.2, 0.15));
    let target = (turned() * turn.matrix(), Vector3::new(0.05, 0.02, -0.03));
    plan(task, "steered_body", body, 0.1, &start, Target::Place(target));
}

/// A plan of twenty steps.
fn plan<S, const D: usize, const U: usize, const C: usize>(
    task: &Recorder,
    name: &str,
    system: S,
    h: f64,
    start: &S::Place,
    target: Target<S::Place>,
) where
    S: Controlled<D, U, C, Scalar = f64>,
{
    task.quantity(name, "plan", |record| {
        let control = system.control(h).expect("regular");
        let mut plan = [control.stage(start); 20];
        let optimum = match control.solve(start, target, &mut plan) {
            Ok(optimum) => optimum,
            Err(error) => return record.note(&format!("{error:?}")),
        };
        record.add(&optimum.price());
        record.note(&format!("{} {}", optimum.iterations(), optimum.negative()));
        for stage in optimum.stages() {
            record.add(stage.place());
            record.add(stage.input());
            record.add(stage.costate());
            record.add(stage.gain());
            record.add(stage.multipliers());
        }
    });
}
