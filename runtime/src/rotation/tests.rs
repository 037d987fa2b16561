//! Rotations by one scalar against Newton's method for three unknowns, which follows the path from the identity.

use super::{
    Diagonal, RotatingBody, RotationEquation, Symmetric, Tensor, rotation_of_motion, scalar_of_motion, solve_rotation,
    turn_of_body, turn_of_motion,
};
use crate::implicit::{Equation, solve};
use crate::runner::proptest;
use crate::{Error, Scalar};
use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;

/// A body in steps of a size, by one scalar.
struct Body<T, A, const IS_LEFT: bool, const IS_CAYLEY: bool = false>(RotatingBody<T, A>);

impl<T: Scalar, A: Tensor<T>, const IS_LEFT: bool, const IS_CAYLEY: bool> Body<T, A, IS_LEFT, IS_CAYLEY> {
    fn new(inertia: &Matrix3<T>, h: T) -> Self {
        Self(RotatingBody::new(inertia, h * T::from_ratio(1, 2)).expect("a body"))
    }
}

impl<T: Scalar, A: Tensor<T>, const IS_LEFT: bool, const IS_CAYLEY: bool> RotationEquation<T>
    for Body<T, A, IS_LEFT, IS_CAYLEY>
{
    type Tensor = A;
    const IS_LEFT: bool = IS_LEFT;
    const IS_CAYLEY: bool = IS_CAYLEY;

    fn body(&self) -> &RotatingBody<T, A> {
        &self.0
    }
}

/// hμ = (F𝒥 − 𝒥Fᵀ)^∨ in the Cayley chart, cleared of its denominator: 2Jx/h = μ + (μ·x) x ± μ × x.
struct Reference {
    inertia: Matrix3<f64>,
    h: f64,
    sign: f64,
}

impl Equation<f64, 3> for Reference {
    type Terms = Vector3<f64>;
    type Jacobian = Matrix3<f64>;

    fn prepare(&self, target: &Vector3<f64>) -> Vector3<f64> {
        *target
    }

    fn linearize(&self, mu: &Vector3<f64>, x: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let a = self.inertia * (2.0 / self.h);
        let turned = mu.cross_matrix() * self.sign;
        let jacobian = a - Matrix3::identity() * mu.dot(x) - x * mu.transpose() - turned;
        (a * x - mu - x * mu.dot(x) - turned * x, jacobian)
    }
}

/// The momentum of the velocity 2x/h by the Cayley map: A x ± x × A x + (x·A x) x = μ with A = 2J/h.
struct CayleyReference(Reference);

impl CayleyReference {
    fn momentum(&self, x: &Vector3<f64>) -> Vector3<f64> {
        let image = self.0.inertia * x * (2.0 / self.0.h);
        image + x.cross(&image) * self.0.sign + x * x.dot(&image)
    }
}

impl Equation<f64, 3> for CayleyReference {
    type Terms = Vector3<f64>;
    type Jacobian = Matrix3<f64>;

    fn prepare(&self, target: &Vector3<f64>) -> Vector3<f64> {
        *target
    }

    fn linearize(&self, mu: &Vector3<f64>, x: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let a = self.0.inertia * (2.0 / self.0.h);
        let image = a * x;
        let turned = (x.cross_matrix() * a - image.cross_matrix()) * self.0.sign;
        let jacobian = a + turned + Matrix3::identity() * x.dot(&image) + x * (image + image).transpose();
        (self.momentum(x) - mu, jacobian)
    }
}

/// Both forms of both sides by the Cayley map against the reference; a solution of a momentum beyond the scalar one too.
fn check_cayley<const IS_LEFT: bool>(inertia: &Matrix3<f64>, h: f64, mu: &Vector3<f64>) -> Result<(), TestCaseError> {
    let reference = CayleyReference(Reference { inertia: *inertia, h, sign: if IS_LEFT { -1.0 } else { 1.0 } });
    let found = solve_rotation(&Body::<f64, Symmetric<f64>, IS_LEFT, true>::new(inertia, h), mu);
    match (solve(&reference, mu), found) {
        (Ok(expected), Ok(found)) => {
            let room = 1.0 + expected.norm_squared();
            let error = (found - expected).norm() / (expected.norm() + f64::MIN_POSITIVE);
            prop_assert!(error < 256.0 * f64::EPSILON * room, "{error:e} of {expected}");
            let defect = (reference.momentum(&found) - mu).norm() / (mu.norm() + f64::MIN_POSITIVE);
            prop_assert!(defect < 256.0 * f64::EPSILON * room, "{defect:e}");
        }
        (Err(Error::Unsolvable { .. }), Err(Error::Unsolvable { .. })) => {}
        (expected, found) => prop_assert!(false, "{expected:?} {found:?}"),
    }
    Ok(())
}

