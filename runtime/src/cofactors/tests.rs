//! Solutions by cofactors against elimination.

use crate::linear::solve_dense;
use crate::orientation::Orientation;
use crate::runner::proptest;
use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector3, Vector6};
use proptest::prelude::*;

fn solve<const M: usize>(a: &SMatrix<f64, M, M>, b: &SVector<f64, M>) -> Option<(SVector<f64, M>, Orientation)> {
    let (x, orientation, known) = super::solve(a, b);
    known.then_some((x, orientation))
}

#[test]
fn six_unknowns_in_two_halves() {
    let a = Matrix6::from_fn(|i, j| if i == j { -4.0 } else { 1.0 / (1 + i + 2 * j) as f64 });
    let x = Vector6::new(1.0, -2.0, 3.0, -4.0, 5.0, -6.0);
    let (solution, orientation) = solve(&a, &(a * x)).expect("a regular matrix");
    assert!((solution - x).amax() < 1e-14 && orientation == Orientation::POSITIVE);
    let (_, mirrored) = solve(&Matrix6::from_rows(&[5, 1, 2, 3, 4, 0].map(|i| a.row(i))), &x).unzip();
    assert!(mirrored.is_none_or(|orientation| orientation == Orientation::NEGATIVE));
}

/// Singular, nearly so, not finite, and near the ends of the exponent range.
#[test]
fn what_is_not_safe_is_left_to_elimination() {
    let regular = Matrix3::new(2.0, 1.0, 0.0, 1.0, 3.0, 1.0, 0.0, 1.0, 4.0);
    let b = Vector3::new(1.0, 2.0, 3.0);
    assert!(solve(&regular, &b).is_some());
    let nearly = Matrix3::from_columns(&[b, b * 2.0, b]) + Matrix3::identity() * 1e-6;
    for unsafe_one in [Matrix3::zeros(), nearly, regular * f64::NAN, regular * f64::INFINITY] {
        assert_eq!(solve(&unsafe_one, &b), None);
    }
    for scale in [2.0_f64.powi(-1000), 2.0_f64.powi(-350), 2.0_f64.powi(350), 2.0_f64.powi(1000)] {
        assert_eq!(solve(&(regular * scale), &b), None);
        let (x, orientation) = solve_dense(&(regular * scale), &(b * scale)).expect("a regular matrix");
        assert!((regular * x - b).amax() < 1e-14 && orientation == Orientation::POSITIVE);
    }
}

fn agrees<const M: usize>(a: SMatrix<f64, M, M>, b: SVector<f64, M>) -> Result<(), TestCaseError> {
    let Some((x, orientation)) = solve(&a, &b) else { return Ok(()) };
    let rows: [[f64; M]; M] = core::array::from_fn(|i| core::array::from_fn(|j| a[(i, j)]));
    prop_assert_eq!(Some(orientation), Orientation::of(rows));
    let size: f64 = (0..M).map(|j| a.column(j).amax() * x[j].abs()).sum();
    prop_assert!((a * x - b).amax() <= 65536.0 * f64::EPSILON * (size + b.amax()));
    Ok(())
}

proptest! {
    /// Of any matrix, with columns of very different size too.
    #[test]
    fn three_unknowns_as_by_elimination(
        a in prop::array::uniform9(-1.0_f64..1.0),
        b in prop::array::uniform3(-1.0_f64..1.0),
        sizes in prop::array::uniform3(-9..9_i32),
    ) {
        let columns = Matrix3::from_diagonal(&Vector3::from(sizes.map(|size| 10.0_f64.powi(size))));
        agrees(Matrix3::from_iterator(a) * columns, b.into())?;
    }

    #[test]
    fn six_unknowns_as_by_elimination(
        a in prop::array::uniform32(-1.0_f64..1.0),
        b in prop::array::uniform6(-1.0_f64..1.0),
        shift in -4.0_f64..4.0,
    ) {
        let a = Matrix6::from_fn(|i, j| a[(7 * i + j) % 32]) + Matrix6::identity() * shift;
        agrees(a, b.into())?;
    }
}
