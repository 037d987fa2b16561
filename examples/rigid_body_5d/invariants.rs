//! The conserved quantities of the free body on SO(5).

use nalgebra::Matrix5;

/// The planes of rotation, in the order of the columns: row and column of each entry above the diagonal, from 0.
pub const PLANES: [(usize, usize); 10] =
    [(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (1, 3), (1, 4), (2, 3), (2, 4), (3, 4)];

/// Names of [`integrals`], the same order.
pub const NAMES: [&str; 6] = [
    "Σ m_ij² is constant (Casimir)",
    "Σ m_ij² (d_k + d_l + d_n) is constant",
    "Σ m_ij² (d_k d_l + d_l d_n + d_n d_k) is constant",
    "Σ m_ij² d_k d_l d_n is constant",
    "Σ P_k² is constant (Casimir)",
    "Σ P_k² d_k is constant",
];

/// The skew matrix with these entries above the diagonal.
pub fn skew(entries: &[f64; 10]) -> Matrix5<f64> {
    let mut matrix = Matrix5::zeros();
    for ((i, j), entry) in PLANES.into_iter().zip(entries) {
        matrix[(i, j)] = *entry;
        matrix[(j, i)] = -entry;
    }
    matrix
}

/// Manakov's integrals: the coefficients of det(z + M + s D), D = J_d², that are not constant by themselves.
///
/// The step factors I + λ h M − λ² D into (F − λ J_d)(Fᵀ + λ J_d) and multiplies in the other order, a similarity. So
/// every coefficient of det(z + λ h M − λ² D) in z and λ is conserved. With them the integrals of the continuous body
/// are conserved, one by one. For M + s D, skew plus diagonal, that determinant is a sum over the sets of planes that
/// do not meet.
/// ```text
/// Π (z + s d_k) + Σ_ij m_ij² Π_{k ≠ i,j} (z + s d_k) + Σ_k P_k² (z + s d_k)
/// ```
/// P_k is the Pfaffian of M without its row and column k. Source: Manakov (1976); Moser and Veselov (1991), §1.4.
pub fn integrals(m: &Matrix5<f64>, j_d: &[f64; 5]) -> [f64; 6] {
    let d = j_d.map(|entry| entry * entry);
    let mut sums = [0.0; 6];
    for plane in PLANES {
        let square = m[plane].powi(2);
        let [a, b, c] = others(plane).map(|k| d[k]);
        for (sum, weight) in sums.iter_mut().zip([1.0, a + b + c, a * b + b * c + c * a, a * b * c]) {
            *sum += square * weight;
        }
    }
    for (k, weight) in d.into_iter().enumerate() {
        let square = pfaffian(m, k).powi(2);
        sums[4] += square;
        sums[5] += square * weight;
    }
    sums
}

/// By how much relative errors of size one in M move the [`integrals`].
///
/// Σ w m² moves by 2 max|w| Σ m² at most. Σ P_k² is (ab)² for rates a, b with a² + b² = Σ m². It is at most (Σ m²)²/4,
/// and of the fourth degree.
pub fn scales(m: &Matrix5<f64>, j_d: &[f64; 5]) -> [f64; 6] {
    let d = j_d.map(|entry| entry * entry);
    let largest = |weight: fn([f64; 3]) -> f64| {
        PLANES.map(|plane| weight(others(plane).map(|k| d[k]))).into_iter().fold(0.0, f64::max)
    };
    let square = m.norm_squared() / 2.0;
    let (quadratic, quartic) = (2.0 * square, square * square);
    [
        quadratic,
        quadratic * largest(|[a, b, c]| a + b + c),
        quadratic * largest(|[a, b, c]| a * b + b * c + c * a),
        quadratic * largest(|[a, b, c]| a * b * c),
        quartic,
        quartic * d.into_iter().fold(0.0, f64::max),
    ]
}

/// The axes that are not in the plane.
fn others((i, j): (usize, usize)) -> [usize; 3] {
    let mut rest = (0..5).filter(|&k| k != i && k != j);
    std::array::from_fn(|_| rest.next().unwrap_or(0))
}

/// The Pfaffian of M without row and column k.
fn pfaffian(m: &Matrix5<f64>, k: usize) -> f64 {
    let mut rest = (0..5).filter(|&axis| axis != k);
    let [a, b, c, d] = std::array::from_fn(|_| rest.next().unwrap_or(0));
    m[(a, b)] * m[(c, d)] - m[(a, c)] * m[(b, d)] + m[(a, d)] * m[(b, c)]
}

/// tr Aᵏ for k = 1, 2, 3, 4, with A = F J_d. The eigenvalues of A are roots of det(λ² − λ h M − J_d²), the same at
/// every step. The fifth function of them, det A = det J_d, is constant in any case.
pub fn traces(f: &Matrix5<f64>, j_d: &[f64; 5]) -> [f64; 4] {
    let a = f * Matrix5::from_diagonal(&(*j_d).into());
    let square = a * a;
    [a.trace(), square.trace(), (square * a).trace(), (square * square).trace()]
}
