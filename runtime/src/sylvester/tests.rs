//! Solutions, signs and sizes against those of the dense matrix.

use super::Sylvester;
use crate::implicit::Jacobian;
use crate::linear::{rows, solve_dense};
use crate::matrices::matrix_of;
use crate::orientation::Orientation;
use nalgebra::{SMatrix, SVector};

/// Numbers between −1 and 1 by a linear congruence.
fn draw<const R: usize, const C: usize>(seed: &mut u64) -> SMatrix<f64, R, C> {
    SMatrix::from_fn(|_, _| {
        *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

/// The product of two reflections.
fn orthogonal(seed: &mut u64) -> SMatrix<f64, 6, 6> {
    let mut reflection = || {
        let v = draw::<6, 1>(seed).normalize();
        SMatrix::<f64, 6, 6>::identity() - v * v.transpose() * 2.0
    };
    reflection() * reflection()
}

/// The same by elimination of all unknowns: solutions, signs, columns, and systems with an exchanged column.
fn is_that_of_its_matrix<const N: usize, const M: usize>(factor: SMatrix<f64, N, N>, seed: &mut u64) {
    let map = Sylvester::new(factor);
    let matrix: SMatrix<f64, M, M> = matrix_of(|x| map.times(x));
    let inverse: SMatrix<f64, M, M> = matrix_of(|x| solve_dense(&matrix, x).expect("a regular map").0);
    let condition = matrix.norm() * inverse.norm();
    let near = |a: &SVector<f64, M>, b: &SVector<f64, M>| (a - b).norm() < 1e-13 * condition * b.norm();
    let [right, column] = [draw(seed), draw(seed)];

    let (x, orientation) = Jacobian::<f64, M>::solve(&map, &right).expect("regular");
    let (expected, sign) = solve_dense(&matrix, &right).expect("regular");
    assert!(near(&x, &expected), "{factor}: {x} and {expected}");
    assert_eq!(orientation, sign, "{factor}");
    assert_eq!(Jacobian::<f64, M>::orientation(&map), Orientation::of(rows(&matrix)));

    let j = M / 2;
    assert!((Jacobian::<f64, M>::column(&map, j) - matrix.column(j)).norm() < 1e-15 * matrix.norm());
    let mut exchanged = matrix;
    exchanged.set_column(j, &column);
    let Some((expected, sign)) = solve_dense(&exchanged, &right) else { panic!("regular") };
    let (x, orientation) = map.solve_exchanged(Some((j, &column)), &right).expect("regular");
    assert!((exchanged * x - right).norm() < 1e-12 * condition * (exchanged.norm() * expected.norm()));
    assert_eq!(orientation, sign, "{factor}");

    let terms = (0..M).flat_map(|i| (0..M).map(move |j| (i, j))).map(|(i, j)| (matrix[(i, j)] * right[j]).abs());
    let terms: f64 = terms.sum();
    let size = Jacobian::<f64, M>::size_of_terms(&map, &right);
    // in few dimensions many entries are sums of two that cancel
    assert!(size >= terms * (1.0 - 1e-14) && (N < 6 || size < 2.0 * terms), "{size} for {terms}");
    assert!(Jacobian::<f64, M>::largest_entry(&map) >= matrix.amax() * (1.0 - 1e-15));
}

/// Random factors of bodies near rest. Many have pairs of complex eigenvalues, and maps with negative determinants.
#[test]
fn maps_are_inverted() {
    let seed = &mut 7;
    let (mut negative, draws) = (0, if cfg!(miri) { 1 } else { 40 });
    for _ in 0..draws {
        is_that_of_its_matrix::<2, 1>(draw(seed), seed);
        is_that_of_its_matrix::<3, 3>(draw(seed), seed);
        is_that_of_its_matrix::<6, 15>(draw(seed), seed);
        is_that_of_its_matrix::<7, 21>(draw(seed), seed);
        let body = SMatrix::<f64, 8, 8>::from_diagonal(&SVector::from_fn(|i, _| 1.0 + i as f64));
        is_that_of_its_matrix::<8, 28>(body + draw::<8, 8>(seed) * 0.1, seed);
        let map = Sylvester::new(draw::<6, 6>(seed));
        let orientation = Jacobian::<f64, 15>::orientation(&map);
        negative += usize::from(orientation == Some(Orientation::NEGATIVE));
    }
    assert!(cfg!(miri) || (5..35).contains(&negative), "{negative} of 40");
}

/// An eigenvalue 0 is none of the map, whose eigenvalues are sums of two.
#[test]
fn flat_bodies_are_no_exception() {
    let seed = &mut 11;
    for off in [0.0, 1e-9, 0.1] {
        let flat = SMatrix::<f64, 6, 6>::from_diagonal(&SVector::from_fn(|i, _| i as f64));
        let turned = orthogonal(seed);
        let factor = turned * (flat + (draw::<6, 6>(seed) - draw::<6, 6>(seed)) * off) * turned.transpose();
        is_that_of_its_matrix::<6, 15>(factor, seed);
    }
    let minus = SMatrix::<f64, 6, 6>::from_diagonal(&SVector::from_fn(|i, _| i as f64 - 0.25));
    is_that_of_its_matrix::<6, 15>(minus, seed);
}

/// Identical eigenvalues, rotations, and matrices that are triangular already.
#[test]
fn special_factors_are_decomposed() {
    let seed = &mut 13;
    is_that_of_its_matrix::<6, 15>(SMatrix::identity(), seed);
    is_that_of_its_matrix::<6, 15>(orthogonal(seed) + SMatrix::identity() * 0.3, seed);
    is_that_of_its_matrix::<6, 15>(draw::<6, 6>(seed).upper_triangle() + SMatrix::identity() * 2.0, seed);
    // a cyclic shift, on which sweeps without a shift stand still
    let cyclic = SMatrix::<f64, 5, 5>::from_fn(|i, j| if (i + 1) % 5 == j { 1.0 } else { 0.0 });
    is_that_of_its_matrix::<5, 10>(cyclic, seed);
}

/// Units are powers of two: the same digits.
#[test]
fn units_do_not_matter() {
    let seed = &mut 17;
    let (factor, right) = (draw::<6, 6>(seed) + SMatrix::identity() * 2.0, draw::<15, 1>(seed));
    let solve = |unit: f64| Jacobian::<f64, 15>::solve(&Sylvester::new(factor * unit), &right).expect("regular").0;
    for power in [-960, -160, 160, 960] {
        let unit = 2.0_f64.powi(power);
        assert_eq!(solve(unit) * unit, solve(1.0));
    }
}

#[test]
fn what_is_singular_or_broken_has_no_solution() {
    let right = SVector::<f64, 15>::repeat(1.0);
    let opposite = SMatrix::<f64, 6, 6>::from_diagonal(&SVector::from_fn(|i, _| i as f64 - 1.0));
    for factor in [opposite, SMatrix::zeros(), SMatrix::repeat(f64::NAN), SMatrix::repeat(f64::INFINITY)] {
        assert_eq!(Jacobian::<f64, 15>::solve(&Sylvester::new(factor), &right), None);
    }
}
