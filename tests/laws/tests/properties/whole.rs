//! Operations on matrices, and points on spheres in (q, w): the operations of code of large systems.

use crate::arbitrary::{cases, matrix, vector};
use crate::runner::proptest;
use clebsch::__private::{
    At, Blocks, InertiaInverse, Jacobian, Orientation, Scheme, Sylvester, axial, determinant, distance_of_projection,
    embedded, hat, invert_uniform, kinetic_energy_uniform, matrix_of, orientation_of_inertia, orientation_of_uniform,
    projection, push, shifted, skew, skew_components, skew_outer, skew_times, tangent, turn_freely, turn_great_circle,
    turned_in_plane,
};
use clebsch::num_dual::Dual64;
use clebsch::{Clebsch, Error, F64x4, Space};
use clebsch_tests::stepping::Stepping;
use nalgebra::{SMatrix, SVector};
use proptest::prelude::*;

type Square = SMatrix<f64, 5, 5>;

/// C. Neumann's point on S⁷, stepped in (q, w).
#[derive(Clebsch, Clone)]
#[clebsch(
    action    = |F: SO<8>, q: Unit<SVector<8>>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.stiffness.dot(&q.component_mul(&q)) / 2,
)]
pub struct Neumann {
    pub stiffness: SVector<f64, 8>,
}

fn square() -> BoxedStrategy<Square> {
    matrix(1.0)
}

/// Two numbers that differ by rounding.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-13 * (1.0 + a.abs().max(b.abs()))
}