/// The angle whose tangent of the half is |x|.
fn angle(x: &Vector3<f64>) -> f64 {
    2.0 * x.norm().atan()
}

/// Moments within a factor of six, and axes.
fn bodies() -> impl Strategy<Value = Matrix3<f64>> {
    let moments = prop::array::uniform3(0.5..3.0_f64);
    (moments, prop::array::uniform3(-3.0..3.0_f64)).prop_map(|(moments, axes)| {
        let axes = *Rotation3::from_scaled_axis(Vector3::from(axes)).matrix();
        let inertia = axes * Matrix3::from_diagonal(&Vector3::from(moments)) * axes.transpose();
        (inertia + inertia.transpose()) / 2.0
    })
}

/// Both forms of both sides against the reference, with the momentum of a rotation by this Gibbs vector.
fn check<const IS_LEFT: bool>(inertia: &Matrix3<f64>, h: f64, mu: &Vector3<f64>) -> Result<(), TestCaseError> {
    let reference = solve(&Reference { inertia: *inertia, h, sign: if IS_LEFT { -1.0 } else { 1.0 } }, mu);
    let found = solve_rotation(&Body::<f64, Symmetric<f64>, IS_LEFT>::new(inertia, h), mu);
    match (reference, found) {
        (Ok(expected), Ok(found)) => {
            // how much the angle moves with the momentum grows as the end of solvability comes near
            let room = 1.0 + angle(&expected).tan().abs().powi(2);
            let error = (found - expected).norm() / (expected.norm() + f64::MIN_POSITIVE);
            prop_assert!(error < 64.0 * f64::EPSILON * room * 12.0, "{error:e} of {expected}");
        }
        (Err(Error::Unsolvable { .. }), Err(Error::Unsolvable { .. })) => {}
        (expected, found) => prop_assert!(false, "{expected:?} {found:?}"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Every body, from the shortest steps to the longest that have a solution and beyond, either way in time.
    #[test]
    fn rotations_are_those_of_newtons_method(
        inertia in bodies(), direction in prop::array::uniform3(-1.0..1.0_f64), exponent in -12.0..0.3_f64, h in 0.01..2.0_f64,
        back in any::<bool>(),
    ) {
        let h = if back { -h } else { h };
        let velocity = Vector3::from(direction) * 10.0_f64.powf(exponent);
        let mu = inertia * velocity / h;
        check::<false>(&inertia, h, &mu)?;
        check::<true>(&inertia, h, &mu)?;
        let tensor = Symmetric::of(&inertia);
        prop_assert_eq!(tensor.matrix(), inertia);
        prop_assert!((tensor.times(&mu) - inertia * mu).norm() <= 4.0 * f64::EPSILON * inertia.norm() * mu.norm());
        // A and −μ for −A and μ: backwards in time it is positive too
        prop_assert!(Body::<f64, Symmetric<f64>, false>::new(&inertia, h).body().determinant() > 0.0);
    }

    /// The same by the Cayley map, from the shortest steps to some turns in one.
    #[test]
    fn rotations_by_the_cayley_map_are_those_of_newtons_method(
        inertia in bodies(), direction in prop::array::uniform3(-1.0..1.0_f64), exponent in -12.0..0.8_f64, h in 0.01..2.0_f64,
        back in any::<bool>(),
    ) {
        let h = if back { -h } else { h };
        let mu = inertia * Vector3::from(direction) * (10.0_f64.powf(exponent) / h);
        check_cayley::<false>(&inertia, h, &mu)?;
        check_cayley::<true>(&inertia, h, &mu)?;
    }

    /// Its scalar settles by itself wherever f is known to increase, up to steps of ten radians.
    #[test]
    fn the_scalar_of_the_cayley_map_settles(
        inertia in bodies(), direction in prop::array::uniform3(-1.0..1.0_f64), exponent in -1.0..1.0_f64, spread in 0.0..1.0_f64,
    ) {
        // balls too: their f increases for the longest steps
        let inertia = Matrix3::identity() + (inertia - Matrix3::identity()) * spread;
        let body = Body::<f64, Symmetric<f64>, false, true>::new(&inertia, 1.0);
        let body = body.body();
        let mu = inertia * Vector3::from(direction).normalize() * (10.0_f64.powf(exponent) * body.unit);
        let increases = mu.norm_squared() * body.deviation <= 3.75;
        prop_assert_eq!(body.cayley_turn(&mu).2, increases);
    }

    /// A diagonal tensor gives the solution that the same numbers give as a symmetric tensor.
    #[test]
    fn principal_axes_are_axes(moments in prop::array::uniform3(0.5..3.0_f64), mu in prop::array::uniform3(-1.0..1.0_f64)) {
        let (inertia, mu) = (Matrix3::from_diagonal(&Vector3::from(moments)), Vector3::from(mu));
        let short = turn_of_body(&Body::<f64, Diagonal<f64>, false>::new(&inertia, 0.3), &mu);
        let long = turn_of_body(&Body::<f64, Symmetric<f64>, false>::new(&inertia, 0.3), &mu);
        prop_assert_eq!(short.expect("a turn"), long.expect("a turn"));
    }

    /// κ = μ·x of a free body is the same after each step, N⁺ = Fᵀμ, and gives the rotation without an iteration.
    #[test]
    fn free_bodies_keep_their_scalar(inertia in bodies(), mu in prop::array::uniform3(-1.0..1.0_f64)) {
        let (body, mut mu) = (Body::<f64, Symmetric<f64>, false>::new(&inertia, 0.3), Vector3::from(mu));
        let kappa = scalar_of_motion(&body, &mu);
        for _ in 0..8 {
            let x = solve_rotation(&body, &mu).expect("a turn");
            let known = rotation_of_motion(&body, kappa, &mu).expect("a turn");
            prop_assert!((known - x).norm() < 1e-14 * x.norm(), "{known} {x}");
            let (w, r) = turn_of_motion(&body, kappa, &mu).expect("a turn");
            prop_assert!((r / w - x).norm() < 1e-14 * x.norm());
            mu += (mu.cross(&x) + x.cross(&x.cross(&mu))) * (2.0 / (1.0 + x.norm_squared()));
        }
        // no scalar: a momentum that is too large has none, and the error of its step
        let large = Vector3::from([40.0, 0.0, 0.0]);
        prop_assert_eq!(scalar_of_motion(&body, &large), 0.0);
        prop_assert!(turn_of_motion(&body, 0.0, &large).is_err());
    }

    /// Units change no bit: inertia and momentum times the same power of two.
    #[test]
    fn units_do_not_matter(inertia in bodies(), mu in prop::array::uniform3(-1.0..1.0_f64), power in -900..900_i32) {
        let (mu, unit) = (Vector3::from(mu), 2.0_f64.powi(power));
        let plain = solve_rotation(&Body::<f64, Symmetric<f64>, false>::new(&inertia, 0.25), &mu);
        let other = solve_rotation(&Body::<f64, Symmetric<f64>, false>::new(&(inertia * unit), 0.25), &(mu * unit));
        prop_assert_eq!(plain.expect("a turn"), other.expect("a turn"));
        let plain = solve_rotation(&Body::<f64, Symmetric<f64>, false, true>::new(&inertia, 0.25), &mu);
        let other = solve_rotation(&Body::<f64, Symmetric<f64>, false, true>::new(&(inertia * unit), 0.25), &(mu * unit));
        prop_assert_eq!(plain.expect("a turn"), other.expect("a turn"));
    }
}

/// A kinetic energy that is not positive has a solution too, by the path from the identity.
#[test]
fn an_indefinite_energy_is_left_to_newtons_method() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, -2.0, 1.5));
    let (h, mu) = (0.1, Vector3::new(0.4, 0.3, -0.2));
    let expected = solve(&Reference { inertia, h, sign: 1.0 }, &mu).expect("a solution");
    let found = solve_rotation(&Body::<f64, Diagonal<f64>, false>::new(&inertia, h), &mu).expect("a solution");
    assert!((found - expected).norm() < 1e-15, "{found} {expected}");
}

