//! Another integrator, without places and multipliers: Newton's and Euler's laws for the attitudes of a few links.

use crate::whip::Whip;
use clebsch_examples::reference::solve;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Links of the chain that is compared.
pub const FEW: usize = 5;
/// R and ω of each link, column by column, and the time.
type Turning = SVector<f64, 61>;
/// Above the fastest rate of the motion, 1/s.
const RATE: f64 = 60.0;

/// The motion at one time.
pub struct Exact {
    /// The hand's end, and the far end of each link, metres.
    pub joints: Vec<Vector3<f64>>,
    /// Joules.
    pub energy: f64,
    /// Of the hand on the chain, newtons.
    pub force: Vector3<f64>,
}

/// The motion at these times, and an estimate of its error, from the start that [`Whip::start`] gives.
pub fn motion(whip: &Whip<FEW>, lean: f64, times: impl IntoIterator<Item = f64>) -> (Vec<Exact>, f64) {
    let (places, _) = whip.start(lean);
    let attitudes = places.iter().flat_map(|place| place.fixed_view::<3, 3>(0, 0).iter().copied().collect::<Vec<_>>());
    let numbers: Vec<f64> = attitudes.chain([0.0; 3 * FEW + 1]).collect();
    let (mut y, mut error) = (Turning::from_column_slice(&numbers), 0.0);
    let mut motion = Vec::new();
    for time in times {
        let solution = solve(|y| whip.law(y), y, time - y[12 * FEW], RATE);
        (y, error) = (solution.end, error + solution.error);
        motion.push(whip.exact(&y));
    }
    (motion, error)
}

impl Whip<FEW> {
    fn turn(y: &Turning, i: usize) -> Matrix3<f64> {
        Matrix3::from_column_slice(&y.as_slice()[9 * i..9 * i + 9])
    }

    fn omega(y: &Turning, i: usize) -> Vector3<f64> {
        y.fixed_rows::<3>(9 * FEW + 3 * i).into_owned()
    }

    /// The centre of link i is that of the hand and Σ R_j l_ij over j ≤ i.
    fn lever(&self, i: usize, j: usize) -> Vector3<f64> {
        if j < i { self.far - self.near } else { -self.near }
    }

    /// ω′, and the force of the hand. For every j, with x_i″ = a″ + Σ R_k (ω_k′ × l_ik + ω_k × (ω_k × l_ik)):
    ///
    /// ```text
    /// J ω_j′ + ω_j × J ω_j + Σ l_ij × R_jᵀ m (x_i″ + g e₂) = 0,    over i ≥ j
    /// ```
    fn forces(&self, y: &Turning) -> (SVector<f64, 15>, Vector3<f64>) {
        let turns: [Matrix3<f64>; FEW] = std::array::from_fn(|i| Self::turn(y, i));
        let omegas: [Vector3<f64>; FEW] = std::array::from_fn(|i| Self::omega(y, i));
        let [_, _, hand] = self.hand(y[12 * FEW]);
        let moments = Matrix3::from_diagonal(&self.moments());
        let (mut matrix, mut right) = (SMatrix::<f64, 15, 15>::zeros(), SVector::<f64, 15>::zeros());
        let mut slopes = SMatrix::<f64, 3, 15>::zeros();
        let mut force = Vector3::zeros();
        for (j, omega) in omegas.iter().enumerate() {
            matrix.fixed_view_mut::<3, 3>(3 * j, 3 * j).copy_from(&moments);
            right.fixed_rows_mut::<3>(3 * j).copy_from(&-omega.cross(&(moments * omega)));
        }
        for i in 0..FEW {
            let mut spun = hand + Vector3::y() * self.gravity;
            let mut slope = SMatrix::<f64, 3, 15>::zeros();
            for (j, (turn, omega)) in turns.iter().zip(&omegas).enumerate().take(i + 1) {
                let lever = self.lever(i, j);
                spun += turn * omega.cross(&omega.cross(&lever));
                slope.fixed_view_mut::<3, 3>(0, 3 * j).copy_from(&(-turn * lever.cross_matrix()));
            }
            for (j, turn) in turns.iter().enumerate().take(i + 1) {
                let moved = self.lever(i, j).cross_matrix() * turn.transpose() * self.mass;
                let mut rows = matrix.fixed_rows_mut::<3>(3 * j);
                rows += moved * slope;
                let mut torque = right.fixed_rows_mut::<3>(3 * j);
                torque -= moved * spun;
            }
            slopes += slope * self.mass;
            force += spun * self.mass;
        }
        let change = matrix.lu().solve(&right).unwrap_or(SVector::repeat(f64::NAN));
        (change, force + slopes * change)
    }

    fn law(&self, y: &Turning) -> Turning {
        let mut change = Turning::zeros();
        for i in 0..FEW {
            let turned = Self::turn(y, i) * Self::omega(y, i).cross_matrix();
            change.fixed_rows_mut::<9>(9 * i).copy_from_slice(turned.as_slice());
        }
        change.fixed_rows_mut::<15>(9 * FEW).copy_from(&self.forces(y).0);
        change[12 * FEW] = 1.0;
        change
    }

    fn exact(&self, y: &Turning) -> Exact {
        let [mut end, mut moving, _] = self.hand(y[12 * FEW]);
        let (mut joints, mut energy) = (vec![end], 0.0);
        for i in 0..FEW {
            let (turn, omega) = (Self::turn(y, i), Self::omega(y, i));
            let at = |lever: Vector3<f64>| (end + turn * lever, moving + turn * omega.cross(&lever));
            let (centre, velocity) = at(-self.near);
            energy += self.mass * (velocity.norm_squared() / 2.0 + self.gravity * centre.y);
            energy += omega.dot(&self.moments().component_mul(&omega)) / 2.0;
            (end, moving) = at(self.far - self.near);
            joints.push(end);
        }
        Exact { joints, energy, force: self.forces(y).1 }
    }
}
