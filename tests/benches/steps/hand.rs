//! The same schemes by hand, in plain Rust, as someone who knows the formulas would write them for one system.

use std::hint::black_box;

/// A map that is iterated.
pub trait Kernel: Copy {
    /// One step.
    fn step(&mut self);
    /// The configuration, in the order of the declared one's rows.
    fn configuration(&self) -> Vec<f64>;
    /// Kinetic and potential energy.
    fn energy(&self) -> f64;
    /// By how much the configuration violates its constraint.
    fn defect(&self) -> f64;
}

/// Rigid body with diagonal inertia in linear potential, as a unit quaternion. Newton's method finds the Gibbs vector c
/// of F: a(1 + |c|²) = Jc + c × Jc with a = hπ/2.
#[derive(Copy, Clone)]
pub struct Body {
    attitude: [f64; 4],
    a: [f64; 3],
    inertia: [f64; 3],
    /// J3 − J2, J1 − J3, J2 − J1
    differences: [f64; 3],
    /// m·g times the centre of mass; all zero for a free body.
    moment: [f64; 3],
    h: f64,
    /// h²/4 τ, which two steps share.
    kick: [f64; 3],
}

impl Body {
    /// At the given attitude and momentum.
    pub fn new(h: f64, inertia: [f64; 3], moment: [f64; 3], attitude: [f64; 4], momentum: [f64; 3]) -> Self {
        let [j1, j2, j3] = black_box(inertia);
        let differences = [j3 - j2, j1 - j3, j2 - j1];
        let (inertia, moment) = ([j1, j2, j3], black_box(moment));
        let mut body =
            Self { attitude, a: momentum.map(|m| h * m / 2.0), inertia, differences, moment, h, kick: [0.0; 3] };
        body.kick = body.torque().map(|t| h * h / 4.0 * t);
        body
    }

    /// Rᵀe3
    #[inline]
    fn zenith(&self) -> [f64; 3] {
        let [w, x, y, z] = self.attitude;
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]
    }

    #[inline]
    fn torque(&self) -> [f64; 3] {
        cross(self.zenith(), self.moment)
    }

    #[inline]
    fn newton(&self) -> [f64; 3] {
        let ([j1, j2, j3], [k1, k2, k3], m) = (self.inertia, self.differences, self.a);
        let [mut x, mut y, mut z] = [m[0] / j1, m[1] / j2, m[2] / j3];
        for _ in 0..30 {
            let n = 1.0 + x * x + y * y + z * z;
            let g = [j1 * x + k1 * y * z - m[0] * n, j2 * y + k2 * z * x - m[1] * n, j3 * z + k3 * x * y - m[2] * n];
            let (u, v, w) = (m.map(|m| 2.0 * m * x), m.map(|m| 2.0 * m * y), m.map(|m| 2.0 * m * z));
            let columns = [
                [j1 - u[0], k2 * z - u[1], k3 * y - u[2]],
                [k1 * z - v[0], j2 - v[1], k3 * x - v[2]],
                [k1 * y - w[0], k2 * x - w[1], j3 - w[2]],
            ];
            let first = cross(columns[1], columns[2]);
            let scale = 1.0 / dot(columns[0], first);
            let (second, third) = (cross(columns[2], columns[0]), cross(columns[0], columns[1]));
            let d = [scale * dot(first, g), scale * dot(second, g), scale * dot(third, g)];
            (x, y, z) = (x - d[0], y - d[1], z - d[2]);
            if dot(d, d) <= 1e-18 * (x * x + y * y + z * z) {
                break;
            }
        }
        [x, y, z]
    }
}

impl Kernel for Body {
    #[inline]
    fn step(&mut self) {
        let is_free = self.moment == [0.0; 3];
        if !is_free {
            self.a = sum(self.a, self.kick);
        }
        let [x, y, z] = self.newton();
        let p = 1.0 / (1.0 + x * x + y * y + z * z);
        let ([k1, k2, k3], t) = (self.differences, 2.0 * p);
        self.a = sum(self.a, [-t * (k1 * y * z), -t * (k2 * z * x), -t * (k3 * x * y)]);
        let (s, [a, b, c, d]) = (p.sqrt(), self.attitude);
        let (w, x, y, z) = (s, s * x, s * y, s * z);
        self.attitude = [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ];
        if !is_free {
            let quarter = self.h * self.h / 4.0;
            self.kick = self.torque().map(|t| quarter * t);
            self.a = sum(self.a, self.kick);
        }
    }

    fn configuration(&self) -> Vec<f64> {
        rotation(self.attitude).to_vec()
    }

    fn energy(&self) -> f64 {
        let kinetic: f64 = self.a.iter().zip(self.inertia).map(|(a, j)| (2.0 * a / self.h).powi(2) / (2.0 * j)).sum();
        kinetic + dot(self.zenith(), self.moment)
    }

    fn defect(&self) -> f64 {
        (self.attitude.iter().map(|x| x * x).sum::<f64>() - 1.0).abs()
    }
}

/// Spherical pendulum of unit mass and length: q⁺ = √(1 − |n|²) q + n × q with n = hN.
#[derive(Copy, Clone)]
pub struct Pendulum {
    q: [f64; 3],
    n: [f64; 3],
    h: f64,
    gravity: f64,
    /// h²g/2
    weight: f64,
}

impl Pendulum {
    /// At the given position and momentum.
    pub fn new(h: f64, gravity: f64, q: [f64; 3], momentum: [f64; 3]) -> Self {
        let (h, gravity) = (black_box(h), black_box(gravity));
        Self { q, n: momentum.map(|m| h * m), h, gravity, weight: h * h * gravity / 2.0 }
    }
}

impl Kernel for Pendulum {
    #[inline]
    fn step(&mut self) {
        let kick = |n: [f64; 3], q: [f64; 3]| [n[0] - self.weight * q[1], n[1] + self.weight * q[0], n[2]];
        let n = kick(self.n, self.q);
        let (c, turn) = ((1.0 - dot(n, n)).sqrt(), cross(n, self.q));
        self.q = [c * self.q[0] + turn[0], c * self.q[1] + turn[1], c * self.q[2] + turn[2]];
        self.n = kick(n, self.q);
    }

    fn configuration(&self) -> Vec<f64> {
        self.q.to_vec()
    }

    fn energy(&self) -> f64 {
        dot(self.n, self.n) / (2.0 * self.h * self.h) + self.gravity * self.q[2]
    }

    fn defect(&self) -> f64 {
        (dot(self.q, self.q) - 1.0).abs()
    }
}

/// w, x, y, z to the rotation matrix by rows.
pub fn rotation([w, x, y, z]: [f64; 4]) -> [f64; 9] {
    let s = 2.0 / (w * w + x * x + y * y + z * z);
    [
        1.0 - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        1.0 - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        1.0 - s * (x * x + y * y),
    ]
}

#[inline]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
