//! One lane of an equation as an equation for single numbers: lanes that Newton's method leaves undecided are solved
//! one by one.

use super::path::Homotopy;
use super::{Equation, Jacobian, QUICK, at_identity, not_converged, size, with_derivatives};
use crate::orientation::Orientation;
use crate::{Error, Mask, Scalar, Space};
use core::marker::PhantomData;
use nalgebra::SVector;
use num_traits::Zero;

/// The solutions `xi`, completed by following the path from the identity in the lanes that are not `solved` after `made` iterations. A lane
/// that has none becomes NaN. If none has one, the error is that of the first whose target is finite: the others have none of their own.
#[cold]
#[inline(never)]
pub(super) fn follow<T: Scalar, E: Equation<T, M, N>, const M: usize, const N: usize>(
    equation: &E,
    target: &SVector<T, N>,
    xi: &SVector<T, M>,
    solved: T::Mask,
    made: u32,
) -> Result<SVector<T, M>, Error> {
    let mut xi = *xi;
    let mut failure = None;
    let mut is_solved = solved.any();
    for lane in (0..T::LANES).filter(|&lane| !solved.lane(lane)) {
        let own = target.lane(lane);
        let equation = InLane { equation, lane, scalar: PhantomData };
        let found = match E::limit() {
            // decided where the program is made: a limit that Newton's method may use up leaves no path to follow
            Some(limit) if limit <= QUICK => Err(unfinished(&equation, &own, &xi.lane(lane), made)),
            limit => Homotopy::follow(&equation, &own, made, limit),
        };
        match found {
            Ok(found) => {
                let found = if T::DERIVATIVES == 0 { found } else { with_derivatives(&equation, &own, found) };
                xi.set_lane(lane, &found);
                is_solved = true;
            }
            Err(error) => {
                xi.set_lane(lane, &SVector::from_element(T::Lane::zero() / T::Lane::zero()));
                failure = match failure {
                    Some((known, true)) => Some((known, true)),
                    Some((known, false)) if !own.all_finite() => Some((known, false)),
                    _ => Some((error, own.all_finite())),
                };
            }
        }
    }
    match failure {
        Some((error, _)) if !is_solved => Err(error),
        _ => Ok(xi),
    }
}

/// The error of an iteration that ends at ξ, as no more are allowed.
fn unfinished<T: Scalar, E: Equation<T, M, N>, const M: usize, const N: usize>(
    equation: &E,
    target: &SVector<T, N>,
    xi: &SVector<T, M>,
    made: u32,
) -> Error {
    if !target.all_finite() {
        return Error::NotFinite { name: "the momentum" };
    }
    let terms = equation.prepare(target);
    let [left, whole] = [*xi, SVector::from_element(T::zero())].map(|xi| size(&equation.residual(&terms, &xi)));
    not_converged(left / whole, made)
}

/// The equation in one lane.
struct InLane<'a, T, E> {
    equation: &'a E,
    lane: usize,
    scalar: PhantomData<T>,
}

impl<T: Scalar, E: Equation<T, M, N>, const M: usize, const N: usize> Equation<T::Lane, M, N> for InLane<'_, T, E> {
    type Terms = E::Terms;
    type Jacobian = <E::Jacobian as Jacobian<T, M>>::Lane;

    fn prepare(&self, target: &SVector<T::Lane, N>) -> Self::Terms {
        self.equation.prepare(&everywhere(target))
    }

    fn linearize(&self, terms: &Self::Terms, xi: &SVector<T::Lane, M>) -> (SVector<T::Lane, M>, Self::Jacobian) {
        let (residual, jacobian) = self.equation.linearize(terms, &everywhere(xi));
        (residual.lane(self.lane), jacobian.lane(self.lane))
    }

    fn limit() -> Option<u32> {
        E::limit()
    }

    fn extent(&self) -> T::Lane {
        self.equation.extent().lane(self.lane)
    }

    fn orientation(&self) -> Option<Orientation> {
        match self.equation.orientation() {
            Some(orientation) => Some(orientation.lane(self.lane)),
            // singular in this lane or in another
            None => at_identity(self),
        }
    }
}

/// The same vector in all lanes.
fn everywhere<T: Scalar, const M: usize>(vector: &SVector<T::Lane, M>) -> SVector<T, M> {
    vector.map(|x| T::from_lanes(|_| x))
}
