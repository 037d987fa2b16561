//! The linear map Δ ↦ ΔB + BᵀΔ of skew matrices, inverted without the matrix of n(n − 1)/2 rows.
//!
//! It is Dρ of the momentum equation of a body on SO(n) in Cayley's chart. With B = QTQᵀ (Schur), Y = QᵀΔQ is skew too
//! and solves TᵀY + YT = QᵀRQ for the right side R, block after block from the first. The eigenvalues of the map are
//! the sums λ_i + λ_j, i < j, of two eigenvalues of B. Flat bodies, which have an eigenvalue 0, are no exception. The
//! sign of their product is that of the small systems' determinants.
//!
//! Source: Bartels and Stewart, *Solution of the matrix equation AX + XB = C*, Communications of the ACM 15 (1972) 820–826.

use crate::implicit::Jacobian;
use crate::linear::{Solution, eliminate, entry, matrix, power_of_two_near, rows, solve_dense};
use crate::matrices::{matrix_of, skew, skew_components};
use crate::orientation::Orientation;
use crate::schur::Schur;
use crate::{Mask, Real, Scalar, Space};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// The map x ↦ ⟨x^B, E⟩ of the components of skew matrices of N rows, in the basis of [`skew`]: ΔB + BᵀΔ for Δ = x^. Cost of a solve: about
/// 35 N³ operations, those of the Schur form and of four products.
#[derive(Clone, Copy, Debug)]
pub struct Sylvester<T, const N: usize> {
    factor: SMatrix<T, N, N>,
}

impl<T: Scalar, const N: usize> Sylvester<T, N> {
    /// The map with the factor B.
    #[inline]
    pub fn new(factor: SMatrix<T, N, N>) -> Self {
        Self { factor }
    }

    /// Its value at x.
    #[inline]
    pub fn times<const M: usize>(&self, x: &SVector<T, M>) -> SVector<T, M> {
        let x: SMatrix<T, N, N> = skew(x);
        skew_components(&(x * self.factor))
    }
}

impl<T: Real, const N: usize> Sylvester<T, N> {
    /// The solutions for some right sides, and the sign of the determinant; `None` where the map is singular.
    fn solutions<const M: usize, const K: usize>(
        &self,
        rights: [SVector<T, M>; K],
    ) -> Option<([SVector<T, M>; K], Orientation)> {
        let (mut solutions, mut orientation) = (rights, Orientation::POSITIVE);
        if T::DERIVATIVES > 0 {
            // derivatives of the terms that the iteration neglects are not negligible
            let matrix = matrix_of(|x| self.times(x));
            for solution in &mut solutions {
                (*solution, orientation) = solve_dense(&matrix, solution)?;
            }
        } else {
            // squares of entries of ordinary size are numbers, whatever the units
            let unit = power_of_two_near(self.factor.max_abs());
            let schur = Schur::new(&(self.factor * unit))?;
            for solution in &mut solutions {
                (*solution, orientation) = schur.solve(&(*solution * unit))?;
            }
        }
        Some((solutions, orientation))
    }
}

/// Rows of a block on the diagonal of a Schur form: the first, and one or two in all.
#[derive(Clone, Copy)]
struct Block {
    first: usize,
    size: usize,
}

impl<T: Real, const N: usize> Schur<T, N> {
    /// The blocks on the diagonal, from the first; those of no rows are behind them.
    fn blocks(&self) -> [Block; N] {
        let mut next = 0;
        from_fn(|_| {
            let first = next;
            let is_pair = entry(&self.t, first + 1, first) != T::zero();
            let size = if first < N { 1 + usize::from(is_pair) } else { 0 };
            next += size;
            Block { first, size }
        })
    }

