//! Orbits: a circle that the steps keep, and Kepler's ellipse.

use crate::body::{Body, Orientation};
use crate::{Momentum, Pose};
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// The circular orbit of the steps themselves.
///
/// x₊ − 2x + x₋ = −h² GM x/r³ has the circles 2(1 − cos ψ) = h²n², n² = GM/r³, with the angle ψ of a step. So no
/// eccentricity that is only the step's forces a libration. The coupling moves both by J/(m r²), which is less than
/// rounding.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    /// m
    pub radius: f64,
    /// n = √(GM/r³), rad/s.
    pub mean_motion: f64,
    /// sin ψ/h: the angular velocity by the momenta of a steady turn by ψ, rad/s.
    pub rate: f64,
    /// Half a kick, m/s, that the momentum of order 1 is ahead; zero at order 2.
    half_kick: f64,
}

impl Circle {
    /// The circle with this radius, m.
    ///
    /// # Errors
    /// [`Failure::Flags`] where a step is longer than a radian: there the circle of the steps has little to do with the orbit.
    pub fn new(body: &Body, radius: f64, run: &Run) -> Result<Self, Failure> {
        let mean_motion = (body.gravitation / radius).sqrt() / radius;
        let angle = run.step_size * mean_motion;
        if !(mean_motion.is_normal()) {
            return Err(Failure::Flags(format!(
                "no orbit of radius {radius:.3e} m about GM = {:.3e} m3/s2 can be computed",
                body.gravitation
            )));
        }
        if angle >= 1.0 {
            let most = 1.0 / mean_motion;
            let period = std::f64::consts::TAU / mean_motion;
            return Err(Failure::Flags(format!(
                "a step of {:.3e} s is too long for an orbit with a period of {period:.3e} s: take less than {most:.3e} s",
                run.step_size
            )));
        }
        // sin ψ with cos ψ = 1 − (hn)²/2
        let rate = mean_motion * (1.0 - angle * angle / 4.0).sqrt();
        let half_kick = if run.order == Order::First { angle * mean_motion * radius / 2.0 } else { 0.0 };
        Ok(Self { radius, mean_motion, rate, half_kick })
    }

    /// The state at the first axis of space, flying along the second. The body is turned by `tilt` (yaw, roll, pitch,
    /// radians) from its orientation, and at rest in the orbiting frame.
    pub fn start(&self, body: &Body, orientation: &Orientation, tilt: &Vector3<f64>) -> (Pose, Momentum) {
        let attitude = Rotation3::from_scaled_axis(*tilt).into_inner() * orientation.axes.transpose();
        let normal = attitude.transpose() * Vector3::z();
        let velocity = Vector3::new(-self.half_kick, self.radius * self.rate, 0.0);
        let (linear, angular) = (velocity * body.mass, body.inertia * normal * self.rate);
        let momentum = Momentum::from_iterator(linear.iter().chain(angular.iter()).copied());
        ((Vector3::x() * self.radius, attitude), momentum)
    }
}

/// Radius, direction of flight and normal as columns.
pub fn frame(position: &Vector3<f64>, velocity: &Vector3<f64>) -> Matrix3<f64> {
    let (radial, normal) = (position.normalize(), position.cross(velocity).normalize());
    Matrix3::from_columns(&[radial, normal.cross(&radial), normal])
}

/// Kepler's orbit of semi-major axis a and eccentricity e about GM, from its pericentre on the first axis.
#[derive(Clone, Copy, Debug)]
pub struct Kepler {
    /// m³/s²
    pub gravitation: f64,
    /// m
    pub semi_major_axis: f64,
    /// From 0 to 1.
    pub eccentricity: f64,
}

impl Kepler {
    /// Position and velocity at a time after the pericentre.
    pub fn at(&self, time: f64) -> (Vector3<f64>, Vector3<f64>) {
        let Self { gravitation, semi_major_axis: a, eccentricity: e } = *self;
        let n = (gravitation / a).sqrt() / a;
        let mean = n * time;
        // Newton's method for E − e sin E = M; from M + e it converges for every e below 1.
        let mut anomaly = mean + e * mean.sin().signum();
        for _ in 0..50 {
            let step = (anomaly - e * anomaly.sin() - mean) / (1.0 - e * anomaly.cos());
            anomaly -= step;
            if step.abs() <= f64::EPSILON * mean.abs() {
                break;
            }
        }
        let ((sin, cos), axis) = (anomaly.sin_cos(), (1.0 - e * e).sqrt());
        let rate = n / (1.0 - e * cos);
        (Vector3::new(cos - e, axis * sin, 0.0) * a, Vector3::new(-sin, axis * cos, 0.0) * (a * rate))
    }
}
