//! The slew of the steps next to a given one.

use super::declaration::FreeBody;
use super::extremal::Slew;
use super::problem::Problem;
use super::shooting::Shot;
use clebsch::{Clebsch, Differentiated, Error, Guess};
use clebsch_examples::scene::Failure;

/// The extremal of N · `finer` steps next to `shot`; `None` where there is none.
///
/// A node of each step is solved for on its own, from one attitude of `shot` to the next. All of them are the guess,
/// [`Guess::Path`].
///
/// # Errors
/// The errors of the solver.
pub fn trace<M: Differentiated<FreeBody, 3>>(
    problem: &Problem,
    shot: &Shot,
    finer: u64,
) -> Result<Option<Slew>, Failure> {
    let steps = problem.steps * finer;
    let stepper = FreeBody { inertia: problem.body.inertia }.into_stepper_by::<M>(problem.duration / steps as f64)?;
    let boundary = stepper.boundary();
    let mut nodes = vec![boundary.rest(&problem.from); steps as usize];
    let way = shot.path(&problem.euler, steps);
    for (node, ends) in nodes.chunks_mut(1).zip(way.windows(2)) {
        match boundary.solve(&ends[0].attitude, &ends[1].attitude, Guess::Geodesic, node) {
            Err(Error::NoExtremal { .. } | Error::UndeterminedDirection { .. }) => return Ok(None),
            solved => solved?,
        };
    }
    match Slew::solve(problem, &stepper, Guess::Path, &mut nodes) {
        Err(Failure::Start(Error::NoExtremal { .. })) => Ok(None),
        slew => slew.map(Some),
    }
}
