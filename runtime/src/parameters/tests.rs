use super::{annihilator_defect, annihilator_projection, check_diagonal, check_symmetric, check_unit, invert};
use crate::Error;
use nalgebra::{Matrix3, Vector3};

#[test]
fn promises_are_checked() {
    assert_eq!(check_diagonal("j", &Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0))), Ok(()));
    let tilted = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, -0.5, 0.0, 0.0, 1.0);
    assert_eq!(check_diagonal("j", &tilted), Err(Error::NotDiagonal { field: "j", defect: 0.5 }));
    assert_eq!(check_unit("e", &Vector3::new(0.6, 0.0, 0.8)), Ok(()));
    assert_eq!(check_unit("e", &Vector3::new(0.0, 2.0, 0.0)), Err(Error::NotUnit { field: "e", length: 2.0 }));
}

#[test]
fn inertia_ratios_do_not_matter_but_degeneracy_does() {
    let principal = Matrix3::from_diagonal(&Vector3::new(1e-6, 1.0, 1e6));
    assert_eq!(invert(&principal), Ok(Matrix3::from_diagonal(&Vector3::new(1e6, 1.0, 1e-6))));
    let flat = Matrix3::new(1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    assert!(matches!(invert(&flat), Err(Error::SingularKineticEnergy { .. })));
    let nearly = Matrix3::new(1.0, 1.0, 0.0, 1.0, 1.0 + f64::EPSILON, 0.0, 0.0, 0.0, 1.0);
    assert!(matches!(invert(&nearly), Err(Error::SingularKineticEnergy { condition }) if condition > 1e15));
    assert!(matches!(invert(&(f64::NAN * principal)), Err(Error::SingularKineticEnergy { .. })));
}

#[test]
fn symmetry_is_relative() {
    let mut matrix = Matrix3::from_element(1e200);
    matrix[(0, 1)] *= 1.0 + 1e-15;
    assert_eq!(check_symmetric("inertia", &matrix), Ok(()));
    matrix[(0, 1)] *= 1.0 + 1e-9;
    assert!(matches!(check_symmetric("inertia", &matrix), Err(Error::NotSymmetric { field: "inertia", .. })));
    assert_eq!(check_symmetric("inertia", &Matrix3::<f32>::zeros()), Ok(()));
}

#[test]
fn momenta_of_a_point_on_the_sphere_are_orthogonal_to_it() {
    // 𝔤_q^⊥ for rotations of q = e3 is spanned by q × e1, q × e2; the third row depends on them.
    let rows = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [-3.0, 2.0, 0.0]];
    assert_eq!(annihilator_defect(&rows, &Vector3::new(1.0, -2.0, 0.0)), 0.0);
    assert_eq!(annihilator_defect(&rows, &Vector3::new(1.0, -2.0, 0.25)), 0.25);
    assert_eq!(annihilator_defect(&rows.map(|row| row.map(|x| x * 1e-200)), &Vector3::new(1e200, 0.0, 1e200)), 1e200);
    assert_eq!(annihilator_defect(&[[0.0; 3]; 0], &Vector3::new(3.0, 4.0, 0.0)), 5.0);
}

/// A component along q that is 10¹² times the others leaves no more than their round-off.
#[test]
fn projected_momenta_are_those_of_motions() {
    let q = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    let rows = [Vector3::x(), Vector3::y(), Vector3::z()].map(|e| q.cross(&e).into());
    let tangential = q.cross(&Vector3::new(0.3, 0.4, 1.2));
    let projected = annihilator_projection(&rows, &(tangential + q * 1e12));
    assert!(annihilator_defect(&rows, &projected) < 1e-15 && (projected - tangential).amax() < 1e-3);
    assert!((annihilator_projection(&rows, &tangential) - tangential).amax() < 1e-15);
    let exact = [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    assert_eq!(annihilator_projection(&exact, &Vector3::new(0.1, 0.7, -3.0)), Vector3::new(0.1, 0.7, 0.0));
    assert_eq!(annihilator_projection(&[[0.0; 3]; 0], &tangential), Vector3::zeros());
    assert!(annihilator_projection(&rows, &Vector3::new(f64::NAN, 0.0, 0.0)).x.is_nan());
}
