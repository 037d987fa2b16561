//! Parts of scenes that have tests of their own: cargo runs no tests inside of examples, so they are taken in here.

#[allow(dead_code, reason = "what another one needs")]
#[path = "../rod/beam.rs"]
mod beam;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../ensemble/euler.rs"]
mod euler;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../fluid_ellipsoid/geodesic.rs"]
mod geodesic;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../rigid_body_n/manakov.rs"]
mod manakov;
#[allow(dead_code, reason = "what the next one needs")]
#[path = "../unicycle/place.rs"]
mod place;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../rod/plane.rs"]
mod plane;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../unicycle/geodesic.rs"]
mod plane_geodesic;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../inertia_estimation/rotation.rs"]
mod rotation;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../kink/solitons.rs"]
mod solitons;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../fluid_ellipsoid/spheroid.rs"]
mod spheroid;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../inertia_estimation/unknowns.rs"]
mod unknowns;
#[allow(dead_code, reason = "taken in for the tests inside it")]
#[path = "../underwater_vehicle/vehicle.rs"]
mod vehicle;
