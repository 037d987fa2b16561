//! Scenes that fail.

use crate::Scene;
use clebsch::{
    Alike, Clebsch, Controlled, Error, F64x4, Field, Guess, Mesh, Prior, Relaxation, Scalar, SiteStorage, State, Target,
};
use clebsch_tests::fixtures::chaplygin_sleigh::ChaplyginSleigh;
use clebsch_tests::fixtures::collocated_top::CollocatedTop;
use clebsch_tests::fixtures::damped_body::DampedBody;
use clebsch_tests::fixtures::eccentric_orbit::EccentricOrbit;
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::fixtures::follower::Follower;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::frugal_car::FrugalCar;
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::promised_top::PromisedTop;
use clebsch_tests::fixtures::regulator::Regulator;
use clebsch_tests::fixtures::rolling_ball::RollingBall;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::spin_chain::SpinChain;
use clebsch_tests::fixtures::steered_body::SteeredBody;
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Matrix2, Matrix3, Quaternion, Vector1, Vector2, Vector3, Vector5};

/// A film over a frame, its height x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    space  = |length, x, next| (next - x).norm_squared() / 2,
)]
pub struct Film;

/// The last one is where the first one is.
const CORNERS: [Vector2<f64>; 4] =
    [Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Vector2::new(1.0, 1.0), Vector2::new(0.0, 0.0)];

fn mesh(faces: &[Vec<usize>]) -> Result<Mesh<f64>, Error> {
    Mesh::new(&CORNERS, faces)
}

/// A potential whose gradient has the wrong sign.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = opaque(Self::value, Self::gradient),
)]
pub struct Mistaken;

impl Mistaken {
    fn value(&self, x: &Vector3<f64>) -> f64 {
        x.y * x.y / 2.0
    }
    fn gradient(&self, x: &Vector3<f64>) -> Vector3<f64> {
        Vector3::y() * -x.y
    }
}

/// A ball that falls up, at 2 m/s².
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| -2 * x.x,
    scalar    = f64,
)]
pub struct Thrown;

/// A point on a sphere about the origin.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Vector3| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    emit   = [boundary],
)]
pub struct Swivel;

/// A drive that pulls past the speed that it is set to, where at h = 1 the solution of the step turns back.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    force  = |v| 2 * (v - self.speed * Vector1::x()) * v.norm_squared(),
    solver = fixed_point,
    emit   = [tangent],
)]
pub struct Trolley {
    /// m/s.
    pub speed: f64,
}

/// A particle whose two constraints are one on the line x = y.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    constraint = |x, v| [v.x == v.y, x.x * v.x == x.y * v.y],
)]
pub struct Crossing;

/// A mass on a rod of length one.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    constraint = |x| [x.norm_squared() == 1],
)]
pub struct Rod;

/// Rotations in the plane along a line.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<2>, R: SO<2>| R * F,
    space  = |ds, W| (W - I).norm_squared() / (4 * ds),
    emit   = [connection],
)]
struct Ribbon;

fn principal() -> Vector3<f64> {
    Vector3::new(1.0, 1.4, 1.9)
}

fn ring() -> SpinChain<4> {
    SpinChain { exchange: 1.0, field: Vector3::z() }
}

fn top() -> HeavyTop {
    HeavyTop { mass_matrix: Matrix3::from_diagonal(&principal()), weight: 1.3, center: Vector3::z() }
}

fn promised() -> PromisedTop {
    PromisedTop {
        inertia: Matrix3::from_diagonal(&principal()),
        weight: 1.3,
        up: Vector3::z(),
        center: Vector3::new(0.1, 0.0, 0.3),
    }
}

fn pendulum() -> SphericalPendulum {
    SphericalPendulum { mass: 2.0, length: 0.5, gravity: 0.0 }
}

/// The error of a call that has to fail.
#[track_caller]
fn refused<T>(result: Result<T, Error>) -> Error {
    result.err().expect("an error")
}

/// At least one for each variant.
pub fn scenes() -> Vec<Scene> {
    [parameters(), lattices(), states(), steps(), extremals(), through_a_singularity(), plans()]
        .into_iter()
        .flatten()
        .collect()
}

fn scene(error: Error, told: &'static [&'static str]) -> Scene {
    Scene { error, told }
}