proptest! {
    #![proptest_config(cases(64))]

    /// By the operations of nalgebra.
    #[test]
    fn operations_are_those_of_matrices(a in square(), part in matrix::<2, 3>(1.0), s in -2.0_f64..2.0) {
        prop_assert_eq!(shifted(&a, s), a + Square::identity() * s);
        prop_assert!(near(determinant(&a), a.determinant()));
        let whole: Square = embedded(&part, 1, 2);
        prop_assert_eq!(whole.fixed_view::<2, 3>(1, 2).into_owned(), part);
        prop_assert!(near(whole.norm(), part.norm()), "zero elsewhere");
        prop_assert_eq!(Blocks::block::<2, 3>(&a, 1, 2), a.fixed_view::<2, 3>(1, 2).into_owned());
        prop_assert!((matrix_of(|x: &SVector<f64, 5>| a * x) - a).amax() == 0.0);
    }

    /// x ↦ Σ x_k E_k with E = E_ji − E_ij, A ↦ ⟨A, E⟩ its transpose, and their action on vectors.
    #[test]
    fn skew_matrices_have_components(x in vector::<10>(1.0), a in square(), v in vector::<5>(1.0), w in vector::<5>(1.0)) {
        let z: Square = skew(&x);
        prop_assert_eq!(z.transpose(), -z);
        prop_assert_eq!((z[(1, 0)], z[(2, 0)], z[(4, 3)]), (x[0], x[1], x[9]), "the order (12) (13) … (45)");
        let components: SVector<f64, 10> = skew_components(&a);
        prop_assert!(near(components.dot(&x), a.dot(&z)));
        prop_assert!((skew_times(&x, &v) - z * v).amax() < 1e-14);
        let outer: SVector<f64, 10> = skew_outer(&v, &w);
        prop_assert!((outer - skew_components::<f64, 5, 10>(&(v * w.transpose()))).amax() < 1e-15);
    }

    /// x^ v = x × v, and A ↦ ⟨A, E⟩ is its transpose.
    #[test]
    fn hats_turn_vectors(x in vector::<3>(1.0), a in matrix::<3, 3>(1.0), v in vector::<3>(1.0)) {
        prop_assert!((hat(&x) * v - x.cross(&v)).amax() < 1e-15);
        prop_assert!(near(axial(&a).dot(&x), a.dot(&hat(&x))));
    }

    /// x ↦ ⟨x^B, E⟩ and its matrix are the same Jacobian: values, solutions, signs, columns, sizes.
    #[test]
    fn maps_of_skew_matrices_are_their_matrices(a in square(), b in square(), x in vector::<10>(1.0), c in vector::<10>(1.0), s in 0.0_f64..1.0, j in 0_usize..10) {
        let factor = a + Square::identity() * 1.5;
        let (map, other) = (Sylvester::new(factor), Sylvester::new(b));
        let matrix: SMatrix<f64, 10, 10> = matrix_of(|x| map.times(x));
        let delta: Square = skew(&x);
        let value: SVector<f64, 10> = skew_components(&(delta * factor + factor.transpose() * delta));
        prop_assert!((map.times(&x) - value / 2.0).amax() < 1e-14, "half of a skew matrix's components");
        prop_assume!(matrix.try_inverse().is_some_and(|inverse| inverse.norm() < 1e3));
        let is_same = |a: Option<(SVector<f64, 10>, Orientation)>, b: Option<(SVector<f64, 10>, Orientation)>| match (a, b) {
            (Some((x, sign)), Some((y, turned))) => (x - y).amax() < 1e-11 * (1.0 + y.amax()) && sign == turned,
            (a, b) => a.is_none() && b.is_none(),
        };
        prop_assert!(is_same(map.solve(&x), matrix.solve(&x)));
        prop_assert!(is_same(map.solve_exchanged(None, &x), matrix.solve_exchanged(None, &x)));
        let mut exchanged = matrix;
        exchanged.set_column(j, &c);
        if exchanged.try_inverse().is_some_and(|inverse| inverse.norm() < 1e3) {
            prop_assert!(is_same(map.solve_exchanged(Some((j, &c)), &x), exchanged.solve(&x)));
            prop_assert!(is_same(matrix.solve_exchanged(Some((j, &c)), &x), exchanged.solve(&x)));
        }
        let [own, whole]: [&dyn Fn() -> Option<Orientation>; 2] = [&|| Jacobian::<f64, 10>::orientation(&map), &|| matrix.orientation()];
        prop_assert_eq!(own(), whole());
        let (column, expected) = (Jacobian::<f64, 10>::column(&map, j), matrix.column(j).into_owned());
        prop_assert!((column - expected).amax() < 1e-15 && Jacobian::<f64, 10>::column(&matrix, j) == expected);
        let terms: f64 = matrix.iter().zip((0..10).flat_map(|k| [x[k]; 10])).map(|(entry, x)| (entry * x).abs()).sum();
        prop_assert!(near(matrix.size_of_terms(&x), terms) && map.size_of_terms(&x) >= terms * (1.0 - 1e-14));
        prop_assert!(matrix.largest_entry() == matrix.amax());
        prop_assert!(Jacobian::<f64, 10>::largest_entry(&map) >= matrix.amax() * (1.0 - 1e-15));
        let between = Jacobian::<f64, 10>::between(&map, &other, s).times(&x);
        prop_assert!((between - (map.times(&x) * (1.0 - s) + other.times(&x) * s)).amax() < 1e-13);
        let broken = Sylvester::new(factor * f64::NAN);
        prop_assert!(Jacobian::<f64, 10>::all_finite(&map) && !Jacobian::<f64, 10>::all_finite(&broken));
        prop_assert_eq!(Jacobian::<f64, 10>::lane(&map, 0).times(&x), map.times(&x));
    }

    /// Lanes have the bits of single numbers, also next to a singular one; derivatives are those of the solution, A
    /// x′ = r′ − A′x.
    #[test]
    fn maps_of_all_kinds_of_numbers_are_inverted(a in square(), b in square(), x in vector::<10>(1.0), y in vector::<10>(1.0)) {
        let factors = [a + Square::identity() * 2.0, b + Square::identity() * 2.0, Square::zeros(), a * b - Square::identity() * 3.0];
        let rights = [x, y, x + y, x - y];
        let wide = Sylvester::new(SMatrix::<F64x4, 5, 5>::side_by_side(|lane| factors[lane]));
        let right = SVector::<F64x4, 10>::side_by_side(|lane| rights[lane]);
        let (solutions, signs) = wide.solve(&right).ok_or(TestCaseError::fail("lanes are regular"))?;
        for (lane, factor) in factors.into_iter().enumerate().filter(|(lane, _)| *lane != 2) {
            let (alone, _) = Sylvester::new(factor).solve(&rights[lane]).ok_or(TestCaseError::reject("singular"))?;
            prop_assert_eq!(solutions.lane(lane), alone);
        }
        prop_assert!(Jacobian::<F64x4, 10>::orientation(&wide).is_none() && signs != Orientation::POSITIVE);
        prop_assert!(Sylvester::new(Square::zeros()).solve(&x).is_none());

        let (factor, slope) = (factors[0], b);
        let moving = Sylvester::new(factor.zip_map(&slope, Dual64::new));
        let (solution, _) = moving.solve(&x.zip_map(&y, Dual64::new)).ok_or(TestCaseError::reject("singular"))?;
        let (value, derivative) = (solution.map(|x| x.re), solution.map(|x| x.eps));
        let [still, changing] = [factor, slope].map(Sylvester::new);
        let condition = 1.0 + derivative.amax() + value.amax();
        prop_assert!((still.times(&value) - x).amax() < 1e-12 * condition);
        prop_assert!((still.times(&derivative) + changing.times(&value) - y).amax() < 1e-12 * condition);
    }

    /// Σ⁻¹μ and the energy by any inertia, by a diagonal one and by κI.
    #[test]
    fn inertias_are_inverted(a in square(), mu in vector::<5>(1.0), kappa in 0.1_f64..3.0, h in 0.01_f64..1.0) {
        let inertia = a * a.transpose() + Square::identity();
        let inverse = InertiaInverse::new(&inertia)?;
        prop_assert!((inverse.matrix() * inertia - Square::identity()).amax() < 1e-12);
        prop_assert!((inertia * inverse.times(&mu) - mu).amax() < 1e-12);
        prop_assert!(near(inverse.energy(&mu), mu.dot(&inverse.times(&mu)) / 2.0));
        let principal = inertia.diagonal();
        let inverse = InertiaInverse::new(&Square::from_diagonal(&principal))?;
        prop_assert!((inverse.times(&mu) - mu.component_div(&principal)).amax() < 1e-15);
        let inverse = invert_uniform(&kappa)?;
        prop_assert!(near(kinetic_energy_uniform(&inverse, &mu), mu.norm_squared() / (2.0 * kappa)));
        prop_assert_eq!(orientation_of_inertia(&inertia, h)?, Orientation::POSITIVE);
        prop_assert_eq!(orientation_of_inertia(&inertia, -h)?, Orientation::NEGATIVE, "an odd number of signs");
        prop_assert_eq!(orientation_of_uniform(-kappa, 5)?, Orientation::NEGATIVE);
        prop_assert_eq!(orientation_of_uniform(-kappa, 4)?, Orientation::POSITIVE);
        let singular = matches!(invert_uniform(&0.0), Err(Error::SingularKineticEnergy { .. }));
        prop_assert!(singular && InertiaInverse::new(&(a - a)).is_err() && orientation_of_uniform(0.0, 3).is_err());
    }

    /// The momentum wqᵀ − qwᵀ has (q, w) back, is carried along the great circle, and stays where lengths are mended.
    #[test]
    fn points_follow_great_circles(q in vector::<5>(1.0), w in vector::<5>(0.8), g in vector::<5>(1.0), a in 0.01_f64..0.5) {
        prop_assume!(q.norm() > 0.1 && w.norm() > 0.1);
        let q = q.normalize();
        let mut w = w;
        push(&q, &mut w, &g, 0.0);
        prop_assert!(q.dot(&w).abs() < 1e-15);
        let momentum = |q: &SVector<f64, 5>, w: &SVector<f64, 5>| skew_outer::<f64, 5, 10>(w, q);
        let matrix: Square = skew(&momentum(&q, &w));
        prop_assert!((matrix - (w * q.transpose() - q * w.transpose())).amax() < 1e-15);
        prop_assert!((tangent(&q, &momentum(&q, &w)) - w).amax() < 1e-14);
        let mut pushed = w;
        push(&q, &mut pushed, &g, 0.5);
        prop_assert!((pushed - (w + (g - q * q.dot(&g)) / 2.0)).amax() < 1e-14);
        let (mut next, mut turned) = (q, w);
        turn_great_circle(a, &mut next, &mut turned)?;
        let mut freely = q;
        turn_freely(a, &(q, w), &mut freely)?;
        prop_assert!((freely - next).amax() < 1e-15);
        prop_assert!(near(next.norm(), 1.0) && next.dot(&turned).abs() < 1e-14);
        prop_assert!((momentum(&next, &turned) - momentum(&q, &w)).amax() < 1e-14);
        prop_assert!(near((next - q * next.dot(&q)).norm(), a * w.norm()), "by the angle with that sine");
        let long = q * (1.0 + 1e-10);
        let (mut mended, mut turned) = (long, w);
        turn_great_circle(a, &mut mended, &mut turned)?;
        prop_assert!((mended.norm() - 1.0).abs() < 1e-15 * 4.0);
        prop_assert!((momentum(&mended, &turned) - momentum(&long, &w)).amax() < 1e-14);
        let refused = turn_great_circle(2.0 / w.norm(), &mut mended, &mut turned);
        prop_assert!(matches!(refused, Err(Error::Unsolvable { .. })), "too far");
    }

    /// On spheres of any radius, with covectors that have a part along q, by the matrix of the group element: I + aM + (aM)²/(1 + c).
    #[test]
    fn covectors_are_turned_in_their_plane(q in vector::<5>(2.0), p in vector::<5>(1.0), part in 0.01_f64..0.99) {
        let m = p * q.transpose() - q * p.transpose();
        let size = (m.norm_squared() / 2.0).sqrt();
        prop_assume!(q.norm() > 0.1 && size > 0.01);
        let a = part / size;
        let f = Square::identity() + m * a + m * m * (a * a / (1.0 + (1.0 - part * part).sqrt()));
        let (next, turned) = turned_in_plane(a, &q, &p)?;
        prop_assert!((next - f * q).amax() < 1e-12 && (turned - f * p).amax() < 1e-12);
        let fraction = 1.0 / (2.0 * size * a);
        let refused = turned_in_plane(2.0 * a / part, &q, &p);
        prop_assert!(matches!(refused, Err(Error::Unsolvable { solvable_fraction, .. }) if near(solvable_fraction, fraction * part)), "{:?}", refused);
    }

    /// A state stores the covector w ⊥ q with N = J(q, w), and the motion is that of the Legendre transforms.
    #[test]
    fn states_hold_what_they_step_in(stiffness in vector::<8>(2.0), q in vector::<8>(1.0), w in vector::<8>(1.0)) {
        prop_assume!(q.norm() > 0.1);
        let q = q.normalize();
        let w = w - q * q.dot(&w);
        let (h, stepper) = (0.05, Neumann { stiffness }.into_stepper(0.05)?);
        let mu = stepper.momentum_map(&q, &w);
        prop_assert!((Neumann::held(&q, &mu) - w).amax() < 1e-14);
        prop_assert!((Neumann::momentum_held(&q, &w) - mu).amax() < 1e-14);
        let start = stepper.state(q, mu)?;
        prop_assert!((start.momentum() - mu).amax() < 1e-14);
        let next = stepper.step(&start)?;
        let f = stepper.inverse_legendre(&q, &mu)?;
        prop_assert!((f * q - next.configuration()).amax() < 1e-13);
        prop_assert!((stepper.system().legendre_next(h, 0.0, &q, &f) - next.momentum()).amax() < 1e-13);
        let together = stepper.advance(&start, 5)?;
        let one_by_one = (0..5).try_fold(start, |state, _| stepper.step(&state))?;
        prop_assert!((together.configuration() - one_by_one.configuration()).amax() < 1e-13);
        prop_assert!((together.momentum() - one_by_one.momentum()).amax() < 1e-13);
        prop_assert_eq!(stepper.advance(&start, 0)?, start);
    }

    /// An integrator makes the steps of its stepper, and keeps its state where one fails.
    #[test]
    fn integrators_step_in_place(stiffness in vector::<8>(2.0), q in vector::<8>(1.0), w in vector::<8>(1.0), count in 0_usize..6) {
        prop_assume!(q.norm() > 0.1 && w.norm() > 0.1);
        let q = q.normalize();
        let point = Neumann { stiffness };
        let mu = point.momentum_map(&q, &w);
        let stepper = point.stepper(0.05)?;
        let start = stepper.state(q, mu)?;
        let mut integrator = Box::new(stepper.clone().integrator(start));
        prop_assert_eq!((integrator.state(), integrator.steps()), (&start, 0));
        let beside = stepper.clone().integrator(start);
        prop_assert_eq!(beside.state(), integrator.state());
        let mut state = start;
        for _ in 0..count {
            state = stepper.step(&state)?;
            integrator.step()?;
            prop_assert_eq!(integrator.state(), &state);
        }
        prop_assert_eq!(integrator.steps(), count as u64);
        let later = stepper.advance(&state, 3)?;
        integrator.advance(3)?;
        prop_assert_eq!((integrator.state(), integrator.steps()), (&later, count as u64 + 3));
        // where it is slow it steps, from where it is too fast it does not
        let constants = integrator.stepper().system().step_constants(0.05)?;
        let (mut x, mut held, mut gradient) = (q, w, w);
        let place = (&q, &Neumann::held(&q, &mu), integrator.stepper().system().impulse(&constants, 0.0, &q, &mu));
        <Neumann as Clebsch>::Scheme::step_into(At::new(&point, &constants, 0.0), (place.0, place.1, &place.2), &(), (&mut x, &mut held, &mut gradient))?;
        prop_assert_eq!(&point.step(&constants, 0.0, place.0, place.1, &place.2, &())?, &(x, held, gradient));
        let stepped = stepper.step(&start)?;
        prop_assert_eq!(&x, stepped.configuration());
        let fast = stepper.state(q, mu * (40.0 / mu.norm()))?;
        integrator.set_state(fast);
        let (refused, several) = (integrator.step_with(&()), integrator.clone().advance(2));
        prop_assert_eq!(refused, stepper.step(&fast).map(drop));
        prop_assert!(refused.is_err() && several == refused && integrator.state() == &fast);
        prop_assert_eq!(integrator.steps(), count as u64 + 3);
    }

    /// A projection in other units is the same, and so is the distance from it.
    #[test]
    fn units_of_projections_do_not_matter(mu in vector::<5>(1.0), q in vector::<5>(1.0), power in -900_i32..900) {
        prop_assume!(q.norm() > 0.1);
        let q = q.normalize();
        let along = |mu: &SVector<f64, 5>| q * q.dot(mu);
        let unit = 2.0_f64.powi(power);
        prop_assert!((projection(&(mu * unit), along) / unit - along(&mu)).amax() < 1e-15);
        prop_assert!(near(distance_of_projection(&(mu * unit), along) / unit, (mu - along(&mu)).norm()));
    }
}
