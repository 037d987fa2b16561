//! Group elements, places and fields: how they are made of their parts, checked and brought back.
//!
//! Entries are of order one, so that sums of products are rounded by a few ε.

use crate::arbitrary::{attitude, cases, definite, matrix, rotation, unit, vector};
use crate::runner::proptest;
use clebsch::__private as private;
use clebsch::{Error, TargetExpansion};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix2, Matrix3, Quaternion, SMatrix, SVector, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// Some ten roundings of numbers of order one.
const NEAR: f64 = 4e-15;

proptest! {
    #![proptest_config(cases(128))]

    /// Brought back by one step of Newton and Schulz, whose error is the square of the defect. A value on its space
    /// already stays to the bit.
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

    /// The same for the rounding errors of sums, which count as much; after the correction the error is rounding.
    #[test]
    fn rests_come_back_with_their_sums(r in attitude(), q in unit(), off in matrix::<3, 3>(1.0), left in matrix::<3, 3>(1.0), size in -12.0_f64..-4.0) {
        let defect = 10.0_f64.powf(size);
        let near = 64.0 * defect * defect + NEAR;
        let (moved, left) = (r + off * defect, left * defect);
        let (back, rest) = private::orthogonal_with_rest(moved, left);
        if back != moved {
            prop_assert!(private::orthogonality_defect(&(back + rest)) < near);
            prop_assert!(rest.amax() <= f64::EPSILON);
        }
        let (moved, left) = (q * (1.0 + defect), left.column(0).into_owned());
        let (back, rest) = private::of_length_one_with_rest(moved, left);
        prop_assert!(private::length_defect(&(back + rest)) < near);
        prop_assert!(rest.amax() <= f64::EPSILON);
        prop_assert_eq!(private::of_length_one_with_rest(q, left), (q, left));
    }

    /// Brought back by one step of McWeeny, or of Newton and Schulz for columns. The error is the square of the defect.
    #[test]
    fn projectors_and_frames_come_back(r in attitude(), off in matrix::<3, 3>(1.0), k in 1..3_usize, size in -12.0_f64..-4.0) {
        let defect = 10.0_f64.powf(size);
        let near = 16.0 * defect * defect + NEAR;
        let columns = r.columns(0, k);
        let p = columns * columns.transpose();
        let moved = p + (off + off.transpose()) * defect;
        prop_assert!(private::projector_defect(&p, k) < NEAR);
        prop_assert!((private::projector_defect(&p, k + 1) - 1.0).abs() < NEAR);
        let square = (moved * moved - moved).amax();
        let trace = (moved.trace() - k as f64).abs();
        prop_assert!((private::projector_defect(&moved, k) - square.max(trace)).abs() < NEAR);
        // of corrections that are made: one direction of the defect is looked at
        let back = private::projector(moved);
        prop_assert_eq!(back.transpose(), back);
        if back != private::symmetric(moved) {
            prop_assert!(private::projector_defect(&back, k) < 4.0 * near);
        }
        let skewed = p + off * defect;
        let asymmetry = (skewed - skewed.transpose()).amax() / skewed.amax();
        prop_assert!(private::projector_defect(&skewed, k) >= asymmetry * (1.0 - 1e-9));

        let x: SMatrix<f64, 3, 2> = (r + off * defect).fixed_columns::<2>(0).into_owned();
        let expected = (x.transpose() * x - Matrix2::identity()).amax();
        prop_assert!((private::orthonormality_defect(&x) - expected).abs() < NEAR);
        let back = private::orthogonal(x);
        if back != x {
            prop_assert!(private::orthonormality_defect(&back) < near);
        }
    }

    /// The same for the rounding errors of sums, which count as much.
    #[test]
    fn rests_of_projectors_come_back(r in attitude(), off in matrix::<3, 3>(1.0), left in matrix::<3, 3>(1.0), size in -12.0_f64..-4.0) {
        let defect = 10.0_f64.powf(size);
        let near = 256.0 * defect * defect + 4.0 * NEAR;
        let columns = r.columns(0, 2);
        let p = columns * columns.transpose() + (off + off.transpose()) * defect;
        let left = (left + left.transpose()) * defect;
        let (back, rest) = private::projector_with_rest(p, left);
        if back != private::symmetric(p) {
            prop_assert!(private::projector_defect(&(back + rest), 2) < near);
            prop_assert!(rest.amax() <= f64::EPSILON);
        }
    }

    /// The entries above the diagonal decide, and the defect is that of the entries, relative to the largest.
    #[test]
    fn matrices_become_symmetric(a in matrix::<3, 3>(1.0), rest in matrix::<3, 3>(1e-16), scale in -100.0_f64..100.0) {
        let a = a * 10.0_f64.powf(scale);
        let back = private::symmetric(a);
        prop_assert_eq!(back.transpose(), back);
        prop_assert_eq!(back.upper_triangle(), a.upper_triangle());
        prop_assert_eq!(private::symmetric_with_rest(a, rest), (back, private::symmetric(rest)));
        prop_assert_eq!(private::symmetry_defect(&back), 0.0);
        let expected = (a - a.transpose()).amax() / a.amax();
        prop_assert!((private::symmetry_defect(&a) - expected).abs() < NEAR);
    }

    /// A promise of a field that is true is accepted, and a value that is off by more than rounding is refused with its
    /// size.
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
        tilted[(j, i)] = -f64::INFINITY;
        prop_assert_eq!(private::check_finite::<f64>("a", &tilted), Err(Error::NotFinite { name: "a" }));
        prop_assert_eq!(private::check_limit::<f64>("a", &tilted), Ok(()));
        tilted[(j, i)] = f64::NAN;
        prop_assert_eq!(private::check_finite::<f64>("a", &tilted), Err(Error::NotFinite { name: "a" }));
        prop_assert_eq!(private::check_limit::<f64>("a", &tilted), Err(Error::NotFinite { name: "a" }));
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
        // the cosine of √(1 − t) knows t to ε
        let condition = 1.0 + 1.0 / (1.0 - t).sqrt();
        for found in [private::per_one_plus_cosine(t), private::quotient_per_one_plus_cosine(t)] {
            prop_assert!((found * (1.0 + angle.cos()) - 1.0).abs() <= 4.0 * f64::EPSILON * condition);
        }
        prop_assert_eq!(private::below_right_angle(x, t), Ok(x));
        let refused = private::below_right_angle(x, beyond * beyond * 1.001);
        let is_refused = matches!(refused, Err(Error::Unsolvable { solvable_fraction, .. }) if (solvable_fraction * beyond * 1.001_f64.sqrt() - 1.0).abs() < NEAR);
        prop_assert!(is_refused);
        // from a rest inside: the part s of the momentum at which |d + s (a − d)| = 1
        let (rest, all) = (x * 0.5, x * 0.5 + x.normalize() * (2.0 * beyond));
        let refused = private::below_right_angle_from(all, |a| a.norm_squared(), |none: &SVector<f64, 1>| rest + all * none.x);
        let Err(Error::Unsolvable { solvable_fraction: s, .. }) = refused else { return Err(TestCaseError::fail("a solution")) };
        prop_assert!(((rest + (all - rest) * s).norm() - 1.0).abs() < 1e-13);
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
        prop_assert_eq!(private::parted(&both), (a, b));
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

    /// Two conditions of a state, in which there is room for six.
    #[test]
    fn conditions_are_differences_of_their_sides(
        (left, right, by_time) in (vector::<2>(1.0), vector::<2>(1.0), vector::<2>(1.0)), slope in matrix::<2, 3>(1.0), curvature in matrix::<3, 3>(1.0),
        (eta, nu) in (vector::<3>(1.0), vector::<3>(1.0)),
    ) {
        let found: TargetExpansion<f64, 6> = private::conditions([&left, &right, &by_time], &slope, &curvature);
        let place: SVector<f64, 6> = private::pair(&eta, &nu);
        let first = |all: SVector<f64, 6>| private::weights::<f64, 2, 6>(&all);
        assert_near(&first(found.values), &(left - right), NEAR, "a − b");
        prop_assert_eq!((first(found.sizes), first(found.by_time)), (left.abs() + right.abs(), by_time));
        assert_near(&first(found.slope * place), &(slope * eta), NEAR, "slopes");
        prop_assert!((place.dot(&(found.curvature * place)) - eta.dot(&(curvature * eta))).abs() < NEAR);
        let none = TargetExpansion::<f64, 6>::none();
        prop_assert_eq!(none.slope - found.slope, -found.slope);
        prop_assert_eq!(found.values.fixed_rows::<4>(2), none.values.fixed_rows::<4>(2));
    }

    #[test]
    fn the_last_bounds_are_soft(prices in vector::<2>(1.0)) {
        let all = private::bound_prices::<f64, 2, 5>(&prices);
        prop_assert!(all.iter().take(3).all(|price| *price == f64::INFINITY));
        prop_assert_eq!(all.fixed_rows::<2>(3), prices);
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
