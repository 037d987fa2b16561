//! Small systems with exact solutions, and the size of their errors.

use super::{Orientation, eliminate, norm, product, solve_dense, solve_linear, solve_symmetric};
use crate::runner::proptest;
use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2, Vector3, Vector4};
use proptest::prelude::*;

#[test]
fn pivots_away_from_zero() {
    let mut b = [[2.0], [1.0]];
    assert_eq!(eliminate([[0.0, 1.0], [1.0, 0.0]], &mut b), Some(Orientation::NEGATIVE));
    assert_eq!(b, [[1.0], [2.0]]);
}

#[test]
fn systems_are_solved_by_rows_and_products_made() {
    let solution = solve_linear(&Matrix2::new(0.0, 2.0, 4.0, 8.0), &Vector2::new(2.0, 0.0));
    assert_eq!(solution, Some(Vector2::new(-2.0, 1.0)));
    assert_eq!(solve_linear(&Matrix2::new(1.0, 2.0, 2.0, 4.0), &Vector2::x()), None);
    let matrices = (Matrix2::new(1.0, 2.0, 3.0, 4.0), Matrix2::new(0.0, 1.0, -1.0, 5.0));
    assert_eq!(product(&matrices.0, &matrices.1), Matrix2::new(-2.0, 11.0, -4.0, 23.0));
    assert_eq!(norm(&Matrix2::new(1.0, -2.0, -3.0, -4.0)), 7.0);
}

/// Units of powers of two change no digit, up to the ends of the exponent range, where determinants leave it.
#[test]
fn solutions_have_no_units() {
    let (a, b) = (Matrix3::new(4.0, 1.0, -0.5, 1.25, 3.0, 0.75, -0.5, 0.25, 2.0), Vector3::new(1.0, -2.0, 0.5));
    let expected = solve_dense(&a, &b);
    let stride = if cfg!(miri) { 100 } else { 1 };
    for k in (-1000..1000).step_by(stride) {
        let unit = 2.0_f64.powi(k);
        assert_eq!(solve_dense(&(a * unit), &(b * unit)), expected, "2^{k}");
    }
    let (a, b) = (a.map(|x| x as f32), b.map(|x| x as f32));
    let expected = solve_dense(&a, &b);
    for k in (-115..120).step_by(stride) {
        let unit = 2.0_f32.powi(k);
        assert_eq!(solve_dense(&(a * unit), &(b * unit)), expected, "2^{k} in single precision");
    }
}

/// A definite matrix, an indefinite one, one whose leading minors vanish, and a singular one.
#[test]
fn symmetric_systems() {
    let b = Vector2::new(3.0, -1.0);
    let of = |a: f64, c: f64, d: f64| solve_symmetric(&Matrix2::new(a, f64::NAN, c, d), &b);
    assert_eq!(of(2.0, 1.0, 1.0), Some((Vector2::new(4.0, -5.0), Orientation::POSITIVE)));
    assert_eq!(of(-2.0, -1.0, -1.0), Some((Vector2::new(-4.0, 5.0), Orientation::POSITIVE)));
    let solved = |a: f64, c: f64, d: f64| solve_symmetric(&Matrix2::new(a, c, c, d), &b);
    assert_eq!(solved(1.0, 2.0, 2.0), Some((Vector2::new(-4.0, 3.5), Orientation::NEGATIVE)));
    assert_eq!(solved(0.0, 1.0, 0.0), Some((Vector2::new(-1.0, 3.0), Orientation::NEGATIVE)));
    assert_eq!(solved(1.0, 1.0, 1.0), None);
    assert_eq!(solved(f64::NAN, 1.0, 1.0), None);
    assert_eq!(solved(f64::INFINITY, 1.0, 1.0), None);
    let cubic = solve_symmetric(&-Matrix3::<f64>::identity(), &Vector3::x());
    assert_eq!(cubic, Some((-Vector3::x(), Orientation::NEGATIVE)));
}

#[test]
fn signs_of_determinants_multiply() {
    let (plus, minus) = (Orientation::POSITIVE, Orientation::NEGATIVE);
    assert_eq!([plus * plus, plus * minus, minus * plus, minus * minus], [plus, minus, minus, plus]);
}

#[test]
fn singular_and_broken_matrices_are_refused() {
    assert_eq!(Orientation::of([[1.0, 2.0], [2.0, 4.0]]), None);
    assert_eq!(Orientation::of([[0.0; 3]; 3]), None);
    assert_eq!(Orientation::of([[f64::NAN, 1.0], [1.0, 0.0]]), None);
    assert_eq!(Orientation::of([[f64::INFINITY, 1.0], [1.0, 0.0]]), None);
}

#[test]
fn determinants_beyond_the_exponent_range_keep_their_sign() {
    // powers of two, whose reciprocals are exact
    for scale in [2.0_f64.powi(-1000), 2.0_f64.powi(1000)] {
        let rows = [[0.0, scale, 0.0], [scale, 0.0, 0.0], [0.0, 0.0, scale]];
        let mut b = [[scale], [2.0 * scale], [3.0 * scale]];
        assert_eq!(eliminate(rows, &mut b), Some(Orientation::NEGATIVE));
        assert_eq!(b, [[2.0], [1.0], [3.0]]);
    }
}

proptest! {
    #[test]
    fn solutions_are_backward_stable(
        a in prop::array::uniform4(prop::array::uniform4(-1.0_f64..1.0)),
        b in prop::array::uniform4(-1.0_f64..1.0),
    ) {
        let mut x = b.map(|entry| [entry]);
        prop_assume!(eliminate(a, &mut x).is_some());
        for (row, entry) in a.iter().zip(b) {
            let size: f64 = row.iter().zip(x).map(|(r, [x])| (r * x).abs()).sum();
            let residual: f64 = row.iter().zip(x).map(|(r, [x])| r * x).sum::<f64>() - entry;
            let largest = x.iter().fold(0.0_f64, |m, [x]| m.max(x.abs()));
            prop_assert!(residual.abs() <= 64.0 * f64::EPSILON * (size + largest + entry.abs()));
        }
    }

    /// Definite, indefinite and nearly singular ones, against elimination with pivoting.
    #[test]
    fn symmetric_solutions_are_those_of_elimination(
        a in prop::array::uniform4(prop::array::uniform4(-1.0_f64..1.0)),
        b in prop::array::uniform4(-1.0_f64..1.0),
        shift in -3.0_f64..3.0,
    ) {
        let a = Matrix4::from(a);
        let (a, b) = (a + a.transpose() + Matrix4::identity() * shift, Vector4::from(b));
        let (dense, symmetric) = (solve_dense(&a, &b), solve_symmetric(&a, &b));
        prop_assume!(dense.is_some());
        let ((x, sign), (y, other)) = (dense.unwrap(), symmetric.unwrap());
        prop_assert_eq!(sign, other);
        prop_assert!((a * y - b).amax() <= 64.0 * f64::EPSILON * (a.amax() * (y.amax() + x.amax()) + b.amax()));
    }

    #[test]
    fn the_sign_is_that_of_the_determinant(a in prop::array::uniform3(prop::array::uniform3(-1.0_f64..1.0))) {
        let det = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
            + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
        prop_assume!(det.abs() > 1e-12);
        let sign = if det > 0.0 { Orientation::POSITIVE } else { Orientation::NEGATIVE };
        prop_assert_eq!(Orientation::of(a), Some(sign));
    }
}
