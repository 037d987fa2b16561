//! Linear systems, functions of matrices and sums: each law with the rounding that its operations allow.
//!
//! Matrices here have entries up to one, so that sums of products are of order one and are rounded by a few ε.

use crate::arbitrary::{attitude, cases, definite, matrix, unit, vector};
use crate::runner::proptest;
use clebsch::__private as private;
use clebsch::{Error, F64x8, Scalar, Space};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix2, Matrix3, Matrix4, Rotation3, SMatrix, SVector, Vector2, Vector3, Vector4};
use private::Orientation;
use proptest::prelude::*;

/// Some ten roundings of numbers of order one.
const NEAR: f64 = 4e-15;

/// |A x − b| ≤ 8 N² ε |A||x|: the growth of elimination with pivoting in a few unknowns is below 8.
fn is_solved<const N: usize>(a: &SMatrix<f64, N, N>, x: &SVector<f64, N>, b: &SVector<f64, N>) -> bool {
    (a * x - b).amax() <= 8.0 * (N * N) as f64 * f64::EPSILON * (a.amax() * x.amax() + b.amax())
}

/// The same by cofactors, |A x − b| ≤ 72 ε (|A||x| + κ|b|), where κ is the product of the lengths of the columns over |det A|. Cofactors are
/// rounded by some ε of the product of two columns, and divided by the determinant.
fn is_solved_by_cofactors(a: &Matrix3<f64>, x: &Vector3<f64>, b: &Vector3<f64>) -> bool {
    let kappa = a.column_iter().map(|column| column.norm()).product::<f64>() / a.determinant().abs();
    (a * x - b).amax() <= 72.0 * f64::EPSILON * (a.amax() * x.amax() + kappa * b.amax())
}

fn sign(determinant: f64) -> Orientation {
    if determinant > 0.0 { Orientation::POSITIVE } else { Orientation::NEGATIVE }
}

/// Σ aᵏ/(k + shift)! by the terms themselves.
fn series<const N: usize>(a: &SMatrix<f64, N, N>, shift: u32) -> SMatrix<f64, N, N> {
    let mut term = SMatrix::<f64, N, N>::identity() / f64::from((1..=shift).product::<u32>());
    let mut sum = term;
    for k in 1..40 {
        term = term * a / f64::from(k + shift);
        sum += term;
    }
    sum
}

