//! The accepted fixtures, compiled: what every test runs.

#![allow(missing_docs)]

/// The code of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The structs of the folder `fixtures/accept`.
pub mod fixtures {
    macro_rules! fixtures {
        ($($module:ident)*) => { $(pub mod $module { include!(concat!("../fixtures/accept/", stringify!($module), ".rs")); })* };
    }
    fixtures! {
        annotated_body first_order_top flying_body free_particle free_rigid_body generic_body heavy_top lopsided_pendulum neumann
        paper_pendulum planar_pendulum principal_body promised_top rigid_body4 sided_pair sphere_geodesic spherical_pendulum spin_pair
        two_bodies two_pendulums
    }
}

pub mod oracle;
