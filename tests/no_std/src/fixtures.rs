//! The exported functions: one for each accepted fixture, three for the generic one.

// what the fixtures import for their declarations, no code names
#![allow(unused_imports)]

use crate::{Motion, Plan, choose, connect, integrate};

macro_rules! modules {
    ($($module:ident)*) => {$(
        mod $module {
            include!(concat!("../../fixtures/accept/", stringify!($module), ".rs"));
        }
    )*};
}

macro_rules! steppers {
    ($($name:ident: $system:ty;)*) => {$(
        /// Whether the integration reaches its end.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(system: &$system, motion: &mut Motion<$system>) -> bool {
            integrate(system, motion).is_ok()
        }
    )*};
}

macro_rules! plans {
    ($($name:ident: $system:ty, $d:literal, $u:literal, $c:literal;)*) => {$(
        /// Whether a plan is found.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(system: &$system, plan: &mut Plan<$system, $d, $u, $c>) -> bool {
            choose(system, plan).is_ok()
        }
    )*};
}

/// Whether a path is found between fixed endpoints.
#[unsafe(no_mangle)]
pub extern "C" fn step_between(
    system: &watched_top::WatchedTop,
    motion: &mut Motion<watched_top::WatchedTop>,
    target: &nalgebra::Matrix3<f64>,
) -> bool {
    connect(system, motion, target).is_ok()
}

modules! {
    annotated_body bounded_top centred_body collocated_top compensated_top damped_body exact_body exact_body4 first_order_top fluid_ellipsoid flying_body free_particle free_rigid_body generic_body
    gravity_gradient growing_shape harmonics heavy_top heavy_top_reduced heisenberg_geodesic linear_optics lopsided_pendulum
    lorentz_frame midpoint_top neumann paper_pendulum planar_pendulum principal_body principal_body4 promised_top quaternion_top regulator
    relativistic_particle rigid_body4 sided_pair sixth_order_top spatial_body sphere_geodesic spherical_pendulum spin_pair split_top steered_bob steered_body tolerant_exact_top tolerant_top tumbling_momentum two_bodies two_pendulums
    underwater_vehicle unicycle watched_top weighted_sl2
}

steppers! {
    step_annotated_body: annotated_body::AnnotatedBody<'static, (), 4>;
    step_bounded_top: bounded_top::BoundedTop;
    step_centred_body: centred_body::CentredBody;
    step_compensated_top: compensated_top::CompensatedTop;
    step_first_order_top: first_order_top::FirstOrderTop;
    step_collocated_top: collocated_top::CollocatedTop;
    step_exact_body: exact_body::ExactBody;
    step_exact_body4: exact_body4::ExactBody4;
    step_fluid_ellipsoid: fluid_ellipsoid::FluidEllipsoid;
    step_flying_body: flying_body::FlyingBody;
    step_free_particle: free_particle::FreeParticle;
    step_free_rigid_body: free_rigid_body::FreeRigidBody;
    step_generic_body_in_f32: generic_body::GenericBody<f32>;
    step_generic_body_lanes: generic_body::GenericBody<clebsch::F64x4>;
    step_generic_body_in_f64: generic_body::GenericBody<f64>;
    step_gravity_gradient: gravity_gradient::GravityGradient;
    step_growing_shape: growing_shape::GrowingShape;
    step_harmonics: harmonics::Harmonics;
    step_heavy_top: heavy_top::HeavyTop;
    step_heavy_top_reduced: heavy_top_reduced::HeavyTopReduced;
    step_heisenberg_geodesic: heisenberg_geodesic::HeisenbergGeodesic;
    step_linear_optics: linear_optics::LinearOptics;
    step_lopsided_pendulum: lopsided_pendulum::LopsidedPendulum;
    step_lorentz_frame: lorentz_frame::LorentzFrame;
    step_midpoint_top: midpoint_top::MidpointTop;
    step_neumann: neumann::Neumann;
    step_paper_pendulum: paper_pendulum::PaperPendulum;
    step_planar_pendulum: planar_pendulum::PlanarPendulum;
    step_principal_body: principal_body::PrincipalBody;
    step_principal_body4: principal_body4::PrincipalBody4;
    step_promised_top: promised_top::PromisedTop;
    step_quaternion_top: quaternion_top::QuaternionTop;
    step_relativistic_particle: relativistic_particle::RelativisticParticle;
    step_rigid_body4: rigid_body4::RigidBody4;
    step_sided_pair: sided_pair::SidedPair;
    step_sixth_order_top: sixth_order_top::SixthOrderTop;
    step_spatial_body: spatial_body::SpatialBody;
    step_sphere_geodesic: sphere_geodesic::SphereGeodesic;
    step_spherical_pendulum: spherical_pendulum::SphericalPendulum;
    step_spin_pair: spin_pair::SpinPair;
    step_split_top: split_top::SplitTop;
    step_tolerant_exact_top: tolerant_exact_top::TolerantExactTop;
    step_tolerant_top: tolerant_top::TolerantTop;
    step_tumbling_momentum: tumbling_momentum::TumblingMomentum;
    step_two_bodies: two_bodies::TwoBodies;
    step_two_pendulums: two_pendulums::TwoPendulums;
    step_underwater_vehicle: underwater_vehicle::UnderwaterVehicle;
    step_damped_body: damped_body::DampedBody;
    step_steered_bob: steered_bob::SteeredBob;
    step_steered_body: steered_body::SteeredBody;
    step_watched_top: watched_top::WatchedTop;
    step_weighted_sl2: weighted_sl2::WeightedSl2;
}

plans! {
    step_regulator: regulator::Regulator, 2, 1, 0;
    step_steered_body_to_a_target: steered_body::SteeredBody, 6, 3, 2;
    step_unicycle: unicycle::Unicycle, 3, 2, 3;
}
