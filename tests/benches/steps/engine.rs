//! The gyroscopic step of game engines on the free body, and where it is after a million steps.

use crate::hand::{Kernel, rotation};
use crate::problems::{Compensated, FreeBody};
use clebsch::{Clebsch, Method, Stepper};
use clebsch_tests::fixtures::principal_body::PrincipalBody;
use nalgebra::{Matrix3, Vector3};
use std::hint::black_box;

/// World angular velocity ω and a unit quaternion, inertia diagonal in the body, as engines such as rapier and avian
/// store them. A step is one explicit step of L̇ = −ω × L in the body's frame, |L| restored by a factor, then q⁺ =
/// exp(hω) q, normalised.
#[derive(Copy, Clone)]
pub struct Gyroscopic {
    attitude: [f64; 4],
    omega: [f64; 3],
    inertia: [f64; 3],
    inverse: [f64; 3],
    h: f64,
}

impl Gyroscopic {
    /// At the identity with a momentum.
    pub fn new(h: f64, inertia: [f64; 3], momentum: [f64; 3]) -> Self {
        let inertia = black_box(inertia);
        let inverse = inertia.map(f64::recip);
        let omega = std::array::from_fn(|i| momentum[i] * inverse[i]);
        Self { attitude: [1.0, 0.0, 0.0, 0.0], omega, inertia, inverse, h }
    }

    /// L in the body.
    #[inline]
    fn momentum(&self) -> [f64; 3] {
        let [w, x, y, z] = self.attitude;
        let omega = turned([w, -x, -y, -z], self.omega);
        std::array::from_fn(|i| self.inertia[i] * omega[i])
    }
}

impl Kernel for Gyroscopic {
    #[inline]
    fn step(&mut self) {
        let before = self.momentum();
        let omega: [f64; 3] = std::array::from_fn(|i| self.inverse[i] * before[i]);
        let torque = cross(omega, before);
        let after: [f64; 3] = std::array::from_fn(|i| before[i] - self.h * torque[i]);
        let scale = (dot(before, before) / dot(after, after)).sqrt();
        self.omega = turned(self.attitude, std::array::from_fn(|i| self.inverse[i] * scale * after[i]));
        let angle = self.h * dot(self.omega, self.omega).sqrt();
        let (sine, cosine) = (angle / 2.0).sin_cos();
        let [x, y, z] = if angle > 0.0 { self.omega.map(|w| w * self.h * sine / angle) } else { [0.0; 3] };
        let [a, b, c, d] = self.attitude;
        let q = [
            cosine * a - x * b - y * c - z * d,
            cosine * b + x * a + y * d - z * c,
            cosine * c - x * d + y * a + z * b,
            cosine * d + x * c - y * b + z * a,
        ];
        let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt().recip();
        self.attitude = q.map(|entry| length * entry);
    }

    fn configuration(&self) -> Vec<f64> {
        rotation(self.attitude).to_vec()
    }

    fn energy(&self) -> f64 {
        energy(self.momentum(), self.inertia)
    }

    fn defect(&self) -> f64 {
        (self.attitude.iter().map(|x| x * x).sum::<f64>() - 1.0).abs()
    }
}

/// Where a contestant is in the end.
pub struct End {
    /// The contestant.
    pub peer: &'static str,
    /// Relative error of the energy.
    pub energy: f64,
    /// Relative error of the spatial momentum, in the norm.
    pub spatial: f64,
    /// The angle between the momentum and the nearest axis of the body, degrees.
    pub angle: f64,
    /// That axis: 1 is that of least inertia.
    pub axis: usize,
}

/// A body that turns about its middle axis, after a million steps of 0.01.
pub fn ends(inertia: [f64; 3], momentum: [f64; 3]) -> [End; 3] {
    let (h, steps) = (0.01, 1_000_000);
    let mut engine = Gyroscopic::new(h, inertia, momentum);
    (0..steps).for_each(|_| engine.step());
    let start = (Matrix3::identity(), momentum.into());
    let (plain, compensated) = (PrincipalBody { moments: inertia.into() }, FreeBody { moments: inertia.into() });
    let plain = last(&plain.into_stepper(h).expect("a body"), start, steps);
    let compensated = last(&compensated.into_stepper_by::<Compensated>(h).expect("a body"), start, steps);
    let of = |peer, body: [f64; 3], r: Matrix3<f64>| {
        let start = Vector3::from(momentum);
        let spatial = (r * Vector3::from(body) - start).norm() / start.norm();
        let energy = energy(body, inertia) / energy(momentum, inertia) - 1.0;
        let axis = Vector3::from(body).iamax();
        let angle = (body[axis].abs() / dot(body, body).sqrt()).min(1.0).acos().to_degrees();
        End { peer, energy, spatial, angle, axis: axis + 1 }
    };
    let attitude = Matrix3::from_row_slice(&engine.configuration());
    [
        of("clebsch", plain.1.into(), plain.0),
        of("clebsch_compensated", compensated.1.into(), compensated.0),
        of("rust_gyroscopic", engine.momentum(), attitude),
    ]
}

/// Attitude and momentum after some steps.
fn last<S, M>(
    stepper: &Stepper<S, M>,
    start: (Matrix3<f64>, Vector3<f64>),
    steps: usize,
) -> (Matrix3<f64>, Vector3<f64>)
where
    S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>,
    M: Method<S>,
{
    let mut state = stepper.state(start.0, start.1).expect("a state");
    for _ in 0..steps {
        state = stepper.step(&state).expect("a step of moderate size");
    }
    state.into_parts()
}

/// ½ L·J⁻¹L
fn energy(momentum: [f64; 3], inertia: [f64; 3]) -> f64 {
    (0..3).map(|i| momentum[i] * momentum[i] / (2.0 * inertia[i])).sum()
}

/// q v q⁻¹
#[inline]
fn turned([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let twice = cross([x, y, z], v).map(|entry| 2.0 * entry);
    let again = cross([x, y, z], twice);
    std::array::from_fn(|i| v[i] + w * twice[i] + again[i])
}

#[inline]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
