//! States from configurations and momenta that violate a constraint.

use clebsch::{Clebsch, Error, F64x4, Scalar, Space};
use clebsch_tests::fixtures::jointed_bodies::JointedBodies;
use nalgebra::{Matrix4, Rotation3, SVector, Vector2, Vector3};

use crate::places::{
    bodies, open,
    rods::{Bob, Lifted},
    tilted,
};

mod circles {
    use clebsch::{Clebsch, Scalar};

    /// A point on a circle.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<2>, x: Vector2| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        constraint = |x| [x.norm_squared() == self.square],
    )]
    pub struct Circle<T: Scalar> {
        pub mass: T,
        pub square: T,
    }
}

use circles::Circle;

/// Numbers between −1 and 1, a congruential sequence.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Both bodies moved and turned by about `size`.
fn disturbed(bodies: &JointedBodies, size: f64, next: &mut impl FnMut() -> f64) -> [Matrix4<f64>; 2] {
    tilted(bodies).map(|q| {
        let turn = Rotation3::new(Vector3::from_fn(|_, _| size * next())).to_homogeneous();
        let shift = Matrix4::new_translation(&Vector3::from_fn(|_, _| size * next()));
        shift * q * turn
    })
}

/// By how fast both joints open: the velocities of the points that they hold, by hand.
fn opening(bodies: &JointedBodies, q: &[Matrix4<f64>; 2], mu: &SVector<f64, 12>) -> f64 {
    let velocity = |i: usize, point: Vector3<f64>| {
        let [a, b, c] = [0, 1, 2].map(|k| bodies.second_moments[i][(k, k)]);
        let inertia = Vector3::new(b + c, a + c, a + b);
        let omega = mu.fixed_rows::<3>(6 * i).component_div(&inertia);
        let v = mu.fixed_rows::<3>(6 * i + 3) / bodies.mass[i];
        q[i].fixed_view::<3, 3>(0, 0) * (v + omega.cross(&point))
    };
    let ceiling = velocity(0, bodies.near[0]).norm();
    ceiling.max((velocity(1, bodies.near[1]) - velocity(0, bodies.far)).norm())
}

#[test]
fn joints_close_and_their_velocities_with_them() -> Result<(), Error> {
    let bodies = bodies();
    let stepper = bodies.stepper(0.01)?;
    let mut next = numbers(7);
    for size in [1e-9, 1e-4, 1e-2, 0.1, 0.3] {
        for _ in 0..50 {
            let q = disturbed(&bodies, size, &mut next);
            let mu = SVector::<f64, 12>::from_fn(|_, _| next());
            let gap = open(&bodies, &q);
            let state = stepper.project(q, mu)?;
            let left = open(&bodies, state.configuration());
            // ε times the change of φ when places of one metre move by two
            assert!(left < 4e-15, "{size}: the joints are open by {left:e}");
            let speed = opening(&bodies, state.configuration(), &state.momentum());
            assert!(speed < 1e-13, "{size}: the joints open at {speed:e}");
            let moved = state.configuration().distance_squared(&q).sqrt();
            assert!(moved < 4.0 * gap, "{size}: moved by {moved:e} for a gap of {gap:e}");
            // a state stays as it is
            let again = stepper.project(*state.configuration(), state.momentum())?;
            assert_eq!(again.configuration(), state.configuration());
        }
    }
    Ok(())
}

/// A point with a mass goes straight to the nearest point of its sphere.
#[test]
fn a_mass_comes_to_the_end_of_its_rod() -> Result<(), Error> {
    let bob = Bob { mass: 0.7, gravity: 9.81, length: 1.3 };
    let stepper = bob.stepper(0.01)?;
    let mut next = numbers(3);
    for _ in 0..200 {
        let x = Vector3::from_fn(|_, _| 2.0 * next());
        let p = Vector3::from_fn(|_, _| next());
        if x.norm() < 0.1 {
            continue;
        }
        let state = stepper.project(x, p)?;
        let expected = x * (bob.length / x.norm());
        let far = (state.configuration() - expected).norm();
        assert!(far < 1e-15, "{x}: {far:e}");
        let tangent = p - expected * (p.dot(&expected) / expected.norm_squared());
        assert!((state.momentum() - tangent).norm() < 1e-15, "{x}");
    }
    Ok(())
}

