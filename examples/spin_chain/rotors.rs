//! A ring of eight against an integrator that knows nothing of spheres.

use crate::{Flags, Spins};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::Order;
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

/// Claims that halved steps are nearer by as much as their order says.
pub fn claim<S: Spins<EIGHT>>(flags: &Flags, claims: &mut Claims) -> Result<(), Failure> {
    let (q, mu) = flags.start(EIGHT);
    let rate = 1.0 + (2.0 * flags.exchange.abs() + flags.field.abs()).sqrt();
    let exact = solve(|y| field(flags, y), joined(&q, &mu), TIME, rate);
    let error = |steps: u32| -> Result<f64, Failure> {
        let stepper = flags.ring::<S, EIGHT>().into_stepper(TIME / f64::from(steps))?;
        let start: (Vec<_>, Vec<_>) = (q.clone(), mu.clone());
        let fits = |_| Failure::Flags("eight spins are eight".to_owned());
        let (points, momenta) = (start.0.try_into().map_err(fits)?, start.1.try_into().map_err(fits)?);
        let mut state = stepper.state(points, momenta)?;
        for step in 1..=u64::from(steps) {
            state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        }
        Ok((joined(state.configuration(), state.momentum()) - exact.end).amax())
    };
    let steps = 200;
    let (whole, half) = (error(steps)?, error(2 * steps)?);
    let reason = "against extrapolation of order 16, which knows nothing of spheres";
    let (name, ratio) = match flags.run.order {
        Order::First => ("eight spins: halved steps are twice as near to another integrator", 1.9..=2.1),
        Order::Second => ("eight spins: halved steps are four times nearer to another integrator", 3.9..=4.1),
    };
    if half > 100.0 * exact.error {
        claims.within(name, whole / half, ratio, 3, reason);
    } else {
        claims.at_most(name, whole, 100.0 * exact.error, "nothing moves far enough for the order to show");
    }
    Ok(())
}
