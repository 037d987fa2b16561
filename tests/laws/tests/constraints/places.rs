//! Constraints on places: pendulums on rods and joints, and a place that moves with the time.

use clebsch::{Clebsch, Error, Space};
use clebsch_tests::fixtures::{
    chaplygin_sleigh::ChaplyginSleigh, jointed_bodies::JointedBodies, snakeboard::Snakeboard, suslov::Suslov,
};
use nalgebra::{Matrix2, Matrix3, Matrix4, Rotation3, SVector, Vector2, Vector3};

pub mod rods {
    use clebsch::Clebsch;

    /// A mass on a rod: a spherical pendulum in three coordinates.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<3>, x: Vector3| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        potential  = |x| self.mass * self.gravity * x.z,
        constraint = |x| [x.norm_squared() == self.length.powi(2)],
    )]
    pub struct Bob {
        pub mass: f64,
        pub gravity: f64,
        pub length: f64,
    }

    /// A plate that turns about a pin, without weight.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SE<2>, q: SE<2>| q * F,
        lagrangian = |v| (self.inertia * v.x.powi(2) + self.mass * (v.y.powi(2) + v.z.powi(2))) / 2,
        constraint = |q| [q.rotation() * self.pin + q.translation() == Vector2::zeros()],
    )]
    pub struct Plate {
        pub inertia: f64,
        pub mass: f64,
        pub pin: nalgebra::Vector2<f64>,
    }

    /// A door that is locked at an angle, and pulled.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SO<2>, q: SO<2>| q * F,
        lagrangian = |w| self.inertia * w.x.powi(2) / 2,
        potential  = |q| -self.pull * q[(0, 0)],
        constraint = |q| [q[(1, 0)] == self.open],
    )]
    pub struct Door {
        pub inertia: f64,
        pub pull: f64,
        pub open: f64,
    }

    /// A body on a ball joint, by the velocity of the joint.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SE<3>, q: SE<3>| q * F,
        lagrangian = |(w, v)| (self.inertia * w.norm_squared() + self.mass * v.norm_squared()) / 2,
        constraint = |q, (w, v)| [q.rotation() * (v + w.cross(&self.arm)) == Vector3::zeros()],
    )]
    pub struct Joint {
        pub inertia: f64,
        pub mass: f64,
        pub arm: nalgebra::Vector3<f64>,
    }

    /// A direction of a body that stays level, by its velocity. The group acts from the left.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SO<3>, R: SO<3>| F * R,
        lagrangian = |w| self.inertia * w.norm_squared() / 2,
        constraint = |R, w| [w.cross(&(R * self.arm)).z == 0],
    )]
    pub struct Level {
        pub inertia: f64,
        pub arm: nalgebra::Vector3<f64>,
    }

    /// A wheel that goes along (1, 0, y), and a plane.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<4>, x: Vector4| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        constraint = |x, v| [v.z == x.y * v.x, x.w * v.w == 0],
    )]
    pub struct Wheel {
        pub mass: f64,
    }

    /// A mass on a plane that moves up and down.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<3>, x: Vector3| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        constraint = |t, x| [x.z == t.sin()],
    )]
    pub struct Lifted {
        pub mass: f64,
    }
}

use rods::{Bob, Joint, Level, Lifted, Wheel};

/// RATTLE, written by hand: x⁺ = x + h v + λ x with |x⁺| = l, a root of a quadratic equation, and v⁺ ⊥ x⁺.
fn rattle(bob: &Bob, h: f64, (x, v): (Vector3<f64>, Vector3<f64>)) -> (Vector3<f64>, Vector3<f64>) {
    let kick = Vector3::z() * (-bob.gravity * h / 2.0);
    let free = x + (v + kick) * h;
    // |free + λ x|² = l²
    let (a, b, c) = (x.norm_squared(), free.dot(&x), free.norm_squared() - bob.length * bob.length);
    let lambda = -c / (b + (b * b - a * c).sqrt());
    let next = free + x * lambda;
    let v = (next - x) / h + kick;
    (next, v - next * (v.dot(&next) / next.norm_squared()))
}

#[test]
fn a_mass_on_a_rod_steps_by_rattle() -> Result<(), Error> {
    let bob = Bob { mass: 0.7, gravity: 9.81, length: 1.3 };
    let stepper = bob.stepper(0.01)?;
    let mut expected = (Vector3::new(0.5, 1.2, 0.0), Vector3::new(1.2, -0.5, 0.8));
    let mut state = stepper.state_moving(expected.0, expected.1)?;
    for step in 0..1000 {
        expected = rattle(&bob, 0.01, expected);
        state = stepper.step(&state)?;
        let far = (state.configuration() - expected.0).norm() + (state.momentum() / bob.mass - expected.1).norm();
        assert!(far < 1e-11, "step {step}: {far:e}");
    }
    Ok(())
}

