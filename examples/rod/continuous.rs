//! The continuous rod, clamped at one end and pulled at the other: Cosserat's equations by shooting.

use clebsch_examples::reference::solve;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// R column by column, x and the moment in space.
type Numbers = SVector<f64, 15>;
/// Above the rates along the rods of this scene, times the length.
const RATE: f64 = 20.0;
/// Iterations of Newton's method.
const ITERATIONS: usize = 12;
/// Differences of moments, relative.
const DIFFERENCE: f64 = 1e-6;

/// A rod, as strains by forces.
#[derive(Clone, Copy, Debug)]
pub struct Rod {
    /// Metres.
    pub length: f64,
    /// 1/EI, 1/EI, 1/GJ, 1/GA, 1/GA, 1/EA; 0 for a rigid rod.
    pub compliance: SVector<f64, 6>,
    /// Curvature in 1/m where it has no load.
    pub curvature: Vector3<f64>,
    /// At its end, newtons.
    pub pull: Vector3<f64>,
}

impl Rod {
    /// R′ = R κ^, x′ = R γ and m′ = −x′ × pull.
    fn law(&self, y: &Numbers) -> Numbers {
        let turn = Matrix3::from_column_slice(&y.as_slice()[..9]);
        let moment = turn.transpose() * y.fixed_rows::<3>(12);
        let force = turn.transpose() * self.pull;
        let kappa = self.curvature + self.compliance.fixed_rows::<3>(0).component_mul(&moment);
        let gamma = Vector3::z() + self.compliance.fixed_rows::<3>(3).component_mul(&force);
        let along = turn * gamma;
        let mut rates = Numbers::zeros();
        rates.fixed_rows_mut::<9>(0).copy_from_slice((turn * kappa.cross_matrix()).as_slice());
        rates.fixed_rows_mut::<3>(9).copy_from(&along);
        rates.fixed_rows_mut::<3>(12).copy_from(&-along.cross(&self.pull));
        rates
    }

    fn end(&self, moment: &Vector3<f64>) -> Numbers {
        let mut y = Numbers::zeros();
        y.fixed_rows_mut::<9>(0).copy_from_slice(Matrix3::<f64>::identity().as_slice());
        y.fixed_rows_mut::<3>(12).copy_from(moment);
        solve(|y| self.law(y), y, self.length, RATE / self.length).end
    }

    /// Where its end is, from a moment at the clamp that is near; and the moment that is left at the end.
    pub fn tip(&self, near: Vector3<f64>) -> (Vector3<f64>, f64) {
        let mut moment = near;
        let size = DIFFERENCE * (1.0 + near.norm());
        for _ in 0..ITERATIONS {
            let left = self.end(&moment).fixed_rows::<3>(12).into_owned();
            let slope = |k: usize| {
                let moved =
                    |sign: f64| self.end(&(moment + Vector3::ith(k, sign * size))).fixed_rows::<3>(12).into_owned();
                (moved(1.0) - moved(-1.0)) / (2.0 * size)
            };
            let slopes = SMatrix::<f64, 3, 3>::from_columns(&[slope(0), slope(1), slope(2)]);
            moment -= slopes.try_inverse().map_or(Vector3::zeros(), |inverse| inverse * left);
        }
        let end = self.end(&moment);
        (end.fixed_rows::<3>(9).into_owned(), end.fixed_rows::<3>(12).norm())
    }
}
