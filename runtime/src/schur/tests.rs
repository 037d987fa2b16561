//! Products of the factors against the matrix.

use super::Schur;
use nalgebra::SMatrix;

/// B = Q T Qᵀ, Q is orthogonal, and below its diagonal T has single entries alone, no two in a row.
fn is_a_form_of<const N: usize>(b: &SMatrix<f64, N, N>) {
    let Schur { q, t } = Schur::new(b).expect("a matrix of numbers");
    let [q, t] = [q, t].map(|rows| SMatrix::<f64, N, N>::from_fn(|i, j| rows[i][j]));
    assert!((q * t * q.transpose() - b).norm() <= 1e-14 * N as f64 * b.norm(), "{b}");
    assert!((q.transpose() * q - SMatrix::identity()).norm() < 1e-14 * N as f64, "{q}");
    for i in 1..N {
        assert!((0..i - 1).all(|j| t[(i, j)] == 0.0), "{t}");
        assert!(i < 2 || t[(i, i - 1)] == 0.0 || t[(i - 1, i - 2)] == 0.0, "{t}");
    }
}

#[test]
fn matrices_are_decomposed() {
    let wave = |shift: usize| move |i: usize, j: usize| ((i * i * 7 + j * 3 * (i + 1) + shift) as f64).sin();
    for shift in 0..if cfg!(miri) { 1 } else { 200 } {
        is_a_form_of(&SMatrix::<f64, 1, 1>::from_fn(wave(shift)));
        is_a_form_of(&SMatrix::<f64, 2, 2>::from_fn(wave(shift)));
        is_a_form_of(&SMatrix::<f64, 3, 3>::from_fn(wave(shift)));
        is_a_form_of(&SMatrix::<f64, 4, 4>::from_fn(wave(shift)));
        is_a_form_of(&SMatrix::<f64, 7, 7>::from_fn(wave(shift)));
        is_a_form_of(&SMatrix::<f64, 10, 10>::from_fn(wave(shift)));
    }
}

/// Cyclic shifts, on which sweeps without other shifts stand still; all eigenvalues alike; entries of very different sizes.
#[test]
fn special_matrices_are_decomposed() {
    is_a_form_of(&SMatrix::<f64, 6, 6>::from_fn(|i, j| if (i + 1) % 6 == j { 1.0 } else { 0.0 }));
    is_a_form_of(&SMatrix::<f64, 4, 4>::from_fn(|i, j| if (i + 1) % 4 == j { 1.0 } else { 0.0 }));
    is_a_form_of(&SMatrix::<f64, 6, 6>::identity());
    is_a_form_of(&SMatrix::<f64, 6, 6>::from_fn(|i, j| if i <= j { 1.0 } else { 0.0 }));
    is_a_form_of(&SMatrix::<f64, 6, 6>::from_fn(|i, j| ((i * j) as f64).cos() * 10_f64.powi(-4 * (i + j) as i32)));
    is_a_form_of(&SMatrix::<f64, 6, 6>::from_fn(|i, j| 1.0 / (1 + i + j) as f64));
    assert!(Schur::new(&SMatrix::<f64, 3, 3>::repeat(f64::NAN)).is_none());
}