#[test]
fn a_mass_comes_to_where_its_plane_is_at_the_time() -> Result<(), Error> {
    let stepper = Lifted { mass: 2.0 }.into_stepper(0.05)?;
    for t in [-1.0_f64, 0.0, 0.7] {
        let state = stepper.project_at(t, Vector3::new(0.1, 0.2, 0.9), Vector3::new(0.3, 0.4, 0.5))?;
        assert_eq!(state.time(), t);
        assert!((state.configuration() - Vector3::new(0.1, 0.2, t.sin())).norm() < 1e-15);
        assert!((state.momentum() - Vector3::new(0.3, 0.4, 2.0 * t.cos())).norm() < 1e-15);
    }
    Ok(())
}

#[test]
fn places_that_are_too_far_are_refused() -> Result<(), Error> {
    let stepper = Circle { mass: 2.0, square: 1.0 }.into_stepper(0.1)?;
    let p = Vector2::new(1.0, 0.0);
    // no direction at the centre
    let centre = stepper.project(Vector2::zeros(), p).err();
    assert_eq!(centre, Some(Error::DependentConstraints { rank: 0, rows: 1 }));
    // Newton's method halves the distance, from 5e11
    let near = stepper.project(Vector2::new(1e-12, 0.0), p);
    assert!(matches!(near, Err(Error::FarFromConstraint { corrections: 32, .. })), "{near:?}");
    for x in [1e300, f64::MAX, 1e-300] {
        let far = stepper.project(Vector2::new(x, x), p);
        let is_typed = matches!(far, Err(Error::FarFromConstraint { .. } | Error::DependentConstraints { .. }));
        assert!(is_typed, "{x:e}: {far:?}");
    }
    for x in [f64::NAN, f64::INFINITY] {
        let refused = stepper.project(Vector2::new(x, 0.0), p);
        assert!(matches!(refused, Err(Error::NotFinite { .. })), "{refused:?}");
    }
    // nothing to come to
    let stepper = Circle { mass: 2.0, square: -1.0 }.into_stepper(0.1)?;
    let refused = stepper.project(Vector2::new(0.3, 0.4), p);
    assert!(
        matches!(refused, Err(Error::FarFromConstraint { .. } | Error::DependentConstraints { .. })),
        "{refused:?}"
    );
    Ok(())
}

#[test]
fn lanes_and_short_numbers_are_repaired() -> Result<(), Error> {
    let wide = Circle { mass: F64x4::splat(2.0), square: F64x4::splat(1.0) }.into_stepper(F64x4::splat(0.1))?;
    let places = [[0.6, 0.8], [3.0, 4.0], [-0.1, 0.3], [1.0 + 1e-9, 0.0]];
    let x = Vector2::from_fn(|i, _| F64x4::from_lanes(|lane| places[lane][i]));
    let p = Vector2::new(F64x4::splat(0.3), F64x4::splat(-0.2));
    let state = wide.project(x, p)?;
    for (lane, place) in places.into_iter().enumerate() {
        let alone = Circle { mass: 2.0, square: 1.0 }.into_stepper(0.1)?;
        let alone = alone.project(place.into(), Vector2::new(0.3, -0.2))?;
        let (found, momentum) = state.lane(lane);
        assert!((found - alone.configuration()).norm() < 1e-15, "lane {lane}");
        assert!((momentum - alone.momentum()).norm() < 1e-15, "lane {lane}");
    }
    let short = Circle { mass: 2.0_f32, square: 1.0 }.into_stepper(0.1)?;
    let state = short.project(Vector2::new(3.0, 4.0), Vector2::new(1.0, 0.0))?;
    assert!((state.configuration() - Vector2::new(0.6, 0.8)).norm() < 1e-7);
    Ok(())
}
