//! Section 2.3: SO(n), SE(3), products.

use clebsch::Clebsch;
use clebsch_tests::fixtures::centred_body::CentredBody;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::spatial_body::SpatialBody;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::fixtures::underwater_vehicle::UnderwaterVehicle;
use clebsch_tests::oracle::body::mass_matrix;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, vee};
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4, Vector6};

use crate::{H, NEAR, assert_conserved, assert_reversible, assert_says, assert_says_nowhere};

#[test]
fn rigid_body4() {
    let random = &mut Random::new(221);
    assert_says::<RigidBody4>(&["from the right", "time-symmetric", "one scalar unknown", "no potential"]);
    let body = RigidBody4 { j_d: random.inertia() };
    let (r, f) = (random.attitude::<4>(), random.rotation::<4>(0.4));
    let expected: Vector6<f64> = components(&((f * body.j_d - body.j_d * f.transpose()) / H));
    assert_near(&body.legendre(H, 0.0, &r, &f), &expected, NEAR, "hM = FJ_d − J_dFᵀ");
    let plane = |i: usize, j: usize| format!("in the plane of e{i} and e{j}, spatial");
    let names = [plane(1, 2), plane(1, 3), plane(1, 4), plane(2, 3), plane(2, 4), plane(3, 4)];
    let mu = random.vector::<6>();
    assert_conserved(body.clone(), r, mu, names.each_ref().map(String::as_str));
    let stepper = body.stepper(H).expect("a body");
    let found = Vector6::from(*stepper.conserved(&stepper.state(r, mu).expect("a state")).values());
    let spatial = r * RigidBody4::momentum_matrix(&mu) * r.transpose();
    assert_near(&found, &components(&spatial), NEAR, "R M Rᵀ");
    assert_reversible(&body, r, mu);
}

/// (W b; 0 1).
fn motion(w: &Matrix3<f64>, b: &Vector3<f64>) -> Matrix4<f64> {
    let mut matrix = w.to_homogeneous();
    matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(b);
    matrix
}

/// (J mc; mcᵀ m).
fn moments(second_moment: &Matrix3<f64>, center: &Vector3<f64>, mass: f64) -> Matrix4<f64> {
    let mut matrix = motion(second_moment, &(center * mass));
    matrix.fixed_view_mut::<1, 3>(3, 0).copy_from(&(center * mass).transpose());
    matrix[(3, 3)] = mass;
    matrix
}

fn both(angular: Vector3<f64>, linear: Vector3<f64>) -> Vector6<f64> {
    Vector6::from_iterator(angular.iter().chain(linear.iter()).copied())
}

const FALLING: [&str; 3] = ["about e3, spatial", "along e1, spatial", "along e2, spatial"];

#[test]
fn spatial_body() {
    let random = &mut Random::new(222);
    assert_says::<SpatialBody>(&["from the right", "time-symmetric", "half kick, drift, half kick"]);
    let (second_moment, center, mass) = (random.inertia::<3>(), random.vector::<3>() * 0.3, 1.4);
    let body = SpatialBody { mass_matrix: moments(&second_moment, &center, mass), gravity: 9.81 };
    let free = SpatialBody { gravity: 0.0, ..body.clone() };
    let q = motion(&random.attitude(), &random.vector());
    let (w, b) = (random.rotation::<3>(0.5), random.vector::<3>() * 0.1);
    let linear = ((w - Matrix3::identity()) * center + b) * (mass / H);
    let turned = ((w - Matrix3::identity()) * second_moment + b * center.transpose() * mass) * w.transpose();
    let expected = both(vee(&turned) * (2.0 / H) + b.cross(&linear), linear);
    assert_near(&free.legendre(H, 0.0, &q, &motion(&w, &b)), &expected, NEAR, "h M_ω, h M_v");
    // gravity pulls at the centre of mass: (c × f, f), f = −m g Γ, over half a step
    let force = -(q.fixed_view::<3, 3>(0, 0).transpose() * Vector3::z()) * (mass * 9.81 * H / 2.0);
    let kick = body.impulse(&body.step_constants(H).expect("a body"), 0.0, &q, &nalgebra::zero());
    assert_near(&kick, &both(center.cross(&force), force), NEAR, "the weight, at the centre of mass");
    assert_conserved(body.clone(), q, random.vector(), FALLING);
    assert_reversible(&body, q, random.vector());
}

