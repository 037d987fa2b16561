//! The same schemes by hand in nalgebra, in vectors and matrices of each group, by the formulas of the generated steps.

pub mod chain;
pub mod foucault;
pub mod hyperbolic;
pub mod similarity;
pub mod unitary;

use nalgebra::{Const, DimMin, SMatrix, SVector};

/// A scheme by hand.
pub trait ByHand {
    /// Configuration and momentum.
    type State: Copy;
    /// One step.
    fn step(&self, state: Self::State) -> Self::State;
}

/// Iterations that no step of these systems needs.
const MOST: usize = 20;

/// Newton's method from zero, until the next correction is below round-off, as the generated steps end it.
#[inline(always)]
fn newton<const N: usize>(
    linearize: impl Fn(&SVector<f64, N>) -> (SVector<f64, N>, SMatrix<f64, N, N>),
) -> SVector<f64, N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let mut x = SVector::zeros();
    let mut before = f64::INFINITY;
    for _ in 0..MOST {
        let (residual, jacobian) = linearize(&x);
        let correction = jacobian.lu().solve(&residual).expect("a regular Jacobian");
        x -= correction;
        let now = correction.amax();
        let scale = x.amax();
        let ratio = now / before;
        let next = now * ratio * ratio;
        if now <= f64::EPSILON * scale || (ratio > 0.0 && ratio <= 0.5 && next <= f64::EPSILON / 4.0 * scale) {
            return x;
        }
        before = now;
    }
    panic!("Newton's method converges within {MOST} iterations")
}