fn lattices() -> Vec<Scene> {
    let film = Film.mesh(&CORNERS, &[[0, 1, 2]]).expect("a mesh");
    let relaxed = |relaxation: Relaxation<'_, Film, Mesh<f64>, Alike>, height: f64| {
        let mut heights = [0.0, height, 0.0, 0.0].map(Vector1::new);
        refused(relaxation.solve(&mut heights).map_err(|error| error.error))
    };
    let (ribbon, identity) = (Ribbon.grid([3]).periodic(), Matrix2::identity());
    let reconstructed = |elements: &[Matrix2<f64>], start: usize| {
        refused(ribbon.reconstruct(elements, (start, identity), 1e-9).map_err(|error| error.error))
    };
    vec![
        scene(refused(mesh(&[vec![0, 1, 4]])), &["face 0 has the corner 4", "4 vertices", "from 0 on"]),
        scene(refused(mesh(&[vec![0, 1]])), &["face 0 has 2 different corners", "at least three"]),
        scene(
            refused(mesh(&[vec![0, 1, 2], vec![1, 2, 3]])),
            &["face 1 runs from vertex 1 to 2", "as another face does", "the other way round"],
        ),
        scene(refused(mesh(&[vec![0, 1, 3]])), &["the vertices 3 and 0 are 0 apart", "different finite places"]),
        scene(
            refused(mesh(&[vec![0, 1, 2]]).and_then(|mesh| mesh.weight([0, 3]))),
            &["no face has an edge between the vertices 0 and 3"],
        ),
        scene(
            relaxed(film.clone().weights(|_| f64::NAN).relax(), 0.0),
            &["the edge of the vertices 0 and 1 has the weight NaN", "give a finite one"],
        ),
        scene(
            relaxed(film.relax().over_relaxation(2.5), 0.0),
            &["the factor of over-relaxation is 2.5", "above 0 and below 2"],
        ),
        scene(
            refused(ribbon.flatness(&[identity; 2])),
            &["there are 2 elements for 3 edges", "the identity where a side has no edge"],
        ),
        scene(
            reconstructed(&[identity, identity, -identity], 0),
            &["the element of the edge from 1 to 2 is 2.000e0 off", "above 1.000e-9", "goes around a hole"],
        ),
        scene(
            reconstructed(&[identity; 3], 5),
            &["no path of edges leads from the site 5 to the site 0", "start at a site of the lattice"],
        ),
        scene(
            relaxed(film.relax().sweeps(1), 1.0),
            &["after 1 sweeps", "above 1.000e-10", "go on from this configuration"],
        ),
    ]
}

fn parameters() -> Vec<Scene> {
    let mut skew = Matrix3::identity();
    skew[(0, 2)] = 0.1;
    let massless = FreeRigidBody { inertia: Matrix3::zeros() };
    let broken = HeavyTop { weight: f64::NAN, ..top() };
    let wrong = Mistaken.check_potential(&Vector3::new(1.0, 2.0, 3.0));
    vec![
        Scene {
            error: ring()
                .into_stepper(0.1)
                .expect("a ring")
                .sites(SiteStorage::of(vec![Vector3::x(); 3], vec![Vector3::zeros(); 4]))
                .expect_err("3 of 4")
                .error,
            told: &["3 entries", "4 sites", "one entry for each site"],
        },
        scene(
            refused(WaveMap.grid([3, 0]).stepper(0.1)),
            &["0 sites in direction 1", "give each direction at least one"],
        ),
        scene(
            refused(WaveMap.grid([3, 3]).spacing([0.5, -0.5]).stepper(0.1)),
            &["the spacing in direction 1 is -0.5", "above zero"],
        ),
        scene(
            refused(WaveMap.grid([3, 3]).slab(2..5).map(|part| part.lattice().sites())),
            &["the rows 2..5 of a grid with 3 rows", "none beyond the last"],
        ),
        Scene {
            error: {
                let stepper = WaveMap.grid([2, 2]).stepper(1.25).expect("a stepper");
                let state = stepper.state([Vector3::x(); 4], [Vector3::zeros(); 4]).expect("a state");
                stepper.check_stable(&state).expect_err("above 1").error
            },
            told: &["the step size 1.25", "above 1, up to which", "take shorter steps"],
        },
        scene(refused(top().stepper(0.0)), &["the step size is 0", "a finite number other than zero"]),
        scene(
            refused(broken.stepper(0.1)),
            &["weight is not finite", "look for NaN, infinity, division by zero or overflow"],
        ),
        scene(
            refused(FreeRigidBody { inertia: skew }.stepper(0.1)),
            &[
                "`inertia` is declared symmetric",
                "1.000e-1",
                "pass (inertia + inertiaᵀ)/2, or remove `#[clebsch(symmetric)]`",
            ],
        ),
        scene(
            refused(FreeRigidBody { inertia: Matrix3::from_diagonal(&Vector3::new(1.0, -2.0, 3.0)) }.stepper(0.1)),
            &[
                "negative for some velocities",
                "from -2.000e0 to 3.000e0",
                "the signs of masses and moments of inertia",
                "declare `signature = indefinite`",
            ],
        ),
        scene(
            refused(PromisedTop { inertia: skew, ..promised() }.stepper(0.1)),
            &["`inertia` is declared diagonal", "1.000e-1", "set it to zero, or remove `#[clebsch(diagonal)]`"],
        ),
        scene(
            refused(PromisedTop { up: Vector3::z() * 2.0, ..promised() }.stepper(0.1)),
            &["`up` is declared a unit vector", "its length is 2", "pass up.normalize(), or remove `#[clebsch(unit)]`"],
        ),
        scene(
            refused(massless.stepper(0.1)),
            &["condition number inf", "check masses and moments of inertia for zeros"],
        ),
        scene(refused(wrong), &["entry 1", "-2.0", "differences of the value give 2.0", "check the sign"]),
    ]
}

