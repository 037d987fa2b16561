//! The exact rotation against power series in time of 60 digits, and against its own laws.

use super::FreeRotation;
use crate::Error;
use crate::runner::{is_long, proptest};
use nalgebra::{Matrix3, Quaternion, SVector, UnitQuaternion, Vector3};
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
        rotation: [
            0.991_222_333_125_865_7,
            0.034_318_678_331_163_824,
            0.125_477_162_937_925_74,
            0.023_579_571_903_802_74,
        ],
    },
    Case {
        what: "on the separatrix, to round-off",
        moments: [1.0, 2.0, 3.0],
        momentum: [0.5, 2.0, 0.866_025_403_784_438_6],
        h: 1.0,
        rotation: [0.842_777_303_540_988_2, 0.171_788_670_071_711_59, 0.497_285_251_457_566_3, 0.113_676_946_448_955_6],
    },
    Case {
        what: "about the long axis",
        moments: [1.0, 1.5, 2.0],
        momentum: [0.1, 0.3, 10.0],
        h: 0.125,
        rotation: [
            0.951_474_380_828_050_7,
            0.004_025_559_129_424_094,
            0.013_081_737_384_493_428,
            0.307_423_430_545_845_4,
        ],
    },
    Case {
        what: "a long step",
        moments: [1.0, 1.5, 2.0],
        momentum: [0.1, 0.3, 10.0],
        h: 1.75,
        rotation: [
            -0.328_229_978_855_402_67,
            -0.008_045_049_702_129_674,
            -0.009_590_663_056_966_507,
            -0.944_514_889_950_391_3,
        ],
    },
    Case {
        what: "a needle",
        moments: [1.0, 1.0, 0.000_976_562_5],
        momentum: [0.25, 0.5, 0.001],
        h: 0.5,
        rotation: [0.957_978_153_116_912, 0.091_789_024_998_576_02, 0.104_781_671_034_844_59, 0.250_745_756_605_504_13],
    },
    Case {
        what: "nearly a ball",
        moments: [1.0, 1.000_000_000_000_000_2, 0.999_999_999_999_999_8],
        momentum: [1.0, -2.0, 3.0],
        h: 0.5,
        rotation: [
            0.593_484_992_441_688_3,
            0.215_103_889_143_709_26,
            -0.430_207_778_287_418_8,
            0.645_311_667_431_128_3,
        ],
    },
    Case {
        what: "a ball",
        moments: [2.0, 2.0, 2.0],
        momentum: [1.0, -2.0, 3.0],
        h: 1.0,
        rotation: [0.593_484_992_441_688_4, 0.215_103_889_143_709_4, -0.430_207_778_287_418_8, 0.645_311_667_431_128_2],
    },
    Case {
        what: "no body: moments that no masses have",
        moments: [1.0, 2.0, 8.0],
        momentum: [1.0, 1.0, -1.0],
        h: 0.5,
        rotation: [
            0.958_564_973_201_734_3,
            0.266_755_426_119_051_3,
            0.092_557_704_525_218_1,
            -0.037_786_321_861_545_645,
        ],
    },
    Case {
        what: "indefinite",
        moments: [1.0, -2.0, 3.0],
        momentum: [0.5, 0.25, 0.125],
        h: 0.5,
        rotation: [
            0.991_504_833_116_289,
            0.125_922_026_313_056_88,
            -0.031_960_210_329_432_06,
            0.006_352_491_790_798_999,
        ],
    },
    Case {
        what: "back",
        moments: [1.0, 2.0, 3.0],
        momentum: [0.3, 2.0, 0.6],
        h: -0.25,
        rotation: [
            0.991_144_578_532_705_5,
            -0.040_542_762_781_557_676,
            -0.123_592_198_519_738,
            -0.026_714_739_308_507_866,
        ],
    },
];

/// All of them. Miri interprets, and the series of each body take it long: it takes the first alone.
fn cases() -> impl Iterator<Item = &'static Case> {
    CASES.iter().take(if cfg!(miri) { 1 } else { CASES.len() })
}