    /// x with ⟨x^B, E⟩ = `right`, and the sign of the determinant of this map; `None` where it is 0.
    fn solve<const M: usize>(&self, right: &SVector<T, M>) -> Solution<T, M> {
        let q = matrix(self.q);
        let right: SMatrix<T, N, N> = skew(right);
        let right = rows(&(q.transpose() * right * q));
        // columns of T
        let t: [[T; N]; N] = from_fn(|j| from_fn(|i| self.t[i][j]));
        let (blocks, mut y, mut orientation) = (self.blocks(), [[T::zero(); N]; N], Orientation::POSITIVE);
        for (number, p) in blocks.iter().enumerate() {
            for q in blocks.iter().skip(number).filter(|q| q.size > 0) {
                // (QᵀRQ)_ij without the terms of blocks before, in which T_kiY_kj is −T_kiY_jk
                let rest = |i: usize, j: usize| {
                    let [above, left] =
                        [[i, j, p.first], [j, i, q.first]].map(|[i, j, count]| dot(&t, i, &y, j, count));
                    entry(&right, i, j) + above - left
                };
                let (found, sign) = if p.first == q.first { self.alone(*p, rest)? } else { self.pair(*p, *q, rest)? };
                orientation = orientation * sign;
                for (k, value) in found.into_iter().enumerate() {
                    let (i, j) = (p.first + k / 2, q.first + k % 2);
                    if k / 2 < p.size && k % 2 < q.size {
                        set(&mut y, i, j, value);
                        set(&mut y, j, i, -value);
                    }
                }
            }
        }
        let y = matrix(y);
        Some((skew_components(&(q * y * q.transpose())) * T::from_ratio(1, 2), orientation))
    }

    /// Y_pp, row by row. It is skew, so only a block of two rows has a number that is not 0: y with (t₁₁ + t₂₂) y =
    /// `rest`.
    fn alone(&self, p: Block, rest: impl Fn(usize, usize) -> T) -> Option<([T; 4], Orientation)> {
        let zero = T::zero();
        if p.size < 2 {
            return Some(([zero; 4], Orientation::POSITIVE));
        }
        let (i, j) = (p.first, p.first + 1);
        let ([y], sign) = quotient(rest(i, j), entry(&self.t, i, i) + entry(&self.t, j, j))?;
        Some(([zero, y, -y, zero], sign))
    }

    /// Y_pq, row by row, with T_ppᵀ Y_pq + Y_pq T_qq = `rest`.
    fn pair(&self, p: Block, q: Block, rest: impl Fn(usize, usize) -> T) -> Option<([T; 4], Orientation)> {
        let t = &self.t;
        if p.size == 1 && q.size == 1 {
            let ([y], sign) =
                quotient(rest(p.first, q.first), entry(t, p.first, p.first) + entry(t, q.first, q.first))?;
            return Some(([y, T::zero(), T::zero(), T::zero()], sign));
        }
        let holds = |row: usize| row / 2 < p.size && row % 2 < q.size;
        let matrix: [[T; 4]; 4] = from_fn(|row| {
            let (i, j) = (row / 2, row % 2);
            from_fn(|column| {
                let (k, l) = (column / 2, column % 2);
                if !(holds(row) && holds(column)) {
                    return if row == column { T::one() } else { T::zero() };
                }
                let above = if j == l { entry(t, p.first + k, p.first + i) } else { T::zero() };
                let left = if i == k { entry(t, q.first + l, q.first + j) } else { T::zero() };
                above + left
            })
        });
        let mut y = from_fn(|row| [if holds(row) { rest(p.first + row / 2, q.first + row % 2) } else { T::zero() }]);
        let orientation = eliminate(matrix, &mut y)?;
        Some((y.map(|[y]| y), orientation))
    }
}

/// Σ a_ik b_jk, k < `count`.
fn dot<T: Real, const N: usize>(a: &[[T; N]; N], i: usize, b: &[[T; N]; N], j: usize, count: usize) -> T {
    let entries = a.get(i).into_iter().flatten().zip(b.get(j).into_iter().flatten());
    entries.take(count).fold(T::zero(), |sum, (a, b)| sum + *a * *b)
}

