use super::Tridiagonal;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

const M: usize = 3;

/// Numbers without a pattern, from −1 to 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Protects the solution of lines and rings of every length against LU of the full matrix.
#[test]
fn solves_as_the_full_matrix() {
    let mut seed = 5;
    for is_ring in [false, true] {
        for count in 1..9_usize {
            let mut matrix = Tridiagonal::<f64, M>::new(count, is_ring);
            let mut full = DMatrix::<f64>::zeros(M * count, M * count);
            let edges = if is_ring { count } else { count - 1 };
            let pairs = (0..edges).flat_map(|i| {
                let j = (i + 1) % count;
                [(i, i), (j, j), (i, j), (j, i)]
            });
            for (i, j) in (0..count).map(|i| (i, i)).chain(pairs) {
                let mut block = SMatrix::<f64, M, M>::from_fn(|_, _| random(&mut seed));
                if i == j {
                    block += SMatrix::identity() * 3.0;
                }
                matrix.add(i, j, &block);
                let mut view = full.view_mut((M * i, M * j), (M, M));
                view += block;
            }
            let right: Vec<SVector<f64, M>> = (0..count).map(|_| SVector::from_fn(|_, _| random(&mut seed))).collect();
            let all = DVector::from_iterator(M * count, right.iter().flat_map(|part| part.iter().copied()));
            let expected = full.lu().solve(&all).unwrap();
            let mut found = right;
            matrix.eliminate().unwrap();
            matrix.solve(&mut found);
            let largest = (0..M * count).map(|k| (found[k / M][k % M] - expected[k]).abs()).fold(0.0, f64::max);
            assert!(largest < 1e-12 * (1.0 + expected.amax()), "{count} rows, ring {is_ring}: {largest:e}");
        }
    }
}

/// Protects against a solution of a singular matrix.
#[test]
fn refuses_a_singular_pivot() {
    let mut matrix = Tridiagonal::<f64, M>::new(2, false);
    matrix.add(0, 0, &SMatrix::identity());
    assert!(matrix.eliminate().is_none());
    matrix.hold(1);
    assert!(matrix.eliminate().is_some());
}
