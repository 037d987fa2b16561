//! One motion, declared in two ways: both sides, both Lagrangians of a body, any scalar.

use clebsch::Clebsch;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::principal_body::PrincipalBody;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, Quaternion, UnitQuaternion, Vector3};

const H: f64 = 0.02;

/// Entries of order one, computed in different ways over 200 steps: round-off of 1e-16 a step, grown linearly.
const NEAR: f64 = 1e-12;

fn heavy_top(random: &mut Random) -> HeavyTop {
    HeavyTop { mass_matrix: random.inertia(), weight: 1.3, center: random.vector() }
}

/// The heavy top with the inverse of F: a left action.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F.transpose(),
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
pub struct LeftTop {
    pub mass_matrix: Matrix3<f64>,
    pub weight: f64,
    pub center: Vector3<f64>,
}

/// A spherical pendulum with the inverse of F: a right action.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F.transpose() * q,
    cost      = |h, F| self.inertia * (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
)]
pub struct RightPendulum {
    pub inertia: f64,
    pub gravity: f64,
}

/// Momenta change their sign with the side, and nothing else does.
#[test]
fn left_action_and_right_action_by_the_inverse_give_the_same_motion() {
    let random = &mut Random::new(23);
    let right = heavy_top(random);
    let left = LeftTop { mass_matrix: right.mass_matrix, weight: right.weight, center: right.center };
    assert!(HeavyTop::DERIVATION.contains("from the right") && LeftTop::DERIVATION.contains("from the left"));
    let (right, left) = (right.stepper(H).expect("a top"), left.stepper(H).expect("a top"));
    let (r, pi) = (random.attitude(), random.vector::<3>());
    let starts = (right.state(r, pi).expect("a state"), left.state(r, -pi).expect("a state"));
    for (right, left) in right.trajectory(starts.0).zip(left.trajectory(starts.1)).take(200) {
        let (right, left) = (right.expect("a step"), left.expect("a step"));
        assert_near(right.configuration(), left.configuration(), NEAR, "R");
        assert_near(&right.momentum(), &-left.momentum(), NEAR, "π");
    }

    let left = SphericalPendulum { mass: 1.0, length: 1.0, gravity: 9.81 }.stepper(H).expect("a pendulum");
    let right = RightPendulum { inertia: 1.0, gravity: 9.81 }.stepper(H).expect("a pendulum");
    let (q, n) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    let starts = (left.state(q, n).expect("a state"), right.state(q, -n).expect("a state"));
    for (left, right) in left.trajectory(starts.0).zip(right.trajectory(starts.1)).take(200) {
        let (left, right) = (left.expect("a step"), right.expect("a step"));
        assert_near(left.configuration(), right.configuration(), NEAR, "q");
        assert_near(&left.momentum(), &-right.momentum(), NEAR, "N");
    }
}

/// A body by its inertia tensor and cost, and by its principal moments and Lagrangian.
#[test]
fn moser_veselov_lagrangian_is_the_cost_of_the_mass_matrix() {
    let random = &mut Random::new(24);
    let moments = Vector3::new(1.0, 1.4, 2.1);
    let cost = FreeRigidBody { inertia: Matrix3::from_diagonal(&moments) }.stepper(H).expect("a body");
    let lagrangian = PrincipalBody { moments }.stepper(H).expect("a body");
    let (r, pi) = (random.attitude(), random.vector::<3>() * 5.0);
    let starts = (cost.state(r, pi).expect("a state"), lagrangian.state(r, pi).expect("a state"));
    for (cost, lagrangian) in cost.trajectory(starts.0).zip(lagrangian.trajectory(starts.1)).take(200) {
        let (cost, lagrangian) = (cost.expect("a step"), lagrangian.expect("a step"));
        assert_near(cost.configuration(), lagrangian.configuration(), 1e-13, "R");
        assert_near(&cost.momentum(), &lagrangian.momentum(), 1e-13, "π");
    }
}

/// A body in four dimensions whose mass matrix has products of inertia.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, R: SO<4>| R * F,
    lagrangian     = |omega| (self.j_d * omega.matrix() * omega.matrix().transpose()).trace(),
    discretization = moser_veselov,
)]
pub struct Body4 {
    #[clebsch(symmetric)]
    pub j_d: Matrix4<f64>,
}

