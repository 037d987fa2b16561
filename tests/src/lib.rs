//! The accepted fixtures, compiled: every test runs them.

#![allow(missing_docs)]

/// The structs of the folder `fixtures/accept`.
pub mod fixtures {
    macro_rules! fixtures {
        ($($module:ident)*) => { $(pub mod $module { include!(concat!("../fixtures/accept/", stringify!($module), ".rs")); })* };
    }
    fixtures! {
        bounded_top braced_beads branching_bodies centred_body chaplygin_sleigh collocated_top compensated_top cosserat_rod covariance_geodesic damped_body double_pendulum driven_body5 driven_sleigh eccentric_orbit exact_body exact_body4 first_order_top fluid_ellipsoid flying_body follower free_rigid_body frugal_car
        generic_body gravity_gradient gripping_disc growing_shape hanging_chain harmonic_map harmonics heavy_top heavy_top_reduced heisenberg_geodesic hopper jointed_bodies linear_optics
        lorentz_frame midpoint_top moving_frame natural_pendulum neumann neumann20 paper_pendulum planar_pendulum principal_body principal_body4 promised_top
        quaternion_top rate_limited_body rayleigh_plane rattleback regulator relativistic_particle rigid_body4 rolling_ball shaken_pendulum sided_pair sine_gordon sixth_order_top spatial_body snakeboard sphere_geodesic spherical_pendulum spin_chain spin_pair split_top steered_bob steered_body suslov three_ways tractor_trailer two_bodies
        telescope tolerant_top tumbling_momentum two_pendulums underwater_vehicle unicycle watched_top wave_map weighted_sl2 wheeled_car
    }
    // no test by default steps these: snapshots have their stages, and tests/no_std links them
    #[cfg(feature = "heavy")]
    fixtures! {
        annotated_body driven_chain eighth_order_top free_particle lopsided_pendulum projected_body rigid_body7 tolerant_exact_top
    }
}

pub mod oracle;
pub mod scenes;
pub mod stepping;
