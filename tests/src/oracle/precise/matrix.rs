//! Matrices and vectors of any size over any number.

use nalgebra::SMatrix;
use std::ops::{Add, Index, IndexMut, Mul, Neg, Range, Sub};

use super::real::Real;

/// A matrix; vectors are columns, scalars are 1×1.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix<R> {
    rows: usize,
    columns: usize,
    entries: Vec<R>,
}

impl<R> Matrix<R> {
    /// The number of rows and of columns.
    pub fn shape(&self) -> (usize, usize) {
        (self.rows, self.columns)
    }

    /// The entries, row by row.
    pub fn entries(&self) -> &[R] {
        &self.entries
    }
}

impl<R: Copy> Matrix<R> {
    /// The matrix of the entries f(i, j).
    pub fn from_fn(rows: usize, columns: usize, mut f: impl FnMut(usize, usize) -> R) -> Self {
        let entries = (0..rows * columns).map(|k| f(k / columns, k % columns)).collect();
        Matrix { rows, columns, entries }
    }

    /// The matrix of these entries, row by row.
    pub fn of(rows: usize, columns: usize, entries: &[R]) -> Self {
        Matrix::from_fn(rows, columns, |i, j| entries[i * columns + j])
    }

    /// A column.
    pub fn vector(entries: &[R]) -> Self {
        Matrix::of(entries.len(), 1, entries)
    }

    /// f of each entry.
    pub fn map<S>(&self, f: impl Fn(R) -> S) -> Matrix<S> {
        Matrix { rows: self.rows, columns: self.columns, entries: self.entries.iter().map(|&entry| f(entry)).collect() }
    }

    /// Aᵀ.
    pub fn transpose(&self) -> Self {
        Matrix::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }

    /// The block of these rows and columns.
    pub fn block(&self, rows: Range<usize>, columns: Range<usize>) -> Self {
        Matrix::from_fn(rows.len(), columns.len(), |i, j| self[(rows.start + i, columns.start + j)])
    }

    /// The upper left block of an element of SE(n), Sim(n), Aff(n), n + 1 rows.
    pub fn linear_part(&self) -> Self {
        self.block(0..self.rows - 1, 0..self.rows - 1)
    }

    /// The last column, without its last entry, of an element of SE(n), Sim(n), Aff(n), Rⁿ, n + 1 rows.
    pub fn translation(&self) -> Self {
        self.block(0..self.rows - 1, self.rows - 1..self.rows)
    }
}

impl<R: Real> Matrix<R> {
    /// I.
    pub fn identity(n: usize) -> Self {
        Matrix::from_fn(n, n, |i, j| if i == j { R::one() } else { R::zero() })
    }

    /// tr A.
    pub fn trace(&self) -> R {
        (0..self.rows).fold(R::zero(), |sum, i| sum + self[(i, i)])
    }

    /// ⟨A, B⟩ = tr(AᵀB).
    pub fn dot(&self, other: &Self) -> R {
        self.entries.iter().zip(&other.entries).fold(R::zero(), |sum, (&a, &b)| sum + a * b)
    }

    /// ⟨A, A⟩.
    pub fn norm_squared(&self) -> R {
        self.dot(self)
    }

    /// The largest size of an entry; NaN where one is.
    pub fn size(&self) -> f64 {
        self.entries
            .iter()
            .map(|entry| entry.size())
            .fold(0.0, |max, size| if size > max || size.is_nan() { size } else { max })
    }

    /// A⁻¹B by Gauss–Jordan elimination with row exchanges; not finite where A is singular.
    pub fn solve(&self, right: &Self) -> Self {
        let (mut a, mut b) = (self.clone(), right.clone());
        for k in 0..a.rows {
            let size = |i: &usize| a[(*i, k)].to_f64().abs();
            let pivot = (k..a.rows).max_by(|i, j| size(i).total_cmp(&size(j))).unwrap_or(k);
            a.exchange_rows(k, pivot);
            b.exchange_rows(k, pivot);
            let head = a[(k, k)];
            for i in (0..a.rows).filter(|&i| i != k) {
                let factor = a[(i, k)] / head;
                (k..a.columns).for_each(|j| a[(i, j)] = a[(i, j)] - factor * a[(k, j)]);
                (0..b.columns).for_each(|j| b[(i, j)] = b[(i, j)] - factor * b[(k, j)]);
            }
        }
        Matrix::from_fn(b.rows, b.columns, |i, j| b[(i, j)] / a[(i, i)])
    }

    /// A solution of A x = b where b is in the range of A, whose rank may be less than full. Unknowns whose pivots are
    /// below `least` times the largest entry are 0.
    pub fn solve_in_range(&self, right: &Self, least: f64) -> Self {
        let (mut a, mut b) = (self.clone(), right.clone());
        let mut order: Vec<usize> = (0..a.columns).collect();
        let least = least * a.size();
        let mut rank = 0;
        while rank < a.rows {
            let left = (rank..a.rows).flat_map(|i| (rank..a.columns).map(move |j| (i, j)));
            let size = |&(i, j): &(usize, usize)| a[(i, j)].to_f64().abs();
            let Some((i, j)) = left.max_by(|x, y| size(x).total_cmp(&size(y))) else { break };
            // a pivot that is no number goes on
            if a[(i, j)].to_f64().abs() <= least {
                break;
            }
            a.exchange_rows(rank, i);
            b.exchange_rows(rank, i);
            (0..a.rows).for_each(|row| a.entries.swap(row * a.columns + rank, row * a.columns + j));
            order.swap(rank, j);
            let head = a[(rank, rank)];
            for i in (0..a.rows).filter(|&i| i != rank) {
                let factor = a[(i, rank)] / head;
                (rank..a.columns).for_each(|j| a[(i, j)] = a[(i, j)] - factor * a[(rank, j)]);
                (0..b.columns).for_each(|j| b[(i, j)] = b[(i, j)] - factor * b[(rank, j)]);
            }
            rank += 1;
        }
        let mut x = Matrix::from_fn(a.columns, b.columns, |_, _| R::zero());
        for k in 0..rank {
            (0..b.columns).for_each(|j| x[(order[k], j)] = b[(k, j)] / a[(k, k)]);
        }
        x
    }