/// All entries of a mass matrix are found, those off the diagonal too.
#[test]
fn moser_veselov_lagrangian_in_four_dimensions() {
    let random = &mut Random::new(28);
    let j_d = random.inertia::<4>();
    let cost = RigidBody4 { j_d }.stepper(H).expect("a body");
    let lagrangian = Body4 { j_d }.stepper(H).expect("a body");
    let (r, mu) = (random.attitude(), random.vector::<6>());
    let starts = (cost.state(r, mu).expect("a state"), lagrangian.state(r, mu).expect("a state"));
    for (cost, lagrangian) in cost.trajectory(starts.0).zip(lagrangian.trajectory(starts.1)).take(100) {
        let (cost, lagrangian) = (cost.expect("a step"), lagrangian.expect("a step"));
        assert_near(cost.configuration(), lagrangian.configuration(), 1e-13, "R");
        assert_near(&cost.momentum(), &lagrangian.momentum(), 1e-13, "μ");
    }
}

/// A top whose potential stands in its Lagrangian.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |R, omega| omega.dot(&(self.inertia * omega)) / 2 - self.weight * (R * self.center).z,
    discretization = moser_veselov,
)]
pub struct WholeTop {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    pub weight: f64,
    pub center: Vector3<f64>,
}

/// The mean of ℓ at both ends of a step is half a kick at each.
#[test]
fn moser_veselov_lagrangian_keeps_its_potential() {
    let random = &mut Random::new(27);
    let apart = heavy_top(random);
    let mass_matrix = apart.mass_matrix;
    let inertia = Matrix3::identity() * mass_matrix.trace() - mass_matrix;
    let whole = WholeTop { inertia, weight: apart.weight, center: apart.center };
    let (apart, whole) = (apart.stepper(H).expect("a top"), whole.stepper(H).expect("a top"));
    let (r, pi) = (random.attitude(), random.vector::<3>());
    let starts = (apart.state(r, pi).expect("a state"), whole.state(r, pi).expect("a state"));
    for (apart, whole) in apart.trajectory(starts.0).zip(whole.trajectory(starts.1)).take(200) {
        let (apart, whole) = (apart.expect("a step"), whole.expect("a step"));
        assert_near(apart.configuration(), whole.configuration(), NEAR, "R");
        assert_near(&apart.momentum(), &whole.momentum(), NEAR, "π");
    }
}

/// A sledge on the plane, for which several mass matrices have one inertia.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + xi.z.powi(2))) / 2,
    discretization = moser_veselov,
)]
pub struct Sledge {
    pub inertia: f64,
    pub mass: f64,
}

/// ½ tr(ξ 𝕄 ξᵀ) is ½ (J ω² + m |v|²), and with F = (θ, a) its cost is (J (1 − cos θ) + ½ m |a|²)/h.
#[test]
fn moser_veselov_of_a_sledge() {
    let sledge = Sledge { inertia: 0.7, mass: 1.9 };
    let (sine, cosine) = 0.4_f64.sin_cos();
    let f = Matrix3::new(cosine, -sine, 0.3, sine, cosine, -0.2, 0.0, 0.0, 1.0);
    // along exp(ηξ) F the angle grows by ηω and a by η (ω k × a + v), and k × a does no work on a
    let expected = Vector3::new(0.7 * sine, 1.9 * 0.3, 1.9 * -0.2) / H;
    assert_near(&sledge.legendre(H, 0.0, &Matrix3::identity(), &f), &expected, 1e-12, "N");
}

