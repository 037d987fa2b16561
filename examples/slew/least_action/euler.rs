//! The continuous free motion with its derivative by the momentum at the start: nothing here is derived by the macro.
//!
//! Ṙ = R ω̂ and π̇ = π × ω with ω = J⁻¹π (Euler). Variations δR = R η̂ obey η̇ = J⁻¹δπ + η × ω and δπ̇ = δπ × ω + π ×
//! J⁻¹δπ. Units: the duration of the slew and the mean principal moment are 1, so that all numbers are angles.

use crate::body::Body;
use clebsch_examples::reference::solve;
use nalgebra::{Matrix3, SVector, Vector3};

/// Free motions of a body that start at one attitude.
#[derive(Clone, Copy, Debug)]
pub struct Euler {
    /// J⁻¹ in these units.
    inverse_inertia: Matrix3<f64>,
    least_moment: f64,
    /// kg·m²/s in a unit of momentum.
    pub momentum_unit: f64,
    /// J·s in a unit of action.
    action_unit: f64,
    start: Matrix3<f64>,
}

/// Where a free motion is.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// R, from the body to space.
    pub attitude: Matrix3<f64>,
    /// π, body frame.
    pub momentum: Vector3<f64>,
    /// ∂η/∂π₀: how the attitude here depends on the momentum at the start.
    pub by_momentum: Matrix3<f64>,
    /// δπ by δπ₀.
    change: Matrix3<f64>,
    /// The error of integration, from above, before the motion magnifies it.
    pub error: f64,
}

impl Euler {
    /// For a slew of this duration, seconds.
    pub fn new(body: &Body, start: &Matrix3<f64>, duration: f64) -> Self {
        let unit = body.moments.mean();
        Self {
            inverse_inertia: (body.inertia / unit).try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)),
            least_moment: body.moments.x / unit,
            momentum_unit: unit / duration,
            action_unit: unit / duration,
            start: *start,
        }
    }

    /// The action of the motion, J·s: the energy ½ π·J⁻¹π is constant.
    pub fn action(&self, momentum: &Vector3<f64>) -> f64 {
        momentum.dot(&(self.inverse_inertia * momentum)) / 2.0 * self.action_unit
    }

    /// The momentum in this direction of J^(1/2)Ω with this action, J·s.
    pub fn momentum(&self, direction: &Vector3<f64>, action: f64) -> Vector3<f64> {
        direction * (action / self.action(direction)).sqrt()
    }

    /// The motion before it has begun.
    pub fn start(&self, momentum: &Vector3<f64>) -> Motion {
        Motion {
            attitude: self.start,
            momentum: *momentum,
            by_momentum: Matrix3::zeros(),
            change: Matrix3::identity(),
            error: 0.0,
        }
    }

    /// The motion later by a part of the duration.
    pub fn after(&self, motion: &Motion, part: f64) -> Motion {
        let rate = motion.momentum.norm() / self.least_moment;
        let solution = solve(|y| self.field(y), motion.pack(), part, rate);
        Motion { error: motion.error + solution.error, ..Motion::unpack(&solution.end) }
    }

    fn field(&self, y: &SVector<f64, 30>) -> SVector<f64, 30> {
        let motion = Motion::unpack(y);
        let omega = self.inverse_inertia * motion.momentum;
        let spin = self.inverse_inertia * motion.change;
        let column = |matrix: &Matrix3<f64>, j: usize| Vector3::new(matrix[(0, j)], matrix[(1, j)], matrix[(2, j)]);
        let by_momentum = [0, 1, 2].map(|j| column(&spin, j) + column(&motion.by_momentum, j).cross(&omega));
        let change =
            [0, 1, 2].map(|j| column(&motion.change, j).cross(&omega) + motion.momentum.cross(&column(&spin, j)));
        let rate = Motion {
            attitude: motion.attitude * omega.cross_matrix(),
            momentum: motion.momentum.cross(&omega),
            by_momentum: Matrix3::from_columns(&by_momentum),
            change: Matrix3::from_columns(&change),
            error: 0.0,
        };
        rate.pack()
    }
}

impl Motion {
    // slices, as iterators over columns and parts take longer than the equations
    fn pack(&self) -> SVector<f64, 30> {
        let mut y = SVector::<f64, 30>::zeros();
        let numbers = y.as_mut_slice();
        numbers[..9].copy_from_slice(self.attitude.as_slice());
        numbers[9..12].copy_from_slice(self.momentum.as_slice());
        numbers[12..21].copy_from_slice(self.by_momentum.as_slice());
        numbers[21..].copy_from_slice(self.change.as_slice());
        y
    }

    fn unpack(y: &SVector<f64, 30>) -> Self {
        let matrix = |row: usize| {
            let mut matrix = Matrix3::<f64>::zeros();
            matrix.as_mut_slice().copy_from_slice(&y.as_slice()[row..row + 9]);
            matrix
        };
        let momentum = y.fixed_rows::<3>(9).into();
        Self { attitude: matrix(0), momentum, by_momentum: matrix(12), change: matrix(21), error: 0.0 }
    }
}