    fn exchange_rows(&mut self, i: usize, j: usize) {
        (0..self.columns).for_each(|column| self.entries.swap(i * self.columns + column, j * self.columns + column));
    }

    /// A⁻¹; not finite where A is singular.
    pub fn inverse(&self) -> Self {
        self.solve(&Matrix::identity(self.rows))
    }

    /// Σ Aᵏ/k!, of A/2ˢ with entries below ⅛, squared s times.
    pub fn exponential(&self) -> Self {
        let halvings = (self.size().log2().ceil() + 3.0).clamp(0.0, 60.0);
        let a = self * R::of((-halvings).exp2());
        let mut term = Matrix::identity(self.rows);
        let mut sum = term.clone();
        for k in 1..=40 {
            term = &term * &a * (R::one() / R::of(f64::from(k)));
            sum = sum + &term;
            if term.size() < 1e-34 {
                break;
            }
        }
        (0..halvings as usize).fold(sum, |power, _| &power * &power)
    }

    /// ln A = 2 Σ Xᵏ/k over odd k, X = (A + I)⁻¹(A − I).
    ///
    /// For A near I, where the eigenvalues of X are at most ½ in size.
    pub fn logarithm(&self) -> Self {
        let one = Matrix::identity(self.rows);
        let x = (self + &one).solve(&(self - &one));
        let square = &x * &x;
        let (mut power, mut sum) = (x.clone(), x);
        for k in (3..200).step_by(2) {
            power = &power * &square;
            sum = sum + &power * (R::one() / R::of(f64::from(k)));
            if power.size() < 1e-34 {
                break;
            }
        }
        sum * R::of(2.0)
    }
}

impl Matrix<f64> {
    /// The same numbers, exactly.
    pub fn lift<R: Real>(&self) -> Matrix<R> {
        self.map(R::of)
    }
}

impl<const N: usize, const M: usize> From<&SMatrix<f64, N, M>> for Matrix<f64> {
    fn from(matrix: &SMatrix<f64, N, M>) -> Self {
        Matrix::from_fn(N, M, |i, j| matrix[(i, j)])
    }
}

impl<R> Index<(usize, usize)> for Matrix<R> {
    type Output = R;
    fn index(&self, (i, j): (usize, usize)) -> &R {
        &self.entries[i * self.columns + j]
    }
}
impl<R> IndexMut<(usize, usize)> for Matrix<R> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut R {
        &mut self.entries[i * self.columns + j]
    }
}

fn sum<R: Real>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    assert_eq!(a.shape(), b.shape(), "a sum of matrices");
    Matrix::from_fn(a.rows, a.columns, |i, j| a[(i, j)] + b[(i, j)])
}
fn difference<R: Real>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    assert_eq!(a.shape(), b.shape(), "a difference of matrices");
    Matrix::from_fn(a.rows, a.columns, |i, j| a[(i, j)] - b[(i, j)])
}
fn product<R: Real>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    assert_eq!(a.columns, b.rows, "a product of matrices");
    Matrix::from_fn(a.rows, b.columns, |i, j| (0..a.columns).fold(R::zero(), |sum, k| sum + a[(i, k)] * b[(k, j)]))
}

/// The operator for values and for references.
macro_rules! operator {
    ($trait:ident, $method:ident, $function:ident) => {
        operator!($trait, $method, $function, Matrix<R>, Matrix<R>);
        operator!($trait, $method, $function, Matrix<R>, &Matrix<R>);
        operator!($trait, $method, $function, &Matrix<R>, Matrix<R>);
        operator!($trait, $method, $function, &Matrix<R>, &Matrix<R>);
    };
    ($trait:ident, $method:ident, $function:ident, $left:ty, $right:ty) => {
        impl<R: Real> $trait<$right> for $left {
            type Output = Matrix<R>;
            #[allow(clippy::needless_borrow, reason = "one text for values and for references")]
            fn $method(self, other: $right) -> Matrix<R> {
                $function(&self, &other)
            }
        }
    };
}
operator!(Add, add, sum);
operator!(Sub, sub, difference);
operator!(Mul, mul, product);

impl<R: Real> Mul<R> for &Matrix<R> {
    type Output = Matrix<R>;
    fn mul(self, factor: R) -> Matrix<R> {
        self.map(|entry| entry * factor)
    }
}
impl<R: Real> Mul<R> for Matrix<R> {
    type Output = Matrix<R>;
    fn mul(self, factor: R) -> Matrix<R> {
        &self * factor
    }
}
impl<R: Real> Neg for &Matrix<R> {
    type Output = Matrix<R>;
    fn neg(self) -> Matrix<R> {
        self.map(|entry| -entry)
    }
}
