//! Rotations of four dimensions by one scalar against the law M = (F J − J Fᵀ)/h, and against the path from the identity.

use super::{Iterated, RotatingBody4, RotationEquation4, solve_rotation_4d};
use crate::implicit::solve;
use crate::runner::proptest;
use crate::{Error, Scalar};
use nalgebra::{Matrix4, SMatrix, SVector};
use proptest::prelude::*;

/// A body in steps of a size.
struct Body<T, const IS_LEFT: bool>(RotatingBody4<T>);

impl<T: Scalar, const IS_LEFT: bool> Body<T, IS_LEFT> {
    fn new(mass: &Matrix4<T>, h: T) -> Self {
        Self(RotatingBody4::new(&inertia(mass), h * T::from_ratio(1, 2)).expect("a body"))
    }
}

impl<T: Scalar, const IS_LEFT: bool> RotationEquation4<T> for Body<T, IS_LEFT> {
    const IS_LEFT: bool = IS_LEFT;

    fn body(&self) -> &RotatingBody4<T> {
        &self.0
    }
}

const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// The skew matrix with these components, below the diagonal.
fn hat<T: Scalar>(v: &SVector<T, 6>) -> Matrix4<T> {
    let mut matrix = Matrix4::from_element(T::zero());
    for (&(i, j), v) in PLANES.iter().zip(v.iter()) {
        (matrix[(j, i)], matrix[(i, j)]) = (*v, -*v);
    }
    matrix
}

fn vee<T: Scalar>(matrix: &Matrix4<T>) -> SVector<T, 6> {
    SVector::from(PLANES.map(|(i, j)| matrix[(j, i)]))
}

/// ΣΩ = JΩ + ΩJ.
fn inertia<T: Scalar>(mass: &Matrix4<T>) -> SMatrix<T, 6, 6> {
    let mut inertia = SMatrix::<T, 6, 6>::from_element(T::zero());
    for k in 0..6 {
        let unit = hat(&SVector::from_fn(|i, _| if i == k { T::one() } else { T::zero() }));
        inertia.set_column(k, &vee(&(mass * unit + unit * mass)));
    }
    inertia
}

/// (1 + X)(1 − X)⁻¹
fn cayley(x: &SVector<f64, 6>) -> Matrix4<f64> {
    let one = Matrix4::identity();
    (one + hat(x)) * (one - hat(x)).try_inverse().expect("regular")
}

/// Moments within a ratio, and axes.
fn bodies(ratio: f64) -> impl Strategy<Value = Matrix4<f64>> {
    let moments = prop::array::uniform4(0.0..1.0_f64);
    (moments, prop::array::uniform6(-1.0..1.0_f64)).prop_map(move |(moments, axes)| {
        let axes = cayley(&SVector::from(axes));
        let moments = moments.map(|moment| ratio.powf(moment));
        let mass = axes * Matrix4::from_diagonal(&moments.into()) * axes.transpose();
        (mass + mass.transpose()) / 2.0
    })
}

