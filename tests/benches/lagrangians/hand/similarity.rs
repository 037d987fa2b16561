//! Similarities of the plane with complex numbers: z = (a, v) moves t to ((1 + a)t + 2v)/(1 − a).

use super::{ByHand, newton};
use crate::systems::Similarity;
use nalgebra::{Complex, Matrix3, Matrix4, Vector4};

type C = Complex<f64>;

pub struct Plane {
    pub system: Similarity,
    pub h: f64,
}

fn parts(x: &Vector4<f64>) -> (C, C) {
    (C::new(x[1], x[0]), C::new(x[2], x[3]))
}

fn join(b: C, v: C) -> Vector4<f64> {
    Vector4::new(b.im, b.re, v.re, v.im)
}

impl Plane {
    fn kick(&self, q: &Matrix3<f64>) -> Vector4<f64> {
        let slope = self.system.stiffness.component_mul(q) * -self.h;
        let m = slope * q.transpose();
        Vector4::new(m[(1, 0)] - m[(0, 1)], m[(0, 0)] + m[(1, 1)], m[(0, 2)], m[(1, 2)])
    }
}

impl ByHand for Plane {
    type State = (Matrix3<f64>, Vector4<f64>);

    fn step(&self, (q, n): Self::State) -> Self::State {
        let h = self.h;
        let inertia = &self.system.inertia;
        let one = C::new(1.0, 0.0);
        let mu = n + self.kick(&q);
        let t = C::new(q[(0, 2)], q[(1, 2)]);
        let here = 1.0 + t.norm_sqr();
        let x = newton(|x: &Vector4<f64>| {
            let (a, v) = parts(x);
            let over = one / (one - a);
            let next = ((one + a) * t + v * 2.0) * over;
            let both = here + 1.0 + next.norm_sqr();
            let xi = x * (2.0 / h);
            let weighted = inertia.component_mul(&xi);
            let g = weighted * (both * 0.5);
            let (by_a, by_v) = parts(&g);
            let scale = (one - a * a).conj();
            let shift = ((one + a) * v).conj();
            let quarter = 0.5 * h * xi.dot(&weighted);
            let moved = join(scale * by_a - shift * by_v, (one + a).conj() * by_v);
            let residual = moved - join(t.conj() * t, t) * quarter - mu;
            let mut jacobian = Matrix4::zeros();
            for k in 0..4 {
                let (da, dv) = parts(&Vector4::ith(k, 1.0));
                let dt = (da * (t + next) + dv * 2.0) * over;
                let mut dg = weighted * (next.re * dt.re + next.im * dt.im);
                dg[k] += inertia[k] * both / h;
                let (dg_a, dg_v) = parts(&dg);
                let d_scale = (a * da * -2.0).conj();
                let d_shift = (da * v + (one + a) * dv).conj();
                let d_moved = join(
                    scale * dg_a - shift * dg_v + d_scale * by_a - d_shift * by_v,
                    (one + a).conj() * dg_v + da.conj() * by_v,
                );
                jacobian.set_column(k, &(d_moved - join(t.conj() * t, t) * (2.0 * weighted[k])));
            }
            (residual, jacobian)
        });
        let (a, v) = parts(&x);
        let over = one / (one - a);
        let f = (one + a) * over;
        let b = v * 2.0 * over;
        let next = Matrix3::new(f.re, -f.im, b.re, f.im, f.re, b.im, 0.0, 0.0, 1.0) * q;
        let t = C::new(next[(0, 2)], next[(1, 2)]);
        let xi = x * (2.0 / h);
        let weighted = inertia.component_mul(&xi);
        let (by_a, by_v) = parts(&(weighted * ((here + 1.0 + t.norm_sqr()) * 0.5)));
        let quarter = 0.5 * h * xi.dot(&weighted);
        let moved = join((one - a * a).conj() * by_a + ((one - a) * v).conj() * by_v, (one - a).conj() * by_v);
        (next, moved + join(t.conj() * t, t) * quarter + self.kick(&next))
    }
}

/// Suzuki's composition of order 4: two steps of h/(4 − ∛4), one of the remaining size, and two more of h/(4 − ∛4).
pub struct Composed {
    outer: Plane,
    middle: Plane,
}

impl Composed {
    pub fn new(system: &Similarity, h: f64) -> Self {
        let share = 1.0 / (4.0 - 4.0_f64.cbrt());
        let of_size = |h: f64| Plane { system: system.clone(), h };
        Self { outer: of_size(share * h), middle: of_size((1.0 - 4.0 * share) * h) }
    }
}

impl ByHand for Composed {
    type State = <Plane as ByHand>::State;

    fn step(&self, state: Self::State) -> Self::State {
        let twice = |state| self.outer.step(self.outer.step(state));
        twice(self.middle.step(twice(state)))
    }
}