fn states() -> Vec<Scene> {
    let stepper = top().stepper(0.1).expect("a top");
    let (r, mu) = (Matrix3::identity(), Vector3::z());
    let sphere = pendulum().stepper(0.1).expect("a pendulum");
    let bodies = [(r, mu), (r, mu)];
    let mut ensemble = stepper.clone().ensemble(bodies).expect("two tops");
    let spins = SiteStorage::of([Vector3::x(); 4], [Vector3::z(); 4]);
    let mut chain = ring().into_stepper(0.1).expect("a ring").sites(spins).expect("its sites");
    let damped = DampedBody { inertia: Matrix3::identity(), damping: 0.1 }.into_stepper(0.1).expect("a body");
    let covector = damped.cotangent_state(r, r).expect("a state");
    let sleigh = ChaplyginSleigh { mass: 1.5, inertia: 0.4, offset: 0.6 }.into_stepper(0.1).expect("a sleigh");
    let crossing = Crossing.into_stepper(0.1).expect("a crossing");
    let ball = RollingBall { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 };
    let turning = ball.into_stepper(50.0).expect("a ball");
    let rolling = turning.project(Vector2::new(3.0, -2.0), Vector5::new(0.2, 0.4, 0.1, -0.3, 0.35)).expect("a state");
    let turning_top = stepper.state(r, mu).expect("a state");
    let late = stepper.trajectory(turning_top).at([0.3, 0.2]).find_map(Result::err).expect("times out of order");
    // x = (t − 1)², up to a factor that is its unit
    let ball = Thrown.into_stepper(0.4).expect("a ball");
    let thrown = ball.state(Vector1::new(1.0), Vector1::new(-2.0)).expect("a state");
    let value = |state: &State<Thrown>| state.configuration().x;
    let undefined =
        ball.trajectory(thrown).events(5, |state| [clebsch::Crossing::Either((value(state) - 0.5).sqrt())]).next();
    let touch = ball.trajectory(thrown).events(5, |state| [clebsch::Crossing::Either(value(state))]).next();
    let mut ceiling = ball.trajectory(thrown).events(9, |state| [clebsch::Crossing::Falling(0.5 - value(state))]);
    let hit = ceiling.next().expect("the ceiling").expect("an event");
    ceiling.go_on_from(ball.state(*hit.state.configuration(), Vector1::zeros()).expect("at rest below it"));
    let resting = ceiling.next();
    let orbit = EccentricOrbit { mass: 1.0, strength: 1.0 }.into_stepper(0.1).expect("an orbit");
    vec![
        scene(
            refused(orbit.state(Vector3::zeros(), Vector3::x())),
            &["the function of `step` is 0.000e0", "positive and finite", "take smaller steps"],
        ),
        scene(late, &["0.2 comes after 0.3", "in the order in which steps reach them"]),
        scene(refused(undefined.expect("an error")), &["event 0 is not finite", "NaN"]),
        scene(refused(touch.expect("an error")), &["event 0 touches zero", "the zeros of its rate"]),
        scene(refused(resting.expect("an error")), &["event 0 does not leave the zero", "set another momentum"]),
        scene(
            refused(sleigh.state_moving(r, Vector3::new(1.0, 0.5, 0.25))),
            &["the velocity violates the constraint by 2.500e-1", "start by `Stepper::project`, or give a velocity"],
        ),
        scene(
            refused(Rod.into_stepper(0.1).expect("a rod").state(Vector2::new(1.0, 1.0), Vector2::zeros())),
            &[
                "the configuration violates the constraint by 1.000e0",
                "start by `Stepper::project`, or from one that obeys every equation",
            ],
        ),
        scene(
            refused(Rod.into_stepper(0.1).expect("a rod").project(Vector2::new(1e-12, 0.0), Vector2::zeros())),
            &[
                "no configuration that obeys the constraint was found near",
                "after 32 corrections",
                "start nearer to one",
            ],
        ),
        scene(
            refused(turning.step(&rolling)),
            &["the step of 5.000e1 is too long", "no solution near those of short steps", "reduce the step size to"],
        ),
        scene(
            refused(crossing.state(Vector2::new(1.0, 1.0), Vector2::zeros())),
            &["the 2 rows of the constraint have rank 1 at this configuration", "leave out the equations"],
        ),
        scene(refused(stepper.state(r * f64::NAN, mu)), &["the configuration is not finite"]),
        scene(
            refused(stepper.state(r * 1.01, mu)),
            &[
                "off its space by 2.010e-2 where 1.5e-8 is accepted",
                "normalise it",
                "orthonormal columns to a rotation",
            ],
        ),
        scene(
            refused(stepper.state(-r, mu)),
            &["a reflection instead of a rotation", "check the sign of its determinant"],
        ),
        scene(
            refused(sphere.state(Vector3::y(), Vector3::new(1.0, 0.25, 0.5))),
            &["a component of 2.500e-1", "start by `Stepper::project` or compute it by `momentum_map`"],
        ),
        scene(
            refused(chain.kick(4, Vector3::zeros()).map_err(Error::from)),
            &["no site 4 among 4", "give a number below 4"],
        ),
        scene(refused(ensemble.set_body(2, (r, mu))), &["no body 2 in an ensemble of 2", "give a number below 2"]),
        scene(refused(damped.step_symmetric(&covector)), &["no step in (q, p)", "step in (q, N), by `Stepper::step`"]),
    ]
}

