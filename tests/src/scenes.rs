//! The accepted fixtures with ordinary parameters, a place to start from and a step size.

use nalgebra::*;

/// Principal moments of inertia.
pub fn principal() -> Vector3<f64> {
    Vector3::new(1.0, 1.4, 1.9)
}

/// An inertia tensor.
pub fn inertia() -> Matrix3<f64> {
    let mut inertia = Matrix3::from_diagonal(&principal());
    (inertia[(0, 1)], inertia[(1, 0)]) = (0.1, 0.1);
    inertia
}

/// A centre of mass.
pub fn centre() -> Vector3<f64> {
    Vector3::new(0.1, -0.2, 0.7)
}

/// A mass matrix in four dimensions.
pub fn four() -> Matrix4<f64> {
    Matrix4::from_diagonal(&Vector4::new(1.0, 1.5, 0.8, 1.2))
}

/// A mass matrix in N dimensions.
pub fn many<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| if i == j { 1.0 + 0.1 * i as f64 } else { 0.0 })
}

/// A rotation.
pub fn turned() -> Matrix3<f64> {
    Matrix3::new(0.0, -1.0, 0.0, 0.6, 0.0, -0.8, 0.8, 0.0, 0.6)
}

/// A unit quaternion.
pub fn quaternion() -> Quaternion<f64> {
    Quaternion::new(0.8, 0.0, 0.6, 0.0)
}

/// A unit vector.
pub fn unit() -> Vector3<f64> {
    Vector3::new(0.6, 0.0, 0.8)
}

/// The projector to a plane in four dimensions.
pub fn plane() -> Matrix4<f64> {
    Matrix4::new(0.36, 0.0, 0.48, 0.0, 0.0, 0.64, 0.0, 0.48, 0.48, 0.0, 0.64, 0.0, 0.0, 0.48, 0.0, 0.36)
}

/// A rigid motion.
pub fn placed() -> Matrix4<f64> {
    let mut placed = turned().to_homogeneous();
    placed[(0, 3)] = 0.5;
    placed
}

/// The inertia of a rattleback.
pub fn rocker() -> Matrix3<f64> {
    Matrix3::new(1.6e-3, -2e-4, 0.0, -2e-4, 2e-3, 0.0, 0.0, 0.0, 2.2e-3)
}

/// An upright body whose centre is so far below the origin.
pub fn hanging(depth: f64) -> Matrix4<f64> {
    Matrix4::new_translation(&Vector3::new(0.0, 0.0, -depth))
}

/// A body whose centre is 2 cm above the plane.
pub fn resting() -> Matrix4<f64> {
    Matrix4::new_translation(&Vector3::new(0.0, 0.0, 0.02))
}

