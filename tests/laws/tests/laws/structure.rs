//! The structure of Jacobians that is known before any number is: linear equations, substituted coordinates, symmetric
//! and block triangular Jacobians, each against closed forms.

use clebsch::{Clebsch, Error};
use clebsch_tests::fixtures::growing_shape::GrowingShape;
use clebsch_tests::fixtures::heisenberg_geodesic::HeisenbergGeodesic;
use clebsch_tests::fixtures::relativistic_particle::RelativisticParticle;
use clebsch_tests::fixtures::spatial_body::SpatialBody;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix2, Matrix3, Matrix4, SVector, Vector3, Vector4};

const H: f64 = 0.1;

#[track_caller]
fn assert_says<S: Clebsch>(sentences: &[&str]) {
    for sentence in sentences {
        assert!(S::DERIVATION.contains(sentence), "{}: no `{sentence}` in\n{}", S::NAME, S::DERIVATION);
    }
}

/// cay Z with Z = x₁E₁₂ + x₂E₂₃ + x₃E₁₃, by its finite series.
fn cayley(x: &Vector3<f64>) -> Matrix3<f64> {
    let z = Matrix3::new(0.0, x.x, x.z, 0.0, 0.0, x.y, 0.0, 0.0, 0.0);
    Matrix3::identity() + 2.0 * z + 2.0 * z * z
}

/// A particle in the plane whose third momentum is the strength of a magnetic field. The mean velocity obeys (2mₓ/h)
/// x + μ₃ y = μ₁, (2m_y/h) y − μ₃ x = μ₂, solved by Cramer's rule.
#[test]
fn the_heisenberg_group_is_linear() {
    assert_says::<HeisenbergGeodesic>(&["x[0], x[1] is linear", "one elimination, no iteration"]);
    let random = &mut Random::new(311);
    for _ in 0..20 {
        let mass = random.vector::<3>().map(|m| 1.5 + m);
        let mu: Vector3<f64> = random.vector::<3>() * 4.0;
        let stepper = HeisenbergGeodesic { mass }.into_stepper(H).expect("a regular system");
        let start = stepper.state(Matrix3::identity(), mu).expect("a state");
        let (a, d, b) = (2.0 * mass.x / H, 2.0 * mass.y / H, mu.z);
        let determinant = a * d + b * b;
        let x = Vector3::new(
            (d * mu.x - b * mu.y) / determinant,
            (a * mu.y + b * mu.x) / determinant,
            H * mu.z / (2.0 * mass.z),
        );
        let next = stepper.step(&start).expect("a solvable step");
        assert_near(next.configuration(), &cayley(&x), 1e-14, "q⁺");
    }
}

/// a = h p/√(m² + |p|²) at the momentum after the half kick, for momenta of up to a thousand rest masses.
#[test]
fn the_relativistic_particle_is_symmetric() {
    assert_says::<RelativisticParticle>(&["its Jacobian is symmetric"]);
    let random = &mut Random::new(312);
    for size in [1e-3, 1.0, 3.0, 30.0, 1e3] {
        let (mass, force) = (1.5, random.vector::<3>());
        let stepper = RelativisticParticle { mass, force }.into_stepper(H).expect("a regular system");
        let mut state = stepper.state(random.vector::<3>(), random.vector::<3>() * size).expect("a state");
        for _ in 0..5 {
            let (x, p) = (*state.configuration(), state.momentum());
            let middle = p + force * (H / 2.0);
            let a = middle * (H / (mass * mass + middle.norm_squared()).sqrt());
            state = stepper.step(&state).unwrap_or_else(|error| panic!("|p| = {}: {error}", p.norm()));
            assert_near(state.configuration(), &(x + a), 1e-14, "x⁺");
            assert_near(&state.momentum(), &(p + force * H), 1e-14 * size.max(1.0), "p⁺");
        }
    }
}

/// The momentum of F = q⁻¹q⁺ by an independent formula: h r = k (F − I)Fᵀ, paired with the basis.
#[test]
fn similarities_are_block_triangular() {
    assert_says::<GrowingShape>(&["its Jacobian is block triangular"]);
    let random = &mut Random::new(313);
    let stiffness = 1.25;
    let stepper = GrowingShape { stiffness }.into_stepper(H).expect("a regular system");
    for _ in 0..20 {
        let mu: Vector4<f64> = random.vector::<4>() * 2.0;
        let f = stepper.inverse_legendre(&Matrix3::identity(), &mu).expect("a solvable step");
        let r = (f - Matrix3::identity()) * f.transpose() * (stiffness / H);
        let paired = Vector4::new(r[(1, 0)] - r[(0, 1)], r[(0, 0)] + r[(1, 1)], r[(0, 2)], r[(1, 2)]);
        assert_near(&paired, &mu, 1e-12, "r(F)");
        let linear: Matrix2<f64> = f.fixed_view::<2, 2>(0, 0).into_owned();
        assert_near(&(linear.transpose() * linear), &(Matrix2::identity() * linear.determinant()), 1e-14, "F");
    }
}

