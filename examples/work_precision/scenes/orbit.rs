//! An orbit about a star, of two eccentricities: Kepler's problem with the great half axis 1 and the frequency 1, from the nearest point.
//!
//! Declarations with `step = |q| q.norm()` take short steps near the star. Classical methods take Cartesian coordinates.

use crate::classical::{Equation, VectorField};
use crate::motion::Scene;
use crate::setting::{Setting, declared, paced};
use clebsch::Clebsch;
use nalgebra::{SVector, Vector2, Vector6};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

struct ShortFourth;
struct ShortSixth;
struct ShortEighth;
struct EvenSixth;
struct EvenEighth;

/// In steps that are short near the star.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |a: Translation<2>, q: Vector2| q + a,
    lagrangian = |v| v.norm_squared() / 2,
    potential  = |q| -self.strength / q.norm(),
    step       = |q| q.norm(),
    method ShortFourth = (order = 4),
    method ShortSixth  = (order = 6),
    method ShortEighth = (order = 8),
)]
struct Comet {
    /// G·M, m³/s².
    strength: f64,
}

/// In steps of one size.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |a: Translation<2>, q: Vector2| q + a,
    lagrangian = |v| v.norm_squared() / 2,
    potential  = |q| -self.strength / q.norm(),
    method EvenSixth  = (order = 6),
    method EvenEighth = (order = 8),
)]
struct EvenComet {
    /// G·M, m³/s².
    strength: f64,
}

type Motion = SVector<f64, 4>;

#[derive(Clone)]
struct Attracted {
    strength: f64,
}

impl VectorField<4> for Attracted {
    #[inline(always)]
    fn rates(&self, y: &Motion) -> Motion {
        let square = y[0] * y[0] + y[1] * y[1];
        let pull = -self.strength / (square * square.sqrt());
        Motion::new(y[2], y[3], pull * y[0], pull * y[1])
    }
}

/// The motion at a time, and how far rounding may have moved it. Kepler's equation u − e sin u = t is solved by bisection, then by Newton's method.
fn on_ellipse(eccentricity: f64, t: f64) -> (Motion, f64) {
    let anomaly = (t + PI).rem_euclid(TAU) - PI;
    let residual = |u: f64| u - eccentricity * u.sin() - anomaly;
    let (mut low, mut high) = (-PI, PI);
    for _ in 0..40 {
        let middle = f64::midpoint(low, high);
        if residual(middle) < 0.0 { low = middle } else { high = middle }
    }
    let mut u = f64::midpoint(low, high);
    for _ in 0..3 {
        u -= residual(u) / (1.0 - eccentricity * u.cos());
    }
    let distance = 1.0 - eccentricity * u.cos();
    let axis = (1.0 - eccentricity * eccentricity).sqrt();
    let place = Vector2::new(u.cos() - eccentricity, axis * u.sin());
    let velocity = Vector2::new(-u.sin(), axis * u.cos()) / distance;
    let rounding = (residual(u).abs() + f64::EPSILON * (t + PI)) * velocity.norm();
    (Motion::new(place.x, place.y, velocity.x, velocity.y), rounding)
}

/// The orbit of an eccentricity.
pub fn scene(name: &'static str, title: &'static str, eccentricity: f64) -> Scene<4> {
    let strength = black_box(1.0);
    let start = on_ellipse(eccentricity, 0.0).0;
    let (comet, even) = (Comet { strength }, EvenComet { strength });
    let from = (Vector2::new(start[0], start[1]), Vector2::new(start[2], start[3]));
    let flat = |q: &Vector2<f64>, n: &Vector2<f64>| Motion::new(q.x, q.y, n.x, n.y);
    let mut settings: Vec<Box<dyn Setting<4>>> = vec![
        paced(ShortFourth, "step = |q| q.norm()", comet, from, flat),
        paced(ShortSixth, "step = |q| q.norm()", comet, from, flat),
        paced(ShortEighth, "step = |q| q.norm()", comet, from, flat),
        declared(EvenSixth, "steps of one size", even, from, flat),
        declared(EvenEighth, "steps of one size", even, from, flat),
    ];
    let field = Attracted { strength };
    settings.extend(Equation { field: field.clone(), start, flat: |y| *y }.settings());
    Scene {
        name,
        title,
        duration: 100.0,
        start,
        field: Box::new(move |y| field.rates(y)),
        energy: Box::new(move |y| (y[2] * y[2] + y[3] * y[3]) / 2.0 - strength / (y[0] * y[0] + y[1] * y[1]).sqrt()),
        momenta: |y| Vector6::new(y[0] * y[3] - y[1] * y[2], 0.0, 0.0, 0.0, 0.0, 0.0),
        constraint: |_| 0.0,
        split: 2,
        momentum_size: from.1.norm(),
        closed_form: None,
        known: Some(Box::new(move |t| on_ellipse(eccentricity, t))),
        reference_steps: 0,
        longer: 10,
        // near the star the velocity is large, and with it the effect of a rounded time
        least_error: 2e-11 / (1.0 - eccentricity),
        shows_sixteen: false,
        settings,
    }
}
