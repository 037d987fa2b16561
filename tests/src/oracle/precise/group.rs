//! Matrix groups, given by the basis of the algebra in which momenta have their components.
//!
//! Every element is a square matrix, translations and quaternions too. A translation a ∈ Rⁿ is (I a; 0 1), so
//! [`Matrix::translation`] is the vector. A unit quaternion is the 4×4 matrix of multiplication by it from the left on
//! (i, j, k, 1). So its last column is the quaternion. Signs, order and scale of the bases are those that the macro
//! documents.

use super::matrix::Matrix;
use super::real::Real;

/// A connected matrix group.
#[derive(Clone, Debug)]
pub struct Group {
    /// The basis E_i of its algebra.
    pub basis: Vec<Matrix<f64>>,
}

impl Group {
    /// The number of rows of an element.
    pub fn size(&self) -> usize {
        self.basis[0].shape().0
    }

    /// Σ x_i E_i.
    pub fn combination<R: Real>(&self, x: &[R]) -> Matrix<R> {
        let n = self.size();
        Matrix::from_fn(n, n, |i, j| {
            self.basis
                .iter()
                .zip(x)
                .fold(R::zero(), |sum, (e, &x)| if e[(i, j)] == 0.0 { sum } else { sum + x * e[(i, j)] })
        })
    }
}

/// A group with any basis: declared by one, or by an equation and solved by hand.
pub fn group(basis: Vec<Matrix<f64>>) -> Group {
    Group { basis }
}

/// SO(n): rotations; for n = 3 the hat matrices of the axes, else E_ji − E_ij, i < j.
pub fn so(n: usize) -> Group {
    match n {
        3 => group(vec![
            sparse(3, &[(2, 1, 1), (1, 2, -1)]),
            sparse(3, &[(0, 2, 1), (2, 0, -1)]),
            sparse(3, &[(1, 0, 1), (0, 1, -1)]),
        ]),
        _ => pseudo_so(n, 0),
    }
}

/// SO(p, q), η = diag(1 …, −1 …): E_ji − η_iη_j E_ij, i < j.
pub fn pseudo_so(p: usize, q: usize) -> Group {
    let n = p + q;
    let sign = |i, j| if (i < p) == (j < p) { -1 } else { 1 };
    group(pairs(n).map(|(i, j)| sparse(n, &[(j, i, 1), (i, j, sign(i, j))])).collect())
}

/// SE(n): SO(n), then translations.
pub fn se(n: usize) -> Group {
    group(bordered(so(n)).chain(translation(n).basis).collect())
}

/// Sim(n): SO(n), the dilation diag(I, 0), translations.
pub fn sim(n: usize) -> Group {
    let dilation = Matrix::from_fn(n + 1, n + 1, |i, j| if i == j && i < n { 1.0 } else { 0.0 });
    group(bordered(so(n)).chain([dilation]).chain(translation(n).basis).collect())
}

/// Rⁿ as matrices (I a; 0 1).
pub fn translation(n: usize) -> Group {
    group((0..n).map(|i| sparse(n + 1, &[(i, n, 1)])).collect())
}

/// GL(n), matrices of positive determinant: E_ij by rows.
pub fn gl(n: usize) -> Group {
    group((0..n * n).map(|k| sparse(n, &[(k / n, k % n, 1)])).collect())
}

/// Aff(n): GL(n), then translations.
pub fn aff(n: usize) -> Group {
    group(bordered(gl(n)).chain(translation(n).basis).collect())
}

/// SL(n): E_ii − E_{i+1,i+1}, then E_ij, i ≠ j, by rows.
pub fn sl(n: usize) -> Group {
    let diagonal = (0..n - 1).map(|i| sparse(n, &[(i, i, 1), (i + 1, i + 1, -1)]));
    let others = (0..n * n).filter(|k| k / n != k % n).map(|k| sparse(n, &[(k / n, k % n, 1)]));
    group(diagonal.chain(others).collect())
}

