//! Parameters and starts.

use nalgebra::{Matrix3, Vector3};

/// Parameters and start of any of the scenes.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Principal moments of inertia, kg·m²; the first is m·l² of a pendulum.
    pub moments: [f64; 3],
    /// m·g, N.
    pub weight: f64,
    /// From the pivot to the centre of mass in the body frame, m; its length is that of a pendulum.
    pub arm: Vector3<f64>,
    /// Step size, s.
    pub h: f64,
    /// R; a pendulum points along its third column.
    pub attitude: Matrix3<f64>,
    /// π in the body frame; spatial for a pendulum, projected.
    pub momentum: Vector3<f64>,
}

impl Setup {
    /// A tumbling body, a fast top, or a pendulum that is level, of the order of one in all units.
    pub fn ordinary() -> Self {
        Self {
            moments: [1.0, 1.5, 2.0],
            weight: 1.0,
            arm: Vector3::new(0.45, 0.0, 0.6),
            h: 0.0625,
            // right to the last digit of every type
            attitude: Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0),
            momentum: Vector3::new(0.5, 1.25, 1.0),
        }
    }

    /// J⁻¹π
    pub fn velocity(&self) -> Vector3<f64> {
        self.momentum.component_div(&Vector3::from(self.moments))
    }

    /// The same with the momentum that gives this velocity.
    pub fn with_velocity(mut self, velocity: Vector3<f64>) -> Self {
        self.momentum = velocity.component_mul(&Vector3::from(self.moments));
        self
    }

    /// The same with each number rounded to `f32`, so that a run of that type and its companion start alike.
    pub fn rounded(&self) -> Self {
        let to = |x: f64| f64::from(x as f32);
        Self {
            moments: self.moments.map(to),
            weight: to(self.weight),
            arm: self.arm.map(to),
            h: to(self.h),
            attitude: self.attitude.map(to),
            momentum: self.momentum.map(to),
        }
    }
}