/// Coordinates of the second kind: x + zy = hμ₁/k, y = hμ₂/k, z = hμ₃/k.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: Heisenberg<1>, q: Heisenberg<1>| q * F,
    cost   = |h, F| self.stiffness * (F - I).norm_squared() / (2 * h),
)]
struct Dido {
    stiffness: f64,
}

#[test]
fn unipotent_groups_are_triangular() {
    assert_says::<Dido>(&["coordinates of the second kind", "is triangular", "solved by substitution, no iteration"]);
    // half a step of the adjoint is linear for the known part, with the determinant of the inertia
    assert!(!Dido::DERIVATION.contains("Newton"), "{}", Dido::DERIVATION);
    let random = &mut Random::new(315);
    let stepper = Dido { stiffness: 0.8 }.into_stepper(H).expect("a regular system");
    for _ in 0..20 {
        let mu: Vector3<f64> = random.vector::<3>() * 5.0;
        let [x, y, z] = [0, 1, 2].map(|i| H * mu[i] / 0.8);
        let expected = Matrix3::new(1.0, x - z * y, z, 0.0, 1.0, y, 0.0, 0.0, 1.0);
        let f = stepper.inverse_legendre(&Matrix3::identity(), &mu).expect("an explicit step");
        assert_near(&f, &expected, 1e-14, "F");
    }
}

/// The midpoint rule for a spring: (M/h + hK/4) a = p − hKx/2, linear and symmetric at every place.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<2>, x: Vector2| x + a,
    cost   = |h, x, a| self.mass * a.norm_squared() / (2 * h) - h * (x + a / 2).dot(&(self.spring * (x + a / 2))) / 2,
)]
struct Spring {
    mass: f64,
    #[clebsch(symmetric)]
    spring: Matrix2<f64>,
}

#[test]
fn the_midpoint_rule_of_a_spring_is_linear() {
    assert_says::<Spring>(&["is linear in the coordinates of the translation", "one elimination, no iteration"]);
    let random = &mut Random::new(316);
    let (mass, spring) = (1.3, random.inertia::<2>());
    for h in [H, 3.0, -H] {
        let stepper = Spring { mass, spring }.into_stepper(h).expect("a regular system");
        let state = stepper.state(random.vector::<2>(), random.vector::<2>()).expect("a state");
        let (x, p) = (*state.configuration(), state.momentum());
        let matrix = Matrix2::identity() * (mass / h) + spring * (h / 4.0);
        let a = matrix.try_inverse().expect("regular") * (p - spring * x * (h / 2.0));
        let next = stepper.step(&state).expect("a solvable step");
        assert_near(next.configuration(), &(x + a), 1e-13, "x⁺");
        assert_near(&next.momentum(), &(a * (mass / h) - spring * (x + a / 2.0) * (h / 2.0)), 1e-13, "p⁺");
    }
}

/// The slope m/h + hk/4 of a spring that pushes apart vanishes at one step size: an error, and no number.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, x, a| (self.mass * a.norm_squared() / h - h * self.spring * (x + a / 2).norm_squared()) / 2,
)]
struct Repelled {
    mass: f64,
    spring: f64,
}

#[test]
fn slopes_that_vanish_are_refused() {
    let stepper = Repelled { mass: 1.0, spring: -16.0 }.into_stepper(0.5).expect("a regular inertia");
    let state = stepper.state([1.0].into(), [2.0].into()).expect("a state");
    // the slope m/h² − |k|/4 vanishes at this step, and at no shorter one
    let refused = stepper.step(&state);
    let Err(Error::StepTooLong { step_size, solvable_step: Some(longest) }) = refused else { panic!("{refused:?}") };
    assert!(step_size == 0.5 && (0.485..0.5).contains(&longest), "{longest}");
    let stepper = Repelled { mass: 1.0, spring: -16.0 }.into_stepper(0.25).expect("a regular inertia");
    let next = stepper.step(&stepper.state([1.0].into(), [2.0].into()).expect("a state")).expect("a solvable step");
    // (4 − 1) a = 2 + 16·0.25/2
    assert!((next.configuration().x - (1.0 + 4.0 / 3.0)).abs() < 1e-15);
}

