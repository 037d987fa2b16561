//! Small matrices and what generated code makes of them: each law with the rounding that its operations allow.
//!
//! Matrices here have entries up to one, so that sums of products are of order one and are rounded by a few ε.

use crate::arbitrary::{attitude, cases, definite, matrix, rotation, unit, vector};
use clebsch::__private as private;
use clebsch::{Error, F64x8, Scalar, Space};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix3, Matrix4, Quaternion, Rotation3, SMatrix, SVector, UnitQuaternion, Vector2, Vector3, Vector4};
use private::Orientation;
use proptest::prelude::*;

/// Some ten roundings of numbers of order one.
const NEAR: f64 = 4e-15;

/// |A x − b| ≤ 8 N² ε |A||x|: the growth of elimination with pivoting in a few unknowns is below 8.
fn is_solved<const N: usize>(a: &SMatrix<f64, N, N>, x: &SVector<f64, N>, b: &SVector<f64, N>) -> bool {
    (a * x - b).amax() <= 8.0 * (N * N) as f64 * f64::EPSILON * (a.amax() * x.amax() + b.amax())
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
        for (solved, orientation) in [private::solve_dense(&a, &b).map(|(x, sign)| (is_solved(&a, &x, &b), sign))].into_iter().flatten() {
            prop_assert!(solved);
            prop_assert!(orientation == sign(a.determinant()) || a.determinant().abs() < NEAR);
        }
        let (x, orientation) = private::solve_dense(&c, &d).expect("regular");
        prop_assert!(is_solved(&c, &x, &d));
        prop_assert!(orientation == sign(c.determinant()) || c.determinant().abs() < NEAR);
        // det −A = −det A for three rows, and that of a product is the product
        let rows = |a: &Matrix3<f64>| std::array::from_fn(|i| std::array::from_fn(|j| a[(i, j)]));
        let of = |a: &Matrix3<f64>| Orientation::of::<f64, 3>(rows(a)).expect("regular");
        prop_assert_eq!(of(&c) * Orientation::NEGATIVE, of(&-c));
        prop_assert_eq!(Orientation::of(rows(&Matrix3::zeros())), None);
        prop_assert!(of(&(c * c)) == Orientation::POSITIVE || c.determinant().abs() < 1e-7);
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

    /// exp A and φ(A) by their series, for |A| ≤ 3; exp(A) exp(−A) = I; A φ(A) = exp A − I.
    #[test]
    fn exponentials_are_their_series(a in matrix::<3, 3>(1.0)) {
        let (found, phi) = (private::exponential(&a), private::phi(&a));
        // e³ is 20: digits of the largest entry
        let near = 40.0 * NEAR;
        assert_near(&found, &series(&a, 0), near, "exp");
        assert_near(&phi, &series(&a, 1), near, "φ");
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

    /// Brought back by one step of Newton and Schulz, whose error is the square of the defect; what is on its space already stays to the bit.
    #[test]
    fn what_has_left_its_space_comes_back(r in attitude(), q in unit(), off in matrix::<3, 3>(1.0), size in -12.0_f64..-4.0) {
        let defect = 10.0_f64.powf(size);
        let near = 16.0 * defect * defect + NEAR;
        let moved = r + off * defect;
        prop_assert!(private::orthogonality_defect(&r) < NEAR);
        let found = private::orthogonality_defect(&moved);
        let expected = (moved.transpose() * moved - Matrix3::identity()).amax();
        prop_assert!((found - expected).abs() < NEAR);
        // of corrections that are made: |Re|² sees some directions of the defect only
        let back = private::orthogonal(moved);
        if back != moved {
            prop_assert!(private::orthogonality_defect(&back) < near);
        }
        prop_assert_eq!(private::orthogonality_defect(&-r), f64::INFINITY);
        prop_assert_eq!((private::orientation_defect(&r), private::orientation_defect(&-r)), (0.0, f64::INFINITY));
        let longer = q * (1.0 + defect);
        prop_assert!((private::length_defect(&longer) - (longer.norm_squared() - 1.0).abs()).abs() < NEAR);
        prop_assert!(private::length_defect(&private::of_length_one(longer)) < near);
        prop_assert_eq!(private::of_length_one(q), q);
    }

    #[test]
    fn the_largest_is_one_of_them(x in vector::<5>(1.0)) {
        let values: [f64; 5] = x.into();
        prop_assert_eq!(private::largest(values), x.amax());
        prop_assert!(private::largest([values[0], f64::NAN, values[1]]).is_nan());
    }

    /// What is promised of a field is accepted, and what is off by more than rounding is refused with its size.
    #[test]
    fn promises_of_fields_are_checked(a in definite::<3>(), e in unit(), i in 0_usize..3, j in 0_usize..2, off in 1e-6_f64..1.0) {
        let j = (i + 1 + j) % 3;
        let mut skewed = a;
        skewed[(i, j)] += off;
        prop_assert_eq!(private::check_symmetric("a", &a), Ok(()));
        let is_refused = matches!(private::check_symmetric("a", &skewed), Err(Error::NotSymmetric { field: "a", defect, .. }) if (defect - off).abs() < NEAR);
        prop_assert!(is_refused);
        let diagonal = Matrix3::from_diagonal(&a.diagonal());
        prop_assert_eq!(private::check_diagonal("a", &diagonal), Ok(()));
        let mut tilted = diagonal;
        tilted[(i, j)] = -off;
        prop_assert_eq!(private::check_diagonal("a", &tilted), Err(Error::NotDiagonal { field: "a", defect: off }));
        prop_assert_eq!(private::check_unit("e", &e), Ok(()));
        let is_refused = matches!(private::check_unit("e", &(e * (1.0 + off))), Err(Error::NotUnit { field: "e", length }) if (length - 1.0 - off).abs() < NEAR);
        prop_assert!(is_refused);
        prop_assert_eq!(private::check_finite("a", &a), Ok(()));
        tilted[(j, i)] = f64::NAN;
        prop_assert_eq!(private::check_finite::<f64>("a", &tilted), Err(Error::NotFinite { name: "a" }));
    }

    /// Onto the span of two rows, and of those with a third that depends on them: in it, nearest to μ, and the same when made again.
    #[test]
    fn projections_are_orthogonal(a in vector::<4>(1.0), b in vector::<4>(1.0), mu in vector::<4>(1.0), s in -1.0_f64..1.0) {
        prop_assume!((a.norm_squared() * b.norm_squared() - a.dot(&b).powi(2)) > 0.01);
        let rows: [[f64; 4]; 3] = [a.into(), b.into(), (a * s + b * 0.5).into()];
        let found = private::annihilator_projection(&rows, &mu);
        // Gram's matrix by hand; its condition is at most some hundreds
        let gram = nalgebra::Matrix2::new(a.dot(&a), a.dot(&b), a.dot(&b), b.dot(&b));
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

    #[test]
    fn elements_are_the_identity_and_their_increments(d in matrix::<3, 3>(1.0), x in vector::<4>(1.0)) {
        prop_assert_eq!(private::from_increment(&d), d + Matrix3::identity());
        let q = private::quaternion::<f64>(x.into());
        prop_assert_eq!((q.i, q.j, q.k, q.w), (x[0], x[1], x[2], x[3]));
        prop_assert_eq!(private::quaternion_from_increment(&q), q + Quaternion::identity());
        let rows = [[x[0], x[1]], [x[2], x[3]], [d[0], d[1]]];
        let made = private::matrix(rows);
        prop_assert!((0..3).all(|i| (0..2).all(|j| made[(i, j)] == rows[i][j])));
        prop_assert_eq!(private::vector::<f64, 4>(x.into()), x);
    }

    /// t/(1 + cos θ) = 1 − cos θ, and θ itself where it is known.
    #[test]
    fn cosines_belong_to_their_sines(angle in 0.0_f64..1.55, x in vector::<3>(1.0), beyond in 1.0_f64..9.0) {
        let t = angle.sin().powi(2);
        let found = private::per_one_plus_cosine(t);
        // the cosine of √(1 − t) knows t to ε
        let condition = 1.0 + 1.0 / (1.0 - t).sqrt();
        prop_assert!((found * (1.0 + angle.cos()) - 1.0).abs() <= 4.0 * f64::EPSILON * condition);
        prop_assert_eq!(private::below_right_angle(x, t), Ok(x));
        let refused = private::below_right_angle(x, beyond * beyond * 1.001);
        let is_refused = matches!(refused, Err(Error::Unsolvable { solvable_fraction, .. }) if (solvable_fraction * beyond * 1.001_f64.sqrt() - 1.0).abs() < NEAR);
        prop_assert!(is_refused);
    }

    /// s + y = s⁺ + r⁺, in lanes as in numbers.
    #[test]
    fn compensated_sums_lose_nothing(s in vector::<3>(1e3), d in vector::<3>(1e-3)) {
        let (sum, rest) = private::accumulate::<f64, _>(&s, &Vector3::zeros(), &d);
        for i in 0..3 {
            prop_assert_eq!(sum[i], s[i] + d[i]);
            // what is left is exact: s − s⁺ is, as both are near, and so is the difference to d
            prop_assert_eq!(rest[i], d[i] - (sum[i] - s[i]));
        }
        let lanes = |x: Vector3<f64>| x.map(F64x8::splat);
        let found = private::accumulate::<F64x8, _>(&lanes(s), &lanes(Vector3::zeros()), &lanes(d));
        prop_assert_eq!(found, (lanes(sum), lanes(rest)));
    }

    /// A cubic has the slope of its derivative, and no other.
    #[test]
    fn slopes_are_those_of_values(c in vector::<4>(1.0), x in -2.0_f64..2.0, entry in 0_usize..9) {
        let value = |x: f64| c[0] + x * (c[1] + x * (c[2] + x * c[3]));
        let slope = c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]);
        prop_assert_eq!(private::check_slope(value, x, slope, entry), Ok(()));
        let is_refused = matches!(private::check_slope(value, x, slope + 0.01, entry), Err(Error::WrongGradient { entry: found, .. }) if found == entry);
        prop_assert!(is_refused);
    }

    /// tan(θ/2) n, from matrices and from quaternions.
    #[test]
    fn gibbs_vectors_are_tangents_of_half_angles(axis in unit(), angle in 0.0_f64..3.0) {
        let turn = UnitQuaternion::from_scaled_axis(axis * angle);
        let expected = axis * (angle / 2.0).tan();
        // tan(1.5) is 14, and 1 + tr F is 0.01 there
        let near = NEAR * (1.0 + expected.norm_squared()).powi(2);
        let of_matrix = private::gibbs_vector_of_matrix(&turn.to_rotation_matrix().into_inner());
        assert_near(&of_matrix, &expected, near, "of a matrix");
        assert_near(&private::gibbs_vector_of_quaternion(turn.quaternion()), &expected, near, "of a quaternion");
    }

    /// The shortest η with GᵀG η = Gᵀd: along the directions that move, by hand in the axes of G.
    #[test]
    fn displacements_are_shortest(axes in attitude(), sizes in prop::array::uniform2(0.5_f64..2.0), a in vector::<3>(1.0)) {
        let metric = axes * Matrix3::from_diagonal(&Vector3::new(sizes[0], sizes[1], 0.0)) * axes.transpose();
        let found = private::displacement(&metric, &(metric * a));
        let expected = a - axes.column(2) * axes.column(2).dot(&a);
        assert_near(&found, &expected, 20.0 * NEAR, "the shortest");
    }

    #[test]
    fn places_are_pairs(a in vector::<3>(1.0), b in vector::<3>(1.0), metric in matrix::<3, 3>(1.0), price in -1.0_f64..1.0) {
        let both: SVector<f64, 6> = private::pair(&a, &b);
        prop_assert_eq!((both.fixed_rows::<3>(0).into_owned(), both.fixed_rows::<3>(3).into_owned()), (a, b));
        let arrival = private::arrival_of_state::<f64, 3, 6>(&metric, &a, &b);
        prop_assert_eq!(arrival.residual, both);
        let expected = private::pair::<f64, 3, 6>(&(metric * a), &b);
        prop_assert!((arrival.slope * both - expected).amax() < NEAR);
        let end = private::endpoint::<f64, 3, 6>(price, 2.0 * price, &a, &metric);
        prop_assert_eq!((end.price, end.by_time, end.slope), (price, 2.0 * price, private::pair(&a, &Vector3::zeros())));
        prop_assert!((end.slope.dot(&both) - a.dot(&a)).abs() < NEAR);
        prop_assert!((both.dot(&(end.curvature * both)) - a.dot(&(metric * a))).abs() < NEAR);
        let none = private::no_endpoint::<f64, 6>();
        prop_assert_eq!(none, private::endpoint(0.0, 0.0, &Vector3::zeros(), &Matrix3::zeros()));
    }

    /// The second-order expansion of bounds in (η, ν) and u is that in η and u.
    #[test]
    fn bounds_do_not_depend_on_momenta(
        values in vector::<2>(1.0), by_motion in matrix::<2, 3>(1.0), by_input in matrix::<2, 1>(1.0), motions in matrix::<3, 3>(1.0),
        (mixed, input) in (matrix::<1, 3>(1.0), matrix::<1, 1>(1.0)), (eta, nu) in (vector::<3>(1.0), vector::<3>(1.0)),
    ) {
        let found = private::bounds::<f64, 3, 6, 1, 2>(values, &by_motion, by_input, &motions, &mixed, input);
        let place: SVector<f64, 6> = private::pair(&eta, &nu);
        prop_assert_eq!((found.values, found.by_input, found.input_curvature), (values, by_input, input));
        assert_near(&(found.by_place * place), &(by_motion * eta), NEAR, "slopes");
        assert_near(&(found.mixed_curvature * place), &(mixed * eta), NEAR, "mixed");
        prop_assert!((place.dot(&(found.place_curvature * place)) - eta.dot(&(motions * eta))).abs() < NEAR);
    }

    #[test]
    fn places_are_checked(q in unit(), r in rotation(1.0), defect in 1e-6_f64..1.0) {
        prop_assert_eq!(private::check_on_orbit::<f64, _>(&q, 1e-12), Ok(()));
        let is_refused = matches!(private::check_on_orbit::<f64, _>(&q, defect), Err(Error::OffOrbit { defect: found, .. }) if found == defect);
        prop_assert!(is_refused);
        prop_assert_eq!(private::check_reached::<f64, _>((q, r)), Ok((q, r)));
        prop_assert!(private::check_reached::<f64, _>((q * f64::NAN, r)).is_err());
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
