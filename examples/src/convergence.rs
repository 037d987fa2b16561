//! The order of the steps, measured against a reference that shares nothing with them.

use crate::claims::Claims;
use crate::flags::{Order, Run};
use crate::scene::Failure;
use clebsch::{Clebsch, Method, State, Stepper};

/// Errors above this, relative, are not yet a power of the step.
const LARGEST: f64 = 0.03;
/// Errors below this many errors of the reference, or roundings, say nothing.
const CLEARANCE: f64 = 50.0;
/// How far a measured slope may be from the order: the next term of the series in h, and its share at h/4.
const SLOPE: f64 = 0.1;

/// Ends of the same motion with steps of h, h/2 and h/4.
///
/// # Errors
/// The errors of a start or of a step.
pub fn refined<S: Clebsch<Scalar = f64> + Clone, M: Method<S>>(
    system: &S,
    run: &Run,
    steps: u64,
    start: impl Fn(&Stepper<S, M>) -> Result<State<S, M>, clebsch::Error>,
) -> Result<[State<S, M>; 3], Failure> {
    let end = |part: u64| -> Result<State<S, M>, Failure> {
        let stepper = system.clone().into_stepper_by(run.step_size / part as f64)?;
        let mut state = start(&stepper)?;
        for step in 1..=steps * part {
            state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        }
        Ok(state)
    };
    Ok([end(1)?, end(2)?, end(4)?])
}

/// Errors of steps of h, h/2 and h/4 at the same time, relative to the size of the solution.
#[derive(Clone, Copy, Debug)]
pub struct Convergence {
    /// Largest first.
    pub errors: [f64; 3],
    /// Of the reference itself, and of rounding where that is magnified; from above.
    pub reference: f64,
    /// Steps of h up to that time.
    pub steps: u64,
}

impl Convergence {
    /// Claims that halving the step divides the error by 2 or by 4, as the order says.
    pub fn claim(&self, order: Order, name: &str, claims: &mut Claims) {
        let [coarse, middle, fine] = self.errors;
        let rounding = f64::EPSILON * (4.0 * self.steps as f64).sqrt();
        let floor = CLEARANCE * self.reference.max(rounding);
        if coarse > LARGEST {
            let reason = format!("the error {coarse:.1e} is not small: too long a step, or too long a time");
            claims.skip(name, &reason);
        } else if fine < floor {
            claims.skip(name, &format!("the error {fine:.1e} is as small as that of the reference, or rounding"));
        } else {
            let expected = if order == Order::First { 1.0 } else { 2.0 };
            let reason =
                format!("slope from h/2 to h/4; error with h {coarse:.1e}, of the reference {:.0e}", self.reference);
            claims.within(name, (middle / fine).log2(), expected - SLOPE..=expected + SLOPE, 3, &reason);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failed(errors: [f64; 3]) -> usize {
        let mut claims = Claims::new();
        Convergence { errors, reference: 1e-13, steps: 100 }.claim(Order::Second, "the order is 2", &mut claims);
        claims.failed().count()
    }

    #[test]
    fn a_wrong_order_fails_and_rounding_says_nothing() {
        assert_eq!(failed([1.6e-4, 4e-5, 1e-5]), 0);
        assert_eq!(failed([1.6e-4, 8e-5, 4e-5]), 1, "order 1");
        assert_eq!(failed([1.6e-11, 8e-12, 4e-12]), 0, "as small as the reference");
        assert_eq!(failed([0.5, 0.25, 0.12]), 0, "too long a step");
    }
}
