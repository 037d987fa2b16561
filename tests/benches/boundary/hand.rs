//! The same extremals by hand: Newton's method on unit quaternions, for one body only. Someone would write it who knows
//! the formulas and needs neither a damped search nor an index.
//!
//! With F = (w, v) the cost is 2vᵀJv/h. With Z = tr(FM) I − FM its second derivatives along both ends are the symmetric
//! parts of Z and of FᵀZF. Between the ends it is −ZF. All are over h. As F is its own matrix of cofactors, ZF is
//! linear in F. Everything below is multiplied by h.

/// A rigid body with the mass matrix diag(mass) in the potential weight·e₃·Re₃.
#[derive(Clone, Copy)]
pub struct Body {
    /// Step size, s.
    pub h: f64,
    /// Diagonal of the mass matrix.
    pub mass: [f64; 3],
    /// Multiplies the height.
    pub weight: f64,
}

/// A vertex, with the data that the backward sweep stores for the forward one.
#[derive(Clone, Copy)]
pub struct Vertex {
    attitude: [f64; 4],
    gain: [[f64; 3]; 3],
    shift: [f64; 3],
}

/// The result.
#[derive(Clone, Copy, Debug)]
pub struct Solution {
    /// Σ ℓd
    pub action: f64,
    /// The largest component of a residual.
    pub residual: f64,
    /// Linearisations.
    pub iterations: u32,
}

/// The symmetric matrix [[a, ., .], [d, b, .], [e, f, c]].
type Symmetric = [f64; 6];

/// The share of an edge in the equations of the vertices at its ends.
struct Edge {
    kinetic: f64,
    before: [f64; 3],
    after: [f64; 3],
    start: Symmetric,
    end: Symmetric,
    /// ZF
    coupling: [[f64; 3]; 3],
}

impl Body {
    /// From the identity through rotations about one axis to `vector`, the half of whose length is that of a quarter turn at most.
    pub fn geodesic(vector: [f64; 3], path: &mut [Vertex]) {
        let angle = dot(vector, vector).sqrt();
        let edges = (path.len() - 1) as f64;
        for (k, vertex) in path.iter_mut().enumerate() {
            let half = angle / 2.0 * (k as f64 / edges);
            let s = half.sin() / angle;
            let [x, y, z] = vector;
            vertex.attitude = [half.cos(), s * x, s * y, s * z];
        }
    }

    /// Newton's method until the residual is below `tolerance`.
    pub fn solve(&self, path: &mut [Vertex], tolerance: f64) -> Solution {
        for iterations in 1.. {
            let (action, residual) = self.eliminate(path);
            if residual <= tolerance || iterations == 30 {
                return Solution { action, residual, iterations };
            }
            correct(path);
        }
        unreachable!()
    }