/// The widest change of the energy, while place and velocity stay on the constraint.
fn band(bob: &Bob, h: f64) -> Result<f64, Error> {
    let stepper = bob.stepper(h)?;
    let mut state = stepper.state_moving(Vector3::new(0.5, 1.2, 0.0), Vector3::new(1.2, -0.5, 0.8))?;
    let energy = stepper.energy(&state);
    let mut band = 0.0_f64;
    for _ in 0..crate::long(5000) {
        state = stepper.advance(&state, 20)?;
        let (x, v) = (state.configuration(), state.momentum() / bob.mass);
        let (longer, along) = ((x.norm() - bob.length).abs(), x.dot(&v).abs());
        assert!(longer < 1e-14 && along < 1e-14, "{longer:e} {along:e}");
        band = band.max((stepper.energy(&state) - energy).abs());
    }
    Ok(band)
}

/// 25 000 steps, with the feature `heavy` 100 000. Half the step has a quarter of the band of the energy, as of a symplectic step of second order.
#[test]
fn places_and_velocities_stay_on_the_constraint() -> Result<(), Error> {
    let bob = Bob { mass: 0.7, gravity: 9.81, length: 1.3 };
    let ratio = band(&bob, 0.01)? / band(&bob, 0.005)?;
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    Ok(())
}

/// A place is known to rounding, and motions may be smaller than that.
#[test]
fn joints_may_rest_or_move_by_less_than_rounding() -> Result<(), Error> {
    let pin = Vector2::new(0.3, 0.4);
    for number in 0..40 {
        let (sin, cos) = (0.1 * f64::from(number)).sin_cos();
        let turn = Matrix2::new(cos, -sin, sin, cos);
        let start = Matrix3::new_translation(&-(turn * pin)) * turn.to_homogeneous();
        let stepper = rods::Plate { inertia: 0.2, mass: 1.1, pin }.into_stepper(0.05)?;
        for speed in [0.0, 1e-18, 1e-16, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8] {
            let moving = Vector3::new(speed, pin.y * speed, -pin.x * speed);
            let late = stepper.advance(&stepper.state_moving(start, moving)?, 50)?;
            let gap = late.configuration().transform_point(&pin.into());
            assert!(gap.coords.norm() < 1e-15, "{gap}");
            // it turns by 2 atan(hω/2) a step, as momenta are known to ε Σ/h
            let angle = turn.transpose() * late.configuration().fixed_view::<2, 2>(0, 0);
            assert!((angle[(1, 0)] - 2.5 * speed).abs() < 1e-13, "{speed:e}: {angle}");
        }

        // the lock carries the pull: N′ = −V′ + A λ, with V = −k cos θ and A = cos θ
        let (angle, pull) = (0.03 * f64::from(number), 1.0 + 0.1 * f64::from(number));
        let stepper = rods::Door { inertia: 1.3, pull, open: angle.sin() }.into_stepper(0.05)?;
        let turn = Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos());
        let (late, lock) = stepper.step_with_reactions(&stepper.state(turn, nalgebra::Vector1::new(0.0))?)?;
        assert!((late.configuration() - turn).amax() < 1e-15, "{}", late.configuration());
        assert!((lock.x - pull * angle.tan()).abs() < 1e-12, "{lock}");
    }
    Ok(())
}

#[test]
fn a_plane_that_moves_carries_its_mass() -> Result<(), Error> {
    let stepper = Lifted { mass: 2.0 }.into_stepper(0.05)?;
    let start = stepper.state_moving(Vector3::new(0.1, 0.2, 0.0), Vector3::new(0.3, 0.0, 1.0))?;
    let end = stepper.advance(&start, 40)?;
    let (x, v) = (end.configuration(), end.momentum() / 2.0);
    assert!((x - Vector3::new(0.7, 0.2, 2.0_f64.sin())).norm() < 1e-14, "{x}");
    assert!((v - Vector3::new(0.3, 0.0, 2.0_f64.cos())).norm() < 1e-14, "{v}");
    Ok(())
}

#[test]
fn places_off_the_constraint_are_refused() -> Result<(), Error> {
    let stepper = Bob { mass: 0.7, gravity: 9.81, length: 1.3 }.into_stepper(0.01)?;
    let refused = stepper.state(Vector3::new(1.0, 0.0, 0.0), Vector3::zeros());
    let Err(Error::OffConstraint { violation, .. }) = refused else { panic!("{refused:?}") };
    assert!((violation - 0.69).abs() < 1e-15, "{violation}");
    let refused = stepper.state_moving(Vector3::new(1.3, 0.0, 0.0), Vector3::x());
    assert!(matches!(refused, Err(Error::ConstraintViolated { .. })), "{refused:?}");
    Ok(())
}

