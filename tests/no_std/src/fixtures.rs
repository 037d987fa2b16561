//! The exported functions: one for each accepted fixture, two for the generic one.

// what the fixtures import for their declarations, no code names
#![allow(unused_imports)]

use crate::{Motion, integrate};

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

modules! {
    annotated_body first_order_top flying_body free_particle free_rigid_body generic_body heavy_top lopsided_pendulum
    neumann paper_pendulum planar_pendulum principal_body promised_top rigid_body4 sided_pair sphere_geodesic
    spherical_pendulum spin_pair two_bodies two_pendulums
}

steppers! {
    step_annotated_body: annotated_body::AnnotatedBody<'static, (), 4>;
    step_first_order_top: first_order_top::FirstOrderTop;
    step_flying_body: flying_body::FlyingBody;
    step_free_particle: free_particle::FreeParticle;
    step_free_rigid_body: free_rigid_body::FreeRigidBody;
    step_generic_body_in_f32: generic_body::GenericBody<f32>;
    step_generic_body_in_f64: generic_body::GenericBody<f64>;
    step_heavy_top: heavy_top::HeavyTop;
    step_lopsided_pendulum: lopsided_pendulum::LopsidedPendulum;
    step_neumann: neumann::Neumann;
    step_paper_pendulum: paper_pendulum::PaperPendulum;
    step_planar_pendulum: planar_pendulum::PlanarPendulum;
    step_principal_body: principal_body::PrincipalBody;
    step_promised_top: promised_top::PromisedTop;
    step_rigid_body4: rigid_body4::RigidBody4;
    step_sided_pair: sided_pair::SidedPair;
    step_sphere_geodesic: sphere_geodesic::SphereGeodesic;
    step_spherical_pendulum: spherical_pendulum::SphericalPendulum;
    step_spin_pair: spin_pair::SpinPair;
    step_two_bodies: two_bodies::TwoBodies;
    step_two_pendulums: two_pendulums::TwoPendulums;
}
