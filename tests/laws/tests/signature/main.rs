//! Kinetic energies are positive unless `signature = indefinite` says otherwise: every way to make a stepper looks at the inertia.

#![allow(missing_docs)]

mod systems;

use clebsch::{Clebsch, Controlled, Error, F64x4, Guess, Method, Power};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix2, Matrix3, SMatrix, Vector1, Vector2, Vector3};
use proptest::prelude::*;
use systems::*;

const H: f64 = 0.01;

/// The least and the largest eigenvalue.
type Ends = [f64; 2];

/// Nothing if it is accepted, the eigenvalues if it is refused.
fn refused<S>(made: Result<S, Error>) -> Option<Ends> {
    match made {
        Ok(_) => None,
        Err(Error::IndefiniteKineticEnergy { least_eigenvalue, largest_eigenvalue }) => {
            Some([least_eigenvalue, largest_eigenvalue])
        }
        Err(other) => panic!("{other}"),
    }
}

/// The same by the eigenvalues that nalgebra finds.
fn expected<const N: usize>(inertia: &SMatrix<f64, N, N>) -> Option<Ends>
where
    nalgebra::Const<N>: nalgebra::DimSub<nalgebra::U1>,
    nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<nalgebra::DimDiff<nalgebra::Const<N>, nalgebra::U1>>,
{
    let values = inertia.symmetric_eigenvalues();
    (values.min() < 0.0).then(|| [values.min(), values.max()])
}

fn assert_same(found: Option<Ends>, expected: Option<Ends>, near: f64) {
    let same = match (found, expected) {
        (Some(found), Some(expected)) => found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= near),
        (found, expected) => found == expected,
    };
    assert!(same, "{found:?} in place of {expected:?}");
}

/// A symmetric matrix of random signature, regular.
fn of_any_signs(random: &mut Random) -> Matrix3<f64> {
    loop {
        let matrix: Matrix3<f64> = random.matrix();
        let symmetric = matrix + matrix.transpose() + Matrix3::identity() * random.between(-2.0, 2.0);
        if symmetric.symmetric_eigenvalues().iter().all(|value| value.abs() > 0.05) {
            return symmetric;
        }
    }
}

/// Σ = tr(𝕄) I − 𝕄
fn inertia_of(mass_matrix: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * mass_matrix.trace() - mass_matrix
}

#[test]
fn every_stepper_looks_at_the_inertia() {
    let random = &mut Random::new(26);
    let [mut positive, mut others] = [0, 0];
    for _ in 0..200 {
        let inertia = of_any_signs(random);
        let body = Body { inertia };
        let told = expected(&inertia);
        let by = |made: Option<Ends>| assert_same(made, told, 1e-14);
        by(refused(body.stepper(H)));
        by(refused(body.clone().into_stepper(-H)));
        by(refused(body.stepper_by::<Chord>(H)));
        by(refused(body.stepper_by::<Exact>(H)));
        by(refused(body.stepper_by::<Fourth>(H)));
        by(refused(body.stepper_by::<Collocated>(H)));
        by(refused(body.constants(H)));
        by(refused(<Chord as Method<Body<f64>>>::constants(&body, H)));
        by(refused(MomentumAlone { inertia }.stepper(H)));
        let single = Body::<f32> { inertia: inertia.map(|entry| entry as f32) };
        assert_same(refused(single.stepper(H as f32)), told, 1e-5);
        assert!(
            BodyOfAnySigns { inertia }.stepper(H).is_ok() && BodyOfAnySigns { inertia }.stepper_by::<Chord>(H).is_ok()
        );
        *if told.is_none() { &mut positive } else { &mut others } += 1;
    }
    assert!(positive > 20 && others > 20, "{positive} and {others}");
}

#[test]
fn one_lane_is_enough() {
    let lanes = |third: f64| F64x4::from([1.0, 2.0, third, 3.0]);
    let body = |third| Body { inertia: Matrix3::from_diagonal(&Vector3::new(lanes(1.0), lanes(third), lanes(2.0))) };
    assert_eq!(refused(body(1.0).stepper(F64x4::splat(H))), None);
    assert_eq!(refused(body(-4.0).stepper(F64x4::splat(H))), Some([-4.0, 2.0]));
    assert_eq!(refused(Point { mass: lanes(1.0) }.stepper(F64x4::splat(H))), None);
    assert_eq!(refused(Point { mass: lanes(-4.0) }.stepper(F64x4::splat(H))), Some([-4.0, -4.0]));
}