fn steps() -> Vec<Scene> {
    let sphere = pendulum().stepper(0.1).expect("a pendulum");
    let fast = sphere.state(Vector3::z(), Vector3::new(6.0, 8.0, 0.0)).expect("a state");
    let long = CollocatedTop { moments: principal(), weight: 1.3 }.into_stepper(40.0).expect("a top");
    let lying = long.state(Quaternion::new(0.8, 0.0, 0.6, 0.0), principal()).expect("a state");
    let lanes = GenericBody {
        mass_matrix: top().mass_matrix.map(F64x4::splat),
        weight: F64x4::splat(1.0),
        center: Vector3::z().map(F64x4::splat),
    };
    let lanes = lanes.into_stepper(F64x4::splat(0.1)).expect("tops");
    let spin = |lane: usize| if lane == 2 { 1e3 } else { 1.0 };
    let tops = lanes.state(Matrix3::identity(), Vector3::z().map(|z: f64| F64x4::from_lanes(|lane| z * spin(lane))));
    let exact = ExactBody { moments: principal() }.into_stepper(0.1).expect("a body");
    let turning = exact.state(Matrix3::identity(), Vector3::new(0.1, 2.0, 0.1)).expect("a state");
    let edge = Trolley { speed: 1.0 }.into_stepper(1.0).expect("a trolley");
    let running = edge.state(Vector1::zeros(), Vector1::x()).expect("a state");
    vec![
        scene(
            refused(sphere.step(&fast)),
            &["the step of 1.000e-1 is too long", "up to 0.500 times it", "reduce the step size to 4.9"],
        ),
        scene(refused(long.step(&lying)), &["was not solved in", "reduce the step size"]),
        scene(
            refused(lanes.step(&tops.expect("states"))),
            &[
                "the step of lane 2 failed",
                "`Stepper::failure` says why",
                "`Stepper::step_each` steps those that can be",
            ],
        ),
        scene(
            refused(exact.suggest_step_size(&turning, 1e-17, 100.0)),
            &["an error of 1.0e-17", "ask for more than that, or for a shorter duration"],
        ),
        scene(refused(edge.step_tangent(&running)), &["the step of 1.000e0 has no derivative", "reduce the step size"]),
    ]
}

fn extremals() -> Vec<Scene> {
    let x = Vector3::x();
    let stepper = Swivel.into_stepper(0.1).expect("a point");
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&x); 8];
    vec![
        scene(
            refused(boundary.solve(&x, &Vector3::y(), Guess::Geodesic, &mut [])),
            &["a path of 0 nodes was given", "give 1 for each step, and at least one step"],
        ),
        scene(
            refused(boundary.solve(&x, &-x, Guess::Geodesic, &mut path)),
            &["2.000e0 away", "give a velocity as the guess"],
        ),
        scene(
            refused(boundary.solve(&x, &(Vector3::y() * 3.0), Guess::Geodesic, &mut path)),
            &["2.000e0 were left", "check that the target is on the orbit", "give a velocity as the guess"],
        ),
    ]
}

