//! The slew of the steps beside a given one: the same motion, slowed down until it is short, is led on to its end.

use super::declaration::FreeBody;
use super::extremal::Slew;
use super::problem::Problem;
use super::shooting::Shot;
use clebsch::{Error, Guess};
use clebsch_examples::scene::Failure;

/// Parts in which the target is reached.
const PARTS: u32 = 24;

/// The extremal of N · `finer` steps beside `shot`; `None` where it is lost.
///
/// A free motion with s times the momentum takes the same path s times as fast, so the extremal to R(sT) in the time T has s π₀. For
/// small s there is only one; each is the guess of the next, [`Guess::Path`].
///
/// # Errors
/// What solving returns.
pub fn trace<S: FreeBody>(problem: &Problem, shot: &Shot, finer: u64) -> Result<Option<Slew>, Failure> {
    let steps = problem.steps * finer;
    let stepper = S::with_inertia(problem.body.inertia).into_stepper(problem.duration / steps as f64)?;
    let boundary = stepper.boundary();
    let mut nodes = vec![boundary.rest(&problem.from); steps as usize];
    let way = shot.path(&problem.euler, u64::from(PARTS));
    let mut guess =
        Guess::Velocity(problem.body.spin(&(shot.momentum * problem.euler.momentum_unit)) / f64::from(PARTS));
    for target in &way[1..way.len() - 1] {
        match boundary.solve(&problem.from, &target.attitude, guess, &mut nodes) {
            Ok(_) => guess = Guess::Path,
            // A conjugate point is near: the next target is tried from where this one was given up.
            Err(Error::NoExtremal { .. }) => guess = Guess::Path,
            Err(error) => return Err(error.into()),
        }
    }
    match Slew::solve(problem, &stepper, guess, &mut nodes) {
        Err(Failure::Start(Error::NoExtremal { .. })) => Ok(None),
        slew => slew.map(Some),
    }
}