/// A body that turns about one axis turns by sin θ = hμ/J up to a right angle, and no further.
#[test]
fn the_end_of_solvability_is_the_right_angle() {
    let body = Body::<f64, Diagonal<f64>, false>::new(&Matrix3::identity(), 1.0);
    for angle in [1.0, 1.2, 1.5, 1.57] {
        let x = solve_rotation(&body, &Vector3::new(0.0, 0.0, f64::sin(angle))).expect("less than a right angle");
        assert!((x.z - (angle / 2.0).tan()).abs() < 1e-12, "{angle}: {x}");
    }
    let beyond = solve_rotation(&body, &Vector3::new(0.0, 0.0, 1.001));
    let Err(Error::Unsolvable { solvable_fraction, .. }) = beyond else { panic!("{beyond:?}") };
    // the path finds its end to a few parts in 10⁵
    assert!((solvable_fraction * 1.001 - 1.0).abs() < 1e-4, "{solvable_fraction}");
}

/// A ball turns by x with |x| (1 + |x|²) = |μ|/a, however large its momentum is: the real root of a cubic.
#[test]
fn balls_turn_by_the_root_of_a_cubic() {
    let body = Body::<f64, Diagonal<f64>, false, true>::new(&Matrix3::identity(), 1.0);
    for tangent in [1e-9, 1e-3, 0.1, 0.5, 1.0, 3.0, 40.0] {
        let mu = Vector3::new(0.6, 0.0, 0.8) * (2.0 * tangent * (1.0 + tangent * tangent));
        let x = solve_rotation(&body, &mu).expect("a turn");
        assert!((x.norm() / tangent - 1.0).abs() < 4.0 * f64::EPSILON, "{tangent}: {x}");
    }
}