/// A body about a sun.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| -self.gravity / x.norm(),
    emit      = [boundary],
)]
struct Kepler {
    gravity: f64,
}

/// Straight through the sun.
fn through_a_singularity() -> Vec<Scene> {
    let stepper = Kepler { gravity: 1.0 }.into_stepper(0.1).expect("a sun");
    let (boundary, x) = (stepper.boundary(), Vector3::new(0.9, 0.23, -0.41));
    let mut path = vec![boundary.rest(&x); 20];
    let error = refused(boundary.solve(&x, &-x, Guess::Geodesic, &mut path));
    vec![scene(error, &["no extremal: momenta jump by", "it may pass a singularity", "by another guess"])]
}

fn plans() -> Vec<Scene> {
    let regulator = Regulator { mass: 1.3, stiffness: 2.0, price: 0.5 }.control(0.1).expect("a regulator");
    let start = Vector2::new(1.0, -0.4);
    // a force moves the velocity in the first step, and the place in the second
    let mut one = [regulator.stage(&start); 1];
    // each newton more is paid for
    let paid = Regulator { mass: 1.3, stiffness: 2.0, price: -0.5 }.control(0.1).expect("a regulator");
    let mut many = [paid.stage(&start); 20];
    let follower = Follower { price: 1.0, clearance: 0.1, miss_price: 1.0 }.control(0.1).expect("a follower");
    let mut followed = [follower.stage(&Matrix3::identity()); 5];
    follower.refer(&mut followed, |k, _| (Vector2::zeros(), Vector2::new(if k == 3 { f64::NAN } else { 1.0 }, 0.0)));
    let frugal =
        FrugalCar { turning: -1.0, off: 1.0, fine: 1.0, fast: 1.0, fastest: 2.0, miss_price: 1.0, goal: Vector2::x() };
    let frugal = frugal.control(0.1).expect("a car");
    let prior = |information| {
        Regulator { mass: 1.3, stiffness: 2.0, price: 0.5 }.control(0.1)?.with_prior(Prior::new(start, information))
    };
    let mut guessed = prior(Matrix2::identity()).expect("a prior");
    let steered = |top: f64| {
        let body = SteeredBody { inertia: Matrix3::identity(), damping: 0.1, top };
        let control = body.control(0.1).expect("a body");
        let (rest, goal) = ((Matrix3::identity(), Vector3::zeros()), (Matrix3::identity(), Vector3::x()));
        let mut plan = [control.stage(&rest); 5];
        refused(control.solve(&rest, Target::Place(goal), &mut plan).map(|_| ()))
    };
    vec![
        scene(
            refused(regulator.solve(&start, Target::Place(Vector2::zeros()), &mut one)),
            &[
                "no small change of the inputs",
                "check that the inputs control all that the target fixes",
                "enough steps",
            ],
        ),
        scene(
            refused(paid.solve(&start, Target::Free, &mut many)),
            &[
                "no extremal was found in 400 linearisations",
                "give a better guess",
                "check that its price cannot fall for ever",
            ],
        ),
        scene(steered(-0.1), &["`torque.x <= self.top` is violated by", "relax it, or guess inputs that keep it"]),
        scene(steered(0.1), &["were left after", "give more steps or wider bounds"]),
        scene(
            refused(frugal.solve(&Matrix3::identity(), Target::Free, &mut [frugal.stage(&Matrix3::identity()); 3])),
            &["the factor of `u.x.abs()` in the price is -2.000e-1", "it has to be positive, or 0"],
        ),
        scene(
            refused(regulator.solve(&start, Target::Conditions, &mut one)),
            &["the declaration has no `target`", "write `target = |q| [a == b]`", "or pass `Target::Place`"],
        ),
        scene(
            refused(prior(Matrix2::new(1.0, 0.0, 0.0, -2.0))),
            &["the information of the prior has the eigenvalue -2.000e0", "the inverse of a covariance"],
        ),
        scene(
            refused(guessed.slide(&mut one, 3)),
            &["the plan has 1 steps, fewer than the 3", "by which the estimate is to go on"],
        ),
        scene(
            refused(follower.solve(&Matrix3::identity(), Target::Free, &mut followed)),
            &[
                "reference 3 is missing",
                "those of the 5 steps, counted from 0",
                "the end, number 5",
                "`Control::refer`",
                "`Control::with_end_reference`",
            ],
        ),
    ]
}
