use super::*;
use crate::Real;
use nalgebra::{Matrix2, Matrix3, Vector3};

/// The polar factor of a matrix near a rotation by Newton's method for XᵀX = I, X ← (X + X⁻ᵀ)/2.
///
/// Source: Higham, *Computing the polar decomposition, with applications*, SIAM J. Sci. Stat. Comput. 7, 1986. Not by singular values: Miri
/// refuses a view of a view in those of nalgebra 0.35 (its issue 1588).
fn nearest_rotation(a: Matrix3<f64>) -> Matrix3<f64> {
    (0..6).fold(a, |x, _| (x + x.try_inverse().expect("regular").transpose()) / 2.0)
}

/// To the square of the defect. A matrix that is off by rounding only keeps its bits, and NaN stays NaN.
#[test]
fn what_has_left_its_space_comes_back() {
    let rotation = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    assert_eq!(orthogonal(rotation), rotation);
    for defect in [1e-13, 1e-8, 1e-4] {
        let off = rotation + Matrix3::new(1.0, 0.5, -0.25, 0.75, 1.0, 0.5, -1.0, 0.25, 0.5) * defect;
        let error = (orthogonal(off) - nearest_rotation(off)).amax();
        assert!(error <= 4.0 * defect * defect + 4.0 * f64::EPSILON, "{defect:e}: {error:e}");
        let q = Vector3::new(0.6, 0.0, -0.8) * (1.0 + defect);
        let error = (of_length_one(q).norm() - 1.0).abs();
        assert!(error <= 4.0 * defect * defect + 2.0 * f64::EPSILON, "{defect:e}: {error:e}");
    }
    assert!(orthogonal(rotation.map(|_| f64::NAN)).iter().all(|entry| entry.is_nan()));
    assert_eq!(of_length_one(Vector3::<f64>::y()), Vector3::y());
}

/// A result is on its space to round-off, or NaN where formulas must have lost their digits.
#[test]
fn a_result_is_on_its_space_or_none() {
    fn check<T: Real>(defect: f64, is_known: bool) {
        let rotation = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
        let direction = Matrix3::new(1.0, 0.5, -0.25, 0.75, 1.0, 0.5, -1.0, 0.25, 0.5);
        let off = (rotation + direction * defect).map(T::from_f64);
        let q = (Vector3::new(0.6, 0.0, -0.8) * (1.0 + defect)).map(T::from_f64);
        let (zero, none) = (SMatrix::from_element(T::zero()), SVector::from_element(T::zero()));
        for found in [orthogonal(off), orthogonal_with_rest(off, zero).0] {
            let defect_left = orthogonality_defect(&found).to_f64();
            assert!(!is_known || defect_left <= 32.0 * T::EPSILON.to_f64(), "{defect:e}: {defect_left:e}");
            assert!(is_known || found.iter().all(|entry| !entry.is_finite()), "{defect:e}: {found:?}");
        }
        for found in [of_length_one(q), of_length_one_with_rest(q, none).0] {
            let defect_left = length_defect(&found).to_f64();
            assert!(!is_known || defect_left <= 32.0 * T::EPSILON.to_f64(), "{defect:e}: {defect_left:e}");
            assert!(is_known || found.iter().all(|entry| !entry.is_finite()), "{defect:e}: {found:?}");
        }
    }
    for defect in [1e-15, 1e-12, 1e-9, 1e-8, 1e-6, 1e-5, 3e-5] {
        check::<f64>(defect, true);
        check::<f32>(defect, true);
    }
    for defect in [3e-3, 0.1, -0.3, 0.5, 10.0, 1e10] {
        check::<f64>(defect, false);
    }
    for defect in [3e-3, 0.2, -0.3, 0.5, 10.0, 1e10] {
        check::<f32>(defect, false);
    }
}

/// R + δ and q + δ come back as exactly as R and q do, though δ is counted apart. A value on its space keeps its
/// rounding error.
#[test]
fn rests_are_brought_back_too() {
    let rotation = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    let direction = Matrix3::new(1.0, 0.5, -0.25, 0.75, 1.0, 0.5, -1.0, 0.25, 0.5);
    for defect in [1e-13, 1e-8, 1e-4] {
        // a rounding error of the size of the defect: true rounding is too small to be seen
        let (r, rest) = (rotation + direction * defect, direction.transpose() * defect);
        let nearest = nearest_rotation(r + rest);
        let (r, rest) = orthogonal_with_rest(r, rest);
        let error = (r + rest - nearest).amax();
        assert!(error <= 16.0 * defect * defect + 4.0 * f64::EPSILON, "{defect:e}: {error:e}");
        assert!(rest.amax() <= f64::EPSILON / 2.0, "{rest}");

        let (q, rest) = (Vector3::new(0.6, 0.0, -0.8) * (1.0 + defect), Vector3::new(0.25, 0.5, -0.5) * defect);
        let (q, rest) = of_length_one_with_rest(q, rest);
        let error = ((q + rest).norm() - 1.0).abs();
        assert!(error <= 4.0 * defect * defect + 2.0 * f64::EPSILON, "{defect:e}: {error:e}");
        assert!(rest.amax() <= f64::EPSILON / 2.0, "{rest}");
    }
    let rest = direction * 1e-17;
    assert_eq!(orthogonal_with_rest(rotation, rest), (rotation, rest));
    let rest = Vector3::repeat(1e-17);
    assert_eq!(of_length_one_with_rest(Vector3::y(), rest), (Vector3::y(), rest));
}

