//! Random elements from a seed, the same on every machine.

use nalgebra::{SMatrix, SVector};

use super::rotation::cayley;

/// The generator SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(u64);

impl Random {
    /// The sequence that belongs to `seed`.
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// A number in [−1, 1).
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A number between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.number() + 1.0) / 2.0
    }

    /// A matrix with entries in [−1, 1).
    pub fn matrix<const R: usize, const C: usize>(&mut self) -> SMatrix<f64, R, C> {
        SMatrix::from_fn(|_, _| self.number())
    }

    /// A vector with entries in [−1, 1).
    pub fn vector<const N: usize>(&mut self) -> SVector<f64, N> {
        self.matrix()
    }

    /// A vector of unit length.
    pub fn unit<const N: usize>(&mut self) -> SVector<f64, N> {
        loop {
            let vector: SVector<f64, N> = self.vector();
            if vector.norm() > 0.1 {
                return vector.normalize();
            }
        }
    }

    /// A symmetric matrix with eigenvalues near 1: definite, and for N = 3 a possible ½tr(J)I − J.
    pub fn inertia<const N: usize>(&mut self) -> SMatrix<f64, N, N> {
        let matrix: SMatrix<f64, N, N> = self.matrix();
        SMatrix::identity() + (matrix + matrix.transpose()) * (0.25 / N as f64)
    }

    /// A rotation by angles up to about `size` in each plane.
    pub fn rotation<const N: usize>(&mut self, size: f64) -> SMatrix<f64, N, N> {
        let matrix: SMatrix<f64, N, N> = self.matrix();
        cayley(&((matrix - matrix.transpose()) * (size / 4.0)))
    }

    /// A rotation far from the identity: the product of three.
    pub fn attitude<const N: usize>(&mut self) -> SMatrix<f64, N, N> {
        self.rotation::<N>(3.0) * self.rotation::<N>(3.0) * self.rotation::<N>(3.0)
    }
}
