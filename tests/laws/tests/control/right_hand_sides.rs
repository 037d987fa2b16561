//! Dynamics from a right-hand side, against the methods of Runge and Kutta by hand.

use super::derivatives;
use clebsch::{Clebsch, Controlled, Error, Target};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Vector1, Vector2, Vector4, vector};

/// A cart on rails with a pendulum: place, angle from hanging, and their rates.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = rk4(|x: Vector4, u: Vector1| {
        let (sine, cosine) = (x.y.sin(), x.y.cos());
        let mass = self.cart + self.bob * sine.powi(2);
        let centrifugal = self.bob * self.length * x.w.powi(2) * sine;
        let weight = self.bob * self.gravity * sine;
        vector![
            x.z,
            x.w,
            (u.x + centrifugal + weight * cosine) / mass,
            -((u.x + centrifugal) * cosine + weight + self.cart * self.gravity * sine) / (self.length * mass),
        ]
    }),
    cost = |h, u| h * u.norm_squared() / 2,
)]
struct CartPole {
    cart: f64,
    bob: f64,
    length: f64,
    gravity: f64,
}

/// A mass on a spring that is shaken.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = midpoint(|t, x: Vector2, u: Vector1| vector![x.y, u.x - self.stiffness * x.x + (3 * t).sin()]),
    cost     = |h, u| h * u.norm_squared() / 2,
)]
struct Shaken {
    stiffness: f64,
}

const H: f64 = 0.05;
const CART_POLE: CartPole = CartPole { cart: 1.0, bob: 0.3, length: 0.5, gravity: 9.81 };

/// The same law from the kinetic and the potential energy: the mass matrix of place and angle is solved as it stands.
fn rate(x: &Vector4<f64>, u: f64) -> Vector4<f64> {
    let CartPole { cart, bob, length, gravity } = CART_POLE;
    let coupling = bob * length * x.y.cos();
    let mass = nalgebra::Matrix2::new(cart + bob, coupling, coupling, bob * length * length);
    let force = vector![u + bob * length * x.w * x.w * x.y.sin(), -bob * gravity * length * x.y.sin()];
    let acceleration = mass.try_inverse().expect("regular") * force;
    vector![x.z, x.w, acceleration.x, acceleration.y]
}

fn by_hand(x: &Vector4<f64>, u: f64) -> Vector4<f64> {
    let first = rate(x, u);
    let second = rate(&(x + first * (H / 2.0)), u);
    let third = rate(&(x + second * (H / 2.0)), u);
    let fourth = rate(&(x + third * H), u);
    x + (first + second * 2.0 + third * 2.0 + fourth) * (H / 6.0)
}

#[test]
fn steps_are_those_of_runge_and_kutta() -> Result<(), Error> {
    let random = &mut Random::new(731);
    let control = CART_POLE.control(H)?;
    for _ in 0..20 {
        let (x, u) = (random.vector::<4>() * 2.0, random.vector::<1>() * 5.0);
        assert!((control.follow(&x, &u)? - by_hand(&x, u.x)).amax() < 1e-13);
    }
    let shaken = Shaken { stiffness: 2.0 };
    let constants = shaken.prepare(H)?;
    for t in [0.0, 0.7] {
        let (x, u) = (random.vector::<2>(), random.vector::<1>());
        let rate = |t: f64, x: &Vector2<f64>| vector![x.y, u.x - 2.0 * x.x + (3.0 * t).sin()];
        let expected = x + rate(t + H / 2.0, &(x + rate(t, &x) * (H / 2.0))) * H;
        assert!((shaken.follow(&constants, t, &x, &u)? - expected).amax() < 1e-15);
    }
    Ok(())
}

#[test]
fn their_derivatives_are_those_of_differences() {
    let random = &mut Random::new(732);
    derivatives::check_vectors(&CART_POLE, &random.vector::<4>(), random);
    derivatives::check_vectors(&Shaken { stiffness: 2.0 }, &random.vector::<2>(), random);
}

/// From hanging at rest to standing at rest, in two seconds: the inputs lead there by hand too.
#[test]
fn a_pendulum_swings_up() -> Result<(), Error> {
    let control = CART_POLE.control(H)?;
    let (start, target) = (Vector4::zeros(), vector![0.0, std::f64::consts::PI, 0.0, 0.0]);
    let guess = |k: usize| control.stage(&start).with_input(Vector1::new(3.0 * (0.3 * k as f64).sin()));
    let mut plan: Vec<_> = (0..40).map(guess).collect();
    let optimum = control.solve(&start, Target::Place(target), &mut plan)?;
    assert!(optimum.is_minimum());
    let end = optimum.stages().iter().fold(start, |x, stage| by_hand(&x, stage.input().x));
    assert!((end - target).amax() < 1e-9, "{end}");
    Ok(())
}
