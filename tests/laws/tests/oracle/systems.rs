//! Problems with exact decimal parameters.

use clebsch_tests::oracle::precise::group::{sl, so};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem, left, right};
use clebsch_tests::oracle::precise::real::Real;

/// diag(a_i/100).
fn hundredths<R: Real>(entries: &[i32]) -> Matrix<R> {
    Matrix::from_fn(entries.len(), entries.len(), |i, j| if i == j { R::ratio(entries[i], 100) } else { R::zero() })
}

/// ⟨F − I, 2 J_d (F − I)⟩/(2h).
fn moser_veselov<R: Real>(j_d: &Matrix<R>, h: R, f: &Matrix<R>) -> R {
    let change = f - Matrix::identity(f.shape().0);
    change.dot(&(j_d * &change)) / h
}

/// s = e_z · Rχ for χ = (0.1, 0.2, 1).
pub fn height<R: Real>(r: &Matrix<R>) -> R {
    r[(2, 0)] * R::ratio(1, 10) + r[(2, 1)] * R::ratio(2, 10) + r[(2, 2)]
}

/// The paper's spherical pendulum: ℓd = ‖F − I‖²/(2h) − 2h g (F q)_z, so M⁺ = M − h(∇V qᵀ − q ∇Vᵀ) at q⁺.
pub struct PaperPendulum;

impl Problem for PaperPendulum {
    fn factors(&self) -> Vec<Factor> {
        vec![left(so(3))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&f[0] * &q[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        (&f[0] - Matrix::identity(3)).norm_squared() / (h * 2.0)
    }
    fn lagrangian<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        self.cost(t, h, q, f) - h * R::ratio(2 * 981, 100) * self.act(f, q)[0][(2, 0)]
    }
}

/// The free body of Moser and Veselov on SO(n), J_d in hundredths.
pub struct FreeBody<'a>(pub &'a [i32]);

impl Problem for FreeBody<'_> {
    fn factors(&self) -> Vec<Factor> {
        vec![right(so(self.0.len()))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        moser_veselov(&hundredths(self.0), h, &f[0])
    }
}

/// Where a step has its potential V.
#[derive(Copy, Clone, PartialEq)]
pub enum Placement {
    /// −h V(Φ_F q): the papers' step on (q, M), drift then kick.
    End,
    /// −h/2 (V(q) + V(Φ_F q)).
    Both,
}

/// A heavy top of inertia diag(1, 1.4, 0.9) with V = 0.8 s.
pub struct HeavyTop(pub Placement);

impl Problem for HeavyTop {
    fn factors(&self) -> Vec<Factor> {
        vec![right(so(3))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        // half of ½tr(J)I − J
        moser_veselov(&hundredths(&[65, 25, 75]), h, &f[0]) * 0.5
    }
    fn potential<R: Real>(&self, _t: R, q: &[Matrix<R>]) -> R {
        height(&q[0]) * R::ratio(8, 10)
    }
    fn lagrangian<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let end = self.potential(t + h, &self.act(f, q));
        let potential = if self.0 == Placement::End { end } else { (self.potential(t, q) + end) * 0.5 };
        self.cost(t, h, q, f) - h * potential
    }
}

/// J_d = diag(0.6, 0.4, 0.25) and V = 0.8 s + 0.5 s² at the mean of both ends: a coupled cost.
pub struct MidpointTop;

impl Problem for MidpointTop {
    fn factors(&self) -> Vec<Factor> {
        vec![right(so(3))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let s = height(&(&q[0] + &q[0] * &f[0])) * 0.5;
        moser_veselov(&hundredths(&[60, 40, 25]), h, &f[0]) - h * (s * R::ratio(8, 10) + s * s * 0.5)
    }
}

/// Geodesics of SL(2): ⟨F − I, W ∘ (F − I)⟩/(2h), W_11 in tenths, the other weights one.
pub struct WeightedSl2(pub i32);

impl Problem for WeightedSl2 {
    fn factors(&self) -> Vec<Factor> {
        vec![right(sl(2))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let change = &f[0] - Matrix::identity(2);
        let first = change[(0, 0)] * change[(0, 0)] * (R::ratio(self.0, 10) - R::one());
        (change.norm_squared() + first) / (h * 2.0)
    }
}

/// A drop of fluid without forces: ‖F q − q‖²/(2h) on SL(3) from the left, a cost that couples q and F.
pub struct FluidEllipsoid;

impl Problem for FluidEllipsoid {
    fn factors(&self) -> Vec<Factor> {
        vec![left(sl(3))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&f[0] * &q[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        (&f[0] * &q[0] - &q[0]).norm_squared() / (h * 2.0)
    }
}