/// A body with its principal axes, by the diagonal of its mass matrix.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(self.moments) * (F - I).transpose()).trace() / (2 * h),
)]
struct PrincipalBody {
    /// Second moments and mass.
    moments: Vector4<f64>,
}

/// A body whose mass matrix is promised to be diagonal.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * self.mass_matrix * (F - I).transpose()).trace() / (2 * h),
)]
struct DiagonalBody {
    #[clebsch(diagonal)]
    mass_matrix: Matrix4<f64>,
}

#[test]
fn principal_bodies_in_space() {
    let random = &mut Random::new(226);
    assert_says::<PrincipalBody>(&["one scalar unknown"]);
    assert_says::<DiagonalBody>(&["one scalar unknown"]);
    for _ in 0..20 {
        let moments = random.inertia::<3>().diagonal().push(1.4);
        let mass_matrix = Matrix4::from_diagonal(&moments);
        let general = SpatialBody { mass_matrix, gravity: 0.0 }.stepper(H).expect("a body");
        let principal = PrincipalBody { moments }.stepper(H).expect("a body");
        let promised = DiagonalBody { mass_matrix }.stepper(H).expect("a body");
        let (q, mu) = (motion(&random.attitude(), &random.vector()), random.vector::<6>());
        let expected = general.step(&general.state(q, mu).expect("a state")).expect("a step");
        let steps = [
            principal
                .step(&principal.state(q, mu).expect("a state"))
                .map(|next| (*next.configuration(), next.momentum())),
            promised
                .step(&promised.state(q, mu).expect("a state"))
                .map(|next| (*next.configuration(), next.momentum())),
        ];
        for step in steps {
            let (place, momentum) = step.expect("a step");
            assert_near(&place, expected.configuration(), NEAR, "the place of the same body");
            assert_near(&momentum, &expected.momentum(), NEAR, "the momentum of the same body");
        }
    }
}

#[test]
fn centred_body() {
    let random = &mut Random::new(223);
    assert_says::<CentredBody>(&["from the right", "time-symmetric", "solved explicitly", "uncouples"]);
    let (inertia, mass) = (random.inertia::<3>(), 1.4);
    let centred = CentredBody { mass, inertia, gravity: 9.81 };
    let second_moment = mass_matrix(&inertia);
    let spatial = SpatialBody { mass_matrix: moments(&second_moment, &Vector3::zeros(), mass), gravity: 9.81 };
    let q = motion(&random.attitude(), &random.vector());
    let mu = random.vector::<6>();
    let (one, other) = (centred.stepper(H).expect("a body"), spatial.stepper(H).expect("a body"));
    let (mut a, mut b) = (one.state(q, mu).expect("a state"), other.state(q, mu).expect("a state"));
    for _ in 0..100 {
        (a, b) = (one.step(&a).expect("a step"), other.step(&b).expect("a step"));
        assert_near(a.configuration(), b.configuration(), 1e-11, "the same body");
        assert_near(&a.momentum(), &b.momentum(), 1e-11, "the same body");
    }
    // uncoupled: b = h M_v/m and the rotation of a free rigid body
    let free = CentredBody { gravity: 0.0, ..centred.clone() }.stepper(H).expect("a body");
    let (angular, linear) = (mu.fixed_rows::<3>(0).into_owned(), mu.fixed_rows::<3>(3).into_owned());
    let f = free.inverse_legendre(&q, &mu).expect("a step");
    let turn = FreeRigidBody { inertia }.stepper(H).expect("a body").inverse_legendre(&Matrix3::identity(), &angular);
    assert_near(&f.fixed_view::<3, 3>(0, 0).into_owned(), &turn.expect("a step"), NEAR, "Moser and Veselov for W");
    assert_near(&f.fixed_view::<3, 1>(0, 3).into_owned(), &(linear * (H / mass)), NEAR, "b = hM_v/m");
    assert_conserved(centred, q, mu, FALLING);
}

