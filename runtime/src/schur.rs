//! The real Schur form of a small matrix, by QR iteration.
//!
//! For every [`Real`], while nalgebra's is for its `RealField` alone, and without a panic that is left in a step.

use crate::linear::{entry, rows};
use crate::{Real, Space};
use core::array::from_fn;
use nalgebra::SMatrix;

/// B = Q T Qᵀ with orthogonal Q, and T upper triangular but for blocks of two rows on its diagonal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Schur<T, const N: usize> {
    pub q: [[T; N]; N],
    pub t: [[T; N]; N],
}

/// Sweeps for one block: two or three are usual.
const SWEEPS: u32 = 60;

impl<T: Real, const N: usize> Schur<T, N> {
    /// By Householder's reflections to Hessenberg form, then by sweeps with the two shifts of Francis; `None` if the matrix is not finite.
    /// Blocks of two rows are left as they are, whether their eigenvalues are real or not. Cost: about 25 N³ operations.
    ///
    /// Source: Golub and Van Loan, *Matrix Computations*, 4th edition, algorithms 7.4.2, 7.5.1 and 7.5.2.
    pub fn new(b: &SMatrix<T, N, N>) -> Option<Self> {
        if !b.all_finite() {
            return None;
        }
        let mut schur = Self::hessenberg(rows(b));
        let (mut end, mut sweeps) = (N, 0);
        while end > 2 {
            let start = schur.start_of_block(end);
            if end - start <= 2 {
                (end, sweeps) = (start, 0);
                continue;
            }
            if sweeps == SWEEPS {
                return None;
            }
            sweeps += 1;
            schur.sweep(start, end, sweeps % 10 == 0);
        }
        Some(schur)
    }

    /// B = Q H Qᵀ with zeros below the first subdiagonal of H.
    fn hessenberg(b: [[T; N]; N]) -> Self {
        let mut form = Self { q: rows(&SMatrix::identity()), t: b };
        for k in 0..N.saturating_sub(2) {
            let below = from_fn(|i| if i > k { entry(&form.t, i, k) } else { T::zero() });
            form.reflect(0, Reflection::<T, N>::onto(below, k + 1), k, N);
            form.t.iter_mut().skip(k + 2).for_each(|row| row[k] = T::zero());
        }
        form
    }

    /// Where the block begins that ends before `end` and has no negligible entry below its diagonal.
    fn start_of_block(&mut self, end: usize) -> usize {
        let mut start = end - 1;
        while start > 0 {
            let around = entry(&self.t, start, start).abs() + entry(&self.t, start - 1, start - 1).abs();
            let Some(below) = self.t.get_mut(start).and_then(|row| row.get_mut(start - 1)) else { break };
            if below.abs() <= T::EPSILON * around {
                *below = T::zero();
                break;
            }
            start -= 1;
        }
        start
    }

    /// One sweep over rows `start` to `end`. The shifts are the two eigenvalues of its last two rows, or others that
    /// lead out of cycles.
    fn sweep(&mut self, start: usize, end: usize, is_exceptional: bool) {
        let at = |i: usize, j: usize| entry(&self.t, i, j);
        let (last, before) = (end - 1, end - 2);
        let (trace, determinant) = if is_exceptional {
            let size = at(last, before).abs() + at(before, before - 1).abs();
            (size * T::from_ratio(3, 2), size * size)
        } else {
            let [a, b, c, d] = [at(before, before), at(before, last), at(last, before), at(last, last)];
            (a + d, a * d - b * c)
        };
        // the first column of (T − σ₁)(T − σ₂)
        let (first, second) = (at(start, start), at(start + 1, start + 1));
        let below = at(start + 1, start);
        let column = [
            first * first + at(start, start + 1) * below - trace * first + determinant,
            below * (first + second - trace),
            below * at(start + 2, start + 1),
        ];
        self.reflect(start, Reflection::onto(column, 0), start, end.min(start + 4));
        for k in start + 1..before {
            let bulge = from_fn(|i| entry(&self.t, k + i, k - 1));
            self.reflect(k, Reflection::<T, 3>::onto(bulge, 0), k - 1, end.min(k + 4));
            self.clear(k + 1..k + 3, k - 1);
        }
        let bulge = from_fn(|i| entry(&self.t, before + i, before - 1));
        self.reflect(before, Reflection::<T, 2>::onto(bulge, 0), before - 1, end);
        self.clear(last..end, before - 1);
    }

    /// Zeros where a reflection has made them up to rounding.
    fn clear(&mut self, rows: core::ops::Range<usize>, column: usize) {
        let rows = self.t.get_mut(rows).into_iter().flatten();
        rows.filter_map(|row| row.get_mut(column)).for_each(|entry| *entry = T::zero());
    }

    /// T ← P T P and Q ← Q P for the reflection P of W rows from `at` on. It acts on columns from `left` on, and on
    /// rows before `bottom`.
    fn reflect<const W: usize>(&mut self, at: usize, reflection: Reflection<T, W>, left: usize, bottom: usize) {
        let Reflection { v, weight } = reflection;
        if let Some(rows) = self.t.get_mut(at..).and_then(<[_]>::first_chunk_mut::<W>) {
            for j in left..N {
                let part = rows.iter().zip(&v).fold(T::zero(), |sum, (row, v)| sum + row[j] * *v) * weight;
                rows.iter_mut().zip(&v).for_each(|(row, v)| row[j] -= *v * part);
            }
        }
        for row in self.t.iter_mut().take(bottom).chain(&mut self.q) {
            if let Some(entries) = row.get_mut(at..).and_then(<[_]>::first_chunk_mut::<W>) {
                let part = entries.iter().zip(&v).fold(T::zero(), |sum, (x, v)| sum + *x * *v) * weight;
                entries.iter_mut().zip(&v).for_each(|(x, v)| *x -= *v * part);
            }
        }
    }
}

/// I − w v vᵀ
struct Reflection<T, const W: usize> {
    v: [T; W],
    weight: T,
}

impl<T: Real, const W: usize> Reflection<T, W> {
    /// That which leaves of x only entry `head`; none where there is no other.
    fn onto(x: [T; W], head: usize) -> Self {
        let mut v = x;
        let others = x.iter().enumerate().filter(|(i, _)| *i != head);
        let rest = others.fold(T::zero(), |sum, (_, x)| sum + *x * *x);
        match v.get_mut(head) {
            // not where the others are just small: it would stay as it is, and the sweep would stand still
            Some(first) if rest > T::zero() => {
                let square = rest + *first * *first;
                let (length, size) = (square.sqrt(), first.abs());
                *first = if *first < T::zero() { *first - length } else { *first + length };
                Self { v, weight: T::one() / (square + length * size) }
            }
            _ => Self { v, weight: T::zero() },
        }
    }
}

#[cfg(test)]
mod tests;
