//! Plans: the time of choosing the inputs, cold and from a solution, for any number of steps.

use crate::timing::{Run, Time, interleaved};
use clebsch::{Control, Controlled, Stage, Target};
use clebsch_tests::fixtures::steered_body::SteeredBody;
use clebsch_tests::fixtures::unicycle::Unicycle;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};
use std::cell::RefCell;
use std::hint::black_box;

/// One problem in so many steps.
pub struct Line {
    pub problem: &'static str,
    pub steps: usize,
    /// Of a plan from no guess, and again from the solution, ns.
    pub times: Vec<Time>,
    pub iterations: [u32; 2],
    pub price: f64,
    /// Stages at which a bound is active.
    pub held: usize,
    /// Bytes of the plan.
    pub bytes: usize,
}

/// A unicycle that parks and a body that turns from rest to rest, both within bounds, in one second.
pub fn lines(steps: usize) -> Vec<Line> {
    let h = 1.0 / steps as f64;
    let unicycle =
        Unicycle { turn_price: 1.0, top_turn: 3.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    let body = SteeredBody { inertia, damping: 0.0, top: 12.0 };
    let parked = Matrix3::new(0.0, -1.0, 1.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0);
    let turned = *Rotation3::from_scaled_axis(Vector3::new(0.6, 1.3, 2.0)).matrix();
    let rest = Vector3::zeros();
    vec![
        line("unicycle", unicycle.control(h).expect("regular"), Matrix3::identity(), parked, steps),
        line("body", body.control(h).expect("regular"), (Matrix3::identity(), rest), (turned, rest), steps),
    ]
}

fn line<S, const D: usize, const U: usize, const C: usize>(
    problem: &'static str,
    control: Control<S, D, U, C>,
    start: S::Place,
    goal: S::Place,
    steps: usize,
) -> Line
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let none = vec![control.stage(&start); steps];
    let plan = RefCell::new(none.clone());
    let solve = |plan: &mut [Stage<S, D, U, C>]| {
        let optimum = control.solve(black_box(&start), Target::Place(goal), plan).expect("a plan");
        (optimum.iterations(), optimum.price())
    };
    let cold = || {
        plan.borrow_mut().copy_from_slice(&none);
        solve(&mut plan.borrow_mut())
    };
    let warm = || solve(&mut plan.borrow_mut());
    let ((first, price), (again, _)) = (cold(), warm());
    let often = |times: u64, run: &dyn Fn() -> (u32, f64)| {
        for _ in 0..times {
            black_box(run());
        }
    };
    let runs: [Run<'_>; 2] = [Box::new(|times| often(times, &cold)), Box::new(|times| often(times, &warm))];
    let times = interleaved(&runs);
    let held = plan.borrow().iter().filter(|stage| stage.active().contains(&true)).count();
    let bytes = size_of_val(none.as_slice());
    Line { problem, steps, times, iterations: [first, again], price, held, bytes }
}