fn set<T: Real, const N: usize>(rows: &mut [[T; N]; N], i: usize, j: usize, value: T) {
    if let Some(entry) = rows.get_mut(i).and_then(|row| row.get_mut(j)) {
        *entry = value;
    }
}

/// a/b and the sign of b; `None` where it is 0 or not finite.
fn quotient<T: Real>(a: T, b: T) -> Option<([T; 1], Orientation)> {
    let sign = if b < T::zero() { Orientation::NEGATIVE } else { Orientation::POSITIVE };
    (b != T::zero() && b.is_finite()).then(|| ([a / b], sign))
}

impl<T: Scalar, const N: usize, const M: usize> Jacobian<T, M> for Sylvester<T, N> {
    type Lane = Sylvester<T::Lane, N>;

    fn lane(&self, lane: usize) -> Self::Lane {
        Sylvester::new(Space::lane(&self.factor, lane))
    }

    #[inline(never)]
    fn solve(&self, residual: &SVector<T, M>) -> Solution<T, M> {
        let mut solution = *residual;
        let (mut regular, mut negative) = (0_u16, 0_u16);
        for lane in 0..T::LANES {
            let own = Sylvester::new(Space::lane(&self.factor, lane));
            if let Some(([own], orientation)) = own.solutions([residual.lane(lane)]) {
                solution.set_lane(lane, &own);
                regular |= 1 << lane;
                negative |= u16::from(orientation == Orientation::NEGATIVE) << lane;
            }
        }
        let orientation = Orientation::new(T::Mask::from_bits(regular), T::Mask::from_bits(negative));
        (regular != 0).then_some((solution, orientation))
    }

    fn orientation(&self) -> Option<Orientation> {
        let (_, orientation) = Jacobian::<T, M>::solve(self, &SVector::from_element(T::zero()))?;
        orientation.lanes::<T>().all().then_some(orientation)
    }

    fn solve_exchanged(&self, exchanged: Option<(usize, &SVector<T, M>)>, right: &SVector<T, M>) -> Solution<T, M>
    where
        T: Real,
    {
        let Some((j, column)) = exchanged else { return Jacobian::<T, M>::solve(self, right) };
        // Sherman and Morrison: A + (c − a_j) e_jᵀ has the solution x − (x_j/z_j)(z − e_j) for Ax = right, Az = c
        let ([mut x, z], orientation) = self.solutions([*right, *column])?;
        let (pivot, entry) = (z.get(j)?, x.get(j).copied()?);
        if *pivot == T::zero() {
            return None;
        }
        let (unknown, turned) = (entry / *pivot, *pivot < T::zero());
        x -= z * unknown;
        *x.get_mut(j)? = unknown;
        Some((x, if turned { orientation * Orientation::NEGATIVE } else { orientation }))
    }

    fn column(&self, j: usize) -> SVector<T, M> {
        self.times(&SVector::<T, M>::from_fn(|i, _| if i == j { T::one() } else { T::zero() }))
    }

    fn size_of_terms(&self, x: &SVector<T, M>) -> T {
        // the sum of all entries of |Δ||B|
        let delta: SMatrix<T, N, N> = skew(x);
        let add = |sum: T, entry: &T| sum + entry.abs();
        delta.column_iter().zip(self.factor.row_iter()).fold(T::zero(), |sum, (column, row)| {
            sum + column.iter().fold(T::zero(), add) * row.iter().fold(T::zero(), add)
        })
    }

    fn largest_entry(&self) -> T {
        // entries are B_ij, and B_ii + B_jj
        self.factor.max_abs() * T::from_ratio(2, 1)
    }

    fn all_finite(&self) -> bool {
        Space::<T>::all_finite(&self.factor)
    }

    fn between(&self, other: &Self, s: T) -> Self {
        Self::new(self.factor + (other.factor - self.factor) * s)
    }
}

#[cfg(test)]
mod tests;