/// Both sides: the law of the step, and the solution that is connected to the identity.
fn check<const IS_LEFT: bool>(mass: &Matrix4<f64>, h: f64, mu: &SVector<f64, 6>) -> Result<bool, TestCaseError> {
    let body = Body::<f64, IS_LEFT>::new(mass, h);
    match (solve(&Iterated(&body), mu), solve_rotation_4d(&body, mu)) {
        (Ok(expected), Ok(x)) => {
            // F − I, as F itself rounds small turns away
            let d = hat(&x) * 2.0 * (Matrix4::identity() - hat(&x)).try_inverse().expect("regular");
            let d = if IS_LEFT { d.transpose() } else { d };
            let momentum = vee(&(d * mass - mass * d.transpose())) / if IS_LEFT { -h } else { h };
            let lost = mass.symmetric_eigenvalues().max() / mass.symmetric_eigenvalues().min();
            let room = lost.powi(2) * (1.0 + x.norm_squared());
            prop_assert!(
                (momentum - mu).norm() < 64.0 * room * f64::EPSILON * mu.norm() + f64::MIN_POSITIVE,
                "{momentum} {mu}"
            );
            // how much x moves with the momentum grows as the end of solvability comes near
            let error = (x - expected).norm();
            prop_assert!(error <= 1e-12 * x.norm() || error < 1e-6 && x.norm() > 0.3, "{error:e} of {expected}");
            Ok(true)
        }
        (Err(Error::Unsolvable { .. }), Err(Error::Unsolvable { .. })) => Ok(false),
        (expected, found) => {
            prop_assert!(false, "{expected:?} {found:?}");
            Ok(false)
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Every body, from the shortest steps to the longest that have a solution and beyond, either way in time.
    #[test]
    fn rotations_solve_the_momentum_equation(
        mass in bodies(8.0), direction in prop::array::uniform6(-1.0..1.0_f64), exponent in -12.0..0.3_f64, h in 0.01..2.0_f64,
        back in any::<bool>(),
    ) {
        let h = if back { -h } else { h };
        let velocity = SVector::from(direction) * 10.0_f64.powf(exponent);
        let mu = inertia(&mass) * velocity / h;
        check::<false>(&mass, h, &mu)?;
        check::<true>(&mass, h, &mu)?;
    }

    /// Moments that differ by any factor, one of them as good as nothing.
    #[test]
    fn moments_may_differ(mass in bodies(1e6), direction in prop::array::uniform6(-0.2..0.2_f64)) {
        let mu = inertia(&mass) * SVector::from(direction);
        let body = Body::<f64, false>::new(&mass, 1.0);
        match (solve_rotation_4d(&body, &mu), solve(&Iterated(&body), &mu)) {
            (Ok(x), Ok(expected)) => prop_assert!((x - expected).norm() <= 1e-11 * expected.norm(), "{x} {expected}"),
            (Err(Error::Unsolvable { .. }), Err(Error::Unsolvable { .. })) => {}
            (x, expected) => prop_assert!(false, "{x:?} {expected:?}"),
        }
    }

    /// Units change no bit: inertia and momentum times the same power of two.
    #[test]
    fn units_do_not_matter(mass in bodies(8.0), mu in prop::array::uniform6(-0.2..0.2_f64), power in -900..900_i32) {
        let (mu, unit) = (SVector::from(mu), 2.0_f64.powi(power));
        let plain = solve_rotation_4d(&Body::<f64, false>::new(&mass, 0.25), &mu);
        let other = solve_rotation_4d(&Body::<f64, false>::new(&(mass * unit), 0.25), &(mu * unit));
        prop_assert_eq!(plain.expect("a turn"), other.expect("a turn"));
    }
}

/// Short steps are found by iterations alone, and are those of the scalar equation. These do not contract in long steps, which they leave.
#[test]
fn short_steps_are_iterated() {
    let mass = Matrix4::from_diagonal(&[1.0, 1.5, 2.0, 2.5].into());
    let body = RotatingBody4::new(&inertia(&mass), 0.5).expect("a body");
    let direction = SVector::from([0.3, -0.5, 0.2, 0.6, -0.1, 0.5]);
    for (size, is_short) in [(1e-9, true), (1e-3, true), (0.01, true), (1.0, false), (1e200, false)] {
        let mu = direction * size;
        let ((swept, settled), (found, solved)) = (body.by_sweeps(&mu), body.by_root(&mu));
        assert_eq!(settled, is_short, "{size}");
        if settled {
            assert!(solved && (swept - found).norm() < 8.0 * f64::EPSILON * found.norm(), "{swept} {found}");
        }
    }
    assert!(!body.by_sweeps(&(direction * f64::NAN)).1);
}

/// One moment may be negative where sums are positive: such a body is left to the path from the identity.
#[test]
fn a_negative_moment_is_left_to_newtons_method() {
    let mass = Matrix4::from_diagonal(&[-0.2, 1.0, 1.5, 2.0].into());
    let (body, mu) = (Body::<f64, false>::new(&mass, 0.1), SVector::from([0.4, 0.3, -0.2, 0.5, 0.1, -0.3]));
    assert_eq!(solve_rotation_4d(&body, &mu), solve(&Iterated(&body), &mu));
}

/// Each lane has the bits of a single number, where others take more iterations or have no solution.
#[cfg(feature = "lanes")]
#[test]
fn lanes_are_single_numbers() {
    use crate::{F64x4, Space};
    use num_traits::One;
    let sizes = [1e-6, 0.02, 0.4, 30.0];
    let mass = Matrix4::from_diagonal(&[1.0, 1.5, 2.0, 0.7].into()) + Matrix4::from_element(0.1);
    let direction = SVector::from([0.3, 0.7, -0.4, 0.2, 0.1, -0.5]);
    let all = Body::<F64x4, false>::new(&mass.map(|entry| F64x4::from_lanes(|_| entry)), F64x4::one());
    let mu = direction.map(|entry| F64x4::from_lanes(|lane| sizes[lane] * entry));
    let found = solve_rotation_4d(&all, &mu).expect("three turns");
    let one = Body::<f64, false>::new(&mass, 1.0);
    for (lane, size) in sizes.into_iter().enumerate() {
        match solve_rotation_4d(&one, &(direction * size)) {
            Ok(expected) => assert_eq!(Space::<F64x4>::lane(&found, lane), expected),
            Err(_) => assert!(!Space::<f64>::all_finite(&Space::<F64x4>::lane(&found, lane))),
        }
    }
}
