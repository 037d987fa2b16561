//! Points of the path, and Newton's method with one unknown fixed.

use crate::implicit::{Equation, Jacobian, is_much_smaller, not_converged, size};
use crate::orientation::Orientation;
use crate::space::larger;
use crate::{Error, Real, Space};
use nalgebra::SVector;

/// A point (ξ, s) of the path with its unit tangent, in the direction away from the identity.
#[derive(Clone, Copy)]
pub(crate) struct PathPoint<T: Real, const M: usize> {
    pub xi: SVector<T, M>,
    pub s: T,
    pub slope_xi: SVector<T, M>,
    pub slope_s: T,
    /// Whether the branch has ended before: det Dρ has changed its sign, or s goes back.
    pub is_past: bool,
}

/// The equation ρ(ξ; sμ) = 0 in the M + 1 unknowns (ξ, s).
pub(crate) struct Homotopy<'a, T: Real, E: Equation<T, M, N>, const M: usize, const N: usize> {
    pub equation: &'a E,
    /// Terms for the target 0.
    still: E::Terms,
    /// Terms for the target μ.
    pub moving: E::Terms,
    /// The sign of det Dρ on the branch.
    pub branch: Option<Orientation>,
    /// Largest entry of dξ/ds at the identity: the unit for a change of ξ.
    pub scale: T,
    /// Size of ρ(0; μ): the unit for a residual.
    pub weight: T,
    /// The linearisations on the path.
    pub count: u32,
    /// The most linearisations.
    most: u32,
    /// The iterations before the path was followed.
    made: u32,
}

/// ρ, Dρ and ∂ρ/∂s at a point.
struct Linearization<T: Real, J: Jacobian<T, M>, const M: usize> {
    residual: SVector<T, M>,
    jacobian: J,
    rate: SVector<T, M>,
}

impl<'a, T: Real, E: Equation<T, M, N>, const M: usize, const N: usize> Homotopy<'a, T, E, M, N> {
    /// The path, and its point ξ = 0, s = 0. There is no solution where det Dρ has another sign than on the branch.
    pub fn start(
        equation: &'a E,
        target: &SVector<T, N>,
        made: u32,
        most: u32,
    ) -> Result<(Self, PathPoint<T, M>), Error> {
        let still = equation.prepare(&SVector::from_element(T::zero()));
        let moving = equation.prepare(target);
        let (branch, zero) = (equation.orientation(), T::zero());
        let mut path = Self { equation, still, moving, branch, scale: zero, weight: zero, count: 0, most, made };
        let xi = SVector::from_element(zero);
        let Linearization { jacobian, rate, .. } = path.linearize(&xi, zero);
        if !(jacobian.all_finite() && rate.all_finite()) {
            return Err(Error::NotFinite { name: "the implicit equation of the step" });
        }
        let (slope_xi, orientation) = jacobian.solve_exchanged(None, &-rate).ok_or(Error::unsolvable(zero))?;
        if branch != Some(orientation) || !slope_xi.all_finite() {
            return Err(Error::unsolvable(zero));
        }
        (path.scale, path.weight) = (slope_xi.max_abs(), size(&rate));
        Ok((path, PathPoint { xi, s: zero, slope_xi, slope_s: T::one(), is_past: false }))
    }

    pub fn is_affordable(&self) -> bool {
        self.count < self.most
    }

    /// The error for too much work.
    pub fn exhausted(&mut self, here: &PathPoint<T, M>) -> Error {
        let (residual, _) = self.equation.linearize(&self.moving, &here.xi);
        not_converged(size(&residual) / self.weight, self.made + self.count)
    }

    /// Whether a residual is no more than the rounding of terms of the size `terms`. Compared with s μ too: where the Jacobian grows without
    /// bound within the last place of ξ, any residual looks like rounding.
    pub fn is_round_off(&self, residual: &SVector<T, M>, terms: T, s: T) -> bool {
        size(residual) <= T::from_f64(8.0) * T::EPSILON * terms && self.is_small(residual, s)
    }

    /// Whether a residual is small relative to s μ. It is not near a pole of ρ, where corrections are as small as the
    /// distance to it.
    pub fn is_small(&self, residual: &SVector<T, M>, s: T) -> bool {
        size(residual) <= self.weight * s.abs() * T::from_ratio(1, 16)
    }

    /// Distance of a point from the identity, in units of the scale and of s.
    pub fn distance(&self, xi: &SVector<T, M>, s: T) -> T {
        size(xi) / self.scale + s.abs()
    }

