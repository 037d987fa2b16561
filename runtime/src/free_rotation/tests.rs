//! The exact rotation against power series in time of 60 digits, and against its own laws.

use super::FreeRotation;
use crate::Error;
use nalgebra::{Matrix3, SVector, Vector3};
use proptest::prelude::*;
use std::vec::Vec;

struct Case {
    what: &'static str,
    moments: [f64; 3],
    momentum: [f64; 3],
    h: f64,
    rotation: [f64; 4],
}

/// Rotations by the Taylor series of R′ = R ω^, M′ = M × ω to order 60, in short steps and 60 digits.
const CASES: [Case; 10] = [
    Case {
        what: "tumbling near the separatrix",
        moments: [1.0, 2.0, 3.0],
        momentum: [0.3, 2.0, 0.6],
        h: 0.25,
        rotation: [0.99122233312586573104, 0.034318678331163822346, 0.12547716293792574791, 0.023579571903802741859],
    },
    Case {
        what: "on the separatrix, to round-off",
        moments: [1.0, 2.0, 3.0],
        momentum: [0.5, 2.0, 0.8660254037844386],
        h: 1.0,
        rotation: [0.84277730354098820489, 0.17178867007171159178, 0.4972852514575662873, 0.11367694644895559886],
    },
    Case {
        what: "about the long axis",
        moments: [1.0, 1.5, 2.0],
        momentum: [0.1, 0.3, 10.0],
        h: 0.125,
        rotation: [0.95147438082805068124, 0.0040255591294240933343, 0.013081737384493428295, 0.30742343054584541475],
    },
    Case {
        what: "a long step",
        moments: [1.0, 1.5, 2.0],
        momentum: [0.1, 0.3, 10.0],
        h: 1.75,
        rotation: [
            -0.32822997885540267106,
            -0.0080450497021296744692,
            -0.0095906630569665067208,
            -0.94451488995039136787,
        ],
    },
    Case {
        what: "a needle",
        moments: [1.0, 1.0, 0.0009765625],
        momentum: [0.25, 0.5, 0.001],
        h: 0.5,
        rotation: [0.95797815311691199629, 0.091789024998576023381, 0.10478167103484459754, 0.25074575660550411196],
    },
    Case {
        what: "nearly a ball",
        moments: [1.0, 1.0000000000000002, 0.9999999999999998],
        momentum: [1.0, -2.0, 3.0],
        h: 0.5,
        rotation: [0.59348499244168828889, 0.21510388914370925776, -0.43020777828741877203, 0.64531166743112832587],
    },
    Case {
        what: "a ball",
        moments: [2.0, 2.0, 2.0],
        momentum: [1.0, -2.0, 3.0],
        h: 1.0,
        rotation: [0.59348499244168834859, 0.21510388914370940105, -0.4302077782874188021, 0.64531166743112820315],
    },
    Case {
        what: "no body: moments that no masses have",
        moments: [1.0, 2.0, 8.0],
        momentum: [1.0, 1.0, -1.0],
        h: 0.5,
        rotation: [0.95856497320173423063, 0.26675542611905129673, 0.092557704525218100963, -0.037786321861545643044],
    },
    Case {
        what: "indefinite",
        moments: [1.0, -2.0, 3.0],
        momentum: [0.5, 0.25, 0.125],
        h: 0.5,
        rotation: [0.99150483311628900495, 0.12592202631305686648, -0.031960210329432057562, 0.0063524917907989988345],
    },
    Case {
        what: "back",
        moments: [1.0, 2.0, 3.0],
        momentum: [0.3, 2.0, 0.6],
        h: -0.25,
        rotation: [0.9911445785327055291, -0.040542762781557677069, -0.12359219851973800196, -0.026714739308507864947],
    },
];

fn body(moments: [f64; 3], h: f64) -> FreeRotation<f64> {
    FreeRotation::new(&Matrix3::from_diagonal(&Vector3::from(moments)), h).expect("regular")
}

/// The unit quaternion with a Gibbs vector, up to its sign.
fn quaternion(c: &Vector3<f64>) -> [f64; 4] {
    let scalar = 1.0 / (1.0 + c.norm_squared()).sqrt();
    [scalar, scalar * c.x, scalar * c.y, scalar * c.z]
}

