//! P5 and P5v: from rest to 2.5 rad about (1, 2, 3)/√14 in one second.

use crate::hand::{self, Body};
use crate::systems::{Free, Top};
use crate::timing::{Run, Time, interleaved};
use clebsch::{Boundary, Clebsch, Guess, Node, Stepper, Variational};
use nalgebra::{Matrix3, Rotation3, SVector, Vector3};
use std::cell::{Cell, RefCell};
use std::hint::black_box;

const MASS: [f64; 3] = [2.0, 1.0, 0.0];
/// The residual at which the reference stops, that of others who solved these problems. Over short edges rounding leaves more: attitudes
/// are rounded to the same digits, and momenta are their differences over h.
fn tolerance(edges: usize) -> f64 {
    1e-11 * (edges as f64 / 1000.0).max(1.0)
}

/// One way to solve one problem.
pub struct Line {
    pub problem: &'static str,
    pub peer: &'static str,
    pub edges: usize,
    /// Of a solution, ns.
    pub time: Time,
    pub iterations: u32,
    pub action: f64,
    pub residual: f64,
    /// Bytes of the path.
    pub bytes: usize,
}

/// The answer of a solve.
struct Answer {
    iterations: u32,
    action: f64,
    residual: f64,
}

/// Both problems in so many steps.
pub fn lines(edges: usize) -> Vec<Line> {
    let h = 1.0 / edges as f64;
    let free = Free { mass: MASS.into() }.into_stepper(h).expect("a body");
    let top = Top { mass: MASS.into(), weight: 1.0 }.into_stepper(h).expect("a top");
    let mut lines = of("P5", &free, 0.0, edges);
    lines.extend(of("P5v", &top, 1.0, edges));
    lines
}

fn vector() -> Vector3<f64> {
    Vector3::new(1.0, 2.0, 3.0) * (2.5 / 14.0_f64.sqrt())
}

fn of<S>(problem: &'static str, stepper: &Stepper<S>, weight: f64, edges: usize) -> Vec<Line>
where
    S: Variational<3> + Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = SVector<f64, 3>>,
{
    let boundary = stepper.boundary();
    let path = RefCell::new(vec![boundary.rest(&Matrix3::identity()); edges]);
    let target = *Rotation3::from_scaled_axis(vector()).matrix();
    // the next target of one who tracks: a hundredth of a radian further
    let further = *Rotation3::from_scaled_axis(vector() + Vector3::new(0.01, 0.0, 0.0)).matrix();
    let cold = || solve(&boundary, &target, Guess::Geodesic, &mut path.borrow_mut());
    let warm = |target: &Matrix3<f64>| solve(&boundary, target, Guess::Path, &mut path.borrow_mut());
    let body = Body { h: stepper.step_size(), mass: MASS, weight };
    let vertices = RefCell::new(vec![hand::REST; edges + 1]);
    let by_hand = || {
        let mut path = vertices.borrow_mut();
        Body::geodesic(black_box(vector()).into(), &mut path);
        let solution = black_box(body).solve(&mut path, tolerance(edges));
        Answer { iterations: solution.iterations, action: solution.action, residual: solution.residual }
    };
    let answers = [cold(), warm(&further), by_hand()];
    // on from run to run: of an odd number of solutions the first would find the target where it is
    let turn = Cell::new(0);
    let to_and_fro = || {
        turn.set(1 - turn.get());
        warm([&further, &target][turn.get()])
    };
    let often = |times: u64, run: &dyn Fn() -> Answer| {
        for _ in 0..times {
            black_box(run());
        }
    };
    let runs: [Run<'_>; 3] = [
        Box::new(|times| often(times, &cold)),
        Box::new(|times| often(times, &to_and_fro)),
        Box::new(|times| often(times, &by_hand)),
    ];
    let bytes =
        [edges * size_of::<Node<S, 3>>(), edges * size_of::<Node<S, 3>>(), (edges + 1) * size_of::<hand::Vertex>()];
    let peers = ["clebsch", "clebsch, warm", "by hand"];
    let times = interleaved(&runs);
    let line = |k: usize| {
        let Answer { iterations, action, residual } = answers[k];
        Line { problem, peer: peers[k], edges, time: times[k], iterations, action, residual, bytes: bytes[k] }
    };
    (0..3).map(line).collect()
}

fn solve<S>(
    boundary: &Boundary<'_, S, 3>,
    target: &Matrix3<f64>,
    guess: Guess<f64, 3>,
    path: &mut [Node<S, 3>],
) -> Answer
where
    S: Variational<3> + Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = SVector<f64, 3>>,
{
    let extremal = boundary.solve(&Matrix3::identity(), black_box(target), guess, path).expect("an extremal");
    Answer { iterations: extremal.iterations(), action: extremal.action(), residual: extremal.residual() }
}
