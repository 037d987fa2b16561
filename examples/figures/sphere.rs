//! The discrete Lagrangian: a step makes the action of two edges stationary.

use crate::Pictures;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{
    self, BLUE, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RGBColor, Series, TEAL, Track, View,
};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// A spherical pendulum of length one and mass one.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
)]
pub struct Bob {
    /// g, m/s².
    pub gravity: f64,
}

const STEP: f64 = 0.5;
const PALE: RGBColor = RGBColor(180, 188, 200);

pub fn discrete_lagrangian(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let bob = Bob { gravity: 1.0 };
    let stepper = bob.stepper(STEP)?;
    let (start, velocity) = (Vector3::new(0.6, -0.8, 0.0), Vector3::new(0.9, 0.675, 1.0));
    let first = stepper.state(start, bob.momentum_map(&start, &velocity))?;
    let second = stepper.step(&first)?;
    let third = stepper.step(&second)?;
    let [from, middle, to] = [&first, &second, &third].map(|state| *state.configuration());

    // The middle point is moved across the path; the part of the action that depends on it.
    let across = middle.cross(&(to - from)).normalize();
    let moved = |angle: f64| middle * angle.cos() + across * angle.sin();
    let action = |q: &Vector3<f64>| {
        let kinetic = (q - from).norm_squared() + (to - q).norm_squared();
        kinetic / (2.0 * STEP) - STEP * bob.potential(0.0, q)
    };
    let slope = (action(&moved(1e-4)) - action(&moved(-1e-4))) / 2e-4;
    claims.at_most("slope of the action at the step", slope.abs(), 1e-8, "rounding of the difference");

    let arcs = |q: &Vector3<f64>| [arc(&from, q), arc(q, &to)].concat();
    let others = [-0.4, -0.2, 0.2, 0.4].map(|angle| arcs(&moved(angle)));
    let own = arcs(&middle);
    let mut tracks: Vec<_> = others.iter().map(|points| Track { points, colour: Some(PALE), width: 1.2 }).collect();
    tracks.push(Track { points: &own, colour: Some(BLUE), width: 2.2 });
    let pointer = |label, direction: Vector3<f64>, colour| Pointer { label, direction: direction.into(), colour };
    let pointers = [pointer("q₀", from, TEAL), pointer("q₁", middle, BLUE), pointer("q₂", to, PURPLE)];
    let curve = (-40..=40).map(|i| f64::from(i) * 0.01).map(|angle| (angle, action(&moved(angle)))).collect();
    let series = vec![
        Series { label: "", colour: INK, points: curve },
        Series { label: "the step", colour: ORANGE, points: vec![(0.0, action(&middle)), (0.0, action(&moved(0.4)))] },
    ];
    pictures.draw("discrete-lagrangian", |area| {
        let (left, right) = figure::columns(area, 370.0);
        let azimuth = middle.y.atan2(middle.x).to_degrees();
        let left = figure::caption(&left, "Two steps, and other paths")?;
        Globe { view: View { azimuth, elevation: 25.0 }, pointers: &pointers, tracks: &tracks }.draw(&left)?;
        let title = "Action of the two steps";
        Panel { title, unit: "J·s", x_label: "q₁ moved across the path (rad)", series }.draw(&right)
    })
}

/// Points on the shortest way between two points on the sphere.
fn arc(from: &Vector3<f64>, to: &Vector3<f64>) -> Vec<[f64; 3]> {
    let share = |i: i32| from.lerp(to, f64::from(i) / 12.0).normalize().into();
    (0..=12).map(share).collect()
}