#[test]
fn underwater_vehicle() {
    let random = &mut Random::new(224);
    assert_says::<UnderwaterVehicle>(&["from the right", "time-symmetric", "half kick, drift, half kick"]);
    assert_says_nowhere::<UnderwaterVehicle>(&["solved explicitly"]);
    let vehicle = UnderwaterVehicle { inertia: random.inertia(), weight: 1.3, center: random.vector() * 0.3 };
    let q = motion(&random.attitude(), &random.vector());
    let up = q.fixed_view::<3, 3>(0, 0).transpose() * Vector3::z();
    let kick = vehicle.impulse(&vehicle.step_constants(H).expect("a vehicle"), 0.0, &q, &nalgebra::zero());
    assert_near(&kick, &both(up.cross(&vehicle.center) * (1.3 * H / 2.0), Vector3::zeros()), NEAR, "weight Γ × center");
    let mu = random.vector();
    assert_conserved(
        vehicle.clone(),
        q,
        mu,
        ["about e3, spatial", "along e1, spatial", "along e2, spatial", "along e3, spatial"],
    );
    assert_reversible(&vehicle, q, mu);
    // ½ π·J⁻¹π
    let stepper = vehicle.stepper(H).expect("a vehicle");
    let energy = stepper.kinetic_energy(&stepper.state(q, mu).expect("a state"));
    let inverse = vehicle.inertia.try_inverse().expect("a regular inertia");
    assert!((energy - mu.dot(&(inverse * mu)) / 2.0).abs() < NEAR);
}

#[test]
fn two_bodies() {
    let random = &mut Random::new(225);
    assert_says::<TwoBodies>(&["solved explicitly", "half kick, drift, half kick", "does not change in the drift"]);
    assert_says_nowhere::<TwoBodies>(&["Newton"]);
    let bodies = TwoBodies { mass: [3.0, 0.5], gravitation: 1.1 };
    let x = [random.vector::<3>(), random.vector::<3>() + Vector3::x() * 3.0];
    let between = x[1] - x[0];
    let pull = between * (1.1 * 3.0 * 0.5 / between.norm().powi(3) * H / 2.0);
    let kick = bodies.impulse(&bodies.step_constants(H).expect("bodies"), 0.0, &x, &nalgebra::zero());
    assert_near(&kick, &both(pull, -pull), NEAR, "−h/2 ∇V");
    let mu = random.vector::<6>() * 0.3;
    let names = [1, 2, 3].map(|k| format!("along e{k} of all factors, spatial"));
    assert_conserved(bodies.clone(), x, mu, names.each_ref().map(String::as_str));
    assert_reversible(&bodies, x, mu);
}

/// The bodies with the rotations offered.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<3>; 2], x: [Vector3; 2]| [x[0] + a[0], x[1] + a[1]],
    cost      = |h, a| (self.mass[0] * a[0].norm_squared() + self.mass[1] * a[1].norm_squared()) / (2 * h),
    potential = |x| -self.gravitation * self.mass[0] * self.mass[1] / (x[1] - x[0]).norm(),
    symmetry  = |S: SO<3>, x, a| ([S * x[0], S * x[1]], [S * a[0], S * a[1]]),
)]
pub struct TurnedBodies {
    pub mass: [f64; 2],
    pub gravitation: f64,
}

#[test]
fn an_offered_symmetry_adds_its_momentum() {
    let random = &mut Random::new(226);
    let bodies = TurnedBodies { mass: [3.0, 0.5], gravitation: 1.1 };
    let x = [random.vector::<3>(), random.vector::<3>() + Vector3::x() * 3.0];
    let mu = random.vector::<6>() * 0.3;
    let stepper = bodies.stepper(H).expect("bodies");
    let start = stepper.state(x, mu).expect("a state");
    let momenta = stepper.conserved(&start);
    assert_eq!(momenta.names().len(), 6, "{momenta}");
    let p = [mu.fixed_rows::<3>(0).into_owned(), mu.fixed_rows::<3>(3).into_owned()];
    let angular = x[0].cross(&p[0]) + x[1].cross(&p[1]);
    for component in angular.iter() {
        assert!(momenta.values().iter().any(|value| (value - component).abs() < NEAR), "{component} in\n{momenta}");
    }
    let names = *momenta.names();
    assert_conserved(bodies, x, mu, names);
}

/// One space, both sides.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |(F, W): (SO<3>, SO<3>), R: Matrix3| W * R * F,
    cost   = |h, (F, W)| ((F - I).norm_squared() + 3 * (W - I).norm_squared()) / (4 * h),
)]
pub struct BothSides;

#[test]
fn sides_are_found_for_each_factor() {
    assert_says::<clebsch_tests::fixtures::sided_pair::SidedPair>(&["acts from the right", "acts from the left"]);
    assert_says::<BothSides>(&["F in SO<3> acts from the right", "W in SO<3> acts from the left"]);
}
