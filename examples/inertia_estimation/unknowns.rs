//! The unknowns that are estimated, and how the start of the motion depends on them.

use crate::rotation::{exponential, logarithm, right_jacobian};
use clebsch::Sensitivity;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Five entries of the inertia, three angles, three rates.
pub const COUNT: usize = 11;

/// How many of them are of the inertia; these come first.
pub const OF_INERTIA: usize = 5;

/// J₁₁, J₂₂, J₁₂, J₁₃, J₂₃ over the trace. Then the rotation vector a of the attitude R̄ exp(â) at the start, radians,
/// and the angular velocity there, body frame, rad/s.
pub type Unknowns = SVector<f64, COUNT>;

/// A row of derivatives of something with three components with respect to the unknowns.
pub type Slopes = SMatrix<f64, 3, COUNT>;

/// Entries of the inertia in the order of its quantities, row by row of the upper triangle.
const UPPER: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// A body and how it starts.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// About the centre of mass, body frame, kg·m².
    pub inertia: Matrix3<f64>,
    /// Body to space.
    pub attitude: Matrix3<f64>,
    /// Angular velocity, body frame, rad/s.
    pub spin: Vector3<f64>,
}

/// The quantities that are not estimated.
#[derive(Clone, Copy, Debug)]
pub struct Chart {
    /// tr J, kg·m²: attitudes do not tell it.
    pub trace: f64,
    /// R̄, about which the attitude at the start is counted.
    pub anchor: Matrix3<f64>,
}

impl Chart {
    /// The unknowns of a start.
    pub fn unknowns(&self, start: &Start) -> Unknowns {
        let ratio = start.inertia / self.trace;
        let turn = logarithm(&(self.anchor.transpose() * start.attitude));
        let entries = [(0, 0), (1, 1), (0, 1), (0, 2), (1, 2)].map(|place| ratio[place]);
        Unknowns::from_iterator(entries.into_iter().chain(turn.iter().copied()).chain(start.spin.iter().copied()))
    }

    /// The start that the unknowns stand for.
    pub fn start(&self, x: &Unknowns) -> Start {
        let (turn, spin) = (Vector3::new(x[5], x[6], x[7]), Vector3::new(x[8], x[9], x[10]));
        let ratio = Matrix3::new(x[0], x[2], x[3], x[2], x[1], x[4], x[3], x[4], 1.0 - x[0] - x[1]);
        Start { inertia: ratio * self.trace, attitude: self.anchor * exponential(&turn), spin }
    }

    /// The derivatives of the entries [`UPPER`]; those of the third moment keep the trace.
    pub fn inertia_slopes(&self) -> SMatrix<f64, 6, COUNT> {
        let mut slopes = SMatrix::zeros();
        for (entry, unknown, slope) in
            [(0, 0, 1.0), (5, 0, -1.0), (3, 1, 1.0), (5, 1, -1.0), (1, 2, 1.0), (2, 3, 1.0), (4, 4, 1.0)]
        {
            slopes[(entry, unknown)] = slope * self.trace;
        }
        slopes
    }

    /// The sensitivity of the first state (R̄ exp(â), Jω): δη = dexp δa from the right, δπ = δJ ω + J δω.
    pub fn start_slopes(&self, x: &Unknowns) -> Sensitivity<f64, 3, COUNT> {
        let Start { inertia, spin, .. } = self.start(x);
        let mut slopes = Sensitivity::<f64, 3, COUNT>::zero();
        slopes.motion.fixed_columns_mut::<3>(5).copy_from(&right_jacobian(&Vector3::new(x[5], x[6], x[7])));
        slopes.momentum.fixed_columns_mut::<3>(8).copy_from(&inertia);
        let of_inertia = self.inertia_slopes();
        for unknown in 0..5 {
            let change = symmetric(&of_inertia.column(unknown).into_owned());
            slopes.momentum.set_column(unknown, &(change * spin));
        }
        slopes
    }
}

/// The symmetric matrix with these entries [`UPPER`].
fn symmetric(upper: &SVector<f64, 6>) -> Matrix3<f64> {
    let mut matrix = Matrix3::zeros();
    for (&(i, j), &entry) in UPPER.iter().zip(upper.iter()) {
        (matrix[(i, j)], matrix[(j, i)]) = (entry, entry);
    }
    matrix
}

/// The entries [`UPPER`] of a symmetric matrix.
pub fn upper(matrix: &Matrix3<f64>) -> SVector<f64, 6> {
    SVector::from(UPPER.map(|place| matrix[place]))
}

/// Whether a body can have this inertia: ½tr J I − J, its second moments, is positive.
pub fn is_of_a_body(inertia: &Matrix3<f64>) -> bool {
    (Matrix3::identity() * (inertia.trace() / 2.0) - inertia).cholesky().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_are_those_of_their_start() {
        let chart = Chart { trace: 30.0, anchor: exponential(&Vector3::new(0.3, -1.0, 2.0)) };
        let x = Unknowns::from([0.2, 0.35, 0.01, -0.02, 0.03, 0.1, -0.2, 0.3, 1.0, 2.0, 3.0]);
        assert!((chart.unknowns(&chart.start(&x)) - x).amax() < 1e-14);
    }

    #[test]
    fn the_slopes_of_the_start_are_differences() {
        let chart = Chart { trace: 30.0, anchor: exponential(&Vector3::new(0.3, -1.0, 2.0)) };
        let x = Unknowns::from([0.2, 0.35, 0.01, -0.02, 0.03, 0.1, -0.2, 0.3, 1.0, 2.0, 3.0]);
        let (here, slopes, step) = (chart.start(&x), chart.start_slopes(&x), 1e-5);
        for k in 0..COUNT {
            let [ahead, behind] = [step, -step].map(|step| chart.start(&(x + Unknowns::ith(k, step))));
            let turn = |start: &Start| logarithm(&(here.attitude.transpose() * start.attitude));
            let motion = (turn(&ahead) - turn(&behind)) / (2.0 * step);
            let momentum = (ahead.inertia * ahead.spin - behind.inertia * behind.spin) / (2.0 * step);
            assert!((motion - slopes.motion.column(k)).amax() < 1e-9);
            assert!((momentum - slopes.momentum.column(k)).amax() < 1e-7);
            let entries = upper(&(ahead.inertia - behind.inertia)) / (2.0 * step);
            assert!((entries - chart.inertia_slopes().column(k)).amax() < 1e-7);
        }
    }

    #[test]
    fn a_rod_thinner_than_a_line_is_no_body() {
        assert!(is_of_a_body(&Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.9))));
        assert!(!is_of_a_body(&Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.1))));
    }
}
