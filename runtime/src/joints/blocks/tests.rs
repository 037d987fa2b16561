use super::{Backward, Block, Elimination, Forward, Place, invert, invert_by_size};
use crate::runner::is_long;
use nalgebra::{SMatrix, SVector};

type Blocks = (SMatrix<f64, 2, 2>, SMatrix<f64, 2, 2>);

/// Eliminates and solves; gives the pivots that are 0, and the site of the first.
fn solve<const N: usize>(given: &[Blocks; N], right: &mut [SVector<f64, 2>; N], is_ring: bool) -> (usize, usize) {
    let at = |site: usize| Place { site, sites: N, is_ring };
    let mut blocks = [Block::<f64, 2>::zero(); N];
    let (mut elimination, mut forward, mut backward) = (Elimination::new(), Forward::new(), Backward::new());
    for (i, (block, given)) in blocks.iter_mut().zip(given).enumerate() {
        elimination.add(block, *given, at(i), 1e-8);
        forward.add(block, right[i], at(i));
    }
    for i in (0..N).rev() {
        right[i] = backward.add(&mut blocks[i], at(i));
    }
    (elimination.zeros, elimination.first)
}

/// Numbers between −1 and 1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Random positive blocks, S as one matrix, and its solution for a random right side by LU of that matrix.
fn compare<const N: usize>(is_ring: bool, seed: u64) {
    let mut number = numbers(seed);
    let mut blocks = [(SMatrix::<f64, 2, 2>::zeros(), SMatrix::<f64, 2, 2>::zeros()); N];
    let mut solved = [SVector::<f64, 2>::zeros(); N];
    // 9 sites at most
    let mut dense = SMatrix::<f64, 18, 18>::identity();
    let mut right = SVector::<f64, 18>::zeros();
    for i in 0..N {
        let a = SMatrix::<f64, 2, 2>::from_fn(|_, _| number());
        // positive, as neighbours take at most 4 in each row
        blocks[i].0 = a * a.transpose() + SMatrix::identity() * 9.0;
        dense.fixed_view_mut::<2, 2>(2 * i, 2 * i).copy_from(&blocks[i].0);
        solved[i] = SVector::from_fn(|_, _| number());
        right.fixed_rows_mut::<2>(2 * i).copy_from(&solved[i]);
    }
    for i in 0..N {
        if i == 0 && !is_ring {
            continue;
        }
        let (before, c) = ((i + N - 1) % N, SMatrix::<f64, 2, 2>::from_fn(|_, _| number()));
        blocks[i].1 = c;
        let mut block = dense.fixed_view_mut::<2, 2>(2 * i, 2 * before);
        block += c;
        let mut block = dense.fixed_view_mut::<2, 2>(2 * before, 2 * i);
        block += c.transpose();
    }
    assert_eq!(solve(&blocks, &mut solved, is_ring), (0, 0));
    let expected = dense.lu().solve(&right).unwrap();
    for (i, solved) in solved.iter().enumerate() {
        let error = (solved - expected.fixed_rows::<2>(2 * i)).norm();
        assert!(error < 1e-13, "{N} sites, ring {is_ring}, site {i}: {error:e}");
    }
}

#[test]
fn solutions_are_those_of_the_dense_matrix() {
    for seed in 0..200 {
        compare::<1>(false, seed);
        compare::<2>(false, seed);
        compare::<3>(false, seed);
        compare::<7>(false, seed);
        compare::<2>(true, seed);
        compare::<3>(true, seed);
        compare::<4>(true, seed);
        compare::<9>(true, seed);
    }
}

#[test]
fn dependent_rows_are_counted() {
    let mut blocks = [(SMatrix::from([[1.0, 0.0], [0.0, 2.0]]), SMatrix::zeros()); 3];
    // the second row of site 1 is that of site 0
    blocks[1].0[(1, 1)] = 1.0;
    blocks[1].1[(1, 0)] = 1.0;
    assert_eq!(solve(&blocks, &mut [SVector::zeros(); 3], false), (1, 1));
}

