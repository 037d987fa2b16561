//! The input: a group, its action and a discrete Lagrangian.

use super::group::Group;
use super::matrix::Matrix;
use super::real::Real;

/// Left: Φ_gh = Φ_g Φ_h, such as F·q. Right: Φ_gh = Φ_h Φ_g, such as q·F.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Side {
    /// Momenta and velocities are spatial.
    Left,
    /// Momenta and velocities are in the body.
    Right,
}

/// One factor of the group and the side from which it acts.
#[derive(Clone, Debug)]
pub struct Factor {
    /// The factor.
    pub group: Group,
    /// Its side.
    pub side: Side,
}

/// A factor that acts from the left.
pub fn left(group: Group) -> Factor {
    Factor { group, side: Side::Left }
}

/// A factor that acts from the right.
pub fn right(group: Group) -> Factor {
    Factor { group, side: Side::Right }
}

/// The identity of each factor.
pub(super) fn identity<R: Real>(factors: &[Factor]) -> Vec<Matrix<R>> {
    factors.iter().map(|factor| Matrix::identity(factor.group.size())).collect()
}

/// exp(Σ x_i E_i) of each factor.
pub(super) fn elements<R: Real>(factors: &[Factor], mut x: &[R]) -> Vec<Matrix<R>> {
    let mut element = |factor: &Factor| {
        let (block, rest) = x.split_at(factor.group.basis.len());
        x = rest;
        factor.group.combination(block).exponential()
    };
    factors.iter().map(&mut element).collect()
}

/// A discrete optimal control problem of Clebsch type, with its arguments in the order of declarations.
///
/// `f` has one matrix for each factor, `q` any number of matrices, vectors being columns.
pub trait Problem {
    /// The factors of the group; momenta are the components of the first factor, then of the second, …
    fn factors(&self) -> Vec<Factor>;

    /// Φ_F(q), polynomial or rational in F.
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>>;

    /// K(t, h, q, F), the kinetic part of the discrete Lagrangian of the step from t to t + h.
    fn cost<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R;

    /// V(t, q).
    fn potential<R: Real>(&self, _t: R, _q: &[Matrix<R>]) -> R {
        R::zero()
    }

    /// ℓd(t, h, q, F) = K − h/2 (V(t, q) + V(t + h, Φ_F q)).
    ///
    /// A step of first order as in the papers, on (q, M), has K − h V(t + h, Φ_F q) here.
    fn lagrangian<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let potential = self.potential(t, q) + self.potential(t + h, &self.act(f, q));
        self.cost(t, h, q, f) - h * potential * 0.5
    }
}

/// ℓd*(t, h, q, F) = −ℓd(t + h, −h, Φ_F q, F⁻¹): its step is the inverse of the step by −h of ℓd.
pub struct Adjoint<'a, P>(pub &'a P);

impl<P: Problem> Problem for Adjoint<'_, P> {
    fn factors(&self) -> Vec<Factor> {
        self.0.factors()
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        self.0.act(f, q)
    }
    fn cost<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        -self.0.cost(t + h, -h, &self.act(f, q), &inverse(f))
    }
    fn potential<R: Real>(&self, t: R, q: &[Matrix<R>]) -> R {
        self.0.potential(t, q)
    }
    fn lagrangian<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        -self.0.lagrangian(t + h, -h, &self.act(f, q), &inverse(f))
    }
}

fn inverse<R: Real>(f: &[Matrix<R>]) -> Vec<Matrix<R>> {
    f.iter().map(Matrix::inverse).collect()
}
