//! Foucault's pendulum with vectors: cay(z) turns q by q + c(z × q + z × (z × q)), c = 2/(1 + |z|²).

use super::{ByHand, newton};
use crate::systems::Foucault;
use nalgebra::{Matrix3, Vector3};

pub struct Pendulum {
    pub system: Foucault,
    pub h: f64,
}

impl Pendulum {
    /// ∂ℓ/∂ξ
    fn momentum(&self, q: &Vector3<f64>, xi: &Vector3<f64>) -> Vector3<f64> {
        q.cross(&(xi + self.system.rate).cross(q)) + xi.dot(q) * q
    }

    /// ∂ℓ/∂q
    fn slope(&self, q: &Vector3<f64>, xi: &Vector3<f64>) -> Vector3<f64> {
        let turning = xi + self.system.rate;
        turning.cross(q).cross(&turning) + xi.dot(q) * xi
    }

    fn kick(&self, q: &Vector3<f64>) -> Vector3<f64> {
        q.cross(&Vector3::new(0.0, 0.0, -0.5 * self.h * self.system.gravity))
    }
}

impl ByHand for Pendulum {
    type State = (Vector3<f64>, Vector3<f64>);

    fn step(&self, (q, n): Self::State) -> Self::State {
        let h = self.h;
        let identity = Matrix3::identity();
        let mu = n + self.kick(&q);
        let q_hat = q.cross_matrix();
        let metric = -q_hat * q_hat + q * q.transpose();
        let turned = |z: &Vector3<f64>| {
            let c = 2.0 / (1.0 + z.norm_squared());
            let once = z.cross(&q);
            let both = once + z.cross(&once);
            (c, once, both, q + c * both)
        };
        let z = newton(|z: &Vector3<f64>| {
            let xi = z * (2.0 / h);
            let turning = xi + self.system.rate;
            let (c, once, both, next) = turned(z);
            let z_hat = z.cross_matrix();
            let g = self.momentum(&q, &xi) + self.momentum(&next, &xi);
            let residual = 0.5 * (g + g.cross(z) + z.dot(&g) * z) - 0.5 * h * q.cross(&self.slope(&q, &xi)) - mu;

            let next_slope = (-c * c) * both * z.transpose() - c * (q_hat + once.cross_matrix() + z_hat * q_hat);
            let next_hat = next.cross_matrix();
            let next_metric = -next_hat * next_hat + next * next.transpose();
            let by_next = -turning.cross(&next).cross_matrix()
                + next_hat * turning.cross_matrix()
                + next * xi.transpose()
                + identity * xi.dot(&next);
            let dg = (2.0 / h) * (metric + next_metric) + by_next * next_slope;
            let outer = z * (dg.tr_mul(z) + g).transpose() + identity * z.dot(&g);
            let moved = 0.5 * (dg - z_hat * dg + g.cross_matrix() + outer);
            let slope_by_xi = turning.cross(&q).cross_matrix()
                + turning.cross_matrix() * q_hat
                + xi * q.transpose()
                + identity * q.dot(&xi);
            (residual, moved - q_hat * slope_by_xi)
        });
        let xi = z * (2.0 / h);
        let (_, _, _, next) = turned(&z);
        let g = self.momentum(&q, &xi) + self.momentum(&next, &xi);
        let momentum = 0.5 * (g - g.cross(&z) + z.dot(&g) * z) + 0.5 * h * next.cross(&self.slope(&next, &xi));
        (next, momentum + self.kick(&next))
    }
}