/// Calls the macro `$scenes` with a line for one fixture of each kind. The line has a name, the system with its
/// parameters, a configuration on its orbit and a step size. Lines behind `$scenes` are added to these.
///
/// The caller imports `clebsch_tests::fixtures::*`, `clebsch_tests::scenes::*` and `nalgebra::*`.
#[rustfmt::skip]
#[macro_export]
macro_rules! scenes_of_each_kind {
    ($scenes:ident $($more:tt)*) => {
        $scenes! {
            a_collocated_top: collocated_top::CollocatedTop { moments: principal(), weight: 1.3 }, quaternion(), 0.1;
            a_double_pendulum: double_pendulum::DoublePendulum { mass: [1.0, 0.7], length: [1.0, 0.8], gravity: 9.81 }, [unit(), Vector3::x()], 0.05;
            an_exact_body: exact_body::ExactBody { moments: principal() }, turned(), 0.1;
            an_eccentric_orbit: eccentric_orbit::EccentricOrbit { mass: 1.2, strength: 0.9 }, centre(), 0.05;
            a_flying_body: flying_body::FlyingBody { mass: 1.2, mass_matrix: inertia().cast(), hook: centre().cast(), stiffness: 2.0 },
                (Vector3::new(0.5, 0.2, -0.3), turned().cast()), 0.05;
            a_generic_body_in_single_precision: generic_body::GenericBody<f32> { mass_matrix: inertia().cast(), weight: 1.3, center: centre().cast() },
                turned().cast(), 0.05;
            a_gravity_gradient: gravity_gradient::GravityGradient { inertia: inertia(), orbital_rate: 0.8 }, turned(), 0.05;
            a_growing_shape: growing_shape::GrowingShape { stiffness: 1.2 }, Matrix3::identity(), 0.05;
            harmonics: harmonics::Harmonics { mass: 1.2 , coefficients: [[0.1, 0.2, 0.1, 0.05]; 4] }, centre(), 0.05;
            a_heavy_top: heavy_top::HeavyTop { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_spherical_pendulum: spherical_pendulum::SphericalPendulum { mass: 0.7, length: 1.3, gravity: 9.81 }, unit(), 0.05;
            a_spin_chain: spin_chain::SpinChain<3> { exchange: 0.7, field: centre() }, [unit(), Vector3::x(), -unit()], 0.05;
            a_rolling_ball: rolling_ball::RollingBall { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 }, Vector2::new(0.3, -0.2), 0.05;
            a_steered_bob: steered_bob::SteeredBob { mass: 1.2, gravity: 9.81, drag: 0.2 }, unit(), 0.05;
            a_momentum_that_tumbles: tumbling_momentum::TumblingMomentum { inertia: inertia() }, (), 0.1;
            $($more)*
        }
    };
}

/// The same with a line for each fixture that can be stepped.
#[rustfmt::skip]
#[macro_export]
macro_rules! every_scene {
    ($scenes:ident) => {
        $crate::scenes_of_each_kind! {
            $scenes
            a_compensated_top: compensated_top::CompensatedTop { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_first_order_top: first_order_top::FirstOrderTop { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_reduced_heavy_top: heavy_top_reduced::HeavyTopReduced { mass_matrix: inertia(), moment: centre() }, unit(), 0.05;
            a_damped_body: damped_body::DampedBody { inertia: inertia(), damping: 0.1 }, turned(), 0.1;
            an_exact_body_in_four_dimensions: exact_body4::ExactBody4 { mass: four() }, Matrix4::identity(), 0.1;
            a_planar_pendulum: planar_pendulum::PlanarPendulum { 0: 1.2, 1: 0.8 }, Vector2::new(0.6, -0.8), 0.05;
            a_natural_pendulum: natural_pendulum::NaturalPendulum { mass: 0.7, weight: 1.3 }, unit(), 0.05;
            a_split_top: split_top::SplitTop { inertia: inertia(), weight: 1.3, center: centre() }, turned(), 0.1;
            a_tolerant_top: tolerant_top::TolerantTop { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_bounded_top: bounded_top::BoundedTop { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_free_particle: free_particle::FreeParticle { mass: 1.2 }, Vector1::new(0.5), 0.1;
            a_midpoint_top: midpoint_top::MidpointTop { mass_matrix: inertia(), weight: 1.3, stiffness: 0.7, center: centre() }, turned(), 0.05;
            neumanns_motion: neumann::Neumann { stiffness: four() }, Vector4::new(0.6, 0.0, 0.8, 0.0), 0.05;
            a_principal_body: principal_body::PrincipalBody { moments: principal() }, turned(), 0.1;
            a_promised_top: promised_top::PromisedTop { inertia: Matrix3::from_diagonal(&principal()), weight: 1.3, up: unit(), center: centre() }, turned(), 0.05;
            a_quaternion_top: quaternion_top::QuaternionTop { inertia: inertia(), moment: centre() }, quaternion(), 0.05;
            a_projected_body: projected_body::ProjectedBody { inertia: inertia() }, turned(), 0.05;
            a_top_of_three_ways: three_ways::ThreeWays { moments: Vector3::new(2.0, 1.5, 1.0), weight: 3.0, center: centre() }, turned(), 0.05;
            two_bodies: two_bodies::TwoBodies { mass: [1.0, 2.0], gravitation: 1.1 }, [Vector3::x(), -Vector3::y()], 0.05;
            a_watched_top: watched_top::WatchedTop { mass: principal(), weight: 1.3 }, turned(), 0.05;
            a_moving_frame: moving_frame::MovingFrame { mass: 0.8, pull: Matrix3x2::new(0.3, -0.4, 1.0, 0.2, 0.1, 0.9) },
                Matrix3x2::new(0.6, 0.0, 0.0, 1.0, 0.8, 0.0), 0.05;
            a_plane_in_four_dimensions: rayleigh_plane::RayleighPlane { mass: 0.7, form: four() }, plane(), 0.05;
            a_geodesic_of_covariances: covariance_geodesic::CovarianceGeodesic { }, Matrix2::new(1.2, 0.3, 0.3, 0.9), 0.1;
            a_centred_body: centred_body::CentredBody { mass: 1.2, inertia: inertia(), gravity: 9.81 }, placed(), 0.05;
            a_fluid_ellipsoid: fluid_ellipsoid::FluidEllipsoid { mass: 1.2 }, Matrix3::identity(), 0.05;
            a_free_rigid_body: free_rigid_body::FreeRigidBody { inertia: inertia() }, turned(), 0.1;
            a_generic_body: generic_body::GenericBody<f64> { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_heisenberg_geodesic: heisenberg_geodesic::HeisenbergGeodesic { mass: principal() }, Matrix3::identity(), 0.05;
            linear_optics: linear_optics::LinearOptics { }, Matrix4::identity(), 0.05;
            a_lopsided_pendulum: lopsided_pendulum::LopsidedPendulum { mass: 1.2, gravity: 9.81 }, unit(), 0.05;
            a_lorentz_frame: lorentz_frame::LorentzFrame { inertia: 1.2, field: Vector4::new(0.1, 0.2, 0.3, 0.4), spin: Vector4::new(1.0, 0.5, 0.2, 0.1) },
                Matrix4::identity(), 0.05;
            neumanns_motion_in_many_dimensions: neumann20::Neumann20 { stiffness: many() }, SVector::from_fn(|i, _| if i == 4 { 1.0 } else { 0.0 }), 0.05;
            a_paper_pendulum: paper_pendulum::PaperPendulum { gravity: 9.81 }, unit(), 0.05;
            a_principal_body_in_four_dimensions: principal_body4::PrincipalBody4 { j_d: Vector4::new(1.0, 1.5, 0.8, 1.2) }, Matrix4::identity(), 0.1;
            a_relativistic_particle: relativistic_particle::RelativisticParticle { mass: 1.2, force: centre() }, centre(), 0.05;
            a_body_in_four_dimensions: rigid_body4::RigidBody4 { j_d: four() }, Matrix4::identity(), 0.1;
            a_body_in_five_dimensions: driven_body5::DrivenBody5 { j_d: many(), drag: 0.2 }, SMatrix::identity(), 0.1;
            a_driven_chain: driven_chain::DrivenChain<3> { inertia: 1.2, stiffness: 0.7, friction: [0.1, 0.0, 0.2] },
                [Vector2::new(0.6, -0.8), Vector2::x(), -Vector2::y()], 0.05;
            a_body_in_seven_dimensions: rigid_body7::RigidBody7 { j_d: many() }, SMatrix::identity(), 0.1;
            a_tractor_with_a_trailer: tractor_trailer::TractorTrailer {
                mass: [1.5, 0.8], inertia: [0.4, 0.25], offset: [0.3, -0.2], hitch: [Vector2::new(-0.4, 0.0), Vector2::new(0.9, 0.0)]
            }, [Matrix3::identity(), Matrix3::new_translation(&Vector2::new(-1.3, 0.0))], 0.05;
            a_sleigh: chaplygin_sleigh::ChaplyginSleigh { mass: 1.5, inertia: 0.4, offset: 0.6 }, Matrix3::identity(), 0.05;
            a_snakeboard: snakeboard::Snakeboard { mass: 1.2, length: 0.8, rotor: 0.3, wheel: 0.15 },
                (Matrix3::identity(), Vector1::new(0.0), Vector1::new(0.6)), 0.02;
            a_rattleback: rattleback::Rattleback { inertia: rocker(), mass: 1.0, gravity: 9.81, axes: Vector3::new(0.2, 0.03, 0.02), height: 0.0 },
                resting(), 0.002;
            jointed_bodies: jointed_bodies::JointedBodies {
                second_moments: [inertia(), inertia()], mass: [1.0, 0.7], gravity: 9.81, near: [Vector3::z(), Vector3::z()], far: -Vector3::z()
            }, [hanging(1.0), hanging(3.0)], 0.02;
            a_hanging_chain: hanging_chain::HangingChain<2> { mass_matrix: four(), weight: 9.81, near: Vector3::z(), far: -Vector3::z() },
                [hanging(1.0), hanging(3.0)], 0.02;
            a_shaken_pendulum: shaken_pendulum::ShakenPendulum {
                mass: 1.2, gravity: 9.81, drag: 0.1, shaking: 0.1, rate: 3.0, length: 0.8
            }, Vector2::new(0.8, 0.0), 0.02;
            branching_bodies: branching_bodies::BranchingBodies<7> { second_moment: inertia(), mass: 0.7, weight: 9.81, near: Vector3::z(), far: -Vector3::z(), side: -Vector3::z() },
                [hanging(1.0), hanging(3.0), hanging(3.0), hanging(5.0), hanging(5.0), hanging(5.0), hanging(7.0)], 0.02;
            braced_beads: braced_beads::BracedBeads { mass: [0.5, 0.4, 0.7, 0.3, 0.2, 0.6, 0.4], long: 4.64_f64.sqrt(), short: 0.8_f64.sqrt() },
                [(0.0, -1.0), (-0.8, -1.6), (0.0, -2.0), (0.8, -1.6), (0.6, -2.8), (0.8, -2.6), (0.0, -3.6)].map(|(x, y)| Vector2::new(x, y)), 0.02;
            suslovs_body: suslov::Suslov { inertia: inertia() }, turned(), 0.1;
            a_sided_pair: sided_pair::SidedPair { }, (turned(), unit()), 0.1;
            a_top_of_eighth_order: eighth_order_top::EighthOrderTop { moments: principal(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_top_of_sixth_order: sixth_order_top::SixthOrderTop { inertia: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
            a_spatial_body: spatial_body::SpatialBody { mass_matrix: four(), gravity: 9.81 }, placed(), 0.05;
            a_geodesic_of_the_sphere: sphere_geodesic::SphereGeodesic { }, Vector4::new(0.6, 0.0, 0.8, 0.0), 0.1;
            a_spin_pair: spin_pair::SpinPair { inertia: [1.0, 1.3], anisotropy: [inertia(), inertia()], exchange: [[0.1, 0.2], [0.3, 0.4]] },
                [unit(), Vector3::x()], 0.05;
            a_steered_body: steered_body::SteeredBody { inertia: inertia(), damping: 0.1, top: 0.5 }, turned(), 0.05;
            a_tolerant_exact_top: tolerant_exact_top::TolerantExactTop { inertia: inertia(), weight: 1.3, center: centre() }, turned(), 0.1;
            two_pendulums: two_pendulums::TwoPendulums { mass: [1.0, 2.0], gravity: 9.81, coupling: centre() }, (unit(), Vector3::x()), 0.05;
            an_underwater_vehicle: underwater_vehicle::UnderwaterVehicle { inertia: Matrix6::from_diagonal(&Vector6::new(1.0, 1.2, 1.4, 2.0, 2.2, 2.5)), weight: 1.3, center: centre() },
                placed(), 0.05;
            a_weighted_group: weighted_sl2::WeightedSl2 { weight: Matrix2::new(1.0, 1.2, 0.9, 1.1) }, Matrix2::identity(), 0.05;
        }
    };
}
