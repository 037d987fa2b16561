//! A ring of eight against an integrator that knows nothing of spheres.

use crate::{Flags, Spins};
use clebsch::State;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::reference::solve;
use clebsch_examples::scene::Failure;
use nalgebra::{SVector, Vector3};

const EIGHT: usize = 8;
/// q and N of all spins.
type Numbers = SVector<f64, 48>;

/// The time over which they are compared, s: for longer ones differences grow as the motion is chaotic.
const TIME: f64 = 2.0;

fn joined(q: &[Vector3<f64>], mu: &[Vector3<f64>]) -> Numbers {
    Numbers::from_iterator(q.iter().chain(mu).flat_map(|vector| vector.iter().copied()))
}

/// q̇ = N × q, Ṅ = q × (J(q₋ + q₊) + B)
fn field(flags: &Flags, y: &Numbers) -> Numbers {
    let part = |i: usize| Vector3::new(y[3 * i], y[3 * i + 1], y[3 * i + 2]);
    let (q, mu) = (part, |i: usize| part(EIGHT + i));
    let neighbours = |i: usize| q((i + EIGHT - 1) % EIGHT) + q((i + 1) % EIGHT);
    let torque = |i: usize| q(i).cross(&(flags.exchange * neighbours(i) + Vector3::z() * flags.field));
    let (moved, turned): (Vec<_>, Vec<_>) = (0..EIGHT).map(|i| (mu(i).cross(&q(i)), torque(i))).unzip();
    joined(&moved, &turned)
}

/// Claims the order of the steps.
pub fn claim<S: Spins<EIGHT>>(flags: &Flags, claims: &mut Claims) -> Result<(), Failure> {
    let (q, mu) = flags.start(EIGHT);
    let steps = (TIME / flags.run.step_size).ceil() as u64;
    let rate = 1.0 + (2.0 * flags.exchange.abs() + flags.field.abs()).sqrt();
    let exact = solve(|y| field(flags, y), joined(&q, &mu), flags.run.time(steps), rate);
    let start = (std::array::from_fn(|i| q[i]), std::array::from_fn(|i| mu[i]));
    let ends = refined(&flags.ring::<S, EIGHT>(), &flags.run, steps, |stepper| stepper.state(start.0, start.1))?;
    let error = |end: State<S>| (joined(end.configuration(), &end.momentum()) - exact.end).amax();
    let convergence = Convergence { errors: ends.map(error), reference: exact.error, steps };
    convergence.claim(
        flags.run.order,
        "eight spins: the order, by extrapolation that knows nothing of spheres",
        claims,
    );
    Ok(())
}
