//! From the identity to the solution along the path of ρ(ξ; sμ) = 0, s from 0 to 1.
//!
//! The path is followed in small steps. Each is a prediction along the tangent, followed by Newton's method with one of
//! the M + 1 unknowns (ξ, s) fixed. This is the one that changes fastest. So it does not stall where s reaches a
//! maximum and the path turns back, the end of solvability. The sign of det Dρ tells the side of such a point.
//! Reference: Rheinboldt, *Numerical Analysis of Parametrized Nonlinear Equations*, 1986.

mod bracket;
mod point;

use super::{Equation, Jacobian, allowed, is_much_smaller, size};
use crate::space::larger;
use crate::{Error, Real, Space};
use nalgebra::SVector;
pub(super) use point::Homotopy;
use point::PathPoint;

/// Bound on the linearisations in following one path; the step that reaches it is finished, which takes at most four more.
pub const LINEARIZATIONS: u32 = 1024;

impl<'a, T: Real, E: Equation<T, M, N>, const M: usize, const N: usize> Homotopy<'a, T, E, M, N> {
    /// The solution for s = 1 on the branch from the identity, in not more than `limit` iterations with those that were `made` before.
    #[cold]
    #[inline(never)]
    pub fn follow(
        equation: &'a E,
        target: &SVector<T, N>,
        made: u32,
        limit: Option<u32>,
    ) -> Result<SVector<T, M>, Error> {
        if !target.all_finite() {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        let most = allowed(LINEARIZATIONS, limit, made);
        let (mut homotopy, mut here) = Self::start(equation, target, made, most)?;
        if homotopy.scale == T::zero() {
            return Ok(here.xi);
        }
        let (half, eighth, two) = (T::from_ratio(1, 2), T::from_ratio(1, 8), T::from_f64(2.0));
        let mut length = T::from_ratio(1, 4);
        while homotopy.is_affordable() {
            if let Some(xi) = homotopy.land(&here, length * two) {
                return Ok(xi);
            }
            let parameter = homotopy.fastest(&here);
            match homotopy.step(&here, parameter, length) {
                Some(next) if next.is_past || next.s >= T::one() => {
                    return bracket::decide(&mut homotopy, here, next, parameter);
                }
                Some(next) => {
                    here = next;
                    // Longer steps far out, for paths that leave the chart.
                    let longest = larger(half, homotopy.distance(&here.xi, here.s) * half);
                    length = if length * two < longest { length * two } else { longest };
                }
                None => length *= eighth,
            }
            // Steps that cannot be seen: the path ends here, in a point where several folds meet.
            if length <= T::from_f64(8.0) * T::EPSILON * homotopy.distance(&here.xi, here.s) {
                return Err(Error::unsolvable(here.s));
            }
        }
        Err(homotopy.exhausted(&here))
    }

    /// Newton's method for s = 1 from the tangent at `here`, if that is within `reach` and contracts cleanly on the branch.
    fn land(&mut self, here: &PathPoint<T, M>, reach: T) -> Option<SVector<T, M>> {
        let distance = T::one() - here.s;
        if here.slope_s <= T::zero() || distance > reach * here.slope_s {
            return None;
        }
        let step = here.slope_xi * (distance / here.slope_s);
        let mut xi = here.xi + step;
        let half = T::from_ratio(1, 2);
        let (mut before, mut residual_before) = (size(&step), SVector::from_element(T::zero()));
        while self.is_affordable() {
            T::iterated();
            self.count += 1;
            let (residual, jacobian) = self.equation.linearize(&self.moving, &xi);
            let (correction, orientation) = jacobian.solve(&residual)?;
            if Some(orientation) != self.branch {
                return None;
            }
            let terms = larger(self.weight, jacobian.largest_entry() * size(&xi));
            xi -= correction;
            let (now, seen) = (size(&correction), T::EPSILON * size(&xi));
            let ratio = now / before;
            if ratio <= half {
                if now * ratio * ratio <= seen * T::from_ratio(1, 4) && self.is_small(&residual, T::one()) {
                    return Some(xi);
                }
            } else {
                if now <= seen && self.is_small(&residual, T::one()) || self.is_round_off(&residual, terms, T::one()) {
                    return Some(xi);
                }
                if !is_much_smaller(&residual, &residual_before) {
                    return None;
                }
            }
            (before, residual_before) = (now, residual);
        }
        None
    }
}
