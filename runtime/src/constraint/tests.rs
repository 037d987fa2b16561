//! The rank of metrics, and momenta on constraints, against values by hand.

use super::{constrained, rank, violation};
use crate::Error;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2, Vector3};

#[test]
fn ranks_do_not_depend_on_units() {
    assert_eq!(rank(Matrix3::<f64>::from_diagonal(&Vector3::new(1e-12, 1.0, 1e12))), 3);
    assert_eq!(rank(Matrix3::<f64>::from_diagonal(&Vector3::new(1.0, 0.0, 2.0))), 2);
    assert_eq!(rank(Matrix2::<f64>::new(1.0, 1e6, 1e6, 1e12)), 1);
    assert_eq!(rank(Matrix2::<f64>::new(1.0, 0.999, 0.999, 1.0)), 2);
    assert_eq!(rank(Matrix2::<f64>::from_element(f64::NAN)), 0);
    assert_eq!(rank(Matrix3::<f64>::zeros()), 0);
}

#[test]
fn momenta_come_to_the_constraint() {
    // masses 1, 2 and 4, with v_x = 3 and v_y − v_z = 1
    let a = Matrix2x3::new(1.0, 0.0, 0.0, 0.0, 1.0, -1.0);
    let b = Vector2::new(3.0, 1.0);
    let metric = Matrix2::new(1.0, 0.0, 0.0, 0.75);
    let mu = Vector3::new(0.0, 0.0, 0.0);
    let found = constrained(&mu, &a, &Vector3::zeros(), &b, &metric).unwrap();
    // κ = (3, 4/3), so that μ = (3, 4/3, −4/3) and the velocity is (3, 2/3, −1/3)
    assert!((found - Vector3::new(3.0, 4.0 / 3.0, -4.0 / 3.0)).norm() < 1e-15);
    let velocity = Vector3::new(found.x, found.y / 2.0, found.z / 4.0);
    assert!(violation(&found, &a, &velocity, &b, &metric).unwrap().check().is_ok());
    let missing = violation(&mu, &a, &Vector3::zeros(), &b, &metric).unwrap();
    assert_eq!((missing.largest, missing.size), (3.0, 3.0));
    assert!(matches!(missing.check(), Err(Error::ConstraintViolated { violation: 3.0, .. })));
}

#[test]
fn dependent_rows_are_refused_with_their_rank() {
    let a = Matrix2x3::new(1.0, 2.0, 0.0, 2.0, 4.0, 0.0);
    let metric = a * a.transpose();
    let zero = Vector3::zeros();
    let refused = Err(Error::DependentConstraints { rank: 1, rows: 2 });
    assert_eq!(constrained(&zero, &a, &zero, &Vector2::zeros(), &metric), refused);
    assert!(violation(&zero, &a, &zero, &Vector2::zeros(), &metric).is_err());
}
