//! The conserved quantities of the generalised rigid body.

use nalgebra::Matrix4;

/// The planes of rotation, in the order of the columns: row and column of each entry above the diagonal, from 0.
pub const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
/// The plane that is perpendicular to each of [`PLANES`].
const PERPENDICULAR: [(usize, usize); 6] = [(2, 3), (1, 3), (1, 2), (0, 3), (0, 2), (0, 1)];

/// The skew matrix with these entries above the diagonal.
pub fn skew(entries: &[f64; 6]) -> Matrix4<f64> {
    let mut matrix = Matrix4::zeros();
    for ((i, j), entry) in PLANES.into_iter().zip(entries) {
        matrix[(i, j)] = *entry;
        matrix[(j, i)] = -entry;
    }
    matrix
}

/// Functions of the body momentum M that every step conserves exactly.
///
/// The eigenvalues of F J_d are constant, and they are roots of det(λ² − λ h M − J_d²). So the coefficients of this
/// polynomial in λ are constant too. With m_ij the entries of M, (k, l) the plane perpendicular to (i, j) and d = J_d²:
#[derive(Clone, Copy, Debug)]
pub struct Invariants {
    /// |M|² = Σ m_ij² over i < j: constant on coadjoint orbits.
    pub square: f64,
    /// Pf M = m_12 m_34 − m_13 m_24 + m_14 m_23: constant on coadjoint orbits.
    pub pfaffian: f64,
    /// Manakov's Σ m_ij² (d_k + d_l).
    pub manakov_sum: f64,
    /// Manakov's Σ m_ij² d_k d_l.
    pub manakov_product: f64,
}

impl Invariants {
    /// Of a momentum, for this diagonal of J_d.
    pub fn new(m: &Matrix4<f64>, j_d: &[f64; 4]) -> Self {
        let d = j_d.map(|entry| entry * entry);
        let over_planes = |weight: fn(f64, f64) -> f64| {
            let pairs = PLANES.into_iter().zip(PERPENDICULAR);
            pairs.map(|(plane, (k, l))| m[plane].powi(2) * weight(d[k], d[l])).sum::<f64>()
        };
        Self {
            square: over_planes(|_, _| 1.0),
            pfaffian: m[(0, 1)] * m[(2, 3)] - m[(0, 2)] * m[(1, 3)] + m[(0, 3)] * m[(1, 2)],
            manakov_sum: over_planes(|a, b| a + b),
            manakov_product: over_planes(|a, b| a * b),
        }
    }
}

/// The two halves of so(4) = so(3) ⊕ so(3): the self-dual and the anti-self-dual part of M. Each has constant length.
pub fn halves(m: &Matrix4<f64>) -> [[f64; 3]; 2] {
    let half = |sign: f64| {
        [
            (m[(0, 1)] + sign * m[(2, 3)]) / 2.0,
            (m[(0, 2)] - sign * m[(1, 3)]) / 2.0,
            (m[(0, 3)] + sign * m[(1, 2)]) / 2.0,
        ]
    };
    [half(1.0), half(-1.0)]
}
