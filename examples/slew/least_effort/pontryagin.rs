//! The continuous problem by Pontryagin's conditions: nothing here is derived by the macro.
//!
//! Ṙ = R ω̂ and π̇ = π × ω + u with ω = J⁻¹π; costates p of the attitude and ν of the momentum obey ṗ = p × ω and
//! ν̇ = ν × ω − J⁻¹(p + ν × π), and u = −ν, cut off at the bounds, makes the Hamiltonian ½ |u|² + p·ω + ν·π̇ least. Bounds make it
//! smooth only piecewise: pieces are joined where |ν| of an axis reaches the bound. Units: duration and mean principal moment are 1.

use super::problem::Problem;
use clebsch_examples::reference::solve;
use nalgebra::{Matrix3, SVector, Vector3, Vector6};

/// Pieces are cut so that no bound is reached and left within one.
const STRIDES: f64 = 200.0;
/// Steps of the search for the time at which a bound is reached.
const SEARCH: usize = 60;

/// Extremals from one attitude at rest.
#[derive(Clone, Copy, Debug)]
pub struct Pontryagin {
    inverse_inertia: Matrix3<f64>,
    start: Matrix3<f64>,
    top: f64,
    /// kg·m²/s in a unit of momentum.
    pub momentum_unit: f64,
    /// N²·m²·s in a unit of effort.
    pub effort_unit: f64,
}

/// R, π, p, ν and the effort so far.
type Packed = SVector<f64, 19>;

/// Where an extremal is.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    y: Packed,
    /// For each axis −1 or 1 at a bound, 0 between them.
    pub held: [i8; 3],
    /// How many times a bound was reached or left.
    pub switches: usize,
    /// What integration has made wrong.
    pub error: f64,
}

impl Motion {
    /// R, from the body to space.
    pub fn attitude(&self) -> Matrix3<f64> {
        Matrix3::from_column_slice(&self.y.as_slice()[..9])
    }

    /// π, body frame.
    pub fn momentum(&self) -> Vector3<f64> {
        self.y.fixed_rows::<3>(9).into()
    }

    /// ∫ ½ |u|² dt up to here.
    pub fn effort(&self) -> f64 {
        self.y[18]
    }

    fn costate(&self) -> Vector3<f64> {
        self.y.fixed_rows::<3>(15).into()
    }
}

impl Pontryagin {
    /// Of a problem.
    pub fn new(problem: &Problem) -> Self {
        let (unit, duration) = (problem.body.moments.mean(), problem.duration);
        let torque_unit = unit / duration.powi(2);
        Self {
            inverse_inertia: (problem.body.inertia / unit).try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)),
            start: problem.from,
            top: problem.top / torque_unit,
            momentum_unit: unit / duration,
            effort_unit: torque_unit.powi(2) * duration,
        }
    }

    /// The costates of a plan, in these units.
    pub fn scaled(&self, costate: &Vector6<f64>) -> Vector6<f64> {
        let (p, nu) = (costate.fixed_rows::<3>(0) / self.effort_unit, costate.fixed_rows::<3>(3));
        let nu = nu * (self.momentum_unit / self.effort_unit);
        Vector6::new(p.x, p.y, p.z, nu.x, nu.y, nu.z)
    }

    /// At rest, with these costates (p, ν).
    pub fn start(&self, costates: &Vector6<f64>) -> Motion {
        let mut y = Packed::zeros();
        y.as_mut_slice()[..9].copy_from_slice(self.start.as_slice());
        y.fixed_rows_mut::<6>(12).copy_from(costates);
        let held = std::array::from_fn(|axis| self.wanted(costates[3 + axis]));
        Motion { y, held, switches: 0, error: 0.0 }
    }

    /// The extremal later by a part of the whole time.
    pub fn after(&self, motion: &Motion, part: f64) -> Motion {
        let strides = (part * STRIDES).ceil().max(1.0);
        (0..strides as u64).fold(*motion, |motion, _| self.stride(motion, part / strides))
    }

    /// Over `length`, piece by piece.
    fn stride(&self, mut motion: Motion, mut length: f64) -> Motion {
        loop {
            let whole = self.piece(&motion, length);
            let passed = (0..3).filter(|&axis| self.passes(&whole, axis));
            let first = passed.map(|axis| (self.reach(&motion, length, axis), axis)).min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((time, axis)) = first else { return whole };
            motion = self.piece(&motion, time);
            motion.held[axis] = if motion.held[axis] == 0 { self.wanted(motion.costate()[axis] * 2.0) } else { 0 };
            motion.switches += 1;
            length -= time;
            if length <= 0.0 {
                return motion;
            }
        }
    }

    /// With torques held, or not, as at its start.
    fn piece(&self, motion: &Motion, length: f64) -> Motion {
        let solution = solve(|y| self.field(y, motion.held), motion.y, length, 1.0);
        Motion { y: solution.end, error: motion.error + solution.error, ..*motion }
    }

    /// Which bound a costate of the momentum asks for.
    fn wanted(&self, nu: f64) -> i8 {
        if nu.abs() <= self.top { 0 } else { -(nu.signum() as i8) }
    }

    /// Whether a torque is not as its costate wants it.
    fn passes(&self, motion: &Motion, axis: usize) -> bool {
        self.wanted(motion.costate()[axis]) != motion.held[axis]
    }

    /// The time at which this happens first, by bisection.
    fn reach(&self, motion: &Motion, length: f64, axis: usize) -> f64 {
        let (mut before, mut after) = (0.0, length);
        for _ in 0..SEARCH {
            let middle = (before + after) / 2.0;
            if middle <= before || middle >= after {
                break;
            }
            if self.passes(&self.piece(motion, middle), axis) { after = middle } else { before = middle }
        }
        after
    }

    fn field(&self, y: &Packed, held: [i8; 3]) -> Packed {
        let part = |row: usize| -> Vector3<f64> { y.fixed_rows::<3>(row).into() };
        let (momentum, p, nu) = (part(9), part(12), part(15));
        let omega = self.inverse_inertia * momentum;
        let torque = |axis: usize| if held[axis] == 0 { -nu[axis] } else { self.top * f64::from(held[axis]) };
        let torque = Vector3::new(torque(0), torque(1), torque(2));
        let mut rate = Packed::zeros();
        let turning = Matrix3::from_column_slice(&y.as_slice()[..9]) * omega.cross_matrix();
        rate.as_mut_slice()[..9].copy_from_slice(turning.as_slice());
        rate.fixed_rows_mut::<3>(9).copy_from(&(momentum.cross(&omega) + torque));
        rate.fixed_rows_mut::<3>(12).copy_from(&p.cross(&omega));
        let nu_rate = nu.cross(&omega) - self.inverse_inertia * (p + nu.cross(&momentum));
        rate.fixed_rows_mut::<3>(15).copy_from(&nu_rate);
        rate[18] = torque.norm_squared() / 2.0;
        rate
    }
}