proptest! {
    #![proptest_config(cases(128))]

    #[test]
    fn linear_systems_are_solved_backward_stably(
        a in matrix::<4, 4>(1.0), b in vector::<4>(1.0), c in matrix::<3, 3>(1.0), d in vector::<3>(1.0),
    ) {
        prop_assume!(a.determinant().abs() > 1e-6 && c.determinant().abs() > 1e-6);
        let (x, orientation) = private::solve_dense(&a, &b).expect("regular");
        prop_assert!(is_solved(&a, &x, &b) && orientation == sign(a.determinant()));
        let (x, orientation) = private::solve_dense(&c, &d).expect("regular");
        prop_assert!(is_solved_by_cofactors(&c, &x, &d) && orientation == sign(c.determinant()));
        // det −A = −det A for three rows, and that of a product is the product
        let rows = |a: &Matrix3<f64>| std::array::from_fn(|i| std::array::from_fn(|j| a[(i, j)]));
        let of = |a: &Matrix3<f64>| Orientation::of::<f64, 3>(rows(a)).expect("regular");
        prop_assert_eq!(of(&c) * Orientation::NEGATIVE, of(&-c));
        prop_assert_eq!(Orientation::of(rows(&Matrix3::zeros())), None);
        prop_assert_eq!(of(&c) * of(&c), Orientation::POSITIVE);
    }

    /// Definite systems of both signs, and indefinite ones.
    #[test]
    fn symmetric_systems_are_solved_backward_stably(a in definite::<4>(), shift in -2.0_f64..2.0, b in vector::<4>(1.0)) {
        let shifted = a - SMatrix::identity() * shift;
        for a in [a, -a, shifted] {
            if let Some((x, orientation)) = private::solve_symmetric(&a, &b) {
                prop_assert!(is_solved(&a, &x, &b));
                prop_assert!(orientation == sign(a.determinant()) || a.determinant().abs() < NEAR);
            }
        }
    }

    #[test]
    fn inverses_undo(a in definite::<4>(), turn in attitude(), b in matrix::<3, 3>(1.0)) {
        // condition numbers of at most three
        let inverse = private::invert(&a)?;
        assert_near(&(a * inverse), &Matrix4::identity(), NEAR, "A A⁻¹");
        assert_near(&(private::inverse(&turn) * turn), &Matrix3::identity(), NEAR, "R⁻¹R");
        // b + 4 I is dominated by its diagonal
        let dominated = b + Matrix3::identity() * 4.0;
        assert_near(&(dominated * private::inverse(&dominated)), &Matrix3::identity(), NEAR, "A A⁻¹");
        // two equal rows
        let mut flat = a;
        flat.set_row(3, &a.row(1));
        let is_refused = matches!(private::invert(&flat), Err(Error::SingularKineticEnergy { .. }));
        prop_assert!(is_refused);
    }

    /// Σ = S A S has the signs of A, whatever the units S are (Sylvester's law of inertia).
    #[test]
    fn inertias_are_definite_by_their_eigenvalues(
        a in matrix::<4, 4>(1.0), shift in -1.0_f64..2.0, units in vector::<4>(6.0), kappa in -2.0_f64..2.0,
    ) {
        let a = (a + a.transpose()) / 2.0 + Matrix4::identity() * shift;
        let values = a.symmetric_eigenvalues();
        prop_assume!(values.iter().all(|value| value.abs() > 1e-6));
        match private::check_definite(&a) {
            Err(Error::IndefiniteKineticEnergy { least_eigenvalue, largest_eigenvalue }) => {
                prop_assert!(values.min() < 0.0);
                prop_assert!((least_eigenvalue - values.min()).abs().max((largest_eigenvalue - values.max()).abs()) < 4.0 * NEAR);
            }
            other => prop_assert!(other.is_ok() && values.min() > 0.0),
        }
        // from 10⁻¹² to 10¹²
        let units = units.map(|unit| 10.0_f64.powf(unit));
        let scaled = Matrix4::from_fn(|i, j| units[i] * a[(i, j)] * units[j]);
        prop_assert_eq!(private::check_definite(&scaled).is_ok(), values.min() > 0.0);
        prop_assert_eq!(private::check_definite_at(&a).is_ok(), values.min() > 0.0);
        // singular, with one eigenvalue 0 and the others positive
        let (flat, wide) = (a.fixed_columns::<3>(0) * a.fixed_columns::<3>(0).transpose(), Matrix4::from_element(1.0));
        prop_assert!(private::check_definite_at(&flat).is_ok() && private::check_definite_at(&wide).is_ok());
        let told = Error::IndefiniteKineticEnergy { least_eigenvalue: kappa, largest_eigenvalue: kappa };
        prop_assert_eq!(private::check_definite_uniform(&kappa).err(), (kappa < 0.0).then_some(told));
    }

    /// exp A and φ(A) by their series, for |A| ≤ 3; exp(A) exp(−A) = I; A φ(A) = exp A − I; φ(A)v of any length of A.
    #[test]
    fn exponentials_are_their_series(a in matrix::<3, 3>(1.0), v in vector::<3>(1.0), size in 0.0_f64..1.0) {
        let (found, phi) = (private::exponential(&a), private::phi(&a));
        // e³ is 20: digits of the largest entry
        let near = 40.0 * NEAR;
        assert_near(&found, &series(&a, 0), near, "exp");
        assert_near(&phi, &series(&a, 1), near, "φ");
        assert_near(&private::phi_times(&a, &v), &(phi * v), near, "φ(A)v");
        assert_near(&private::phi_times(&(a * size), &v), &(series(&(a * size), 1) * v), near, "φ(A)v for a small A");
        assert_near(&(found * private::exponential(&-a)), &Matrix3::identity(), 20.0 * near, "exp A exp −A");
        assert_near(&(a * phi), &(found - Matrix3::identity()), near, "Aφ(A)");
    }

    /// The logarithm of a rotation is its angle about its axis, as long as that is below π.
    #[test]
    fn logarithms_are_those_of_rotations(axis in unit(), angle in 0.0_f64..3.0) {
        let turn = Rotation3::from_scaled_axis(axis * angle).into_inner();
        let found = private::logarithm(&turn);
        // the condition number near π is 1/(π − θ), here at most 7
        assert_near(&found, &hat(&(axis * angle)), 40.0 * NEAR, "log");
        assert_near(&private::exponential(&found), &turn, 40.0 * NEAR, "exp log");
        assert_near(&private::motion_logarithm(&turn), &hat(&(axis * angle)), NEAR, "log of a motion");
    }

    /// cos and sin, cosh and sinh, and c_k = 1/k! − s c_{k+2}.
    #[test]
    fn stumpff_functions_are_trigonometric(s in -30.0_f64..30.0) {
        let c: [f64; 8] = std::array::from_fn(|k| private::stumpff(k as u32, s));
        let root = s.abs().sqrt();
        let (even, odd) = if s > 0.0 { (root.cos(), root.sin() / root) } else { (root.cosh(), root.sinh() / root) };
        let near = |found: f64, exact: f64, size: f64| (found - exact).abs() <= 16.0 * f64::EPSILON * (1.0 + root) * size;
        prop_assert!(near(c[0], even, even.abs().max(1.0)) && near(c[1], odd, odd.abs().max(1.0 / (1.0 + root))));
        let mut factorial = 1.0;
        for k in 0..6 {
            prop_assert!(near(c[k], 1.0 / factorial - s * c[k + 2], 1.0 / factorial + (s * c[k + 2]).abs()), "{k}");
            factorial *= k as f64 + 1.0;
        }
    }

    #[test]
    fn the_largest_is_one_of_them(x in vector::<5>(1.0)) {
        let values: [f64; 5] = x.into();
        prop_assert_eq!(private::largest(values), x.amax());
        prop_assert!(private::largest([values[0], f64::NAN, values[1]]).is_nan());
    }

    /// Onto the span of two rows, and of those with a third that depends on them. The projection is in it, nearest to
    /// μ, and the same when made again.
    #[test]
    fn projections_are_orthogonal(a in vector::<4>(1.0), b in vector::<4>(1.0), mu in vector::<4>(1.0), s in -1.0_f64..1.0) {
        prop_assume!((a.norm_squared() * b.norm_squared() - a.dot(&b).powi(2)) > 0.01);
        let rows: [[f64; 4]; 3] = [a.into(), b.into(), (a * s + b * 0.5).into()];
        let found = private::annihilator_projection(&rows, &mu);
        // Gram's matrix by hand; its condition is at most some hundreds
        let gram = Matrix2::new(a.dot(&a), a.dot(&b), a.dot(&b), b.dot(&b));
        let weights = gram.try_inverse().expect("independent") * Vector2::new(a.dot(&mu), b.dot(&mu));
        assert_near(&found, &(a * weights.x + b * weights.y), 1e-12, "the span");
        assert_near(&private::annihilator_projection(&rows, &found), &found, 1e-14, "twice");
        let rest = mu - found;
        prop_assert!(rest.dot(&a).abs() < 1e-13 && rest.dot(&b).abs() < 1e-13);
        prop_assert!((private::annihilator_defect(&rows, &mu) - rest.norm()).abs() < 1e-13);
        prop_assert!(private::annihilator_defect(&rows, &found) < 1e-14);
    }

    /// ½ μ·Σ⁻¹μ, by nalgebra's inverse.
    #[test]
    fn kinetic_energies_are_quadratic(sigma in definite::<3>(), mu in vector::<3>(1.0)) {
        let inverse = sigma.try_inverse().expect("definite");
        let expected = mu.dot(&(inverse * mu)) / 2.0;
        prop_assert!((private::kinetic_energy(&inverse, &mu) - expected).abs() < NEAR);
        prop_assert!((private::kinetic_energy_at(&sigma, &mu) - expected).abs() < NEAR);
        prop_assert_eq!(private::kinetic_energy_at::<f64, 3>(&Matrix3::zeros(), &Vector3::zeros()), 0.0);
        prop_assert_eq!(private::kinetic_energy_at::<f64, 3>(&Matrix3::zeros(), &Vector3::x()), f64::INFINITY);
    }

    /// s + y = s⁺ + r⁺, in lanes as in numbers.
    #[test]
    fn compensated_sums_lose_nothing(s in vector::<3>(1e3), d in vector::<3>(1e-3)) {
        let (sum, rest) = private::accumulate::<f64, _>(&s, &Vector3::zeros(), &d);
        for i in 0..3 {
            prop_assert_eq!(sum[i], s[i] + d[i]);
            // the error is exact: s − s⁺ is, as both are near, and so is the difference to d
            prop_assert_eq!(rest[i], d[i] - (sum[i] - s[i]));
        }
        // whichever is the larger
        prop_assert_eq!(private::accumulate::<f64, _>(&d, &Vector3::zeros(), &s), (sum, rest));
        let lanes = |x: Vector3<f64>| x.map(F64x8::splat);
        let found = private::accumulate::<F64x8, _>(&lanes(s), &lanes(Vector3::zeros()), &lanes(d));
        prop_assert_eq!(found, (lanes(sum), lanes(rest)));
    }
}

/// In lanes each matrix is treated as if it were alone.
#[test]
fn lanes_have_their_own_pivots() {
    let a = Matrix4::from_fn(|i, j| {
        F64x8::from_lanes(|lane| ((i * 7 + j * 3 + lane) % 5) as f64 - if i == j { 9.0 } else { 0.0 })
    });
    let b = Vector4::from_fn(|i, _| F64x8::from_lanes(|lane| (i + lane) as f64));
    let (x, _) = private::solve_dense(&a, &b).expect("dominated by the diagonal");
    for lane in 0..8 {
        let alone = private::solve_dense(&a.map(|entry| entry.lane(lane)), &b.map(|entry| entry.lane(lane)))
            .expect("regular")
            .0;
        assert_eq!(Space::<F64x8>::lane(&x, lane), alone);
    }
}