/// Sp(2n) for Ω = (0 I; −I 0): E_ij − E_{n+j,n+i} by rows, E_{i,n+j} + E_{j,n+i}, j ≤ i, and their transposes.
pub fn sp(two_n: usize) -> Group {
    let n = two_n / 2;
    let square = (0..n * n).map(|k| sparse(two_n, &[(k / n, k % n, 1), (n + k % n, n + k / n, -1)]));
    let upper = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let upper: Vec<_> = upper
        .map(
            |(i, j)| {
                if i == j { sparse(two_n, &[(i, n + i, 1)]) } else { sparse(two_n, &[(i, n + j, 1), (j, n + i, 1)]) }
            },
        )
        .collect();
    let lower: Vec<_> = upper.iter().map(Matrix::transpose).collect();
    group(square.chain(upper).chain(lower).collect())
}

/// U(n) as (A −B; B A): A = E_ji − E_ij, then B = E_ji + E_ij, i < j, then B = E_ii.
pub fn u(n: usize) -> Group {
    let phases = (0..n).map(|i| imaginary(n, &[(i, i, 1)]));
    group(special_unitary_off_diagonal(n).chain(phases).collect())
}

/// SU(n): the same with B = E_ii − E_{i+1,i+1}.
pub fn su(n: usize) -> Group {
    let phases = (0..n - 1).map(|i| imaginary(n, &[(i, i, 1), (i + 1, i + 1, -1)]));
    group(special_unitary_off_diagonal(n).chain(phases).collect())
}

/// SU(2) as unit quaternions: i/2, j/2, k/2 multiply from the left.
pub fn unit_quaternions() -> Group {
    let (i, j, k, w) = (0, 1, 2, 3);
    let units = [(i, j, k), (j, k, i), (k, i, j)];
    let half = |m: Matrix<f64>| m * 0.5;
    group(units.map(|(a, b, c)| half(sparse(4, &[(a, w, 1), (w, a, -1), (c, b, 1), (b, c, -1)]))).to_vec())
}

/// The Heisenberg group of n + 2 rows: E_{1,1+i}; E_{1+i,n+2}; E_{1,n+2}.
pub fn heisenberg(n: usize) -> Group {
    let entries = (1..=n).map(|i| (0, i)).chain((1..=n).map(|i| (i, n + 1))).chain([(0, n + 1)]);
    group(entries.map(|(i, j)| sparse(n + 2, &[(i, j, 1)])).collect())
}

fn sparse(n: usize, entries: &[(usize, usize, i8)]) -> Matrix<f64> {
    let entry = |i, j| entries.iter().find(|e| (e.0, e.1) == (i, j)).map_or(0.0, |e| f64::from(e.2));
    Matrix::from_fn(n, n, entry)
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// The basis with a row and a column of zeros added.
fn bordered(group: Group) -> impl Iterator<Item = Matrix<f64>> {
    let n = group.size();
    group
        .basis
        .into_iter()
        .map(move |e| Matrix::from_fn(n + 1, n + 1, |i, j| if i < n && j < n { e[(i, j)] } else { 0.0 }))
}

/// A + iB as (A −B; B A).
fn complex(a: &Matrix<f64>, b: &Matrix<f64>) -> Matrix<f64> {
    let n = a.shape().0;
    Matrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)],
        (false, false) => a[(i - n, j - n)],
        (true, false) => -b[(i, j - n)],
        (false, true) => b[(i - n, j)],
    })
}

fn imaginary(n: usize, b: &[(usize, usize, i8)]) -> Matrix<f64> {
    complex(&sparse(n, &[]), &sparse(n, b))
}

fn special_unitary_off_diagonal(n: usize) -> impl Iterator<Item = Matrix<f64>> {
    let real = pairs(n).map(move |(i, j)| complex(&sparse(n, &[(j, i, 1), (i, j, -1)]), &sparse(n, &[])));
    real.chain(pairs(n).map(move |(i, j)| imaginary(n, &[(j, i, 1), (i, j, 1)])))
}
