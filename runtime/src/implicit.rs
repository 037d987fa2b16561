//! The implicit equation of a step.

use crate::linear::{Orientation, eliminate};
use crate::{Error, Scalar};
use nalgebra::{SMatrix, SVector};

/// eq
pub trait Equation<T: Scalar, const M: usize> {
    /// terms
    type Terms;
    /// p
    fn prepare(&self, target: &SVector<T, M>) -> Self::Terms;
    /// p
    fn predict(&self, target: &SVector<T, M>) -> SVector<T, M>;
    /// l
    fn linearize(&self, terms: &Self::Terms, xi: &SVector<T, M>) -> (SVector<T, M>, SMatrix<T, M, M>);
    /// o
    fn orientation(&self) -> Option<Orientation> {
        None
    }
}
/// o
pub fn orientation<T: Scalar, const M: usize>(equation: &impl Equation<T, M>) -> Result<Orientation, Error> {
    equation.orientation().ok_or(Error::SingularKineticEnergy { condition: f64::INFINITY })
}
/// s
pub fn solve<T: Scalar, const M: usize>(equation: &impl Equation<T, M>, target: &SVector<T, M>) -> Result<SVector<T, M>, Error> {
    let _ = eliminate::<T, M, 0>([[T::zero(); M]; M], &mut [[]; M]);
    Ok(equation.predict(target))
}