/// A rigid body by the velocity 2(F − I)(F + I)⁻¹/h.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = cayley,
)]
pub struct CayleyBody {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// With F = cay(x), N = (Jx ± ½ x × Jx + ¼ x (x·Jx))/h before and after the step.
#[test]
fn cayley_lagrangian_has_its_explicit_momenta() {
    let random = &mut Random::new(25);
    for _ in 0..100 {
        let inertia = random.inertia::<3>();
        let body = CayleyBody { inertia };
        let x = random.vector::<3>();
        let f = clebsch_tests::oracle::rotation::cayley(&(clebsch_tests::oracle::rotation::hat(&x) / 2.0));
        let (jx, r) = (inertia * x, random.attitude());
        let momentum = |sign: f64| (jx + x.cross(&jx) * (sign / 2.0) + x * (x.dot(&jx) / 4.0)) / H;
        // divided by h = 0.02
        assert_near(&body.legendre(H, 0.0, &r, &f), &momentum(1.0), 1e-12, "N");
        assert_near(&body.legendre_next(H, 0.0, &r, &f), &momentum(-1.0), 1e-12, "N⁺");
    }
}

/// The declared scalar decides the accuracy and nothing else.
#[test]
fn generic_body_over_both_scalars() {
    let random = &mut Random::new(26);
    let top = heavy_top(random);
    let double = GenericBody::<f64> { mass_matrix: top.mass_matrix, weight: top.weight, center: top.center };
    let single = GenericBody::<f32> {
        mass_matrix: top.mass_matrix.cast(),
        weight: top.weight as f32,
        center: top.center.cast(),
    };
    let (r, pi) = (random.attitude::<3>(), random.vector::<3>());
    let steppers =
        (top.stepper(H).expect("a top"), double.stepper(H).expect("a top"), single.stepper(H as f32).expect("a top"));
    let mut states = (
        steppers.0.state(r, pi).expect("a state"),
        steppers.1.state(r, pi).expect("a state"),
        steppers.2.state(r.cast(), pi.cast()).expect("a state"),
    );
    for _ in 0..200 {
        states = (
            steppers.0.step(&states.0).expect("a step"),
            steppers.1.step(&states.1).expect("a step"),
            steppers.2.step(&states.2).expect("a step"),
        );
    }
    assert_near(states.0.configuration(), states.1.configuration(), NEAR, "f64 declared and generic");
    // 200 steps of the unit round-off 6e-8, grown linearly
    assert_near(&states.2.configuration().cast(), states.1.configuration(), 1e-4, "f32");
    assert_near(&states.2.momentum().cast(), &states.1.momentum(), 1e-4, "f32");
}

/// Half of V in the cost, at the start of the step, and half as a potential of order 1, at its end. That is order 2.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, R, F| {
        let kinetic = (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h);
        kinetic - h / 2 * self.weight * (R * self.center).z
    },
    potential = |R| self.weight * (R * self.center).z / 2,
    order     = 1,
)]
pub struct SplitTop {
    pub mass_matrix: Matrix3<f64>,
    pub weight: f64,
    pub center: Vector3<f64>,
}

/// A separable cost `|h, R, F|` is the sum of its parts.
#[test]
fn potential_inside_of_the_cost() {
    let random = &mut Random::new(27);
    let whole = heavy_top(random);
    let split = SplitTop { mass_matrix: whole.mass_matrix, weight: whole.weight, center: whole.center };
    let r = random.attitude::<3>();
    assert!((whole.potential(0.0, &r) - split.potential(0.0, &r)).abs() < 1e-15, "both parts are the potential");
    let (whole, split) = (whole.stepper(H).expect("a top"), split.stepper(H).expect("a top"));
    let pi = random.vector::<3>();
    let starts = (whole.state(r, pi).expect("a state"), split.state(r, pi).expect("a state"));
    for (whole, split) in whole.trajectory(starts.0).zip(split.trajectory(starts.1)).take(200) {
        let (whole, split) = (whole.expect("a step"), split.expect("a step"));
        assert_near(whole.configuration(), split.configuration(), NEAR, "R");
        assert_near(&whole.momentum(), &split.momentum(), NEAR, "π");
    }
}

/// A body whose constant inertia stands in space, as a left action leaves it: most often a mistake.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| F * R,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
)]
pub struct SpatialInertia {
    pub inertia: Matrix3<f64>,
}

/// A frame that only its first factor moves.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, (x, y): (Vector3, Vector3)| (x + a, y),
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    potential  = |(x, y)| self.mass * (x - y).norm_squared() / 2,
)]
pub struct Anchored {
    pub mass: f64,
}

/// A particle that motions of space move, in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SE<3>, x: Vector3| F.rotation() * x + F.translation(),
    cost      = |h, x, F| self.mass * (F.rotation() * x + F.translation() - x).norm_squared() / (2 * h),
    potential = |x| -self.mass * self.gravity.dot(&x),
)]
pub struct Thrown {
    pub mass: f64,
    pub gravity: Vector3<f64>,
}

/// A vector that unit quaternions turn.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |Q: SU<2>, x: Vector3| Q * x,
    cost      = |h, Q| self.inertia * (Q - I).norm_squared() / h,
    potential = |x| self.weight * x.z,
)]
pub struct Turned {
    pub inertia: f64,
    pub weight: f64,
}

