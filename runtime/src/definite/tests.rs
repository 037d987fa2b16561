use super::{check_definite, check_definite_at};
use crate::Error;
use nalgebra::{Matrix1, Matrix2, Matrix3, SMatrix, Vector3};
use std::string::{String, ToString};

fn eigenvalues<const N: usize>(inertia: &SMatrix<f64, N, N>) -> Option<[f64; 2]> {
    match check_definite(inertia) {
        Err(Error::IndefiniteKineticEnergy { least_eigenvalue, largest_eigenvalue }) => {
            Some([least_eigenvalue, largest_eigenvalue])
        }
        other => other.map_or_else(|error| panic!("{error}"), |()| None),
    }
}

#[test]
fn signs_are_those_of_the_eigenvalues() {
    assert_eq!(eigenvalues(&Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0))), None);
    assert_eq!(eigenvalues(&Matrix3::from_diagonal(&Vector3::new(1.0, -2.0, 3.0))), Some([-2.0, 3.0]));
    let are = |inertia, least: f64, largest: f64| {
        eigenvalues::<2>(&inertia).is_some_and(|[a, b]| (a - least).abs().max((b - largest).abs()) < 1e-15)
    };
    // positive entries alone
    assert!(are(Matrix2::new(1.0, 2.0, 2.0, 1.0), -1.0, 3.0));
    assert_eq!(eigenvalues(&Matrix1::new(-5.0)), Some([-5.0, -5.0]));
    // a saddle without a diagonal
    assert!(are(Matrix2::new(0.0, 1.0, 1.0, 0.0), -1.0, 1.0));
}

#[test]
fn units_of_rows_do_not_matter() {
    let scaled = |off: f64| Matrix2::new(1e-12, off, off, 1e12);
    assert_eq!(eigenvalues(&scaled(0.999)), None);
    assert!(eigenvalues(&scaled(1.001)).is_some());
    assert_eq!(eigenvalues(&Matrix3::from_diagonal(&Vector3::new(1e-300, 1.0, 1e300))), None);
    assert!(eigenvalues(&Matrix3::from_diagonal(&Vector3::new(-1e-300, 1.0, 1e300))).is_some());
}

#[test]
fn what_is_not_finite_is_left_to_other_checks() {
    assert_eq!(check_definite(&Matrix2::new(f64::NAN, 0.0, 0.0, -1.0)), Ok(()));
    assert_eq!(check_definite(&Matrix1::new(f64::NEG_INFINITY)), Ok(()));
}

/// As of a mass in polar coordinates, whose inertia about the origin vanishes there.
#[test]
fn at_one_configuration_an_inertia_may_be_singular() {
    assert_eq!(check_definite_at(&Matrix2::new(2.0, 0.0, 0.0, 0.0)), Ok(()));
    assert_eq!(check_definite_at(&Matrix2::new(2.0, 0.0, 0.0, -1e-17)), Ok(()));
    assert_eq!(check_definite_at(&Matrix2::<f64>::zeros()), Ok(()));
    assert_eq!(check_definite_at(&Matrix2::new(1.0, 1.0, 1.0, 1.0)), Ok(()));
    let error = check_definite_at(&Matrix2::new(2.0, 0.0, 0.0, -1e-9));
    assert!(
        matches!(error, Err(Error::IndefiniteKineticEnergy { least_eigenvalue, .. }) if (least_eigenvalue + 1e-9).abs() < 1e-13)
    );
}

#[test]
fn messages_tell_an_energy_of_both_signs_from_a_negative_one() {
    let message =
        |inertia: &Matrix2<f64>| check_definite(inertia).map_or_else(|error| error.to_string(), |()| String::new());
    let saddle = message(&Matrix2::new(1.0, 0.0, 0.0, -2.0));
    assert!(saddle.starts_with(
        "the kinetic energy is negative for some velocities (eigenvalues of the inertia from -2.000e0 to 1.000e0)"
    ));
    assert!(
        saddle.contains("signs of masses") && saddle.ends_with("declare `signature = indefinite` where this is meant")
    );
    let negative = message(&Matrix2::new(-1.0, 0.0, 0.0, -2.0));
    assert!(negative.starts_with("the kinetic energy is negative for every velocity"));
    assert!(negative.contains("`.transpose()`") && negative.contains("change the sign"));
}