    /// The backward sweep. Returns action and residual.
    #[inline]
    fn eliminate(&self, path: &mut [Vertex]) -> (f64, f64) {
        let (h, weight) = (self.h, self.weight);
        let last = path.len() - 1;
        let mut later = self.edge(&path[last - 1].attitude, &path[last].attitude);
        let (mut kinetic, mut residual) = (later.kinetic, 0.0_f64);
        let ends = zenith(&path[last].attitude)[2] + zenith(&path[0].attitude)[2];
        let mut potential = ends / 2.0;
        // the shares of later vertices, by elimination, in the pivot and the gradient
        let (mut pivot, mut gradient) = (later.start, later.before.map(|x| -x));
        for k in (1..last).rev() {
            let [x, y, z] = zenith(&path[k].attitude);
            potential += z;
            let edge = self.edge(&path[k - 1].attitude, &path[k].attitude);
            kinetic += edge.kinetic;
            let s = h * h * weight;
            let kick = [-s * y, s * x, 0.0];
            let kicked = [edge.after[0] - kick[0], edge.after[1] - kick[1], edge.after[2]];
            for (kicked, before) in kicked.iter().zip(&later.before) {
                residual = residual.max((kicked - before).abs());
            }
            let d = [
                pivot[0] + edge.end[0] + s * z,
                pivot[1] + edge.end[1] + s * z,
                pivot[2] + edge.end[2],
                pivot[3] + edge.end[3],
                pivot[4] + edge.end[4] - s * x / 2.0,
                pivot[5] + edge.end[5] - s * y / 2.0,
            ];
            let g = [gradient[0] + kicked[0], gradient[1] + kicked[1], gradient[2] + kicked[2]];
            let inverse = inverse(d);
            // K = −D⁻¹Cᵀ with the coupling C = ZF of the edge before
            let c = &edge.coupling;
            let gain: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| dot(inverse[i], c[j])));
            let shift = inverse.map(|row| dot(row, g));
            let product = |i: usize, j: usize| c[i][0] * gain[0][j] + c[i][1] * gain[1][j] + c[i][2] * gain[2][j];
            pivot = [
                edge.start[0] - product(0, 0),
                edge.start[1] - product(1, 1),
                edge.start[2] - product(2, 2),
                edge.start[3] - product(1, 0),
                edge.start[4] - product(2, 0),
                edge.start[5] - product(2, 1),
            ];
            gradient = std::array::from_fn(|i| dot(c[i], shift) - edge.before[i]);
            (path[k].gain, path[k].shift) = (gain, shift);
            later = edge;
        }
        (kinetic / h - h * weight * potential, residual / h)
    }

    #[inline]
    fn edge(&self, a: &[f64; 4], b: &[f64; 4]) -> Edge {
        let [m1, m2, m3] = self.mass;
        let [w, x, y, z] = [
            a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3],
            a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
            a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3],
            a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1],
        ];
        let (x2, y2, z2, w2) = (x + x, y + y, z + z, w + w);
        let (xx, yy, zz, xy, xz, yz) = (x2 * x, y2 * y, z2 * z, x2 * y, x2 * z, y2 * z);
        let (wx, wy, wz) = (w2 * x, w2 * y, w2 * z);
        let f = [
            [1.0 - (yy + zz), xy - wz, xz + wy],
            [xy + wz, 1.0 - (xx + zz), yz - wx],
            [xz - wy, yz + wx, 1.0 - (xx + yy)],
        ];
        let fm = f.map(|[a, b, c]| [a * m1, b * m2, c * m3]);
        let trace = fm[0][0] + fm[1][1] + fm[2][2];
        // 2(wJv ± Jv × v)
        let [j1, j2, j3] = [m2 + m3, m3 + m1, m1 + m2];
        let even = [j1 * wx, j2 * wy, j3 * wz];
        let odd = [(j2 - j3) * yz, (j3 - j1) * xz, (j1 - j2) * xy];
        let [s1, s2, s3] = [trace - fm[0][0], trace - fm[1][1], trace - fm[2][2]];
        let coupling = [
            [m2 * f[2][2] + m3 * f[1][1], -m3 * f[1][0], -m2 * f[2][0]],
            [-m3 * f[0][1], m1 * f[2][2] + m3 * f[0][0], -m1 * f[2][1]],
            [-m2 * f[0][2], -m1 * f[1][2], m1 * f[1][1] + m2 * f[0][0]],
        ];
        Edge {
            kinetic: j1 * xx + j2 * yy + j3 * zz,
            before: [even[0] - odd[0], even[1] - odd[1], even[2] - odd[2]],
            after: [even[0] + odd[0], even[1] + odd[1], even[2] + odd[2]],
            start: [s1, s2, s3, half(fm[1][0], fm[0][1]), half(fm[2][0], fm[0][2]), half(fm[2][1], fm[1][2])],
            end: [
                s1,
                s2,
                s3,
                half(m2 * f[1][0], m1 * f[0][1]),
                half(m3 * f[2][0], m1 * f[0][2]),
                half(m3 * f[2][1], m2 * f[1][2]),
            ],
            coupling,
        }
    }
}

/// The forward sweep.
#[inline]
fn correct(path: &mut [Vertex]) {
    let mut motion = [0.0; 3];
    let last = path.len() - 1;
    for vertex in &mut path[1..last] {
        let (gain, shift) = (&vertex.gain, &vertex.shift);
        motion = std::array::from_fn(|i| dot(gain[i], motion) - shift[i]);
        let [x, y, z] = motion.map(|x| 0.5 * x);
        let n = 1.0 / (1.0 + x * x + y * y + z * z).sqrt();
        let [a, b, c, d] = vertex.attitude.map(|x| n * x);
        vertex.attitude = [
            a - b * x - c * y - d * z,
            b + a * x + c * z - d * y,
            c + a * y - b * z + d * x,
            d + a * z + b * y - c * x,
        ];
    }
}

/// −½(a + b)
#[inline]
fn half(a: f64, b: f64) -> f64 {
    -0.5 * (a + b)
}

/// Rᵀe₃
#[inline]
fn zenith(&[w, x, y, z]: &[f64; 4]) -> [f64; 3] {
    [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]
}

#[inline]
fn inverse([a, b, c, d, e, f]: Symmetric) -> [[f64; 3]; 3] {
    let first = [b * c - f * f, e * f - d * c, d * f - b * e];
    let scale = 1.0 / (a * first[0] + d * first[1] + e * first[2]);
    let [p, q, r] = first.map(|x| scale * x);
    let (s, t, u) = (scale * (a * c - e * e), scale * (d * e - a * f), scale * (a * b - d * d));
    [[p, q, r], [q, s, t], [r, t, u]]
}

#[inline]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vertex at the identity.
pub const REST: Vertex = Vertex { attitude: [1.0, 0.0, 0.0, 0.0], gain: [[0.0; 3]; 3], shift: [0.0; 3] };
