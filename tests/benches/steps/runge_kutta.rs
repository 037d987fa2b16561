//! The classical Runge–Kutta method on the same equations of motion: the usual choice where nothing better is at hand.

use crate::hand::{Kernel, rotation};
use std::hint::black_box;

/// An ordinary differential equation with the quantities that are checked along its solution.
pub trait Motion<const N: usize>: Copy {
    /// ẏ
    fn rate(&self, y: &[f64; N]) -> [f64; N];
    /// The configuration, in the order of the declared one's rows.
    fn configuration(y: &[f64; N]) -> Vec<f64>;
    /// Kinetic and potential energy.
    fn energy(&self, y: &[f64; N]) -> f64;
    /// By how much the configuration violates its constraint.
    fn defect(y: &[f64; N]) -> f64;
}

/// Four evaluations a step, order 4.
#[derive(Copy, Clone)]
pub struct RungeKutta<M, const N: usize> {
    motion: M,
    y: [f64; N],
    h: f64,
}

impl<M: Motion<N>, const N: usize> RungeKutta<M, N> {
    /// From y with steps of h.
    pub fn new(h: f64, motion: M, y: [f64; N]) -> Self {
        Self { motion: black_box(motion), y, h }
    }
}

impl<M: Motion<N>, const N: usize> Kernel for RungeKutta<M, N> {
    #[inline]
    fn step(&mut self) {
        let (h, y) = (self.h, self.y);
        let along = |k: &[f64; N], s: f64| std::array::from_fn(|i| y[i] + s * k[i]);
        let a = self.motion.rate(&y);
        let b = self.motion.rate(&along(&a, h / 2.0));
        let c = self.motion.rate(&along(&b, h / 2.0));
        let d = self.motion.rate(&along(&c, h));
        self.y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
    }

    fn configuration(&self) -> Vec<f64> {
        M::configuration(&self.y)
    }

    fn energy(&self) -> f64 {
        self.motion.energy(&self.y)
    }

    fn defect(&self) -> f64 {
        M::defect(&self.y)
    }
}

/// Quaternion and body momentum, inertia diagonal.
#[derive(Copy, Clone)]
pub struct Turning {
    /// Principal moments.
    pub inertia: [f64; 3],
    /// m·g times the centre of mass.
    pub moment: [f64; 3],
}

impl Turning {
    fn zenith(y: &[f64; 7]) -> [f64; 3] {
        let r = rotation([y[0], y[1], y[2], y[3]]);
        [r[6], r[7], r[8]]
    }
}

impl Motion<7> for Turning {
    #[inline]
    fn rate(&self, y: &[f64; 7]) -> [f64; 7] {
        let [w, x, y, z, p, q, r] = *y;
        let (a, b, c) = (p / self.inertia[0], q / self.inertia[1], r / self.inertia[2]);
        let ([u, v, s], [k, l, m]) =
            ([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)], self.moment);
        [
            -0.5 * (x * a + y * b + z * c),
            0.5 * (w * a + y * c - z * b),
            0.5 * (w * b + z * a - x * c),
            0.5 * (w * c + x * b - y * a),
            q * c - r * b + (v * m - s * l),
            r * a - p * c + (s * k - u * m),
            p * b - q * a + (u * l - v * k),
        ]
    }

    fn configuration(y: &[f64; 7]) -> Vec<f64> {
        rotation([y[0], y[1], y[2], y[3]]).to_vec()
    }

    fn energy(&self, y: &[f64; 7]) -> f64 {
        let potential: f64 = Self::zenith(y).iter().zip(self.moment).map(|(z, m)| z * m).sum();
        potential + y[4..].iter().zip(self.inertia).map(|(p, j)| p * p / (2.0 * j)).sum::<f64>()
    }

    fn defect(y: &[f64; 7]) -> f64 {
        (y[..4].iter().map(|x| x * x).sum::<f64>() - 1.0).abs()
    }
}

/// q̇ = N × q, Ṅ = −q × g e3
#[derive(Copy, Clone)]
pub struct Swinging {
    /// g
    pub gravity: f64,
}

impl Motion<6> for Swinging {
    #[inline]
    fn rate(&self, &[x, y, z, a, b, c]: &[f64; 6]) -> [f64; 6] {
        [b * z - c * y, c * x - a * z, a * y - b * x, -self.gravity * y, self.gravity * x, 0.0]
    }

    fn configuration(y: &[f64; 6]) -> Vec<f64> {
        y[..3].to_vec()
    }

    fn energy(&self, y: &[f64; 6]) -> f64 {
        y[3..].iter().map(|n| n * n / 2.0).sum::<f64>() + self.gravity * y[2]
    }

    fn defect(y: &[f64; 6]) -> f64 {
        (y[..3].iter().map(|x| x * x).sum::<f64>() - 1.0).abs()
    }
}

/// Ṙ = RΩ, Ṁ = [M, Ω], M = ΩJ_d + J_dΩ: attitude by rows, then M above the diagonal.
#[derive(Copy, Clone)]
pub struct Turning4 {
    /// J_d
    pub j_d: [f64; 4],
}

/// Row and column of the components of M.
const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

impl Motion<22> for Turning4 {
    #[inline]
    fn rate(&self, y: &[f64; 22]) -> [f64; 22] {
        let (mut velocity, mut momentum) = ([0.0; 16], [0.0; 16]);
        for (k, (i, j)) in PLANES.into_iter().enumerate() {
            let (m, w) = (y[16 + k], y[16 + k] / (self.j_d[i] + self.j_d[j]));
            (momentum[4 * i + j], momentum[4 * j + i]) = (m, -m);
            (velocity[4 * i + j], velocity[4 * j + i]) = (w, -w);
        }
        let product = |a: &[f64], i: usize, j: usize| -> f64 {
            a[4 * i] * velocity[j]
                + a[4 * i + 1] * velocity[4 + j]
                + a[4 * i + 2] * velocity[8 + j]
                + a[4 * i + 3] * velocity[12 + j]
        };
        std::array::from_fn(|k| match k.checked_sub(16) {
            None => product(y, k / 4, k % 4),
            Some(k) => product(&momentum, PLANES[k].0, PLANES[k].1) - product(&momentum, PLANES[k].1, PLANES[k].0),
        })
    }

    fn configuration(y: &[f64; 22]) -> Vec<f64> {
        y[..16].to_vec()
    }

    fn energy(&self, y: &[f64; 22]) -> f64 {
        let energy = |(m, (i, j)): (&f64, (usize, usize))| m * m / (2.0 * (self.j_d[i] + self.j_d[j]));
        y[16..].iter().zip(PLANES).map(energy).sum()
    }

    fn defect(y: &[f64; 22]) -> f64 {
        let gram = |i: usize, j: usize| (0..4).map(|k| y[4 * k + i] * y[4 * k + j]).sum::<f64>();
        let entry = |k: usize| (gram(k / 4, k % 4) - f64::from(u8::from(k / 4 == k % 4))).abs();
        (0..16).map(entry).fold(0.0, f64::max)
    }
}