/// Free needles turn by a scalar of each momentum. One that is carried along is off by the square of the ratio of the moments.
#[test]
fn needles_keep_no_scalar() {
    let mu = Vector3::new(0.02, 0.05, -0.03);
    let body = |least: f64| {
        Body::<f64, Diagonal<f64>, false>::new(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.9, least)), 0.1)
    };
    assert!(scalar_of_motion(&body(0.01), &(mu * 0.01)) > 0.0);
    let needle = body(1e-6);
    let small = mu * 1e-6;
    let kappa = scalar_of_motion(&needle, &small);
    assert_eq!(kappa, 0.0);
    let (w, x) = turn_of_motion(&needle, kappa, &small).expect("a turn");
    assert_eq!(x / w, solve_rotation(&needle, &small).expect("a turn"));
}

/// Beyond the momentum up to which f is known to increase, Newton's method finds the same rotation.
#[test]
fn the_scalar_ends_without_a_jump() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.5, 1.0, 3.0));
    let body = Body::<f64, Diagonal<f64>, false, true>::new(&inertia, 1.0);
    let direction = Vector3::new(0.2, 0.9, 0.3).normalize();
    let turn = |size: f64| solve_rotation(&body, &(direction * size)).expect("a turn");
    let is_by_scalar = |size: f64| body.body().cayley_turn(&(direction * (size * body.body().unit))).2;
    let (mut low, mut high) = (0.1, 100.0);
    assert!(is_by_scalar(low) && !is_by_scalar(high));
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if is_by_scalar(middle) { low = middle } else { high = middle }
    }
    assert!((1.0..4.0).contains(&low), "{low}");
    assert!((turn(low) - turn(high)).norm() < 64.0 * f64::EPSILON, "{}, {}", turn(low), turn(high));
}

#[test]
fn what_is_not_finite_is_an_error() {
    let body = Body::<f64, Symmetric<f64>, false>::new(&Matrix3::identity(), 1.0);
    for mu in [f64::NAN, f64::INFINITY, 1e300] {
        let found = solve_rotation(&body, &Vector3::new(0.0, mu, 0.0));
        assert!(matches!(found, Err(Error::NotFinite { .. } | Error::Unsolvable { .. })), "{found:?}");
    }
    assert_eq!(solve_rotation(&body, &Vector3::zeros()), Ok(Vector3::zeros()));
}