/// By the theorem of Frobenius: the velocity of a joint is that of a place, dz = y dx is not, and neither is a blade.
#[test]
fn velocities_of_places_are_told() {
    let told = "of places φ(q) = c";
    assert!(Joint::DERIVATION.contains("== Vector3::zeros() is the velocity of places"), "{}", Joint::DERIVATION);
    assert!(Level::DERIVATION.contains(".z == 0 is the velocity of places"), "{}", Level::DERIVATION);
    assert!(Wheel::DERIVATION.contains("\nx.w * v.w == 0 is the velocity of places"), "{}", Wheel::DERIVATION);
    for text in [Bob::DERIVATION, ChaplyginSleigh::DERIVATION, Snakeboard::DERIVATION, Suslov::DERIVATION] {
        assert!(!text.contains(told), "{text}");
    }
}

/// ½ tr(J) I − J of principal moments.
fn second_moment(moments: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal(&(-moments).add_scalar(moments.sum() / 2.0))
}

pub fn bodies() -> JointedBodies {
    JointedBodies {
        second_moments: [Vector3::new(0.09, 0.085, 0.01), Vector3::new(0.04, 0.038, 0.005)].map(second_moment),
        mass: [1.0, 0.7],
        gravity: 9.81,
        near: [Vector3::z() * 0.5, Vector3::z() * 0.4],
        far: Vector3::z() * -0.5,
    }
}

/// Both bodies tilted about axes of their own.
pub fn tilted(bodies: &JointedBodies) -> [Matrix4<f64>; 2] {
    let turns = [Rotation3::new(Vector3::new(0.6, 0.3, 0.1)), Rotation3::new(Vector3::new(-0.4, 0.7, 0.2))];
    let turns = turns.map(|turn| *turn.matrix());
    let upper = -(turns[0] * bodies.near[0]);
    let joint = upper + turns[0] * bodies.far;
    let lower = joint - turns[1] * bodies.near[1];
    let placed = |turn: &Matrix3<f64>, place: Vector3<f64>| {
        let mut placed = turn.to_homogeneous();
        placed.fixed_view_mut::<3, 1>(0, 3).copy_from(&place);
        placed
    };
    [placed(&turns[0], upper), placed(&turns[1], lower)]
}

/// By how much both joints are open.
pub fn open(bodies: &JointedBodies, q: &[Matrix4<f64>; 2]) -> f64 {
    let at = |q: &Matrix4<f64>, point: Vector3<f64>| q.transform_point(&point.into()).coords;
    let ceiling = at(&q[0], bodies.near[0]);
    ceiling.norm().max((at(&q[1], bodies.near[1]) - at(&q[0], bodies.far)).norm())
}

#[test]
fn joints_stay_closed_and_steps_are_time_symmetric() -> Result<(), Error> {
    let bodies = bodies();
    let (forth, back) = (bodies.stepper(0.01)?, bodies.stepper(-0.01)?);
    let places = tilted(&bodies);
    let start = forth.project(places, SVector::from_fn(|i, _| 0.01 * (i as f64 - 5.0)))?;
    let there = forth.advance(&start, 40)?;
    let again = back.advance(&back.state(*there.configuration(), there.momentum())?, 40)?;
    let far = start.configuration().distance_squared(again.configuration()).sqrt();
    assert!(far < 1e-12, "{far:e}");
    let mut state = start;
    let mut widest = 0.0_f64;
    for _ in 0..crate::long(100) {
        state = forth.advance(&state, 100)?;
        widest = widest.max(open(&bodies, state.configuration()));
    }
    assert!(widest < 1e-14, "the joints open by {widest:e}");
    Ok(())
}

/// The error at a fixed time falls with the square of the step, against a step 64 times as short.
#[test]
fn jointed_bodies_are_of_second_order() -> Result<(), Error> {
    let bodies = bodies();
    let places = tilted(&bodies);
    let at = |steps: usize| -> Result<[Matrix4<f64>; 2], Error> {
        let stepper = bodies.stepper(0.4 / steps as f64)?;
        let start = stepper.state(places, SVector::zeros())?;
        Ok(*stepper.advance(&start, steps)?.configuration())
    };
    let exact = at(2560)?;
    let error = |steps: usize| -> Result<f64, Error> { Ok(at(steps)?.distance_squared(&exact).sqrt()) };
    let order = (error(20)? / error(40)?).log2();
    assert!((order - 2.0).abs() < 0.05, "order {order}");
    Ok(())
}
