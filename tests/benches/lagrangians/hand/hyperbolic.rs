//! The metric on orbits of SO(2, 1), with products of vectors.
//!
//! η = diag(1, 1, −1) and Zq = η(z × q) give Z²q = (z·ηz)q − (ηz·q)z and ZZZ = (z·ηz)Z.
//! So cay(Z) = I + c(Z + Z²) with c = 2/(1 − z·ηz), and momenta are q × ηp.

use super::{ByHand, newton};
use crate::systems::Hyperbolic;
use nalgebra::{Matrix3, Vector3};

pub struct Orbit {
    inertia: Vector3<f64>,
    stiffness: f64,
    h: f64,
}

/// The vector z of Σ x_i E_i. Its inverse is `basis`, and momenta transform alike.
pub fn vector(x: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(-x[2], x[1], x[0])
}

/// The components in the basis of the group.
pub fn basis(z: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(z[2], z[1], -z[0])
}

/// ηv
fn eta(v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, v.y, -v.z)
}

impl Orbit {
    pub fn new(system: &Hyperbolic, h: f64) -> Self {
        let weights = system.inertia;
        Self { inertia: Vector3::new(weights[2], weights[1], weights[0]), stiffness: system.stiffness, h }
    }

    /// J(q, p e₃)
    fn map(q: &Vector3<f64>, p: f64) -> Vector3<f64> {
        q.cross(&Vector3::new(0.0, 0.0, -p))
    }
}

impl ByHand for Orbit {
    type State = (Vector3<f64>, Vector3<f64>);

    fn step(&self, (q, n): Self::State) -> Self::State {
        let h = self.h;
        let mu = n + Self::map(&q, -0.5 * h * self.stiffness);
        let here = 1.0 + q.z * q.z;
        let by_height = Self::map(&q, q.z);
        let moved = |z: &Vector3<f64>| {
            let dual = eta(z);
            let c = 2.0 / (1.0 - z.dot(&dual));
            let both = eta(&z.cross(&q)) + q * z.dot(&dual) - z * dual.dot(&q);
            (dual, c, both, q + c * both)
        };
        let z = newton(|z: &Vector3<f64>| {
            let (dual, c, both, next) = moved(z);
            let there = 1.0 + next.z * next.z;
            let xi = z * (2.0 / h);
            let weighted = self.inertia.component_mul(&xi);
            let g = weighted * (here + there);
            let along = g.dot(z);
            let energy = xi.dot(&weighted);
            let residual = 0.5 * (g + eta(&g).cross(z) - dual * along) - by_height * (0.5 * h * energy) - mu;

            // the row e₃ᵀ∂(cay(Z)q)/∂z
            let turned = Vector3::new(-q.y, q.x, 0.0);
            let squared = dual * (2.0 * q.z) - eta(&q) * z.z - Vector3::z() * dual.dot(&q);
            let height = dual * (c * c * both.z) + (turned + squared) * c;
            let dg = Matrix3::from_diagonal(&(self.inertia * ((here + there) * 2.0 / h)))
                + weighted * (height * (2.0 * next.z)).transpose();
            let mut jacobian = dg - z.cross_matrix() * Matrix3::from_diagonal(&eta(&Vector3::repeat(1.0))) * dg;
            jacobian += eta(&g).cross_matrix() - dual * (dg.tr_mul(z) + g).transpose();
            jacobian -= Matrix3::from_diagonal(&(eta(&Vector3::repeat(1.0)) * along));
            (residual, 0.5 * jacobian - by_height * (2.0 * weighted).transpose())
        });
        let (dual, _, _, next) = moved(&z);
        let xi = z * (2.0 / h);
        let weighted = self.inertia.component_mul(&xi);
        let g = weighted * (here + 1.0 + next.z * next.z);
        let end = Self::map(&next, next.z * 0.5 * h * xi.dot(&weighted) - 0.5 * h * self.stiffness);
        (next, 0.5 * (g - eta(&g).cross(&z) - dual * g.dot(&z)) + end)
    }
}