/// Units of the rows change no sign, and moments may differ by 10²⁴.
#[test]
fn units_do_not_matter() {
    let random = &mut Random::new(12);
    for _ in 0..200 {
        let inertia = of_any_signs(random);
        let units = Vector3::from_fn(|_, _| 10.0_f64.powf(random.between(-3.0, 3.0)));
        let units = Matrix3::from_diagonal(&units);
        let scaled = units * inertia * units;
        // the inverse of moments that differ by much more has no digits, which is another error
        let made = Body { inertia: (scaled + scaled.transpose()) / 2.0 }.into_stepper(H);
        assert_eq!(refused(made).is_some(), expected(&inertia).is_some(), "{scaled}");
    }
    for signs in [[1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, 1.0]] {
        let principal = Vector3::new(1e-12, 1.0, 1e12).component_mul(&Vector3::from(signs));
        let made = Body { inertia: Matrix3::from_diagonal(&principal) }.into_stepper(H);
        assert_eq!(refused(made).is_some(), principal.min() < 0.0);
    }
}

/// The inertia has to be positive, not the parameter. An inertia that has no distribution of mass may make ∫ρ₁²dm
/// negative.
#[test]
fn mass_matrices_may_have_negative_eigenvalues() {
    let random = &mut Random::new(7);
    let mut negative = 0;
    for _ in 0..200 {
        let mass_matrix = of_any_signs(random);
        let told = expected(&inertia_of(&mass_matrix));
        if inertia_of(&mass_matrix).determinant().abs() < 1e-3 {
            continue;
        }
        assert_same(refused(BodyOfMasses { mass_matrix }.into_stepper(H)), told, 1e-14);
        negative += usize::from(told.is_none() && expected(&mass_matrix).is_some());
    }
    assert!(negative > 5, "{negative}");
}

#[test]
fn a_forgotten_transpose_is_a_negative_energy() {
    let principal = Vector3::new(1.0, 2.0, 3.0);
    let error = ForgottenTranspose { mass_matrix: Matrix3::from_diagonal(&principal) }.into_stepper(H).err();
    assert_eq!(error, Some(Error::IndefiniteKineticEnergy { least_eigenvalue: -5.0, largest_eigenvalue: -3.0 }));
    let message = error.map(|error| error.to_string()).unwrap_or_default();
    assert!(
        message.starts_with("the kinetic energy is negative for every velocity") && message.contains("`.transpose()`")
    );
    assert!(ForgottenTranspose::DERIVATION.contains(
        "It is negative definite for positive parameters and positive definite matrices, and `stepper()` refuses it without `signature = indefinite`."
    ));
}

/// Σ has the eigenvalues μᵢ + μⱼ, i < j.
#[test]
fn matrix_code_looks_too() {
    let random = &mut Random::new(5);
    for _ in 0..20 {
        let matrix: SMatrix<f64, 5, 5> = random.matrix();
        let mass = matrix + matrix.transpose() + SMatrix::identity() * random.between(0.0, 3.0);
        let mut values: Vec<f64> = mass.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        let [least, largest] = [values[0] + values[1], values[3] + values[4]];
        let told = (least < 0.0).then_some([least, largest]);
        assert_same(refused(Large { mass }.into_stepper(H)), told, 1e-13);
    }
}

#[test]
fn other_kinds_of_systems_look_too() {
    assert_eq!(refused(Point { mass: 2.0 }.into_stepper(H)), None);
    assert_eq!(refused(Point { mass: -2.0 }.into_stepper(H)), Some([-2.0, -2.0]));
    assert_eq!(refused(Point { mass: -2.0_f32 }.into_stepper(0.01)), Some([-2.0, -2.0]));
    assert_eq!(refused(Relativistic { mass: 1.5 }.into_stepper(H)), None);
    assert_eq!(refused(Relativistic { mass: -1.5 }.into_stepper(H)), Some([-1.5, -1.5]));
    assert_eq!(refused(Ring { mass: [1.0, 2.0, 3.0, 4.0] }.into_stepper(H)), None);
    assert_eq!(refused(Ring { mass: [1.0, 2.0, -3.0, 4.0] }.into_stepper(H)), Some([-3.0, -3.0]));
    let steered = |off: f64| Steered { mass: Matrix2::new(1.0, off, off, 1.0) };
    assert_eq!(refused(steered(0.5).control(H)), None);
    assert_same(refused(steered(2.0).control(H)), Some([-1.0, 3.0]), 1e-15);
    assert_same(refused(steered(2.0).stepper(H)), Some([-1.0, 3.0]), 1e-15);
}