/// L Lᵀ with rows of L between 1 and 10^−digits of the others, and its rank.
fn gram<const N: usize>(number: &mut impl FnMut() -> f64, digits: f64, rank: usize) -> SMatrix<f64, N, N> {
    let factor = SMatrix::<f64, N, N>::from_fn(|_, j| if j < rank { number() } else { 0.0 });
    let sizes = SVector::<f64, N>::from_fn(|_, _| 10.0_f64.powf(digits * number()));
    let mut gram = factor * factor.transpose();
    for i in 0..N {
        for j in 0..N {
            gram[(i, j)] *= sizes[i] * sizes[j];
        }
    }
    gram
}

/// The error is that of the matrix whose diagonal is scaled to 1. Pivots by size give no less.
#[test]
fn inverses_without_exchanges_are_as_right_as_with_pivots() {
    const N: usize = 6;
    let (mut number, mut worst) = (numbers(7), 0.0_f64);
    for _ in 0..2000 {
        let matrix = gram::<N>(&mut number, 6.0, N);
        let scale = matrix.diagonal().map(f64::sqrt);
        let scaled = SMatrix::<f64, N, N>::from_fn(|i, j| matrix[(i, j)] / (scale[i] * scale[j]));
        let values = scaled.symmetric_eigenvalues();
        let condition = values.max() / values.min();
        if !(0.0..1e12).contains(&condition) {
            continue;
        }
        let x = SVector::<f64, N>::from_fn(|i, _| number() / scale[i]);
        let right = matrix * x;
        let mut inverse = matrix;
        assert_eq!(invert(&mut inverse, &matrix.diagonal(), 1e-14), 0);
        let size = |x: SVector<f64, N>| x.component_mul(&scale).norm();
        let error = size(inverse * right - x) / size(x);
        let mut by_size = matrix;
        assert_eq!(invert_by_size(&mut by_size, &matrix.diagonal(), 1e-14), 0);
        let other = size(by_size * right - x) / size(x);
        assert!(other < 32.0 * f64::EPSILON * condition, "{other:e}, condition {condition:e}");
        let pivoted = size(matrix.full_piv_lu().solve(&right).expect("a regular matrix") - x) / size(x);
        assert!(error < 32.0 * f64::EPSILON * condition, "{error:e}, {pivoted:e} with pivots, condition {condition:e}");
        worst = worst.max(error / (pivoted + f64::EPSILON * condition));
    }
    assert!((0.01..20.0).contains(&worst), "{worst}");
}

/// Rows that depend on each other are counted where the others are independent enough, whatever the order of the rows.
#[test]
fn the_rank_does_not_depend_on_the_order() {
    let mut number = numbers(11);
    for rank in 0..=6 {
        for _ in 0..if is_long() { 2000 } else { 200 } {
            let matrix = gram::<6>(&mut number, 3.0, rank);
            let scale = matrix.diagonal().map(f64::sqrt);
            let scaled = SMatrix::<f64, 6, 6>::from_fn(|i, j| matrix[(i, j)] / (scale[i] * scale[j]));
            let mut values = scaled.symmetric_eigenvalues();
            values.as_mut_slice().sort_by(f64::total_cmp);
            if rank > 0 && values[6 - rank] < 1e-4 {
                continue;
            }
            let mut inverse = matrix;
            let zeros = invert_by_size(&mut inverse, &matrix.diagonal(), 1e-10);
            let reversed = SMatrix::<f64, 6, 6>::from_fn(|i, j| matrix[(5 - i, 5 - j)]);
            let mut other = reversed;
            assert_eq!(
                (zeros, invert_by_size(&mut other, &reversed.diagonal(), 1e-10)),
                (6 - rank, 6 - rank),
                "{matrix}"
            );
        }
    }
}
