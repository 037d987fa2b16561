//! The Moser–Veselov body on SO(4) by hand, with a fixed point for the symmetric part of F J_d.

use crate::hand::Kernel;
use std::hint::black_box;

type Matrix = [[f64; 4]; 4];

/// F J_d = J_d + D + A with A = hM/2 and D symmetric: D_ij (d_i + d_j) = (A² − D² − [J_d + D, A])_ij, iterated from D = 0.
#[derive(Copy, Clone)]
pub struct Body4 {
    attitude: Matrix,
    a: Matrix,
    j_d: [f64; 4],
    /// 1/(d_i + d_j)
    inverse: Matrix,
    h: f64,
}

impl Body4 {
    /// At the identity, M above the diagonal by rows.
    pub fn new(h: f64, j_d: [f64; 4], momentum: [f64; 6]) -> Self {
        let (h, d) = (black_box(h), black_box(j_d));
        let mut a = [[0.0; 4]; 4];
        for (m, (i, j)) in momentum.into_iter().zip([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]) {
            (a[i][j], a[j][i]) = (h * m / 2.0, -h * m / 2.0);
        }
        let attitude = entries(|i, j| f64::from(u8::from(i == j)));
        Self { attitude, a, j_d: d, inverse: entries(|i, j| 1.0 / (d[i] + d[j])), h }
    }
}

impl Kernel for Body4 {
    #[inline]
    fn step(&mut self) {
        let (a, d) = (self.a, self.j_d);
        let squared = product(a, a);
        let fixed: Matrix = entries(|i, j| squared[i][j] - (d[i] - d[j]) * a[i][j]);
        let mut symmetric: Matrix = entries(|i, j| self.inverse[i][j] * fixed[i][j]);
        for _ in 0..60 {
            let (mixed, square) = (product(symmetric, a), product(symmetric, symmetric));
            let next: Matrix =
                entries(|i, j| self.inverse[i][j] * (fixed[i][j] - square[i][j] - mixed[i][j] - mixed[j][i]));
            let change = next.iter().flatten().zip(symmetric.iter().flatten()).map(|(x, y)| (x - y).abs());
            let change = change.fold(0.0, f64::max);
            symmetric = next;
            if change < 1e-15 {
                break;
            }
        }
        let x: Matrix = entries(|i, j| symmetric[i][j] + a[i][j] + if i == j { d[i] } else { 0.0 });
        let moved = product(self.attitude, x);
        self.attitude = entries(|i, j| moved[i][j] * (1.0 / d[j]));
        self.a = entries(|i, j| 0.5 * (d[i] / d[j] * x[i][j] - d[j] / d[i] * x[j][i]));
    }

    fn configuration(&self) -> Vec<f64> {
        self.attitude.concat()
    }

    fn energy(&self) -> f64 {
        (0..16).map(|k| (k / 4, k % 4)).map(|(i, j)| (self.a[i][j] / self.h).powi(2) * self.inverse[i][j]).sum()
    }

    fn defect(&self) -> f64 {
        let r = self.attitude;
        let gram: Matrix = entries(|i, j| (0..4).map(|k| r[k][i] * r[k][j]).sum::<f64>() - f64::from(u8::from(i == j)));
        gram.iter().flatten().fold(0.0, |largest, x| largest.max(x.abs()))
    }
}

#[inline]
fn entries(entry: impl Fn(usize, usize) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

#[inline]
fn product(a: Matrix, b: Matrix) -> Matrix {
    entries(|i, j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j])
}