#[test]
fn states_look_where_the_inertia_changes_with_the_time() -> Result<(), Error> {
    let stepper = Rocket { mass: 3.0, rate: 1.0 }.into_stepper(H)?;
    let (x, mu) = (Vector1::new(0.0), Vector1::new(1.0));
    assert!(stepper.state(x, mu).is_ok() && stepper.state_at(2.0, x, mu).is_ok());
    assert_same(refused(stepper.state_at(5.0, x, mu)), Some([-2.0, -2.0]), 1e-13);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Where the inertia depends on the configuration it is looked at in every state that is made, and in no step.
    #[test]
    fn states_look_where_the_inertia_moves(mass in 0.5_f64..4.0, radius in 0.5_f64..2.0, part in 0.01_f64..0.99, beyond in 0.01_f64..2.0) {
        let stepper = Hole { mass, hole: radius * radius }.into_stepper(H)?;
        let [outside, edge, inside] = [radius + beyond, radius, part * radius].map(|x| Vector2::new(x, 0.0));
        let none = Vector2::zeros();
        prop_assert!(stepper.state(outside, none).is_ok() && stepper.state(edge, none).is_ok());
        let told = Some([mass * (inside.x * inside.x - radius * radius), mass]);
        let same = |found| assert_same(found, told, 1e-12);
        same(refused(stepper.system().check_kinetic_energy(0.0, &inside)));
        same(refused(stepper.state(inside, none)));
        same(refused(stepper.staggered_state(inside, none)));
        same(refused(stepper.cotangent_state(inside, none)));
        let boundary = stepper.boundary();
        let mut path = [boundary.rest(&outside); 8];
        same(refused(boundary.solve(&inside, &outside, Guess::Geodesic, &mut path)));
        same(refused(boundary.solve(&outside, &inside, Guess::Geodesic, &mut path)));
        // three radii a second, along the first axis alone
        let start = stepper.state(outside, Vector2::new(-3.0 * mass * radius, 0.0))?;
        // the inertia of a step is the mean of those at its ends: where that has changed its sign, no short step leads there
        let next = outside.x - 3.0 * radius * H;
        let mean = (outside.x * outside.x + next * next) / 2.0 - radius * radius;
        match stepper.step(&start) {
            Ok(_) => {}
            Err(Error::Unsolvable { .. }) => prop_assert!(mean < 1e-9 * radius * radius, "{}", mean),
            Err(error) => prop_assert!(false, "{}", error),
        }
        let stepper = HoleOfAnySigns { mass, hole: radius * radius }.into_stepper(H)?;
        prop_assert!(stepper.state(inside, none).is_ok());
    }

    #[test]
    fn sites_look_where_their_inertia_changes_with_the_time(masses in prop::array::uniform3(0.5_f64..3.0), t in 0.0_f64..4.0) {
        let stepper = Rockets { mass: masses }.into_stepper(H)?;
        let (x, mu) = ([Vector1::new(0.0); 3], [Vector1::new(1.0); 3]);
        let least = masses.map(|mass| mass - t).into_iter().find(|mass| *mass < 0.0);
        let told = least.map(|mass| [mass, mass]);
        assert_same(refused(stepper.system().power_check_kinetic_energy(t, &x)), told, 1e-12);
        assert_same(refused(stepper.state_at(t, x, mu)), told, 1e-12);
    }
}

/// A quadratic form takes the symmetric part of its matrix: the other part does nothing.
#[test]
fn antisymmetric_parts_do_nothing_to_a_quadratic_form() -> Result<(), Error> {
    assert!(Coupled::DERIVATION.contains("Only the symmetric part of mass enters."));
    let random = &mut Random::new(3);
    for _ in 0..100 {
        let symmetric = of_any_signs(random);
        let matrix: Matrix3<f64> = random.matrix();
        let skew = matrix - matrix.transpose();
        let made = Coupled { mass: symmetric + skew }.into_stepper(H);
        let told = expected(&symmetric);
        if told.is_some() {
            assert_same(refused(made), told, 1e-13);
            continue;
        }
        let stepper = made?;
        let start = stepper.state(Matrix3::identity(), random.vector::<3>() * 0.05)?;
        let plain = Coupled { mass: symmetric }.into_stepper(H)?;
        let [end, alike] =
            [stepper.advance(&start, 10)?, plain.advance(&plain.state(Matrix3::identity(), start.momentum())?, 10)?];
        assert_near(end.configuration(), alike.configuration(), 1e-13, "q");
        assert_near(&end.momentum(), &alike.momentum(), 1e-13, "N");
    }
    Ok(())
}

#[test]
fn antisymmetric_parts_that_would_change_a_step_are_refused() {
    assert!(Twisted::DERIVATION.contains("mass_matrix has to be symmetric"));
    let mut mass_matrix = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    assert!(Twisted { mass_matrix }.into_stepper(H).is_ok());
    mass_matrix[(0, 1)] = 0.25;
    let error = Twisted { mass_matrix }.into_stepper(H).err();
    assert!(matches!(error, Some(Error::NotSymmetric { field: "mass_matrix", defect, .. }) if defect == 0.25));
    mass_matrix[(1, 0)] = 0.25;
    assert!(Twisted { mass_matrix }.into_stepper(H).is_ok());
}

/// A body whose energy has both signs is stepped as every other one.
#[test]
fn energies_of_both_signs_are_conserved() -> Result<(), Error> {
    let stepper =
        BodyOfAnySigns { inertia: Matrix3::from_diagonal(&Vector3::new(1.0, -2.0, 3.0)) }.into_stepper(1e-3)?;
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.3, 0.5, -0.4))?;
    let end = stepper.advance(&start, 1000)?;
    assert!((stepper.energy(&end) - stepper.energy(&start)).abs() < 1e-7);
    assert!((end.momentum().norm() - start.momentum().norm()).abs() < 1e-12);
    Ok(())
}