#[test]
fn rotations_have_no_defect_and_reflections_an_infinite_one() {
    let rotation = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    assert_eq!(orthogonality_defect(&rotation), 0.0);
    assert_eq!(orthogonality_defect(&-rotation), f64::INFINITY);
    assert_eq!(orthogonality_defect(&(rotation * 2.0)), 3.0);
}

#[test]
fn orientations() {
    assert_eq!(orientation_defect(&Matrix2::new(1.25_f64, 0.75, 0.75, 1.25)), 0.0);
    assert_eq!(orientation_defect(&Matrix2::new(0.0, 1.0, 1.0, 0.0)), f64::INFINITY);
    assert_eq!(orientation_defect(&Matrix2::<f64>::zeros()), f64::INFINITY);
}

#[test]
fn the_largest_number_keeps_what_is_none() {
    assert_eq!(largest([1.0, -3.0, 2.0]), 3.0);
    assert_eq!(largest::<f64, 0>([]), 0.0);
    for values in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
        assert!(largest(values).is_nan());
    }
    assert_eq!(largest([1.0, f64::INFINITY, 2.0]), f64::INFINITY);
}

#[test]
fn lengths_are_squared() {
    assert_eq!(length_defect(&Vector3::new(0.0, 3.0, 0.0)), 8.0);
}

/// The defect does not depend on the size of a matrix, and the entries above the diagonal decide.
#[test]
fn matrices_become_symmetric() {
    let above = Matrix3::new(2.0, 0.5, -1.0, 0.5, 3.0, 0.25, -1.0, 0.25, 4.0);
    let off = above + Matrix3::new(0.0, 0.0, 0.0, 0.125, 0.0, 0.0, 0.0, -0.5, 0.0);
    for scale in [1e-150, 1.0, 1e150] {
        assert_eq!(symmetry_defect(&(off * scale)), 0.125);
        assert_eq!(symmetric(off * scale), above * scale);
        assert_eq!(symmetric_with_rest(off * scale, off), (above * scale, above));
    }
    assert_eq!(symmetry_defect(&above), 0.0);
    assert_eq!(symmetry_defect(&Matrix3::<f64>::zeros()), 0.0);
}

/// Projectors and frames come back to round-off from small and from larger defects, and are NaN where digits are lost.
#[test]
fn projectors_and_frames_come_back() {
    let rotation = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    let columns = rotation.fixed_columns::<2>(0).into_owned();
    let plane = columns * columns.transpose();
    assert_eq!(projector(plane), symmetric(plane));
    assert_eq!(orthogonal(columns), columns);
    let direction = Matrix3::new(1.0, 0.5, -0.25, 0.5, 1.0, 0.75, -0.25, 0.75, 0.5);
    let zero = SMatrix::zeros();
    for defect in [1e-13, 1e-11, 1e-8, 1e-6, 1e-4, 3e-4] {
        let off = plane + direction * defect;
        for found in [projector(off), projector_with_rest(off, zero).0] {
            assert!(projector_defect(&found, 2) < 1e-15 + 8.0 * f64::EPSILON, "{defect:e}: {found}");
        }
        let off = columns + direction.fixed_columns::<2>(0) * defect;
        assert!(orthonormality_defect(&orthogonal(off)) < 8.0 * f64::EPSILON, "{defect:e}");
    }
    for defect in [1e-2, 0.1, 0.5, 1e10] {
        let found = projector(plane + direction * defect);
        assert!(found.iter().all(|entry| !entry.is_finite()), "{defect:e}: {found}");
    }
    assert!(projector(plane.map(|_| f64::NAN)).iter().all(|entry| entry.is_nan()));
    assert_eq!(projector_defect(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 0.0)), 1), 0.0);
    assert_eq!(projector_defect(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 0.0)), 2), 1.0);
}