/// The longest step of random motions: for Miri short ones, of few parts.
const LONGEST: f64 = if cfg!(miri) { 0.03 } else { 0.2 };

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
    for case in cases() {
        let c = body(case.moments, case.h).gibbs_vector(&case.momentum.into()).expect("solved");
        let error = distance(quaternion(&c), case.rotation);
        assert!(error < 1e-15, "{}: {error:e}", case.what);
    }
}

/// A motion that is followed for a hundred steps is that of each step by itself.
#[test]
fn what_a_motion_keeps_is_computed_once() {
    for case in cases().filter(|case| case.what != "nearly a ball") {
        let free = body(case.moments, case.h);
        let mut momentum = Vector3::from(case.momentum);
        let motion = free.motion(&momentum);
        for _ in 0..if cfg!(miri) { 2 } else { 100 } {
            let (once, each) = (
                free.gibbs_vector_of(&motion, &momentum).expect("solved"),
                free.gibbs_vector(&momentum).expect("solved"),
            );
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
    for case in cases() {
        let moments = Matrix3::from_diagonal(&Vector3::from(case.moments));
        let turned = FreeRotation::new(&(axes * moments * axes.transpose()), case.h).expect("regular");
        let c = turned.gibbs_vector(&(axes * Vector3::from(case.momentum))).expect("solved");
        let error = distance(quaternion(&(axes.transpose() * c)), case.rotation);
        assert!(error < 3e-14, "{}: {error:e}", case.what);
    }
}

#[test]
fn the_momentum_is_that_of_the_rotation() {
    for case in cases() {
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

/// A needle turns slowly, but h|M|/J about its axis is large: exp(hM/J⊥) exp(hω(1 − J/J⊥)e₁) in closed form. The error is that of such an angle's last digit.
#[test]
fn needles_take_many_duplications() {
    for moment in [1e-4, 1e-5, 1e-6, 1e-7].into_iter().take(if cfg!(miri) { 1 } else { 4 }) {
        let (h, omega) = (0.05, Vector3::new(1.0, 0.7, -0.4));
        let momentum = omega.component_mul(&Vector3::new(moment, 1.0, 1.0));
        let c = body([moment, 1.0, 1.0], h).gibbs_vector(&momentum).expect("not too long");
        let own = Vector3::x() * (h * omega.x * (1.0 - moment));
        let half = |angle: Vector3<f64>| angle * ((angle.norm() / 2.0).tan() / angle.norm());
        let expected = composed(&half(momentum * h), &half(own));
        let angle = h * momentum.norm() / moment;
        let error = (c - expected).norm();
        std::println!("needle {moment:e}: an error of {error:.1e}, angles up to {angle:.1e}");
        assert!(error <= 4.0 * f64::EPSILON * angle, "needle {moment:e}: {error:.1e}");
    }
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
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The flow of h and then of k is that of h + k; energy and the square of the momentum stay.
    #[test]
    fn motions_add_up(
        moments in prop::array::uniform3(0.1_f64..10.0),
        momentum in prop::array::uniform3(-1.0_f64..1.0),
        h in 0.01..LONGEST,
        k in 0.01..LONGEST,
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

    /// Series that end early are off by their tolerance, for long motions too; a tolerance below rounding is rounding.
    #[test]
    fn series_end_at_the_tolerance(
        moments in prop::array::uniform3(0.3_f64..3.0),
        momentum in prop::array::uniform3(-1.0_f64..1.0),
        h in 0.1..15.0 * LONGEST,
    ) {
        let momentum = Vector3::from(momentum);
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
        let to = |tolerance: f64| {
            let free = FreeRotation::to_tolerance(&inertia, h, tolerance).expect("regular");
            quaternion(&free.gibbs_vector(&momentum).expect("solved"))
        };
        let exact = quaternion(&body(moments, h).gibbs_vector(&momentum).expect("solved"));
        prop_assert_eq!(to(1e-20), exact);
        for tolerance in [1e-3, 1e-6, 1e-9].into_iter().take(if cfg!(miri) { 1 } else { 3 }) {
            // an angle of at most 18, in parts below one
            let error = distance(to(tolerance), exact);
            prop_assert!(error < 20.0 * tolerance, "{tolerance:e}: {error:e}");
        }
    }

    /// Series that converge agree with duplications of shorter ones.
    #[test]
    fn duplication_makes_the_whole(
        moments in prop::array::uniform3(0.3_f64..3.0),
        momentum in prop::array::uniform3(-1.0_f64..1.0),
    ) {
        let free = body(moments, 0.2);
        let m = Vector3::from(momentum) * free.scale;
        let whole = free.gibbs_vector(&Vector3::from(momentum)).expect("solved");
        let (w, x) = free.of_lane(0).long_turn(None, &m).expect("solved");
        let twice = x / w;
        prop_assert!((whole - twice).norm() < 1e-15);
    }
}

/// Duplications of long motions against the same motion in 64 steps, for bodies of all shapes. They agree within some
/// roundings of the angle and of the momentum. The latter grow exponentially about middle axes.
#[test]
fn long_motions_are_those_of_their_parts() {
    let mut state = 1_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (count, parts) = if cfg!(miri) { (1, 4) } else { (if is_long() { 2000 } else { 40 }, 64) };
    for _ in 0..count {
        let moments = [(); 3].map(|()| 10_f64.powf(2.0 * uniform() - 1.0));
        let momentum = Vector3::from([(); 3].map(|()| 2.0 * uniform() - 1.0));
        let least = moments.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let angle = 40.0 * uniform();
        let h = angle * least / momentum.norm();
        let (free, part) = (body(moments, h), body(moments, h / f64::from(parts)));
        let whole = |momentum: &Vector3<f64>| quaternion(&free.gibbs_vector(momentum).expect("solved"));
        let (mut m, mut q) = (momentum, UnitQuaternion::identity());
        for _ in 0..parts {
            let c = part.gibbs_vector(&m).expect("solved");
            q *= UnitQuaternion::from_quaternion(Quaternion::new(1.0, c.x, c.y, c.z));
            m = carried(&m, &c);
        }
        let found = whole(&momentum);
        let sensitivity = (0..3)
            .map(|i| distance(whole(&(momentum + 1e-8 * momentum.norm() * Vector3::ith(i, 1.0))), found) * 1e8)
            .fold(0.0, f64::max);
        let error = distance(found, [q.w, q.i, q.j, q.k]);
        assert!(
            error < 1e-14 * (1.0 + angle + sensitivity),
            "{moments:?} {momentum:?} {h}: {error:e} beside {sensitivity:e}"
        );
    }
}

/// ℘′ changes its sign at half a period of the momentum: parts are shorter than that, however loose the tolerance is.
#[test]
fn parts_are_shorter_than_half_a_period() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(2.232_505, 2.330_859_3, 0.318_828_32));
    let between = if is_long() { 1 } else { 7 };
    for h in if cfg!(miri) { 12..13 } else { 1..60 }.step_by(between) {
        // about the third axis, by an angle of up to 16
        let momentum = Vector3::new(0.0, 0.0, -0.85);
        let angle = 0.1 * f64::from(h) * momentum.z / inertia.m33;
        let expected = [(angle / 2.0).cos(), 0.0, 0.0, (angle / 2.0).sin()];
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-6].into_iter().take(if cfg!(miri) { 1 } else { 4 }) {
            let free = FreeRotation::to_tolerance(&inertia, 0.1 * f64::from(h), tolerance).expect("regular");
            let error = distance(quaternion(&free.gibbs_vector(&momentum).expect("solved")), expected);
            assert!(error < 20.0 * tolerance, "{tolerance:e}, {angle}: {error:e}");
        }
        let free = FreeRotation::new(&inertia.map(|entry| entry as f32), 0.1 * h as f32).expect("regular");
        let c = free.gibbs_vector(&momentum.map(|entry| entry as f32)).expect("solved").map(f64::from);
        assert!(distance(quaternion(&c), expected) < 2e-6, "{angle}");
    }
}

#[test]
fn single_precision_is_as_good_as_it_can_be() {
    let errors: Vec<f64> = cases()
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