    /// The unknown that changes fastest along the path: the number of one of ξ, or M for s.
    pub fn fastest(&self, point: &PathPoint<T, M>) -> usize {
        let mut fastest = (M, point.slope_s.abs());
        for (j, slope) in point.slope_xi.iter().enumerate() {
            let speed = slope.abs() / self.scale;
            if speed > fastest.1 {
                fastest = (j, speed);
            }
        }
        fastest.0
    }

    /// The point at `length` along the tangent, brought back to the path with `parameter` fixed. `None` if Newton's method does not
    /// contract cleanly or the path turns by too much for this length.
    pub fn step(&mut self, from: &PathPoint<T, M>, parameter: usize, length: T) -> Option<PathPoint<T, M>> {
        let (mut xi, mut s) = (from.xi + from.slope_xi * length, from.s + from.slope_s * length);
        let half = T::from_ratio(1, 2);
        let (mut before, mut residual_before) = (length * half, SVector::from_element(T::zero()));
        let mut is_first = true;
        while self.is_affordable() {
            let at = self.linearize(&xi, s);
            let (correction, change) = at.solve(parameter, &at.residual, T::zero())?;
            let terms = larger(self.weight * s.abs(), at.jacobian.largest_entry() * size(&xi));
            xi -= correction;
            s -= change;
            // Only the unknowns that move count: a path that saturates has ξ far below its scale.
            let moving = if parameter < M { s } else { T::zero() };
            let (now, seen) = (self.distance(&correction, change), T::EPSILON * self.distance(&xi, moving));
            let ratio = now / before;
            // The first is compared with the length of the step, from which the next correction cannot be told.
            let is_found = now <= seen || !is_first && ratio <= half && now * ratio * ratio <= seen;
            if is_found && self.is_small(&at.residual, s) {
                return self.arrive(xi, s, parameter, from);
            }
            if ratio > half && self.is_round_off(&at.residual, terms, s) {
                return self.arrive(xi, s, parameter, from);
            }
            if ratio <= half || is_much_smaller(&at.residual, &residual_before) {
                (before, residual_before, is_first) = (now, at.residual, false);
            } else {
                return None;
            }
        }
        None
    }

    /// The tangent at a point of the path, and on which side of the end of the branch the point is.
    fn arrive(&mut self, xi: SVector<T, M>, s: T, parameter: usize, from: &PathPoint<T, M>) -> Option<PathPoint<T, M>> {
        let at = self.linearize(&xi, s);
        // the derivatives by the parameter
        let fixed = if parameter < M { at.jacobian.column(parameter) } else { at.rate };
        let (mut slope_xi, mut slope_s) = at.solve(parameter, &-fixed, T::one())?;
        let along = (slope_xi / self.scale).dot(&(from.slope_xi / self.scale)) + slope_s * from.slope_s;
        let speed = larger(slope_s.abs(), slope_xi.max_abs() / self.scale);
        let unit = if along < T::zero() { -T::one() / speed } else { T::one() / speed };
        slope_xi *= unit;
        slope_s *= unit;
        let half = T::from_ratio(1, 2);
        let turn = larger((slope_xi - from.slope_xi).max_abs() / self.scale, (slope_s - from.slope_s).abs());
        if turn < half {
            let is_past = slope_s <= T::zero() || at.jacobian.orientation() != self.branch;
            return Some(PathPoint { xi, s, slope_xi, slope_s, is_past });
        }
        None
    }

    /// ρ(ξ; sμ) = ρ(ξ; 0) + s(ρ(ξ; μ) − ρ(ξ; 0)), for ρ is affine in μ.
    fn linearize(&mut self, xi: &SVector<T, M>, s: T) -> Linearization<T, E::Jacobian, M> {
        self.count += 2;
        T::iterated();
        T::iterated();
        let (residual, jacobian) = self.equation.linearize(&self.still, xi);
        let (residual_moving, jacobian_moving) = self.equation.linearize(&self.moving, xi);
        let rate = residual_moving - residual;
        Linearization { residual: residual + rate * s, jacobian: jacobian.between(&jacobian_moving, s), rate }
    }
}

impl<T: Real, J: Jacobian<T, M>, const M: usize> Linearization<T, J, M> {
    /// Solves \[Dρ ∂ρ/∂s\] (ξ, s) = `right` without the column of the parameter, which gets `fixed`.
    fn solve(&self, parameter: usize, right: &SVector<T, M>, fixed: T) -> Option<(SVector<T, M>, T)> {
        let exchanged = (parameter < M).then_some((parameter, &self.rate));
        let (mut xi, _) = self.jacobian.solve_exchanged(exchanged, right)?;
        let mut s = fixed;
        if let Some(unknown) = xi.get_mut(parameter) {
            core::mem::swap(&mut s, unknown);
        }
        Some((xi, s))
    }
}