/// Points are no frames: no product of the group element and the configuration exists. Its steps are those of a parabola.
#[test]
fn points_of_space_are_no_frames() {
    let random = &mut Random::new(63);
    let (x, v, mass, gravity) = (random.vector::<3>(), random.vector::<3>(), 1.3, random.vector::<3>());
    let stepper = Thrown { mass, gravity }.into_stepper(H).expect("a particle");
    let start = stepper.state(x, stepper.momentum_map(&x, &(mass * v))).expect("a state");
    for (k, state) in stepper.trajectory(start).take(50).enumerate() {
        let t = k as f64 * H;
        let expected = x + t * v + t * t / 2.0 * gravity;
        assert_near(state.expect("a step").configuration(), &expected, NEAR, "the place");
    }
    let stepper = Turned { inertia: 0.8, weight: 0.4 }.into_stepper(H).expect("a vector");
    let start = stepper.state(x, x.cross(&v)).expect("a state");
    let last = stepper.trajectory(start).take(50).last().expect("steps").expect("a step");
    assert!((last.configuration().norm() - x.norm()).abs() < NEAR, "{last:?}");
}

#[test]
fn the_inertia_of_a_left_action_does_not_turn() {
    let sentence = "The inertia is constant in space and does not turn with R.";
    assert!(SpatialInertia::DERIVATION.contains(sentence), "{}", SpatialInertia::DERIVATION);
    assert!(!LeftTop::DERIVATION.contains("constant in space") && !HeavyTop::DERIVATION.contains("constant in space"));
    let random = &mut Random::new(61);
    let body = SpatialInertia { inertia: random.inertia() };
    let inverse = body.inertia.try_inverse().expect("a regular inertia");
    let stepper = body.stepper(H).expect("a body");
    let mu = random.vector::<3>();
    for _ in 0..20 {
        let state = stepper.state(random.attitude(), mu).expect("a state");
        let energy = mu.dot(&(inverse * mu)) / 2.0;
        assert!((stepper.energy(&state) - energy).abs() < NEAR * energy, "{} and not {energy}", stepper.energy(&state));
    }
}

#[test]
fn a_configuration_that_nothing_moves_stays() {
    assert!(Anchored::DERIVATION.contains("Nothing moves y: it stays as it is."), "{}", Anchored::DERIVATION);
    let random = &mut Random::new(62);
    let (x, y) = (random.vector::<3>(), random.vector::<3>());
    let stepper = Anchored { mass: 1.2 }.into_stepper(H).expect("a system");
    let start = stepper.state((x, y), random.vector::<3>()).expect("a state");
    let last = stepper.trajectory(start).take(50).last().expect("steps").expect("a step");
    assert_eq!(last.configuration().1, y);
    assert_ne!(last.configuration().0, x);
}

macro_rules! damped {
    ($agree:ident: $quaternions:ident, $matrices:ident, $order:literal) => {
        /// A body whose force depends on the velocity, by quaternions.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
                            action = |F: SU<2>, Q: SU<2>| Q * F,
                            cost   = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h,
                            force  = |omega| -self.drag * omega,
                            order  = $order,
                        )]
        pub struct $quaternions {
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
            pub drag: f64,
        }

        /// The same by matrices.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
                            action = |F: SO<3>, R: SO<3>| R * F,
                            cost   = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
                            force  = |omega| -self.drag * omega,
                            order  = $order,
                        )]
        pub struct $matrices {
            #[clebsch(symmetric)]
            pub mass_matrix: Matrix3<f64>,
            pub drag: f64,
        }

        /// Both costs are one function, so both momenta move alike.
        #[test]
        fn $agree() {
            let random = &mut Random::new(63);
            let mass_matrix = random.inertia::<3>();
            let inertia = Matrix3::identity() * mass_matrix.trace() - mass_matrix;
            let quaternions = $quaternions { inertia, drag: 0.3 }.into_stepper(H).expect("a body");
            let matrices = $matrices { mass_matrix, drag: 0.3 }.into_stepper(H).expect("a body");
            let mu = random.vector::<3>() * 5.0;
            let turned = quaternions.state(Quaternion::identity(), mu).expect("a state");
            let other = matrices.state(Matrix3::identity(), mu).expect("a state");
            let last = quaternions.advance(&turned, 200).expect("steps");
            let other = matrices.advance(&other, 200).expect("steps");
            assert_near(&last.momentum(), &other.momentum(), 1e-13, "π");
            let attitude = UnitQuaternion::from_quaternion(*last.configuration()).to_rotation_matrix();
            assert_near(attitude.matrix(), other.configuration(), NEAR, "R");
            assert!(last.momentum().norm() < 0.9 * mu.norm(), "drag acts");
        }
    };
}
damped!(damped_quaternions_are_damped_matrices: DampedQuaternion, DampedMatrix, 2);
damped!(late_quaternions_are_late_matrices: LateQuaternion, LateMatrix, 1);