fn distance(found: [f64; 4], wanted: [f64; 4]) -> f64 {
    let sign = if found[0] * wanted[0] < 0.0 { -1.0 } else { 1.0 };
    (0..4).map(|i| (found[i] - sign * wanted[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn rotations_are_those_of_long_series() {
    for case in &CASES {
        let c = body(case.moments, case.h).gibbs_vector(&case.momentum.into()).expect("solved");
        let error = distance(quaternion(&c), case.rotation);
        // two are made of 64 and 256 parts, whose roundings add up
        let tolerance = if ["a long step", "a needle"].contains(&case.what) { 2e-14 } else { 1e-15 };
        assert!(error < tolerance, "{}: {error:e}", case.what);
    }
}

/// A motion that is followed for a hundred steps is that of each step by itself.
#[test]
fn what_a_motion_keeps_is_computed_once() {
    for case in CASES.iter().filter(|case| case.what != "nearly a ball") {
        let free = body(case.moments, case.h);
        let mut momentum = Vector3::from(case.momentum);
        let motion = free.motion(&momentum).expect("a motion");
        for _ in 0..100 {
            let (once, each) = (motion.gibbs_vector(&momentum), free.gibbs_vector(&momentum).expect("solved"));
            let error = (once - each).norm() / (1.0 + each.norm_squared());
            assert!(error < 1e-13, "{}: {error:e}", case.what);
            momentum = carried(&momentum, &each);
        }
    }
}

/// Where the principal axes are turned, rotation vectors turn along.
#[test]
fn axes_may_be_turned() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    let axes = turn.matrix();
    for case in &CASES {
        let moments = Matrix3::from_diagonal(&Vector3::from(case.moments));
        let turned = FreeRotation::new(&(axes * moments * axes.transpose()), case.h).expect("regular");
        let c = turned.gibbs_vector(&(axes * Vector3::from(case.momentum))).expect("solved");
        let error = distance(quaternion(&(axes.transpose() * c)), case.rotation);
        assert!(error < 3e-14, "{}: {error:e}", case.what);
    }
}

#[test]
fn the_momentum_is_that_of_the_rotation() {
    for case in &CASES {
        let free = body(case.moments, case.h);
        let momentum = Vector3::from(case.momentum);
        let c = free.gibbs_vector(&momentum).expect("solved");
        let found = free.momentum(&c);
        // a rotation of more than half a turn is that of another motion
        if case.what != "a long step" {
            let error = (found - momentum).norm() / momentum.norm();
            assert!(error < 1e-12, "{}: {error:e}", case.what);
        }
    }
}

#[test]
fn half_a_turn_is_no_exception() {
    // a ball with h|ω| = π
    let free = body([1.0; 3], 1.0);
    let c = free.gibbs_vector(&Vector3::new(core::f64::consts::PI, 0.0, 0.0)).expect("solved");
    let rotation = quaternion(&c);
    assert!(rotation[0].abs() < 1e-15 && (rotation[1].abs() - 1.0).abs() < 1e-15);
    assert!(c.iter().all(|entry| entry.is_finite()));
}

#[test]
fn what_cannot_be_is_said() {
    assert!(matches!(
        FreeRotation::new(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 2.0)), 0.1),
        Err(Error::SingularKineticEnergy { .. })
    ));
    assert!(matches!(
        FreeRotation::new(&Matrix3::from_diagonal(&Vector3::new(1.0, f64::NAN, 2.0)), 0.1),
        Err(Error::NotFinite { .. })
    ));
    let free = body([1.0, 2.0, 3.0], 0.1);
    assert!(matches!(free.gibbs_vector(&Vector3::new(f64::NAN, 0.0, 0.0)), Err(Error::NotFinite { .. })));
    let Err(Error::Unsolvable { solvable_fraction, .. }) = free.gibbs_vector(&Vector3::new(1e9, 0.0, 0.0)) else {
        panic!("a billion radians were made")
    };
    assert!(free.gibbs_vector(&Vector3::new(1e9 * solvable_fraction, 0.0, 0.0)).is_ok());
}

/// F ↦ Fᵀ M
fn carried(momentum: &Vector3<f64>, c: &Vector3<f64>) -> Vector3<f64> {
    let once = c.cross(momentum);
    momentum + (c.cross(&once) - once) * (2.0 / (1.0 + c.norm_squared()))
}

/// The Gibbs vector of a rotation and then another, both about axes of the body.
fn composed(c: &Vector3<f64>, d: &Vector3<f64>) -> Vector3<f64> {
    (c + d + c.cross(d)) / (1.0 - c.dot(d))
}

proptest! {
    /// The flow of h and then of k is that of h + k; energy and the square of the momentum stay.
    #[test]
    fn motions_add_up(
        moments in prop::array::uniform3(0.1_f64..10.0),
        momentum in prop::array::uniform3(-1.0_f64..1.0),
        h in 0.01_f64..0.2,
        k in 0.01_f64..0.2,
    ) {
        let momentum = Vector3::from(momentum);
        let [first, second, both] = [h, k, h + k].map(|h| body(moments, h));
        let c = first.gibbs_vector(&momentum).expect("solved");
        let later = carried(&momentum, &c);
        let d = second.gibbs_vector(&later).expect("solved");
        let whole = both.gibbs_vector(&momentum).expect("solved");
        let error = (composed(&c, &d) - whole).norm() / (1.0 + whole.norm_squared());
        prop_assert!(error < 2e-15, "{error:e}");
        let energy = |m: &Vector3<f64>| (0..3).map(|i| m[i] * m[i] / moments[i]).sum::<f64>();
        prop_assert!((energy(&later) / energy(&momentum) - 1.0).abs() < 5e-15);
        prop_assert!((later.norm_squared() / momentum.norm_squared() - 1.0).abs() < 5e-15);
    }

    /// Series that converge agree with the same rotation in parts.
    #[test]
    fn parts_make_the_whole(
        moments in prop::array::uniform3(0.3_f64..3.0),
        momentum in prop::array::uniform3(-1.0_f64..1.0),
    ) {
        let free = body(moments, 0.2);
        let m = momentum.map(|component| component * free.scale);
        let whole = free.gibbs_vector(&Vector3::from(momentum)).expect("solved");
        let parts = free.in_parts(&m).expect("solved");
        prop_assert!((whole - parts).norm() < 1e-15);
    }
}

#[test]
fn single_precision_is_as_good_as_it_can_be() {
    let errors: Vec<f64> = CASES
        .iter()
        .filter(|case| case.what != "a long step" && case.what != "nearly a ball")
        .map(|case| {
            let inertia = Matrix3::from_diagonal(&Vector3::from(case.moments.map(|moment| moment as f32)));
            let momentum: SVector<f32, 3> = Vector3::from(case.momentum.map(|entry| entry as f32));
            let c = FreeRotation::new(&inertia, case.h as f32).expect("regular").gibbs_vector(&momentum);
            let c = c.expect("solved").map(f64::from);
            // a needle takes 256 parts, whose roundings add up
            distance(quaternion(&c), case.rotation) / if case.what == "a needle" { 64.0 } else { 1.0 }
        })
        .collect();
    assert!(errors.iter().all(|error| *error < 2e-7), "{errors:?}");
}