#[test]
fn a_body_without_a_moment_is_refused() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 2.0));
    let made = RotatingBody::<f64, Diagonal<f64>>::new(&inertia, 0.1);
    assert!(matches!(made, Err(Error::SingularKineticEnergy { .. })), "{made:?}");
}

/// In single precision the series ends sooner and the angle is right to its own rounding.
#[test]
fn single_precision_is_right_to_its_rounding() {
    for size in [1e-4_f32, 1e-2, 0.1, 0.5] {
        let (inertia, mu) = (Vector3::new(1.0_f32, 2.0, 2.5), Vector3::new(0.3_f32, 0.7, -0.4) * size);
        let found =
            solve_rotation(&Body::<f32, Diagonal<f32>, false>::new(&Matrix3::from_diagonal(&inertia), 1.0), &mu);
        let inertia = Matrix3::from_diagonal(&inertia.map(f64::from));
        let expected = solve(&Reference { inertia, h: 1.0, sign: 1.0 }, &mu.map(f64::from)).expect("a solution");
        let error = (found.expect("a solution").map(f64::from) - expected).norm() / expected.norm();
        assert!(error < 4.0 * f64::from(f32::EPSILON), "{size}: {error:e}");
        let inertia = Matrix3::from_diagonal(&Vector3::new(1.0_f32, 2.0, 2.5));
        let found = solve_rotation(&Body::<f32, Diagonal<f32>, false, true>::new(&inertia, 1.0), &mu);
        let reference = CayleyReference(Reference { inertia: inertia.map(f64::from), h: 1.0, sign: 1.0 });
        let expected = solve(&reference, &mu.map(f64::from)).expect("a solution");
        let error = (found.expect("a solution").map(f64::from) - expected).norm() / expected.norm();
        assert!(error < 4.0 * f64::from(f32::EPSILON), "by the Cayley map {size}: {error:e}");
    }
}

/// By the Cayley map every step has a solution, in single precision too: up to a hundred million radians.
#[test]
fn single_precision_turns_by_long_steps() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0_f32, 2.0, 3.0));
    let body = Body::<f32, Diagonal<f32>, false, true>::new(&inertia, 1.0);
    let reference = CayleyReference(Reference { inertia: inertia.map(f64::from), h: 1.0, sign: 1.0 });
    for exponent in 0..=32 {
        for direction in [Vector3::new(0.3_f32, 2.0, 0.6), Vector3::new(-0.5, 0.1, 0.9), Vector3::new(1.0, 1.0, -1.0)] {
            let mu = direction * 10.0_f32.powf(exponent as f32 / 4.0);
            let x = solve_rotation(&body, &mu).expect("a turn").map(f64::from);
            let defect = (reference.momentum(&x) - mu.map(f64::from)).norm() / f64::from(mu.norm());
            assert!(defect < 2e-5, "{mu}: {defect:e}");
        }
    }
}

/// Each lane has the bits of a single number, where others have another way to it or none.
#[cfg(feature = "lanes")]
#[test]
fn lanes_are_single_numbers() {
    check_lanes::<false>();
    check_lanes::<true>();
}

#[cfg(feature = "lanes")]
fn check_lanes<const IS_CAYLEY: bool>() {
    use crate::{F64x4, Space};
    use num_traits::One;
    let sizes = [1e-6, 0.02, 0.4, 3.0];
    let inertia = Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.5, -0.2, 0.0, -0.2, 2.0);
    let direction = Vector3::new(0.3, 0.7, -0.4);
    let wide = inertia.map(|entry| F64x4::from_lanes(|_| entry));
    let all = Body::<F64x4, Symmetric<F64x4>, false, IS_CAYLEY>::new(&wide, F64x4::one());
    let mu = direction.map(|entry| F64x4::from_lanes(|lane| sizes[lane] * entry));
    let found = solve_rotation(&all, &mu).expect("three turns");
    let one = Body::<f64, Symmetric<f64>, false, IS_CAYLEY>::new(&inertia, 1.0);
    for (lane, size) in sizes.into_iter().enumerate() {
        match solve_rotation(&one, &(direction * size)) {
            Ok(expected) => assert_eq!(Space::<F64x4>::lane(&found, lane), expected),
            Err(_) => assert!(!Space::<f64>::all_finite(&Space::<F64x4>::lane(&found, lane))),
        }
    }
}
