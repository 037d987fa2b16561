//! Where a throw arrives by the equations of motion, which know nothing of groups or steps.

use crate::Flags;
use crate::SphericalPendulum;
use crate::throw::Way;
use clebsch::{Clebsch, Differentiated};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::reference;
use clebsch_examples::scene::Failure;
use nalgebra::{Vector3, Vector6};

/// q̇ at the start, 1/s, from the momentum before the first step: N × q.
///
/// At order 1 that momentum is the one half a kick later, as its step kicks only once, at the end. The path is that of
/// order 2.
pub fn launch(momentum: &Vector3<f64>, flags: &Flags, h: f64) -> Vector3<f64> {
    let from = flags.ends().0;
    let half_kick = match flags.run.order {
        Order::First => from.cross(&Vector3::z()) * (-flags.gravity * h / 2.0),
        Order::Second => Vector3::zeros(),
    };
    (momentum - half_kick).cross(&from)
}

/// By how much the throws found with steps of h, h/2 and h/4 miss the target: their velocities are off by O(h²).
pub fn converge<M: Differentiated<SphericalPendulum, 3>>(way: Way, flags: &Flags) -> Result<Convergence, Failure> {
    let (from, to) = flags.ends();
    let mut reference = 0.0_f64;
    let mut missed = |part: u64| -> Result<f64, Failure> {
        let h = flags.run.step_size / part as f64;
        let stepper = SphericalPendulum { gravity: flags.gravity }.into_stepper_by::<M>(h)?;
        let (mut path, guess) = way.guess::<M>(flags, part)?;
        let extremal = stepper.boundary().solve(&from, &to, guess, &mut path)?;
        let arrival = fly(&from, &launch(extremal.momentum(), flags, h), flags);
        reference = reference.max(arrival.error);
        Ok((arrival.end.fixed_rows::<3>(0) - to).norm())
    };
    let errors = [missed(1)?, missed(2)?, missed(4)?];
    Ok(Convergence { errors, reference, steps: flags.run.steps })
}

/// (q, q̇) after the duration, by q̈ = −g e₃ + (g q₃ − |q̇|²) q.
fn fly(from: &Vector3<f64>, velocity: &Vector3<f64>, flags: &Flags) -> reference::Solution<6> {
    let g = flags.gravity;
    let field = |y: &Vector6<f64>| {
        let (q, v): (Vector3<f64>, Vector3<f64>) = (y.fixed_rows::<3>(0).into(), y.fixed_rows::<3>(3).into());
        let acceleration = q * (g * q.z - v.norm_squared()) - Vector3::z() * g;
        Vector6::new(v.x, v.y, v.z, acceleration.x, acceleration.y, acceleration.z)
    };
    let start = Vector6::new(from.x, from.y, from.z, velocity.x, velocity.y, velocity.z);
    let rate = velocity.norm() + 2.0 * g.abs().sqrt();
    reference::solve(field, start, flags.run.duration(), rate)
}