/// The force does not couple directions: one equation each, two of them without iteration.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| self.mass * (v.norm_squared() / 2 + v.x.powi(4)),
)]
struct Quartic {
    mass: f64,
}

#[test]
fn directions_that_do_not_couple_are_solved_one_by_one() {
    let random = &mut Random::new(317);
    let stepper = Quartic { mass: 0.7 }.into_stepper(H).expect("a regular system");
    for _ in 0..20 {
        let v: Vector3<f64> = random.vector::<3>();
        let p = Vector3::new(v.x + 4.0 * v.x.powi(3), v.y, v.z) * 0.7;
        let next = stepper.step(&stepper.state(Vector3::zeros(), p).expect("a state")).expect("a solvable step");
        assert_near(next.configuration(), &(v * H), 1e-15, "x⁺");
    }
    assert!(Quartic::DERIVATION.contains("[0] is solved by Newton's method"), "{}", Quartic::DERIVATION);
    assert!(Quartic::DERIVATION.contains("[1], "), "{}", Quartic::DERIVATION);
}

/// A body with this mass and centre of mass.
fn body(random: &mut Random, mass: f64, center: Vector3<f64>) -> SpatialBody {
    let moments = random.inertia::<3>() * 0.3 + mass * center * center.transpose();
    let mut mass_matrix = Matrix4::zeros();
    mass_matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&moments);
    mass_matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&(mass * center));
    mass_matrix.fixed_view_mut::<1, 3>(3, 0).copy_from(&(center.transpose() * mass));
    mass_matrix[(3, 3)] = mass;
    SpatialBody { mass_matrix, gravity: 0.0 }
}

/// Where a momentum is too large for three unknowns, which know of six of its components, the largest solvable fraction is exact.
#[test]
fn solvable_fractions_count_what_was_put_in() {
    let random = &mut Random::new(318);
    let mut refused = 0;
    for k in 1..=40 {
        let center = random.vector::<3>();
        let stepper = body(random, 1.5, center).into_stepper(H).expect("a regular system");
        let solved = |mu: &SVector<f64, 6>| stepper.inverse_legendre(&Matrix4::identity(), mu);
        let mu = random.vector::<6>() * (0.5 * f64::from(k));
        match solved(&mu) {
            Ok(f) => assert_near(&stepper.legendre(&Matrix4::identity(), &f), &mu, 1e-11, "r(F)"),
            Err(Error::Unsolvable { solvable_fraction, .. }) => {
                refused += 1;
                assert!(solvable_fraction > 0.0 && solvable_fraction < 1.0, "{solvable_fraction}");
                assert!(solved(&(mu * (solvable_fraction * 0.999))).is_ok(), "below {solvable_fraction}");
                assert!(solved(&(mu * (solvable_fraction * 1.001))).is_err(), "above {solvable_fraction}");
            }
            Err(other) => panic!("{other}"),
        }
    }
    println!("{refused} refused");
    assert!((5..36).contains(&refused), "{refused} of 40 refused");
}

/// The shift follows from the turn, b = hM_v/m − (W − I)c, and three unknowns remain.
#[test]
fn the_shift_of_a_body_is_put_in() {
    assert_says::<SpatialBody>(&["x₁ is solved by Newton's method", "given the other coordinates"]);
    let random = &mut Random::new(314);
    let (mass, center) = (1.5, Vector3::new(0.2, -0.1, 0.3));
    let stepper = body(random, mass, center).into_stepper(H).expect("a regular system");
    for _ in 0..20 {
        let mu = random.vector::<6>();
        let f = stepper.inverse_legendre(&Matrix4::identity(), &mu).expect("a solvable step");
        let turn: Matrix3<f64> = f.fixed_view::<3, 3>(0, 0).into_owned();
        let expected = mu.fixed_rows::<3>(3) * (H / mass) - (turn - Matrix3::identity()) * center;
        assert_near(&f.fixed_view::<3, 1>(0, 3).into_owned(), &expected, 1e-14, "b");
        assert_near(&stepper.legendre(&Matrix4::identity(), &f), &mu, 1e-13, "r(F)");
    }
}

/// A body without mass has no shift: the stepper says so, before any division by it.
#[test]
fn singular_slopes_are_refused() {
    let empty = SpatialBody { mass_matrix: Matrix4::from_diagonal(&Vector4::new(1.0, 1.0, 1.0, 0.0)), gravity: 0.0 };
    assert!(matches!(empty.into_stepper(H), Err(Error::SingularKineticEnergy { .. })));
    let flat = HeisenbergGeodesic { mass: Vector3::new(1.0, 1.0, 0.0) };
    assert!(matches!(flat.into_stepper(H), Err(Error::SingularKineticEnergy { .. })));
}
